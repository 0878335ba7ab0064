//! What the tests of the laws share.

use crate::numeric::rng::{Stream, stream};
use crate::synth::config::Range;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::f64::consts::TAU;
use std::fmt::Debug;

/// Numbers that a mean is taken of.
pub(super) const DRAWS: usize = 50_000;

pub(super) fn rng() -> Stream {
    stream(7, 0x7e57, 0)
}

pub(in crate::synth) fn range(min: f64, max: f64) -> Range {
    Range { min, max }
}

pub(super) fn draws(mut draw: impl FnMut(&mut Stream) -> f64) -> Vec<f64> {
    let mut rng = rng();
    (0..DRAWS).map(|_| draw(&mut rng)).collect()
}

pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Whether the mean of `f` over the values is `expected`, within 5 standard errors as the values themselves have them.
pub(super) fn has_mean(values: &[f64], f: impl Fn(f64) -> f64, expected: f64) -> bool {
    let values: Vec<f64> = values.iter().map(|&x| f(x)).collect();
    let found = mean(&values);
    let variance = values.iter().map(|x| (x - found).powi(2)).sum::<f64>() / values.len() as f64;
    (found - expected).abs() < 5.0 * (variance / values.len() as f64).sqrt()
}

/// Whether a configuration file says this, and what is written of it is read as the same.
pub(in crate::synth) fn says<T>(text: &str, expected: impl Into<T>) -> bool
where
    T: Serialize + DeserializeOwned + PartialEq + Debug,
{
    let expected = expected.into();
    let read: T = toml::from_str(text).unwrap();
    let again: T = toml::from_str(&toml::to_string(&expected).unwrap()).unwrap();
    let json: T = serde_json::from_value(serde_json::to_value(&expected).unwrap()).unwrap();
    read == expected && again == expected && json == expected
}

/// Standard normal numbers drawn with scalar functions, in the order in which words are taken.
#[derive(Default)]
pub(super) struct Normals {
    /// The second of a pair.
    spare: Option<f64>,
}

impl Normals {
    pub(super) fn one(&mut self, rng: &mut Stream) -> f64 {
        if let Some(x) = self.spare.take() {
            return x;
        }
        let r = (-2.0 * libm::log(1.0 - rng.unit())).sqrt();
        let (sin, cos) = libm::sincos(TAU * rng.unit());
        self.spare = Some(r * sin);
        r * cos
    }
}
