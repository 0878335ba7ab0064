// What every pass of a frame knows; wgsl/frame.wgsl says what each is.
layout(std140) uniform Frame {
    mat4 clip_from_world;
    mat4 view_from_world;
    vec3 eye;
    float opacity;
    vec2 range;
    vec2 size;
    float focal;
    float gloss;
    float strand_width;
    float depth_scale;
    vec4 backdrop;
    float floor_side;
    uint first_row;
    uint capacity;
    float one_color;
} frame;

struct Surface { float v; vec3 color; float alpha; };

Surface with_opacity(float v, vec3 color, float alpha) {
    float clear = pow(clamp(1.0 - alpha, 0.0, 1.0), frame.opacity);
    return Surface(v, frame.one_color > 0.5 ? vec3(0.8, 0.35, 0.1) : color, 1.0 - clear);
}

float light_on(vec3 normal) {
    vec3 lamp = vec3(-0.44653, 0.74421, 0.49614);
    vec3 fill = vec3(0.79603, 0.0995, 0.59702);
    return 0.42 + 0.5 * abs(dot(normal, lamp)) + 0.12 * abs(dot(normal, fill));
}
