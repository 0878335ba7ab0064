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

// The features of a fragment that needs the network, from its five numbers and the means and spreads of the tail.
fn nmt_features(x: f32, count: f32, ln_b0: f32, lower: f32, upper: f32, tail: vec4<f32>) -> mat3x4<f32> {
    return mat3x4<f32>(vec4<f32>(x, count, ln_b0, lower), vec4<f32>(upper, tail.xyz), vec4<f32>(tail.w, 0.0, 0.0, 0.0));
}

const NMT_W1 = array<mat4x4<f32>, 12>(
    mat4x4<f32>(vec4<f32>(4.633581f, 1.5577128f, 4.847308f, -7.9550843f), vec4<f32>(-0.040778674f, 0.30109483f, 0.18810418f, 0.08001085f), vec4<f32>(0.1270906f, -0.113899805f, -0.09940042f, 0.06291714f), vec4<f32>(-5.239348f, 4.4244847f, 11.981173f, -5.647331f)),
    mat4x4<f32>(vec4<f32>(-6.316239f, 7.0866685f, 0.7747114f, -6.249695f), vec4<f32>(-2.8813026f, 1.3543744f, -2.5794756f, -3.425034f), vec4<f32>(-0.14739996f, 2.974767f, 1.035014f, -0.48165968f), vec4<f32>(-0.58785886f, 0.50425225f, 0.19695403f, -0.901528f)),
    mat4x4<f32>(vec4<f32>(0.21754104f, -2.6533523f, 0.27809235f, 0.23363206f), vec4<f32>(7.509731f, 0.018536674f, 5.0530396f, -3.8738046f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-3.1414006f, 4.4425554f, -0.89057094f, -1.1077212f), vec4<f32>(-0.059489608f, -0.20166463f, -0.23307152f, -0.11338352f), vec4<f32>(0.05209868f, 0.059970256f, 0.18867385f, 0.09877608f), vec4<f32>(26.519499f, 20.081259f, -4.729799f, -1.1468024f)),
    mat4x4<f32>(vec4<f32>(-21.093914f, -0.65355283f, -12.0057335f, 5.4057674f), vec4<f32>(5.5124702f, -0.11932348f, -2.0397336f, -3.026001f), vec4<f32>(-7.544677f, -1.4594955f, 0.9759642f, -4.3099356f), vec4<f32>(-4.8257446f, -1.2188243f, 4.2050624f, 4.96347f)),
    mat4x4<f32>(vec4<f32>(0.29272616f, 5.196453f, 1.3102355f, 0.27936175f), vec4<f32>(-0.21944292f, 2.4984572f, 1.7173952f, 1.3231782f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-1.8677667f, -0.47189677f, 3.3769467f, 2.4587243f), vec4<f32>(-0.22109956f, 0.060226426f, 0.052055903f, 0.11305356f), vec4<f32>(0.05001351f, 0.039633315f, -0.020085853f, -0.10174877f), vec4<f32>(-1.739131f, 5.6659603f, 12.399412f, -3.9291306f)),
    mat4x4<f32>(vec4<f32>(-23.451077f, 3.901157f, -12.326258f, -16.445658f), vec4<f32>(-2.008173f, -3.4493191f, -4.080363f, -9.312441f), vec4<f32>(-1.5544633f, -5.9060125f, -1.8305857f, -1.870911f), vec4<f32>(1.8193483f, 8.248149f, 1.6809378f, 8.031535f)),
    mat4x4<f32>(vec4<f32>(4.5426483f, 6.092583f, 10.385813f, 5.0848346f), vec4<f32>(0.7915796f, -2.201602f, -0.02491766f, 1.6812139f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-6.600309f, 0.123911336f, 0.0f, 0.0f), vec4<f32>(-0.1909336f, 0.3993747f, 0.0f, 0.0f), vec4<f32>(0.13846499f, -0.076549605f, 0.0f, 0.0f), vec4<f32>(9.1780405f, -24.788761f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-1.6179283f, 4.5265007f, 0.0f, 0.0f), vec4<f32>(-1.2897608f, 3.906312f, 0.0f, 0.0f), vec4<f32>(1.3081037f, 3.0357022f, 0.0f, 0.0f), vec4<f32>(0.94770765f, -3.043183f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-0.08552459f, -9.461983f, 0.0f, 0.0f), vec4<f32>(-6.4232793f, 1.3108759f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f))
);
const NMT_W2 = array<mat4x4<f32>, 8>(
    mat4x4<f32>(vec4<f32>(1.1419989f, -1.4198644f, -0.19373854f, 0.56172514f), vec4<f32>(-0.75568086f, -1.1981204f, -0.7734579f, 0.29221427f), vec4<f32>(0.072205335f, 2.5015967f, -0.56138813f, -0.7423831f), vec4<f32>(-0.34978172f, 1.01927f, -0.19402012f, 1.2962704f)),
    mat4x4<f32>(vec4<f32>(-1.8820454f, -0.9988709f, -1.0608377f, 3.7136261f), vec4<f32>(-0.9074444f, 0.100530505f, -3.6432486f, 0.9728528f), vec4<f32>(-0.07494871f, 0.06845625f, 0.4569547f, 1.2108296f), vec4<f32>(-0.007983513f, -1.39181f, 2.5139186f, -0.68514496f)),
    mat4x4<f32>(vec4<f32>(1.1394446f, -1.2730776f, -0.46546707f, -0.12843531f), vec4<f32>(-0.5475997f, -0.3343885f, -3.3071005f, 0.58014804f), vec4<f32>(-1.662909f, -1.1193928f, 3.9590952f, -0.9652814f), vec4<f32>(-3.4225204f, 2.9797518f, -0.11754079f, 0.023971306f)),
    mat4x4<f32>(vec4<f32>(3.0399487f, 1.6670663f, -3.1889777f, 2.7175567f), vec4<f32>(0.0562945f, 1.1437154f, -3.8556113f, 0.5253217f), vec4<f32>(2.817947f, 0.85403734f, 0.7493489f, 2.9479167f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(0.4565463f, 0.46166718f, -7.863282f, 0.4971716f), vec4<f32>(2.2395608f, -3.3886964f, 0.4029314f, -4.3679767f), vec4<f32>(-3.5426292f, 2.6224256f, -2.0955248f, -1.2515348f), vec4<f32>(-2.0730424f, 0.21992649f, 7.2669735f, -0.28032577f)),
    mat4x4<f32>(vec4<f32>(0.2647249f, 2.2715585f, 0.21832715f, -1.41066f), vec4<f32>(2.2557268f, 0.09026979f, 0.015854748f, 3.7563598f), vec4<f32>(0.4581541f, -1.9481311f, -0.054118f, -0.3657199f), vec4<f32>(0.9714568f, -2.4021637f, -0.17931756f, 0.7629885f)),
    mat4x4<f32>(vec4<f32>(-1.542965f, 2.8256016f, 0.18076795f, 3.3432143f), vec4<f32>(0.50801617f, 1.5908597f, 0.3709236f, -3.6185648f), vec4<f32>(-0.8337836f, -1.631481f, -0.13030158f, -6.766812f), vec4<f32>(-3.4649694f, -0.792588f, -0.10180443f, -0.32464153f)),
    mat4x4<f32>(vec4<f32>(2.7873704f, 0.40408432f, 2.34775f, -1.3204027f), vec4<f32>(-0.7127589f, 1.8839266f, -0.15561827f, 3.494888f), vec4<f32>(-1.5662805f, -7.3176303f, -4.491624f, -4.135471f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f))
);
const NMT_W3 = array<vec4<f32>, 2>(
    vec4<f32>(-0.24083899f, 0.15409076f, 0.13565949f, -0.2946874f),
    vec4<f32>(0.1629475f, 0.3656696f, -1.2356493f, -0.1714698f)
);
const NMT_B3: f32 = -0.33463305f;

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
