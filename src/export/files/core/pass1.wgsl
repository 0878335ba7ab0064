// WebGPU, pass 1 of a core: draw every transparent surface, in any order, without writing depth.
//
%sums // Target {i}: {format{i}}, blend add, factors one and one, cleared to 0.
// Buffer nmt_core: {slots} words a pixel, cleared to 0. What a fragment writes there stays whatever a depth test says
// later, so that opaque depth is looked at here.
//
%include nmt_core_insert nmt_core_codes nmt_core_steps nmt_core_absorbance_of nmt_core_moments nmt_core_absorbance

struct Frame {
    // Least and greatest distance along the view direction of what is transparent.
    v0: f32,
    v1: f32,
    // Columns of the image.
    columns: u32,
}

@group(0) @binding(0) var<uniform> frame: Frame;
@group(1) @binding(0) var<storage, read_write> nmt_core: array<atomic<u32>>;
@group(1) @binding(1) var opaque_depth: texture_depth_2d;

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
    let at = vec2<u32>(in.position.xy);
    if (in.position.z > textureLoad(opaque_depth, at, 0)) {
        discard;
    }
    let codes = nmt_core_codes(frame.v0, frame.v1);
    let steps = nmt_core_steps(in.v, nmt_core_absorbance_of(in.color.a), codes);
    nmt_core_insert(at.x + at.y * frame.columns, steps, codes);
    let moments = nmt_core_moments(steps);
    let n = select(0.0, 1.0, steps.y > 0u);
    return Targets(vec4<f32>(nmt_core_absorbance(steps), moments.xyz), vec4<f32>(moments.w, n, 0.0, 0.0));
}
