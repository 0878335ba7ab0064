//! What a scene needs of a network, measured and never printed; and networks made to measure.

pub mod facts;
pub mod network;
pub mod recommend;
pub mod simplify;
pub mod skip;
pub mod specialise;

pub use facts::{Facts, facts};
pub use network::{Networked, look_into};
pub use recommend::{Recommendation, recommend};

use crate::evaluate::{EvaluateError, Image, Truth, image};
use crate::model::simplify::SimplifyError;
use crate::model::{self, Mlp, ShapeError};
use crate::numeric::tolerance::AbsoluteError;
use crate::oit::{self, Context, MethodError};
use crate::pixel::{DepthError, FragmentList, abuffer};
use rayon::prelude::*;

/// Why a scene could not be profiled, or a network not be fitted to it.
#[derive(Debug, thiserror::Error)]
pub enum ProfileError {
    /// A network cannot be applied to the list.
    #[error(transparent)]
    Method(#[from] MethodError),
    /// The list lacks what features need.
    #[error(transparent)]
    Depth(#[from] DepthError),
    /// Images could not be compared.
    #[error(transparent)]
    Evaluate(#[from] EvaluateError),
    /// What was made is no network.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// Units could not be taken out of a network.
    #[error(transparent)]
    Simplify(#[from] SimplifyError),
    /// The network answers too little of the scene.
    #[error(
        "the network is evaluated for {rows} fragments of this scene; at least {least} are needed to {what}: take a \
            larger image, or a scene with deeper pixels"
    )]
    TooFew {
        /// Rows of features.
        rows: usize,
        /// How many are needed.
        least: usize,
        /// What for.
        what: &'static str,
    },
    /// The network's answer is no transmittance.
    #[error("{model}: its answer is not a transmittance, so it cannot be fitted to a scene here")]
    NoTransmittance {
        /// The network.
        model: String,
    },
    /// The error to keep is none.
    #[error("--target-error {0}: must be a number greater than 0")]
    TargetError(f64),
    /// Training ran away.
    #[error("the weights are not finite after training on this scene; the network or the scene has extreme values")]
    Diverged,
    /// It was asked to stop.
    #[error("interrupted; nothing was written")]
    Interrupted,
}

/// A fragment list with its exact answer, and how it is looked at.
pub struct Scene<'a> {
    /// The fragments.
    pub list: &'a FragmentList,
    /// Planes and range of depth.
    pub context: Context,
    /// What everything is compared with.
    pub truth: Truth<'a>,
    /// Exact transmittance of every fragment.
    pub transmittance: Vec<f64>,
    /// Linear colour behind everything.
    pub background: [f64; 3],
}

/// How far answers are off.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Errors {
    /// Mean squared error of the image over all pixels and channels; none where the list makes none.
    pub image_mse: Option<f64>,
    /// Mean squared error of transmittance over all fragments.
    pub transmittance_mse: f64,
}

impl Errors {
    /// What a network is judged by.
    pub fn decisive(&self) -> f64 {
        self.image_mse.unwrap_or(self.transmittance_mse)
    }
}

impl<'a> Scene<'a> {
    /// A list before a background.
    pub fn new(list: &'a FragmentList, context: Context, background: [f64; 3]) -> Self {
        Self {
            list,
            context,
            truth: Truth::new(list, background),
            transmittance: abuffer::list_transmittance(list),
            background,
        }
    }

    /// The image that transmittances make, where the list makes one.
    pub fn image_of(&self, transmittance: &[f32]) -> Option<Result<Image, EvaluateError>> {
        let (width, height) = image::size_of(self.list).ok()?;
        let pixels = (0..self.list.pixels())
            .into_par_iter()
            .with_min_len(256)
            .map(|p| self.color_of(p, transmittance))
            .collect();
        Some(Image::new(width, height, pixels))
    }

    /// Colour of a pixel.
    fn color_of(&self, p: usize, transmittance: &[f32]) -> [f64; 3] {
        let weights: Vec<f64> = transmittance[self.list.range(p)].iter().map(|&t| t.into()).collect();
        oit::composite_normalised(self.list.pixel(p), &weights, self.background)
    }

    /// Errors of answers to the whole list.
    ///
    /// # Errors
    /// [`EvaluateError`] where images cannot be compared.
    pub fn errors(&self, transmittance: &[f32]) -> Result<Errors, EvaluateError> {
        let mut of_t = AbsoluteError::default();
        transmittance
            .iter()
            .zip(&self.transmittance)
            .for_each(|(&t, &e)| of_t.add(t.into(), e));
        let image_mse = match (self.image_of(transmittance).transpose()?, self.truth.image()) {
            (Some(image), Ok(truth)) => Some(image.error(truth)?.mse()),
            _ => None,
        };
        Ok(Errors {
            image_mse,
            transmittance_mse: of_t.mse(),
        })
    }
}

/// The networks that a scene is profiled with by default.
pub fn default_networks() -> Vec<Mlp> {
    let names = ["recommended", "small", "moments-6", "paper"];
    names.into_iter().filter_map(model::shipped::named).collect()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn profiles_look_into_four_networks() {
        let names: Vec<String> = default_networks().iter().map(|m| m.name().to_owned()).collect();
        assert_eq!(names, ["recommended", "small", "moments-6", "paper"]);
    }

    #[test]
    fn medians_by_hand() {
        assert_eq!((median(&[3.0, 1.0, 2.0]), median(&[4.0, 1.0])), (2.0, 2.5));
        assert!(median(&[]).is_nan());
    }
}
