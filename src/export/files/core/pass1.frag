#version {version}
// {api}, pass 1 of a core: draw every transparent surface, in any order, without writing depth.
//
%opengl // glBlendFunc(GL_ONE, GL_ONE), GL_FUNC_ADD.
%opengl // Target 0: GL_RGBA32F, target 1: GL_RG32F, cleared to 0.
%vulkan // Blend factors VK_BLEND_FACTOR_ONE, VK_BLEND_OP_ADD. Target 0: VK_FORMAT_R32G32B32A32_SFLOAT, target 1:
%vulkan // VK_FORMAT_R32G32_SFLOAT, cleared to 0.
// Buffer NmtCore: {slots} words a pixel, cleared to 0. Opaque depth is tested before the shader, which writes to memory.
//
%es precision highp float;
%es precision highp int;
%es
layout(early_fragment_tests) in;
%opengl layout(std430, binding = 0) coherent buffer NmtCore { uint nmt_core[]; };
%vulkan layout(std430, set = 0, binding = 0) coherent buffer NmtCore { uint nmt_core[]; };

%include nmt_core_insert nmt_core_codes nmt_core_steps nmt_core_absorbance_of nmt_core_moments nmt_core_absorbance

// Distance along the view direction.
layout(location = 0) in float v;
// Not premultiplied.
layout(location = 1) in vec4 color;
%sums layout(location = {i}) out vec4 sums{i};
// Least and greatest v of what is transparent; columns of the image.
%opengl layout(location = 0) uniform vec2 v_range;
%opengl layout(location = 1) uniform uint columns;
%vulkan layout(push_constant) uniform Frame { vec2 v_range; uint columns; };

void main() {
    uvec2 at = uvec2(gl_FragCoord.xy);
    NmtCodes codes = nmt_core_codes(v_range.x, v_range.y);
    uvec2 steps = nmt_core_steps(v, nmt_core_absorbance_of(color.a), codes);
    nmt_core_insert(at.x + at.y * columns, steps, codes);
    vec4 moments = nmt_core_moments(steps);
    sums0 = vec4(nmt_core_absorbance(steps), moments.xyz);
    sums1 = vec4(moments.w, steps.y > 0u ? 1.0 : 0.0, 0.0, 0.0);
}
