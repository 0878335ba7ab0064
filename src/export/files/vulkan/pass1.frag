#version 450
// Vulkan, pass 1: draw every transparent surface, in any order, without writing depth and tested against the depth of
// what is opaque. Discard what is cut out.
//
// All blend factors VK_BLEND_FACTOR_ONE; VK_BLEND_OP_ADD, and VK_BLEND_OP_MAX for target {range} (feature
// independentBlend).
%sums // Target {i}: {vkformat{i}}, cleared to 0.
// Target {range}: VK_FORMAT_R32G32_SFLOAT, cleared to -3e38.
%log // Push constants of the fragment stage: v_range at offset 0, 8 bytes.
// Between the passes a barrier from VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT and
// VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT to VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT and VK_ACCESS_SHADER_READ_BIT, with
// layouts to match, or a dependency of the render pass; docs/integration.md has the rest.
//
%include nmt_pass1

%log // Distance along the view direction.
%log layout(location = 0) in float v;
// Not premultiplied.
layout(location = 1) in vec4 color;
%sums layout(location = {i}) out vec4 sums{i};
layout(location = {range}) out vec4 range;
%log // Least and greatest v of what is transparent.
%log layout(push_constant) uniform Frame { vec2 v_range; } frame;

void main() {
%log     NmtSums sums = nmt_pass1(v, frame.v_range.x, frame.v_range.y, color.a);
%window     NmtSums sums = nmt_pass1(gl_FragCoord.z, color.a);
%sums     sums{i} = sums.sums{i};
    range = sums.range;
}
