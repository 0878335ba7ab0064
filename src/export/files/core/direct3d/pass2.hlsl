// Direct3D, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Factors ONE, D3D12_BLEND_OP_ADD; target DXGI_FORMAT_R16G16B16A16_FLOAT or R32G32B32A32_FLOAT, cleared to 0. Textures:
// the targets of pass 1; behind them the buffer of pass 1, as pairs.
//
%include nmt_core_transmittance nmt_core_codes nmt_core_steps nmt_core_absorbance_of

cbuffer Frame : register(b0) {
    float2 v_range;
    uint width;
};

%sums Texture2D<float4> sums{i}_texture : register(t{i});
StructuredBuffer<uint2> core : register(t{range});

struct Varying {
    float4 position : SV_Position;
    float v : DEPTH;
    float4 color : COLOR;
};

float4 pass2(Varying input) : SV_Target {
    NmtCodes codes = nmt_core_codes(v_range.x, v_range.y);
    uint2 steps = nmt_core_steps(input.v, nmt_core_absorbance_of(input.color.a), codes);
    uint2 pixel = uint2(input.position.xy);
    uint first = {pairs}u * (pixel.y * width + pixel.x);
    int3 at = int3(pixel, 0);
%sums     float4 sums{i} = sums{i}_texture.Load(at);
    float4 moments = float4({moments});
    float T = nmt_core_transmittance(steps, codes, {slots}, {n}, {b0}, moments);
    float weight = input.color.a * T;
    return float4(weight * input.color.rgb, weight);
}
