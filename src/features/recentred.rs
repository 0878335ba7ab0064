//! Recentred features: what the other fragments of a pixel look like from the pixel's own depth range, with everything taken out that is known exactly.
//!
//! Pass 1 adds up b_0..b_K, counts fragments and keeps the nearest and the farthest view depth. Pass 2 removes the fragment's own absorbance,
//! moves the moments to the pixel's own range [−1, 1], and describes the measure μ of the other fragments' absorbance by means and spreads:
//! of μ itself, then of (1 − x²) μ, which no longer holds the two known fragments at the ends, and so on. Each spread is the variance as a share
//! of the greatest that the mean allows, so that every feature has its range whatever the others are (canonical moments are built alike).

use crate::numeric::Real;

/// Added to b_0' before its logarithm is taken, so that a faint pixel stays finite.
pub const ABSORBANCE_OFFSET: f32 = 0.05;

/// Column of ln(b_0' + [`ABSORBANCE_OFFSET`]).
pub const ABSORBANCE_COLUMN: usize = 2;

/// Columns before the description of the measure.
const FIXED: usize = 3;

/// Names of the columns with 8 moments; with fewer, the first ones.
const COLUMNS: [&str; 11] =
    ["x", "count", "ln_b0", "mean", "spread", "inner_mean", "inner_spread", "inner2_mean", "inner2_spread", "inner3_mean", "inner3_spread"];

/// Names of the columns with K moments.
pub fn columns(moments: usize) -> &'static [&'static str] {
    &COLUMNS[..FIXED + moments]
}

/// What the columns mean.
pub const DESCRIPTION: [&str; 12] = [
    "v is distance along the view direction and z = 2 ln(v/v0)/ln(v1/v0) - 1 moment depth, v0 and v1 the scene's least and greatest v;",
    "pass 1 adds up b_k = sum of A z^k, counts fragments (n) and keeps the pixel's least and greatest v as f32.",
    "A = min(-ln(1 - alpha), 10) is a fragment's absorbance; primed quantities leave out the fragment's own, b_k' = b_k - A z^k.",
    "c and h are middle and half of the pixel's range of z; m_k = moments of the others in (z - c)/h, normalised by b_0'.",
    "x = (z - c)/h, count = log2(n)/3 - 1, ln_b0 = ln(b_0' + 0.05);",
    "mean = m_1, spread = (m_2 - m_1^2)/(1 - m_1^2); inner_ of (1 - x^2) times the measure: mean = (m_1 - m_3)/(1 - m_2),",
    "spread = the square root of the same ratio of its own; inner2_ and inner3_ of (1 - x^2)^2 and (1 - x^2)^3.",
    "The answer is T = exp(-b_0' s), s the network's sigmoid: the share of the other absorbance that lies in front.",
    "Not part of the network, and to be applied before it, in this order: nearest in its pixel (v compared bit for bit): T = 1;",
    "b_0' <= 1e-6 b_0: T = 1; farthest: T = exp(-b_0'); three fragments: T = exp(-b_0' (1 - m_1)/2);",
    "four fragments, where rounding allows: the closed form in nmt_recentred.",
    "So pixels of up to three fragments, and all that is nearest or farthest, never need the network.",
];

/// A pixel after pass 1.
///
/// # Source
/// NMT24 Eq. 5; count and depth range as NMT24 Sec. 4, but the range as f32 view depth.
#[derive(Debug, Clone, Copy)]
pub struct PixelSums<R, const K: usize> {
    /// Σ A.
    pub b0: R,
    /// Σ A z^k, k = 1..=K.
    pub b: [R; K],
    /// Number of fragments.
    pub count: u32,
    /// Least view depth.
    pub nearest: f32,
    /// Greatest view depth.
    pub farthest: f32,
}

impl<R: Real, const K: usize> Default for PixelSums<R, K> {
    fn default() -> Self {
        Self { b0: R::ZERO, b: [R::ZERO; K], count: 0, nearest: f32::INFINITY, farthest: f32::NEG_INFINITY }
    }
}

/// A fragment as both passes see it.
#[derive(Debug, Clone, Copy)]
pub struct Seen<R> {
    /// View depth, as the depth range keeps it.
    pub view_z: f32,
    /// Moment depth.
    pub z: R,
    /// Absorbance.
    pub absorbance: R,
}

impl<R: Real> Seen<R> {
    /// What the fragment adds to b_1..b_K; pass 2 takes away the same numbers.
    fn moments<const K: usize>(&self) -> [R; K] {
        let mut term = self.absorbance;
        std::array::from_fn(|_| {
            term *= self.z;
            term
        })
    }
}

/// What pass 2 knows of a fragment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Known<R, const K: usize> {
    /// Its transmittance, without a network.
    Transmittance(R),
    /// Features for the network: x, count, ln_b0, then mean and spread by turns.
    Features([R; 3], [R; K]),
}

/// Least half-range of a pixel in moment depth; f32 hardly tells nearer depths apart.
pub const LEAST_HALF_RANGE: f64 = 1e-8;

/// Greatest error of s that a closed form of four fragments may have by its own estimate; beyond, the network answers.
///
/// # Accuracy
/// Measured: see `four_fragments_switch_where_the_network_is_better`.
pub const CLOSED_FORM_TOLERANCE: f64 = 0.02;

impl<R: Real, const K: usize> PixelSums<R, K> {
    /// Pass 1: adds a fragment.
    pub fn add(&mut self, seen: Seen<R>) {
        self.b0 += seen.absorbance;
        for (b, term) in self.b.iter_mut().zip(seen.moments::<K>()) {
            *b += term;
        }
        self.count += 1;
        self.nearest = self.nearest.min(seen.view_z);
        self.farthest = self.farthest.max(seen.view_z);
    }

    /// Pass 2: the exact rules, the closed forms, and where they end the features.
    ///
    /// `ends` are the moment depths of the nearest and the farthest view depth.
    ///
    /// # Domain
    /// A fragment that pass 1 has added. Whatever rounding has done to the sums, the answer is in [0, 1] and the features are finite and within
    /// their ranges.
    pub fn look(&self, seen: Seen<R>, ends: [R; 2]) -> Known<R, K> {
        let others = (self.b0 - seen.absorbance).max(R::ZERO);
        if seen.view_z == self.nearest || others <= R::from_f64(1e-6) * self.b0 {
            return Known::Transmittance(R::ONE);
        }
        if seen.view_z == self.farthest {
            return Known::Transmittance((-others).exp());
        }
        let half = R::from_f64(0.5);
        let (c, h) = (half * (ends[0] + ends[1]), (half * (ends[1] - ends[0])).max(R::from_f64(LEAST_HALF_RANGE)));
        let m = self.recentred(seen, others, c, h);
        if let Some(s) = self.closed_form(seen, others, c, h, &m) {
            return Known::Transmittance((-(others * s)).exp());
        }
        let x = clamp((seen.z - c) / h, -R::ONE, R::ONE);
        let count = R::from_f64(f64::from(self.count));
        // log2(n)/3 − 1
        let count = count.ln() * R::from_f64(std::f64::consts::LOG2_E / 3.0) - R::ONE;
        Known::Features([x, count, (others + R::from_f32(ABSORBANCE_OFFSET)).ln()], describe(&m))
    }

    /// m_1..m_K of the other fragments, in [−1, 1] whatever rounding has done.
    fn recentred(&self, seen: Seen<R>, others: R, c: R, h: R) -> [R; K] {
        let own = seen.moments::<K>();
        let per_b0 = R::ONE / others;
        let mut m: [R; K] = std::array::from_fn(|k| (self.b[k] - own[k]) * per_b0);
        // Moments of z − c, one factor at a time: E[z^{k−j} (z − c)^j] = E[z^{k−j+1} (z − c)^{j−1}] − c E[z^{k−j} (z − c)^{j−1}].
        for pass in 0..K {
            for k in (pass..K).rev() {
                let before = if k == 0 { R::ONE } else { m[k - 1] };
                m[k] = m[k] - c * before;
            }
        }
        // No factor overflows, so that 0 stays 0 however thin the pixel.
        let h1 = R::ONE / h;
        let h2 = h1 * h1;
        let powers = [h1, h2, h2 * h1, h2 * h2];
        for (k, m) in m.iter_mut().enumerate() {
            let scaled = if k < 4 { *m * powers[k] } else { *m * powers[3] * powers[k - 4] };
            *m = clamp(scaled, -R::ONE, R::ONE);
        }
        m
    }

    /// The share in front of a fragment that is one of three, or one of four where rounding leaves that well conditioned.
    ///
    /// The nearest and the farthest of the pixel are known atoms at −1 and 1. With three fragments they are all the others, and their mean says how they
    /// share. With four there is one atom more, at u with mass a: (1 − x²) dμ holds it alone, so u = (m_1 − m_3)/(1 − m_2) and a = (1 − m_2)/(1 − u²).
    fn closed_form(&self, seen: Seen<R>, others: R, c: R, h: R, m: &[R; K]) -> Option<R> {
        let half = R::from_f64(0.5);
        if self.count == 3 {
            return Some(clamp(half * (R::ONE - m[0]), R::ZERO, R::ONE));
        }
        if self.count != 4 || K < 3 {
            return None;
        }
        // What rounding may have done to m_k: half an ulp of b_0, carried through the shift and the scale.
        let reach = R::ONE + (c.abs() + c.abs()) / h;
        let e1 = R::EPSILON * reach * self.b0 / others;
        let (e2, e3) = (e1 * reach, e1 * reach * reach);
        let inner = R::ONE - m[1];
        if inner <= R::ZERO {
            return None;
        }
        let u = clamp((m[0] - m[2]) / inner, -R::ONE, R::ONE);
        let u_error = (e1 + e3 + u.abs() * e2) / inner;
        let x = (seen.z - c) / h;
        let in_front = u < x;
        // The end on the fragment's far side decides: s = A_near, or 1 − A_far.
        let sign = if in_front { -R::ONE } else { R::ONE };
        let gap = R::ONE + sign * u;
        if gap <= R::ZERO {
            return None;
        }
        let end = half * (R::ONE - sign * m[0] - inner / gap);
        let mut error = half * (e1 + e2 / gap + inner * u_error / (gap * gap));
        if (x - u).abs() <= u_error {
            error += inner / (R::ONE - u * u).max(R::EPSILON);
        }
        let share = if in_front { R::ONE - end } else { end };
        (error * others.min(R::ONE) <= R::from_f64(CLOSED_FORM_TOLERANCE)).then(|| clamp(share, R::ZERO, R::ONE))
    }
}

/// Means and spreads of a measure and of what is left of it as (1 − x²) takes its ends out again and again.
fn describe<R: Real, const K: usize>(m: &[R; K]) -> [R; K] {
    let mut q = [R::ONE; 9];
    q[1..=K].copy_from_slice(m);
    let least = R::from_f64(1e-6);
    let mut out = [R::ZERO; K];
    for (level, out) in out.chunks_exact_mut(2).enumerate() {
        let last = K - 2 * level;
        let per_mass = R::ONE / q[0].max(least);
        let mean = clamp(q[1] * per_mass, -R::ONE, R::ONE);
        let spread = (q[2] * per_mass - mean * mean) / (R::ONE - mean * mean).max(least);
        let spread = clamp(spread, R::ZERO, R::ONE);
        out[0] = mean;
        out[1] = if level == 0 { spread } else { spread.sqrt() };
        for k in 0..=last - 2 {
            q[k] = q[k] - q[k + 2];
        }
    }
    out
}

/// NaN becomes the lower end.
fn clamp<R: Real>(x: R, low: R, high: R) -> R {
    x.max(low).min(high)
}
