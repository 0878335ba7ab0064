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
// Provenance: nmt 0.1.0, commit b1d5f0d9a708, backend fused, seed 1, epochs 1500, dataset 9636ee68609509b56e59e891665a02e7488e2241af88306025242c084edbf4a2.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.550e-3, worst 1.000.

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
    mat4(vec4(4.633581, 1.5577128, 4.847308, -7.9550843), vec4(-0.040778674, 0.30109483, 0.18810418, 0.08001085), vec4(0.1270906, -0.113899805, -0.09940042, 0.06291714), vec4(-5.239348, 4.4244847, 11.981173, -5.647331)),
    mat4(vec4(-6.316239, 7.0866685, 0.7747114, -6.249695), vec4(-2.8813026, 1.3543744, -2.5794756, -3.425034), vec4(-0.14739996, 2.974767, 1.035014, -0.48165968), vec4(-0.58785886, 0.50425225, 0.19695403, -0.901528)),
    mat4(vec4(0.21754104, -2.6533523, 0.27809235, 0.23363206), vec4(7.509731, 0.018536674, 5.0530396, -3.8738046), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-3.1414006, 4.4425554, -0.89057094, -1.1077212), vec4(-0.059489608, -0.20166463, -0.23307152, -0.11338352), vec4(0.05209868, 0.059970256, 0.18867385, 0.09877608), vec4(26.519499, 20.081259, -4.729799, -1.1468024)),
    mat4(vec4(-21.093914, -0.65355283, -12.0057335, 5.4057674), vec4(5.5124702, -0.11932348, -2.0397336, -3.026001), vec4(-7.544677, -1.4594955, 0.9759642, -4.3099356), vec4(-4.8257446, -1.2188243, 4.2050624, 4.96347)),
    mat4(vec4(0.29272616, 5.196453, 1.3102355, 0.27936175), vec4(-0.21944292, 2.4984572, 1.7173952, 1.3231782), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-1.8677667, -0.47189677, 3.3769467, 2.4587243), vec4(-0.22109956, 0.060226426, 0.052055903, 0.11305356), vec4(0.05001351, 0.039633315, -0.020085853, -0.10174877), vec4(-1.739131, 5.6659603, 12.399412, -3.9291306)),
    mat4(vec4(-23.451077, 3.901157, -12.326258, -16.445658), vec4(-2.008173, -3.4493191, -4.080363, -9.312441), vec4(-1.5544633, -5.9060125, -1.8305857, -1.870911), vec4(1.8193483, 8.248149, 1.6809378, 8.031535)),
    mat4(vec4(4.5426483, 6.092583, 10.385813, 5.0848346), vec4(0.7915796, -2.201602, -0.02491766, 1.6812139), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-6.600309, 0.123911336, 0.0, 0.0), vec4(-0.1909336, 0.3993747, 0.0, 0.0), vec4(0.13846499, -0.076549605, 0.0, 0.0), vec4(9.1780405, -24.788761, 0.0, 0.0)),
    mat4(vec4(-1.6179283, 4.5265007, 0.0, 0.0), vec4(-1.2897608, 3.906312, 0.0, 0.0), vec4(1.3081037, 3.0357022, 0.0, 0.0), vec4(0.94770765, -3.043183, 0.0, 0.0)),
    mat4(vec4(-0.08552459, -9.461983, 0.0, 0.0), vec4(-6.4232793, 1.3108759, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0))
);
const mat4 NMT_W2[8] = mat4[8](
    mat4(vec4(1.1419989, -1.4198644, -0.19373854, 0.56172514), vec4(-0.75568086, -1.1981204, -0.7734579, 0.29221427), vec4(0.072205335, 2.5015967, -0.56138813, -0.7423831), vec4(-0.34978172, 1.01927, -0.19402012, 1.2962704)),
    mat4(vec4(-1.8820454, -0.9988709, -1.0608377, 3.7136261), vec4(-0.9074444, 0.100530505, -3.6432486, 0.9728528), vec4(-0.07494871, 0.06845625, 0.4569547, 1.2108296), vec4(-0.007983513, -1.39181, 2.5139186, -0.68514496)),
    mat4(vec4(1.1394446, -1.2730776, -0.46546707, -0.12843531), vec4(-0.5475997, -0.3343885, -3.3071005, 0.58014804), vec4(-1.662909, -1.1193928, 3.9590952, -0.9652814), vec4(-3.4225204, 2.9797518, -0.11754079, 0.023971306)),
    mat4(vec4(3.0399487, 1.6670663, -3.1889777, 2.7175567), vec4(0.0562945, 1.1437154, -3.8556113, 0.5253217), vec4(2.817947, 0.85403734, 0.7493489, 2.9479167), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(0.4565463, 0.46166718, -7.863282, 0.4971716), vec4(2.2395608, -3.3886964, 0.4029314, -4.3679767), vec4(-3.5426292, 2.6224256, -2.0955248, -1.2515348), vec4(-2.0730424, 0.21992649, 7.2669735, -0.28032577)),
    mat4(vec4(0.2647249, 2.2715585, 0.21832715, -1.41066), vec4(2.2557268, 0.09026979, 0.015854748, 3.7563598), vec4(0.4581541, -1.9481311, -0.054118, -0.3657199), vec4(0.9714568, -2.4021637, -0.17931756, 0.7629885)),
    mat4(vec4(-1.542965, 2.8256016, 0.18076795, 3.3432143), vec4(0.50801617, 1.5908597, 0.3709236, -3.6185648), vec4(-0.8337836, -1.631481, -0.13030158, -6.766812), vec4(-3.4649694, -0.792588, -0.10180443, -0.32464153)),
    mat4(vec4(2.7873704, 0.40408432, 2.34775, -1.3204027), vec4(-0.7127589, 1.8839266, -0.15561827, 3.494888), vec4(-1.5662805, -7.3176303, -4.491624, -4.135471), vec4(0.0, 0.0, 0.0, 0.0))
);
const vec4 NMT_W3[2] = vec4[2](
    vec4(-0.24083899, 0.15409076, 0.13565949, -0.2946874),
    vec4(0.1629475, 0.3656696, -1.2356493, -0.1714698)
);
const float NMT_B3 = -0.33463305;

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
