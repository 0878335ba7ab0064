// Twin of wgsl/backdrop.wgsl: PART is 0 for the backdrop, 1 for the floor, 2 for opaque surfaces.
#ifdef VERTEX
#if PART == 1
out vec2 v_at;
void main() {
    v_at = (vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 2.0 - 1.0) * frame.floor_side * 4.0;
    gl_Position = frame.clip_from_world * vec4(v_at.x, -0.012, v_at.y, 1.0);
}
#else
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 normal;
layout(location = 2) in vec4 color;
out vec3 v_world;
out vec3 v_normal;
out vec3 v_color;
void main() {
    gl_Position = frame.clip_from_world * vec4(position, 1.0);
    v_world = position;
    v_normal = normal.xyz;
    v_color = color.rgb;
}
#endif
#else
out vec4 result;

vec3 studio(float height) {
    return mix(vec3(0.70, 0.71, 0.74), vec3(0.90, 0.91, 0.94), smoothstep(-0.2, 1.0, height));
}

#if PART == 0
in vec2 v_at;
void main() {
    result = vec4(frame.backdrop.w > 0.5 ? studio(v_at.y) : frame.backdrop.rgb, 1.0);
}
#elif PART == 1
in vec2 v_at;
uniform sampler2D shadow;

float line(float x, float width) {
    float away = abs(fract(x - 0.5) - 0.5);
    float pixel = max(fwidth(x), 1e-4);
    return (1.0 - smoothstep(width, width + pixel, away)) * clamp(0.35 / pixel - 0.6, 0.0, 1.0);
}

void main() {
    float height = 2.0 * gl_FragCoord.y / frame.size.y - 1.0;
    float lines = max(line(v_at.x * 2.0, 0.012), line(v_at.y * 2.0, 0.012));
    vec3 color = vec3(0.78, 0.785, 0.80) * (1.0 - 0.25 * lines);
    vec3 light = textureLod(shadow, 0.5 + 0.5 * v_at / frame.floor_side, 0.0).rgb;
    color *= max(abs(v_at.x), abs(v_at.y)) < frame.floor_side ? light : vec3(1.0);
    float fade = smoothstep(0.5 * frame.floor_side, 2.0 * frame.floor_side, length(v_at));
    result = vec4(mix(color, studio(height), fade), 1.0);
}
#else
in vec3 v_world;
in vec3 v_normal;
in vec3 v_color;
void main() {
    vec3 to_eye = frame.eye - v_world;
    vec3 facing = normalize(v_normal + vec3(0.0, 1e-6, 0.0));
    vec3 normal = facing * sign(dot(facing, to_eye) + 1e-9);
    float lamp = max(dot(normal, vec3(-0.44653, 0.74421, 0.49614)), 0.0);
    result = vec4(v_color * (0.3 + 0.15 * normal.y + 0.6 * lamp), 1.0);
}
#endif
#endif
