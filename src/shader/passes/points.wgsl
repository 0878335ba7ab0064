// The vertex stage that draws a fragment list: one point a fragment.
//
// A renderer has its own vertex stage. What it must hand on is v, the distance along the view direction, and it must
// hand on the same bits in both passes: same expressions, same vertices, @invariant position. The nearest and the
// farthest fragment of a pixel are told by comparing v.

@group(1) @binding(0) var<storage, read> oit_pixel_of: array<u32>;
@group(1) @binding(1) var<storage, read> oit_view_z: array<f32>;
@group(1) @binding(2) var<storage, read> oit_alpha: array<f32>;
@group(1) @binding(3) var<storage, read> oit_color: array<f32>;

struct OitVarying {
    @invariant @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) color: vec4<f32>,
    @location(1) @interpolate(flat) v: f32,
}

@vertex
fn oit_point(@builtin(vertex_index) i: u32) -> OitVarying {
    let pixel = oit_pixel_of[i];
    let size = vec2<f32>(oit_frame.size);
    let center = vec2<f32>(vec2<u32>(pixel % oit_frame.size.x, pixel / oit_frame.size.x)) + 0.5;
    let place = 2.0 * center / size - 1.0;
    let color = vec4<f32>(oit_color[3u * i], oit_color[3u * i + 1u], oit_color[3u * i + 2u], oit_alpha[i]);
    // Rows are counted from the top, clip space from the bottom.
    return OitVarying(vec4<f32>(place.x, -place.y, 0.5, 1.0), color, oit_view_z[i]);
}

fn oit_seen(f: OitVarying) -> OitFragment {
    return oit_fragment_at(f.v, f.color.a);
}
