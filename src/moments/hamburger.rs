//! Absorbance in front of a depth, reconstructed from power moments.

use crate::numeric::Scalar;
use crate::numeric::orthogonal::{MassBounds, Orthogonal};
use crate::pixel::MomentDepth;

/// Weight of the upper bound in the estimate \[dimensionless\].
///
/// # Source
/// MKKP18 Sec. 3.2.
pub const OVERESTIMATION: f64 = 0.25;

/// Regularisation of normalised moments: b ← (1 − s) b + s b*, which moves them away from the edge of what is a
/// measure's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bias {
    /// s, the `moment_bias` \[dimensionless\].
    pub strength: f64,
    /// b*_1..b*_m, moments of a measure of mass 1; longer than m is fine.
    pub target: [f64; 8],
}

impl Bias {
    /// MKKP18's bias for m power moments, m one of 4, 6, 8, kept in single precision.
    ///
    /// # Source
    /// MKKP18, supplementary document.
    ///
    /// # Panics
    /// For another m.
    pub fn single_precision(m: usize) -> Self {
        let (strength, target) = match m {
            4 => (5e-7, [0.0, 0.375, 0.0, 0.375, 0.0, 0.0, 0.0, 0.0]),
            6 => (5e-6, [0.0, 0.48, 0.0, 0.451, 0.0, 0.45, 0.0, 0.0]),
            8 => (5e-5, [0.0, 0.75, 0.0, 0.67666667, 0.0, 0.63, 0.0, 0.60030303]),
            _ => panic!("{m} power moments: only 4, 6 and 8 are defined"),
        };
        Self { strength, target }
    }

    /// MKKP18's bias for m power moments, m one of 4, 6, 8, kept in 16 bits each.
    ///
    /// # Source
    /// MKKP18, supplementary document.
    ///
    /// # Panics
    /// For another m.
    pub fn sixteen_bits(m: usize) -> Self {
        let (strength, target) = match m {
            4 => (6e-5, [0.0, 0.628, 0.0, 0.628, 0.0, 0.0, 0.0, 0.0]),
            6 => (6e-4, [0.0, 0.5566, 0.0, 0.489, 0.0, 0.47869382, 0.0, 0.0]),
            8 => (
                2.5e-3,
                [0.0, 0.42474916, 0.0, 0.22407803, 0.0, 0.15369231, 0.0, 0.12900441],
            ),
            _ => panic!("{m} power moments: only 4, 6 and 8 are defined"),
        };
        Self { strength, target }
    }

    /// The regularised moments of a measure of mass 1: b_1..b_m of the result, after b_0 = 1.
    pub fn apply<R: Scalar, const M: usize>(&self, normalised: [R; M]) -> [R; M] {
        let s = R::from_f64(self.strength);
        let keep = R::ONE - s;
        std::array::from_fn(|k| {
            if k == 0 {
                normalised[0]
            } else {
                keep * normalised[k] + s * R::from_f64(self.target[k - 1])
            }
        })
    }
}

/// Absorbance over depth as m = 2N power moments tell it.
///
/// # Source
/// MKKP18 Sec. 3.2 and Algorithm 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PowerCurve<R, const N: usize> {
    total: R,
    fractions: Orthogonal<R, N>,
}

impl<R: Scalar, const N: usize> PowerCurve<R, N> {
    /// The curve of a pixel's moments b_0..b_2N, normalised by b_0 and then biased.
    ///
    /// # Domain
    /// b_0 = 0 gives a curve that is NaN everywhere: whoever asks for a transmittance first looks whether there is
    /// absorbance at all.
    ///
    /// # Panics
    /// Unless there are M = 2N + 1 moments.
    pub fn new<const M: usize>(moments: &[R; M], bias: &Bias) -> Self {
        let total = moments[0];
        let normalised = moments.map(|b| b / total);
        Self {
            total,
            fractions: Orthogonal::from_moments(&bias.apply(normalised)),
        }
    }

    /// The curve of a total absorbance and of already regularised polynomials of the distribution of its fractions.
    pub fn from_parts(total: R, fractions: Orthogonal<R, N>) -> Self {
        Self { total, fractions }
    }

    /// Sharp bounds on the absorbance in front of a depth.
    pub fn bounds(&self, MomentDepth(z): MomentDepth) -> MassBounds<R> {
        let MassBounds { lower, upper } = self.fractions.bounds(R::from_f64(z));
        MassBounds {
            lower: self.total * lower,
            upper: self.total * upper,
        }
    }

    /// T = exp(−A), A between its bounds.
    pub fn transmittance(&self, z: MomentDepth, overestimation: f64) -> R {
        (-self.bounds(z).blend(R::from_f64(overestimation))).exp()
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::moments::power::power_moments;
    use crate::numeric::npy::Npz;
    use crate::numeric::tolerance::AbsoluteError;
    use crate::pixel::{FragmentList, ViewZ, absorbance, abuffer};
    use crate::synth::{Purpose, Synth, SynthConfig};
    use proptest::prelude::*;
    use std::path::Path;

    /// Worst error, relative to the total absorbance, against an independent program's bounds
    /// (`tests/data/moment_bounds`).
    fn worst_against_file<const N: usize, const M: usize>(bias: f64) -> f64 {
        let path =
            Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/data/moment_bounds/moment_bounds_f64_n{N}.npz"));
        let npz = Npz::read(&path, &["m", "eta", "bounds"]).unwrap();
        let (m, eta, bounds) = (
            npz.required::<f64>("m").unwrap(),
            npz.required::<f64>("eta").unwrap(),
            npz.required::<f64>("bounds").unwrap(),
        );
        assert!(m.shape() == [M, eta.len()] && eta.len() > 100);
        let target = Bias::single_precision(2 * N).target;
        let mut worst = 0.0f64;
        for i in 0..eta.len() {
            // The file's convention: the bias is added to moments that are not normalised.
            let moments: [f64; M] =
                std::array::from_fn(|k| (1.0 - bias) * m[[k, i]] + bias * if k == 0 { 1.0 } else { target[k - 1] });
            let ours = Orthogonal::<f64, N>::from_moments(&moments).bounds(eta[i]).blend(0.5);
            let error = (ours - bounds[i]).abs() / bounds[i].abs();
            worst = if error.is_nan() {
                f64::INFINITY
            } else {
                worst.max(error)
            };
        }
        worst
    }

    #[test]
    fn agrees_with_an_independent_program_on_four_and_six_moments() {
        let (four, six) = (worst_against_file::<2, 5>(1e-3), worst_against_file::<3, 7>(1e-3));
        println!("worst relative error: four {four:.2e}, six {six:.2e}");
        assert!(four <= 1e-9 && six <= 1e-9, "{four:e} {six:e}");
        // The control: a bias one part in a thousand off is seen.
        assert!(worst_against_file::<2, 5>(1.001e-3) > 1e-9 && worst_against_file::<3, 7>(1.001e-3) > 1e-9);
    }

    /// Lower bound by another road: atoms y of the representation at z as eigenvalues of the pencil of localised Hankel
    /// matrices, found as sign changes of det[∫ (x − y)(x − z) x^{i+j}] over y, and masses from the Vandermonde system
    /// of the moments themselves.
    fn bounds_by_determinants<const N: usize, const M: usize>(b: &[f64; M], z: f64) -> MassBounds<f64> {
        let determinant = |y: f64| {
            let mut a: Vec<Vec<f64>> = (0..N)
                .map(|i| {
                    (0..N)
                        .map(|j| b[i + j + 2] - (y + z) * b[i + j + 1] + y * z * b[i + j])
                        .collect()
                })
                .collect();
            eliminate(&mut a)
        };
        let mut atoms = vec![z];
        // y = tan(t) covers the whole line, so that an atom far outside [−1, 1] is found too.
        let at = |i: usize| (std::f64::consts::PI * (i as f64 + 0.123) / 20_000.0 - std::f64::consts::FRAC_PI_2).tan();
        for i in 0..20_000 {
            let (mut low, mut high) = (at(i), at(i + 1));
            if low > high || (determinant(low) > 0.0) == (determinant(high) > 0.0) {
                continue;
            }
            for _ in 0..100 {
                let middle = 0.5 * (low + high);
                if (determinant(middle) > 0.0) == (determinant(low) > 0.0) {
                    low = middle
                } else {
                    high = middle
                }
            }
            atoms.push(0.5 * (low + high));
        }
        let n = atoms.len();
        let mut a: Vec<Vec<f64>> = (0..n)
            .map(|k| atoms.iter().map(|y| y.powi(k as i32)).chain([b[k]]).collect())
            .collect();
        eliminate(&mut a);
        let mut mass = vec![0.0; n];
        for i in (0..n).rev() {
            mass[i] = (a[i][n] - (i + 1..n).map(|j| a[i][j] * mass[j]).sum::<f64>()) / a[i][i];
        }
        let lower = (1..n).filter(|&i| atoms[i] < z).map(|i| mass[i]).sum::<f64>();
        MassBounds {
            lower,
            upper: lower + mass[0],
        }
    }

    /// Gaussian elimination with pivoting; the determinant of the leading square.
    fn eliminate(a: &mut [Vec<f64>]) -> f64 {
        let n = a.len();
        let mut determinant = 1.0;
        for k in 0..n {
            let pivot = (k..n).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs())).unwrap();
            if pivot != k {
                a.swap(pivot, k);
                determinant = -determinant;
            }
            determinant *= a[k][k];
            for i in k + 1..n {
                let factor = a[i][k] / a[k][k];
                let (above, below) = a.split_at_mut(i);
                for (x, y) in below[0].iter_mut().zip(&above[k]) {
                    *x -= factor * y;
                }
            }
        }
        determinant
    }

    /// Tolerance 1e-6 of the total: the determinants of the other road lose half the digits.
    #[test]
    fn eight_moments_agree_with_determinants_and_vandermonde() {
        let bias = Bias {
            strength: 1e-3,
            ..Bias::single_precision(8)
        };
        let mut worst = 0.0f64;
        for case in 0..20u32 {
            let fragment = |i: u32| {
                let u = |k: u32| {
                    f64::from((case * 7919 + i * 104_729 + k * 1_299_709).wrapping_mul(2_654_435_761))
                        / f64::from(u32::MAX)
                };
                (MomentDepth(2.0 * u(1) - 1.0), 0.05 + u(2))
            };
            let (z, a): (Vec<_>, Vec<_>) = (0..12).map(fragment).unzip();
            let b: [f64; 9] = power_moments(&z, &a);
            let biased = bias.apply(b.map(|x| x / b[0]));
            let fractions = Orthogonal::<f64, 4>::from_moments(&biased);
            for at in [-0.83, -0.21, 0.34, 0.77] {
                let (ours, theirs) = (fractions.bounds(at), bounds_by_determinants::<4, 9>(&biased, at));
                let error = (ours.lower - theirs.lower).abs().max((ours.upper - theirs.upper).abs());
                assert!(error <= 1e-6, "case {case} at {at}: {ours:?} {theirs:?}");
                worst = worst.max(error);
                // The control: 1 % off is seen.
                assert!((1.01 * ours.upper - theirs.upper).abs() > 1e-6);
            }
        }
        println!("worst {worst:.1e}");
    }

    /// Few atoms are found again, every one. Tolerance 1e-5 on the absorbance strictly in front of each.
    fn atoms_are_reconstructed<const N: usize, const M: usize>(
        gaps: &[f64],
        masses: &[f64],
        strength: f64,
    ) -> Result<(), TestCaseError> {
        let bias = Bias {
            strength,
            ..Bias::single_precision(2 * N)
        };
        let mut at = -1.0;
        let atoms: Vec<MomentDepth> = gaps[..N]
            .iter()
            .map(|g| {
                at += g;
                MomentDepth(at)
            })
            .collect();
        let b: [f64; M] = power_moments(&atoms, &masses[..N]);
        let curve = PowerCurve::<f64, N>::new(&b, &bias);
        let mut in_front = 0.0;
        for (&z, &a) in atoms.iter().zip(masses) {
            let bounds = curve.bounds(z);
            prop_assert!(
                (bounds.lower - in_front).abs() <= 1e-5,
                "{in_front} at {z:?}: {bounds:?}"
            );
            in_front += a;
            prop_assert!(
                (bounds.upper - in_front).abs() <= 1e-5,
                "{in_front} at {z:?}: {bounds:?}"
            );
        }
        Ok(())
    }

    proptest! {
        /// At most m/2 atoms at least 0.1 apart, moment_bias ≤ 1e-10.
        #[test]
        fn few_atoms_are_exact(gaps in prop::collection::vec(0.1f64..0.5, 4),
            masses in prop::collection::vec(0.1f64..1.0, 4)) {
            atoms_are_reconstructed::<2, 5>(&gaps, &masses, 1e-10)?;
            atoms_are_reconstructed::<3, 7>(&gaps, &masses, 1e-12)?;
            atoms_are_reconstructed::<4, 9>(&gaps, &masses, 1e-13)?;
        }

        /// Truth within unbiased bounds at every fragment, single precision staying near double. Tolerances: 1e-9 of
        /// the total; 2e-2 in f32 with 1e-3 of bias.
        #[test]
        fn truth_lies_within_the_unbiased_bounds(fragments in prop::collection::vec((-1.0f64..1.0, 0.01f64..2.0),
            4..40)) {
            let (z, a): (Vec<_>, Vec<_>) = fragments.iter().map(|&(z, a)| (MomentDepth(z), a)).unzip();
            let b: [f64; 7] = power_moments(&z, &a);
            let none = Bias { strength: 0.0, target: [0.0; 8] };
            let some = Bias { strength: 1e-3, ..Bias::single_precision(6) };
            let curve = PowerCurve::<f64, 3>::new(&b, &none);
            let (double, single) = (PowerCurve::<f64, 3>::new(&b, &some), PowerCurve::<f32,
                3>::new(&b.map(|b| b as f32), &some));
            for &(at, own) in &fragments {
                let below: f64 = fragments.iter().filter(|f| f.0 < at).map(|f| f.1).sum();
                let bounds = curve.bounds(MomentDepth(at));
                // Within 1e-9 where the atoms are not so close that rounding alone makes the matrix singular.
                prop_assume!(curve.fractions.last_norm() > 1e-6);
                prop_assert!(bounds.lower <= below + 1e-9 * b[0] && bounds.upper >= below + own - 1e-9 * b[0],
                    "{below} + {own} in {bounds:?}");
                let (d, s) = (double.transmittance(MomentDepth(at), 0.25), single.transmittance(MomentDepth(at), 0.25));
                prop_assert!((d - f64::from(s)).abs() < 2e-2, "{d} {s}");
            }
        }
    }

    /// T-MSE over all fragments of random pixels, moments of 2w − 1.
    fn paper_mse<const N: usize, const M: usize>(list: &FragmentList, strength: f64) -> f64 {
        let planes = list.planes().unwrap();
        let bias = Bias {
            strength,
            ..Bias::single_precision(2 * N)
        };
        let exact = abuffer::list_transmittance(list);
        let mut error = AbsoluteError::default();
        for p in 0..list.pixels() {
            let pixel = list.pixel(p);
            let z: Vec<_> = pixel
                .view_z
                .iter()
                .map(|&v| planes.window(ViewZ(v.into())).unwrap().to_moment())
                .collect();
            let a: Vec<_> = pixel.alpha.iter().map(|&a| absorbance(a)).collect();
            let curve = PowerCurve::<f64, N>::new(&power_moments::<f64, M>(&z, &a), &bias);
            for (&z, &exact) in z.iter().zip(&exact[list.range(p)]) {
                error.add(curve.transmittance(z, OVERESTIMATION), exact);
            }
        }
        error.mse()
    }

    /// Figures of an independent prototype on another draw of the same distribution; tolerance 3 %.
    #[test]
    fn the_papers_distribution_gives_the_known_errors() {
        let list = Synth::new(SynthConfig::paper(), 5)
            .unwrap()
            .pixels(Purpose::Evaluation, 0, 40_000);
        let found = [
            paper_mse::<2, 5>(&list, 6e-5),
            paper_mse::<3, 7>(&list, 5e-5),
            paper_mse::<4, 9>(&list, 5e-5),
        ];
        println!("T-MSE {found:?}");
        for (found, known) in found.into_iter().zip([9.7e-3, 6.1e-3, 4.8e-3]) {
            assert!((found / known - 1.0).abs() <= 0.03, "{found:e} against {known:e}");
        }
        // The control: without overestimation's share of the mass the error is another one.
        assert!((paper_mse::<2, 5>(&list, 1e-1) / 9.7e-3 - 1.0).abs() > 0.03);
    }
}
