//! Errors along one quantity: half of a pixel's range, number of fragments, bits of storage.

use super::Errors;
use super::cases::Fragments;
use super::subject::{Doubles, Subject};
use crate::oit::Context;
use crate::pixel::abuffer;
use crate::synth::config::Range;
use crate::synth::law::{CountLaw, FragmentCount, PixelLaw};
use crate::synth::{Purpose, Synth, SynthConfig};
use serde::Serialize;

const SEED: u64 = 0x7377;

/// Half-ranges of pixels in moment depth \[dimensionless\].
pub const HALF_RANGES: [f64; 18] = [
    0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5, 5e-6, 2e-6, 1e-6,
];

/// Numbers of fragments.
pub const COUNTS: [u32; 11] = [3, 4, 6, 8, 16, 32, 64, 128, 256, 1024, 4096];

/// Significant binary digits that moments are kept with: 11 in half precision, 24 in single, 53 in double.
pub const DIGITS: [u32; 15] = [8, 10, 11, 12, 14, 16, 18, 20, 22, 24, 28, 32, 36, 44, 53];

/// Errors of a method at one place of a sweep.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Point {
    /// Name of the method.
    pub method: String,
    /// The quantity that is swept: its name says its unit.
    pub sweep: &'static str,
    /// Its value.
    pub x: f64,
    /// Number of fragments.
    pub fragments: u64,
    /// Mean squared error of T over the finite answers.
    pub mse: Option<f64>,
    /// The same without rounding.
    pub approximation_mse: Option<f64>,
    /// Mean squared difference from the method's own answer without rounding.
    pub rounding_mse: Option<f64>,
    /// Greatest absolute error of T over the finite answers.
    pub worst_error: Option<f64>,
    /// Answers that are not finite.
    pub nonfinite: u64,
}

impl Point {
    /// What rounding adds to the mean squared error, as a share of the error without it.
    pub fn added(&self) -> Option<f64> {
        Some((self.mse? - self.approximation_mse?) / self.approximation_mse?)
    }
}

/// Random pixels of the distribution that networks are trained on, changed in one thing.
fn pixels(change: impl Fn(&mut PixelLaw), count: usize) -> Fragments {
    let mut config = SynthConfig::wide();
    config.pixels.iter_mut().for_each(change);
    let list = Synth::new(config, SEED)
        .expect("ranges within those of valid laws")
        .pixels(Purpose::Evaluation, 0, count);
    let planes = list.planes();
    Fragments::of_list(
        &list,
        Context {
            planes,
            depth_range: planes.map(|p| (p.near(), p.far())),
        },
    )
}

/// Pixels of one half-range of moment depth.
pub fn of_half_range(half: f64, count: usize) -> Fragments {
    pixels(
        |law| {
            if let Some(range) = &mut law.range {
                range.half = Range { min: half, max: half };
            }
        },
        count,
    )
}

/// Pixels of one number of fragments.
pub fn of_count(n: u32, count: usize) -> Fragments {
    pixels(
        |law| {
            law.fragments = FragmentCount {
                min: n,
                max: n,
                law: CountLaw::Uniform,
            }
        },
        count,
    )
}

/// Pixels as networks are trained on.
pub fn usual(count: usize) -> Fragments {
    pixels(|_| {}, count)
}

/// Errors of methods on the same fragments.
pub fn points(sweep: &'static str, x: f64, fragments: &Fragments, subjects: &[Subject<'_>]) -> Vec<Point> {
    let mut exact = vec![0.0; fragments.len()];
    for p in 0..fragments.pixels() {
        abuffer::transmittance(fragments.pixel(p), &mut exact[fragments.range(p)]);
    }
    let mut doubles = Doubles::default();
    subjects
        .iter()
        .map(|subject| {
            let answers = subject.answers(fragments).unwrap_or_default();
            let double = subject.double(fragments, &mut doubles);
            let errors = Errors::of(&answers, &exact);
            Point {
                method: subject.name.clone(),
                sweep,
                x,
                fragments: fragments.len() as u64,
                mse: errors.map(|e| e.mse),
                approximation_mse: double.and_then(|d| Errors::of(d, &exact)).map(|e| e.mse),
                rounding_mse: double.and_then(|d| Errors::of(&answers, d)).map(|e| e.mse),
                worst_error: errors.map(|e| e.worst),
                nonfinite: answers.iter().filter(|t| !t.is_finite()).count() as u64,
            }
        })
        .collect()
}
