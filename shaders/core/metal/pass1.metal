// Metal, by naga from WGSL, pass 1: draw every transparent surface, in any order, without writing depth.
//
// Target 0: rgba32float, blend add, factors one and one, cleared to 0.
// Target 1: rg32float, blend add, factors one and one, cleared to 0.
// Buffer 2: 6 words a pixel, cleared to 0. Buffer 0: the uniforms.
//
// Neural moment transparency: network 'core', 9-32-16-1, 816 multiply-adds.
// Provenance: nmt 0.1.0, commit a848199e5c6e, backend fused, seed 2, epochs 1500, dataset 01b6983dc69ed68b847bc6fa4ad020706782ce5990d348cf55044a5188b5ba4f.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.202e-3, worst 1.000.

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
typedef metal::atomic_uint NmtType6[1];
struct Frame {
    float v0;
    float v1;
    uint width;
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
};
constant uint NMT_DEPTH_BITS = 16u;
constant uint NMT_OCTAVE_BITS = 11u;
constant uint NMT_HEAVY = 4u;
constant uint NMT_SLOTS = 6u;
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

metal::uint2 nmt_core_nearest_steps(
    uint code
) {
    return metal::uint2(NMT_LAST_DEPTH - (code >> NMT_END_BITS), code & 65535u);
}

uint nmt_core_farthest_code(
    metal::uint2 steps_4
) {
    return (steps_4.x << NMT_END_BITS) | steps_4.y;
}

metal::uint2 nmt_core_farthest_steps(
    uint code_1
) {
    return metal::uint2(code_1 >> NMT_END_BITS, code_1 & 65535u);
}

uint nmt_core_heavy_code(
    metal::uint2 steps_5,
    NmtCodes codes_1
) {
    uint nearness = NMT_LAST_DEPTH - steps_5.x;
    return ((steps_5.y + ((nearness * codes_1.slope) >> NMT_DEPTH_BITS)) << NMT_DEPTH_BITS) | nearness;
}

uint nmt_core_offer(
    uint slot,
    uint code_2,
    device NmtType6& nmt_core
) {
    uint _e4 = metal::atomic_load_explicit(&nmt_core[slot], metal::memory_order_relaxed);
    if (_e4 >= code_2) {
        return code_2;
    }
    uint _e8 = metal::atomic_fetch_max_explicit(&nmt_core[slot], code_2, metal::memory_order_relaxed);
    return metal::min(_e8, code_2);
}

void nmt_core_insert(
    uint pixel,
    metal::uint2 steps_6,
    NmtCodes codes_2,
    device NmtType6& nmt_core
) {
    uint code_3 = {};
    bool local = {};
    uint slot_1 = {};
    if (steps_6.y == 0u) {
        return;
    }
    uint first_2 = pixel * NMT_SLOTS;
    uint _e8 = nmt_core_nearest_code(steps_6);
    uint _e9 = nmt_core_offer(first_2, _e8, nmt_core);
    if (_e9 == 0u) {
        return;
    }
    metal::uint2 _e14 = nmt_core_nearest_steps(_e9);
    uint _e15 = nmt_core_farthest_code(_e14);
    uint _e16 = nmt_core_offer(first_2 + 1u, _e15, nmt_core);
    if (_e16 == 0u) {
        return;
    }
    metal::uint2 _e19 = nmt_core_farthest_steps(_e16);
    uint _e20 = nmt_core_heavy_code(_e19, codes_2);
    code_3 = _e20;
    if (true) {
        uint _e31 = metal::atomic_load_explicit(&nmt_core[(first_2 + 1u) + NMT_HEAVY], metal::memory_order_relaxed);
        uint _e32 = code_3;
        local = _e31 >= _e32;
    } else {
        local = true;
    }
    bool _e35 = local;
    if (_e35) {
        return;
    }
    slot_1 = first_2 + 2u;
    bool loop_init = true;
    while(true) {
        if (!loop_init) {
            uint _e52 = slot_1;
            slot_1 = _e52 + 1u;
        }
        loop_init = false;
        uint _e39 = slot_1;
        if (_e39 < ((first_2 + 2u) + NMT_HEAVY)) {
        } else {
            break;
        }
        {
            uint _e45 = slot_1;
            uint _e46 = code_3;
            uint _e47 = nmt_core_offer(_e45, _e46, nmt_core);
            code_3 = _e47;
            uint _e48 = code_3;
            if (_e48 == 0u) {
                return;
            }
        }
    }
    return;
}
metal::uint2 naga_f2u32(metal::float2 value) {
    return static_cast<metal::uint2>(metal::clamp(value, 0.0, 4294967000.0));
}


struct pass1_Input {
    float v_1 [[user(loc0), center_perspective]];
    metal::float4 color [[user(loc1), center_perspective]];
};
struct pass1_Output {
    metal::float4 sums0 [[color(0)]];
    metal::float4 sums1 [[color(1)]];
};
[[early_fragment_tests]]
fragment pass1_Output pass1(
  pass1_Input varyings [[stage_in]]
, metal::float4 position [[position]]
, device NmtType6& nmt_core [[buffer(2)]]
, constant Frame& frame [[buffer(0)]]
) {
    const Varying in = { position, varyings.v_1, {}, varyings.color };
    float _e3 = frame.v0;
    float _e6 = frame.v1;
    NmtCodes _e7 = nmt_core_codes(_e3, _e6);
    float _e11 = nmt_core_absorbance_of(in.color.w);
    metal::uint2 _e12 = nmt_core_steps(in.v, _e11, _e7);
    metal::uint2 at = naga_f2u32(in.position.xy);
    uint _e19 = frame.width;
    nmt_core_insert((at.y * _e19) + at.x, _e12, _e7, nmt_core);
    float _e23 = nmt_core_absorbance(_e12);
    metal::float4 _e24 = nmt_core_moments(_e12);
    float n = (_e12.y > 0u) ? 1.0 : 0.0;
    const auto _tmp = Targets {metal::float4(_e23, _e24.x, _e24.y, _e24.z), metal::float4(_e24.w, n, 0.0, 0.0)};
    return pass1_Output { _tmp.sums0, _tmp.sums1 };
}
