#version {version}
// {api}, pass 2 of a core: draw every transparent surface again, with the same vertices and the same vertex shader.
//
%opengl // glBlendFunc(GL_ONE, GL_ONE), GL_FUNC_ADD; target GL_RGBA16F or GL_RGBA32F, cleared to 0. A barrier stands before:
%opengl // glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT).
%vulkan // Blend factors VK_BLEND_FACTOR_ONE, VK_BLEND_OP_ADD; target VK_FORMAT_R16G16B16A16_SFLOAT or R32G32B32A32_SFLOAT,
%vulkan // cleared to 0. A barrier stands before: fragment shader write to fragment shader read, of the buffer.
//
%es precision highp float;
%es precision highp int;
%es precision highp sampler2D;
%es
%include nmt_core_transmittance nmt_core_codes nmt_core_steps nmt_core_absorbance_of

layout(location = 0) in float v;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 weighted;
// The buffer of pass 1, read four words at a time, and its targets.
%opengl layout(std430, binding = 0) readonly buffer Core { uvec4 core[]; };
%opengl layout(binding = 0) uniform sampler2D sums0_texture;
%opengl layout(binding = 1) uniform sampler2D sums1_texture;
%opengl layout(location = 0) uniform vec2 v_range;
%opengl layout(location = 1) uniform uint columns;
%vulkan layout(std430, set = 0, binding = 0) readonly buffer Core { uvec4 core[]; };
%vulkan layout(set = 0, binding = 1) uniform sampler2D sums0_texture;
%vulkan layout(set = 0, binding = 2) uniform sampler2D sums1_texture;
%vulkan layout(push_constant) uniform Frame { vec2 v_range; uint columns; };

void main() {
    uvec2 at = uvec2(gl_FragCoord.xy);
    uint first = (at.x + at.y * columns) * {vectors}u;
    vec4 sums0 = texelFetch(sums0_texture, ivec2(at), 0);
    vec4 sums1 = texelFetch(sums1_texture, ivec2(at), 0);
    // The same expressions as in pass 1.
    NmtCodes codes = nmt_core_codes(v_range.x, v_range.y);
    uvec2 steps = nmt_core_steps(v, nmt_core_absorbance_of(color.a), codes);
    float T = nmt_core_transmittance(
        steps, codes, {core}, sums1.y, sums0.x, vec4(sums0.yzw, sums1.x));
    float weight = color.a * T;
    weighted = vec4(weight * color.rgb, weight);
}
