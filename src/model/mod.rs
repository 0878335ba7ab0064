//! The network: plain arrays, a reference forward pass in two precisions, and its file.

pub mod colour;
pub mod file;
pub mod kernel;
pub mod mlp;
pub mod shipped;
pub mod simplify;

pub use colour::ColourNetwork;
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

impl Provenance {
    /// Of what this program trains by a configuration; the training adds what it knows.
    pub fn of_this_program(config: serde_json::Value) -> Self {
        Self {
            source: format!("nmt {}", env!("CARGO_PKG_VERSION")),
            commit: option_env!("NMT_COMMIT").map(str::to_owned),
            config: Some(config),
            ..Self::default()
        }
    }

    /// Epochs as a person counts them: those of one training, or "3 x 600" where the best of several was kept.
    pub fn epochs_text(&self) -> Option<String> {
        let all = self.epochs?;
        let of = |name: &str| self.config.as_ref()?.get("train")?.get(name)?.as_u64();
        match (of("seeds"), of("epochs")) {
            (Some(seeds), Some(each)) if seeds > 1 && seeds.checked_mul(each) == Some(all) => {
                Some(format!("{seeds} x {each}"))
            }
            _ => Some(all.to_string()),
        }
    }

    /// The epoch whose weights these are, counted within its own training.
    pub fn best_epoch_text(&self) -> Option<String> {
        let (best, each) = (
            self.best_epoch?,
            self.config.as_ref().and_then(|c| c["train"]["epochs"].as_u64()),
        );
        match each.filter(|&each| each > 0 && best > each) {
            Some(each) => Some(format!(
                "{} of training {}",
                (best - 1) % each + 1,
                (best - 1) / each + 1
            )),
            None => Some(best.to_string()),
        }
    }

    /// The error that was measured when the network was made, and on what.
    pub fn measured_text(&self) -> Option<String> {
        if let (Some(mse), Some(worst)) = (self.transmittance_mse, self.transmittance_worst_error) {
            return Some(format!(
                "Measured on fresh pixels of the training distribution: mean squared error of T {mse:.3e}, worst \
                    {worst:.3}."
            ));
        }
        let derived = self.derived.as_ref()?;
        let number = |name: &str| derived.get(name).and_then(serde_json::Value::as_f64);
        let from = derived
            .get("from")
            .and_then(serde_json::Value::as_str)
            .unwrap_or("another network");
        let (error, held_out) = (number("error")?, number("error_held_out")?);
        Some(format!(
            "Measured on the scene that it was retrained on: error {error:.3e}, and {held_out:.3e} on the tiles held \
                out; '{from}' had {:.3e} and {:.3e}.",
            number("error_before").unwrap_or(f64::NAN),
            number("error_before_held_out").unwrap_or(f64::NAN)
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn epochs_of_several_trainings_are_told_apart() {
        let mut p = Provenance {
            epochs: Some(1800),
            best_epoch: Some(1750),
            ..Provenance::default()
        };
        assert_eq!(
            (p.epochs_text().unwrap(), p.best_epoch_text().unwrap()),
            ("1800".to_owned(), "1750".to_owned())
        );
        p.config = Some(serde_json::json!({ "train": { "epochs": 600, "seeds": 3 } }));
        assert_eq!(
            (p.epochs_text().unwrap(), p.best_epoch_text().unwrap()),
            ("3 x 600".to_owned(), "550 of training 3".to_owned())
        );
        assert!(p.measured_text().is_none());
        p.derived = Some(
            serde_json::json!({ "from": "a", "error": 1e-3, "error_held_out": 2e-3, "error_before": 3e-3,
                "error_before_held_out": 4e-3 }),
        );
        assert!(p.measured_text().unwrap().contains("error 1.000e-3, and 2.000e-3"));
    }
}
