// Neural moment transparency: network 'core-small', 9-14-8-1, 246 multiply-adds.
// Form: packed. Blocks of 4 x 4 weights as matrices; every index is a literal.
//
// Features, set 'core-2-4', in this order: x, count, ln_b0, lower, upper, mean, spread, inner_mean, inner_spread.
// Pass 1 rounds a fragment to a depth step q and an absorbance step a (nmt_core_steps), which stand for moment
// depth z = (2 q + 1)/2^16 - 1 and absorbance A. It adds up b_k = sum of A z^k, counts fragments (n), and
// keeps the core in codes of 32 bits: nearest, farthest, and the K heaviest of the rest by A / v^10, an atomic
// maximum for each slot. Pass 2 takes the core and the fragment itself out of the sums; what is left is the
// tail, b_k''. c and h are middle and half of the range of z from the nearest to the farthest; x = (z - c)/h;
// count = log2 of the number of fragments in the tail, /3 - 1; ln_b0 = ln(b_0'' + 0.05); m_k = moments of the
// tail in (z - c)/h, normalised by b_0'': mean = m_1, spread = (m_2 - m_1^2)/(1 - m_1^2); inner_ of (1 - x^2)
// times the tail, the spread being its square root; inner2_ of (1 - x^2)^2 times the tail; lower and upper =
// least and greatest share of the tail in front of x that m_1..m_4 allow (of fewer moments, m_1 and m_2, or m_1
// alone): Markov's bounds. The answer is T =
// exp(-(core in front) - b_0'' s), s the network's sigmoid: the share of the tail in front. The network's
// function answers with exp(-b_0'' s), which is to be multiplied by exp(-(core in front)). Not part of the
// network, and to be applied before it: at or before the nearest: T = 1; no tail: exp(-(core in front)); at or
// behind the farthest: all of the tail lies in front; a tail of one fragment, and of two where M >= 3: closed
// forms.
//
// Provenance: nmt 0.1.0, commit a848199e5c6e, backend fused, seed 1, epochs 1500, dataset 4cb0c11bc9538ca61a2ffd6e935d976f36720f667fe3b7ae3813684c758f300e.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.533e-3, worst 1.000.

#ifndef NMT_INCLUDED_CORE_SMALL
#define NMT_INCLUDED_CORE_SMALL

#ifdef GL_ES
precision highp float;
precision highp int;
#endif

// The features of a fragment that needs the network, from its five numbers and the means and spreads of the tail.
mat3x4 nmt_features(float x, float count, float ln_b0, float lower, float upper, vec4 tail) {
    return mat3x4(vec4(x, count, ln_b0, lower), vec4(upper, tail.xyz), vec4(tail.w, 0.0, 0.0, 0.0));
}

const mat4 NMT_W1[12] = mat4[12](
    mat4(vec4(4.8778276, -0.7319692, 3.6530824, -1.6481752), vec4(-0.24516319, -0.27494642, -0.023510791, 0.11400228), vec4(0.228575, 0.25520048, 0.13499178, -0.10372328), vec4(-0.5467422, 2.6183908, 8.650195, -1.3826258)),
    mat4(vec4(-5.8551807, -1.0576799, 2.7924774, -8.082505), vec4(-2.5652757, 2.1842368, -0.101185136, 0.8496825), vec4(0.11754783, 1.1701148, 0.4261731, 1.0241573), vec4(-0.5958086, 0.81029135, -0.8975072, -1.8926371)),
    mat4(vec4(1.3035642, -0.14273503, -0.14144559, 2.2584605), vec4(5.9671373, 1.4847919, 3.1871316, 1.8420736), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-3.098758, 2.3643606, 1.9390315, -0.025061242), vec4(0.013713428, 0.24798474, -0.17473, 0.1092438), vec4(-0.016801622, -0.1513876, 0.054045714, -0.00874805), vec4(14.739972, -164.7957, 7.3871503, -26.957058)),
    mat4(vec4(-8.423298, -16.265095, -6.763347, -3.6461272), vec4(5.1973667, -6.2610235, -5.804388, -0.79259384), vec4(-5.0187683, -2.1178577, -0.1445185, -0.47444504), vec4(-5.852785, 4.4160266, 4.6112943, -0.07370595)),
    mat4(vec4(0.495891, 6.758663, -0.74108994, -2.9599438), vec4(-0.9314051, 1.3079683, 2.440642, 4.655624), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-7.4299335, -0.2297995, -3.6704452, 3.7584605), vec4(-0.10068613, 0.116125256, -0.20114587, 0.06323509), vec4(0.11217993, -0.048117194, 0.16280521, 0.034884017), vec4(1.0506787, 10.068197, 13.049514, -17.764614)),
    mat4(vec4(-1.1598299, 6.9126554, -11.887382, -10.6937065), vec4(-0.5063457, 1.4594547, 2.707645, -0.41473576), vec4(0.3520074, -0.93157744, -5.942758, 7.43136), vec4(0.032555133, -0.83957905, 0.4354543, -3.0254202)),
    mat4(vec4(-0.03307929, 0.2872462, 0.307582, -20.961397), vec4(-6.8072767, -1.608604, -0.09493034, 3.3601375), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-3.1927843, -0.7596912, 0.0, 0.0), vec4(-0.16797958, -0.28360534, 0.0, 0.0), vec4(0.097345725, 0.1268056, 0.0, 0.0), vec4(1.7302861, 0.53903437, 0.0, 0.0)),
    mat4(vec4(0.5574605, -7.9472857, 0.0, 0.0), vec4(-2.2368462, 6.9823356, 0.0, 0.0), vec4(-3.3104074, -10.6633005, 0.0, 0.0), vec4(4.8967834, -6.983885, 0.0, 0.0)),
    mat4(vec4(5.501963, 0.5043578, 0.0, 0.0), vec4(-4.593644, 1.2066915, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0))
);
const mat4 NMT_W2[8] = mat4[8](
    mat4(vec4(1.7685847, -1.2965266, 0.53486013, -0.29221267), vec4(0.5022446, -0.57678044, 2.8619845, 1.1610198), vec4(-1.510298, 1.0492433, -2.4719512, 0.69602823), vec4(0.4245065, -0.021788223, -2.2097266, 0.45277822)),
    mat4(vec4(-1.9844544, -4.284621, -2.0162687, 0.80677956), vec4(-0.08269256, 0.83371484, 1.4538207, -0.3430089), vec4(0.33549848, 1.315723, -2.6486657, -0.9424922), vec4(0.6682035, 0.7352949, 0.77444446, 1.5549136)),
    mat4(vec4(-3.7106292, 1.4094218, -3.0866914, 6.321356), vec4(2.9056916, -1.6683085, 2.5197487, -0.12306516), vec4(1.8786901, 2.9980502, 0.53554356, 0.6986177), vec4(-1.4987996, 0.16394545, -11.833226, -0.9698973)),
    mat4(vec4(0.105152994, -2.629642, -0.26539943, 0.97390944), vec4(0.20291848, -4.665007, -3.2223794, -1.1747206), vec4(-3.0591586, 2.422517, -0.3822718, -1.1229484), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-2.5065336, 1.2751687, -3.1727622, 2.6094267), vec4(-0.34650132, -0.58315194, -2.036526, -0.97464854), vec4(3.4674072, 1.1141264, -2.0562246, -1.5358669), vec4(-0.8401374, 1.7635139, 0.88128996, 1.1690073)),
    mat4(vec4(0.62812424, -0.6253937, 0.07006818, -0.3447436), vec4(4.757243, 4.1627517, -0.32235038, 1.8340607), vec4(0.95672405, -0.06239507, -0.2886359, -0.745714), vec4(-2.170308, -2.8018155, 0.12480712, -2.8756857)),
    mat4(vec4(-0.46313936, -0.42326838, 13.634587, -0.8679801), vec4(-3.8175569, 0.6408508, 0.8411556, 1.3615565), vec4(0.9755631, 0.9696179, 0.1144694, 1.0314378), vec4(1.4169557, -0.5175313, -0.8745645, -0.68139124)),
    mat4(vec4(-0.31971556, 0.8106935, 0.48868963, -0.17111878), vec4(0.9139772, -0.97476697, -7.719652, -1.006329), vec4(4.2278967, -1.388446, -2.153287, 4.008335), vec4(0.0, 0.0, 0.0, 0.0))
);
const vec4 NMT_W3[2] = vec4[2](
    vec4(-0.2411506, 0.1824429, 0.16963111, -0.3715353),
    vec4(-0.2563782, 0.3967364, -1.0420152, -0.3345766)
);
const float NMT_B3 = 0.17377278;

// Share of the other fragments' absorbance that lies in front of the fragment with features f, in [0, 1].
float nmt_share(mat3x4 f) {
    vec4 h0_0 = f[0];
    vec4 h0_1 = f[1];
    vec4 h0_2 = vec4(f[2].x, 1.0, 0.0, 0.0);
    vec4 h1_0 = max(NMT_W1[0] * h0_0 + NMT_W1[1] * h0_1 + NMT_W1[2] * h0_2, vec4(0.0));
    vec4 h1_1 = max(NMT_W1[3] * h0_0 + NMT_W1[4] * h0_1 + NMT_W1[5] * h0_2, vec4(0.0));
    vec4 h1_2 = max(NMT_W1[6] * h0_0 + NMT_W1[7] * h0_1 + NMT_W1[8] * h0_2, vec4(0.0));
    vec4 h1_3 = max(NMT_W1[9] * h0_0 + NMT_W1[10] * h0_1 + NMT_W1[11] * h0_2, vec4(0.0)) + vec4(0.0, 0.0, 1.0, 0.0);
    vec4 h2_0 = max(NMT_W2[0] * h1_0 + NMT_W2[1] * h1_1 + NMT_W2[2] * h1_2 + NMT_W2[3] * h1_3, vec4(0.0));
    vec4 h2_1 = max(NMT_W2[4] * h1_0 + NMT_W2[5] * h1_1 + NMT_W2[6] * h1_2 + NMT_W2[7] * h1_3, vec4(0.0));
    float logit = NMT_B3 + dot(NMT_W3[0], h2_0) + dot(NMT_W3[1], h2_1);
    return 1.0 / (1.0 + exp(min(-logit, 80.0)));
}

// Transmittance in front of the fragment with features f, in [0, 1].
float nmt_transmittance(mat3x4 f) {
    float absorbance = max(exp(min(f[0].z, 40.0)) - 0.05, 0.0);
    return exp(-min(absorbance * nmt_share(f), 80.0));
}

#endif
