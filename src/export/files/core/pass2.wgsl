// WebGPU, pass 2 of a core: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Target 0: rgba16float or rgba32float, blend add, factors one and one, cleared to 0; opaque depth is tested as ever.
// Group 1: the buffer of pass 1, read four words at a time, and its targets.
//
%include nmt_core_transmittance nmt_core_codes nmt_core_steps nmt_core_absorbance_of

struct Frame {
    v0: f32,
    v1: f32,
    columns: u32,
}

@group(0) @binding(0) var<uniform> frame: Frame;
@group(1) @binding(0) var<storage, read> core: array<vec4<u32>>;
@group(1) @binding(1) var sums0_texture: texture_2d<f32>;
@group(1) @binding(2) var sums1_texture: texture_2d<f32>;

struct Varying {
    @invariant @builtin(position) position: vec4<f32>,
    @location(0) v: f32,
    @location(1) color: vec4<f32>,
}

@fragment
fn pass2(in: Varying) -> @location(0) vec4<f32> {
    let at = vec2<u32>(in.position.xy);
    let first = (at.x + at.y * frame.columns) * {vectors}u;
    let sums0 = textureLoad(sums0_texture, at, 0);
    let sums1 = textureLoad(sums1_texture, at, 0);
    // The same expressions as in pass 1.
    let codes = nmt_core_codes(frame.v0, frame.v1);
    let steps = nmt_core_steps(in.v, nmt_core_absorbance_of(in.color.a), codes);
    let T = nmt_core_transmittance(
        steps, codes, {core}, sums1.y, sums0.x, vec4<f32>(sums0.yzw, sums1.x),
    );
    let weight = in.color.a * T;
    return vec4<f32>(weight * in.color.rgb, weight);
}
