#version {version}
// {api}, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// glBlendFunc(GL_ONE, GL_ONE), GL_FUNC_ADD; target GL_RGBA16F or GL_RGBA32F, cleared to 0. Textures: the targets of
// pass 1.
//
%es precision highp float;
%es precision highp int;
%es precision highp sampler2D;
%es
%include nmt_pass2

%log {in0}in float v;
{in1}in vec4 color;
layout(location = 0) out vec4 weighted;
%log {uniform0}uniform vec2 v_range;
%sums {binding{i}}uniform sampler2D sums{i}_texture;
{binding{range}}uniform sampler2D range_texture;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float T = nmt_pass2(
%log         v, v_range.x, v_range.y, color.a,
%window         gl_FragCoord.z,
%sums         texelFetch(sums{i}_texture, at, 0),
        texelFetch(range_texture, at, 0));
    float weight = color.a * T;
    weighted = vec4(weight * color.rgb, weight);
}
