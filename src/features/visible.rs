//! What cannot be seen: fragments whose answer may be replaced by a cheap one, with a bound on what that does to the
//! image.
//!
//! # Two sets of answers
//!
//! NMT24 Eq. 7 composites C = (1 − e^−b_0) Σ a t C_i / Σ a t + e^−b_0 C_bg. Let the answers t become u, d_i = a_i (u_i
//! − t_i), W = Σ a t, U = Σ a u, and m the weighted mean colour under t. Then C_u − C_t = (1 − e^−b_0) Σ d_i (C_i − m)
//! / U, and the same over W with the mean under u. Colours lie in [0, 1], so
//!
//! |C_u − C_t| ≤ (1 − e^−b_0) max(D⁺, D⁻) / max(U, W),
//!
//! D⁺ and D⁻ the sums of the positive and of the negative d. Two rules keep this below half a display step, 1/512, in
//! every channel. Both need only what pass 2 has at hand, in any order of the fragments.
//!
//! # Faint pixels
//!
//! Every answer lies between e^−b_0' and 1, b_0' ≤ b_0 the absorbance of the others, whatever the network says. Answer
//! u = e^(−b_0'/2), the middle: then 1 − t/u ≤ 1 − e^(−b_0/2) and t/u − 1 ≤ e^(b_0/2) − 1, so D⁺ and D⁻ are at most
//! (e^(b_0/2) − 1) U and the error is at most (1 − e^−b_0)(e^(b_0/2) − 1), which at b_0 = 1/16 is 1.923e-3 < 1/512 =
//! 1.953e-3. A whole pixel with b_0 ≤ [`FAINT`] needs no network; this holds for every network against its own answers.
//!
//! # Hidden fragments
//!
//! Let P bound the share of the others' absorbance at or behind a fragment ([`most_behind`]). Then T ≤ hi = exp(−b_0'
//! (1 − P)), and at or behind it there is at most the absorbance β = b_0' P + A. A fragment is hidden where hi min(β, n
//! − 2) ≤ [`HIDDEN`]. The *sum* over a pixel's hidden fragments is as small: the nearest of them, g, bounds T ≤ T_g for
//! all, and their opacities add up to no more than their absorbances, which lie at or behind g, nor to more than their
//! number, so Σ a T ≤ T_g min(β_g, n − 2) ≤ 1/1024, ties or not. They are answered with the least that is possible, u =
//! e^−b_0' ≤ T: against the image in which they are answered exactly, D⁺ = 0 and D⁻ ≤ 1/1024, and the error is at most
//! 1/512 wherever U ≥ 1/2. Exact answers give U = 1 − e^−b_0, at least 0.99 where one looks; the CPU adds U up and asks
//! the network after all where its answers to the others leave less than a half. (Against a network's own answers to
//! hidden fragments nothing can be proved: it may claim that they shine through. The figures say what ours do.)
//!
//! The same bound asked of a depth instead of a fragment, with A = 0 and the moments of the whole pixel, holds for all
//! that lies at or behind that depth at once: T ≤ exp(−b_0 (1 − P)), the absorbances there sum to b_0 P at most, and
//! without the ends there are n − 2 fragments at most. So a shader that goes through a pixel's list looks for one depth
//! and compares fragments with it. What cannot go back has less: U is at least the opacity of the nearest fragment,
//! whose answer is 1, so that the bound holds without condition where that is 1/2 or more.

use crate::numeric::real::{Divisor, Real, c, square};

/// Greatest b_0 of a pixel that needs no network.
pub const FAINT: f32 = 1.0 / 16.0;

/// Greatest hi min(β, n − 2) of a hidden fragment: 1/1024, less what rounding may do.
pub const HIDDEN: f32 = 9.5e-4;

/// Absorbance of a pixel from which on fragments may be hidden in it: with less, hardly any are.
pub const MIN_HIDING: f32 = 5.0;

/// Answers whose weights sum to less than this are not to be trusted with hidden fragments; a hair more than a half,
/// for rounding.
pub const MIN_WEIGHT: f32 = 0.501;

/// Rounding of moment depths, beyond which they stand in the order of the view depths \[moment depth\].
pub const ORDER: f64 = 2e-6;

/// How far rounding may have moved what the bounds are made of.
#[derive(Debug, Clone, Copy)]
pub struct Noise<R> {
    /// Error of m_k divided by growth^k.
    pub moments: R,
    /// How much more rounding does to each next moment: 1 + 2|c|/h.
    pub growth: R,
    /// Error of positions in the pixel's range.
    pub position: R,
    /// Error of an optical depth.
    pub depth: R,
}

impl<R: Real> Noise<R> {
    /// Of a pixel with n fragments in [c − h, c + h] that absorb b_0, all but b_0' of it the fragment's own; `unit` is
    /// one rounding of a sum, as a share of b_0, and `growth` 1 + 2|c|/h.
    ///
    /// Adding n terms one after the other leaves each sum within n roundings of Σ |A z^k| ≤ b_0 (|c| + h)^k; the shift
    /// by c and the scale by 1/h turn that into growth^k of b_0, and division by b_0' into a share. Sixteen roundings
    /// more cover the shift, the scale and the bound itself.
    #[inline(always)]
    pub fn of(n: R, b0: R, others: R, half_range: Divisor<R>, growth: R, unit: R) -> Self {
        Self {
            moments: ((n + c(16.0)) * unit * b0 / others.max(c(1e-30)))
                .note("What rounding may have done to moments and places.")
                .named("unsure"),
            growth,
            position: others.like(ORDER).over(half_range).named("off"),
            depth: (n + c(4.0)) * unit * b0 + c(1e-5),
        }
    }
}

/// Upper bound of the share of a measure on [−1, 1] that lies at or behind x, from its moments m_1..m_4; 1 where they
/// say nothing.
///
/// # Source
/// Any polynomial that is at least 0 on the range and at least 1 from x on has an expectation of at least that share
/// (Markov, Chebyshev, Cantelli). Two are tried: ((t − r)/(x − r))² with Cantelli's r < x; and (E + t)(t − r)² (1 − γ(t
/// − x)) over its value at x, γ such that it comes back to 1 at the range's end E: with its only zeros −E, r twice and
/// one beyond E, it rises and falls once between r and there, and so stays above 1 between x and E. Its r is the inner
/// atom of the measure with the same moments on −1, r, x and 1, where there is one; any r < x is valid.
///
/// # Domain
/// x in [−1, 1].
#[inline(always)]
pub fn most_behind<R: Real>(x: R, m: [R; 4], noise: &Noise<R>) -> R {
    let growth = noise.growth;
    let end = (c(1.0) + noise.position).named("end");
    let x = (x - noise.position).named("x");
    // Any zero in front of x will do; as far off as −1e6 it says nothing.
    let ahead = (x - m[0]).note("Cantelli's inequality.").named("ahead");
    let variance = (m[1] - square(m[0])).max(c(0.0));
    let r1 = (m[0] - variance / ahead.max(c(1e-30))).max(c(-1e6)).named("r1");
    let growth1 = (growth + r1.abs()).named("growth1");
    let above = m[1] - c(2.0) * r1 * m[0] + square(r1) + noise.moments * square(growth1);
    let gap1 = (x - r1).named("gap1");
    let share1 = (above / square(gap1).max(c(1e-30))).named("share1");
    let w1 = (m[0] - m[2]).note("The quartic.").named("w1");
    let below = (w1 - x * (c(1.0) - m[1])).named("below");
    let below = R::select(below.abs().lt(c(1e-30)), below.like(1e-30), below);
    let inner = ((m[1] - m[3] - x * w1) / below).named("inner");
    let outer = r1.max(c(-1.0)).named("outer");
    let inside = R::select(inner.ge(-end), inner, outer).named("inside");
    let r = R::select(inside.lt(x), inside, outer).named("r");
    let gap = (x - r).named("gap");
    let per_value = (c(1.0) / ((end + x) * square(gap)).max(c(1e-30))).named("per_value");
    let end_gap = (end - r).named("end_gap");
    let there = c(2.0) * end * square(end_gap) * per_value;
    let gamma = (c(0.99999) * (c(1.0) - c(1.0) / there) / (end - x)).named("gamma");
    // (E + t)(t − r)², then times (1 + γx) − γt.
    let p0 = (end * r * r).named("p0");
    let p1 = (r * r - c(2.0) * r * end).named("p1");
    let p2 = (end - c(2.0) * r).named("p2");
    let lift = (c(1.0) + gamma * x).named("lift");
    let value =
        p0 * lift + (p1 * lift - gamma * p0) * m[0] + (p2 * lift - gamma * p1) * m[1] + (lift - gamma * p2) * m[2]
            - gamma * m[3];
    let value = value.named("value");
    let growth2 = (growth + r.abs()).named("growth2");
    let lost = noise.moments * (end + growth) * square(growth2) * (c(1.0) + gamma * (x.abs() + growth));
    let lost = lost.named("lost");
    let share2 = ((value + lost) * per_value).named("share2");
    let share = (share1.min_number(share2) * c(1.00001)).named("share");
    // NaN is not less than 1 either.
    let behind = R::select(share.lt(c(1.0)), share.max(c(0.0)), share.like(1.0));
    R::select(ahead.gt(c(0.0)), behind, ahead.like(1.0)).named("behind")
}

/// Moment depth from which on one looks for hidden fragments: with b_0 the pixel's absorbance and V its variance, that
/// at which (z − mean)² (b_0 − 5) = 5 V, where Cantelli leaves e^−5 or so. In front of it the bounds would find few
/// more; beyond every depth where b_0 ≤ [`MIN_HIDING`].
#[inline(always)]
pub fn first_hidden_depth<R: Real>(b0: R, b1: R, b2: R) -> R {
    R::step(
        "first_hidden_depth",
        "Moment depth from which on one looks for hidden fragments in a pixel; no depth reaches it where the pixel \
         lets too much light through.",
        [("b0", b0), ("b1", b1), ("b2", b2)],
        #[inline(always)]
        |[b0, b1, b2]| {
            let least = c(f64::from(MIN_HIDING));
            let excess = (b0 - least).named("excess");
            let variance = (b2 * b0 - b1 * b1).max(c(0.0));
            let deviation = (variance * least / excess.max(c(1e-6))).sqrt().named("deviation");
            R::select(excess.gt(c(0.0)), (b1 + deviation) / b0.max(c(1e-30)), b0.like(3e38))
        },
    )
}

/// The most that the hidden fragments of a pixel may weigh, Σ a T, if this one at [`first_hidden_depth`] or behind is
/// the nearest of them: `others` is b_0', `absorbance` its own, n the number of the pixel's fragments, `behind` what
/// [`most_behind`] says.
#[inline(always)]
pub fn hidden_weight<R: Real>(others: R, absorbance: R, n: R, behind: R, noise: &Noise<R>) -> R {
    let least_depth = (others * (c(1.0) - behind) - noise.depth).named("least_depth");
    let beta = others * behind + absorbance;
    (-least_depth).exp() * beta.min(n - c(2.0))
}

/// Whether a fragment at [`first_hidden_depth`] or behind is hidden; see [`hidden_weight`].
#[inline(always)]
pub fn is_hidden<R: Real>(others: R, absorbance: R, n: R, behind: R, noise: &Noise<R>) -> R::Mask {
    hidden_weight(others, absorbance, n, behind, noise).le(c(f64::from(HIDDEN)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::Scalar;
    use crate::numeric::rng::{Stream, stream};
    use rand::RngExt;

    /// Atoms on [−1, 1], some of them bunched, tied or at the ends, with masses of many sizes; the masses add up to 1.
    fn measure(rng: &mut Stream) -> Vec<(f64, f64)> {
        let n = rng.random_range(1..40);
        let kind = rng.random_range(0..4);
        let bunch = rng.random_range(-1.0..1.0);
        let mut atoms: Vec<(f64, f64)> = (0..n)
            .map(|i| {
                let x: f64 = match kind {
                    0 => rng.random_range(-1.0..=1.0),
                    1 => (bunch + rng.random_range(-0.05..0.05f64)).clamp(-1.0, 1.0),
                    2 => [-1.0, 1.0, bunch][i % 3],
                    _ => {
                        if rng.random_range(0..2) == 0 {
                            -rng.random_range(0.5..=1.0f64)
                        } else {
                            rng.random_range(-1.0..=1.0)
                        }
                    }
                };
                (x, libm::exp(rng.random_range(-9.0..2.3)))
            })
            .collect();
        let total: f64 = atoms.iter().map(|a| a.1).sum();
        atoms.iter_mut().for_each(|a| a.1 /= total);
        atoms
    }

    fn moments<R: Scalar>(atoms: &[(f64, f64)]) -> [R; 4] {
        std::array::from_fn(|k| R::from_f64(atoms.iter().map(|&(x, a)| a * x.powi(k as i32 + 1)).sum()))
    }

    fn no_noise<R: Scalar>() -> Noise<R> {
        Noise {
            moments: R::from_f64(16.0) * R::EPSILON,
            growth: R::ONE,
            position: R::from_f64(1e-6),
            depth: R::ZERO,
        }
    }

    /// Random and adversarial measures, x anywhere and on the atoms: the bound is never below the true share, in f64
    /// and in f32. Controls: half the bound is, often; and in half of the cases it says more than nothing.
    #[test]
    fn nothing_lies_behind_beyond_the_bound() {
        let mut rng = stream(1, 93, 0);
        let (mut tried, mut control, mut useful) = (0, 0, 0);
        for round in 0..200_000 {
            let atoms = measure(&mut rng);
            let x = if round % 2 == 0 {
                atoms[rng.random_range(0..atoms.len())].0
            } else {
                rng.random_range(-1.0..=1.0)
            };
            let exact: f64 = atoms.iter().filter(|a| a.0 >= x).map(|a| a.1).sum();
            let wide = most_behind::<f64>(x, moments(&atoms), &no_noise());
            let narrow = most_behind::<f32>(x as f32, moments(&atoms), &no_noise());
            assert!(
                wide >= exact - 1e-12 && f64::from(narrow) >= exact - 1e-12,
                "{wide} {narrow} < {exact} at {x} of {atoms:?}"
            );
            tried += 1;
            control += usize::from(0.5 * wide < exact);
            useful += usize::from(wide < 1.0);
        }
        assert!(
            control > tried / 20 && useful > tried / 3,
            "{control} {useful} of {tried}"
        );
    }

    /// The bound is attained: for atoms at −1, r, x and 1 it is their share, to 1e-4; without the quartic it would be
    /// far from it.
    #[test]
    fn the_bound_is_sharp_where_four_atoms_say_so() {
        for (r, x) in [(-0.5, 0.3), (-0.9, -0.2), (0.1, 0.6)] {
            let atoms = [(-1.0, 0.3), (r, 0.4), (x, 0.05), (1.0, 0.25)];
            let bound = most_behind::<f64>(x, moments(&atoms), &no_noise());
            assert!((0.3..0.3 + 1e-4).contains(&bound), "{bound}");
            let m = moments::<f64>(&atoms);
            let variance = m[1] - m[0] * m[0];
            assert!(x < m[0] || variance / (variance + (x - m[0]).powi(2)) > 0.4);
        }
    }

    #[test]
    fn nonsense_hides_nothing() {
        let odd = [f32::NAN, f32::INFINITY, -1.0, 0.0, 1e-30, 1.0];
        for a in odd {
            for b in odd {
                let noise = Noise {
                    moments: a,
                    growth: b,
                    ..no_noise()
                };
                let bound = most_behind::<f32>(0.5, [a, b, a, b], &noise);
                assert!((0.0..=1.0).contains(&bound));
                if a.is_nan() || b.is_nan() {
                    assert_eq!(bound, 1.0);
                }
            }
        }
    }

    /// The constants as the derivation has them.
    #[test]
    fn faint_pixels_change_by_less_than_half_a_step() {
        let change = |b0: f64| -libm::expm1(-b0) * libm::expm1(0.5 * b0);
        assert!(change(FAINT.into()) < 1.0 / 512.0);
        assert!(change(1.02 * f64::from(FAINT)) > 1.0 / 512.0);
        assert!(2.0 * f64::from(HIDDEN) < 1.0 / 512.0);
    }
}
