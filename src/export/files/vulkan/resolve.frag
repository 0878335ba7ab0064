#version 450
// Vulkan, resolve: draw three vertices of fullscreen.vert over the opaque image, VK_BLEND_OP_ADD, source factor
// VK_BLEND_FACTOR_ONE, destination factor VK_BLEND_FACTOR_SRC_ALPHA.
//
// Set 0: target 0 of pass 1, then the target of pass 2; input attachments with NMT_SUBPASS defined.
//
%include nmt_resolve

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
