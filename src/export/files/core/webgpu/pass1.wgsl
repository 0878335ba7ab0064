// WebGPU, pass 1: draw every transparent surface, in any order, without writing depth.
//
%webgpu // The fragment shader writes to a storage buffer even where a depth test fails behind it: discard what lies behind the
%webgpu // opaque depth, read as a texture, before nmt_core_insert.
%webgpu //
%sums // Target {i}: {format{i}}, blend add, factors one and one, cleared to 0.
%webgpu // Buffer of group 3: {words} words a pixel, cleared to 0.
%metal // Buffer {range}: {words} words a pixel, cleared to 0. Buffer 0: the uniforms.
//
%include nmt_core_insert nmt_core_codes nmt_core_steps nmt_core_absorbance_of nmt_core_moments nmt_core_absorbance

struct Frame {
    // Least and greatest distance along the view direction of what is transparent.
    v0: f32,
    v1: f32,
    // Columns of the image.
    width: u32,
}

@group(0) @binding(0) var<uniform> frame: Frame;

struct Varying {
    @invariant @builtin(position) position: vec4<f32>,
    // Distance along the view direction.
    @location(0) v: f32,
    // Not premultiplied.
    @location(1) color: vec4<f32>,
}

struct Targets {
%sums     @location({i}) sums{i}: vec4<f32>,
}

@fragment
fn pass1(in: Varying) -> Targets {
    let codes = nmt_core_codes(frame.v0, frame.v1);
    let steps = nmt_core_steps(in.v, nmt_core_absorbance_of(in.color.a), codes);
    let at = vec2<u32>(in.position.xy);
    nmt_core_insert(at.y * frame.width + at.x, steps, codes);
    let absorbance = nmt_core_absorbance(steps);
    let b = nmt_core_moments(steps);
    let n = select(0.0, 1.0, steps.y > 0u);
    return Targets({terms});
}
