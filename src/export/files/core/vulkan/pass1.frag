#version 450
// Vulkan, pass 1: draw every transparent surface, in any order, without writing depth and tested against the depth of
// what is opaque. Discard what is cut out before the call of nmt_core_insert.
//
// All blend factors VK_BLEND_FACTOR_ONE, VK_BLEND_OP_ADD.
%sums // Target {i}: {vkformat{i}}, cleared to 0.
// Storage buffer at binding {range} of set 0 (feature fragmentStoresAndAtomics): {words} words a pixel, cleared to 0;
// between the passes a barrier from VK_ACCESS_SHADER_WRITE_BIT to VK_ACCESS_SHADER_READ_BIT of the fragment stage.
// Push constants of the fragment stage: v_range at offset 0, width at offset 8, 12 bytes.
// And between the passes one from VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT and
// VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT to VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT and VK_ACCESS_SHADER_READ_BIT, with
// layouts to match, or a dependency of the render pass; docs/integration.md has the rest.
//
%include nmt_core_insert nmt_core_codes nmt_core_steps nmt_core_absorbance_of nmt_core_moments nmt_core_absorbance

// Atomics write even where a depth test behind the shader fails.
layout(early_fragment_tests) in;

// Distance along the view direction.
layout(location = 0) in float v;
// Not premultiplied.
layout(location = 1) in vec4 color;
%sums layout(location = {i}) out vec4 sums{i};
// Least and greatest v of what is transparent; columns of the image.
layout(push_constant) uniform Frame { vec2 v_range; uint width; } frame;

void main() {
    NmtCodes codes = nmt_core_codes(frame.v_range.x, frame.v_range.y);
    uvec2 steps = nmt_core_steps(v, nmt_core_absorbance_of(color.a), codes);
    uvec2 at = uvec2(gl_FragCoord.xy);
    nmt_core_insert(at.y * frame.width + at.x, steps, codes);
    float absorbance = nmt_core_absorbance(steps);
    vec4 b = nmt_core_moments(steps);
    float n = steps.y > 0u ? 1.0 : 0.0;
%sums     sums{i} = {terms{i}};
}
