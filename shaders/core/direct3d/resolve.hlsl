// Direct3D, resolve: draw three vertices of `everywhere` over the opaque image, D3D12_BLEND_OP_ADD, source factor ONE,
// destination factor SRC_ALPHA.
//
// Textures: target 0 of pass 1, then the target of pass 2.
//
// Neural moment transparency: network 'core', 9-32-16-1, 816 multiply-adds.
// Provenance: nmt 0.1.0, commit a848199e5c6e, backend fused, seed 2, epochs 1500, dataset 01b6983dc69ed68b847bc6fa4ad020706782ce5990d348cf55044a5188b5ba4f.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.202e-3, worst 1.000.

// Resolve: what lies over the background, of the sum that pass 2 has made, and in alpha how much of the background
// shows through: result.rgb + result.a * background. As a blend state: source factor one, destination factor source
// alpha.
float4 nmt_resolve(float4 weighted, float4 sums0) {
    float behind = exp(-sums0.x);
    float scale = (weighted.w > 0.0 ? (1.0 - behind) / max(weighted.w, 1e-37) : 0.0);
    return float4(scale * weighted.x, scale * weighted.y, scale * weighted.z, behind);
}

Texture2D<float4> sums0_texture : register(t0);
Texture2D<float4> weighted_texture : register(t1);

float4 everywhere(uint i : SV_VertexID) : SV_Position {
    return float4(float(i & 1u) * 4.0 - 1.0, float(i >> 1u) * 4.0 - 1.0, 0.5, 1.0);
}

float4 resolve(float4 position : SV_Position) : SV_Target {
    int3 at = int3(int2(position.xy), 0);
    return nmt_resolve(weighted_texture.Load(at), sums0_texture.Load(at));
}
