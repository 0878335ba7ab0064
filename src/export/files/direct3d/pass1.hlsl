// Direct3D, pass 1: draw every transparent surface, in any order, without writing depth.
//
// IndependentBlendEnable; all factors ONE; D3D12_BLEND_OP_ADD, and D3D12_BLEND_OP_MAX for target {range}.
%sums // Target {i}: {dxformat{i}}, cleared to 0.
// Target {range}: DXGI_FORMAT_R32G32_FLOAT, cleared to -3e38.
//
%include nmt_pass1

%log cbuffer Frame : register(b0) {
%log     // Least and greatest distance along the view direction of what is transparent.
%log     float2 v_range;
%log };
%log
struct Varying {
    float4 position : SV_Position;
%log     // Distance along the view direction.
%log     float v : DEPTH;
    // Not premultiplied.
    float4 color : COLOR;
};

struct Targets {
%sums     float4 sums{i} : SV_Target{i};
    float4 range : SV_Target{range};
};

Targets pass1(Varying input) {
%log     NmtSums sums = nmt_pass1(input.v, v_range.x, v_range.y, input.color.a);
%window     NmtSums sums = nmt_pass1(input.position.z, input.color.a);
    Targets targets;
%sums     targets.sums{i} = sums.sums{i};
    targets.range = sums.range;
    return targets;
}
