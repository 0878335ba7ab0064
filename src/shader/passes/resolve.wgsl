// Resolve: one triangle over the whole image makes its colour of what both passes left.

@group(1) @binding(0) var oit_weighted: texture_2d<f32>;

@vertex
fn oit_everywhere(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
    // (-1, -1), (3, -1), (-1, 3)
    return vec4<f32>(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.5, 1.0);
}

@fragment
fn oit_resolve(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let at = vec2<i32>(position.xy);
    let weighted = textureLoad(oit_weighted, at, 0);
    return vec4<f32>(oit_composite(weighted, oit_sums(at)[0], oit_count(at), oit_frame.background.rgb), 1.0);
}
