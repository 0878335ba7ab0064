// Direct3D, pass 1 of a core: draw every transparent surface, in any order, without writing depth.
//
// All factors ONE, D3D12_BLEND_OP_ADD. Target 0: DXGI_FORMAT_R32G32B32A32_FLOAT, target 1: DXGI_FORMAT_R32G32_FLOAT,
// cleared to 0. Buffer u2, behind the targets: {slots} words a pixel, cleared to 0.
//
%include nmt_core_insert nmt_core_codes nmt_core_steps nmt_core_absorbance_of nmt_core_moments nmt_core_absorbance

cbuffer Frame : register(b0) {
    // Least and greatest distance along the view direction of what is transparent; columns of the image.
    float2 v_range;
    uint columns;
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

// Opaque depth is tested before the shader, which writes to memory.
[earlydepthstencil]
Targets pass1(Varying input) {
    uint2 at = uint2(input.position.xy);
    NmtCodes codes = nmt_core_codes(v_range.x, v_range.y);
    uint2 steps = nmt_core_steps(input.v, nmt_core_absorbance_of(input.color.a), codes);
    nmt_core_insert(at.x + at.y * columns, steps, codes);
    float4 moments = nmt_core_moments(steps);
    Targets targets;
    targets.sums0 = float4(nmt_core_absorbance(steps), moments.xyz);
    targets.sums1 = float4(moments.w, steps.y > 0u ? 1.0 : 0.0, 0.0, 0.0);
    return targets;
}
