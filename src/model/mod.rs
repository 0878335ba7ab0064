//! The network: plain arrays, a reference forward pass in two precisions, and its file.

pub mod file;
pub mod kernel;
pub mod mlp;
pub mod shipped;
pub mod simplify;

pub use file::ModelError;
pub use mlp::{Dense, Mlp, ShapeError};

use serde::{Deserialize, Serialize};

/// Where a network comes from. Everything is optional but for what training itself knows.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Provenance {
    /// The program that trained it, with its version, or where the weights were imported from.
    pub source: String,
    /// The configuration that it was trained with, whole.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub config: Option<serde_json::Value>,
    /// Seed of initial weights and shuffling.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
    /// Hash of the dataset.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dataset_hash: Option<String>,
    /// Version-control revision of the program, where it was built from one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub commit: Option<String>,
    /// What computed the gradients.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub backend: Option<String>,
    /// Epochs trained.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub epochs: Option<u64>,
    /// The epoch whose weights these are: the one with the least validation loss.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub best_epoch: Option<u64>,
    /// Mean squared error over the training rows in that epoch.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub training_loss: Option<f64>,
    /// Mean squared error over the validation rows after that epoch.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub validation_loss: Option<f64>,
    /// Mean squared error of T over fresh pixels of the training distribution.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub transmittance_mse: Option<f64>,
    /// Greatest absolute error of T over the same pixels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub transmittance_worst_error: Option<f64>,
    /// What was taken out of the network that was trained.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pruned: Option<simplify::Pruned>,
    /// How it was made of another network, from what, and where that holds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub derived: Option<serde_json::Value>,
}
