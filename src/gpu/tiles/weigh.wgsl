// Pass 2 and the resolve: a workgroup a tile, a thread a pixel.

@group(0) @binding(1) var<storage, read> oit_offsets: array<u32>;
@group(0) @binding(2) var<storage, read> oit_view_z: array<f32>;
@group(0) @binding(3) var<storage, read> oit_alpha: array<f32>;
@group(0) @binding(4) var<storage, read> oit_color: array<f32>;
@group(0) @binding(5) var<storage, read> oit_sums: array<f32>;
@group(0) @binding(6) var<storage, read> oit_ranges: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> oit_image: array<vec4<f32>>;

fn oit_shade(at: vec2<u32>) {
    if (any(at >= oit_frame.size)) {
        return;
    }
    let pixel = at.y * oit_frame.size.x + at.x;
    let ends = oit_ranges[pixel];
    let sums = array<f32, OIT_SUMS>(OIT_LOAD);
    let state = OitPixel(sums, ends.x, ends.y, ends.z, oit_depth(ends.y, oit_frame.range), oit_depth(ends.z, oit_frame.range));
    var weighted = vec4<f32>(0.0);
    for (var i = oit_offsets[pixel]; i < oit_offsets[pixel + 1u]; i++) {
        let v = oit_view_z[i];
        let alpha = oit_alpha[i];
        let weight = alpha * OIT_WEIGHT(OitFragment(v, oit_depth(v, oit_frame.range), alpha, oit_absorbance(alpha)), state);
        weighted += vec4<f32>(weight * vec3<f32>(oit_color[3u * i], oit_color[3u * i + 1u], oit_color[3u * i + 2u]), weight);
    }
    oit_image[pixel] = vec4<f32>(oit_composite(weighted, sums[0], ends.x, oit_frame.background.rgb), 1.0);
}
