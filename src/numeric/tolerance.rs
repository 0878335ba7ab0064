//! Comparison of numbers: a stated tolerance, failure on NaN, failure on empty input.

/// `|a − b| ≤ atol + rtol·|b|`; false as soon as either is NaN.
pub fn close(a: f64, b: f64, atol: f64, rtol: f64) -> bool {
    // Written so that NaN on either side makes the comparison false.
    (a - b).abs() <= atol + rtol * b.abs()
}

/// Worst and mean absolute error over pairs of numbers.
///
/// A non-finite value on either side is counted and never hidden by a maximum.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct AbsoluteError {
    count: u64,
    nonfinite: u64,
    worst: f64,
    sum: f64,
    sum_of_squares: f64,
}

impl AbsoluteError {
    /// Errors of `values` against `reference`, pair by pair.
    ///
    /// # Panics
    /// If the lengths differ.
    pub fn of(values: &[f64], reference: &[f64]) -> Self {
        assert_eq!(values.len(), reference.len(), "compared slices differ in length");
        let mut error = Self::default();
        for (&v, &r) in values.iter().zip(reference) {
            error.add(v, r);
        }
        error
    }

    /// Adds one pair.
    pub fn add(&mut self, value: f64, reference: f64) {
        self.count += 1;
        if value.is_finite() && reference.is_finite() {
            let e = (value - reference).abs();
            self.worst = self.worst.max(e);
            self.sum += e;
            self.sum_of_squares += e * e;
        } else {
            self.nonfinite += 1;
        }
    }

    /// The errors of two disjoint sets of pairs together.
    pub fn merge(self, other: Self) -> Self {
        Self {
            count: self.count + other.count,
            nonfinite: self.nonfinite + other.nonfinite,
            worst: self.worst.max(other.worst),
            sum: self.sum + other.sum,
            sum_of_squares: self.sum_of_squares + other.sum_of_squares,
        }
    }

    /// Number of pairs.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Number of pairs of which a side was NaN or infinite.
    pub fn nonfinite(&self) -> u64 {
        self.nonfinite
    }

    /// Greatest absolute error; NaN where there was no pair or a non-finite one.
    pub fn worst(&self) -> f64 {
        if self.usable() { self.worst } else { f64::NAN }
    }

    /// Mean absolute error; NaN where there was no pair or a non-finite one.
    pub fn mean(&self) -> f64 {
        if self.usable() {
            self.sum / self.count as f64
        } else {
            f64::NAN
        }
    }

    /// Mean squared error; NaN where there was no pair or a non-finite one.
    pub fn mse(&self) -> f64 {
        if self.usable() {
            self.sum_of_squares / self.count as f64
        } else {
            f64::NAN
        }
    }

    /// Whether there was at least one pair, all were finite, and none was further off than `bar`.
    pub fn within(&self, bar: f64) -> bool {
        self.usable() && self.worst <= bar
    }

    fn usable(&self) -> bool {
        self.count > 0 && self.nonfinite == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nan_and_empty_input_fail() {
        assert!(close(1.0, 1.0 + 1e-9, 1e-8, 0.0));
        assert!(!close(f64::NAN, 1.0, 1e9, 1e9));
        assert!(!close(1.0, f64::NAN, 1e9, 1e9));
        assert!(!AbsoluteError::default().within(f64::INFINITY));
        assert!(!AbsoluteError::of(&[f64::NAN, 0.0], &[0.0, 0.0]).within(f64::INFINITY));
        assert!(AbsoluteError::of(&[f64::INFINITY], &[f64::INFINITY]).worst().is_nan());
    }

    #[test]
    fn worst_mean_and_mse() {
        let e = AbsoluteError::of(&[1.0, 2.0], &[1.5, 2.0]);
        assert_eq!((e.worst(), e.mean(), e.mse()), (0.5, 0.25, 0.125));
        assert!(e.within(0.5) && !e.within(0.499));
        let both = e.merge(AbsoluteError::of(&[0.0], &[1.0]));
        assert_eq!((both.count(), both.worst(), both.mean()), (3, 1.0, 0.5));
    }
}
