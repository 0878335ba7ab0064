// Resolve: (1 - e^-b0) / (sum of a T) (sum of a T C) + e^-b0 background.
@group(2) @binding(0) var weighted: texture_2d<f32>;
@group(2) @binding(1) var background: texture_2d<f32>;

@vertex
fn everywhere(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.5, 1.0);
}

@fragment
fn resolve(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let at = vec2<i32>(position.xy);
    let behind = exp(-total(at));
    let sum = textureLoad(weighted, at, 0);
    let scale = select(0.0, (1.0 - behind) / max(sum.a, 1e-37), sum.a > 0.0);
    return vec4<f32>(scale * sum.rgb + behind * textureLoad(background, at, 0).rgb, 1.0);
}
