//! [`recentred`](super::recentred) and [`visible`](super::visible) for sixteen fragments at once, of any pixels, in f32; function by function what those files do, without branches.

use super::recentred::{
    ABSORBANCE_OFFSET, ARITHMETIC, ByCount, INNER_MEAN_DEVIATION, INNER_SPREAD_DEVIATION, INNER_SPREAD_OF_OFFSET,
    INNER_SPREAD_OF_SPREAD, MEAN_DEVIATION, NOISE_GROWTH, SPREAD_DEVIATION, USUAL_INNER_SPREAD, USUAL_NOISE,
    USUAL_SPREAD,
};
use super::visible::{HIDDEN, ORDER};
use crate::numeric::lanes::{exp, ln};
use fearless_simd::prelude::*;
use fearless_simd::{f32x16, mask32x16};

/// Sixteen fragments as pass 2 sees them.
#[derive(Clone, Copy)]
pub struct Fragments<S: Simd, const K: usize> {
    /// Moment depth.
    pub z: f32x16<S>,
    /// Absorbance.
    pub absorbance: f32x16<S>,
    /// Total absorbance of the pixel, Σ A.
    pub b0: f32x16<S>,
    /// Σ A z^k.
    pub b: [f32x16<S>; K],
    /// Number of fragments of the pixel.
    pub count: f32x16<S>,
    /// Middle of the pixel's range of moment depth.
    pub c: f32x16<S>,
    /// Half of that range.
    pub h: f32x16<S>,
    /// Place in a thin pixel's range by view depth; more than 1 where the pixel is not thin.
    pub place: f32x16<S>,
}

/// What follows from them.
#[derive(Clone, Copy)]
pub struct Described<S: Simd, const K: usize> {
    /// Absorbance of the others, b_0'.
    pub others: f32x16<S>,
    /// Position in the pixel's range.
    pub x: f32x16<S>,
    /// Moments of the others there.
    pub m: [f32x16<S>; K],
    /// How much more rounding does to each next moment.
    pub noise_growth: f32x16<S>,
}

#[inline(always)]
fn square<S: Simd>(v: f32x16<S>) -> f32x16<S> {
    v * v
}

/// a + b/n
#[inline(always)]
fn by_count<S: Simd>(simd: S, quantity: ByCount, per_n: f32x16<S>) -> f32x16<S> {
    f32x16::splat(simd, quantity.many as f32) + f32x16::splat(simd, quantity.few as f32) * per_n
}

/// What is best thought of a quantity; see the function of this name beside [`PixelSums`](super::recentred::PixelSums).
#[inline(always)]
fn shrink_to_prior<S: Simd>(
    value: f32x16<S>,
    expected: f32x16<S>,
    noise: f32x16<S>,
    deviation: f32x16<S>,
) -> f32x16<S> {
    let trust = square(deviation);
    expected + (value - expected) * (trust / (trust + square(noise)))
}

/// NaN becomes the lower end.
#[inline(always)]
fn clamp<S: Simd>(x: f32x16<S>, low: f32x16<S>, high: f32x16<S>) -> f32x16<S> {
    x.max_precise(low).min(high)
}

/// Moment depth of view depths between v0 and v1, finite and > 0.
#[inline(always)]
pub fn moment_depth<S: Simd>(simd: S, v: f32x16<S>, [v0, v1]: [f32x16<S>; 2]) -> f32x16<S> {
    let splat = |v: f32| f32x16::splat(simd, v);
    let log_ratio = |a: f32x16<S>, b: f32x16<S>| {
        let s = (a - b) / (a + b);
        let q = s * s;
        let near = (s + s)
            * (splat(1.0)
                + q * (splat(0.333_333_34) + q * (splat(0.2) + q * (splat(0.142_857_15) + q * splat(0.111_111_11)))));
        s.abs().simd_lt(splat(0.2)).select(near, ln(simd, a / b))
    };
    let warped = splat(2.0) * log_ratio(v, v0) / log_ratio(v1, v0).max(splat(1e-30)) - splat(1.0);
    v1.simd_gt(v0)
        .select(clamp(warped, splat(-1.0), splat(1.0)), splat(0.0))
}

impl<S: Simd, const K: usize> Fragments<S, K> {
    /// Takes the fragment's own absorbance out and moves the moments to the pixel's range.
    #[inline(always)]
    pub fn describe(&self, simd: S) -> Described<S, K> {
        let splat = |v: f32| f32x16::splat(simd, v);
        let (zero, one) = (splat(0.0), splat(1.0));
        let others = (self.b0 - self.absorbance).max(zero);
        // Where next to nothing is left, its moments are not asked for, and stay finite.
        let per_b0 = one / others.max(splat(1e-6) * self.b0).max(splat(f32::MIN_POSITIVE));
        let mut own = self.absorbance;
        let mut m: [f32x16<S>; K] = self.b;
        for m in &mut m {
            own *= self.z;
            *m = (*m - own) * per_b0;
        }
        for pass in 0..K {
            for k in (pass..K).rev() {
                let before = if k == 0 { one } else { m[k - 1] };
                m[k] -= self.c * before;
            }
        }
        let h1 = one / self.h;
        let h2 = h1 * h1;
        let powers = [h1, h2, h2 * h1, h2 * h2];
        for (k, m) in m.iter_mut().enumerate() {
            let scaled = if k < 4 {
                *m * powers[k]
            } else {
                *m * powers[3] * powers[k - 4]
            };
            *m = clamp(scaled, -one, one);
        }
        let x = clamp((self.z - self.c) * h1, -one, one);
        let noise_growth = one + (self.c.abs() + self.c.abs()) * h1;
        Described {
            others,
            x,
            m,
            noise_growth,
        }
    }

    /// What rounding may have done to m_1.
    #[inline(always)]
    fn rounding(&self, simd: S, d: &Described<S, K>) -> f32x16<S> {
        f32x16::splat(simd, f32::EPSILON) * d.noise_growth * self.b0 / d.others
    }

    /// What rounding usually has done to m_1.
    #[inline(always)]
    fn noise(&self, simd: S, d: &Described<S, K>) -> f32x16<S> {
        self.rounding(simd, d) * (f32x16::splat(simd, USUAL_NOISE as f32) * self.count.sqrt())
    }

    /// Optical depth in front of a fragment that is one of three or four.
    #[inline(always)]
    pub fn closed_form(&self, simd: S, d: &Described<S, K>) -> f32x16<S> {
        let splat = |v: f32| f32x16::splat(simd, v);
        let (zero, half, one) = (splat(0.0), splat(0.5), splat(1.0));
        let (measure, transition_width) = self.measure(simd, d);
        let [mean, spread, u] = [measure[0], measure[1], measure[2]];
        let of_three = clamp(half - half * mean, zero, one);
        // share_of_four
        let least = splat(1e-6);
        let inner = (one - spread) * (one - mean * mean);
        let near = clamp(half * (one - mean - inner / (one + u).max(least)), zero, one);
        let far = clamp(half * (one + mean - inner / (one - u).max(least)), zero, one);
        let behind = clamp(half + half * (self.position(simd, d) - u) / transition_width, zero, one);
        let of_four = clamp(near + behind * (one - far - near), zero, one);
        d.others * self.count.simd_eq(splat(3.0)).select(of_three, of_four)
    }

    /// Position in the pixel's range; in a thin pixel that of its view depth.
    #[inline(always)]
    fn position(&self, simd: S, d: &Described<S, K>) -> f32x16<S> {
        self.place.simd_le(f32x16::splat(simd, 1.0)).select(self.place, d.x)
    }

    /// The columns of the feature set, in order: the first three, then mean and spread by turns.
    #[inline(always)]
    pub fn features(&self, simd: S, d: &Described<S, K>) -> ([f32x16<S>; 3], [f32x16<S>; K]) {
        let splat = |v: f32| f32x16::splat(simd, v);
        let count = ln(simd, self.count) * splat((std::f64::consts::LOG2_E / 3.0) as f32) - splat(1.0);
        let ln_b0 = ln(simd, d.others + splat(ABSORBANCE_OFFSET));
        ([self.position(simd, d), count, ln_b0], self.measure(simd, d).0)
    }

    /// Means and spreads, and how far the inner mean may usually be off.
    #[inline(always)]
    fn measure(&self, simd: S, d: &Described<S, K>) -> ([f32x16<S>; K], f32x16<S>) {
        let splat = |v: f32| f32x16::splat(simd, v);
        let (zero, half, one) = (splat(0.0), splat(0.5), splat(1.0));
        let least = splat(1e-6);
        let mut q = [one; 9];
        q[1..=K].copy_from_slice(&d.m);
        let mut out = [zero; K];
        let per_n = one / self.count;
        let further = d.noise_growth * splat(NOISE_GROWTH as f32);
        let noise1 = self.noise(simd, d);
        let noise2 = noise1 * further;
        let noise3 = noise2 * further;
        let noise4 = noise3 * further;
        let (mut mean0, mut spread0, mut transition_width) = (zero, zero, one);
        for level in 0..K / 2 {
            let last = K - 2 * level;
            let per_mass = one / q[0].max(least);
            let mut mean = clamp(q[1] * per_mass, -one, one);
            match level {
                0 => mean = shrink_to_prior(mean, zero, noise1, by_count(simd, MEAN_DEVIATION, per_n)),
                1 => {
                    let deviation = by_count(simd, INNER_MEAN_DEVIATION, per_n) * (spread0 + splat(0.02));
                    let noise = noise3 * per_mass;
                    let all = noise + splat(ARITHMETIC as f32 * f32::EPSILON) * per_mass;
                    transition_width = all * deviation / (all + deviation);
                    mean = shrink_to_prior(mean, mean0 * (one - spread0) / (one + spread0), noise, deviation);
                }
                _ => {}
            }
            let most = (one - mean * mean).max(least);
            let mut spread = clamp((q[2] * per_mass - mean * mean) / most, zero, one);
            match level {
                0 => {
                    let expected = by_count(simd, USUAL_SPREAD, per_n);
                    spread = shrink_to_prior(spread, expected, noise2 / most, by_count(simd, SPREAD_DEVIATION, per_n));
                    (mean0, spread0) = (mean, spread);
                }
                1 => {
                    let deviation = by_count(simd, INNER_SPREAD_DEVIATION, per_n) * (spread0 + splat(0.02));
                    let offset = mean * (one + spread0) - mean0 * (one - spread0);
                    let usual = by_count(simd, USUAL_INNER_SPREAD, per_n)
                        + splat(INNER_SPREAD_OF_SPREAD as f32) * square(square(spread0))
                        - splat(INNER_SPREAD_OF_OFFSET as f32) * square(offset);
                    let expected = clamp(usual * spread0 / (one + spread0 + spread0), zero, one);
                    spread = shrink_to_prior(spread, expected, noise4 * per_mass / most, deviation).sqrt();
                }
                _ => {
                    spread = spread.sqrt();
                    let mut noise = self.rounding(simd, d) * per_mass;
                    for _ in 1..2 * level + 1 {
                        noise *= d.noise_growth;
                    }
                    mean *= one / (one + noise * noise);
                    noise *= d.noise_growth;
                    spread = half + (spread - half) * (one / (one + noise * noise));
                }
            }
            out[2 * level] = mean;
            out[2 * level + 1] = spread;
            for k in 0..=last - 2 {
                let beyond = q[k + 2];
                q[k] -= beyond;
            }
        }
        (out, transition_width)
    }

    /// Which of these fragments, if they lie deep enough to be looked at, are hidden.
    #[inline(always)]
    pub fn hidden(&self, simd: S, d: &Described<S, K>) -> mask32x16<S> {
        let splat = |v: f32| f32x16::splat(simd, v);
        let (zero, one, two) = (splat(0.0), splat(1.0), splat(2.0));
        let eps = splat(f32::EPSILON);
        let noise = (self.count + splat(16.0)) * eps * self.b0 / d.others;
        let position = splat(ORDER as f32) / self.h;
        let noise_of_depth = (self.count + splat(4.0)) * eps * self.b0 + splat(1e-5);
        // most_behind
        let margin = splat(1e-5);
        let end = one + position;
        let x = d.x - position;
        let (rho, m) = (d.noise_growth, &d.m);
        let ahead = x - m[0];
        let variance = (m[1] - m[0] * m[0]).max(zero);
        let r = m[0] - variance / ahead;
        let bound = (m[1] - two * r * m[0] + r * r + noise * square(rho + r.abs())) / square(x - r);
        let (w0, w1, w2) = (one - m[1], m[0] - m[2], m[1] - m[3]);
        let inner = (w2 - x * w1) / (w1 - x * w0);
        let r = (inner.simd_ge(-end) & inner.simd_lt(x)).select(inner, r.max(-one));
        let per_value = one / ((end + x) * square(x - r)).max(splat(1e-30));
        let there = two * end * square(end - r) * per_value;
        let gamma = (one - margin) * (one - one / there) / (end - x);
        let p = [end * r * r, r * r - two * r * end, end - two * r, one];
        let lift = one + gamma * x;
        let value = p[0] * lift
            + (p[1] * lift - gamma * p[0]) * m[0]
            + (p[2] * lift - gamma * p[1]) * m[1]
            + (p[3] * lift - gamma * p[2]) * m[2]
            - gamma * m[3];
        let lost = noise * (end + rho) * square(rho + r.abs()) * (one + gamma * (x.abs() + rho));
        let share = bound.min_precise((value + lost) * per_value) * (one + margin);
        // NaN is not less than 1 either.
        let behind = (ahead.simd_gt(zero) & share.simd_lt(one)).select(share.max(zero), one);
        // is_hidden
        let least_depth = d.others * (one - behind) - noise_of_depth;
        let beta = d.others * behind + self.absorbance;
        (exp(simd, -least_depth) * beta.min(self.count - two)).simd_le(splat(HIDDEN))
    }
}
