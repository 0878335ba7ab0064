//! Complex numbers over either precision.

use super::Scalar;
use std::ops::{Add, Mul, Sub};

/// re + i·im.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Complex<R> {
    /// Scalar part.
    pub re: R,
    /// Imaginary part.
    pub im: R,
}

impl<R: Scalar> Complex<R> {
    /// 0.
    pub const ZERO: Self = Self {
        re: R::ZERO,
        im: R::ZERO,
    };
    /// 1.
    pub const ONE: Self = Self {
        re: R::ONE,
        im: R::ZERO,
    };

    /// re + i·im.
    pub fn new(re: R, im: R) -> Self {
        Self { re, im }
    }

    /// re − i·im.
    pub fn conj(self) -> Self {
        Self {
            re: self.re,
            im: -self.im,
        }
    }

    /// re² + im².
    pub fn norm_squared(self) -> R {
        self.re * self.re + self.im * self.im
    }

    /// A real multiple.
    pub fn scale(self, factor: R) -> Self {
        Self {
            re: self.re * factor,
            im: self.im * factor,
        }
    }
}

impl<R: Scalar> Add for Complex<R> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            re: self.re + other.re,
            im: self.im + other.im,
        }
    }
}

impl<R: Scalar> Sub for Complex<R> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self {
            re: self.re - other.re,
            im: self.im - other.im,
        }
    }
}

impl<R: Scalar> Mul for Complex<R> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self {
            re: self.re * other.re - self.im * other.im,
            im: self.re * other.im + self.im * other.re,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arithmetic() {
        let (a, b) = (Complex::new(1.0, 2.0), Complex::new(3.0, -1.0));
        assert_eq!(a * b, Complex::new(5.0, 5.0));
        assert_eq!(a * a.conj(), Complex::new(a.norm_squared(), 0.0));
        assert_eq!(a + b - b.scale(1.0), a);
        assert_ne!(a * b, a * b.conj());
    }
}
