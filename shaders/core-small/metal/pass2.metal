// Metal, by naga from WGSL, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Target 0: rgba16float or rgba32float, blend add, factors one and one, cleared to 0.
// Textures: the targets of pass 1. Buffer 2: that of pass 1. Buffer 0: the uniforms.
//
// Neural moment transparency: network 'core-small', 9-14-8-1, 246 multiply-adds.
// Provenance: nmt 0.1.0, commit b1d5f0d9a708, backend fused, seed 1, epochs 1500, dataset 9636ee68609509b56e59e891665a02e7488e2241af88306025242c084edbf4a2.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.550e-3, worst 1.000.

// language: metal2.1
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct NmtType2 {
    metal::float4x4 inner[12];
};
struct NmtType4 {
    metal::float4x4 inner[8];
};
struct NmtType5 {
    metal::float4 inner[2];
};
struct NmtCodes {
    int first_bits;
    int last_bits;
    int first_log2;
    uint shift;
    uint multiplier;
    uint slope;
};
struct Frame {
    float v0;
    float v1;
    uint width;
};
typedef metal::uint2 NmtType14[1];
struct Varying {
    metal::float4 position;
    float v;
    char _pad2[12];
    metal::float4 color;
};
constant NmtType2 NMT_W1 = NmtType2 {{metal::float4x4(metal::float4(4.633581, 1.5577128, 4.847308, -7.9550843), metal::float4(-0.040778674, 0.30109483, 0.18810418, 0.08001085), metal::float4(0.1270906, -0.113899805, -0.09940042, 0.06291714), metal::float4(-5.239348, 4.4244847, 11.981173, -5.647331)), metal::float4x4(metal::float4(-6.316239, 7.0866685, 0.7747114, -6.249695), metal::float4(-2.8813026, 1.3543744, -2.5794756, -3.425034), metal::float4(-0.14739996, 2.974767, 1.035014, -0.48165968), metal::float4(-0.58785886, 0.50425225, 0.19695403, -0.901528)), metal::float4x4(metal::float4(0.21754104, -2.6533523, 0.27809235, 0.23363206), metal::float4(7.509731, 0.018536674, 5.0530396, -3.8738046), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-3.1414006, 4.4425554, -0.89057094, -1.1077212), metal::float4(-0.059489608, -0.20166463, -0.23307152, -0.11338352), metal::float4(0.05209868, 0.059970256, 0.18867385, 0.09877608), metal::float4(26.519499, 20.081259, -4.729799, -1.1468024)), metal::float4x4(metal::float4(-21.093914, -0.65355283, -12.0057335, 5.4057674), metal::float4(5.5124702, -0.11932348, -2.0397336, -3.026001), metal::float4(-7.544677, -1.4594955, 0.9759642, -4.3099356), metal::float4(-4.8257446, -1.2188243, 4.2050624, 4.96347)), metal::float4x4(metal::float4(0.29272616, 5.196453, 1.3102355, 0.27936175), metal::float4(-0.21944292, 2.4984572, 1.7173952, 1.3231782), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-1.8677667, -0.47189677, 3.3769467, 2.4587243), metal::float4(-0.22109956, 0.060226426, 0.052055903, 0.11305356), metal::float4(0.05001351, 0.039633315, -0.020085853, -0.10174877), metal::float4(-1.739131, 5.6659603, 12.399412, -3.9291306)), metal::float4x4(metal::float4(-23.451077, 3.901157, -12.326258, -16.445658), metal::float4(-2.008173, -3.4493191, -4.080363, -9.312441), metal::float4(-1.5544633, -5.9060125, -1.8305857, -1.870911), metal::float4(1.8193483, 8.248149, 1.6809378, 8.031535)), metal::float4x4(metal::float4(4.5426483, 6.092583, 10.385813, 5.0848346), metal::float4(0.7915796, -2.201602, -0.02491766, 1.6812139), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-6.600309, 0.123911336, 0.0, 0.0), metal::float4(-0.1909336, 0.3993747, 0.0, 0.0), metal::float4(0.13846499, -0.076549605, 0.0, 0.0), metal::float4(9.1780405, -24.788761, 0.0, 0.0)), metal::float4x4(metal::float4(-1.6179283, 4.5265007, 0.0, 0.0), metal::float4(-1.2897608, 3.906312, 0.0, 0.0), metal::float4(1.3081037, 3.0357022, 0.0, 0.0), metal::float4(0.94770765, -3.043183, 0.0, 0.0)), metal::float4x4(metal::float4(-0.08552459, -9.461983, 0.0, 0.0), metal::float4(-6.4232793, 1.3108759, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0))}};
constant NmtType4 NMT_W2 = NmtType4 {{metal::float4x4(metal::float4(1.1419989, -1.4198644, -0.19373854, 0.56172514), metal::float4(-0.75568086, -1.1981204, -0.7734579, 0.29221427), metal::float4(0.072205335, 2.5015967, -0.56138813, -0.7423831), metal::float4(-0.34978172, 1.01927, -0.19402012, 1.2962704)), metal::float4x4(metal::float4(-1.8820454, -0.9988709, -1.0608377, 3.7136261), metal::float4(-0.9074444, 0.100530505, -3.6432486, 0.9728528), metal::float4(-0.07494871, 0.06845625, 0.4569547, 1.2108296), metal::float4(-0.007983513, -1.39181, 2.5139186, -0.68514496)), metal::float4x4(metal::float4(1.1394446, -1.2730776, -0.46546707, -0.12843531), metal::float4(-0.5475997, -0.3343885, -3.3071005, 0.58014804), metal::float4(-1.662909, -1.1193928, 3.9590952, -0.9652814), metal::float4(-3.4225204, 2.9797518, -0.11754079, 0.023971306)), metal::float4x4(metal::float4(3.0399487, 1.6670663, -3.1889777, 2.7175567), metal::float4(0.0562945, 1.1437154, -3.8556113, 0.5253217), metal::float4(2.817947, 0.85403734, 0.7493489, 2.9479167), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(0.4565463, 0.46166718, -7.863282, 0.4971716), metal::float4(2.2395608, -3.3886964, 0.4029314, -4.3679767), metal::float4(-3.5426292, 2.6224256, -2.0955248, -1.2515348), metal::float4(-2.0730424, 0.21992649, 7.2669735, -0.28032577)), metal::float4x4(metal::float4(0.2647249, 2.2715585, 0.21832715, -1.41066), metal::float4(2.2557268, 0.09026979, 0.015854748, 3.7563598), metal::float4(0.4581541, -1.9481311, -0.054118, -0.3657199), metal::float4(0.9714568, -2.4021637, -0.17931756, 0.7629885)), metal::float4x4(metal::float4(-1.542965, 2.8256016, 0.18076795, 3.3432143), metal::float4(0.50801617, 1.5908597, 0.3709236, -3.6185648), metal::float4(-0.8337836, -1.631481, -0.13030158, -6.766812), metal::float4(-3.4649694, -0.792588, -0.10180443, -0.32464153)), metal::float4x4(metal::float4(2.7873704, 0.40408432, 2.34775, -1.3204027), metal::float4(-0.7127589, 1.8839266, -0.15561827, 3.494888), metal::float4(-1.5662805, -7.3176303, -4.491624, -4.135471), metal::float4(0.0, 0.0, 0.0, 0.0))}};
constant NmtType5 NMT_W3 = NmtType5 {{metal::float4(-0.24083899, 0.15409076, 0.13565949, -0.2946874), metal::float4(0.1629475, 0.3656696, -1.2356493, -0.1714698)}};
constant float NMT_B3 = -0.33463305;
constant uint NMT_DEPTH_BITS = 16u;
constant uint NMT_OCTAVE_BITS = 11u;
constant uint NMT_HEAVY = 2u;
constant uint NMT_SLOTS = 4u;
constant float NMT_KEY_SCALE = 0.625;
constant uint NMT_LAST_ABSORBANCE = 27136u;
constant uint NMT_LAST_DEPTH = 65535u;
constant uint NMT_END_BITS = 16u;
constant uint NMT_LINEAR_BITS = 981467136u;
constant float NMT_LINEAR = 0.0009765625;
constant float NMT_OPEN = 0.0;

float nmt_share(
    metal::float3x4 f
) {
    metal::float4 h0_0 = f[0];
    metal::float4 h0_1 = f[1];
    metal::float4 h0_2 = metal::float4(f[2].x, 1.0, 0.0, 0.0);
    metal::float4 h1_0 = metal::max(((metal::float4x4(metal::float4(4.633581, 1.5577128, 4.847308, -7.9550843), metal::float4(-0.040778674, 0.30109483, 0.18810418, 0.08001085), metal::float4(0.1270906, -0.113899805, -0.09940042, 0.06291714), metal::float4(-5.239348, 4.4244847, 11.981173, -5.647331)) * h0_0) + (metal::float4x4(metal::float4(-6.316239, 7.0866685, 0.7747114, -6.249695), metal::float4(-2.8813026, 1.3543744, -2.5794756, -3.425034), metal::float4(-0.14739996, 2.974767, 1.035014, -0.48165968), metal::float4(-0.58785886, 0.50425225, 0.19695403, -0.901528)) * h0_1)) + (metal::float4x4(metal::float4(0.21754104, -2.6533523, 0.27809235, 0.23363206), metal::float4(7.509731, 0.018536674, 5.0530396, -3.8738046), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_1 = metal::max(((metal::float4x4(metal::float4(-3.1414006, 4.4425554, -0.89057094, -1.1077212), metal::float4(-0.059489608, -0.20166463, -0.23307152, -0.11338352), metal::float4(0.05209868, 0.059970256, 0.18867385, 0.09877608), metal::float4(26.519499, 20.081259, -4.729799, -1.1468024)) * h0_0) + (metal::float4x4(metal::float4(-21.093914, -0.65355283, -12.0057335, 5.4057674), metal::float4(5.5124702, -0.11932348, -2.0397336, -3.026001), metal::float4(-7.544677, -1.4594955, 0.9759642, -4.3099356), metal::float4(-4.8257446, -1.2188243, 4.2050624, 4.96347)) * h0_1)) + (metal::float4x4(metal::float4(0.29272616, 5.196453, 1.3102355, 0.27936175), metal::float4(-0.21944292, 2.4984572, 1.7173952, 1.3231782), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_2 = metal::max(((metal::float4x4(metal::float4(-1.8677667, -0.47189677, 3.3769467, 2.4587243), metal::float4(-0.22109956, 0.060226426, 0.052055903, 0.11305356), metal::float4(0.05001351, 0.039633315, -0.020085853, -0.10174877), metal::float4(-1.739131, 5.6659603, 12.399412, -3.9291306)) * h0_0) + (metal::float4x4(metal::float4(-23.451077, 3.901157, -12.326258, -16.445658), metal::float4(-2.008173, -3.4493191, -4.080363, -9.312441), metal::float4(-1.5544633, -5.9060125, -1.8305857, -1.870911), metal::float4(1.8193483, 8.248149, 1.6809378, 8.031535)) * h0_1)) + (metal::float4x4(metal::float4(4.5426483, 6.092583, 10.385813, 5.0848346), metal::float4(0.7915796, -2.201602, -0.02491766, 1.6812139), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_3 = metal::max(((metal::float4x4(metal::float4(-6.600309, 0.123911336, 0.0, 0.0), metal::float4(-0.1909336, 0.3993747, 0.0, 0.0), metal::float4(0.13846499, -0.076549605, 0.0, 0.0), metal::float4(9.1780405, -24.788761, 0.0, 0.0)) * h0_0) + (metal::float4x4(metal::float4(-1.6179283, 4.5265007, 0.0, 0.0), metal::float4(-1.2897608, 3.906312, 0.0, 0.0), metal::float4(1.3081037, 3.0357022, 0.0, 0.0), metal::float4(0.94770765, -3.043183, 0.0, 0.0)) * h0_1)) + (metal::float4x4(metal::float4(-0.08552459, -9.461983, 0.0, 0.0), metal::float4(-6.4232793, 1.3108759, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0)) + metal::float4(0.0, 0.0, 1.0, 0.0);
    metal::float4 h2_0 = metal::max((((metal::float4x4(metal::float4(1.1419989, -1.4198644, -0.19373854, 0.56172514), metal::float4(-0.75568086, -1.1981204, -0.7734579, 0.29221427), metal::float4(0.072205335, 2.5015967, -0.56138813, -0.7423831), metal::float4(-0.34978172, 1.01927, -0.19402012, 1.2962704)) * h1_0) + (metal::float4x4(metal::float4(-1.8820454, -0.9988709, -1.0608377, 3.7136261), metal::float4(-0.9074444, 0.100530505, -3.6432486, 0.9728528), metal::float4(-0.07494871, 0.06845625, 0.4569547, 1.2108296), metal::float4(-0.007983513, -1.39181, 2.5139186, -0.68514496)) * h1_1)) + (metal::float4x4(metal::float4(1.1394446, -1.2730776, -0.46546707, -0.12843531), metal::float4(-0.5475997, -0.3343885, -3.3071005, 0.58014804), metal::float4(-1.662909, -1.1193928, 3.9590952, -0.9652814), metal::float4(-3.4225204, 2.9797518, -0.11754079, 0.023971306)) * h1_2)) + (metal::float4x4(metal::float4(3.0399487, 1.6670663, -3.1889777, 2.7175567), metal::float4(0.0562945, 1.1437154, -3.8556113, 0.5253217), metal::float4(2.817947, 0.85403734, 0.7493489, 2.9479167), metal::float4(0.0, 0.0, 0.0, 0.0)) * h1_3), metal::float4(0.0));
    metal::float4 h2_1 = metal::max((((metal::float4x4(metal::float4(0.4565463, 0.46166718, -7.863282, 0.4971716), metal::float4(2.2395608, -3.3886964, 0.4029314, -4.3679767), metal::float4(-3.5426292, 2.6224256, -2.0955248, -1.2515348), metal::float4(-2.0730424, 0.21992649, 7.2669735, -0.28032577)) * h1_0) + (metal::float4x4(metal::float4(0.2647249, 2.2715585, 0.21832715, -1.41066), metal::float4(2.2557268, 0.09026979, 0.015854748, 3.7563598), metal::float4(0.4581541, -1.9481311, -0.054118, -0.3657199), metal::float4(0.9714568, -2.4021637, -0.17931756, 0.7629885)) * h1_1)) + (metal::float4x4(metal::float4(-1.542965, 2.8256016, 0.18076795, 3.3432143), metal::float4(0.50801617, 1.5908597, 0.3709236, -3.6185648), metal::float4(-0.8337836, -1.631481, -0.13030158, -6.766812), metal::float4(-3.4649694, -0.792588, -0.10180443, -0.32464153)) * h1_2)) + (metal::float4x4(metal::float4(2.7873704, 0.40408432, 2.34775, -1.3204027), metal::float4(-0.7127589, 1.8839266, -0.15561827, 3.494888), metal::float4(-1.5662805, -7.3176303, -4.491624, -4.135471), metal::float4(0.0, 0.0, 0.0, 0.0)) * h1_3), metal::float4(0.0));
    float logit = (NMT_B3 + metal::dot(metal::float4(-0.24083899, 0.15409076, 0.13565949, -0.2946874), h2_0)) + metal::dot(metal::float4(0.1629475, 0.3656696, -1.2356493, -0.1714698), h2_1);
    return 1.0 / (1.0 + metal::exp(metal::min(-(logit), 80.0)));
}

float nmt_transmittance(
    metal::float3x4 f_1
) {
    float absorbance_2 = metal::max(metal::exp(metal::min(f_1[0].z, 40.0)) - 0.05, 0.0);
    float _e10 = nmt_share(f_1);
    return metal::exp(-(metal::min(absorbance_2 * _e10, 80.0)));
}

int nmt_core_log2(
    int bits
) {
    int m = bits & 8388607;
    int h = m >> 11u;
    int l = m & 2047;
    int t = as_type<int>(as_type<uint>(as_type<int>(as_type<uint>(h) * as_type<uint>(as_type<int>(as_type<uint>(4096) - as_type<uint>(h)))) >> 1u) + as_type<uint>(as_type<int>(as_type<uint>(l) * as_type<uint>(as_type<int>(as_type<uint>(2048) - as_type<uint>(h)))) >> 11u));
    return as_type<int>(as_type<uint>(bits) + as_type<uint>(as_type<int>(as_type<uint>(11) * as_type<uint>(t)) >> 5u));
}

uint naga_div(uint lhs, uint rhs) {
    return lhs / metal::select(rhs, 1u, rhs == 0u);
}

uint naga_f2u32(float value) {
    return static_cast<uint>(metal::clamp(value, 0.0, 4294967000.0));
}

NmtCodes nmt_core_codes(
    float v0,
    float v1
) {
    int first = as_type<int>(v0);
    int last = as_type<int>(v1);
    int _e4 = nmt_core_log2(first);
    int _e5 = nmt_core_log2(last);
    uint range = static_cast<uint>(as_type<int>(as_type<uint>(_e5) - as_type<uint>(_e4)));
    uint shift = metal::max(32u - metal::clz(range), 17u) - 17u;
    uint multiplier = naga_div(2147483648u, (range >> shift) + 1u);
    uint slope = metal::min(naga_f2u32(static_cast<float>(range >> 8u) * NMT_KEY_SCALE), 38399u);
    return NmtCodes {first, last, _e4, shift, multiplier, slope};
}

float nmt_core_absorbance_of(
    float alpha
) {
    return -(metal::log(metal::max(1.0 - alpha, 0.00004539993)));
}

metal::uint2 nmt_core_steps(
    float v,
    float absorbance,
    NmtCodes codes
) {
    int _e7 = nmt_core_log2(metal::clamp(as_type<int>(v), codes.first_bits, codes.last_bits));
    uint w = static_cast<uint>(as_type<int>(as_type<uint>(_e7) - as_type<uint>(codes.first_log2))) >> codes.shift;
    uint a = as_type<uint>(metal::clamp(absorbance, 0.0, 10.0) + NMT_LINEAR) - NMT_LINEAR_BITS;
    return metal::uint2((w * codes.multiplier) >> 15u, (a + 2048u) >> 12u);
}

float nmt_core_depth(
    metal::uint2 steps
) {
    return (static_cast<float>((2u * steps.x) + 1u) * 0.000015258789) - 1.0;
}

float nmt_core_absorbance(
    metal::uint2 steps_1
) {
    return as_type<float>(NMT_LINEAR_BITS + (steps_1.y << 12u)) - NMT_LINEAR;
}

metal::uint2 nmt_core_nearest_steps(
    uint code
) {
    return metal::uint2(NMT_LAST_DEPTH - (code >> NMT_END_BITS), code & 65535u);
}

metal::uint2 nmt_core_farthest_steps(
    uint code_1
) {
    return metal::uint2(code_1 >> NMT_END_BITS, code_1 & 65535u);
}

metal::uint2 nmt_core_heavy_steps(
    uint code_2,
    NmtCodes codes_1
) {
    uint nearness = code_2 & NMT_LAST_DEPTH;
    uint key = code_2 >> NMT_DEPTH_BITS;
    return metal::uint2(NMT_LAST_DEPTH - nearness, key - ((nearness * codes_1.slope) >> NMT_DEPTH_BITS));
}

metal::float2 nmt_core_bounds(
    float x,
    float m1,
    float m2,
    float m3,
    float m4
) {
    float mean = m1 * 0.9999;
    float second = (m2 * 0.9999) + 0.000033333334;
    float third = m3 * 0.9999;
    float square = mean * mean;
    float variance = metal::max(second - square, 0.0000001);
    float per_deviation = 1.0 / metal::sqrt(variance);
    float per_variance = per_deviation * per_deviation;
    float skewness = metal::clamp(((third - (mean * ((3.0 * second) - (2.0 * square)))) * per_variance) * per_deviation, -30.0, 30.0);
    float d = metal::clamp(((((((m4 * 0.9999) + 0.00002) - (mean * ((4.0 * third) - (mean * ((6.0 * second) - (3.0 * square)))))) * per_variance) * per_variance) - (skewness * skewness)) - 1.0, 0.001, 10000.0);
    float y = (x - mean) * per_deviation;
    float q = ((y * (y - skewness)) - 1.0) / d;
    float at = 1.0 / ((1.0 + (y * y)) + ((q * q) * d));
    float rest = 1.0 - at;
    float linear = y - (q * skewness);
    float per_root = 1.0 / metal::sqrt(metal::max((linear * linear) - ((4.0 * q) * (1.0 - q)), 0.000000000001));
    float between = metal::clamp(((0.5 * rest) * (1.0 + (linear * per_root))) - (((at * y) * q) * per_root), 0.0, rest);
    float lower = (0.0 > q) ? between : ((y > (0.5 * skewness)) ? rest : 0.0);
    return metal::float2(lower, lower + at);
}

float nmt_core_weigh(
    float z,
    float absorbance_1,
    metal::float4 depths0,
    metal::float4 absorbances0,
    float n,
    float b0,
    metal::float4 moments
) {
    bool local = {};
    bool local_1 = {};
    bool local_2 = {};
    bool local_3 = {};
    bool local_4 = {};
    bool local_5 = {};
    bool local_6 = {};
    float front = 0.0 + ((z > depths0.x) ? absorbances0.x : 0.0);
    if (depths0.x == z) {
        local = absorbances0.x == absorbance_1;
    } else {
        local = false;
    }
    bool _e21 = local;
    float in_core = _e21 ? 1.0 : 0.0;
    float count = n - ((absorbances0.x > 0.0) ? 1.0 : 0.0);
    float rest0 = b0 - absorbances0.x;
    float rest1 = moments.x - (absorbances0.x * depths0.x);
    float rest2 = moments.y - ((absorbances0.x * depths0.x) * depths0.x);
    float rest3 = moments.z - (((absorbances0.x * depths0.x) * depths0.x) * depths0.x);
    float rest4 = moments.w - ((((absorbances0.x * depths0.x) * depths0.x) * depths0.x) * depths0.x);
    float front_2 = front + ((z > depths0.y) ? absorbances0.y : 0.0);
    if (depths0.y == z) {
        local_1 = absorbances0.y == absorbance_1;
    } else {
        local_1 = false;
    }
    bool _e79 = local_1;
    float in_core_2 = _e79 ? 1.0 : in_core;
    float count_2 = count - ((absorbances0.y > 0.0) ? 1.0 : 0.0);
    float rest0_2 = rest0 - absorbances0.y;
    float rest1_2 = rest1 - (absorbances0.y * depths0.y);
    float rest2_2 = rest2 - ((absorbances0.y * depths0.y) * depths0.y);
    float rest3_2 = rest3 - (((absorbances0.y * depths0.y) * depths0.y) * depths0.y);
    float rest4_2 = rest4 - ((((absorbances0.y * depths0.y) * depths0.y) * depths0.y) * depths0.y);
    float front_3 = front_2 + ((z > depths0.z) ? absorbances0.z : 0.0);
    if (depths0.z == z) {
        local_2 = absorbances0.z == absorbance_1;
    } else {
        local_2 = false;
    }
    bool _e132 = local_2;
    float in_core_3 = _e132 ? 1.0 : in_core_2;
    float count_3 = count_2 - ((absorbances0.z > 0.0) ? 1.0 : 0.0);
    float rest0_3 = rest0_2 - absorbances0.z;
    float rest1_3 = rest1_2 - (absorbances0.z * depths0.z);
    float rest2_3 = rest2_2 - ((absorbances0.z * depths0.z) * depths0.z);
    float rest3_3 = rest3_2 - (((absorbances0.z * depths0.z) * depths0.z) * depths0.z);
    float rest4_3 = rest4_2 - ((((absorbances0.z * depths0.z) * depths0.z) * depths0.z) * depths0.z);
    float front_4 = front_3 + ((z > depths0.w) ? absorbances0.w : 0.0);
    if (depths0.w == z) {
        local_3 = absorbances0.w == absorbance_1;
    } else {
        local_3 = false;
    }
    bool _e185 = local_3;
    float in_core_4 = _e185 ? 1.0 : in_core_3;
    float count_4 = count_3 - ((absorbances0.w > 0.0) ? 1.0 : 0.0);
    float rest0_4 = rest0_3 - absorbances0.w;
    float rest1_4 = rest1_3 - (absorbances0.w * depths0.w);
    float rest2_4 = rest2_3 - ((absorbances0.w * depths0.w) * depths0.w);
    float rest3_4 = rest3_3 - (((absorbances0.w * depths0.w) * depths0.w) * depths0.w);
    float rest4_4 = rest4_3 - ((((absorbances0.w * depths0.w) * depths0.w) * depths0.w) * depths0.w);
    float far = (absorbances0.y > 0.0) ? depths0.y : depths0.x;
    float center = 0.5 * (depths0.x + far);
    float half_range = metal::max(0.5 * (far - depths0.x), 0.000015258789);
    float per_h = 1.0 / half_range;
    float moved1 = (rest1_4 - (center * rest0_4)) * per_h;
    float moved2 = ((rest2_4 - (center * rest1_4)) - (center * (rest1_4 - (center * rest0_4)))) * (per_h * per_h);
    float moved3 = (((rest3_4 - (center * rest2_4)) - (center * (rest2_4 - (center * rest1_4)))) - (center * ((rest2_4 - (center * rest1_4)) - (center * (rest1_4 - (center * rest0_4)))))) * ((per_h * per_h) * per_h);
    float moved4 = ((((rest4_4 - (center * rest3_4)) - (center * (rest3_4 - (center * rest2_4)))) - (center * ((rest3_4 - (center * rest2_4)) - (center * (rest2_4 - (center * rest1_4)))))) - (center * (((rest3_4 - (center * rest2_4)) - (center * (rest2_4 - (center * rest1_4)))) - (center * ((rest2_4 - (center * rest1_4)) - (center * (rest1_4 - (center * rest0_4)))))))) * (((per_h * per_h) * per_h) * per_h);
    float x_1 = metal::clamp((z - center) * per_h, -1.0, 1.0);
    float removed = (in_core_4 == 0.0) ? absorbance_1 : 0.0;
    float tail0 = rest0_4 - removed;
    float tail1 = moved1 - (removed * x_1);
    float tail2 = moved2 - ((removed * x_1) * x_1);
    float tail3 = moved3 - (((removed * x_1) * x_1) * x_1);
    float tail4 = moved4 - ((((removed * x_1) * x_1) * x_1) * x_1);
    float others = count_4 - ((removed > 0.0) ? 1.0 : 0.0);
    float absorbance_of_tail = metal::clamp(tail0, 0.0, 1000000000000000000000000000000.0);
    float per_b0 = 1.0 / metal::max(tail0, 0.000000000001);
    float m1_1 = metal::clamp(tail1 * per_b0, -1.0, 1.0);
    float m2_1 = metal::clamp(tail2 * per_b0, -1.0, 1.0);
    float m3_1 = metal::clamp(tail3 * per_b0, -1.0, 1.0);
    float m4_1 = metal::clamp(tail4 * per_b0, -1.0, 1.0);
    float own_step = per_h * 0.000030517578;
    float noise = ((b0 / metal::max(absorbance_of_tail, 0.000000000001)) * (per_h + (metal::abs(center) * per_h))) * 0.0000019073486;
    float exact = metal::clamp(((x_1 - m1_1) - (own_step * 0.25)) / ((own_step * 0.5) + noise), 0.0, 1.0);
    float variance_1 = metal::max(m2_1 - (m1_1 * m1_1), 0.000000001);
    float sum = metal::clamp(((m3_1 - ((3.0 * m1_1) * m2_1)) + (((2.0 * m1_1) * m1_1) * m1_1)) / variance_1, -2.0, 2.0);
    float root = metal::sqrt((sum * sum) + (4.0 * variance_1));
    float near = 0.5 * (sum - root);
    float far_2 = 0.5 * (sum + root);
    float of_near = metal::clamp(far_2 / root, 0.0, 1.0);
    float exact_2 = (others > 1.5) ? ((of_near * metal::clamp((((x_1 - m1_1) - near) - (own_step * 0.25)) / ((own_step * 0.5) + (noise + (noise / metal::max(metal::sqrt(variance_1), 0.0001)))), 0.0, 1.0)) + ((1.0 - of_near) * metal::clamp((((x_1 - m1_1) - far_2) - (own_step * 0.25)) / ((own_step * 0.5) + (noise + (noise / metal::max(metal::sqrt(variance_1), 0.0001)))), 0.0, 1.0))) : exact;
    float exact_3 = (z >= far) ? 1.0 : exact_2;
    if (!((others < 0.5))) {
        local_4 = z <= depths0.x;
    } else {
        local_4 = true;
    }
    bool _e465 = local_4;
    float exact_4 = _e465 ? 0.0 : exact_3;
    if (!((others < 2.5))) {
        local_5 = z >= far;
    } else {
        local_5 = true;
    }
    bool _e475 = local_5;
    if (!(_e475)) {
        local_6 = z <= depths0.x;
    } else {
        local_6 = true;
    }
    bool _e482 = local_6;
    if (_e482) {
        float known = metal::min(metal::exp(-((front_4 + (absorbance_of_tail * exact_4)))), 1.0);
        return known;
    }
    metal::float2 _e489 = nmt_core_bounds(x_1, m1_1, m2_1, m3_1, m4_1);
    float mean_1 = metal::clamp(m1_1 * 1.0, -1.0, 1.0);
    float mean_2 = metal::clamp((m1_1 - m3_1) * (1.0 / metal::max(1.0 - m2_1, 0.000001)), -1.0, 1.0);
    if (false) {
        float bounds_noise = ((((((b0 / metal::max(absorbance_of_tail, 0.000000000001)) * (((1.0 + metal::abs(center)) * per_h) + 1.0)) * 0.00000047683716) * (((1.0 + metal::abs(center)) * per_h) + 1.0)) * (((1.0 + metal::abs(center)) * per_h) + 1.0)) * (((1.0 + metal::abs(center)) * per_h) + 1.0)) / (metal::max(metal::clamp(((m2_1 * 1.0) - (mean_1 * mean_1)) / metal::max(1.0 - (mean_1 * mean_1), 0.000001), 0.0, 1.0) * (1.0 - (mean_1 * mean_1)), 0.0000001) * metal::max(metal::clamp(((m2_1 * 1.0) - (mean_1 * mean_1)) / metal::max(1.0 - (mean_1 * mean_1), 0.000001), 0.0, 1.0) * (1.0 - (mean_1 * mean_1)), 0.0000001));
        float most = metal::min(metal::exp(-((front_4 + (absorbance_of_tail * metal::max(_e489.x - bounds_noise, 0.0))))), 1.0);
        float least = metal::min(metal::exp(-((front_4 + (absorbance_of_tail * metal::min(_e489.y + bounds_noise, 1.0))))), 1.0);
        if ((most - least) <= NMT_OPEN) {
            float middle = 0.5 * (most + least);
            return middle;
        }
    }
    float _e658 = nmt_transmittance(metal::float3x4(metal::float4(x_1, (metal::log2(others) * 0.33333334) - 1.0, metal::log(absorbance_of_tail + 0.05), _e489.x), metal::float4(_e489.y, mean_1, metal::clamp(((m2_1 * 1.0) - (mean_1 * mean_1)) / metal::max(1.0 - (mean_1 * mean_1), 0.000001), 0.0, 1.0), mean_2), metal::float4(metal::sqrt(metal::clamp((((m2_1 - m4_1) * (1.0 / metal::max(1.0 - m2_1, 0.000001))) - (mean_2 * mean_2)) / metal::max(1.0 - (mean_2 * mean_2), 0.000001), 0.0, 1.0)), 0.0, 0.0, 0.0)));
    return metal::exp(-(front_4)) * _e658;
}

metal::float2 nmt_core_slot(
    uint code_3,
    metal::uint2 steps_2
) {
    float _e4 = nmt_core_depth(steps_2);
    float _e5 = nmt_core_absorbance(steps_2);
    return (code_3 > 0u) ? metal::float2(_e4, _e5) : metal::float2(0.0);
}

float nmt_core_transmittance(
    metal::uint2 steps_3,
    NmtCodes codes_2,
    metal::uint4 core0,
    float n_1,
    float b0_1,
    metal::float4 moments_1
) {
    metal::uint2 _e8 = nmt_core_nearest_steps(core0.x);
    metal::float2 _e9 = nmt_core_slot(core0.x, _e8);
    metal::uint2 _e12 = nmt_core_farthest_steps(core0.y);
    metal::float2 _e13 = nmt_core_slot(core0.y, _e12);
    metal::uint2 _e16 = nmt_core_heavy_steps(core0.z, codes_2);
    metal::float2 _e17 = nmt_core_slot(core0.z, _e16);
    metal::uint2 _e20 = nmt_core_heavy_steps(core0.w, codes_2);
    metal::float2 _e21 = nmt_core_slot(core0.w, _e20);
    float _e22 = nmt_core_depth(steps_3);
    float _e23 = nmt_core_absorbance(steps_3);
    float _e34 = nmt_core_weigh(_e22, _e23, metal::float4(_e9.x, _e13.x, _e17.x, _e21.x), metal::float4(_e9.y, _e13.y, _e17.y, _e21.y), n_1, b0_1, moments_1);
    return _e34;
}
metal::uint2 naga_f2u32(metal::float2 value) {
    return static_cast<metal::uint2>(metal::clamp(value, 0.0, 4294967000.0));
}


struct pass2_Input {
    float v_1 [[user(loc0), center_perspective]];
    metal::float4 color [[user(loc1), center_perspective]];
};
struct pass2_Output {
    metal::float4 member [[color(0)]];
};
fragment pass2_Output pass2(
  pass2_Input varyings [[stage_in]]
, metal::float4 position [[position]]
, constant Frame& frame [[buffer(0)]]
, metal::texture2d<float, metal::access::sample> sums0_texture [[texture(0)]]
, metal::texture2d<float, metal::access::sample> sums1_texture [[texture(1)]]
, device NmtType14 const& core [[buffer(2)]]
) {
    const Varying in = { position, varyings.v_1, {}, varyings.color };
    float _e3 = frame.v0;
    float _e6 = frame.v1;
    NmtCodes _e7 = nmt_core_codes(_e3, _e6);
    float _e11 = nmt_core_absorbance_of(in.color.w);
    metal::uint2 _e12 = nmt_core_steps(in.v, _e11, _e7);
    metal::uint2 at_1 = naga_f2u32(in.position.xy);
    uint _e20 = frame.width;
    uint first_1 = 2u * ((at_1.y * _e20) + at_1.x);
    metal::float4 sums0 = sums0_texture.read(metal::uint2(at_1), 0);
    metal::float4 sums1 = sums1_texture.read(metal::uint2(at_1), 0);
    metal::float4 moments_2 = metal::float4(sums0.y, sums0.z, sums0.w, sums1.x);
    metal::uint2 _e38 = core[first_1];
    metal::uint2 _e43 = core[first_1 + 1u];
    float _e47 = nmt_core_transmittance(_e12, _e7, metal::uint4(_e38, _e43), sums1.y, sums0.x, moments_2);
    float weight = in.color.w * _e47;
    return pass2_Output { metal::float4(weight * in.color.xyz, weight) };
}
