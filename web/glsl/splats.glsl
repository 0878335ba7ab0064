// Twin of wgsl/splats.wgsl.
#ifdef VERTEX
layout(location = 0) in vec3 center;
layout(location = 1) in vec3 row0;
layout(location = 2) in vec3 row12;
layout(location = 3) in vec4 color;
invariant gl_Position;
flat out float v_depth;
out vec2 v_place;
flat out vec4 v_color;

void main() {
    vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 2.0 - 1.0;
    vec4 clip = frame.clip_from_world * vec4(center, 1.0);
    mat3 view = mat3(frame.view_from_world);
    vec3 at = (frame.view_from_world * vec4(center, 1.0)).xyz;
    float per_v = frame.focal / max(-at.z, 1e-6);
    vec3 gx = transpose(view) * vec3(per_v, 0.0, per_v * clamp(at.x / -at.z, -2.0, 2.0));
    vec3 gy = transpose(view) * vec3(0.0, per_v, per_v * clamp(at.y / -at.z, -2.0, 2.0));
    mat3 covariance = mat3(row0, vec3(row0.y, row12.xy), vec3(row0.z, row12.yz));
    vec3 sx = covariance * gx;
    float xx = dot(gx, sx) + 0.3;
    float xy = dot(gy, sx);
    float yy = dot(gy, covariance * gy) + 0.3;
    float middle = 0.5 * (xx + yy);
    float apart = sqrt(max(0.25 * (xx - yy) * (xx - yy) + xy * xy, 1e-12));
    vec2 lean = vec2(xy, middle + apart - xx);
    vec2 axis = dot(lean, lean) > 1e-12 ? normalize(lean) : vec2(1.0, 0.0);
    float long_side = 3.0 * sqrt(middle + apart);
    float short_side = 3.0 * sqrt(max(middle - apart, 0.05));
    vec2 offset = corner.x * long_side * axis + corner.y * short_side * vec2(-axis.y, axis.x);
    gl_Position = clip + vec4(2.0 * offset / frame.size * clip.w, 0.0, 0.0);
    v_depth = clip.w;
    v_place = 3.0 * corner;
    v_color = color;
}
#else
flat in float v_depth;
in vec2 v_place;
flat in vec4 v_color;

Surface surface() {
    float alpha = v_color.a * exp(-0.5 * dot(v_place, v_place));
    Surface found = with_opacity(v_depth, v_color.rgb, alpha);
    if (alpha < 0.00392) {
        found.alpha = -1.0;
    }
    return found;
}
#endif
