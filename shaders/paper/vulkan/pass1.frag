#version 450
// Vulkan, pass 1: draw every transparent surface, in any order, without writing depth and tested against the depth of
// what is opaque. Discard what is cut out.
//
// All blend factors VK_BLEND_FACTOR_ONE; VK_BLEND_OP_ADD, and VK_BLEND_OP_MAX for target 2 (feature
// independentBlend).
// Target 0: VK_FORMAT_R32G32B32A32_SFLOAT, cleared to 0.
// Target 1: VK_FORMAT_R32G32_SFLOAT, cleared to 0.
// Target 2: VK_FORMAT_R32G32_SFLOAT, cleared to -3e38.
// Between the passes a barrier from VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT and
// VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT to VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT and VK_ACCESS_SHADER_READ_BIT, with
// layouts to match, or a dependency of the render pass; docs/integration.md has the rest.
//
// Neural moment transparency: network 'paper', 7-32-16-1, 752 multiply-adds.
// Provenance: nmt 0.1.0, commit 122c62af9569, backend fused, seed 1, epochs 1000, dataset 7efe7a15adf78c7d3c08d1766f86933c7206479e931a41fb0eb5cd099252fcd5.
// Measured on fresh pixels of the training distribution: mean squared error of T 5.094e-3, worst 0.657.

// Absorbance of a fragment, min(-ln(1 - alpha), 10), accurate for faint fragments too.
float nmt_absorbance(float alpha) {
    float faint = alpha * (1.0 + alpha * (0.5 + alpha * (0.33333334 + alpha * (0.25 + alpha * 0.2))));
    return (alpha < 0.03 ? faint : -log(max(1.0 - alpha, 4.539993e-5)));
}

// Pass 1: what a fragment at window depth w adds to b1..b4; to b0 it adds its absorbance.
vec4 nmt_moments(float w, float absorbance) {
    float z = 2.0 * w - 1.0;
    float b1 = absorbance * z;
    float b2 = b1 * z;
    float b3 = b2 * z;
    float b4 = b3 * z;
    return vec4(b1, b2, b3, b4);
}

// What pass 1 writes of a fragment, and what pass 2 reads of its pixel, a vector a render target.
struct NmtSums {
    // (b0, b1, b2, b3): blended by addition, cleared to 0.
    vec4 sums0;
    // (b4, number of fragments, 0, 0): blended by addition, cleared to 0.
    vec4 sums1;
    // (-w, w, 0, 0): blended by max, cleared to -3e38, so that it holds -w_min and w_max. Two channels, f32 always.
    vec4 range;
};

// Pass 1 in one call. w is window depth in [0, 1], the same bits in both passes.
NmtSums nmt_pass1(float w, float alpha) {
    float absorbance = nmt_absorbance(alpha);
    vec4 b = nmt_moments(w, absorbance);
    return NmtSums(vec4(absorbance, b.xyz), vec4(b.w, 1.0, 0.0, 0.0), vec4(-w, w, 0.0, 0.0));
}

// Not premultiplied.
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 sums0;
layout(location = 1) out vec4 sums1;
layout(location = 2) out vec4 range;

void main() {
    NmtSums sums = nmt_pass1(gl_FragCoord.z, color.a);
    sums0 = sums.sums0;
    sums1 = sums.sums1;
    range = sums.range;
}
