// The passes of a frame, one main a value of PASS; wgsl/ says what each does.
ivec2 at() {
    return ivec2(gl_FragCoord.xy);
}

#if PASS == COUNT
layout(location = 0) out vec4 result;
void main() {
    if (surface().alpha < 0.0) {
        discard;
    }
    result = vec4(1.0);
}
#elif PASS == PEEL
// Of the fragments behind the layer before, the nearest; depth is v scaled by a power of two, so that no bit is lost.
uniform sampler2D layer_before;
uniform sampler2D opaque_depth;
layout(location = 0) out vec4 result;
layout(location = 1) out vec4 v;
void main() {
    Surface found = surface();
    bool hidden = gl_FragCoord.z > texelFetch(opaque_depth, at(), 0).x;
    if (hidden || found.alpha < 0.0 || found.v <= texelFetch(layer_before, at(), 0).x) {
        discard;
    }
    result = vec4(found.color, found.alpha);
    v = vec4(found.v, 0.0, 0.0, 1.0);
    gl_FragDepth = found.v * frame.depth_scale;
}
#elif PASS == LAYER
// A layer goes under those before it: alpha holds what is still clear.
uniform sampler2D layer;
layout(location = 0) out vec4 result;
void main() {
    vec4 found = texelFetch(layer, at(), 0);
    result = vec4(found.a * found.rgb, min(found.a, 0.999954600069));
}
#elif PASS == UNDER
uniform sampler2D layers;
uniform sampler2D background;
layout(location = 0) out vec4 result;
void main() {
    vec4 found = texelFetch(layers, at(), 0);
    result = vec4(found.rgb + found.a * texelFetch(background, at(), 0).rgb, 1.0);
}
#elif PASS == OVER
layout(location = 0) out vec4 result;
void main() {
    Surface found = surface();
    if (found.alpha < 0.0) {
        discard;
    }
    result = vec4(found.alpha * found.color, found.alpha);
}
#elif PASS == COPY
uniform sampler2D image;
layout(location = 0) out vec4 result;
void main() {
    result = texelFetch(image, at(), 0);
}
#elif PASS == ENDS
layout(location = 0) out vec4 result;
void main() {
    Surface found = surface();
    if (found.alpha < 0.0) {
        discard;
    }
    result = vec4(written_ends(found), 0.0, 0.0);
}
#elif PASS == END_DEPTH
uniform sampler2D opaque_depth;
void main() {
    Surface found = surface();
    if (found.alpha < 0.0 || gl_FragCoord.z > texelFetch(opaque_depth, at(), 0).x) {
        discard;
    }
    gl_FragDepth = found.v * frame.depth_scale;
}
#elif PASS == FIRST
void main() {
    Surface found = surface();
    if (found.alpha < 0.0) {
        discard;
    }
    accumulate(found, at());
}
#elif PASS == SECOND
layout(location = 0) out vec4 result;
void main() {
    Surface found = surface();
    if (found.alpha < 0.0) {
        discard;
    }
    float share = found.alpha * weight(found, at());
    result = vec4(share * found.color, share);
}
#elif PASS == RESOLVE
uniform sampler2D weighted;
uniform sampler2D background;
layout(location = 0) out vec4 result;
void main() {
    float behind = exp(-total(at()));
    vec4 sum = texelFetch(weighted, at(), 0);
    float scale = sum.a > 0.0 ? (1.0 - behind) / max(sum.a, 1e-37) : 0.0;
    result = vec4(scale * sum.rgb + behind * texelFetch(background, at(), 0).rgb, 1.0);
}
#elif PASS == PRESENT
uniform sampler2D image;
uniform sampler2D truth;
uniform sampler2D counts;
uniform int mode;
uniform float split;
uniform float scale;
layout(location = 0) out vec4 result;

vec3 encode(vec3 linear) {
    vec3 c = clamp(linear, 0.0, 1.0);
    return mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, vec3(lessThan(c, vec3(0.0031308))));
}

vec3 heat(float t) {
    float x = clamp(t, 0.0, 1.0) * 5.0;
    int k = int(min(x, 4.0));
    vec3 stops[6] = vec3[6](vec3(0.02, 0.02, 0.06), vec3(0.24, 0.06, 0.40), vec3(0.55, 0.14, 0.42),
        vec3(0.86, 0.30, 0.24), vec3(0.98, 0.62, 0.16), vec3(0.98, 0.98, 0.70));
    return mix(stops[k], stops[k + 1], x - float(k));
}

void main() {
    vec3 color = texelFetch(image, at(), 0).rgb;
    if (mode == 0 || (mode == 1 && gl_FragCoord.x >= split)) {
        result = vec4(encode(color), 1.0);
    } else if (mode == 3) {
        result = vec4(heat(log2(1.0 + texelFetch(counts, at(), 0).x) / log2(1.0 + scale)), 1.0);
    } else {
        vec3 exact = texelFetch(truth, at(), 0).rgb;
        vec3 d = abs(color - exact);
        result = vec4(mode == 1 ? encode(exact) : heat(max(d.x, max(d.y, d.z)) / scale), 1.0);
    }
}
#endif
