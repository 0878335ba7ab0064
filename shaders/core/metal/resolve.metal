// Metal, by naga from WGSL, resolve: draw three vertices over the opaque image, blend add, source factor one, destination factor
// src-alpha.
//
// Textures of group 0: target 0 of pass 1, then the target of pass 2.
//
// Neural moment transparency: network 'core', 9-32-16-1, 816 multiply-adds.
// Provenance: nmt 0.1.0, commit a848199e5c6e, backend fused, seed 2, epochs 1500, dataset 01b6983dc69ed68b847bc6fa4ad020706782ce5990d348cf55044a5188b5ba4f.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.202e-3, worst 1.000.

// language: metal2.1
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;


metal::float4 nmt_resolve(
    metal::float4 weighted,
    metal::float4 sums0
) {
    float behind = metal::exp(-(sums0.x));
    float scale = (weighted.w > 0.0) ? ((1.0 - behind) / metal::max(weighted.w, 0.0000000000000000000000000000000000001)) : 0.0;
    return metal::float4(scale * weighted.x, scale * weighted.y, scale * weighted.z, behind);
}

struct everywhereInput {
};
struct everywhereOutput {
    metal::float4 member [[position]];
};
vertex everywhereOutput everywhere(
  uint i [[vertex_id]]
) {
    return everywhereOutput { metal::float4((static_cast<float>(i & 1u) * 4.0) - 1.0, (static_cast<float>(i >> 1u) * 4.0) - 1.0, 0.5, 1.0) };
}

metal::int2 naga_f2i32(metal::float2 value) {
    return static_cast<metal::int2>(metal::clamp(value, -2147483600.0, 2147483500.0));
}


struct resolveInput {
};
struct resolveOutput {
    metal::float4 member_1 [[color(0)]];
};
fragment resolveOutput resolve(
  metal::float4 position [[position]]
, metal::texture2d<float, metal::access::sample> sums0_texture [[texture(0)]]
, metal::texture2d<float, metal::access::sample> weighted_texture [[texture(1)]]
) {
    metal::int2 at = naga_f2i32(position.xy);
    metal::float4 _e5 = weighted_texture.read(metal::uint2(at), 0);
    metal::float4 _e8 = sums0_texture.read(metal::uint2(at), 0);
    metal::float4 _e9 = nmt_resolve(_e5, _e8);
    return resolveOutput { _e9 };
}
