// WebGPU, pass 1: draw every transparent surface, in any order, without writing depth.
//
%sums // Target {i}: {format{i}}, blend add, factors one and one, cleared to 0.
// Target {range}: rg32float, blend max, factors one and one, cleared to -3e38.
//
%include nmt_pass1

%log struct Frame {
%log     // Least and greatest distance along the view direction of what is transparent.
%log     v0: f32,
%log     v1: f32,
%log }
%log
%log @group(0) @binding(0) var<uniform> frame: Frame;
%log
struct Varying {
    @invariant @builtin(position) position: vec4<f32>,
%log     // Distance along the view direction.
%log     @location(0) v: f32,
    // Not premultiplied.
    @location(1) color: vec4<f32>,
}

struct Targets {
%sums     @location({i}) sums{i}: vec4<f32>,
    @location({range}) range: vec4<f32>,
}

@fragment
fn pass1(in: Varying) -> Targets {
%log     let sums = nmt_pass1(in.v, frame.v0, frame.v1, in.color.a);
%window     let sums = nmt_pass1(in.position.z, in.color.a);
    return Targets({sums}, sums.range);
}
