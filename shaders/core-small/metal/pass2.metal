// Metal, by naga from WGSL, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Target 0: rgba16float or rgba32float, blend add, factors one and one, cleared to 0.
// Textures: the targets of pass 1. Buffer 2: that of pass 1. Buffer 0: the uniforms.
//
// Neural moment transparency: network 'core-small', 9-14-8-1, 246 multiply-adds.
// Provenance: nmt 0.1.0, commit a848199e5c6e, backend fused, seed 1, epochs 1500, dataset 4cb0c11bc9538ca61a2ffd6e935d976f36720f667fe3b7ae3813684c758f300e.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.533e-3, worst 1.000.

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
typedef metal::uint2 NmtType15[1];
struct Varying {
    metal::float4 position;
    float v;
    char _pad2[12];
    metal::float4 color;
};
constant NmtType2 NMT_W1 = NmtType2 {{metal::float4x4(metal::float4(4.8778276, -0.7319692, 3.6530824, -1.6481752), metal::float4(-0.24516319, -0.27494642, -0.023510791, 0.11400228), metal::float4(0.228575, 0.25520048, 0.13499178, -0.10372328), metal::float4(-0.5467422, 2.6183908, 8.650195, -1.3826258)), metal::float4x4(metal::float4(-5.8551807, -1.0576799, 2.7924774, -8.082505), metal::float4(-2.5652757, 2.1842368, -0.101185136, 0.8496825), metal::float4(0.11754783, 1.1701148, 0.4261731, 1.0241573), metal::float4(-0.5958086, 0.81029135, -0.8975072, -1.8926371)), metal::float4x4(metal::float4(1.3035642, -0.14273503, -0.14144559, 2.2584605), metal::float4(5.9671373, 1.4847919, 3.1871316, 1.8420736), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-3.098758, 2.3643606, 1.9390315, -0.025061242), metal::float4(0.013713428, 0.24798474, -0.17473, 0.1092438), metal::float4(-0.016801622, -0.1513876, 0.054045714, -0.00874805), metal::float4(14.739972, -164.7957, 7.3871503, -26.957058)), metal::float4x4(metal::float4(-8.423298, -16.265095, -6.763347, -3.6461272), metal::float4(5.1973667, -6.2610235, -5.804388, -0.79259384), metal::float4(-5.0187683, -2.1178577, -0.1445185, -0.47444504), metal::float4(-5.852785, 4.4160266, 4.6112943, -0.07370595)), metal::float4x4(metal::float4(0.495891, 6.758663, -0.74108994, -2.9599438), metal::float4(-0.9314051, 1.3079683, 2.440642, 4.655624), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-7.4299335, -0.2297995, -3.6704452, 3.7584605), metal::float4(-0.10068613, 0.116125256, -0.20114587, 0.06323509), metal::float4(0.11217993, -0.048117194, 0.16280521, 0.034884017), metal::float4(1.0506787, 10.068197, 13.049514, -17.764614)), metal::float4x4(metal::float4(-1.1598299, 6.9126554, -11.887382, -10.6937065), metal::float4(-0.5063457, 1.4594547, 2.707645, -0.41473576), metal::float4(0.3520074, -0.93157744, -5.942758, 7.43136), metal::float4(0.032555133, -0.83957905, 0.4354543, -3.0254202)), metal::float4x4(metal::float4(-0.03307929, 0.2872462, 0.307582, -20.961397), metal::float4(-6.8072767, -1.608604, -0.09493034, 3.3601375), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-3.1927843, -0.7596912, 0.0, 0.0), metal::float4(-0.16797958, -0.28360534, 0.0, 0.0), metal::float4(0.097345725, 0.1268056, 0.0, 0.0), metal::float4(1.7302861, 0.53903437, 0.0, 0.0)), metal::float4x4(metal::float4(0.5574605, -7.9472857, 0.0, 0.0), metal::float4(-2.2368462, 6.9823356, 0.0, 0.0), metal::float4(-3.3104074, -10.6633005, 0.0, 0.0), metal::float4(4.8967834, -6.983885, 0.0, 0.0)), metal::float4x4(metal::float4(5.501963, 0.5043578, 0.0, 0.0), metal::float4(-4.593644, 1.2066915, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0))}};
constant NmtType4 NMT_W2 = NmtType4 {{metal::float4x4(metal::float4(1.7685847, -1.2965266, 0.53486013, -0.29221267), metal::float4(0.5022446, -0.57678044, 2.8619845, 1.1610198), metal::float4(-1.510298, 1.0492433, -2.4719512, 0.69602823), metal::float4(0.4245065, -0.021788223, -2.2097266, 0.45277822)), metal::float4x4(metal::float4(-1.9844544, -4.284621, -2.0162687, 0.80677956), metal::float4(-0.08269256, 0.83371484, 1.4538207, -0.3430089), metal::float4(0.33549848, 1.315723, -2.6486657, -0.9424922), metal::float4(0.6682035, 0.7352949, 0.77444446, 1.5549136)), metal::float4x4(metal::float4(-3.7106292, 1.4094218, -3.0866914, 6.321356), metal::float4(2.9056916, -1.6683085, 2.5197487, -0.12306516), metal::float4(1.8786901, 2.9980502, 0.53554356, 0.6986177), metal::float4(-1.4987996, 0.16394545, -11.833226, -0.9698973)), metal::float4x4(metal::float4(0.105152994, -2.629642, -0.26539943, 0.97390944), metal::float4(0.20291848, -4.665007, -3.2223794, -1.1747206), metal::float4(-3.0591586, 2.422517, -0.3822718, -1.1229484), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-2.5065336, 1.2751687, -3.1727622, 2.6094267), metal::float4(-0.34650132, -0.58315194, -2.036526, -0.97464854), metal::float4(3.4674072, 1.1141264, -2.0562246, -1.5358669), metal::float4(-0.8401374, 1.7635139, 0.88128996, 1.1690073)), metal::float4x4(metal::float4(0.62812424, -0.6253937, 0.07006818, -0.3447436), metal::float4(4.757243, 4.1627517, -0.32235038, 1.8340607), metal::float4(0.95672405, -0.06239507, -0.2886359, -0.745714), metal::float4(-2.170308, -2.8018155, 0.12480712, -2.8756857)), metal::float4x4(metal::float4(-0.46313936, -0.42326838, 13.634587, -0.8679801), metal::float4(-3.8175569, 0.6408508, 0.8411556, 1.3615565), metal::float4(0.9755631, 0.9696179, 0.1144694, 1.0314378), metal::float4(1.4169557, -0.5175313, -0.8745645, -0.68139124)), metal::float4x4(metal::float4(-0.31971556, 0.8106935, 0.48868963, -0.17111878), metal::float4(0.9139772, -0.97476697, -7.719652, -1.006329), metal::float4(4.2278967, -1.388446, -2.153287, 4.008335), metal::float4(0.0, 0.0, 0.0, 0.0))}};
constant NmtType5 NMT_W3 = NmtType5 {{metal::float4(-0.2411506, 0.1824429, 0.16963111, -0.3715353), metal::float4(-0.2563782, 0.3967364, -1.0420152, -0.3345766)}};
constant float NMT_B3 = 0.17377278;
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
    metal::float4 h1_0 = metal::max(((metal::float4x4(metal::float4(4.8778276, -0.7319692, 3.6530824, -1.6481752), metal::float4(-0.24516319, -0.27494642, -0.023510791, 0.11400228), metal::float4(0.228575, 0.25520048, 0.13499178, -0.10372328), metal::float4(-0.5467422, 2.6183908, 8.650195, -1.3826258)) * h0_0) + (metal::float4x4(metal::float4(-5.8551807, -1.0576799, 2.7924774, -8.082505), metal::float4(-2.5652757, 2.1842368, -0.101185136, 0.8496825), metal::float4(0.11754783, 1.1701148, 0.4261731, 1.0241573), metal::float4(-0.5958086, 0.81029135, -0.8975072, -1.8926371)) * h0_1)) + (metal::float4x4(metal::float4(1.3035642, -0.14273503, -0.14144559, 2.2584605), metal::float4(5.9671373, 1.4847919, 3.1871316, 1.8420736), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_1 = metal::max(((metal::float4x4(metal::float4(-3.098758, 2.3643606, 1.9390315, -0.025061242), metal::float4(0.013713428, 0.24798474, -0.17473, 0.1092438), metal::float4(-0.016801622, -0.1513876, 0.054045714, -0.00874805), metal::float4(14.739972, -164.7957, 7.3871503, -26.957058)) * h0_0) + (metal::float4x4(metal::float4(-8.423298, -16.265095, -6.763347, -3.6461272), metal::float4(5.1973667, -6.2610235, -5.804388, -0.79259384), metal::float4(-5.0187683, -2.1178577, -0.1445185, -0.47444504), metal::float4(-5.852785, 4.4160266, 4.6112943, -0.07370595)) * h0_1)) + (metal::float4x4(metal::float4(0.495891, 6.758663, -0.74108994, -2.9599438), metal::float4(-0.9314051, 1.3079683, 2.440642, 4.655624), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_2 = metal::max(((metal::float4x4(metal::float4(-7.4299335, -0.2297995, -3.6704452, 3.7584605), metal::float4(-0.10068613, 0.116125256, -0.20114587, 0.06323509), metal::float4(0.11217993, -0.048117194, 0.16280521, 0.034884017), metal::float4(1.0506787, 10.068197, 13.049514, -17.764614)) * h0_0) + (metal::float4x4(metal::float4(-1.1598299, 6.9126554, -11.887382, -10.6937065), metal::float4(-0.5063457, 1.4594547, 2.707645, -0.41473576), metal::float4(0.3520074, -0.93157744, -5.942758, 7.43136), metal::float4(0.032555133, -0.83957905, 0.4354543, -3.0254202)) * h0_1)) + (metal::float4x4(metal::float4(-0.03307929, 0.2872462, 0.307582, -20.961397), metal::float4(-6.8072767, -1.608604, -0.09493034, 3.3601375), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_3 = metal::max(((metal::float4x4(metal::float4(-3.1927843, -0.7596912, 0.0, 0.0), metal::float4(-0.16797958, -0.28360534, 0.0, 0.0), metal::float4(0.097345725, 0.1268056, 0.0, 0.0), metal::float4(1.7302861, 0.53903437, 0.0, 0.0)) * h0_0) + (metal::float4x4(metal::float4(0.5574605, -7.9472857, 0.0, 0.0), metal::float4(-2.2368462, 6.9823356, 0.0, 0.0), metal::float4(-3.3104074, -10.6633005, 0.0, 0.0), metal::float4(4.8967834, -6.983885, 0.0, 0.0)) * h0_1)) + (metal::float4x4(metal::float4(5.501963, 0.5043578, 0.0, 0.0), metal::float4(-4.593644, 1.2066915, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0)) + metal::float4(0.0, 0.0, 1.0, 0.0);
    metal::float4 h2_0 = metal::max((((metal::float4x4(metal::float4(1.7685847, -1.2965266, 0.53486013, -0.29221267), metal::float4(0.5022446, -0.57678044, 2.8619845, 1.1610198), metal::float4(-1.510298, 1.0492433, -2.4719512, 0.69602823), metal::float4(0.4245065, -0.021788223, -2.2097266, 0.45277822)) * h1_0) + (metal::float4x4(metal::float4(-1.9844544, -4.284621, -2.0162687, 0.80677956), metal::float4(-0.08269256, 0.83371484, 1.4538207, -0.3430089), metal::float4(0.33549848, 1.315723, -2.6486657, -0.9424922), metal::float4(0.6682035, 0.7352949, 0.77444446, 1.5549136)) * h1_1)) + (metal::float4x4(metal::float4(-3.7106292, 1.4094218, -3.0866914, 6.321356), metal::float4(2.9056916, -1.6683085, 2.5197487, -0.12306516), metal::float4(1.8786901, 2.9980502, 0.53554356, 0.6986177), metal::float4(-1.4987996, 0.16394545, -11.833226, -0.9698973)) * h1_2)) + (metal::float4x4(metal::float4(0.105152994, -2.629642, -0.26539943, 0.97390944), metal::float4(0.20291848, -4.665007, -3.2223794, -1.1747206), metal::float4(-3.0591586, 2.422517, -0.3822718, -1.1229484), metal::float4(0.0, 0.0, 0.0, 0.0)) * h1_3), metal::float4(0.0));
    metal::float4 h2_1 = metal::max((((metal::float4x4(metal::float4(-2.5065336, 1.2751687, -3.1727622, 2.6094267), metal::float4(-0.34650132, -0.58315194, -2.036526, -0.97464854), metal::float4(3.4674072, 1.1141264, -2.0562246, -1.5358669), metal::float4(-0.8401374, 1.7635139, 0.88128996, 1.1690073)) * h1_0) + (metal::float4x4(metal::float4(0.62812424, -0.6253937, 0.07006818, -0.3447436), metal::float4(4.757243, 4.1627517, -0.32235038, 1.8340607), metal::float4(0.95672405, -0.06239507, -0.2886359, -0.745714), metal::float4(-2.170308, -2.8018155, 0.12480712, -2.8756857)) * h1_1)) + (metal::float4x4(metal::float4(-0.46313936, -0.42326838, 13.634587, -0.8679801), metal::float4(-3.8175569, 0.6408508, 0.8411556, 1.3615565), metal::float4(0.9755631, 0.9696179, 0.1144694, 1.0314378), metal::float4(1.4169557, -0.5175313, -0.8745645, -0.68139124)) * h1_2)) + (metal::float4x4(metal::float4(-0.31971556, 0.8106935, 0.48868963, -0.17111878), metal::float4(0.9139772, -0.97476697, -7.719652, -1.006329), metal::float4(4.2278967, -1.388446, -2.153287, 4.008335), metal::float4(0.0, 0.0, 0.0, 0.0)) * h1_3), metal::float4(0.0));
    float logit = (NMT_B3 + metal::dot(metal::float4(-0.2411506, 0.1824429, 0.16963111, -0.3715353), h2_0)) + metal::dot(metal::float4(-0.2563782, 0.3967364, -1.0420152, -0.3345766), h2_1);
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

metal::float3 nmt_core_bounds(
    float x,
    float m1,
    float m2,
    float m3,
    float m4
) {
    float mean = m1 * 0.9999;
    float second = (m2 * 0.9999) + 0.000033333334;
    float third = m3 * 0.9999;
    float fourth = (m4 * 0.9999) + 0.00002;
    float square = mean * mean;
    float variance = metal::max(second - square, 0.0000001);
    float per_deviation = 1.0 / metal::sqrt(variance);
    float per_variance = per_deviation * per_deviation;
    float skewness = metal::clamp(((third - (mean * ((3.0 * second) - (2.0 * square)))) * per_variance) * per_deviation, -30.0, 30.0);
    float d = metal::clamp(((((fourth - (mean * ((4.0 * third) - (mean * ((6.0 * second) - (3.0 * square)))))) * per_variance) * per_variance) - (skewness * skewness)) - 1.0, 0.001, 10000.0);
    float y = (x - mean) * per_deviation;
    float per_d = 1.0 / d;
    float q = ((y * (y - skewness)) - 1.0) * per_d;
    float at = 1.0 / ((1.0 + (y * y)) + ((q * q) * d));
    float rest = 1.0 - at;
    float linear = y - (q * skewness);
    float per_root = 1.0 / metal::sqrt(metal::max((linear * linear) - ((4.0 * q) * (1.0 - q)), 0.000000000001));
    float between = metal::clamp(((0.5 * rest) * (1.0 + (linear * per_root))) - (((at * y) * q) * per_root), 0.0, rest);
    float lower = (0.0 > q) ? between : ((y > (0.5 * skewness)) ? rest : 0.0);
    float inner = metal::max(1.0 - second, 0.000001);
    float per_inner = 1.0 / inner;
    float inner_mean = (mean - third) * per_inner;
    float inner_second = (second - fourth) * per_inner;
    float width = metal::max(inner_second - (inner_mean * inner_mean), 0.0000001);
    float place = inner_mean - x;
    float of_inner = width / (width + (place * place));
    float ended = (inner * of_inner) / metal::max(1.0 - (x * x), 0.000001);
    float side = (0.0 > place) ? -1.0 : 1.0;
    float of_fourth = ((inner * (1.0 - of_inner)) * metal::abs(place)) / metal::max((metal::abs(place) + inner_second) - (x * inner_mean), 0.000001);
    float at_end = metal::clamp(0.5 * (((1.0 - (side * mean)) - (ended * (1.0 - (side * x)))) - of_fourth), 0.0, metal::max(1.0 - ended, 0.0));
    float least = (at > ended) ? ((0.0 > place) ? ((1.0 - ended) - at_end) : at_end) : lower;
    float most = (at > ended) ? ended : at;
    return metal::float3(least, least + most, (per_variance * per_variance) * per_d);
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
    metal::float3 _e489 = nmt_core_bounds(x_1, m1_1, m2_1, m3_1, m4_1);
    if (false) {
        float bounds_noise = (((b0 / metal::max(absorbance_of_tail, 0.000000000001)) * (((((1.0 + metal::abs(center)) * per_h) + 1.0) * (((1.0 + metal::abs(center)) * per_h) + 1.0)) * ((((1.0 + metal::abs(center)) * per_h) + 1.0) * (((1.0 + metal::abs(center)) * per_h) + 1.0)))) * _e489.z) * 0.000000014901161;
        float most_1 = metal::min(metal::exp(-((front_4 + (absorbance_of_tail * metal::max(_e489.x - bounds_noise, 0.0))))), 1.0);
        float least_1 = metal::min(metal::exp(-((front_4 + (absorbance_of_tail * metal::min(_e489.y + bounds_noise, 1.0))))), 1.0);
        float opacity = 1.0 - metal::exp(-(absorbance_1));
        if ((opacity * (most_1 - least_1)) <= NMT_OPEN) {
            float middle = 0.5 * (most_1 + least_1);
            return middle;
        }
    }
    float mean_1 = metal::clamp(m1_1 * 1.0, -1.0, 1.0);
    float mean_2 = metal::clamp((m1_1 - m3_1) * (1.0 / metal::max(1.0 - m2_1, 0.000001)), -1.0, 1.0);
    float _e625 = nmt_transmittance(metal::float3x4(metal::float4(x_1, (metal::log2(others) * 0.33333334) - 1.0, metal::log(absorbance_of_tail + 0.05), _e489.x), metal::float4(_e489.y, mean_1, metal::clamp(((m2_1 * 1.0) - (mean_1 * mean_1)) / metal::max(1.0 - (mean_1 * mean_1), 0.000001), 0.0, 1.0), mean_2), metal::float4(metal::sqrt(metal::clamp((((m2_1 - m4_1) * (1.0 / metal::max(1.0 - m2_1, 0.000001))) - (mean_2 * mean_2)) / metal::max(1.0 - (mean_2 * mean_2), 0.000001), 0.0, 1.0)), 0.0, 0.0, 0.0)));
    return metal::exp(-(front_4)) * _e625;
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
, device NmtType15 const& core [[buffer(2)]]
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
