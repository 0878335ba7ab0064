//! One algorithm, several precisions: the numbers that reference code branches on.

use super::real::{Real, c};
use std::iter::Sum;

/// A binary floating-point number, `f32`, `f64` or a device's, which code may compare and branch on.
///
/// Transcendental functions come from the `libm` crate and not from the platform, so that the same input gives the same
/// bits on every machine. Multiplication and addition stay separate: nothing here contracts to a fused multiply-add. Of
/// two numbers of which one is NaN, the lesser and the greater are the other.
pub trait Scalar: Real<Mask = bool> + PartialOrd + Send + Sync + std::fmt::Debug + Sum + 'static {
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
    /// Neither NaN nor infinite.
    fn is_finite(self) -> bool;

    /// 1/(1 + e^−x), finite for every finite x.
    fn sigmoid(self) -> Self {
        // e^80 is finite in f32, and 1/(1 + e^80) is below every tolerance used here.
        Self::ONE / (Self::ONE + Real::min(-self, c(80.0)).exp())
    }
}

macro_rules! scalar {
    ($t:ty) => {
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
            fn is_finite(self) -> bool {
                <$t>::is_finite(self)
            }
        }
    };
}

scalar!(f32);
scalar!(f64);

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
