// Metal, by naga from WGSL, pass 1: draw every transparent surface, in any order, without writing depth.
//
// Target 0: rgba32float, blend add, factors one and one, cleared to 0.
// Target 1: rg32float, blend add, factors one and one, cleared to 0.
// Target 2: rg32float, blend max, factors one and one, cleared to -3e38.
//
// Neural moment transparency: network 'small', 7-16-8-1, 248 multiply-adds.
// Provenance: nmt 0.1.0, commit 122c62af9569, backend fused, seed 1, epochs 600, dataset b329efeb897a86799fe59c425268dc10595a6b88aa3a06fcbd8c3af287331927.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.593e-3, worst 0.995.

// language: metal2.1
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

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

float nmt_absorbance(
    float alpha
) {
    float faint = alpha * (1.0 + (alpha * (0.5 + (alpha * (0.33333334 + (alpha * (0.25 + (alpha * 0.2))))))));
    return (0.03 > alpha) ? faint : -(metal::log(metal::max(1.0 - alpha, 0.00004539993)));
}

float nmt_log_ratio(
    float a,
    float b
) {
    float s = (a - b) / (a + b);
    float q = s * s;
    return (0.2 > metal::abs(s)) ? ((s + s) * (1.0 + (q * (0.33333334 + (q * (0.2 + (q * (0.14285715 + (q * 0.11111111))))))))) : metal::log(a / b);
}

float nmt_moment_depth(
    float v,
    float v0,
    float v1
) {
    float _e3 = nmt_log_ratio(v, v0);
    float _e6 = nmt_log_ratio(v1, v0);
    return (v1 > v0) ? metal::clamp(((2.0 * _e3) / metal::max(_e6, 0.000000000000000000000000000001)) - 1.0, -1.0, 1.0) : 0.0;
}

metal::float4 nmt_moments(
    float z,
    float absorbance
) {
    float moment1 = absorbance * z;
    float moment2 = moment1 * z;
    float moment3 = moment2 * z;
    float moment4 = moment3 * z;
    return metal::float4(moment1, moment2, moment3, moment4);
}

NmtSums nmt_pass1(
    float v_1,
    float v0_1,
    float v1_1,
    float alpha_1
) {
    float _e4 = nmt_absorbance(alpha_1);
    float _e5 = nmt_moment_depth(v_1, v0_1, v1_1);
    metal::float4 _e6 = nmt_moments(_e5, _e4);
    return NmtSums {metal::float4(_e4, _e6.xyz), metal::float4(_e6.w, 1.0, 0.0, 0.0), metal::float4(-(v_1), v_1, 0.0, 0.0)};
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
