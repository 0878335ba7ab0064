#version 450
// Vulkan, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Blend factors VK_BLEND_FACTOR_ONE, VK_BLEND_OP_ADD; target VK_FORMAT_R16G16B16A16_SFLOAT or R32G32B32A32_SFLOAT,
// cleared to 0. Set 0: the targets of pass 1. With NMT_SUBPASS defined they are input attachments of a subpass, which
// tilers keep on chip. Depth test, discard and push constants as in pass 1; before the resolve a barrier like that
// behind pass 1.
//
%include nmt_pass2

%log layout(location = 0) in float v;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 weighted;
%log layout(push_constant) uniform Frame { vec2 v_range; } frame;
#ifdef NMT_SUBPASS
%sums layout(input_attachment_index = {i}, set = 0, binding = {i}) uniform subpassInput sums{i}_texture;
layout(input_attachment_index = {range}, set = 0, binding = {range}) uniform subpassInput range_texture;
#define NMT_LOAD(name) subpassLoad(name)
#else
%sums layout(set = 0, binding = {i}) uniform sampler2D sums{i}_texture;
layout(set = 0, binding = {range}) uniform sampler2D range_texture;
#define NMT_LOAD(name) texelFetch(name, ivec2(gl_FragCoord.xy), 0)
#endif

void main() {
    float T = nmt_pass2(
%log         v, frame.v_range.x, frame.v_range.y, color.a,
%window         gl_FragCoord.z,
%sums         NMT_LOAD(sums{i}_texture),
        NMT_LOAD(range_texture));
    float weight = color.a * T;
    weighted = vec4(weight * color.rgb, weight);
}
