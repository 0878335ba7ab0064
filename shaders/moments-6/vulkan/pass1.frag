#version 450
// Vulkan, pass 1: draw every transparent surface, in any order, without writing depth and tested against the depth of
// what is opaque. Discard what is cut out.
//
// All blend factors VK_BLEND_FACTOR_ONE; VK_BLEND_OP_ADD, and VK_BLEND_OP_MAX for target 2 (feature
// independentBlend).
// Target 0: VK_FORMAT_R32G32B32A32_SFLOAT, cleared to 0.
// Target 1: VK_FORMAT_R32G32B32A32_SFLOAT, cleared to 0.
// Target 2: VK_FORMAT_R32G32_SFLOAT, cleared to -3e38.
// Push constants of the fragment stage: v_range at offset 0, 8 bytes.
// Between the passes a barrier from VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT and
// VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT to VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT and VK_ACCESS_SHADER_READ_BIT, with
// layouts to match, or a dependency of the render pass; docs/integration.md has the rest.
//
// Neural moment transparency: network 'moments-6', 9-32-16-1, 816 multiply-adds.
// Provenance: nmt 0.1.0, commit 122c62af9569, backend fused, seed 1, epochs 600, dataset 37f23ca23c85cddd29cc28c82e42ad387652d607b62fdde6a7e9a18fca6b8f75.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.305e-3, worst 0.995.

// Absorbance of a fragment, min(-ln(1 - alpha), 10), accurate for faint fragments too.
float nmt_absorbance(float alpha) {
    float faint = alpha * (1.0 + alpha * (0.5 + alpha * (0.33333334 + alpha * (0.25 + alpha * 0.2))));
    return (alpha < 0.03 ? faint : -log(max(1.0 - alpha, 4.539993e-5)));
}

// ln(a / b), as accurate relative to itself where a is near b as elsewhere.
float nmt_log_ratio(float a, float b) {
    float s = (a - b) / (a + b);
    float q = s * s;
    return (abs(s) < 0.2 ? (s + s) * (1.0 + q * (0.33333334 + q * (0.2 + q * (0.14285715 + q * 0.11111111))))
        : log(a / b));
}

// Moment depth of view depth v; v0 and v1 are the least and the greatest of the scene. Where a prepass has found the
// pixel's own nearest and farthest view depth, these may be v0 and v1 in both passes: then no pixel is too thin for its
// moments.
float nmt_moment_depth(float v, float v0, float v1) {
    return (v1 > v0 ? clamp(2.0 * nmt_log_ratio(v, v0) / max(nmt_log_ratio(v1, v0), 1e-30) - 1.0, -1.0, 1.0) : 0.0);
}

// Pass 1: what a fragment at moment depth z adds to b1, b2 and so on; to b0 it adds its absorbance, to n it adds 1.
mat2x4 nmt_moments(float z, float absorbance) {
    float moment1 = absorbance * z;
    float moment2 = moment1 * z;
    float moment3 = moment2 * z;
    float moment4 = moment3 * z;
    float moment5 = moment4 * z;
    float moment6 = moment5 * z;
    return mat2x4(vec4(moment1, moment2, moment3, moment4), vec4(moment5, moment6, 0.0, 0.0));
}

// What pass 1 writes of a fragment, and what pass 2 reads of its pixel, a vector a render target.
struct NmtSums {
    // (b0, b1, b2, b3): blended by addition, cleared to 0.
    vec4 sums0;
    // (b4, b5, b6, number of fragments): blended by addition, cleared to 0.
    vec4 sums1;
    // (-v, v, 0, 0): blended by max, cleared to -3e38, so that it holds -nearest and farthest. Two channels, f32
    // always.
    vec4 range;
};

// Pass 1 in one call. v is distance along the view direction, the same bits in both passes; v0 and v1 are the least and
// the greatest v of the scene.
NmtSums nmt_pass1(float v, float v0, float v1, float alpha) {
    float absorbance = nmt_absorbance(alpha);
    mat2x4 b = nmt_moments(nmt_moment_depth(v, v0, v1), absorbance);
    return NmtSums(vec4(absorbance, b[0].xyz), vec4(b[0].w, b[1].xy, 1.0), vec4(-v, v, 0.0, 0.0));
}

// Distance along the view direction.
layout(location = 0) in float v;
// Not premultiplied.
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 sums0;
layout(location = 1) out vec4 sums1;
layout(location = 2) out vec4 range;
// Least and greatest v of what is transparent.
layout(push_constant) uniform Frame { vec2 v_range; } frame;

void main() {
    NmtSums sums = nmt_pass1(v, frame.v_range.x, frame.v_range.y, color.a);
    sums0 = sums.sums0;
    sums1 = sums.sums1;
    range = sums.range;
}
