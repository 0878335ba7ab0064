// The backdrop, a floor with the coloured shadow of what stands on it, and opaque surfaces. All write linear colour and
// depth.
@group(1) @binding(0) var shadow: texture_2d<f32>;
@group(1) @binding(1) var shadow_sampler: sampler;

struct Backdrop { @builtin(position) position: vec4<f32>, @location(0) at: vec2<f32> }

@vertex
fn everywhere(@builtin(vertex_index) i: u32) -> Backdrop {
    let at = vec2<f32>(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0);
    return Backdrop(vec4<f32>(at, 1.0, 1.0), at);
}

fn studio(height: f32) -> vec3<f32> {
    return mix(vec3<f32>(0.70, 0.71, 0.74), vec3<f32>(0.90, 0.91, 0.94), smoothstep(-0.2, 1.0, height));
}

@fragment
fn backdrop(f: Backdrop) -> @location(0) vec4<f32> {
    return vec4<f32>(select(frame.backdrop.rgb, studio(f.at.y), frame.backdrop.w > 0.5), 1.0);
}

struct Floor { @builtin(position) position: vec4<f32>, @location(0) at: vec2<f32> }

@vertex
fn floor_place(@builtin(vertex_index) i: u32) -> Floor {
    let at = (vec2<f32>(f32(i & 1u), f32(i >> 1u)) * 2.0 - 1.0) * frame.floor * 4.0;
    return Floor(frame.clip_from_world * vec4<f32>(at.x, -0.012, at.y, 1.0), at);
}

fn line(x: f32, width: f32) -> f32 {
    let away = abs(fract(x - 0.5) - 0.5);
    let pixel = max(fwidth(x), 1e-4);
    return (1.0 - smoothstep(width, width + pixel, away)) * clamp(0.35 / pixel - 0.6, 0.0, 1.0);
}

@fragment
fn floor_color(f: Floor) -> @location(0) vec4<f32> {
    let at = f.at;
    let height = 1.0 - 2.0 * f.position.y / frame.size.y;
    let lines = max(line(at.x * 2.0, 0.012), line(at.y * 2.0, 0.012));
    var color = vec3<f32>(0.78, 0.785, 0.80) * (1.0 - 0.25 * lines);
    let light = textureSampleLevel(shadow, shadow_sampler, 0.5 + 0.5 * at / frame.floor, 0.0).rgb;
    let inside = max(abs(at.x), abs(at.y)) < frame.floor;
    color *= select(vec3<f32>(1.0), light, inside);
    let fade = smoothstep(0.5 * frame.floor, 2.0 * frame.floor, length(at));
    return vec4<f32>(mix(color, studio(height), fade), 1.0);
}

struct Opaque {
    @builtin(position) position: vec4<f32>,
    @location(0) world: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) color: vec3<f32>,
}

@vertex
fn opaque_place(
    @location(0) position: vec3<f32>,
    @location(1) normal: vec4<f32>,
    @location(2) color: vec4<f32>,
) -> Opaque {
    return Opaque(frame.clip_from_world * vec4<f32>(position, 1.0), position, normal.xyz, color.rgb);
}

@fragment
fn opaque_color(f: Opaque) -> @location(0) vec4<f32> {
    let to_eye = frame.eye - f.world;
    let facing = normalize(f.normal + vec3<f32>(0.0, 1e-6, 0.0));
    let normal = facing * sign(dot(facing, to_eye) + 1e-9);
    let lamp = max(dot(normal, vec3<f32>(-0.44653, 0.74421, 0.49614)), 0.0);
    return vec4<f32>(f.color * (0.3 + 0.15 * normal.y + 0.6 * lamp), 1.0);
}
