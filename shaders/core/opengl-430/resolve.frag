#version 430
// OpenGL 4.3, resolve: draw three vertices of fullscreen.vert over the opaque image, glBlendFunc(GL_ONE, GL_SRC_ALPHA).
//
// Textures: target 0 of pass 1, then the target of pass 2.
//
// Neural moment transparency: network 'core', 9-32-16-1, 816 multiply-adds.
// Provenance: nmt 0.1.0, commit a848199e5c6e, backend fused, seed 2, epochs 1500, dataset 01b6983dc69ed68b847bc6fa4ad020706782ce5990d348cf55044a5188b5ba4f.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.202e-3, worst 1.000.

// Resolve: what lies over the background, of the sum that pass 2 has made, and in alpha how much of the background
// shows through: result.rgb + result.a * background. As a blend state: source factor one, destination factor source
// alpha.
vec4 nmt_resolve(vec4 weighted, vec4 sums0) {
    float behind = exp(-sums0.x);
    float scale = (weighted.w > 0.0 ? (1.0 - behind) / max(weighted.w, 1e-37) : 0.0);
    return vec4(scale * weighted.x, scale * weighted.y, scale * weighted.z, behind);
}

layout(location = 0) out vec4 result;
layout(binding = 0) uniform sampler2D sums0_texture;
layout(binding = 1) uniform sampler2D weighted_texture;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    result = nmt_resolve(texelFetch(weighted_texture, at, 0), texelFetch(sums0_texture, at, 0));
}
