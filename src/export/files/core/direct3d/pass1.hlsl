// Direct3D, pass 1: draw every transparent surface, in any order, without writing depth.
//
// Factors ONE, D3D12_BLEND_OP_ADD.
%sums // Target {i}: {dxformat{i}}, cleared to 0.
// Buffer u{range}, behind the targets, whose slots Direct3D 11 shares with it: {words} words a pixel, cleared to 0.
//
%include nmt_core_insert nmt_core_codes nmt_core_steps nmt_core_absorbance_of nmt_core_moments nmt_core_absorbance

cbuffer Frame : register(b0) {
    // Least and greatest distance along the view direction of what is transparent.
    float2 v_range;
    // Columns of the image.
    uint width;
};

struct Varying {
    float4 position : SV_Position;
    // Distance along the view direction.
    float v : DEPTH;
    // Not premultiplied.
    float4 color : COLOR;
};

struct Targets {
%sums     float4 sums{i} : SV_Target{i};
};

// Atomics write even where a depth test behind the shader fails.
[earlydepthstencil]
Targets pass1(Varying input) {
    NmtCodes codes = nmt_core_codes(v_range.x, v_range.y);
    uint2 steps = nmt_core_steps(input.v, nmt_core_absorbance_of(input.color.a), codes);
    uint2 at = uint2(input.position.xy);
    nmt_core_insert(at.y * width + at.x, steps, codes);
    float absorbance = nmt_core_absorbance(steps);
    float4 b = nmt_core_moments(steps);
    float n = steps.y > 0u ? 1.0 : 0.0;
    Targets targets;
%sums     targets.sums{i} = {terms{i}};
    return targets;
}
