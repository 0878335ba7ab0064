//! What a scene needs of a network, measured and never printed.

pub mod skip;

use crate::evaluate::{EvaluateError, Image, Truth, image};
use crate::oit::{self, Context, MethodError};
use crate::pixel::FragmentList;
use rayon::prelude::*;

/// Why a scene could not be profiled.
#[derive(Debug, thiserror::Error)]
pub enum ProfileError {
    /// A network cannot be applied to the list.
    #[error(transparent)]
    Method(#[from] MethodError),
    /// Images could not be compared.
    #[error(transparent)]
    Evaluate(#[from] EvaluateError),
}

/// A fragment list with its exact answer, and how it is looked at.
pub struct Scene<'a> {
    /// The fragments.
    pub list: &'a FragmentList,
    /// Planes and range of depth.
    pub context: Context,
    /// What everything is compared with.
    pub truth: Truth<'a>,
    /// Linear colour behind everything.
    pub background: [f64; 3],
}

impl<'a> Scene<'a> {
    /// A list before a background.
    pub fn new(list: &'a FragmentList, context: Context, background: [f64; 3]) -> Self {
        Self { list, context, truth: Truth::new(list, background), background }
    }

    /// The image that transmittances make, where the list makes one.
    pub fn image_of(&self, transmittance: &[f32]) -> Option<Result<Image, EvaluateError>> {
        let (width, height) = image::size_of(self.list).ok()?;
        let pixels = (0..self.list.pixels()).into_par_iter().with_min_len(256);
        let pixels = pixels.map(|p| {
            let weights: Vec<f64> = transmittance[self.list.range(p)].iter().map(|&t| t.into()).collect();
            oit::composite_normalised(self.list.pixel(p), &weights, self.background)
        });
        Some(Image::new(width, height, pixels.collect()))
    }
}

/// The middle of some samples, the mean of the two in the middle where their number is even; NaN of none.
fn median(samples: &[f64]) -> f64 {
    let mut sorted = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    match sorted.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => sorted[n / 2],
        n => 0.5 * (sorted[n / 2 - 1] + sorted[n / 2]),
    }
}
