#version {version}
// {api}, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// glBlendFunc(GL_ONE, GL_ONE), GL_FUNC_ADD; target GL_RGBA16F or GL_RGBA32F, cleared to 0. Textures: the targets of
// pass 1. Storage buffer at binding 0: that of pass 1.
//
%es precision highp float;
%es precision highp int;
%es precision highp sampler2D;
%es
%include nmt_core_transmittance nmt_core_codes nmt_core_steps nmt_core_absorbance_of

{in0}in float v;
{in1}in vec4 color;
layout(location = 0) out vec4 weighted;
{uniform0}uniform vec2 v_range;
{uniform1}uniform uint width;
%sums {binding{i}}uniform sampler2D sums{i}_texture;
layout(std430, binding = 0) readonly buffer Cores { uvec2 core[]; };

void main() {
    NmtCodes codes = nmt_core_codes(v_range.x, v_range.y);
    uvec2 steps = nmt_core_steps(v, nmt_core_absorbance_of(color.a), codes);
    ivec2 at = ivec2(gl_FragCoord.xy);
    uint first = {pairs}u * (uint(at.y) * width + uint(at.x));
%sums     vec4 sums{i} = texelFetch(sums{i}_texture, at, 0);
    vec4 moments = vec4({moments});
    float T = nmt_core_transmittance(steps, codes, {slots}, {n}, {b0}, moments);
    float weight = color.a * T;
    weighted = vec4(weight * color.rgb, weight);
}
