// Direct3D, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Factors ONE, D3D12_BLEND_OP_ADD; target DXGI_FORMAT_R16G16B16A16_FLOAT or R32G32B32A32_FLOAT, cleared to 0. Textures:
// the targets of pass 1.
//
%include nmt_pass2

%log cbuffer Frame : register(b0) {
%log     float2 v_range;
%log };
%log
%sums Texture2D<float4> sums{i}_texture : register(t{i});
Texture2D<float4> range_texture : register(t{range});

struct Varying {
    float4 position : SV_Position;
%log     float v : DEPTH;
    float4 color : COLOR;
};

float4 pass2(Varying input) : SV_Target {
    int3 at = int3(int2(input.position.xy), 0);
    float T = nmt_pass2(
%log         input.v, v_range.x, v_range.y, input.color.a,
%window         input.position.z,
%sums         sums{i}_texture.Load(at),
        range_texture.Load(at));
    float weight = input.color.a * T;
    return float4(weight * input.color.rgb, weight);
}
