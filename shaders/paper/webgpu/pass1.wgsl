// WebGPU, pass 1: draw every transparent surface, in any order, without writing depth.
//
// Target 0: rgba32float, blend add, factors one and one, cleared to 0.
// Target 1: rg32float, blend add, factors one and one, cleared to 0.
// Target 2: rg32float, blend max, factors one and one, cleared to -3e38.
//
// Neural moment transparency: network 'paper', 7-32-16-1, 752 multiply-adds.
// Provenance: nmt 0.1.0, commit 122c62af9569, backend fused, seed 1, epochs 1000, dataset 7efe7a15adf78c7d3c08d1766f86933c7206479e931a41fb0eb5cd099252fcd5.
// Measured on fresh pixels of the training distribution: mean squared error of T 5.094e-3, worst 0.657.

// Absorbance of a fragment, min(-ln(1 - alpha), 10), accurate for faint fragments too.
fn nmt_absorbance(alpha: f32) -> f32 {
    let faint = alpha * (1.0 + alpha * (0.5 + alpha * (0.33333334 + alpha * (0.25 + alpha * 0.2))));
    return select(-log(max(1.0 - alpha, 4.539993e-5)), faint, 0.03 > alpha);
}

// Pass 1: what a fragment at window depth w adds to b1..b4; to b0 it adds its absorbance.
fn nmt_moments(w: f32, absorbance: f32) -> vec4<f32> {
    let z = 2.0 * w - 1.0;
    let b1 = absorbance * z;
    let b2 = b1 * z;
    let b3 = b2 * z;
    let b4 = b3 * z;
    return vec4<f32>(b1, b2, b3, b4);
}

// What pass 1 writes of a fragment, and what pass 2 reads of its pixel, a vector a render target.
struct NmtSums {
    // (b0, b1, b2, b3): blended by addition, cleared to 0.
    sums0: vec4<f32>,
    // (b4, number of fragments, 0, 0): blended by addition, cleared to 0.
    sums1: vec4<f32>,
    // (-w, w, 0, 0): blended by max, cleared to -3e38, so that it holds -w_min and w_max. Two channels, f32 always.
    range: vec4<f32>,
}

// Pass 1 in one call. w is window depth in [0, 1], the same bits in both passes.
fn nmt_pass1(w: f32, alpha: f32) -> NmtSums {
    let absorbance = nmt_absorbance(alpha);
    let b = nmt_moments(w, absorbance);
    return NmtSums(vec4<f32>(absorbance, b.xyz), vec4<f32>(b.w, 1.0, 0.0, 0.0), vec4<f32>(-w, w, 0.0, 0.0));
}

struct Varying {
    @invariant @builtin(position) position: vec4<f32>,
    // Not premultiplied.
    @location(1) color: vec4<f32>,
}

struct Targets {
    @location(0) sums0: vec4<f32>,
    @location(1) sums1: vec4<f32>,
    @location(2) range: vec4<f32>,
}

@fragment
fn pass1(in: Varying) -> Targets {
    let sums = nmt_pass1(in.position.z, in.color.a);
    return Targets(sums.sums0, sums.sums1, sums.range);
}
