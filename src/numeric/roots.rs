//! Roots of polynomials that are known to have only real ones.

use super::Scalar;

/// Greatest degree that [`real_roots`] takes.
pub const MAX_ROOTS: usize = 4;

/// Most steps of one root: enough to halve a bracket down to one unit in the last place from any start.
const STEPS: usize = 200;

/// The roots of c_0 + c_1 x + … + c_d x^d in ascending order, the first d entries of the result, for a polynomial all
/// of whose roots are real.
///
/// Degrees 1 and 2 are solved in closed form without cancellation. Above that the roots of the derivative, found in the
/// same way, bracket the roots one by one, Laguerre's and Samuelson's bounds close the outer brackets, and a Newton
/// iteration that is kept within its bracket finds each. The result is therefore always real: where rounding has pushed
/// a close pair off the real line, it is the nearby extremum twice.
///
/// # Shapes
/// `coefficients: [d + 1]`, 1 ≤ d ≤ [`MAX_ROOTS`], c_0 first, c_d ≠ 0.
///
/// # Accuracy
/// Simple roots to a few units in the last place times their condition (`roots_are_recovered`).
///
/// # Panics
/// If the degree is out of range.
pub fn real_roots<R: Scalar>(coefficients: &[R]) -> [R; MAX_ROOTS] {
    let degree = coefficients.len() - 1;
    assert!(
        (1..=MAX_ROOTS).contains(&degree),
        "degree {degree} is not in 1..={MAX_ROOTS}"
    );
    let mut roots = [R::ZERO; MAX_ROOTS];
    match *coefficients {
        [c0, c1] => roots[0] = -c0 / c1,
        [c0, c1, c2] => (roots[0], roots[1]) = quadratic(c0, c1, c2),
        _ => bracketed(coefficients, &mut roots),
    }
    roots
}

fn quadratic<R: Scalar>(c0: R, c1: R, c2: R) -> (R, R) {
    let half = c1 * R::from_f64(0.5);
    let discriminant = half * half - c2 * c0;
    // Rounding alone makes the discriminant of a double root negative.
    let root = if discriminant < R::ZERO {
        R::ZERO
    } else {
        discriminant.sqrt()
    };
    let sum = if half < R::ZERO { root - half } else { -(half + root) };
    let (a, b) = (sum / c2, if sum == R::ZERO { R::ZERO } else { c0 / sum });
    if a < b { (a, b) } else { (b, a) }
}

fn bracketed<R: Scalar>(c: &[R], roots: &mut [R; MAX_ROOTS]) {
    let degree = c.len() - 1;
    let mut derivative = [R::ZERO; MAX_ROOTS];
    for k in 1..=degree {
        derivative[k - 1] = c[k] * R::from_f64(k as f64);
    }
    let extrema = real_roots(&derivative[..degree]);
    // Every root lies within (d − 1)/d · sqrt(a² − 2d/(d − 1) b) of −a/d, a and b the next coefficients of the monic
    // polynomial.
    let d = R::from_f64(degree as f64);
    let less = R::from_f64((degree - 1) as f64);
    let (a, b) = (c[degree - 1] / c[degree], c[degree - 2] / c[degree]);
    let spread = a * a - R::from_f64(2.0) * d / less * b;
    let radius = less / d * if spread < R::ZERO { R::ZERO } else { spread.sqrt() };
    let slack = R::from_f64(8.0) * R::EPSILON * (radius + a.abs());
    let (least, greatest) = (-a / d - radius - slack, -a / d + radius + slack);
    for i in 0..degree {
        let low = if i == 0 { least } else { extrema[i - 1] };
        let high = if i == degree - 1 { greatest } else { extrema[i] };
        // Newton's method runs monotonically to the outer roots from outside.
        let start = match i {
            0 => low,
            i if i == degree - 1 => high,
            _ => (low + high) * R::from_f64(0.5),
        };
        let rising = (c[degree] > R::ZERO) == (degree - 1 - i).is_multiple_of(2);
        roots[i] = bracketed_root(c, low, high, start, rising);
    }
}

/// The root within [low, high] of a polynomial that rises (or falls) through it.
fn bracketed_root<R: Scalar>(c: &[R], mut low: R, mut high: R, start: R, rising: bool) -> R {
    let mut x = start;
    for _ in 0..STEPS {
        let (mut value, mut slope) = (R::ZERO, R::ZERO);
        for &c in c.iter().rev() {
            slope = slope * x + value;
            value = value * x + c;
        }
        if value == R::ZERO {
            break;
        }
        if (value > R::ZERO) == rising {
            high = x;
        } else {
            low = x;
        }
        let newton = x - value / slope;
        let next = if newton >= low && newton <= high {
            newton
        } else {
            (low + high) * R::from_f64(0.5)
        };
        let step = (next - x).abs();
        x = next;
        if step <= R::from_f64(2.0) * R::EPSILON * x.abs() {
            break;
        }
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Coefficients of scale · Π (x − root).
    fn expand(roots: &[f64], scale: f64) -> Vec<f64> {
        let mut c = vec![scale];
        for &r in roots {
            c.push(0.0);
            for k in (0..c.len()).rev() {
                c[k] = if k > 0 { c[k - 1] } else { 0.0 } - r * c[k];
            }
        }
        c
    }

    proptest! {
        /// Roots at least 0.05 apart in [−2, 2], to 1e-10 in f64 and 2e-2 in f32: coefficients rounded to ε move a root
        /// by ε · Σ|c x^k| / |p'|, at most 2e-16 · 81 / 0.05³ = 1.3e-10 for four of them at 2; typical ones are far
        /// better.
        #[test]
        fn roots_are_recovered(gaps in prop::collection::vec(0.05f64..1.0, 1..=4), scale in prop_oneof![-9.0f64..-0.1,
            0.1f64..9.0]) {
            let total: f64 = gaps.iter().sum();
            let mut at = -total / 2.0;
            let roots: Vec<f64> = gaps.iter().map(|g| { at += g; at }).collect();
            let c = expand(&roots, scale);
            let found = real_roots(&c);
            for (f, r) in found.iter().zip(&roots) {
                prop_assert!((f - r).abs() <= 1e-10, "{found:?} for {roots:?}");
            }
            let single: Vec<f32> = c.iter().map(|&c| c as f32).collect();
            let found = real_roots(&single);
            for (&f, r) in found.iter().zip(&roots) {
                prop_assert!((f64::from(f) - r).abs() <= 2e-2, "{found:?} for {roots:?}");
            }
        }

        /// One root many orders of magnitude away costs neither it nor the others their digits. Tolerance 1e-9 relative
        /// to the root's size and to 1.
        #[test]
        fn far_roots(near in prop::collection::vec(0.1f64..0.9, 1..=3), exponent in 1.0f64..8.0,
            negative in any::<bool>()) {
            let mut roots: Vec<f64> = near.iter().enumerate().map(|(i, r)| i as f64 + r * 0.8).collect();
            roots.push(10f64.powf(exponent) * if negative { -1.0 } else { 5.0 });
            let found = real_roots(&expand(&roots, 1.0));
            roots.sort_by(f64::total_cmp);
            for (f, r) in found.iter().zip(&roots) {
                prop_assert!((f - r).abs() <= 1e-9 * r.abs().max(1.0) * 10.0, "{found:?} for {roots:?}");
            }
        }
    }

    #[test]
    fn multiple_roots_stay_real_and_close() {
        // A d-fold root moves by ε^(1/d).
        for (roots, tolerance) in [
            (vec![0.3, 0.3], 1e-7),
            (vec![0.3, 0.3, 0.7], 1e-6),
            (vec![0.3; 3], 1e-4),
            (vec![-0.6, 0.3, 0.3, 0.7], 1e-6),
            (vec![0.3; 4], 1e-3),
        ] {
            let found = real_roots(&expand(&roots, 2.0));
            assert!(
                found.iter().zip(&roots).all(|(f, r)| (f - r).abs() < tolerance),
                "{found:?} for {roots:?}"
            );
        }
        assert_eq!(real_roots(&[0.0, 0.0, 1.0])[..2], [0.0, 0.0]);
    }

    #[test]
    fn nan_in_nan_out() {
        for degree in 1..=4 {
            let found = real_roots(&vec![f64::NAN; degree + 1]);
            assert!(found[..degree].iter().all(|r| r.is_nan()), "{degree}: {found:?}");
        }
    }
}
