//! Laws of single numbers, and arithmetic on many of them at once.

use crate::numeric::doubles::{self, DOUBLES};
use crate::numeric::rng::Stream;
use crate::synth::config::Range;
use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, f64x8};
use std::f64::consts::TAU;

/// What fills a last vector up: in the domain of all that is computed here, and no special case of it.
pub(super) const FILLER: f64 = 0.125;

/// A whole number below n of a random word, uniform but for a bias below n/2^32.
#[inline]
pub(super) fn below(word: u32, n: usize) -> usize {
    ((u64::from(word) * n as u64) >> 32) as usize
}

/// Replaces all numbers by what becomes of them, eight at a time.
macro_rules! each {
    ($values:expr, $simd:ident, $x:ident => $becomes:expr) => {
        fearless_simd::dispatch!(fearless_simd::Level::new(), $simd =>
            crate::synth::law::numbers::map($simd, $values, #[inline(always)] |$x| $becomes))
    };
}
pub(super) use each;

/// [`each`] with the instructions of one level.
#[inline(always)]
pub(super) fn map<S: Simd>(simd: S, values: &mut [f64], becomes: impl Fn(f64x8<S>) -> f64x8<S>) {
    let (whole, rest) = values.as_chunks_mut::<DOUBLES>();
    for x in whole {
        becomes(f64x8::from_slice(simd, x)).store_slice(x);
    }
    if !rest.is_empty() {
        let mut x = [FILLER; DOUBLES];
        x[..rest.len()].copy_from_slice(rest);
        becomes(f64x8::from_slice(simd, &x)).store_slice(&mut x);
        rest.copy_from_slice(&x[..rest.len()]);
    }
}

/// A law of one number.
pub(super) trait NumberLaw {
    /// A number.
    fn draw(&self, rng: &mut Stream) -> f64;

    /// [`Self::draw`] of all these units.
    fn of_units(&self, units: &mut [f64]);
}

/// The uniform law: low + scale u.
#[derive(Debug, Clone, Copy)]
pub(super) struct UniformInclusive {
    low: f64,
    scale: f64,
}

impl UniformInclusive {
    /// On [min, max], both ends included: the greatest u, 1 − 2^−52, gives max.
    pub(super) fn new(Range { min, max }: Range) -> Self {
        let greatest = 1.0 - f64::EPSILON;
        let mut scale = (max - min) / greatest;
        while scale * greatest + min > max {
            scale = scale.next_down();
        }
        Self { low: min, scale }
    }

    #[inline]
    pub(super) fn at(&self, u: f64) -> f64 {
        u * self.scale + self.low
    }
}

impl NumberLaw for UniformInclusive {
    #[inline]
    fn draw(&self, rng: &mut Stream) -> f64 {
        self.at(rng.unit())
    }

    #[inline]
    fn of_units(&self, units: &mut [f64]) {
        units.iter_mut().for_each(|u| *u = self.at(*u));
    }
}

/// A uniform law that never leaves [min, max], whatever rounding does: min + (max − min) u.
#[derive(Debug, Clone, Copy)]
pub(super) struct UniformLerp(pub Range);

impl UniformLerp {
    #[inline]
    pub(super) fn at(&self, u: f64) -> f64 {
        let Range { min, max } = self.0;
        (min + (max - min) * u).min(max)
    }

    #[inline]
    pub(super) fn draw(&self, rng: &mut Stream) -> f64 {
        self.at(rng.unit())
    }
}

/// The log-uniform law on [min, max]: every octave is as likely as any other.
#[derive(Debug, Clone, Copy)]
pub(super) struct LogUniform {
    range: Range,
    ln_min: f64,
    ln_ratio: f64,
}

impl LogUniform {
    pub(super) fn new(range: Range) -> Self {
        let ln_min = libm::log(range.min);
        Self {
            range,
            ln_min,
            ln_ratio: libm::log(range.max) - ln_min,
        }
    }
}

impl NumberLaw for LogUniform {
    #[inline]
    fn draw(&self, rng: &mut Stream) -> f64 {
        libm::exp(self.ln_min + self.ln_ratio * rng.unit()).clamp(self.range.min, self.range.max)
    }

    fn of_units(&self, units: &mut [f64]) {
        let Self {
            range,
            ln_min,
            ln_ratio,
        } = *self;
        each!(units, simd, u => {
            let splat = |x: f64| f64x8::splat(simd, x);
            doubles::exp(simd, splat(ln_min) + splat(ln_ratio) * u).max(splat(range.min)).min(splat(range.max))
        });
    }
}

/// The two standard normal numbers of each pair of units, in the places of those.
///
/// # Source
/// Box and Muller, *A note on the generation of random normal deviates*, 1958.
pub(super) fn normals(radii: &mut [f64], angles: &mut [f64]) {
    #[inline(always)]
    fn all<S: Simd>(simd: S, radii: &mut [f64], angles: &mut [f64]) {
        let splat = |x: f64| f64x8::splat(simd, x);
        for (u, v) in radii
            .as_chunks_mut::<DOUBLES>()
            .0
            .iter_mut()
            .zip(angles.as_chunks_mut::<DOUBLES>().0)
        {
            // 1 − u is never 0.
            let r = (splat(-2.0) * doubles::ln(simd, splat(1.0) - f64x8::from_slice(simd, u))).sqrt();
            let (sin, cos) = doubles::sincos(simd, splat(TAU) * f64x8::from_slice(simd, v));
            (r * cos).store_slice(u);
            (r * sin).store_slice(v);
        }
    }
    assert!(
        radii.len() == angles.len() && radii.len().is_multiple_of(DOUBLES),
        "whole vectors"
    );
    dispatch!(Level::new(), simd => all(simd, radii, angles));
}

/// So many units in the place of what is there.
pub(super) fn fill(rng: &mut Stream, n: usize, units: &mut Vec<f64>) {
    units.resize(n, 0.0);
    rng.units(units);
}

#[cfg(test)]
mod tests {
    use super::super::testing::{draws, has_mean, range, rng};
    use super::*;
    use rand::Rng;
    use rand_distr::{Distribution, Uniform};

    #[test]
    fn the_basic_laws() {
        let u = draws(Stream::unit);
        assert!(u.iter().all(|u| (0.0..1.0).contains(u)));
        assert!(has_mean(&u, |u| u, 0.5) && has_mean(&u, |u| u * u, 1.0 / 3.0));
        // Control: the tolerance is narrower than a hundredth.
        assert!(!has_mean(&u, |u| u, 0.51));
        let k = draws(|rng| below(rng.next_u32(), 5) as f64);
        assert!((0..5).all(|i| has_mean(&k, |k| f64::from(u8::from(k == f64::from(i))), 0.2)));
        let log = draws(|rng| LogUniform::new(range(1e-3, 10.0)).draw(rng));
        assert!(log.iter().all(|x| (1e-3..=10.0).contains(x)));
        assert!(has_mean(&log, f64::log10, -1.0) && has_mean(&log, |x| x, (10.0 - 1e-3) / 1e4f64.ln()));
    }

    /// Laws of many units at once are those of one after the other. Control: another law's.
    #[test]
    fn many_units_are_drawn_as_one_is() {
        fn check(law: &impl NumberLaw, other: &impl NumberLaw) {
            let (mut many, mut one, mut units) = (rng(), rng(), Vec::new());
            fill(&mut many, 101, &mut units);
            let mut of_other = units.clone();
            law.of_units(&mut units);
            other.of_units(&mut of_other);
            let expected: Vec<f64> = (0..101).map(|_| law.draw(&mut one)).collect();
            assert_eq!(units, expected);
            assert_ne!(of_other, expected);
        }
        let (uniform, log) = (UniformInclusive::new(range(0.1, 0.5)), LogUniform::new(range(0.1, 0.5)));
        check(&uniform, &log);
        check(&log, &uniform);
    }

    /// The uniform law is that of `rand`, to the bit.
    #[test]
    fn the_uniform_law_is_rands() {
        for (min, max) in [
            (0.0, 1.0),
            (0.3, 1.0),
            (0.1, 0.5),
            (0.02, 0.95),
            (0.25, 0.25),
            (0.0, 0.0),
            (1.0 / 3.0, 0.7),
        ] {
            let (ours, theirs) = (
                UniformInclusive::new(range(min, max)),
                Uniform::new_inclusive(min, max).unwrap(),
            );
            let (mut a, mut b) = (rng(), rng());
            for _ in 0..1000 {
                let x = ours.draw(&mut a);
                assert!(x == theirs.sample(&mut b) && (min..=max).contains(&x));
            }
            assert_eq!(ours.at(0.0), min);
        }
    }
}
