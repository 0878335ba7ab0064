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

// The features of a fragment that needs the network, from its five numbers and the means and spreads of the tail.
fn nmt_features(x: f32, count: f32, ln_b0: f32, lower: f32, upper: f32, tail: vec4<f32>) -> mat3x4<f32> {
    return mat3x4<f32>(vec4<f32>(x, count, ln_b0, lower), vec4<f32>(upper, tail.xyz), vec4<f32>(tail.w, 0.0, 0.0, 0.0));
}

const NMT_W1 = array<mat4x4<f32>, 12>(
    mat4x4<f32>(vec4<f32>(4.8778276f, -0.7319692f, 3.6530824f, -1.6481752f), vec4<f32>(-0.24516319f, -0.27494642f, -0.023510791f, 0.11400228f), vec4<f32>(0.228575f, 0.25520048f, 0.13499178f, -0.10372328f), vec4<f32>(-0.5467422f, 2.6183908f, 8.650195f, -1.3826258f)),
    mat4x4<f32>(vec4<f32>(-5.8551807f, -1.0576799f, 2.7924774f, -8.082505f), vec4<f32>(-2.5652757f, 2.1842368f, -0.101185136f, 0.8496825f), vec4<f32>(0.11754783f, 1.1701148f, 0.4261731f, 1.0241573f), vec4<f32>(-0.5958086f, 0.81029135f, -0.8975072f, -1.8926371f)),
    mat4x4<f32>(vec4<f32>(1.3035642f, -0.14273503f, -0.14144559f, 2.2584605f), vec4<f32>(5.9671373f, 1.4847919f, 3.1871316f, 1.8420736f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-3.098758f, 2.3643606f, 1.9390315f, -0.025061242f), vec4<f32>(0.013713428f, 0.24798474f, -0.17473f, 0.1092438f), vec4<f32>(-0.016801622f, -0.1513876f, 0.054045714f, -0.00874805f), vec4<f32>(14.739972f, -164.7957f, 7.3871503f, -26.957058f)),
    mat4x4<f32>(vec4<f32>(-8.423298f, -16.265095f, -6.763347f, -3.6461272f), vec4<f32>(5.1973667f, -6.2610235f, -5.804388f, -0.79259384f), vec4<f32>(-5.0187683f, -2.1178577f, -0.1445185f, -0.47444504f), vec4<f32>(-5.852785f, 4.4160266f, 4.6112943f, -0.07370595f)),
    mat4x4<f32>(vec4<f32>(0.495891f, 6.758663f, -0.74108994f, -2.9599438f), vec4<f32>(-0.9314051f, 1.3079683f, 2.440642f, 4.655624f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-7.4299335f, -0.2297995f, -3.6704452f, 3.7584605f), vec4<f32>(-0.10068613f, 0.116125256f, -0.20114587f, 0.06323509f), vec4<f32>(0.11217993f, -0.048117194f, 0.16280521f, 0.034884017f), vec4<f32>(1.0506787f, 10.068197f, 13.049514f, -17.764614f)),
    mat4x4<f32>(vec4<f32>(-1.1598299f, 6.9126554f, -11.887382f, -10.6937065f), vec4<f32>(-0.5063457f, 1.4594547f, 2.707645f, -0.41473576f), vec4<f32>(0.3520074f, -0.93157744f, -5.942758f, 7.43136f), vec4<f32>(0.032555133f, -0.83957905f, 0.4354543f, -3.0254202f)),
    mat4x4<f32>(vec4<f32>(-0.03307929f, 0.2872462f, 0.307582f, -20.961397f), vec4<f32>(-6.8072767f, -1.608604f, -0.09493034f, 3.3601375f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-3.1927843f, -0.7596912f, 0.0f, 0.0f), vec4<f32>(-0.16797958f, -0.28360534f, 0.0f, 0.0f), vec4<f32>(0.097345725f, 0.1268056f, 0.0f, 0.0f), vec4<f32>(1.7302861f, 0.53903437f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(0.5574605f, -7.9472857f, 0.0f, 0.0f), vec4<f32>(-2.2368462f, 6.9823356f, 0.0f, 0.0f), vec4<f32>(-3.3104074f, -10.6633005f, 0.0f, 0.0f), vec4<f32>(4.8967834f, -6.983885f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(5.501963f, 0.5043578f, 0.0f, 0.0f), vec4<f32>(-4.593644f, 1.2066915f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f))
);
const NMT_W2 = array<mat4x4<f32>, 8>(
    mat4x4<f32>(vec4<f32>(1.7685847f, -1.2965266f, 0.53486013f, -0.29221267f), vec4<f32>(0.5022446f, -0.57678044f, 2.8619845f, 1.1610198f), vec4<f32>(-1.510298f, 1.0492433f, -2.4719512f, 0.69602823f), vec4<f32>(0.4245065f, -0.021788223f, -2.2097266f, 0.45277822f)),
    mat4x4<f32>(vec4<f32>(-1.9844544f, -4.284621f, -2.0162687f, 0.80677956f), vec4<f32>(-0.08269256f, 0.83371484f, 1.4538207f, -0.3430089f), vec4<f32>(0.33549848f, 1.315723f, -2.6486657f, -0.9424922f), vec4<f32>(0.6682035f, 0.7352949f, 0.77444446f, 1.5549136f)),
    mat4x4<f32>(vec4<f32>(-3.7106292f, 1.4094218f, -3.0866914f, 6.321356f), vec4<f32>(2.9056916f, -1.6683085f, 2.5197487f, -0.12306516f), vec4<f32>(1.8786901f, 2.9980502f, 0.53554356f, 0.6986177f), vec4<f32>(-1.4987996f, 0.16394545f, -11.833226f, -0.9698973f)),
    mat4x4<f32>(vec4<f32>(0.105152994f, -2.629642f, -0.26539943f, 0.97390944f), vec4<f32>(0.20291848f, -4.665007f, -3.2223794f, -1.1747206f), vec4<f32>(-3.0591586f, 2.422517f, -0.3822718f, -1.1229484f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-2.5065336f, 1.2751687f, -3.1727622f, 2.6094267f), vec4<f32>(-0.34650132f, -0.58315194f, -2.036526f, -0.97464854f), vec4<f32>(3.4674072f, 1.1141264f, -2.0562246f, -1.5358669f), vec4<f32>(-0.8401374f, 1.7635139f, 0.88128996f, 1.1690073f)),
    mat4x4<f32>(vec4<f32>(0.62812424f, -0.6253937f, 0.07006818f, -0.3447436f), vec4<f32>(4.757243f, 4.1627517f, -0.32235038f, 1.8340607f), vec4<f32>(0.95672405f, -0.06239507f, -0.2886359f, -0.745714f), vec4<f32>(-2.170308f, -2.8018155f, 0.12480712f, -2.8756857f)),
    mat4x4<f32>(vec4<f32>(-0.46313936f, -0.42326838f, 13.634587f, -0.8679801f), vec4<f32>(-3.8175569f, 0.6408508f, 0.8411556f, 1.3615565f), vec4<f32>(0.9755631f, 0.9696179f, 0.1144694f, 1.0314378f), vec4<f32>(1.4169557f, -0.5175313f, -0.8745645f, -0.68139124f)),
    mat4x4<f32>(vec4<f32>(-0.31971556f, 0.8106935f, 0.48868963f, -0.17111878f), vec4<f32>(0.9139772f, -0.97476697f, -7.719652f, -1.006329f), vec4<f32>(4.2278967f, -1.388446f, -2.153287f, 4.008335f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f))
);
const NMT_W3 = array<vec4<f32>, 2>(
    vec4<f32>(-0.2411506f, 0.1824429f, 0.16963111f, -0.3715353f),
    vec4<f32>(-0.2563782f, 0.3967364f, -1.0420152f, -0.3345766f)
);
const NMT_B3: f32 = 0.17377278f;

// Share of the other fragments' absorbance that lies in front of the fragment with features f, in [0, 1].
fn nmt_share(f: mat3x4<f32>) -> f32 {
    let h0_0 = f[0];
    let h0_1 = f[1];
    let h0_2 = vec4<f32>(f[2].x, 1.0f, 0.0f, 0.0f);
    let h1_0 = max(NMT_W1[0] * h0_0 + NMT_W1[1] * h0_1 + NMT_W1[2] * h0_2, vec4<f32>(0.0f));
    let h1_1 = max(NMT_W1[3] * h0_0 + NMT_W1[4] * h0_1 + NMT_W1[5] * h0_2, vec4<f32>(0.0f));
    let h1_2 = max(NMT_W1[6] * h0_0 + NMT_W1[7] * h0_1 + NMT_W1[8] * h0_2, vec4<f32>(0.0f));
    let h1_3 = max(NMT_W1[9] * h0_0 + NMT_W1[10] * h0_1 + NMT_W1[11] * h0_2, vec4<f32>(0.0f)) + vec4<f32>(0.0f, 0.0f, 1.0f, 0.0f);
    let h2_0 = max(NMT_W2[0] * h1_0 + NMT_W2[1] * h1_1 + NMT_W2[2] * h1_2 + NMT_W2[3] * h1_3, vec4<f32>(0.0f));
    let h2_1 = max(NMT_W2[4] * h1_0 + NMT_W2[5] * h1_1 + NMT_W2[6] * h1_2 + NMT_W2[7] * h1_3, vec4<f32>(0.0f));
    let logit = NMT_B3 + dot(NMT_W3[0], h2_0) + dot(NMT_W3[1], h2_1);
    return 1.0 / (1.0 + exp(min(-logit, 80.0)));
}

// Transmittance in front of the fragment with features f, in [0, 1].
fn nmt_transmittance(f: mat3x4<f32>) -> f32 {
    let absorbance = max(exp(min(f[0].z, 40.0f)) - 0.05f, 0.0);
    return exp(-min(absorbance * nmt_share(f), 80.0));
}
