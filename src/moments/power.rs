//! Power moments of absorbance.

use crate::numeric::Scalar;
use crate::pixel::MomentDepth;

/// Power moments b_0..b_K of a pixel: b_k = Σ A_i z_i^k, N = K + 1 of them.
///
/// # Source
/// NMT24 Eq. 5, MKKP18 Eq. 3.
///
/// # Shapes
/// `depths: [n]`, `absorbances: [n]`; the result is `[N]`, b_0 first.
///
/// # Domain
/// z in [−1, 1], A ≥ 0. No fragment: all moments 0. Sums are taken in the order of the input and in the precision `R`;
/// in another order they differ by rounding only (order independence is tested to `n · ε · b_0`).
///
/// # Panics
/// If the slices differ in length.
pub fn power_moments<R: Scalar, const N: usize>(depths: &[MomentDepth], absorbances: &[f64]) -> [R; N] {
    assert_eq!(depths.len(), absorbances.len(), "one absorbance a depth");
    let mut b = [R::ZERO; N];
    for (&MomentDepth(z), &a) in depths.iter().zip(absorbances) {
        let z = R::from_f64(z);
        let mut term = R::from_f64(a);
        for b in &mut b {
            *b += term;
            term *= z;
        }
    }
    b
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn closed_forms() {
        let none: [f64; 5] = power_moments(&[], &[]);
        assert_eq!(none, [0.0; 5]);
        // One fragment: A z^k.
        let one: [f64; 5] = power_moments(&[MomentDepth(-0.5)], &[2.0]);
        assert_eq!(one, [2.0, -1.0, 0.5, -0.25, 0.125]);
        // Symmetric pair: odd moments vanish.
        let pair: [f64; 5] = power_moments(&[MomentDepth(-0.5), MomentDepth(0.5)], &[1.0, 1.0]);
        assert_eq!(pair, [2.0, 0.0, 0.5, 0.0, 0.125]);
    }

    proptest! {
        /// Any order gives the same moments up to rounding: n · 2^−52 · b_0 in f64 and n · 2^−23 · b_0 in f32; and f64
        /// agrees with the definition written with `powi`.
        #[test]
        fn order_independent(
            fragments in prop::collection::vec((-1.0f64..=1.0, 0.0f64..10.0), 1..64),
            seed in any::<u64>(),
        ) {
            let mut shuffled = fragments.clone();
            let mut state = seed | 1;
            for i in (1..shuffled.len()).rev() {
                state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                shuffled.swap(i, (state >> 33) as usize % (i + 1));
            }
            let split = |f: &[(f64, f64)]| -> (Vec<MomentDepth>, Vec<f64>) { f.iter().map(|&(z, a)| (MomentDepth(z),
                a)).unzip() };
            let (z, a) = split(&fragments);
            let (zs, a_s) = split(&shuffled);
            let n = fragments.len() as f64;
            let (b, bs): ([f64; 5], [f64; 5]) = (power_moments(&z, &a), power_moments(&zs, &a_s));
            let (c, cs): ([f32; 5], [f32; 5]) = (power_moments(&z, &a), power_moments(&zs, &a_s));
            for k in 0..5 {
                let definition: f64 = fragments.iter().map(|(z, a)| a * z.powi(k as i32)).sum();
                prop_assert!((b[k] - bs[k]).abs() <= n * f64::EPSILON * b[0]);
                prop_assert!((b[k] - definition).abs() <= 4.0 * n * f64::EPSILON * b[0]);
                prop_assert!(f64::from((c[k] - cs[k]).abs()) <= n * f64::from(f32::EPSILON) * b[0]);
            }
        }
    }
}
