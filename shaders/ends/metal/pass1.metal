// Metal, by naga from WGSL, pass 1: draw every transparent surface, in any order, without writing depth.
//
// Target 0: rgba32float, blend add, factors one and one, cleared to 0.
// Target 1: rg32float, blend add, factors one and one, cleared to 0.
// Target 2: rg32float, blend max, factors one and one, cleared to -3e38.
//
// Neural moment transparency: network 'ends', 9-32-16-1, 816 multiply-adds.
// Provenance: nmt 0.1.0, commit a848199e5c6e, backend fused, seed 1, epochs 1500, dataset 8eea3df1bcd36b439cc33c166ec5bf3acdf40f132555cd6c0c5c70ae502afbb9.
// Measured on fresh pixels of the training distribution: mean squared error of T 3.010e-3, worst 1.000.

// language: metal2.1
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct NmtCodes {
    int first_bits;
    int last_bits;
    int first_log2;
    uint shift;
    uint multiplier;
    uint slope;
};
struct NmtSums {
    metal::float4 sums0;
    metal::float4 sums1;
    metal::float4 range;
};
struct Frame {
    float v0;
    float v1;
};
struct Varying {
    metal::float4 position;
    float v;
    char _pad2[12];
    metal::float4 color;
};
struct Targets {
    metal::float4 sums0;
    metal::float4 sums1;
    metal::float4 range;
};
constant uint NMT_DEPTH_BITS = 16u;
constant uint NMT_OCTAVE_BITS = 11u;
constant uint NMT_HEAVY = 0u;
constant uint NMT_SLOTS = 2u;
constant float NMT_KEY_SCALE = 0.625;
constant uint NMT_LAST_ABSORBANCE = 27136u;
constant uint NMT_LAST_DEPTH = 65535u;
constant uint NMT_END_BITS = 16u;
constant uint NMT_LINEAR_BITS = 981467136u;
constant float NMT_LINEAR = 0.0009765625;

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

metal::float4 nmt_core_moments(
    metal::uint2 steps_2
) {
    float _e1 = nmt_core_depth(steps_2);
    float _e2 = nmt_core_absorbance(steps_2);
    float first_1 = _e2 * _e1;
    float second = first_1 * _e1;
    float third = second * _e1;
    return metal::float4(first_1, second, third, third * _e1);
}

uint nmt_core_nearest_code(
    metal::uint2 steps_3
) {
    return ((NMT_LAST_DEPTH - steps_3.x) << NMT_END_BITS) | steps_3.y;
}

uint nmt_core_farthest_code(
    metal::uint2 steps_4
) {
    return (steps_4.x << NMT_END_BITS) | steps_4.y;
}

float nmt_core_end_value(
    uint code
) {
    int rank = as_type<int>(as_type<uint>(static_cast<int>(((code >> NMT_END_BITS) << 15u) | (code & ((1u << 15u) - 1u)))) - as_type<uint>(1073741824));
    return as_type<float>((rank >= 0) ? (8388608u + static_cast<uint>(rank)) : (2155872256u + static_cast<uint>(as_type<int>(as_type<uint>(-1) - as_type<uint>(rank)))));
}

metal::float2 nmt_core_end_values(
    metal::uint2 steps_5
) {
    bool absorbs = steps_5.y > 0u;
    uint _e5 = nmt_core_nearest_code(steps_5);
    float _e7 = nmt_core_end_value(absorbs ? _e5 : 0u);
    uint _e9 = nmt_core_farthest_code(steps_5);
    float _e11 = nmt_core_end_value(absorbs ? _e9 : 0u);
    return metal::float2(_e7, _e11);
}

NmtSums nmt_pass1(
    float v_1,
    float v0_1,
    float v1_1,
    float alpha_1
) {
    NmtSums sums = {};
    float _e4 = nmt_core_absorbance_of(alpha_1);
    NmtCodes _e5 = nmt_core_codes(v0_1, v1_1);
    metal::uint2 _e6 = nmt_core_steps(v_1, _e4, _e5);
    float _e7 = nmt_core_absorbance(_e6);
    metal::float4 _e8 = nmt_core_moments(_e6);
    float n = (_e6.y > 0u) ? 1.0 : 0.0;
    sums.sums0 = metal::float4(_e7, _e8.x, _e8.y, _e8.z);
    sums.sums1 = metal::float4(_e8.w, n, 0.0, 0.0);
    metal::float2 _e27 = nmt_core_end_values(_e6);
    sums.range = metal::float4(_e27, 0.0, 0.0);
    NmtSums _e31 = sums;
    return _e31;
}

struct pass1_Input {
    float v_2 [[user(loc0), center_perspective]];
    metal::float4 color [[user(loc1), center_perspective]];
};
struct pass1_Output {
    metal::float4 sums0 [[color(0)]];
    metal::float4 sums1 [[color(1)]];
    metal::float4 range [[color(2)]];
};
fragment pass1_Output pass1(
  pass1_Input varyings [[stage_in]]
, metal::float4 position [[position]]
, constant Frame& frame [[buffer(0)]]
) {
    const Varying in = { position, varyings.v_2, {}, varyings.color };
    float _e4 = frame.v0;
    float _e7 = frame.v1;
    NmtSums _e10 = nmt_pass1(in.v, _e4, _e7, in.color.w);
    const auto _tmp = Targets {_e10.sums0, _e10.sums1, _e10.range};
    return pass1_Output { _tmp.sums0, _tmp.sums1, _tmp.range };
}
