//! Absorbance: the additive form of opacity.

use crate::numeric::lanes;
use fearless_simd::f32x16;
use fearless_simd::prelude::*;

/// Greatest absorbance of one fragment \[dimensionless\]; an opaque fragment leaves e^−10 of the light (the usual clamp
/// of shipped renderers).
pub const ABSORBANCE_MAX: f64 = 10.0;

/// Absorbance of a fragment: A = min(−ln(1 − alpha), 10).
///
/// # Source
/// MKKP18 Sec. 3.1, NMT24 Eq. 4.
///
/// # Domain
/// alpha in [0, 1]; the result is in [0, 10].
///
/// # Accuracy
/// Within 1 ULP of f64 for every alpha, tiny ones included (`log1p`).
pub fn absorbance(alpha: f32) -> f64 {
    (-libm::log1p(-f64::from(alpha))).min(ABSORBANCE_MAX)
}

/// [`absorbance`] of sixteen opacities at once, in f32.
///
/// # Accuracy
/// Within 4 ULP of f64 for every alpha in [0, 1]; `lanes_follow_the_scalar`.
#[inline(always)]
pub fn absorbance_lanes<S: Simd>(simd: S, alpha: f32x16<S>) -> f32x16<S> {
    let splat = |x: f32| f32x16::splat(simd, x);
    let one = splat(1.0);
    // ln(1 − α) of the rounded 1 − α, times what rounding took from α.
    let rest = one - alpha;
    let lost = one - rest;
    let exact = lanes::ln(simd, rest.max(splat(4e-5))) * (alpha / lost.max(splat(f32::MIN_POSITIVE)));
    let a = lost.simd_gt(splat(0.0)).select(-exact, alpha);
    a.min(splat(ABSORBANCE_MAX as f32))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_small_values_and_the_clamp() {
        assert_eq!(absorbance(0.0), 0.0);
        assert_eq!(absorbance(1.0), ABSORBANCE_MAX);
        assert_eq!(absorbance(0.5), std::f64::consts::LN_2);
        // −ln(1 − a) = a + a²/2 + O(a³)
        let a = 1e-8f32;
        let expected = f64::from(a) + f64::from(a) * f64::from(a) / 2.0;
        assert!((absorbance(a) - expected).abs() <= 1e-22);
        // 1 − e^−10 = 0.9999546: beyond it the clamp holds
        assert_eq!(absorbance(0.99999), ABSORBANCE_MAX);
        assert!(absorbance(0.9999) < ABSORBANCE_MAX);
    }

    /// Tolerance: 4 ULP, over alphas of every size. Control: the alphas one lane on.
    #[test]
    fn lanes_follow_the_scalar() {
        use crate::numeric::lanes::{LANES, Lanes};
        use fearless_simd::{Level, dispatch};
        let mut alphas: Vec<f32> = (0..200_000u32)
            .map(|i| f32::from_bits(0x0080_0000 + i * 5240))
            .collect();
        alphas.extend((0..200_000).map(|i| i as f32 / 2e5));
        alphas.extend([
            0.0,
            1.0,
            1.0 - f32::EPSILON,
            0.999_954_6,
            0.999_95,
            1e-39,
            f32::MIN_POSITIVE,
            0.5,
        ]);
        alphas.retain(|a| *a <= 1.0);
        alphas.truncate(alphas.len() / LANES * LANES);
        let run = |alpha: &[f32]| -> Vec<f32> {
            let mut out = Vec::new();
            for chunk in alpha.chunks_exact(LANES) {
                let mut lanes = Lanes(chunk.try_into().unwrap());
                dispatch!(Level::new(), simd => lanes.store(absorbance_lanes(simd, lanes.load(simd))));
                out.extend(lanes.0);
            }
            out
        };
        let worst = |found: &[f32]| {
            let off = |(f, &a): (&f32, &f32)| {
                (f64::from(*f) - absorbance(a)).abs() / (absorbance(a) * f64::from(f32::EPSILON)).max(1e-38)
            };
            found
                .iter()
                .zip(&alphas)
                .map(off)
                .fold(0.0, |m: f64, e| if e.is_nan() { f64::INFINITY } else { m.max(e) })
        };
        let found = run(&alphas);
        assert!(found.len() > 390_000 && worst(&found) <= 4.0, "{}", worst(&found));
        assert!(worst(&[&found[1..], &found[..1]].concat()) > 4.0);
    }
}
