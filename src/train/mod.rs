//! Training: the only place that knows burn.

pub mod burn;
pub mod checkpoint;
pub mod initial;
pub mod schedule;

pub use checkpoint::{Checkpoint, CheckpointError};
pub use schedule::{EpochReport, Outcome, TrainError, train};

use serde::{Deserialize, Serialize};

/// How a network is trained.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrainConfig {
    /// Units of each hidden layer.
    pub hidden: Vec<usize>,
    /// Passes over the training rows.
    pub epochs: u64,
    /// Rows of one step; the last step of an epoch takes what is left.
    pub batch: usize,
    /// Adam's step size.
    pub learning_rate: f64,
    /// Adam's decay of the mean gradient.
    #[serde(default = "default_beta1")]
    pub beta1: f64,
    /// Adam's decay of the mean squared gradient.
    #[serde(default = "default_beta2")]
    pub beta2: f64,
    /// Adam's guard against division by zero.
    #[serde(default = "default_epsilon")]
    pub epsilon: f64,
    /// Epochs between two checkpoints.
    #[serde(default = "default_checkpoint_every")]
    pub checkpoint_every: u64,
}

fn default_beta1() -> f64 {
    0.9
}
fn default_beta2() -> f64 {
    0.999
}
/// What Keras, which NMT24 used, takes by default.
fn default_epsilon() -> f64 {
    1e-7
}
fn default_checkpoint_every() -> u64 {
    50
}

/// What is wrong with a training configuration.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("train.{field} = {value}: must be {expected}")]
pub struct TrainConfigError {
    field: &'static str,
    value: String,
    expected: &'static str,
}

impl TrainConfig {
    /// Checks every field.
    ///
    /// # Errors
    /// [`TrainConfigError`] names the field and what it must be.
    pub fn validate(&self) -> Result<(), TrainConfigError> {
        let most = crate::model::mlp::MOST_UNITS;
        let unit = |x: f64| (0.0..1.0).contains(&x);
        let checks = [
            (
                self.hidden.iter().all(|&h| (1..=most).contains(&h)) && self.hidden.len() <= 16,
                "hidden",
                format!("{:?}", self.hidden),
                "at most 16 layers of 1 to 4096 units",
            ),
            (self.epochs >= 1, "epochs", self.epochs.to_string(), "at least 1"),
            (self.batch >= 1, "batch", self.batch.to_string(), "at least 1"),
            (self.learning_rate > 0.0 && self.learning_rate <= 1.0, "learning_rate", self.learning_rate.to_string(), "greater than 0 and at most 1"),
            (unit(self.beta1), "beta1", self.beta1.to_string(), "from 0 to below 1"),
            (unit(self.beta2), "beta2", self.beta2.to_string(), "from 0 to below 1"),
            (self.epsilon > 0.0 && self.epsilon.is_finite(), "epsilon", self.epsilon.to_string(), "finite and greater than 0"),
            (self.checkpoint_every >= 1, "checkpoint_every", self.checkpoint_every.to_string(), "at least 1"),
        ];
        match checks.into_iter().find(|(ok, ..)| !ok) {
            Some((_, field, value, expected)) => Err(TrainConfigError { field, value, expected }),
            None => Ok(()),
        }
    }
}

/// What computes gradients and takes Adam's steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Backend {
    /// burn on its `flex` CPU backend.
    Flex,
    /// burn on its `ndarray` CPU backend (burn-ndarray).
    Ndarray,
}

impl Backend {
    /// Its name on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Flex => "flex",
            Self::Ndarray => "ndarray",
        }
    }

    /// An optimiser of this kind, at the given weights and with fresh moments.
    pub fn optimiser(self, shapes: &[(usize, usize)], parameters: &[f32], config: &TrainConfig) -> Box<dyn Optimiser> {
        Box::new(burn::BurnOptimiser::new(self, shapes, parameters, config))
    }
}

/// The moments of Adam, in the order of the parameters.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AdamMoments {
    /// Steps taken.
    pub steps: u64,
    /// Decayed mean of the gradient; empty before the first step.
    pub first: Vec<f32>,
    /// Decayed mean of the squared gradient; empty before the first step.
    pub second: Vec<f32>,
}

/// A network being fitted. Parameters are flat: layer by layer, weights `[in][out]`, then biases.
pub trait Optimiser {
    /// One step of Adam on the mean squared error of a batch; the error is of the weights before the step.
    ///
    /// # Shapes
    /// `features: [batch, W]`, `targets: [batch]`.
    fn step(&mut self, features: &[f32], targets: &[f32], learning_rate: f64) -> f64;

    /// Mean squared error of a batch and its gradient.
    fn gradient(&self, features: &[f32], targets: &[f32]) -> (f64, Vec<f32>);

    /// The weights as they stand.
    fn parameters(&self) -> Vec<f32>;

    /// Adam's moments as they stand.
    fn moments(&self) -> AdamMoments;

    /// Continues from elsewhere.
    fn restore(&mut self, parameters: &[f32], moments: &AdamMoments);
}
