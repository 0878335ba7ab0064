// WebGPU, pass 1: draw every transparent surface, in any order, without writing depth.
//
// Target 0: rgba32float, blend add, factors one and one, cleared to 0.
// Target 1: rgba32float, blend add, factors one and one, cleared to 0.
// Target 2: rg32float, blend max, factors one and one, cleared to -3e38.
//
// Neural moment transparency: network 'moments-6', 9-32-16-1, 816 multiply-adds.
// Provenance: nmt 0.1.0, commit 122c62af9569, backend fused, seed 1, epochs 600, dataset 37f23ca23c85cddd29cc28c82e42ad387652d607b62fdde6a7e9a18fca6b8f75.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.305e-3, worst 0.995.

// Absorbance of a fragment, min(-ln(1 - alpha), 10), accurate for faint fragments too.
fn nmt_absorbance(alpha: f32) -> f32 {
    let faint = alpha * (1.0 + alpha * (0.5 + alpha * (0.33333334 + alpha * (0.25 + alpha * 0.2))));
    return select(-log(max(1.0 - alpha, 4.539993e-5)), faint, 0.03 > alpha);
}

// ln(a / b), as accurate relative to itself where a is near b as elsewhere.
fn nmt_log_ratio(a: f32, b: f32) -> f32 {
    let s = (a - b) / (a + b);
    let q = s * s;
    return select(log(a / b), (s + s) * (1.0 + q * (0.33333334 + q * (0.2 + q * (0.14285715 + q * 0.11111111)))),
        0.2 > abs(s));
}

// Moment depth of view depth v; v0 and v1 are the least and the greatest of the scene. Where a prepass has found the
// pixel's own nearest and farthest view depth, these may be v0 and v1 in both passes: then no pixel is too thin for its
// moments.
fn nmt_moment_depth(v: f32, v0: f32, v1: f32) -> f32 {
    return select(0.0, clamp(2.0 * nmt_log_ratio(v, v0) / max(nmt_log_ratio(v1, v0), 1e-30) - 1.0, -1.0, 1.0), v1 > v0);
}

// Pass 1: what a fragment at moment depth z adds to b1, b2 and so on; to b0 it adds its absorbance, to n it adds 1.
fn nmt_moments(z: f32, absorbance: f32) -> mat2x4<f32> {
    let moment1 = absorbance * z;
    let moment2 = moment1 * z;
    let moment3 = moment2 * z;
    let moment4 = moment3 * z;
    let moment5 = moment4 * z;
    let moment6 = moment5 * z;
    return mat2x4<f32>(vec4<f32>(moment1, moment2, moment3, moment4), vec4<f32>(moment5, moment6, 0.0, 0.0));
}

// What pass 1 writes of a fragment, and what pass 2 reads of its pixel, a vector a render target.
struct NmtSums {
    // (b0, b1, b2, b3): blended by addition, cleared to 0.
    sums0: vec4<f32>,
    // (b4, b5, b6, number of fragments): blended by addition, cleared to 0.
    sums1: vec4<f32>,
    // (-v, v, 0, 0): blended by max, cleared to -3e38, so that it holds -nearest and farthest. Two channels, f32
    // always.
    range: vec4<f32>,
}

// Pass 1 in one call. v is distance along the view direction, the same bits in both passes; v0 and v1 are the least and
// the greatest v of the scene.
fn nmt_pass1(v: f32, v0: f32, v1: f32, alpha: f32) -> NmtSums {
    let absorbance = nmt_absorbance(alpha);
    let b = nmt_moments(nmt_moment_depth(v, v0, v1), absorbance);
    return NmtSums(vec4<f32>(absorbance, b[0].xyz), vec4<f32>(b[0].w, b[1].xy, 1.0), vec4<f32>(-v, v, 0.0, 0.0));
}

struct Frame {
    // Least and greatest distance along the view direction of what is transparent.
    v0: f32,
    v1: f32,
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
    @location(0) sums0: vec4<f32>,
    @location(1) sums1: vec4<f32>,
    @location(2) range: vec4<f32>,
}

@fragment
fn pass1(in: Varying) -> Targets {
    let sums = nmt_pass1(in.v, frame.v0, frame.v1, in.color.a);
    return Targets(sums.sums0, sums.sums1, sums.range);
}
