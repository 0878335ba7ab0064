// Vertex stage and look of strands: ribbons that face the viewer.
struct Varying {
    @invariant @builtin(position) position: vec4<f32>,
    @location(0) v: f32,
    @location(1) along: vec3<f32>,
    @location(2) color: vec4<f32>,
}

@vertex
fn place(@location(0) position: vec3<f32>, @location(1) along: vec4<f32>, @location(2) color: vec4<f32>) -> Varying {
    let across = normalize(cross(along.xyz, frame.eye - position) + vec3<f32>(1e-6, 0.0, 0.0));
    let clip = frame.clip_from_world * vec4<f32>(position + across * (0.5 * frame.strand_width * along.w), 1.0);
    return Varying(clip, clip.w, along.xyz, color);
}

fn surface(f: Varying) -> Surface {
    // A fibre is brightest where the lamp stands square to it.
    let along = normalize(f.along + vec3<f32>(0.0, 1e-6, 0.0));
    let square = 1.0 - abs(dot(along, vec3<f32>(-0.44653, 0.74421, 0.49614)));
    let color = mix(f.color.rgb * (0.4 + 0.6 * square), vec3<f32>(1.0, 0.93, 0.8), 0.45 * square * square * square);
    return with_opacity(f.v, color, f.color.a);
}
