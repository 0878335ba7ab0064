//! The gamma law, drawn from units of which the logarithms are computed ahead.

use super::numbers::{FILLER, each};
use crate::numeric::doubles::{self, DOUBLES};
use crate::numeric::rng::{Stream, unit};
use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, f64x8};
use std::f64::consts::TAU;

/// Units to come, each with its logarithm and with the sine and cosine of its share of a turn: which of them will serve
/// for what is not known beforehand, as draws that are rejected shift all that follow.
#[derive(Default)]
pub(super) struct Ahead {
    units: Vec<f64>,
    /// ln(1 − u)
    ln: Vec<f64>,
    sin: Vec<f64>,
    cos: Vec<f64>,
    /// The next of them.
    at: usize,
    /// The second normal number of a pair.
    spare: Option<f64>,
}

impl Ahead {
    /// Units that are at hand after [`Self::provide`].
    const LEAST: usize = 4;

    /// Makes four units at least, and about as many as are wanted.
    #[inline]
    fn provide(&mut self, rng: &mut Stream, wanted: usize) {
        if self.units.len() - self.at < Self::LEAST {
            self.refill(rng, wanted);
        }
    }

    #[inline(never)]
    fn refill(&mut self, rng: &mut Stream, wanted: usize) {
        #[inline(always)]
        fn all<S: Simd>(
            simd: S,
            Ahead {
                units, ln, sin, cos, ..
            }: &mut Ahead,
        ) {
            let splat = |x: f64| f64x8::splat(simd, x);
            for out in [&mut *ln, sin, cos] {
                out.resize(units.len(), 0.0);
            }
            let outputs = ln
                .as_chunks_mut::<DOUBLES>()
                .0
                .iter_mut()
                .zip(sin.as_chunks_mut::<DOUBLES>().0)
                .zip(cos.as_chunks_mut::<DOUBLES>().0);
            for (u, ((ln, sin), cos)) in units.as_chunks::<DOUBLES>().0.iter().zip(outputs) {
                let u = f64x8::from_slice(simd, u);
                doubles::ln(simd, splat(1.0) - u).store_slice(ln);
                let (s, c) = doubles::sincos(simd, splat(TAU) * u);
                s.store_slice(sin);
                c.store_slice(cos);
            }
        }
        self.settle(rng);
        let words = rng.words().as_chunks().0;
        let words = &words[..words.len().min(wanted.max(Self::LEAST).next_multiple_of(DOUBLES))];
        self.units.extend(words.iter().map(|&pair| unit(pair)));
        let count = self.units.len();
        self.units.resize(count.next_multiple_of(DOUBLES), FILLER);
        dispatch!(Level::new(), simd => all(simd, self));
        self.units.truncate(count);
    }

    /// Uses up the units that were taken, and forgets all others and the second number of a pair: the end of a pixel.
    pub(super) fn end(&mut self, rng: &mut Stream) {
        self.settle(rng);
        self.spare = None;
    }

    /// Uses up the units that were taken, and forgets the others.
    fn settle(&mut self, rng: &mut Stream) {
        rng.skip(2 * self.at);
        self.at = 0;
        self.units.clear();
    }

    /// A standard normal number; takes two units, or none.
    #[inline]
    fn normal(&mut self) -> f64 {
        if let Some(x) = self.spare.take() {
            return x;
        }
        let r = (-2.0 * self.ln[self.at]).sqrt();
        let (sin, cos) = (self.sin[self.at + 1], self.cos[self.at + 1]);
        self.at += 2;
        self.spare = Some(r * sin);
        r * cos
    }
}

/// The gamma law of unit scale.
pub(super) struct Gamma {
    d: f64,
    c: f64,
    /// 1/a where the shape a is below 1.
    boost: Option<f64>,
}

impl Gamma {
    pub(super) fn new(a: f64) -> Self {
        let d = if a < 1.0 { a + 1.0 } else { a } - 1.0 / 3.0;
        Self {
            d,
            c: 1.0 / (9.0 * d).sqrt(),
            boost: (a < 1.0).then(|| 1.0 / a),
        }
    }

    /// A number and the logarithm of its factor, which is 0 where there is none; `wanted` units will be taken in about
    /// all that follows.
    ///
    /// # Source
    /// Marsaglia and Tsang, *A simple method for generating gamma variables*, 2000; shapes below 1 by their Sec. 6:
    /// γ(a) = γ(a + 1) u^(1/a).
    #[inline]
    pub(super) fn draw(&self, rng: &mut Stream, ahead: &mut Ahead, wanted: usize) -> (f64, f64) {
        let gamma = loop {
            ahead.provide(rng, wanted);
            let x = ahead.normal();
            let v = 1.0 + self.c * x;
            if v <= 0.0 {
                continue;
            }
            let v = v * v * v;
            let (u, ln) = (1.0 - ahead.units[ahead.at], ahead.ln[ahead.at]);
            ahead.at += 1;
            // The first test is cheap and settles most draws.
            if u < 1.0 - 0.0331 * (x * x) * (x * x) || ln < 0.5 * x * x + self.d * (1.0 - v + libm::log(v)) {
                break self.d * v;
            }
        };
        let Some(power) = self.boost else { return (gamma, 0.0) };
        ahead.at += 1;
        (gamma, power * ahead.ln[ahead.at - 1])
    }

    /// Units that a draw takes where none is rejected.
    pub(super) fn units(&self) -> usize {
        if self.boost.is_some() { 3 } else { 2 }
    }

    /// Applies the factors of which the logarithms are given; these become the factors on the way.
    pub(super) fn boost(&self, gammas: &mut [f64], logarithms: &mut [f64]) {
        if self.boost.is_some() {
            each!(logarithms, simd, x => doubles::exp(simd, x));
            gammas
                .iter_mut()
                .zip(logarithms)
                .for_each(|(gamma, factor)| *gamma *= *factor);
        }
    }
}

/// A gamma variable of shape a, drawn with scalar functions in the order in which words are taken.
#[cfg(test)]
pub(super) fn one_gamma(a: f64, rng: &mut Stream, normals: &mut super::testing::Normals) -> f64 {
    let law = Gamma::new(a);
    let gamma = loop {
        let x = normals.one(rng);
        let v = 1.0 + law.c * x;
        let v = v * v * v;
        if v > 0.0 && libm::log(1.0 - rng.unit()) < 0.5 * x * x + law.d * (1.0 - v + libm::log(v)) {
            break law.d * v;
        }
    };
    if a < 1.0 {
        gamma * libm::exp(1.0 / a * libm::log(1.0 - rng.unit()))
    } else {
        gamma
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{DRAWS, draws, has_mean, rng};
    use super::*;

    #[test]
    fn normal_numbers() {
        let mut ahead = Ahead::default();
        let x = draws(|rng| {
            ahead.provide(rng, 100);
            ahead.normal()
        });
        let inside = |x: f64| f64::from(u8::from(x.abs() < 1.0));
        assert!(
            has_mean(&x, |x| x, 0.0)
                && has_mean(&x, |x| x * x, 1.0)
                && has_mean(&x, |x| x.powi(4), 3.0)
                && has_mean(&x, inside, 0.682_689_5)
        );
        // Those of one pair are independent.
        let products: Vec<f64> = x.chunks_exact(2).map(|x| x[0] * x[1]).collect();
        assert!(has_mean(&products, |p| p, 0.0));
    }

    /// Of a gamma variable, mean and variance are both a, and the mean of its logarithm is ψ(a).
    #[test]
    fn the_gamma_law() {
        for (a, digamma) in [(0.3, -3.502_524_222), (1.0, -0.577_215_665), (5.0, 1.506_117_668)] {
            let (gamma, mut ahead) = (Gamma::new(a), Ahead::default());
            let (mut x, mut logarithms): (Vec<f64>, Vec<f64>) = {
                let mut rng = rng();
                (0..DRAWS).map(|_| gamma.draw(&mut rng, &mut ahead, 100)).unzip()
            };
            gamma.boost(&mut x, &mut logarithms);
            assert!(x.iter().all(|&x| x > 0.0));
            assert!(
                has_mean(&x, |x| x, a) && has_mean(&x, |x| (x - a).powi(2), a) && has_mean(&x, f64::ln, digamma),
                "a = {a}"
            );
        }
    }
}
