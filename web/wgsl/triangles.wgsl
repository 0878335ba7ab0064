// Vertex stage and look of triangles.
struct Varying {
    @invariant @builtin(position) position: vec4<f32>,
    @location(0) v: f32,
    @location(1) world: vec3<f32>,
    @location(2) normal: vec4<f32>,
    @location(3) color: vec4<f32>,
}

@vertex
fn place(@location(0) position: vec3<f32>, @location(1) normal: vec4<f32>, @location(2) color: vec4<f32>) -> Varying {
    let clip = frame.clip_from_world * vec4<f32>(position, 1.0);
    return Varying(clip, clip.w, position, normal, color);
}

fn surface(f: Varying) -> Surface {
    let normal = normalize(f.normal.xyz + vec3<f32>(0.0, 1e-6, 0.0));
    let to_eye = normalize(frame.eye - f.world);
    let facing = min(abs(dot(normal, to_eye)), 1.0);
    // A wall of glass is longer where it is seen from the side.
    let side = (1.0 - facing) * (1.0 - facing);
    var alpha = f.color.a + (1.0 - f.color.a) * f.normal.w * side;
    var color = f.color.rgb * light_on(normal);
    let halfway = normalize(to_eye + vec3<f32>(-0.44653, 0.74421, 0.49614));
    let glint = frame.gloss * pow(max(dot(normal * sign(dot(normal, to_eye)), halfway), 0.0), 90.0);
    color = mix(color, vec3<f32>(1.0), glint);
    alpha = alpha + (1.0 - alpha) * glint * 0.9;
    return with_opacity(f.v, color, alpha);
}
