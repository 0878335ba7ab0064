// Vertex stage and look of Gaussian splats: a rectangle about the ellipse that three standard deviations cover.
struct Varying {
    @invariant @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) v: f32,
    @location(1) place: vec2<f32>,
    @location(2) @interpolate(flat) color: vec4<f32>,
}

@vertex
fn place(
    @builtin(vertex_index) index: u32,
    @location(0) center: vec3<f32>,
    @location(1) row0: vec3<f32>,
    @location(2) row12: vec3<f32>,
    @location(3) color: vec4<f32>,
) -> Varying {
    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u)) * 2.0 - 1.0;
    let clip = frame.clip_from_world * vec4<f32>(center, 1.0);
    // Covariance in the image [pixels^2], by the projection's derivative at the centre; a third of a pixel widens it.
    let view = mat3x3<f32>(frame.view_from_world[0].xyz, frame.view_from_world[1].xyz, frame.view_from_world[2].xyz);
    let at = (frame.view_from_world * vec4<f32>(center, 1.0)).xyz;
    let per_v = frame.focal / max(-at.z, 1e-6);
    let gx = transpose(view) * vec3<f32>(per_v, 0.0, per_v * clamp(at.x / -at.z, -2.0, 2.0));
    let gy = transpose(view) * vec3<f32>(0.0, per_v, per_v * clamp(at.y / -at.z, -2.0, 2.0));
    let covariance = mat3x3<f32>(row0, vec3<f32>(row0.y, row12.xy), vec3<f32>(row0.z, row12.yz));
    let sx = covariance * gx;
    let xx = dot(gx, sx) + 0.3;
    let xy = dot(gy, sx);
    let yy = dot(gy, covariance * gy) + 0.3;
    // Its axes.
    let middle = 0.5 * (xx + yy);
    let apart = sqrt(max(0.25 * (xx - yy) * (xx - yy) + xy * xy, 1e-12));
    let lean = vec2<f32>(xy, middle + apart - xx);
    let axis = select(vec2<f32>(1.0, 0.0), normalize(lean), dot(lean, lean) > 1e-12);
    let long = 3.0 * sqrt(middle + apart);
    let short = 3.0 * sqrt(max(middle - apart, 0.05));
    let offset = corner.x * long * axis + corner.y * short * vec2<f32>(-axis.y, axis.x);
    var position = clip;
    position += vec4<f32>(2.0 * offset / frame.size * clip.w, 0.0, 0.0);
    return Varying(position, clip.w, 3.0 * corner, color);
}

fn surface(f: Varying) -> Surface {
    let alpha = f.color.a * exp(-0.5 * dot(f.place, f.place));
    var found = with_opacity(f.v, f.color.rgb, alpha);
    if (alpha < 0.00392) {
        found.alpha = -1.0;
    }
    return found;
}
