#version {version}
// {api}, resolve: draw three vertices of fullscreen.vert over the opaque image, glBlendFunc(GL_ONE, GL_SRC_ALPHA).
//
// Textures: target 0 of pass 1, then the target of pass 2.
//
%es precision highp float;
%es precision highp int;
%es precision highp sampler2D;
%es
%include nmt_resolve

layout(location = 0) out vec4 result;
{binding0}uniform sampler2D sums0_texture;
{binding1}uniform sampler2D weighted_texture;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    result = nmt_resolve(texelFetch(weighted_texture, at, 0), texelFetch(sums0_texture, at, 0));
}
