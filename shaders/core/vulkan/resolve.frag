#version 450
// Vulkan, resolve: draw three vertices of fullscreen.vert over the opaque image, VK_BLEND_OP_ADD, source factor
// VK_BLEND_FACTOR_ONE, destination factor VK_BLEND_FACTOR_SRC_ALPHA.
//
// Set 0: target 0 of pass 1, then the target of pass 2; input attachments with NMT_SUBPASS defined.
//
// Neural moment transparency: network 'core', 9-32-16-1, 816 multiply-adds.
// Provenance: nmt 0.1.0, commit a848199e5c6e, backend fused, seed 2, epochs 1500, dataset 01b6983dc69ed68b847bc6fa4ad020706782ce5990d348cf55044a5188b5ba4f.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.202e-3, worst 1.000.

// Resolve: what lies over the background, of the sum that pass 2 has made, and in alpha how much of the background
// shows through: result.rgb + result.a * background. As a blend state: source factor one, destination factor source
// alpha.
vec4 nmt_resolve(vec4 weighted, vec4 sums0) {
    float behind = exp(-sums0.x);
    float scale = (weighted.w > 0.0 ? (1.0 - behind) / max(weighted.w, 1e-37) : 0.0);
    return vec4(scale * weighted.x, scale * weighted.y, scale * weighted.z, behind);
}

layout(location = 0) out vec4 result;
#ifdef NMT_SUBPASS
layout(input_attachment_index = 0, set = 0, binding = 0) uniform subpassInput sums0_texture;
layout(input_attachment_index = 1, set = 0, binding = 1) uniform subpassInput weighted_texture;
#define NMT_LOAD(name) subpassLoad(name)
#else
layout(set = 0, binding = 0) uniform sampler2D sums0_texture;
layout(set = 0, binding = 1) uniform sampler2D weighted_texture;
#define NMT_LOAD(name) texelFetch(name, ivec2(gl_FragCoord.xy), 0)
#endif

void main() {
    result = nmt_resolve(NMT_LOAD(weighted_texture), NMT_LOAD(sums0_texture));
}
