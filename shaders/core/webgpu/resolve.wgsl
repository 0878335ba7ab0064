// WebGPU, resolve: draw three vertices over the opaque image, blend add, source factor one, destination factor
// src-alpha.
//
// Textures of group 0: target 0 of pass 1, then the target of pass 2.
//
// Neural moment transparency: network 'core', 9-32-16-1, 816 multiply-adds.
// Provenance: nmt 0.1.0, commit a848199e5c6e, backend fused, seed 2, epochs 1500, dataset 01b6983dc69ed68b847bc6fa4ad020706782ce5990d348cf55044a5188b5ba4f.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.202e-3, worst 1.000.

// Resolve: what lies over the background, of the sum that pass 2 has made, and in alpha how much of the background
// shows through: result.rgb + result.a * background. As a blend state: source factor one, destination factor source
// alpha.
fn nmt_resolve(weighted: vec4<f32>, sums0: vec4<f32>) -> vec4<f32> {
    let behind = exp(-sums0.x);
    let scale = select(0.0, (1.0 - behind) / max(weighted.w, 1e-37), weighted.w > 0.0);
    return vec4<f32>(scale * weighted.x, scale * weighted.y, scale * weighted.z, behind);
}

@group(0) @binding(0) var sums0_texture: texture_2d<f32>;
@group(0) @binding(1) var weighted_texture: texture_2d<f32>;

@vertex
fn everywhere(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.5, 1.0);
}

@fragment
fn resolve(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let at = vec2<i32>(position.xy);
    return nmt_resolve(textureLoad(weighted_texture, at, 0), textureLoad(sums0_texture, at, 0));
}
