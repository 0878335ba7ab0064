//! The arithmetic of devices: single precision with what shading languages allow beside IEEE 754.

use crate::numeric::Scalar;
use crate::numeric::real::{Operand, Real, Word, constant_on_the_right};
use std::cmp::Ordering;
use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// Single precision as a device may compute it.
///
/// - `FUSED`: wherever a product is added to something, the product is not rounded first (fused multiply-add), whatever
///   stands between the two.
/// - `ROUGH`: quotients, square roots, exponentials and logarithms are as far off as WGSL allows, up or down at the
///   whim of their operands' bits.
/// - `FLUSHED`: subnormal numbers are 0.
///
/// # Source
/// WGSL, Sec. "Floating Point Accuracy": 2.5 ULP for x / y, 3 + 2 |x| ULP for e^x and 2^x, 3 ULP for logarithms but
/// 2^−21 in [0.5, 2]; √x inherits 1 / inverseSqrt(x), 2 + 2.5 ULP.
#[derive(Debug, Clone, Copy)]
pub struct Device<const FUSED: bool, const ROUGH: bool, const FLUSHED: bool>(
    /// A single-precision number, or under `FUSED` the exact product of two.
    f64,
);

/// Fused multiply-adds, everything else exact to half an ULP.
pub type Fused = Device<true, false, false>;
/// Rough functions.
pub type Rough = Device<false, true, false>;
/// Flushed subnormals.
pub type Flushed = Device<false, false, true>;
/// All three at once.
pub type Worst = Device<true, true, true>;

/// A number between −1 and 1 that looks random, the same for the same bits.
fn whim(a: f32, b: f32) -> f64 {
    let mut x = (u64::from(a.to_bits()) << 32) | u64::from(b.to_bits());
    // SplitMix64's finaliser.
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^= x >> 31;
    (x >> 11) as f64 * (2.0 / (1u64 << 53) as f64) - 1.0
}

/// Unit in the last place of a single-precision number, taken of its exact value.
fn ulp(x: f64) -> f64 {
    let exponent = ((((x.abs()).to_bits() >> 52) & 0x7ff) as i32 - 1023).max(-126);
    libm::exp2(f64::from(exponent - 23))
}

impl<const FUSED: bool, const ROUGH: bool, const FLUSHED: bool> Device<FUSED, ROUGH, FLUSHED> {
    /// As the nearest single-precision number.
    fn settled(self) -> f32 {
        let x = self.0 as f32;
        if FLUSHED && x.is_subnormal() {
            0.0f32.copysign(x)
        } else {
            x
        }
    }

    fn single(x: f32) -> Self {
        Self(f64::from(Self(f64::from(x)).settled()))
    }

    fn rounded(x: f64) -> Self {
        Self::single(x as f32)
    }

    /// A function's value, off by up to so many ULP or so much, whichever is more.
    fn off(exact: f64, operands: (f32, f32), ulps: f64, least: f64) -> Self {
        if !ROUGH || !exact.is_finite() {
            return Self::rounded(exact);
        }
        Self::rounded(exact + whim(operands.0, operands.1) * (ulps * ulp(exact)).max(least))
    }

    fn logarithm(self, exact: impl Fn(f64) -> f64, whim_of: f32) -> Self {
        let x = self.settled();
        let near_one = (0.5..=2.0).contains(&x);
        Self::off(
            exact(x.into()),
            (x, whim_of),
            if near_one { 0.0 } else { 3.0 },
            if near_one { libm::exp2(-21.0) } else { 0.0 },
        )
    }
}

impl<const FUSED: bool, const ROUGH: bool, const FLUSHED: bool> PartialEq for Device<FUSED, ROUGH, FLUSHED> {
    fn eq(&self, other: &Self) -> bool {
        self.settled() == other.settled()
    }
}

impl<const FUSED: bool, const ROUGH: bool, const FLUSHED: bool> PartialOrd for Device<FUSED, ROUGH, FLUSHED> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.settled().partial_cmp(&other.settled())
    }
}

impl<const FUSED: bool, const ROUGH: bool, const FLUSHED: bool> Add for Device<FUSED, ROUGH, FLUSHED> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        // Of two products only one can be fused. A product of two f32 is exact in f64, and its sum with an f32 rounds
        // in f64 first, which a single rounding to f32 undoes but for ties of one in 2^28.
        let b = if f64::from(self.0 as f32) == self.0 {
            other.0
        } else {
            f64::from(other.settled())
        };
        Self::rounded(self.0 + b)
    }
}

impl<const FUSED: bool, const ROUGH: bool, const FLUSHED: bool> Sub for Device<FUSED, ROUGH, FLUSHED> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + (-other)
    }
}

impl<const FUSED: bool, const ROUGH: bool, const FLUSHED: bool> Neg for Device<FUSED, ROUGH, FLUSHED> {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl<const FUSED: bool, const ROUGH: bool, const FLUSHED: bool> Mul for Device<FUSED, ROUGH, FLUSHED> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let product = f64::from(self.settled()) * f64::from(other.settled());
        if FUSED { Self(product) } else { Self::rounded(product) }
    }
}

impl<const FUSED: bool, const ROUGH: bool, const FLUSHED: bool> Div for Device<FUSED, ROUGH, FLUSHED> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let (a, b) = (self.settled(), other.settled());
        Self::off(f64::from(a) / f64::from(b), (a, b), 2.5, 0.0)
    }
}

impl<const FUSED: bool, const ROUGH: bool, const FLUSHED: bool> AddAssign for Device<FUSED, ROUGH, FLUSHED> {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<const FUSED: bool, const ROUGH: bool, const FLUSHED: bool> SubAssign for Device<FUSED, ROUGH, FLUSHED> {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<const FUSED: bool, const ROUGH: bool, const FLUSHED: bool> MulAssign for Device<FUSED, ROUGH, FLUSHED> {
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl<const FUSED: bool, const ROUGH: bool, const FLUSHED: bool> Sum for Device<FUSED, ROUGH, FLUSHED> {
    fn sum<I: Iterator<Item = Self>>(items: I) -> Self {
        items.fold(Self::ZERO, Add::add)
    }
}

constant_on_the_right!([const FUSED: bool, const ROUGH: bool, const FLUSHED: bool] Device<FUSED, ROUGH, FLUSHED>);

impl<const FUSED: bool, const ROUGH: bool, const FLUSHED: bool> Scalar for Device<FUSED, ROUGH, FLUSHED> {
    const ZERO: Self = Self(0.0);
    const ONE: Self = Self(1.0);
    const EPSILON: Self = Self(f32::EPSILON as f64);

    fn from_f64(x: f64) -> Self {
        Self::rounded(x)
    }

    fn from_f32(x: f32) -> Self {
        Self::single(x)
    }

    fn to_f64(self) -> f64 {
        self.settled().into()
    }

    fn is_finite(self) -> bool {
        self.settled().is_finite()
    }
}

impl<const FUSED: bool, const ROUGH: bool, const FLUSHED: bool> Real for Device<FUSED, ROUGH, FLUSHED> {
    type Mask = bool;
    type Word = u32;
    const ROUNDING: f64 = f32::EPSILON as f64;

    fn like(self, value: f64) -> Self {
        Self::rounded(value)
    }

    fn min(self, other: impl Operand<Self>) -> Self {
        Self::single(self.settled().min(other.of(self).settled()))
    }

    fn max(self, other: impl Operand<Self>) -> Self {
        Self::single(self.settled().max(other.of(self).settled()))
    }

    fn clamp(self, low: impl Operand<Self>, high: impl Operand<Self>) -> Self {
        Real::min(Real::max(self, low), high)
    }

    fn abs(self) -> Self {
        Self(self.0.abs())
    }

    fn sqrt(self) -> Self {
        let x = self.settled();
        Self::off(f64::from(x).sqrt(), (x, 2.0), 4.5, 0.0)
    }

    fn exp(self) -> Self {
        let x = self.settled();
        // However coarse, no exponential is negative.
        Self::off(libm::exp(x.into()), (x, 0.0), 3.0 + 2.0 * f64::from(x.abs()), 0.0).max(Self::ZERO)
    }

    fn ln(self) -> Self {
        self.logarithm(libm::log, 1.0)
    }

    fn exp2(self) -> Self {
        let x = self.settled();
        Self::off(libm::exp2(x.into()), (x, 3.0), 3.0 + 2.0 * f64::from(x.abs()), 0.0).max(Self::ZERO)
    }

    fn log2(self) -> Self {
        self.logarithm(libm::log2, 4.0)
    }

    fn floor(self) -> Self {
        Self::single(self.settled().floor())
    }

    fn lt(self, other: impl Operand<Self>) -> bool {
        self < other.of(self)
    }

    fn le(self, other: impl Operand<Self>) -> bool {
        self <= other.of(self)
    }

    fn gt(self, other: impl Operand<Self>) -> bool {
        self > other.of(self)
    }

    fn ge(self, other: impl Operand<Self>) -> bool {
        self >= other.of(self)
    }

    fn eq(self, other: impl Operand<Self>) -> bool {
        self == other.of(self)
    }

    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }

    fn to_bits(self) -> u32 {
        self.settled().to_bits()
    }

    fn to_word(self) -> u32 {
        self.settled() as u32
    }
}

impl<const FUSED: bool, const ROUGH: bool, const FLUSHED: bool> Word<Device<FUSED, ROUGH, FLUSHED>> for u32 {
    fn like(self, value: u32) -> Self {
        value
    }

    fn min(self, other: Self) -> Self {
        Ord::min(self, other)
    }

    fn max(self, other: Self) -> Self {
        Ord::max(self, other)
    }

    fn lt(self, other: Self) -> bool {
        self < other
    }

    fn eq(self, other: Self) -> bool {
        self == other
    }

    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }

    fn to_real(self) -> Device<FUSED, ROUGH, FLUSHED> {
        Device::single(self as f32)
    }

    fn bits_to_real(self) -> Device<FUSED, ROUGH, FLUSHED> {
        Device::single(f32::from_bits(self))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::rng::stream;
    use rand::RngExt;

    type Plain = Device<false, false, false>;

    fn numbers(count: usize) -> Vec<f32> {
        let mut rng = stream(1, 701, 0);
        (0..count)
            .map(|_| {
                libm::pow(10.0, rng.random_range(-6.0..6.0)) as f32 * if rng.random::<bool>() { 1.0 } else { -1.0 }
            })
            .collect()
    }

    /// Without any of the three it is f32, bit for bit; functions are the correctly rounded ones.
    #[test]
    fn plain_is_single_precision() {
        for pair in numbers(40_000).chunks_exact(2) {
            let (a, b) = (pair[0], pair[1]);
            let (x, y) = (Plain::from_f32(a), Plain::from_f32(b));
            for (found, expected) in [
                (x + y, a + b),
                (x - y, a - b),
                (x * y, a * b),
                (x / y, a / b),
                (x.abs().sqrt(), a.abs().sqrt()),
            ] {
                assert_eq!(found.to_f64() as f32, expected, "{a} {b}");
            }
            assert_eq!((x < y, x.max(y).to_f64() as f32), (a < b, a.max(b)));
        }
    }

    /// a b + c as the standard library fuses it; and the control, that apart it is another number now and then.
    #[test]
    fn products_are_fused() {
        let mut differ = 0;
        for three in numbers(60_000).chunks_exact(3) {
            let (a, b, c) = (three[0], three[1], three[2] * 1e-3);
            let [x, y, z] = [a, b, c].map(Fused::from_f32);
            assert_eq!((x * y + z).to_f64() as f32, a.mul_add(b, c));
            assert_eq!((z - x * y).to_f64() as f32, (-a).mul_add(b, c));
            let mut sum = z;
            sum += x * y;
            assert_eq!(sum.to_f64() as f32, a.mul_add(b, c));
            // A product that is used by itself is rounded.
            assert_eq!(((x * y) * z).to_f64() as f32, (a * b) * c);
            differ += usize::from(a * b + c != a.mul_add(b, c));
        }
        assert!(differ > 1000);
    }

    /// Within what the language allows, and off by more than half of it now and then; the same number for the same
    /// operands.
    #[test]
    fn rough_functions_stay_within_their_allowance() {
        let mut farthest = [0.0f64; 3];
        for a in numbers(20_000) {
            let x = Rough::from_f32(a.abs());
            let (exact, found) = (libm::log(a.abs().into()), x.ln().to_f64());
            let allowed = if (0.5..=2.0).contains(&a.abs()) {
                libm::exp2(-21.0)
            } else {
                3.0 * ulp(exact)
            };
            farthest[0] = farthest[0].max((found - exact).abs() / (allowed + 0.5 * ulp(exact)));
            assert_eq!(found, x.ln().to_f64());
            if a.abs() < 80.0 {
                let (exact, found) = (libm::exp((-a.abs()).into()), (-x).exp().to_f64());
                farthest[1] = farthest[1].max((found - exact).abs() / ((3.5 + 2.0 * f64::from(a.abs())) * ulp(exact)));
            }
            let (exact, found) = (1.0 / f64::from(a.abs()), (Rough::ONE / x).to_f64());
            farthest[2] = farthest[2].max((found - exact).abs() / (3.0 * ulp(exact)));
        }
        assert!(farthest.iter().all(|f| (0.5..=1.0).contains(f)), "{farthest:?}");
    }

    #[test]
    fn subnormals_are_flushed() {
        let least = Flushed::from_f32(f32::MIN_POSITIVE);
        assert_eq!((least * Flushed::from_f32(0.5)).to_f64(), 0.0);
        assert_eq!(Flushed::from_f32(1e-40).to_f64(), 0.0);
        assert_eq!(least.to_f64() as f32, f32::MIN_POSITIVE);
        assert!((Plain::from_f32(f32::MIN_POSITIVE) * Plain::from_f32(0.5)).to_f64() > 0.0);
    }
}
