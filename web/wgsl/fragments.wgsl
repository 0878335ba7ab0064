// Vertex stage and look of a fragment list: one point a fragment, at the pixel that the list puts it in.
struct Varying {
    @invariant @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) v: f32,
    @location(1) @interpolate(flat) color: vec4<f32>,
}

@vertex
fn place(@location(0) pixel: u32, @location(1) v: f32, @location(2) color: vec4<f32>) -> Varying {
    let size = vec2<u32>(frame.size);
    let at = (vec2<f32>(vec2<u32>(pixel % size.x, pixel / size.x)) + 0.5) / frame.size * 2.0 - 1.0;
    // Rows are counted from the top, clip space from the bottom. A list is in front of all that is opaque.
    return Varying(vec4<f32>(at.x, -at.y, 0.0, 1.0), v, color);
}

fn surface(f: Varying) -> Surface {
    return with_opacity(f.v, f.color.rgb, f.color.a);
}
