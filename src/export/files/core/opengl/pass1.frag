#version {version}
// {api}, pass 1: draw every transparent surface, in any order, without writing depth.
//
// glBlendFunc(GL_ONE, GL_ONE); glBlendEquation(GL_FUNC_ADD).
%sums // Target {i}: {glformat{i}}, cleared to 0.
// Storage buffer at binding 0: {words} words a pixel, cleared to 0; a barrier with GL_SHADER_STORAGE_BARRIER_BIT between
// the passes.
//
%es precision highp float;
%es precision highp int;
%es
%include nmt_core_insert nmt_core_codes nmt_core_steps nmt_core_absorbance_of nmt_core_moments nmt_core_absorbance

// Atomics write even where a depth test behind the shader fails.
layout(early_fragment_tests) in;

// Distance along the view direction.
{in0}in float v;
// Not premultiplied.
{in1}in vec4 color;
%sums layout(location = {i}) out vec4 sums{i};
// Least and greatest v of what is transparent.
{uniform0}uniform vec2 v_range;
// Columns of the image.
{uniform1}uniform uint width;

void main() {
    NmtCodes codes = nmt_core_codes(v_range.x, v_range.y);
    uvec2 steps = nmt_core_steps(v, nmt_core_absorbance_of(color.a), codes);
    uvec2 at = uvec2(gl_FragCoord.xy);
    nmt_core_insert(at.y * width + at.x, steps, codes);
    float absorbance = nmt_core_absorbance(steps);
    vec4 b = nmt_core_moments(steps);
    float n = steps.y > 0u ? 1.0 : 0.0;
%sums     sums{i} = {terms{i}};
}
