//! Measures on the complex unit circle known by their trigonometric moments: Szegő polynomials, and the representation
//! by few atoms that has one at a given place.

use super::Scalar;
use super::complex::Complex;
use super::roots::{MAX_ROOTS, real_roots};

/// κ\[j\]\[t\]: coefficient of (i s)^t in (1 + i s)^j (1 − i s)^(m − j).
type Krawtchouk = [[f64; MAX_ROOTS + 1]; MAX_ROOTS + 1];

const fn krawtchouk(m: usize) -> Krawtchouk {
    let mut table = [[0.0; MAX_ROOTS + 1]; MAX_ROOTS + 1];
    let mut j = 0;
    while j <= m {
        table[j][0] = 1.0;
        let mut factor = 0;
        while factor < m {
            let sign = if factor < j { 1.0 } else { -1.0 };
            let mut t = m;
            while t > 0 {
                table[j][t] += sign * table[j][t - 1];
                t -= 1;
            }
            factor += 1;
        }
        j += 1;
    }
    table
}

const KRAWTCHOUK: [Krawtchouk; MAX_ROOTS + 1] = [
    krawtchouk(0),
    krawtchouk(1),
    krawtchouk(2),
    krawtchouk(3),
    krawtchouk(4),
];

/// An atom of a measure on the unit circle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CircleAtom<R> {
    /// Where, |x| = 1.
    pub x: Complex<R>,
    /// How much.
    pub mass: R,
}

/// Monic Szegő polynomials φ_0..φ_M of a measure on the unit circle: reflection coefficients of φ_{k+1} = x φ_k − ā_k
/// φ*_k and squared norms E_k.
///
/// # Shapes
/// M ≤ 4.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Szego<R, const M: usize> {
    reflection: [Complex<R>; M],
    inverse_norm: [R; MAX_ROOTS + 1],
}

impl<R: Scalar, const M: usize> Szego<R, M> {
    /// The polynomials of the measure with mass m_0 and moments m_1..m_M, m_k = ∫ x^k, by Levinson's algorithm on their
    /// Toeplitz matrix.
    ///
    /// Where an E_k is not positive, the moments are not those of a measure with more than k atoms, and everything is
    /// NaN.
    pub fn from_moments(mass: R, moments: &[Complex<R>; M]) -> Self {
        let mut reflection = [Complex::ZERO; M];
        let mut norm = [R::ZERO; MAX_ROOTS + 1];
        norm[0] = mass;
        let mut phi = [Complex::ZERO; MAX_ROOTS + 1];
        phi[0] = Complex::ONE;
        for k in 0..M {
            let mut overlap = Complex::ZERO;
            for j in 0..=k {
                overlap = overlap + phi[j] * moments[j];
            }
            let a = overlap.conj().scale(R::ONE / norm[k]);
            reflection[k] = a;
            norm[k + 1] = norm[k] * (R::ONE - a.norm_squared());
            let reversed: [_; MAX_ROOTS + 1] =
                std::array::from_fn(|j| if j <= k { phi[k - j].conj() } else { Complex::ZERO });
            for j in (0..=k + 1).rev() {
                let shifted = if j > 0 { phi[j - 1] } else { Complex::ZERO };
                phi[j] = shifted - a.conj() * reversed[j];
            }
        }
        let mut inverse_norm = [R::from_f64(f64::NAN); MAX_ROOTS + 1];
        if norm[..=M].iter().all(|&e| e > R::ZERO) {
            for k in 0..=M {
                inverse_norm[k] = R::ONE / norm[k];
            }
        }
        Self {
            reflection,
            inverse_norm,
        }
    }

    /// Kernel K(x, x) = Σ |φ_k(x)|²/E_k.
    fn kernel(&self, x: Complex<R>) -> R {
        let (mut phi, mut reversed) = (Complex::ONE, Complex::ONE);
        let mut sum = self.inverse_norm[0];
        for (k, &a) in self.reflection.iter().enumerate() {
            let shifted = x * phi;
            (phi, reversed) = (shifted - a.conj() * reversed, reversed - a * shifted);
            sum += phi.norm_squared() * self.inverse_norm[k + 1];
        }
        sum
    }

    /// Coefficients q of the kernel polynomial K(x0, x) = Σ q_k x^k; its M roots lie on the unit circle.
    pub fn kernel_polynomial(&self, x0: Complex<R>) -> [Complex<R>; MAX_ROOTS + 1] {
        let mut phi = [Complex::ZERO; MAX_ROOTS + 1];
        phi[0] = Complex::ONE;
        let (mut at, mut at_reversed) = (Complex::ONE, Complex::ONE);
        let mut q = [Complex::ZERO; MAX_ROOTS + 1];
        q[0] = Complex::new(self.inverse_norm[0], R::ZERO);
        for k in 0..M {
            let a = self.reflection[k];
            let before = phi;
            for j in 0..=k + 1 {
                let shifted = if j > 0 { before[j - 1] } else { Complex::ZERO };
                let reversed = if j <= k { before[k - j].conj() } else { Complex::ZERO };
                phi[j] = shifted - a.conj() * reversed;
            }
            let shifted = x0 * at;
            (at, at_reversed) = (shifted - a.conj() * at_reversed, at_reversed - a * shifted);
            let factor = at.conj().scale(self.inverse_norm[k + 1]);
            for j in 0..=k + 1 {
                q[j] = q[j] + factor * phi[j];
            }
        }
        q
    }

    /// The M + 1 atoms of the one measure with these moments that has M + 1 atoms, the first of them at x0.
    ///
    /// The other atoms are the roots of the kernel polynomial. With x = −x0 (1 + i s)/(1 − i s) the circle without x0
    /// becomes the real line and the polynomial a real one of the same degree with M real roots and leading coefficient
    /// K(x0, x0) > 0, so that every atom lies on the circle by construction.
    ///
    /// # Source
    /// MKKP18 Algorithm 2, which finds the roots as complex numbers and the masses by divided differences.
    ///
    /// # Domain
    /// |x0| = 1.
    pub fn atoms(&self, x0: Complex<R>) -> [CircleAtom<R>; MAX_ROOTS + 1] {
        let q = self.kernel_polynomial(x0);
        let opposite = x0.scale(-R::ONE);
        let mut turned = [Complex::ZERO; MAX_ROOTS + 1];
        let mut power = Complex::ONE;
        for j in 0..=M {
            turned[j] = q[j] * power;
            power = power * opposite;
        }
        let mut c = [R::ZERO; MAX_ROOTS + 1];
        for (t, c) in c.iter_mut().enumerate().take(M + 1) {
            let mut sum = Complex::ZERO;
            for j in 0..=M {
                sum = sum + turned[j].scale(R::from_f64(KRAWTCHOUK[M][j][t]));
            }
            // Scalar part of i^(M + t) · sum; the imaginary part is nought but rounding.
            *c = match (M + t) % 4 {
                0 => sum.re,
                1 => -sum.im,
                2 => -sum.re,
                _ => sum.im,
            };
        }
        let s = real_roots(&c[..=M]);
        let mut atoms = [CircleAtom {
            x: x0,
            mass: R::ONE / self.kernel(x0),
        }; MAX_ROOTS + 1];
        for (atom, &s) in atoms[1..=M].iter_mut().zip(&s) {
            let scale = R::ONE / (R::ONE + s * s);
            let x = opposite * Complex::new((R::ONE - s * s) * scale, (s + s) * scale);
            *atom = CircleAtom {
                x,
                mass: R::ONE / self.kernel(x),
            };
        }
        atoms
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn on_circle(t: f64) -> Complex<f64> {
        Complex::new(t.cos(), t.sin())
    }

    fn moments<const M: usize>(atoms: &[(f64, f64)]) -> [Complex<f64>; M] {
        std::array::from_fn(|k| {
            atoms.iter().fold(Complex::ZERO, |sum, (t, w)| {
                sum + on_circle((k + 1) as f64 * t).scale(*w)
            })
        })
    }

    /// Roots of a complex polynomial by simultaneous (Durand–Kerner) iteration, with no idea of a circle.
    fn complex_roots(q: &[Complex<f64>]) -> Vec<Complex<f64>> {
        let divide = |a: Complex<f64>, b: Complex<f64>| (a * b.conj()).scale(1.0 / b.norm_squared());
        let degree = q.len() - 1;
        let mut roots: Vec<_> = (0..degree)
            .map(|k| on_circle(0.4 + 2.1 * k as f64).scale(0.9 + 0.05 * k as f64))
            .collect();
        for _ in 0..2000 {
            for i in 0..degree {
                let value = q.iter().rev().fold(Complex::ZERO, |sum, &c| sum * roots[i] + c);
                let mut product = q[degree];
                for j in (0..degree).filter(|&j| j != i) {
                    product = product * (roots[i] - roots[j]);
                }
                roots[i] = roots[i] - divide(value, product);
            }
        }
        roots
    }

    fn check<const M: usize>(atoms: &[(f64, f64)], t0: f64) -> Result<(), TestCaseError> {
        let total: f64 = atoms.iter().map(|a| a.1).sum();
        let m = moments::<M>(atoms).map(|m| m.scale(1.0 - 1e-3));
        let szego = Szego::<f64, M>::from_moments(total, &m);
        let found = szego.atoms(on_circle(t0));
        // The atoms have the moments, all of them: tolerance 1e-9 of the mass.
        let mass: f64 = found[..=M].iter().map(|a| a.mass).sum();
        prop_assert!((mass - total).abs() < 1e-9 * total, "{mass} {total}");
        for (k, m) in m.iter().enumerate() {
            let sum = found[..=M].iter().fold(Complex::ZERO, |sum, a| {
                sum + (0..=k).fold(Complex::ONE, |p, _| p * a.x).scale(a.mass)
            });
            prop_assert!(
                (sum - *m).norm_squared().sqrt() < 1e-9 * total,
                "moment {}: {sum:?} {m:?}",
                k + 1
            );
        }
        prop_assert!(
            found[..=M]
                .iter()
                .all(|a| a.mass > 0.0 && (a.x.norm_squared() - 1.0).abs() < 1e-14)
        );
        // A solver that knows of no circle finds the same roots, on the circle to 1e-8.
        for root in complex_roots(&szego.kernel_polynomial(on_circle(t0))[..=M]) {
            prop_assert!((root.norm_squared().sqrt() - 1.0).abs() < 1e-8, "{root:?}");
            prop_assert!(
                found[1..=M].iter().any(|a| (a.x - root).norm_squared().sqrt() < 1e-8),
                "{root:?} in {found:?}"
            );
        }
        // The control: the polynomial of a non-positive Toeplitz matrix has roots off the circle, and the atoms are
        // NaN.
        let bad = Szego::<f64, M>::from_moments(
            total,
            &m.map(|m| m.scale(3.0 * total / (m.norm_squared().sqrt() + 1e-3 * total))),
        );
        prop_assert!(bad.atoms(on_circle(t0))[0].mass.is_nan());
        Ok(())
    }

    proptest! {
        #[test]
        fn atoms_on_the_circle_have_the_moments(atoms in prop::collection::vec((0.0f64..6.0, 0.05f64..1.0), 1..20),
            t0 in 0.0f64..6.0) {
            check::<2>(&atoms, t0)?;
            check::<3>(&atoms, t0)?;
            check::<4>(&atoms, t0)?;
        }
    }
}
