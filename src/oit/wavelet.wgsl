// Wavelet transparency, the twin of wavelet.rs. WAVELET_RANK and WAVELET_LOG stand before it; a pixel has OIT_SUMS = 2^(rank + 1) coefficients.

// Place of a fragment in [0, (N - 1)/N]; 0 where the pixel has one depth.
fn wavelet_place(v: f32, nearest: f32, farthest: f32) -> f32 {
    if (!(farthest > nearest)) {
        return 0.0;
    }
    let d = select((v - nearest) / (farthest - nearest), log(v / nearest) / log(farthest / nearest), WAVELET_LOG);
    return clamp(d, 0.0, 1.0) * (1.0 - 1.0 / f32(OIT_SUMS));
}

// Adds what a fragment at x has in one coefficient a level, and in the mean.
fn wavelet_add(c: ptr<function, array<f32, OIT_SUMS>>, x: f32, absorbance: f32) {
    for (var p = 0u; p <= WAVELET_RANK; p++) {
        let intervals = f32(1u << p);
        let k = floor(intervals * x);
        let u = x - k / intervals;
        (*c)[(1u << p) - 1u + u32(k)] += absorbance * sqrt(intervals) * min(u, 1.0 / intervals - u);
    }
    (*c)[OIT_SUMS - 1u] += absorbance * (1.0 - x);
}

// The mean over cell j of the absorbance in front.
fn wavelet_cell(c: ptr<function, array<f32, OIT_SUMS>>, j: u32) -> f32 {
    var f = (*c)[OIT_SUMS - 1u];
    for (var p = 0u; p <= WAVELET_RANK; p++) {
        let term = sqrt(f32(1u << p)) * (*c)[(1u << p) - 1u + (j >> (WAVELET_RANK + 1u - p))];
        f += select(-term, term, ((j >> (WAVELET_RANK - p)) & 1u) == 1u);
    }
    return f;
}

// Absorbance in front of x.
fn wavelet_in_front(c: ptr<function, array<f32, OIT_SUMS>>, x: f32) -> f32 {
    let at = f32(OIT_SUMS) * x;
    let j = min(u32(at), OIT_SUMS - 1u);
    let behind = wavelet_cell(c, j);
    var before = 0.0;
    if (j > 0u) {
        before = wavelet_cell(c, j - 1u);
    }
    return before + (behind - before) * (at - f32(j));
}

fn oit_add_to(sums: ptr<function, array<f32, OIT_SUMS>>, f: OitFragment, nearest: f32, farthest: f32) {
    wavelet_add(sums, wavelet_place(f.v, nearest, farthest), f.absorbance);
}

fn oit_weight(f: OitFragment, p: OitPixel) -> f32 {
    var others = p.sums;
    var least = 0.0;
    if (WAVELET_LOG) {
        let total = wavelet_cell(&others, OIT_SUMS - 1u);
        let rest = max(total - f.absorbance, 0.0);
        least = min(exp(-rest), 1.0);
        if (f.v == p.nearest || rest <= 1e-6 * total) {
            return 1.0;
        }
        if (f.v == p.farthest) {
            return least;
        }
    }
    let x = wavelet_place(f.v, p.nearest, p.farthest);
    wavelet_add(&others, x, -f.absorbance);
    return clamp(exp(-wavelet_in_front(&others, x)), least, 1.0);
}
