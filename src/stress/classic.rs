//! Moment-based transparency as a shader runs it: sums, reconstruction and exponential in one arithmetic.

use super::cases::Fragments;
use super::subject::{Arithmetic, Promise, Subject, each_pixel, to_digits};
use crate::moments::hamburger::{Bias, OVERESTIMATION, PowerCurve};
use crate::moments::trigonometric::{TrigonometricCurve, TrigonometricMoments, moment_bias};
use crate::numeric::Scalar;
use crate::oit;
use crate::pixel::{LogWarp, MomentDepth, Pixel, ViewZ, absorbance};

/// A classic method whose every operation is rounded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Classic {
    /// So many power moments: 4, 6 or 8.
    Power(usize),
    /// So many trigonometric moments: 2, 3 or 4.
    Trigonometric(usize),
}

impl Classic {
    /// All that there are.
    pub const ALL: [Self; 6] = [
        Self::Power(4),
        Self::Power(6),
        Self::Power(8),
        Self::Trigonometric(2),
        Self::Trigonometric(3),
        Self::Trigonometric(4),
    ];

    fn name(self) -> String {
        match self {
            Self::Power(m) => format!("moment-power-{m}"),
            Self::Trigonometric(m) => format!("moment-trig-{m}"),
        }
    }

    /// The method with all of its arithmetic in single precision, at the biases published for that.
    pub fn subject(self) -> Subject<'static> {
        let name = format!("{} @ {}", self.name(), Arithmetic::Shader.name());
        let double = oit::parse(&self.name()).expect("the name of a method");
        Subject::new(name, Promise::None, move |f| Ok(self.answers::<f32>(f))).with_method_as_double(double)
    }

    /// Four power moments kept with so many significant binary digits, rounded after every addition, at both published
    /// biases; everything else is in double precision.
    pub fn power_with_digits(digits: u32) -> [Subject<'static>; 2] {
        [
            ("moment-power-4, bias of f32", Bias::single_precision(4)),
            ("moment-power-4, bias of 16 bits", Bias::sixteen_bits(4)),
        ]
        .map(|(name, bias)| {
            Subject::new(name, Promise::None, move |f| {
                let (v0, v1) = f.context.depth_range.unwrap_or((1.0, 1.0));
                let warp = LogWarp::new(ViewZ(v0.into()), ViewZ(v1.into())).map_err(|e| e.to_string())?;
                let z = |v: f32| warp.moment(ViewZ(v.into()));
                Ok(each_pixel(f, |pixel, out| {
                    let mut b = [0.0f64; 5];
                    for (&v, &alpha) in pixel.view_z.iter().zip(pixel.alpha) {
                        let mut term = absorbance(alpha);
                        for b in &mut b {
                            *b = to_digits(*b + term, digits);
                            term *= z(v).0;
                        }
                    }
                    if b[0] == 0.0 {
                        return out.fill(1.0);
                    }
                    let curve = PowerCurve::<f64, 2>::new(&b, &bias);
                    for (out, &v) in out.iter_mut().zip(pixel.view_z) {
                        *out = curve.transmittance(z(v), OVERESTIMATION);
                    }
                }))
            })
        })
    }

    fn answers<R: Scalar>(self, fragments: &Fragments) -> Vec<f64> {
        let (v0, v1) = fragments.context.depth_range.unwrap_or((1.0, 1.0));
        let warp = LogWarp::new(ViewZ(v0.into()), ViewZ(v1.into()));
        let z =
            |v: f32| MomentDepth(R::from_f64(warp.as_ref().map_or(f64::NAN, |w| w.moment(ViewZ(v.into())).0)).to_f64());
        each_pixel(fragments, |pixel, out| match self {
            Self::Power(4) => power::<R, 2, 5>(pixel, z, out),
            Self::Power(6) => power::<R, 3, 7>(pixel, z, out),
            Self::Power(_) => power::<R, 4, 9>(pixel, z, out),
            Self::Trigonometric(2) => trigonometric::<R, 2>(pixel, z, out),
            Self::Trigonometric(3) => trigonometric::<R, 3>(pixel, z, out),
            Self::Trigonometric(_) => trigonometric::<R, 4>(pixel, z, out),
        })
    }
}

/// Power moments b_0..b_2N of a pixel in arithmetic R.
pub(super) fn power_sums<R: Scalar, const M: usize>(pixel: Pixel<'_>, z: impl Fn(f32) -> MomentDepth) -> [R; M] {
    let mut b = [R::ZERO; M];
    for (&v, &alpha) in pixel.view_z.iter().zip(pixel.alpha) {
        let (z, mut term) = (R::from_f64(z(v).0), R::from_f64(absorbance(alpha)));
        for b in &mut b {
            *b += term;
            term *= z;
        }
    }
    b
}

fn power<R: Scalar, const N: usize, const M: usize>(pixel: Pixel<'_>, z: impl Fn(f32) -> MomentDepth, out: &mut [f64]) {
    let b: [R; M] = power_sums(pixel, &z);
    if b[0] == R::ZERO {
        return out.fill(1.0);
    }
    let curve = PowerCurve::<R, N>::new(&b, &Bias::single_precision(2 * N));
    for (out, &v) in out.iter_mut().zip(pixel.view_z) {
        *out = curve.transmittance(z(v), OVERESTIMATION).to_f64();
    }
}

fn trigonometric<R: Scalar, const N: usize>(pixel: Pixel<'_>, z: impl Fn(f32) -> MomentDepth, out: &mut [f64]) {
    let mut b = TrigonometricMoments::<R, N>::ZERO;
    for (&v, &alpha) in pixel.view_z.iter().zip(pixel.alpha) {
        b.add(z(v), R::from_f64(absorbance(alpha)));
    }
    if b.total == R::ZERO {
        return out.fill(1.0);
    }
    let curve = TrigonometricCurve::<R, N>::new(&b, moment_bias(N, false));
    for (out, &v) in out.iter_mut().zip(pixel.view_z) {
        *out = curve.transmittance(z(v), OVERESTIMATION).to_f64();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stress::{Case, Errors};

    /// In double precision it is the method of the same name. Tolerance: 1e-9, for nothing but the order of operations
    /// differs. Control: in single precision it is not.
    #[test]
    fn double_precision_is_the_method_itself() {
        let case = Case::all().into_iter().find(|c| c.name == "usual").unwrap();
        for classic in Classic::ALL {
            let method = Subject::method(oit::parse(&classic.name()).unwrap(), None)
                .answers(&case.fragments)
                .unwrap();
            let off = |a: &[f64]| Errors::of(a, &method).unwrap().worst;
            assert!(
                off(&classic.answers::<f64>(&case.fragments)) <= 1e-9
                    && off(&classic.answers::<f32>(&case.fragments)) > 1e-9,
                "{classic:?}"
            );
        }
    }
}
