// Metal, by naga from WGSL, pass 1: draw every transparent surface, in any order, without writing depth.
//
// Target 0: rgba32float, blend add, factors one and one, cleared to 0.
// Target 1: rg32float, blend add, factors one and one, cleared to 0.
// Target 2: rg32float, blend max, factors one and one, cleared to -3e38.
//
// Neural moment transparency: network 'paper', 7-32-16-1, 752 multiply-adds.
// Provenance: nmt 0.1.0, commit 122c62af9569, backend fused, seed 1, epochs 1000, dataset 7efe7a15adf78c7d3c08d1766f86933c7206479e931a41fb0eb5cd099252fcd5.
// Measured on fresh pixels of the training distribution: mean squared error of T 5.094e-3, worst 0.657.

// language: metal2.1
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct NmtSums {
    metal::float4 sums0;
    metal::float4 sums1;
    metal::float4 range;
};
struct Varying {
    metal::float4 position;
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

metal::float4 nmt_moments(
    float w,
    float absorbance
) {
    float z = (2.0 * w) - 1.0;
    float b1 = absorbance * z;
    float b2 = b1 * z;
    float b3 = b2 * z;
    float b4 = b3 * z;
    return metal::float4(b1, b2, b3, b4);
}

NmtSums nmt_pass1(
    float w_1,
    float alpha_1
) {
    float _e2 = nmt_absorbance(alpha_1);
    metal::float4 _e3 = nmt_moments(w_1, _e2);
    return NmtSums {metal::float4(_e2, _e3.xyz), metal::float4(_e3.w, 1.0, 0.0, 0.0), metal::float4(-(w_1), w_1, 0.0, 0.0)};
}

struct pass1_Input {
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
) {
    const Varying in = { position, varyings.color };
    NmtSums _e5 = nmt_pass1(in.position.z, in.color.w);
    const auto _tmp = Targets {_e5.sums0, _e5.sums1, _e5.range};
    return pass1_Output { _tmp.sums0, _tmp.sums1, _tmp.range };
}
