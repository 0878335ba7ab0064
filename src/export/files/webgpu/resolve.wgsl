// WebGPU, resolve: draw three vertices over the opaque image, blend add, source factor one, destination factor
// src-alpha.
//
// Textures of group 0: target 0 of pass 1, then the target of pass 2.
//
%include nmt_resolve

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
