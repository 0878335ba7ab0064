//! Trigonometric moments of absorbance, and absorbance in front of a depth reconstructed from them.

use crate::numeric::Scalar;
use crate::numeric::complex::Complex;
use crate::numeric::unit_circle::Szego;
use crate::pixel::MomentDepth;

/// θ, the arc of the circle that no depth maps to and where depths wrap around \[radians\].
///
/// # Source
/// MKKP18 Sec. 5.2.
pub const WRAPPING_ZONE: f64 = std::f64::consts::PI / 10.0;

/// Trigonometric moments b_0..b_M of a pixel; b_0 is real.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrigonometricMoments<R, const M: usize> {
    /// Total absorbance.
    pub total: R,
    /// b_1..b_M, b_k = Σ A x^k.
    pub b: [Complex<R>; M],
}

/// Point of the unit circle that a depth stands for: x = exp(i (2π − θ)(z + 1)/2).
///
/// # Source
/// MKKP18 Eq. 5.
pub fn circle_point<R: Scalar>(MomentDepth(z): MomentDepth) -> Complex<R> {
    let (sin, cos) = libm::sincos((2.0 * std::f64::consts::PI - WRAPPING_ZONE) * (z + 1.0) / 2.0);
    Complex::new(R::from_f64(cos), R::from_f64(sin))
}

impl<R: Scalar, const M: usize> TrigonometricMoments<R, M> {
    /// No absorbance.
    pub const ZERO: Self = Self {
        total: R::ZERO,
        b: [Complex::ZERO; M],
    };

    /// Adds a fragment; a negative absorbance takes one away.
    pub fn add(&mut self, z: MomentDepth, absorbance: R) {
        let x = circle_point(z);
        let mut term = Complex::new(absorbance, R::ZERO);
        self.total += absorbance;
        for b in &mut self.b {
            term = term * x;
            *b = *b + term;
        }
    }
}

/// A number that grows with the angle of a point of the unit circle, from −1 at angle 0 to 7 just below 2π, without
/// inverse functions.
///
/// # Source
/// MKKP18 Sec. 5.2, ψ.
fn order<R: Scalar>(x: Complex<R>) -> R {
    match (x.re >= R::ZERO, x.im >= R::ZERO) {
        (true, true) => x.im - x.re,
        (false, true) => R::from_f64(2.0) - x.re - x.im,
        (false, false) => R::from_f64(4.0) + x.re - x.im,
        (true, false) => R::from_f64(6.0) + x.re + x.im,
    }
}

/// `moment_bias` of M trigonometric moments \[dimensionless\], M one of 2, 3, 4: b_k ← (1 − bias) b_k.
///
/// # Source
/// MKKP18, supplementary document.
///
/// # Panics
/// For another M.
pub fn moment_bias(m: usize, sixteen_bits: bool) -> f64 {
    match (m, sixteen_bits) {
        (2, false) => 4e-7,
        (3, false) => 8e-7,
        (4, false) => 1.5e-6,
        (2, true) => 4e-4,
        (3, true) => 6.5e-4,
        (4, true) => 8.5e-4,
        _ => panic!("{m} trigonometric moments: only 2, 3 and 4 are defined"),
    }
}

/// Absorbance over depth as M trigonometric moments tell it.
///
/// # Source
/// MKKP18 Algorithm 2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrigonometricCurve<R, const M: usize> {
    total: R,
    szego: Szego<R, M>,
    end: R,
}

impl<R: Scalar, const M: usize> TrigonometricCurve<R, M> {
    /// The curve of a pixel's moments, normalised by b_0 and then biased.
    ///
    /// # Domain
    /// b_0 = 0 gives a curve that is NaN everywhere.
    pub fn new(moments: &TrigonometricMoments<R, M>, bias: f64) -> Self {
        let scale = R::from_f64(1.0 - bias) / moments.total;
        let szego = Szego::from_moments(R::ONE, &moments.b.map(|b| b.scale(scale)));
        Self {
            total: moments.total,
            szego,
            end: order(circle_point(MomentDepth(1.0))),
        }
    }

    /// Absorbance in front of a depth; not a bound, but near one for overestimation 0 and 1.
    ///
    /// # Source
    /// MKKP18 Eq. 6 for the share of each atom.
    pub fn absorbance(&self, z: MomentDepth, overestimation: f64) -> R {
        let x0 = circle_point(z);
        let here = order(x0);
        let atoms = self.szego.atoms(x0);
        let mut sum = R::from_f64(overestimation) * atoms[0].mass;
        for atom in &atoms[1..=M] {
            let place = order(atom.x);
            let share = if place < here {
                R::ONE
            } else if place <= self.end {
                R::ZERO
            } else {
                (place - self.end) / (R::from_f64(7.0) - self.end)
            };
            sum += share * atom.mass;
        }
        self.total * sum
    }

    /// T = exp(−A).
    pub fn transmittance(&self, z: MomentDepth, overestimation: f64) -> R {
        (-self.absorbance(z, overestimation)).exp()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn moments<const M: usize>(fragments: &[(f64, f64)]) -> TrigonometricMoments<f64, M> {
        let mut b = TrigonometricMoments::ZERO;
        for &(z, a) in fragments {
            b.add(MomentDepth(z), a);
        }
        b
    }

    #[test]
    fn the_order_of_points_is_the_order_of_depths() {
        let places: Vec<f64> = (0..=1000)
            .map(|i| order(circle_point(MomentDepth(i as f64 / 500.0 - 1.0))))
            .collect();
        assert!(places.windows(2).all(|w| w[0] < w[1]));
        assert_eq!(places[0], -1.0);
        assert!(places[1000] < 7.0);
    }

    proptest! {
        /// At most M atoms at least 0.1 apart and clear of the ends, moment_bias 1e-10: tolerance 1e-5 at every atom.
        #[test]
        fn few_atoms_are_exact(gaps in prop::collection::vec(0.1f64..0.45, 4),
            masses in prop::collection::vec(0.1f64..1.0, 4)) {
            let mut at = -0.95;
            let fragments: Vec<(f64, f64)> = gaps.iter().zip(&masses).map(|(g, &a)| { at += g; (at, a) }).collect();
            let curves = (
                TrigonometricCurve::new(&moments::<2>(&fragments[..2]), 1e-10),
                TrigonometricCurve::new(&moments::<3>(&fragments[..3]), 1e-12),
                TrigonometricCurve::new(&moments::<4>(&fragments), 1e-13),
            );
            let mut in_front = 0.0;
            for (i, &(z, a)) in fragments.iter().enumerate() {
                let z = MomentDepth(z);
                let mut found = vec![curves.2.absorbance(z, 0.0)];
                if i < 3 { found.push(curves.1.absorbance(z, 0.0)); }
                if i < 2 { found.push(curves.0.absorbance(z, 0.0)); }
                for f in found {
                    prop_assert!((f - in_front).abs() <= 1e-5, "{f} for {in_front} at {z:?}");
                }
                in_front += a;
            }
        }

        /// Single precision stays near double with a bias of 1e-3. Tolerance 2e-2 of T.
        #[test]
        fn single_precision(fragments in prop::collection::vec((-1.0f64..1.0, 0.05f64..1.0), 1..20),
            z in -0.9f64..0.9) {
            let b = moments::<3>(&fragments);
            let mut single = TrigonometricMoments::<f32, 3>::ZERO;
            for &(z, a) in &fragments {
                single.add(MomentDepth(z), a as f32);
            }
            let d = TrigonometricCurve::new(&b, 1e-3).transmittance(MomentDepth(z), 0.25);
            let s = TrigonometricCurve::new(&single, 1e-3).transmittance(MomentDepth(z), 0.25);
            prop_assert!((d - f64::from(s)).abs() < 2e-2, "{d} {s}");
        }
    }
}
