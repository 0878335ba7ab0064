// Twin of wgsl/fragments.wgsl.
#ifdef VERTEX
layout(location = 0) in uint pixel;
layout(location = 1) in float v;
layout(location = 2) in vec4 color;
flat out float v_depth;
flat out vec4 v_color;

void main() {
    uvec2 size = uvec2(frame.size);
    vec2 at = (vec2(float(pixel % size.x), float(pixel / size.x)) + 0.5) / frame.size * 2.0 - 1.0;
    gl_Position = vec4(at.x, -at.y, -1.0, 1.0);
    gl_PointSize = 1.0;
    v_depth = v;
    v_color = color;
}
#else
flat in float v_depth;
flat in vec4 v_color;

Surface surface() {
    return with_opacity(v_depth, v_color.rgb, v_color.a);
}
#endif
