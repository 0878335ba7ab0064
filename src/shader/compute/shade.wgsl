// Pass 2 and the resolve, a thread a pixel: what all of its shaders share.

@group(0) @binding(1) var<storage, read> oit_offsets: array<u32>;
@group(0) @binding(2) var<storage, read> oit_view_z: array<f32>;
@group(0) @binding(3) var<storage, read> oit_alpha: array<f32>;
@group(0) @binding(4) var<storage, read> oit_color: array<f32>;
@group(0) @binding(5) var<storage, read> oit_state: array<vec4<f32>>;
// Colour, and how many fragments the network was run for.
@group(0) @binding(6) var<storage, read_write> oit_image: array<vec4<f32>>;

fn oit_fragment(i: u32) -> OitFragment {
    let v = oit_view_z[i];
    let alpha = oit_alpha[i];
    return oit_fragment_at(v, alpha);
}

fn oit_weighted(i: u32, weight: f32) -> vec4<f32> {
    return vec4<f32>(weight * vec3<f32>(oit_color[3u * i], oit_color[3u * i + 1u], oit_color[3u * i + 2u]), weight);
}

fn oit_finish(pixel: u32, state: OitPixel, weighted: vec4<f32>, evaluated: f32) {
    let color = oit_composite(weighted, state.sums[0], state.n, oit_frame.background.rgb);
    oit_image[pixel] = vec4<f32>(color, evaluated);
}
