// WebGPU, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Target 0: rgba16float or rgba32float, blend add, factors one and one, cleared to 0. Textures of group 1: the targets
// of pass 1.
//
%include nmt_pass2

%log struct Frame {
%log     v0: f32,
%log     v1: f32,
%log }
%log
%log @group(0) @binding(0) var<uniform> frame: Frame;
%sums @group(1) @binding({i}) var sums{i}_texture: texture_2d<f32>;
@group(1) @binding({range}) var range_texture: texture_2d<f32>;

struct Varying {
    @invariant @builtin(position) position: vec4<f32>,
%log     @location(0) v: f32,
    @location(1) color: vec4<f32>,
}

@fragment
fn pass2(in: Varying) -> @location(0) vec4<f32> {
    let at = vec2<i32>(in.position.xy);
    let T = nmt_pass2(
%log         in.v, frame.v0, frame.v1, in.color.a,
%window         in.position.z,
%sums         textureLoad(sums{i}_texture, at, 0),
        textureLoad(range_texture, at, 0),
    );
    let weight = in.color.a * T;
    return vec4<f32>(weight * in.color.rgb, weight);
}
