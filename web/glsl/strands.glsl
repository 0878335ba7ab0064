// Twin of wgsl/strands.wgsl.
#ifdef VERTEX
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 along;
layout(location = 2) in vec4 color;
invariant gl_Position;
out float v_depth;
out vec3 v_along;
out vec4 v_color;

void main() {
    vec3 across = normalize(cross(along.xyz, frame.eye - position) + vec3(1e-6, 0.0, 0.0));
    gl_Position = frame.clip_from_world * vec4(position + across * (0.5 * frame.strand_width * along.w), 1.0);
    v_depth = gl_Position.w;
    v_along = along.xyz;
    v_color = color;
}
#else
in float v_depth;
in vec3 v_along;
in vec4 v_color;

Surface surface() {
    vec3 along = normalize(v_along + vec3(0.0, 1e-6, 0.0));
    float square = 1.0 - abs(dot(along, vec3(-0.44653, 0.74421, 0.49614)));
    vec3 color = mix(v_color.rgb * (0.4 + 0.6 * square), vec3(1.0, 0.93, 0.8), 0.45 * square * square * square);
    return with_opacity(v_depth, color, v_color.a);
}
#endif
