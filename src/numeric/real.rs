//! One formula, every kind of arithmetic: what a formula that is written once may do with numbers.
//!
//! A function that is generic over [`Real`] runs in every kind of arithmetic that the program knows:
//!
//! | kind | what it is for |
//! |---|---|
//! | `f32`, `f64` | reference code, pixel by pixel |
//! | `f32x16<S>` | kernels, sixteen fragments at once |
//! | `Device` of the stress suite | single precision with everything that shading languages allow beside IEEE 754 |
//! | [`Expression`](super::source::Expression) | no numbers at all: it writes the formula as shader source |
//!
//! # How a formula is written
//!
//! ```
//! use nmt::numeric::real::{Real, c};
//!
//! /// ln(a/b), accurate where a is near b too.
//! #[inline(always)]
//! fn log_ratio<R: Real>(a: R, b: R) -> R {
//!     R::step("log_ratio", "ln(a / b), accurate where a is near b too.", [("a", a), ("b", b)], |[a, b]| {
//!         let s = ((a - b) / (a + b)).named("s");
//!         let q = (s * s).named("q");
//!         let near = (s + s) * (c(1.0) + q * (c(0.33333334) + q * (c(0.2) + q * c(0.14285715))));
//!         R::select(s.abs().lt(c(0.2)), near, (a / b).ln())
//!     })
//! }
//!
//! assert!((log_ratio(1.001, 1.0) - 0.000_999_500_3).abs() < 1e-9f64);
//! ```
//!
//! - Constants are [`c`]`(0.5)`, on either side of an operator; where a number of the kind itself is needed,
//!   `x.like(0.5)`.
//! - There is no `if`: a comparison gives a mask, and [`Real::select`] takes one of two values that are both computed.
//!   Neither may trap, and what is not taken may be NaN or infinite.
//! - [`Real::named`] gives a value the name that it has in shader source. A value that is used more than once needs a
//!   name, or its text is written again at each use. On numbers it does nothing.
//! - [`Real::note`] puts a comment in front of the next statement of the source.
//! - [`Real::step`] makes a part of a derivation a function of its own in shader source, defined once; on numbers it is
//!   the closure that it holds. [`Real::step_array`] is the same for parts that take or give several numbers.
//! - Words of 32 bits, for packed codes, are [`Real::Word`]: `x.to_bits()`, `word.bits_to_real()`, `word >> 12`,
//!   `word & 0xfff`.
//! - Every such function is `#[inline(always)]`, so that it is compiled for the SIMD level of its caller.
//!
//! Multiplication and addition stay apart in every kind but where a device fuses them, and are done in the order in
//! which they are written.

use super::lanes;
use fearless_simd::prelude::*;
use fearless_simd::{f32x16, mask32x16, u32x16};
use std::ops::{Add, AddAssign, BitAnd, BitOr, BitXor, Div, Mul, MulAssign, Neg, Not, Shl, Shr, Sub, SubAssign};

/// A constant of a formula, rounded to the kind of the number that it meets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constant(pub f64);

/// A constant of a formula.
#[inline(always)]
pub const fn c(value: f64) -> Constant {
    Constant(value)
}

/// What may stand beside a number of kind R as an argument: another one, or a constant.
pub trait Operand<R>: Copy {
    /// As a number of the kind of `like`.
    fn of(self, like: R) -> R;
}

impl<R: Real> Operand<R> for R {
    #[inline(always)]
    fn of(self, _: R) -> R {
        self
    }
}

impl<R: Real> Operand<R> for Constant {
    #[inline(always)]
    fn of(self, like: R) -> R {
        like.like(self.0)
    }
}

/// The outcome of a comparison: one truth value, one a lane, or an expression.
pub trait Mask: Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {}

impl Mask for bool {}
impl<S: Simd> Mask for mask32x16<S> {}

/// Words of 32 bits beside numbers of kind R. Sums and products must fit into a word.
pub trait Word<R: Real>:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + BitAnd<Output = Self>
    + BitOr<Output = Self>
    + BitXor<Output = Self>
    + Add<u32, Output = Self>
    + Sub<u32, Output = Self>
    + Mul<u32, Output = Self>
    + BitAnd<u32, Output = Self>
    + BitOr<u32, Output = Self>
    + BitXor<u32, Output = Self>
    + Shl<u32, Output = Self>
    + Shr<u32, Output = Self>
{
    /// A constant of the same kind.
    fn like(self, value: u32) -> Self;
    /// The lesser of two.
    fn min(self, other: Self) -> Self;
    /// The greater of two.
    fn max(self, other: Self) -> Self;
    /// self < other
    fn lt(self, other: Self) -> R::Mask;
    /// self = other
    fn eq(self, other: Self) -> R::Mask;
    /// `yes` where the mask is set, else `no`.
    fn select(mask: R::Mask, yes: Self, no: Self) -> Self;
    /// The number that the word counts.
    fn to_real(self) -> R;
    /// The single-precision number that has these bits.
    fn bits_to_real(self) -> R;
    /// The same word under the name that it has in shader source.
    #[inline(always)]
    fn named(self, _name: &str) -> Self {
        self
    }
    /// The same word; shader source gets a comment before its next statement.
    #[inline(always)]
    fn note(self, _text: &str) -> Self {
        self
    }
}

/// A number of any kind of arithmetic; see the [module](self).
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<Constant, Output = Self>
    + Sub<Constant, Output = Self>
    + Mul<Constant, Output = Self>
    + Div<Constant, Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
{
    /// What comparisons give.
    type Mask: Mask;
    /// Words of 32 bits beside it.
    type Word: Word<Self>;

    /// Distance from 1 to the next greater number.
    const ROUNDING: f64;

    /// A constant of the same kind.
    fn like(self, value: f64) -> Self;
    /// The lesser of two numbers; either where one is NaN.
    fn min(self, other: impl Operand<Self>) -> Self;
    /// The greater of two numbers; either where one is NaN.
    fn max(self, other: impl Operand<Self>) -> Self;
    /// The lesser of two numbers; on the CPU the other where one is NaN.
    #[inline(always)]
    fn min_number(self, other: impl Operand<Self>) -> Self {
        self.min(other)
    }
    /// Within [low, high]; on the CPU NaN becomes the lower end.
    fn clamp(self, low: impl Operand<Self>, high: impl Operand<Self>) -> Self;
    /// |self|
    fn abs(self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// e^self
    fn exp(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// 2^self
    fn exp2(self) -> Self;
    /// Logarithm to base 2.
    fn log2(self) -> Self;
    /// The greatest whole number that is not above.
    fn floor(self) -> Self;

    /// self < other
    fn lt(self, other: impl Operand<Self>) -> Self::Mask;
    /// self ≤ other
    fn le(self, other: impl Operand<Self>) -> Self::Mask;
    /// self > other
    fn gt(self, other: impl Operand<Self>) -> Self::Mask;
    /// self ≥ other
    fn ge(self, other: impl Operand<Self>) -> Self::Mask;
    /// self = other
    fn eq(self, other: impl Operand<Self>) -> Self::Mask;
    /// self ≠ other
    #[inline(always)]
    fn ne(self, other: impl Operand<Self>) -> Self::Mask {
        !self.eq(other)
    }
    /// `yes` where the mask is set, else `no`.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// The bits of the single-precision number.
    fn to_bits(self) -> Self::Word;
    /// The whole number below a number from 0 to 2^32 − 1; anything, never a trap, for others.
    fn to_word(self) -> Self::Word;

    /// self/divisor, by whichever of the two ways is the usual one of the kind; see [`Divisor`].
    #[inline(always)]
    fn over(self, divisor: Divisor<Self>) -> Self {
        self * divisor.reciprocal
    }

    /// The same number under the name that it has in shader source.
    #[inline(always)]
    fn named(self, _name: &str) -> Self {
        self
    }

    /// [`Self::named`] after a letter and a number, as items of an array are.
    #[inline(always)]
    fn named_at(self, _stem: &str, _index: usize) -> Self {
        self
    }

    /// The same number; shader source gets a comment before its next statement.
    #[inline(always)]
    fn note(self, _text: &str) -> Self {
        self
    }

    /// A step of a derivation, which in shader source is a function of its own.
    ///
    /// `name` is the function's name without the prefix of its source, `about` the comment before it.
    /// A body that lanes go through is a closure with `#[inline(always)]`: otherwise it hands them on in memory, which
    /// once cost `predict` a fifth of its time.
    #[inline(always)]
    fn step<const N: usize>(
        _name: &str,
        _about: &str,
        parameters: [(&str, Self); N],
        body: impl FnOnce([Self; N]) -> Self,
    ) -> Self {
        body(lanes::array(|i| parameters[i].1))
    }

    /// [`Self::step`] with an array behind the other parameters, and an array as the result, by the name that it has in
    /// its caller; N and K may be 0.
    #[inline(always)]
    fn step_array<const N: usize, const K: usize, const M: usize>(
        _name: &str,
        _about: &str,
        parameters: [(&str, Self); N],
        array: (&str, [Self; K]),
        _result: &str,
        body: impl FnOnce([Self; N], [Self; K]) -> [Self; M],
    ) -> [Self; M] {
        body(lanes::array(|i| parameters[i].1), array.1)
    }
}

/// A number that others are divided by again and again: scalar code on the CPU divides, which rounds once; lanes and
/// shaders multiply by its reciprocal.
#[derive(Debug, Clone, Copy)]
pub struct Divisor<R> {
    /// The number.
    pub value: R,
    /// Its reciprocal.
    pub reciprocal: R,
}

impl<R: Real> Divisor<R> {
    /// Of a number other than 0.
    #[inline(always)]
    pub fn new(value: R) -> Self {
        Self {
            value,
            reciprocal: c(1.0) / value,
        }
    }

    /// The same under the name that the reciprocal has in shader source.
    #[inline(always)]
    pub fn named(self, name: &str) -> Self {
        Self {
            reciprocal: self.reciprocal.named(name),
            ..self
        }
    }
}

/// x²
#[inline(always)]
pub fn square<R: Real>(x: R) -> R {
    x * x
}

/// c(1.0) − x and its like.
macro_rules! constant_on_the_left {
    ($($op:ident $f:ident),*) => {$(
        impl<R: Real> $op<R> for Constant {
            type Output = R;
            #[inline(always)]
            fn $f(self, x: R) -> R {
                $op::$f(x.like(self.0), x)
            }
        }
    )*};
}

constant_on_the_left!(Add add, Sub sub, Mul mul, Div div);

/// x − c(1.0) and its like, for a kind of number.
macro_rules! constant_on_the_right {
    ([$($generics:tt)*] $t:ty) => {
        $crate::numeric::real::constant_on_the_right!(@ [$($generics)*] $t, Add add, Sub sub, Mul mul, Div div);
    };
    (@ [$($generics:tt)*] $t:ty, Add add, $($rest:tt)*) => {
        $crate::numeric::real::constant_on_the_right!(# [$($generics)*] $t, Add, add);
        $crate::numeric::real::constant_on_the_right!(@ [$($generics)*] $t, $($rest)*);
    };
    (@ [$($generics:tt)*] $t:ty, Sub sub, $($rest:tt)*) => {
        $crate::numeric::real::constant_on_the_right!(# [$($generics)*] $t, Sub, sub);
        $crate::numeric::real::constant_on_the_right!(@ [$($generics)*] $t, $($rest)*);
    };
    (@ [$($generics:tt)*] $t:ty, Mul mul, Div div) => {
        $crate::numeric::real::constant_on_the_right!(# [$($generics)*] $t, Mul, mul);
        $crate::numeric::real::constant_on_the_right!(# [$($generics)*] $t, Div, div);
    };
    (# [$($generics:tt)*] $t:ty, $op:ident, $f:ident) => {
        impl<$($generics)*> std::ops::$op<$crate::numeric::real::Constant> for $t {
            type Output = Self;
            #[inline(always)]
            fn $f(self, constant: $crate::numeric::real::Constant) -> Self {
                let constant = $crate::numeric::real::Real::like(self, constant.0);
                std::ops::$op::$f(self, constant)
            }
        }
    };
}
pub(crate) use constant_on_the_right;

constant_on_the_right!([] f32);
constant_on_the_right!([] f64);
constant_on_the_right!([S: Simd] f32x16<S>);

macro_rules! scalar {
    ($t:ty, $exp:path, $ln:path, $exp2:path, $log2:path) => {
        impl Real for $t {
            type Mask = bool;
            type Word = u32;
            const ROUNDING: f64 = <$t>::EPSILON as f64;

            #[inline(always)]
            fn like(self, value: f64) -> Self {
                value as $t
            }
            // Where self is NaN these give the other.
            #[inline(always)]
            fn min(self, other: impl Operand<Self>) -> Self {
                <$t>::min(self, other.of(self))
            }
            #[inline(always)]
            fn max(self, other: impl Operand<Self>) -> Self {
                <$t>::max(self, other.of(self))
            }
            #[inline(always)]
            fn clamp(self, low: impl Operand<Self>, high: impl Operand<Self>) -> Self {
                <$t>::min(<$t>::max(self, low.of(self)), high.of(self))
            }
            #[inline(always)]
            fn abs(self) -> Self {
                <$t>::abs(self)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                // IEEE 754 rounds square roots correctly: the platform's is the same everywhere.
                <$t>::sqrt(self)
            }
            #[inline(always)]
            fn exp(self) -> Self {
                $exp(self)
            }
            #[inline(always)]
            fn ln(self) -> Self {
                $ln(self)
            }
            #[inline(always)]
            fn exp2(self) -> Self {
                $exp2(self)
            }
            #[inline(always)]
            fn log2(self) -> Self {
                $log2(self)
            }
            #[inline(always)]
            fn floor(self) -> Self {
                <$t>::floor(self)
            }
            #[inline(always)]
            fn lt(self, other: impl Operand<Self>) -> bool {
                self < other.of(self)
            }
            #[inline(always)]
            fn le(self, other: impl Operand<Self>) -> bool {
                self <= other.of(self)
            }
            #[inline(always)]
            fn gt(self, other: impl Operand<Self>) -> bool {
                self > other.of(self)
            }
            #[inline(always)]
            fn ge(self, other: impl Operand<Self>) -> bool {
                self >= other.of(self)
            }
            #[inline(always)]
            fn eq(self, other: impl Operand<Self>) -> bool {
                self == other.of(self)
            }
            #[inline(always)]
            fn select(mask: bool, yes: Self, no: Self) -> Self {
                if mask { yes } else { no }
            }
            #[inline(always)]
            fn to_bits(self) -> u32 {
                (self as f32).to_bits()
            }
            #[inline(always)]
            fn to_word(self) -> u32 {
                self as u32
            }
            #[inline(always)]
            fn over(self, divisor: Divisor<Self>) -> Self {
                self / divisor.value
            }
        }

        impl Word<$t> for u32 {
            #[inline(always)]
            fn like(self, value: u32) -> Self {
                value
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                Ord::min(self, other)
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                Ord::max(self, other)
            }
            #[inline(always)]
            fn lt(self, other: Self) -> bool {
                self < other
            }
            #[inline(always)]
            fn eq(self, other: Self) -> bool {
                self == other
            }
            #[inline(always)]
            fn select(mask: bool, yes: Self, no: Self) -> Self {
                if mask { yes } else { no }
            }
            #[inline(always)]
            fn to_real(self) -> $t {
                self as $t
            }
            #[inline(always)]
            fn bits_to_real(self) -> $t {
                f32::from_bits(self) as $t
            }
        }
    };
}

scalar!(f32, libm::expf, libm::logf, libm::exp2f, libm::log2f);
scalar!(f64, libm::exp, libm::log, libm::exp2, libm::log2);

/// Sixteen numbers in f32. Functions have the domains and accuracy of [`lanes`]: a logarithm of what is not a normal
/// positive number is garbage.
impl<S: Simd> Real for f32x16<S> {
    type Mask = mask32x16<S>;
    type Word = u32x16<S>;
    const ROUNDING: f64 = f32::EPSILON as f64;

    #[inline(always)]
    fn like(self, value: f64) -> Self {
        Self::splat(self.simd, value as f32)
    }
    #[inline(always)]
    fn min(self, other: impl Operand<Self>) -> Self {
        SimdBase::min(self, other.of(self))
    }
    #[inline(always)]
    fn max(self, other: impl Operand<Self>) -> Self {
        SimdBase::max(self, other.of(self))
    }
    #[inline(always)]
    fn min_number(self, other: impl Operand<Self>) -> Self {
        SimdBase::min_precise(self, other.of(self))
    }
    #[inline(always)]
    fn clamp(self, low: impl Operand<Self>, high: impl Operand<Self>) -> Self {
        SimdBase::min(SimdBase::max_precise(self, low.of(self)), high.of(self))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        SimdBase::abs(self)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        SimdFloat::sqrt(self)
    }
    #[inline(always)]
    fn exp(self) -> Self {
        lanes::exp(self.simd, self)
    }
    #[inline(always)]
    fn ln(self) -> Self {
        lanes::ln(self.simd, self)
    }
    #[inline(always)]
    fn exp2(self) -> Self {
        lanes::exp(self.simd, self * c(std::f64::consts::LN_2))
    }
    #[inline(always)]
    fn log2(self) -> Self {
        lanes::ln(self.simd, self) * c(std::f64::consts::LOG2_E)
    }
    #[inline(always)]
    fn floor(self) -> Self {
        SimdFloat::floor(self)
    }
    #[inline(always)]
    fn lt(self, other: impl Operand<Self>) -> Self::Mask {
        self.simd_lt(other.of(self))
    }
    #[inline(always)]
    fn le(self, other: impl Operand<Self>) -> Self::Mask {
        self.simd_le(other.of(self))
    }
    #[inline(always)]
    fn gt(self, other: impl Operand<Self>) -> Self::Mask {
        self.simd_gt(other.of(self))
    }
    #[inline(always)]
    fn ge(self, other: impl Operand<Self>) -> Self::Mask {
        self.simd_ge(other.of(self))
    }
    #[inline(always)]
    fn eq(self, other: impl Operand<Self>) -> Self::Mask {
        self.simd_eq(other.of(self))
    }
    #[inline(always)]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self {
        Select::select(mask, yes, no)
    }
    #[inline(always)]
    fn to_bits(self) -> Self::Word {
        self.bitcast()
    }
    #[inline(always)]
    fn to_word(self) -> Self::Word {
        self.to_int()
    }
}

impl<S: Simd> Word<f32x16<S>> for u32x16<S> {
    #[inline(always)]
    fn like(self, value: u32) -> Self {
        Self::splat(self.simd, value)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        SimdBase::min(self, other)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        SimdBase::max(self, other)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> mask32x16<S> {
        self.simd_lt(other)
    }
    #[inline(always)]
    fn eq(self, other: Self) -> mask32x16<S> {
        self.simd_eq(other)
    }
    #[inline(always)]
    fn select(mask: mask32x16<S>, yes: Self, no: Self) -> Self {
        Select::select(mask, yes, no)
    }
    #[inline(always)]
    fn to_real(self) -> f32x16<S> {
        self.to_float()
    }
    #[inline(always)]
    fn bits_to_real(self) -> f32x16<S> {
        self.bitcast()
    }
}
