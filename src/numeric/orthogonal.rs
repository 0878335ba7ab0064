//! Measures on the real line known by their moments: orthogonal polynomials, and the representation by few atoms that
//! has one at a given place.

use super::Scalar;
use super::roots::{MAX_ROOTS, real_roots};

/// Beyond this distance from the prescribed atom, another one has no mass: at most h_n · 1e-16 for n = 2, less above.
const FAR: f64 = 1e4;

/// Monic orthogonal polynomials π_0..π_N of a measure: their three-term recurrence π_{k+1} = (x − α_k) π_k − β_k
/// π_{k−1} and their squared norms h_k.
///
/// # Shapes
/// N ≤ 4.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Orthogonal<R, const N: usize> {
    alpha: [R; N],
    beta: [R; N],
    norm: [R; MAX_ROOTS + 1],
    inverse_norm: [R; MAX_ROOTS + 1],
}

/// Mass of a measure in front of a point: sharp bounds, from its moments alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MassBounds<R> {
    /// Least mass strictly below the point that the moments allow.
    pub lower: R,
    /// Greatest mass at and below the point that the moments allow.
    pub upper: R,
}

impl<R: Scalar> MassBounds<R> {
    /// lower + weight · (upper − lower).
    pub fn blend(self, weight: R) -> R {
        self.lower + weight * (self.upper - self.lower)
    }
}

impl<R: Scalar, const N: usize> Orthogonal<R, N> {
    /// The polynomials of the measure with these moments, by a factorisation L D Lᵀ of their Hankel matrix.
    ///
    /// Row k of D Lᵀ is found from the two rows above it by Chebyshev's algorithm; D holds the h_k. Where an h_k is not
    /// positive, the moments are not those of a measure with more than k atoms, and everything is NaN.
    ///
    /// # Shapes
    /// `moments: [2N + 1]`, m_0 first.
    ///
    /// # Source
    /// W. Gautschi, *Orthogonal Polynomials: Computation and Approximation*, Sec. 2.1.7.
    ///
    /// # Panics
    /// If another number of moments is given.
    pub fn from_moments(moments: &[R]) -> Self {
        assert_eq!(moments.len(), 2 * N + 1, "2N + 1 moments");
        let mut above = [R::ZERO; 2 * MAX_ROOTS + 1];
        let mut row = above;
        row[..=2 * N].copy_from_slice(moments);
        let (mut alpha, mut beta, mut norm) = ([R::ZERO; N], [R::ZERO; N], [R::ZERO; MAX_ROOTS + 1]);
        norm[0] = row[0];
        for k in 0..N {
            alpha[k] = row[k + 1] / norm[k];
            if k > 0 {
                alpha[k] -= above[k] / norm[k - 1];
                beta[k] = norm[k] / norm[k - 1];
            }
            let mut below = above;
            for l in k + 1..2 * N - k {
                below[l] = row[l + 1] - alpha[k] * row[l] - beta[k] * above[l];
            }
            above = row;
            row = below;
            norm[k + 1] = row[k + 1];
        }
        Self::new(alpha, beta, norm)
    }

    /// The polynomials of the measure that has these atoms and, beyond them, h_N = `last_norm`.
    ///
    /// # Shapes
    /// `atoms: [N]`, `masses: [N]`, positive, the atoms distinct.
    pub fn from_atoms(atoms: &[R; N], masses: &[R; N], last_norm: R) -> Self {
        let (mut alpha, mut beta, mut norm) = ([R::ZERO; N], [R::ZERO; N], [R::ZERO; MAX_ROOTS + 1]);
        let (mut before, mut here) = ([R::ZERO; N], [R::ONE; N]);
        for k in 0..N {
            let (mut mass, mut first) = (R::ZERO, R::ZERO);
            for i in 0..N {
                let weight = masses[i] * here[i] * here[i];
                mass += weight;
                first += weight * atoms[i];
            }
            norm[k] = mass;
            alpha[k] = first / mass;
            if k > 0 {
                beta[k] = norm[k] / norm[k - 1];
            }
            for i in 0..N {
                let next = (atoms[i] - alpha[k]) * here[i] - beta[k] * before[i];
                before[i] = here[i];
                here[i] = next;
            }
        }
        norm[N] = last_norm;
        Self::new(alpha, beta, norm)
    }

    fn new(alpha: [R; N], beta: [R; N], norm: [R; MAX_ROOTS + 1]) -> Self {
        let positive = norm[..=N].iter().all(|&h| h > R::ZERO);
        let mut inverse_norm = [R::from_f64(f64::NAN); MAX_ROOTS + 1];
        if positive {
            for k in 0..=N {
                inverse_norm[k] = R::ONE / norm[k];
            }
        }
        Self {
            alpha,
            beta,
            norm,
            inverse_norm,
        }
    }

    /// Squared norm h_N = ∫ π_N² of the last polynomial: how far the moments are from those of N atoms.
    pub fn last_norm(&self) -> R {
        self.norm[N]
    }

    /// Greatest h_N that a measure on [low, high] with these π_0..π_N can have: that at which (x − α) π_N − h_N/h_{N−1}
    /// π_{N−1} has a root at either end (Gauss–Lobatto quadrature).
    pub fn greatest_last_norm(&self, low: R, high: R) -> R {
        let ratio = |x: R| {
            let (mut before, mut here) = (R::ZERO, R::ONE);
            for k in 0..N {
                let next = (x - self.alpha[k]) * here - self.beta[k] * before;
                before = here;
                here = next;
            }
            before / here
        };
        (high - low) / (ratio(high) - ratio(low)) * self.norm[N - 1]
    }

    /// Kernel K(x, x) = Σ_{k<terms} π_k(x)²/h_k; its inverse is the greatest mass that an atom at x can have.
    fn kernel(&self, x: R, terms: usize) -> R {
        let (mut before, mut here) = (R::ZERO, R::ONE);
        let mut sum = self.inverse_norm[0];
        for k in 0..terms - 1 {
            let next = (x - self.alpha[k]) * here - self.beta[k] * before;
            before = here;
            here = next;
            sum += here * here * self.inverse_norm[k + 1];
        }
        sum
    }

    /// The representation by N atoms that has the moments m_0..m_{2N−1} (Gauss' quadrature): atoms in ascending order
    /// and their masses.
    pub fn gauss(&self) -> ([R; N], [R; N]) {
        // Coefficients of π_N about the centre of the atoms, which is where they are smallest.
        let mut centre = R::ZERO;
        for &a in &self.alpha {
            centre += a;
        }
        centre = centre / R::from_f64(N as f64);
        let mut before = [R::ZERO; MAX_ROOTS + 1];
        let mut here = before;
        here[0] = R::ONE;
        for k in 0..N {
            let next = self.next(k, centre, &here, &before);
            before = here;
            here = next;
        }
        let roots = real_roots(&here[..=N]);
        let atoms = std::array::from_fn(|i| centre + roots[i]);
        (atoms, atoms.map(|x| R::ONE / self.kernel(x, N)))
    }

    /// Coefficients of π_{k+1} about a point from those of π_k and π_{k−1}.
    #[inline]
    fn next(&self, k: usize, centre: R, here: &[R; MAX_ROOTS + 1], before: &[R; MAX_ROOTS + 1]) -> [R; MAX_ROOTS + 1] {
        let shift = centre - self.alpha[k];
        let mut next = [R::ZERO; MAX_ROOTS + 1];
        next[0] = shift * here[0] - self.beta[k] * before[0];
        for j in 1..=N {
            next[j] = shift * here[j] + here[j - 1] - self.beta[k] * before[j];
        }
        next
    }

    /// Sharp bounds on the mass in front of `x`.
    ///
    /// Of all measures with the given moments, the one with an atom of the greatest possible mass at x is extremal
    /// there. Its other atoms are the roots of the kernel polynomial K(x, ·). They are found as s = 1/(atom − x): in s
    /// the polynomial's leading coefficient is K(x, x) > 0, so that an atom at infinity is the harmless s = 0, and the
    /// atoms in front of x are the negative roots.
    ///
    /// # Source
    /// MKKP18 Algorithm 1, which solves the same equations by divided differences.
    ///
    /// # Accuracy
    /// 1e-9 relative to the total mass against an independent program, in f64 with a bias of 1e-3
    /// (`moments::hamburger::tests::agrees_with_*`).
    pub fn bounds(&self, x: R) -> MassBounds<R> {
        let mut before = [R::ZERO; MAX_ROOTS + 1];
        let mut here = before;
        here[0] = R::ONE;
        // Coefficients of K(x, ·) about x, highest power of s = 1/(· − x) last.
        let mut c = [R::ZERO; MAX_ROOTS + 1];
        c[N] = self.inverse_norm[0];
        for k in 0..N {
            let next = self.next(k, x, &here, &before);
            before = here;
            here = next;
            let factor = here[0] * self.inverse_norm[k + 1];
            for j in 0..=N {
                c[N - j] += factor * here[j];
            }
        }
        let own = R::ONE / c[N];
        let mut lower = R::ZERO;
        for &s in &real_roots(&c[..=N])[..N] {
            // A NaN is not skipped.
            if s > R::from_f64(-1.0 / FAR) {
                continue;
            }
            lower += R::ONE / self.kernel(x + R::ONE / s, N + 1);
        }
        MassBounds {
            lower,
            upper: lower + own,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn moments<const M: usize>(atoms: &[(f64, f64)]) -> [f64; M] {
        std::array::from_fn(|k| atoms.iter().map(|(x, w)| w * x.powi(k as i32)).sum())
    }

    /// Legendre's polynomials: α = 0, β_k = k²/(4k² − 1), Gauss' nodes of [−1, 1].
    #[test]
    fn the_uniform_measure_gives_legendre() {
        let m: [f64; 9] = std::array::from_fn(|k| if k % 2 == 0 { 2.0 / (k as f64 + 1.0) } else { 0.0 });
        let p = Orthogonal::<f64, 4>::from_moments(&m);
        for k in 1..4 {
            let k2 = (k * k) as f64;
            assert!((p.beta[k] - k2 / (4.0 * k2 - 1.0)).abs() < 1e-13 && p.alpha[k].abs() < 1e-13);
        }
        let (nodes, weights) = p.gauss();
        let expected = [
            (0.8611363115940526, 0.3478548451374538),
            (0.3399810435848563, 0.6521451548625461),
        ];
        for (i, (x, w)) in expected.into_iter().enumerate() {
            assert!(
                (nodes[3 - i] - x).abs() < 1e-12 && (nodes[i] + x).abs() < 1e-12,
                "{nodes:?}"
            );
            assert!(
                (weights[3 - i] - w).abs() < 1e-12 && (weights[i] - w).abs() < 1e-12,
                "{weights:?}"
            );
        }
    }

    #[test]
    fn too_few_atoms_give_nan() {
        let one = Orthogonal::<f64, 2>::from_moments(&moments::<5>(&[(0.5, 1.0)]));
        assert!(one.bounds(0.25).lower.is_nan() && one.bounds(0.25).upper.is_nan());
        assert!(
            Orthogonal::<f64, 2>::from_moments(&[1.0, 0.0, -0.5, 0.0, 1.0])
                .bounds(0.0)
                .lower
                .is_nan()
        );
    }

    proptest! {
        /// Gauss' atoms are the atoms themselves, and rebuilding the polynomials from them changes nothing. Tolerance
        /// 1e-7: masses and gaps of 0.05 leave an h_3 of at least 1e-9.
        #[test]
        fn gauss_round_trip(gaps in prop::collection::vec(0.2f64..0.5, 4),
            masses in prop::collection::vec(0.05f64..1.0, 4), last in 0.01f64..1.0) {
            let mut at = -1.0;
            let atoms: [f64; 4] = std::array::from_fn(|i| { at += gaps[i]; at });
            let masses: [f64; 4] = std::array::from_fn(|i| masses[i]);
            let p = Orthogonal::<f64, 4>::from_atoms(&atoms, &masses, last);
            prop_assert_eq!(p.last_norm(), last);
            let (x, w) = p.gauss();
            for i in 0..4 {
                prop_assert!((x[i] - atoms[i]).abs() < 1e-7 && (w[i] - masses[i]).abs() < 1e-7, "{:?} {:?}", x, w);
            }
        }

        /// The measure itself lies within its bounds, with more atoms than moments. Tolerance 1e-9 of the mass.
        #[test]
        fn truth_lies_within(atoms in prop::collection::vec((-1.0f64..1.0, 0.01f64..1.0), 5..30), x in -1.0f64..1.0) {
            let total: f64 = atoms.iter().map(|a| a.1).sum();
            let below: f64 = atoms.iter().filter(|a| a.0 < x).map(|a| a.1).sum();
            let four = Orthogonal::<f64, 2>::from_moments(&moments::<5>(&atoms)).bounds(x);
            let six = Orthogonal::<f64, 3>::from_moments(&moments::<7>(&atoms)).bounds(x);
            let slack = 1e-9 * total;
            for b in [four, six] {
                prop_assert!(b.lower <= below + slack && below <= b.upper + slack, "{below} in {b:?}");
            }
            // More moments, tighter bounds.
            prop_assert!(six.lower >= four.lower - 1e-6 * total && six.upper <= four.upper + 1e-6 * total, "{six:?} \
                {four:?}");
        }
    }

    /// The control of the test above: bounds of another measure do not hold the truth. A measure shifted by 0.6 has its
    /// mass elsewhere.
    #[test]
    fn bounds_of_another_measure_do_not_hold_the_truth() {
        let atoms: Vec<(f64, f64)> = (0..9).map(|i| (-0.9 + 0.1 * f64::from(i), 0.3)).collect();
        let shifted: Vec<(f64, f64)> = atoms.iter().map(|&(z, a)| (z + 0.6, a)).collect();
        let below: f64 = atoms.iter().filter(|a| a.0 < -0.2).map(|a| a.1).sum();
        let holds = |atoms: &[(f64, f64)]| {
            let b = Orthogonal::<f64, 3>::from_moments(&moments::<7>(atoms)).bounds(-0.2);
            b.lower <= below + 1e-9 && below <= b.upper + 1e-9
        };
        assert!(holds(&atoms) && !holds(&shifted));
    }
}
