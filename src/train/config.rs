//! How a network is trained, as a configuration says it.

use crate::dataset::build::is_default;
use crate::numeric::lanes::LANES;
use serde::{Deserialize, Serialize};

/// How a network is trained.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct TrainConfig {
    /// Units of each hidden layer.
    pub hidden: Vec<usize>,
    /// Passes over the training rows.
    pub epochs: u64,
    /// Rows of one step, a multiple of sixteen; the last step of an epoch takes what is left.
    pub batch: usize,
    /// Adam's step size.
    pub learning_rate: f64,
    /// How the step size changes over the steps.
    #[serde(default, skip_serializing_if = "is_default")]
    pub schedule: Schedule,
    /// Steps over which the step size first rises from 0.
    #[serde(default, skip_serializing_if = "is_default")]
    pub warmup_steps: u64,
    /// Networks to train, from as many seeds; the one with the least validation loss is kept.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub seeds: u64,
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

/// How the step size changes over the steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Schedule {
    /// Not at all.
    #[default]
    Constant,
    /// Along half a cosine down to 0 at the last step.
    Cosine,
}

fn one() -> u64 {
    1
}
fn is_one(n: &u64) -> bool {
    *n == 1
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
        let most = crate::model::mlp::MAX_UNITS;
        let unit = |x: f64| (0.0..1.0).contains(&x);
        let checks = [
            (
                self.hidden.iter().all(|&h| (1..=most).contains(&h)) && self.hidden.len() <= 16,
                "hidden",
                format!("{:?}", self.hidden),
                "at most 16 layers of 1 to 4096 units",
            ),
            (self.epochs >= 1, "epochs", self.epochs.to_string(), "at least 1"),
            (
                self.batch >= 1 && self.batch.is_multiple_of(LANES),
                "batch",
                self.batch.to_string(),
                "a multiple of 16, at least 16",
            ),
            (
                (1..=1000).contains(&self.seeds),
                "seeds",
                self.seeds.to_string(),
                "from 1 to 1000",
            ),
            (
                self.learning_rate > 0.0 && self.learning_rate <= 1.0,
                "learning_rate",
                self.learning_rate.to_string(),
                "greater than 0 and at most 1",
            ),
            (unit(self.beta1), "beta1", self.beta1.to_string(), "from 0 to below 1"),
            (unit(self.beta2), "beta2", self.beta2.to_string(), "from 0 to below 1"),
            (
                self.epsilon > 0.0 && self.epsilon.is_finite(),
                "epsilon",
                self.epsilon.to_string(),
                "finite and greater than 0",
            ),
            (
                self.checkpoint_every >= 1,
                "checkpoint_every",
                self.checkpoint_every.to_string(),
                "at least 1",
            ),
        ];
        match checks.into_iter().find(|(ok, ..)| !ok) {
            Some((_, field, value, expected)) => Err(TrainConfigError { field, value, expected }),
            None => Ok(()),
        }
    }
}

impl TrainConfig {
    /// Step size of a step, from 1, of so many.
    pub fn learning_rate_at(&self, step: u64, steps: u64) -> f64 {
        let warm = if self.warmup_steps == 0 {
            1.0
        } else {
            (step as f64 / self.warmup_steps as f64).min(1.0)
        };
        let decay = match self.schedule {
            Schedule::Constant => 1.0,
            Schedule::Cosine => 0.5 * (1.0 + libm::cos(std::f64::consts::PI * step as f64 / steps as f64)),
        };
        self.learning_rate * warm * decay
    }
}
