#version 450
// Vulkan, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Blend factors VK_BLEND_FACTOR_ONE, VK_BLEND_OP_ADD; target VK_FORMAT_R16G16B16A16_SFLOAT or R32G32B32A32_SFLOAT,
// cleared to 0. Set 0: the targets of pass 1, then its storage buffer. With NMT_SUBPASS defined the targets are input
// attachments of a subpass, which tilers keep on chip. Depth test, discard and push constants as in pass 1; before the
// resolve a barrier like that of the targets.
//
%include nmt_core_transmittance nmt_core_codes nmt_core_steps nmt_core_absorbance_of

layout(location = 0) in float v;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 weighted;
layout(push_constant) uniform Frame { vec2 v_range; uint width; } frame;
#ifdef NMT_SUBPASS
%sums layout(input_attachment_index = {i}, set = 0, binding = {i}) uniform subpassInput sums{i}_texture;
#define NMT_LOAD(name) subpassLoad(name)
#else
%sums layout(set = 0, binding = {i}) uniform sampler2D sums{i}_texture;
#define NMT_LOAD(name) texelFetch(name, ivec2(gl_FragCoord.xy), 0)
#endif
layout(std430, set = 0, binding = {range}) readonly buffer Cores { uvec2 core[]; };

void main() {
    NmtCodes codes = nmt_core_codes(frame.v_range.x, frame.v_range.y);
    uvec2 steps = nmt_core_steps(v, nmt_core_absorbance_of(color.a), codes);
    uvec2 at = uvec2(gl_FragCoord.xy);
    uint first = {pairs}u * (at.y * frame.width + at.x);
%sums     vec4 sums{i} = NMT_LOAD(sums{i}_texture);
    vec4 moments = vec4({moments});
    float T = nmt_core_transmittance(steps, codes, {slots}, {n}, {b0}, moments);
    float weight = color.a * T;
    weighted = vec4(weight * color.rgb, weight);
}
