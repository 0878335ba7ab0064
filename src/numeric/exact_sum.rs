//! Sums that do not depend on the order of their terms.

/// A sum in fixed point: every term is rounded by itself to a multiple of 2^−80, and whole numbers add up without
/// rounding, so that any order of the terms gives the same bits.
///
/// # Domain
/// Terms below 2^40 in size, at most 2^6 of the greatest. Greater ones and those that are not finite are added up
/// beside, in f64, in their order.
///
/// # Accuracy
/// Each term is off by at most 2^−80, below half an ulp of every f64 above 2^−27. Test `the_order_changes_no_bit`.
#[derive(Debug, Clone, Copy, Default)]
pub struct ExactSum {
    units: i128,
    beside: f64,
}

/// Units of a whole: 2^80.
const UNITS: f64 = (1u128 << 80) as f64;

/// Least size of a term that is added beside.
const LIMIT: f64 = (1u64 << 40) as f64;

impl ExactSum {
    /// Adds a term.
    pub fn add(&mut self, x: f64) {
        if x.abs() < LIMIT {
            self.units += (x * UNITS) as i128;
        } else {
            self.beside += x;
        }
    }

    /// The sum, rounded to f64.
    pub fn value(&self) -> f64 {
        self.units as f64 / UNITS + self.beside
    }
}

impl FromIterator<f64> for ExactSum {
    fn from_iter<I: IntoIterator<Item = f64>>(terms: I) -> Self {
        let mut sum = Self::default();
        terms.into_iter().for_each(|x| sum.add(x));
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Control: a plain sum of the same terms does depend on the order, in some case of a hundred.
        #[test]
        fn the_order_changes_no_bit(terms in prop::collection::vec(-1e3f64..1e3, 1..200), by in 0usize..200) {
            let mut turned = terms.clone();
            turned.rotate_left(by % terms.len());
            let sum = |terms: &[f64]| terms.iter().copied().collect::<ExactSum>().value();
            prop_assert_eq!(sum(&terms).to_bits(), sum(&turned).to_bits());
            turned.reverse();
            prop_assert_eq!(sum(&terms).to_bits(), sum(&turned).to_bits());
            let plain: f64 = terms.iter().sum();
            prop_assert!((sum(&terms) - plain).abs() <= 1e-9);
        }
    }

    #[test]
    fn a_plain_sum_depends_on_the_order() {
        let terms = [1.0, 1e-16, 1e-16, 1e-16];
        let backwards: f64 = terms.iter().rev().sum();
        assert_ne!(terms.iter().sum::<f64>(), backwards);
        let exact = |terms: &mut dyn Iterator<Item = f64>| terms.collect::<ExactSum>().value();
        assert_eq!(
            exact(&mut terms.iter().copied()),
            exact(&mut terms.iter().rev().copied())
        );
    }

    #[test]
    fn what_is_not_finite_stays() {
        let sum = |terms: &[f64]| terms.iter().copied().collect::<ExactSum>().value();
        assert!(sum(&[1.0, f64::NAN]).is_nan() && sum(&[f64::INFINITY, f64::NEG_INFINITY]).is_nan());
        assert_eq!(sum(&[1.0, f64::INFINITY]), f64::INFINITY);
        assert_eq!(sum(&[1e300, 1.0]), 1e300);
        assert_eq!(sum(&[]), 0.0);
    }
}
