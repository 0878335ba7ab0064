//! One algorithm, two precisions: the arithmetic that reference code needs, for `f32` and `f64`.

use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// A binary floating-point number, `f32` or `f64`.
///
/// Transcendental functions come from the `libm` crate and not from the platform, so that the same input gives the same bits
/// on every machine. Multiplication and addition stay separate: nothing here contracts to a fused multiply-add.
pub trait Scalar:
    Copy
    + PartialOrd
    + Send
    + Sync
    + std::fmt::Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + Sum
    + 'static
{
    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;
    /// Distance from 1 to the next greater number.
    const EPSILON: Self;
    /// Rounds an `f64` to this precision.
    fn from_f64(x: f64) -> Self;
    /// Widens (or rounds) an `f32` to this precision; exact for both.
    fn from_f32(x: f32) -> Self;
    /// Widens to `f64`; exact for both.
    fn to_f64(self) -> f64;
    /// e^self.
    fn exp(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Square root, correctly rounded; NaN of a negative number.
    fn sqrt(self) -> Self;
    /// The lesser of two numbers; `other` where `self` is NaN.
    fn min(self, other: Self) -> Self;
    /// The greater of two numbers; `other` where `self` is NaN.
    fn max(self, other: Self) -> Self;
    /// |self|.
    fn abs(self) -> Self;
    /// Neither NaN nor infinite.
    fn is_finite(self) -> bool;

    /// 1/(1 + e^−x), finite for every finite x.
    fn sigmoid(self) -> Self {
        // e^80 is finite in f32, and 1/(1 + e^80) is below every tolerance used here.
        let eighty = Self::from_f64(80.0);
        Self::ONE / (Self::ONE + (-self).min(eighty).exp())
    }
}

macro_rules! real {
    ($t:ty, $exp:path, $ln:path) => {
        impl Scalar for $t {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const EPSILON: Self = <$t>::EPSILON;
            #[inline]
            fn from_f64(x: f64) -> Self {
                x as $t
            }
            #[inline]
            fn from_f32(x: f32) -> Self {
                x as $t
            }
            #[inline]
            fn to_f64(self) -> f64 {
                self as f64
            }
            #[inline]
            fn exp(self) -> Self {
                $exp(self)
            }
            #[inline]
            fn ln(self) -> Self {
                $ln(self)
            }
            #[inline]
            fn sqrt(self) -> Self {
                // IEEE 754 rounds square roots correctly: the platform's is the same everywhere.
                <$t>::sqrt(self)
            }
            #[inline]
            fn min(self, other: Self) -> Self {
                <$t>::min(self, other)
            }
            #[inline]
            fn max(self, other: Self) -> Self {
                <$t>::max(self, other)
            }
            #[inline]
            fn abs(self) -> Self {
                <$t>::abs(self)
            }
            #[inline]
            fn is_finite(self) -> bool {
                <$t>::is_finite(self)
            }
        }
    };
}

real!(f32, libm::expf, libm::logf);
real!(f64, libm::exp, libm::log);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sigmoid_is_finite_and_bounded_everywhere() {
        for x in [-f32::MAX, -1e4, -90.0, -1.0, -0.0, 0.0, 1e-40, 1.0, 90.0, f32::MAX] {
            let s = x.sigmoid();
            assert!(s.is_finite() && (0.0..=1.0).contains(&s), "sigmoid({x}) = {s}");
        }
        assert_eq!(0.0f64.sigmoid(), 0.5);
        assert!((1.0f64.sigmoid() - 0.731_058_578_630_004_9).abs() < 1e-15);
    }
}
