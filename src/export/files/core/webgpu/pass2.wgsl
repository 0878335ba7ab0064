// WebGPU, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Target 0: rgba16float or rgba32float, blend add, factors one and one, cleared to 0.
%webgpu // Textures of group 1: the targets of pass 1; behind them the buffer of pass 1, as pairs.
%metal // Textures: the targets of pass 1. Buffer {range}: that of pass 1. Buffer 0: the uniforms.
//
%include nmt_core_transmittance nmt_core_codes nmt_core_steps nmt_core_absorbance_of

struct Frame {
    v0: f32,
    v1: f32,
    width: u32,
}

@group(0) @binding(0) var<uniform> frame: Frame;
%sums @group(1) @binding({i}) var sums{i}_texture: texture_2d<f32>;
@group(1) @binding({range}) var<storage, read> core: array<vec2<u32>>;

struct Varying {
    @invariant @builtin(position) position: vec4<f32>,
    @location(0) v: f32,
    @location(1) color: vec4<f32>,
}

@fragment
fn pass2(in: Varying) -> @location(0) vec4<f32> {
    let codes = nmt_core_codes(frame.v0, frame.v1);
    let steps = nmt_core_steps(in.v, nmt_core_absorbance_of(in.color.a), codes);
    let at = vec2<u32>(in.position.xy);
    let first = {pairs}u * (at.y * frame.width + at.x);
%sums     let sums{i} = textureLoad(sums{i}_texture, at, 0);
    let moments = vec4<f32>({moments});
    let T = nmt_core_transmittance(steps, codes, {slots}, {n}, {b0}, moments);
    let weight = in.color.a * T;
    return vec4<f32>(weight * in.color.rgb, weight);
}
