// Direct3D, resolve: draw three vertices of `everywhere` over the opaque image, D3D12_BLEND_OP_ADD, source factor ONE,
// destination factor SRC_ALPHA.
//
// Textures: target 0 of pass 1, then the target of pass 2.
//
%include nmt_resolve

Texture2D<float4> sums0_texture : register(t0);
Texture2D<float4> weighted_texture : register(t1);

float4 everywhere(uint i : SV_VertexID) : SV_Position {
    return float4(float(i & 1u) * 4.0 - 1.0, float(i >> 1u) * 4.0 - 1.0, 0.5, 1.0);
}

float4 resolve(float4 position : SV_Position) : SV_Target {
    int3 at = int3(int2(position.xy), 0);
    return nmt_resolve(weighted_texture.Load(at), sums0_texture.Load(at));
}
