// Direct3D, pass 2 of a core: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Factors ONE, D3D12_BLEND_OP_ADD; target DXGI_FORMAT_R16G16B16A16_FLOAT or R32G32B32A32_FLOAT, cleared to 0. The buffer
// of pass 1, read four words at a time, and its targets; a barrier stands before.
//
%include nmt_core_transmittance nmt_core_codes nmt_core_steps nmt_core_absorbance_of

cbuffer Frame : register(b0) {
    float2 v_range;
    uint columns;
};

StructuredBuffer<uint4> core : register(t0);
Texture2D<float4> sums0_texture : register(t1);
Texture2D<float4> sums1_texture : register(t2);

struct Varying {
    float4 position : SV_Position;
    float v : DEPTH;
    float4 color : COLOR;
};

float4 pass2(Varying input) : SV_Target {
    uint2 at = uint2(input.position.xy);
    uint first = (at.x + at.y * columns) * {vectors}u;
    float4 sums0 = sums0_texture.Load(int3(int2(at), 0));
    float4 sums1 = sums1_texture.Load(int3(int2(at), 0));
    // The same expressions as in pass 1.
    NmtCodes codes = nmt_core_codes(v_range.x, v_range.y);
    uint2 steps = nmt_core_steps(input.v, nmt_core_absorbance_of(input.color.a), codes);
    float T = nmt_core_transmittance(
        steps, codes, {core}, sums1.y, sums0.x, float4(sums0.yzw, sums1.x));
    float weight = input.color.a * T;
    return float4(weight * input.color.rgb, weight);
}
