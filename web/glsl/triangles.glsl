// Twin of wgsl/triangles.wgsl.
#ifdef VERTEX
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 normal;
layout(location = 2) in vec4 color;
invariant gl_Position;
out float v_depth;
out vec3 v_world;
out vec4 v_normal;
out vec4 v_color;

void main() {
    gl_Position = frame.clip_from_world * vec4(position, 1.0);
    v_depth = gl_Position.w;
    v_world = position;
    v_normal = normal;
    v_color = color;
}
#else
in float v_depth;
in vec3 v_world;
in vec4 v_normal;
in vec4 v_color;

Surface surface() {
    vec3 normal = normalize(v_normal.xyz + vec3(0.0, 1e-6, 0.0));
    vec3 to_eye = normalize(frame.eye - v_world);
    float facing = min(abs(dot(normal, to_eye)), 1.0);
    float side = (1.0 - facing) * (1.0 - facing);
    float alpha = v_color.a + (1.0 - v_color.a) * v_normal.w * side;
    vec3 color = v_color.rgb * light_on(normal);
    vec3 halfway = normalize(to_eye + vec3(-0.44653, 0.74421, 0.49614));
    float glint = frame.gloss * pow(max(dot(normal * sign(dot(normal, to_eye)), halfway), 0.0), 90.0);
    color = mix(color, vec3(1.0), glint);
    alpha = alpha + (1.0 - alpha) * glint * 0.9;
    return with_opacity(v_depth, color, alpha);
}
#endif
