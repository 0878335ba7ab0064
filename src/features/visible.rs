//! What cannot be seen: fragments whose answer may be replaced by a cheap one, with a bound on what that does to the image.
//!
//! # Two sets of answers
//!
//! NMT24 Eq. 7 composites C = (1 − e^−b_0) Σ a t C_i / Σ a t + e^−b_0 C_bg. Let the answers t become u, d_i = a_i (u_i − t_i), W = Σ a t, U = Σ a u, and m the
//! weighted mean colour under t. Then C_u − C_t = (1 − e^−b_0) Σ d_i (C_i − m) / U, and the same over W with the mean under u. Colours lie in [0, 1], so
//!
//! |C_u − C_t| ≤ (1 − e^−b_0) max(D⁺, D⁻) / max(U, W),
//!
//! D⁺ and D⁻ the sums of the positive and of the negative d. Two rules keep this below half a display step, 1/512, in every channel. Both need only what pass 2
//! has at hand, in any order of the fragments.
//!
//! # Faint pixels
//!
//! Every answer lies between e^−b_0' and 1, b_0' ≤ b_0 the absorbance of the others, whatever the network says. Answer u = e^(−b_0'/2), the middle: then
//! 1 − t/u ≤ 1 − e^(−b_0/2) and t/u − 1 ≤ e^(b_0/2) − 1, so D⁺ and D⁻ are at most (e^(b_0/2) − 1) U and the error is at most (1 − e^−b_0)(e^(b_0/2) − 1), which at
//! b_0 = 1/16 is 1.923e-3 < 1/512 = 1.953e-3. A whole pixel with b_0 ≤ [`FAINT`] needs no network; this holds for every network against its own answers.
//!
//! # Hidden fragments
//!
//! Let P bound the share of the others' absorbance at or behind a fragment ([`most_behind`]). Then T ≤ hi = exp(−b_0' (1 − P)), and at or behind it there is at most
//! the absorbance β = b_0' P + A. A fragment is hidden where hi min(β, n − 2) ≤ [`HIDDEN`]. The *sum* over a pixel's hidden fragments is as small: the
//! nearest of them, g, bounds T ≤ T_g for all, and their opacities add up to no more than their absorbances, which lie at or behind g, nor to more than their number,
//! so Σ a T ≤ T_g min(β_g, n − 2) ≤ 1/1024, ties or not. They are answered with the least that is possible, u = e^−b_0' ≤ T: against the image in which they
//! are answered exactly, D⁺ = 0 and D⁻ ≤ 1/1024, and the error is at most 1/512 wherever U ≥ 1/2. Exact answers give U = 1 − e^−b_0, at least 0.99 where one looks; the
//! CPU adds U up and asks the network after all where its answers to the others leave less than a half. (Against a network's own answers to hidden fragments nothing can be proved:
//! it may claim that they shine through. The figures say what ours do.)
//!
//! The same bound asked of a depth instead of a fragment, with A = 0 and the moments of the whole pixel, holds for all that lies at or behind that depth at once: T ≤ exp(−b_0 (1 − P)), the
//! absorbances there sum to b_0 P at most, and without the ends there are n − 2 fragments at most. So a shader that goes through a pixel's list looks for one depth and compares fragments with it.
//! What cannot go back has less: U is at least the opacity of the nearest fragment, whose answer is 1, so that the bound holds without condition where that is 1/2 or more.

use crate::numeric::Scalar;

/// Greatest b_0 of a pixel that needs no network.
pub const FAINT: f32 = 1.0 / 16.0;

/// Greatest hi min(β, n − 2) of a hidden fragment: 1/1024, less what rounding may do.
pub const HIDDEN: f32 = 9.5e-4;

/// Absorbance of a pixel from which on fragments may be hidden in it: with less, hardly any are.
pub const MIN_HIDING: f32 = 5.0;

/// Answers whose weights sum to less than this are not to be trusted with hidden fragments; a hair more than a half, for rounding.
pub const MIN_WEIGHT: f32 = 0.501;

/// Rounding of moment depths, beyond which they stand in the order of the view depths \[moment depth\].
pub const ORDER: f64 = 2e-6;

/// How far rounding may have moved what the bounds are made of.
#[derive(Debug, Clone, Copy)]
pub struct Noise<R> {
    /// Error of m_k divided by noise_growth^k.
    pub moments: R,
    /// How much more rounding does to each next moment: 1 + 2|c|/h.
    pub noise_growth: R,
    /// Error of positions in the pixel's range.
    pub position: R,
    /// Error of an optical depth.
    pub depth: R,
}

impl<R: Scalar> Noise<R> {
    /// Of a pixel with `count` fragments in [c − h, c + h] that absorb b_0, all but b_0' of it the fragment's own; sums in the precision R.
    ///
    /// Adding n terms one after the other leaves each sum within n roundings of Σ |A z^k| ≤ b_0 (|c| + h)^k; the shift by c and the scale by 1/h turn that into
    /// noise_growth^k of b_0, and division by b_0' into a share. Sixteen roundings more cover the shift, the scale and the bound itself.
    pub fn of(count: u32, b0: R, others: R, c: R, h: R) -> Self {
        let n = R::from_f64(f64::from(count));
        let two = R::from_f64(2.0);
        Self {
            moments: (n + R::from_f64(16.0)) * R::EPSILON * b0 / others,
            noise_growth: R::ONE + two * c.abs() / h,
            position: R::from_f64(ORDER) / h,
            depth: (n + R::from_f64(4.0)) * R::EPSILON * b0 + R::from_f64(1e-5),
        }
    }
}

/// Upper bound of the share of a measure on [−1, 1] that lies at or behind x, from its moments m_1..m_4; 1 where they say nothing.
///
/// # Source
/// Any polynomial that is at least 0 on the range and at least 1 from x on has an expectation of at least that share (Markov, Chebyshev, Cantelli). Two are tried:
/// ((t − r)/(x − r))² with Cantelli's r < x; and (E + t)(t − r)² (1 − γ(t − x)) over its value at x, γ such that it comes back to 1 at the range's end E: with its only
/// zeros −E, r twice and one beyond E, it rises and falls once between r and there, and so stays above 1 between x and E. Its r is the inner atom of the
/// measure with the same moments on −1, r, x and 1, where there is one; any r < x is valid.
pub fn most_behind<R: Scalar>(x: R, m: [R; 4], noise: &Noise<R>) -> R {
    let (one, two) = (R::ONE, R::from_f64(2.0));
    let margin = R::from_f64(1e-5);
    let end = one + noise.position;
    let x = x.min(one).max(-one) - noise.position;
    let rho = noise.noise_growth;
    let square = |v: R| v * v;
    // Cantelli.
    let ahead = x - m[0];
    if ahead <= R::ZERO {
        return one;
    }
    let variance = (m[1] - m[0] * m[0]).max(R::ZERO);
    let r = m[0] - variance / ahead;
    let gap = x - r;
    let bound = (m[1] - two * r * m[0] + r * r + noise.moments * square(rho + r.abs())) / square(gap);
    // The quartic.
    let (w0, w1, w2) = (one - m[1], m[0] - m[2], m[1] - m[3]);
    let inner = (w2 - x * w1) / (w1 - x * w0);
    let r = if inner >= -end && inner < x { inner } else { r.max(-one) };
    let per_value = one / ((end + x) * square(x - r)).max(R::from_f64(1e-30));
    let there = two * end * square(end - r) * per_value;
    let gamma = (one - margin) * (one - one / there) / (end - x);
    // (E + t)(t − r)², then times (1 + γx) − γt.
    let p = [end * r * r, r * r - two * r * end, end - two * r, one];
    let lift = one + gamma * x;
    let value = p[0] * lift
        + (p[1] * lift - gamma * p[0]) * m[0]
        + (p[2] * lift - gamma * p[1]) * m[1]
        + (p[3] * lift - gamma * p[2]) * m[2]
        - gamma * m[3];
    let lost = noise.moments * (end + rho) * square(rho + r.abs()) * (one + gamma * (x.abs() + rho));
    let quartic = (value + lost) * per_value;
    let share = bound.min(quartic) * (one + margin);
    // NaN is not less than 1 either.
    if share < one { share.max(R::ZERO) } else { one }
}

/// Moment depth from which on one looks for hidden fragments: with b_0 the pixel's absorbance and V its variance, that at which
/// (z − mean)² (b_0 − 5) = 5 V, where Cantelli leaves e^−5 or so. In front of it the bounds would find few more; infinity where b_0 ≤ [`MIN_HIDING`].
pub fn first_hidden_depth<R: Scalar>(b0: R, b1: R, b2: R) -> R {
    let least = R::from_f32(MIN_HIDING);
    if b0 <= least {
        return R::from_f32(f32::INFINITY);
    }
    (b1 + (least * (b2 * b0 - b1 * b1).max(R::ZERO) / (b0 - least)).sqrt()) / b0
}

/// The most that the hidden fragments of a pixel may weigh, Σ a T, if this one at [`first_hidden_depth`] or behind is the nearest of them: `others` is b_0', `absorbance`
/// its own, `count` the pixel's n, `behind` what [`most_behind`] says.
pub fn hidden_weight<R: Scalar>(others: R, absorbance: R, count: u32, behind: R, noise: &Noise<R>) -> R {
    let least_depth = others * (R::ONE - behind) - noise.depth;
    let beta = others * behind + absorbance;
    (-least_depth).exp() * beta.min(R::from_f64(f64::from(count) - 2.0))
}

/// Whether a fragment at [`first_hidden_depth`] or behind is hidden; see [`hidden_weight`].
pub fn is_hidden<R: Scalar>(others: R, absorbance: R, count: u32, behind: R, noise: &Noise<R>) -> bool {
    hidden_weight(others, absorbance, count, behind, noise) <= R::from_f32(HIDDEN)
}

#[cfg(test)]
mod tests {
    use super::*;
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
            noise_growth: R::ONE,
            position: R::from_f64(1e-6),
            depth: R::ZERO,
        }
    }

    /// Random and adversarial measures, x anywhere and on the atoms: the bound is never below the true share, in f64 and in f32. Controls: half the bound is, often; and
    /// in half of the cases it says more than nothing.
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

    /// The bound is attained: for atoms at −1, r, x and 1 it is their share, to 1e-4; without the quartic it would be far from it.
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
                    noise_growth: b,
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
