#version {version}
// {api}, pass 1: draw every transparent surface, in any order, without writing depth.
//
// glBlendFunc(GL_ONE, GL_ONE); glBlendEquationi(i, ...) with GL_FUNC_ADD, and with GL_MAX for target {range}.
%sums // Target {i}: {glformat{i}}, cleared to 0.
// Target {range}: GL_RG32F, cleared to -3e38.
//
%es precision highp float;
%es precision highp int;
%es
%include nmt_pass1

%log // Distance along the view direction.
%log {in0}in float v;
// Not premultiplied.
{in1}in vec4 color;
%sums layout(location = {i}) out vec4 sums{i};
layout(location = {range}) out vec4 range;
%log // Least and greatest v of what is transparent.
%log {uniform0}uniform vec2 v_range;

void main() {
%log     NmtSums sums = nmt_pass1(v, v_range.x, v_range.y, color.a);
%window     NmtSums sums = nmt_pass1(gl_FragCoord.z, color.a);
%sums     sums{i} = sums.sums{i};
    range = sums.range;
}
