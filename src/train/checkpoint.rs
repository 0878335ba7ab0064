//! Checkpoints: all that a later process needs to continue as if there had been no interruption.

use super::{AdamMoments, Backend, Schedule, TrainConfig};
use crate::numeric::file::{FileError, Replace, read, write_atomically};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// The version of the checkpoint file that this program writes and reads.
pub const CHECKPOINT_VERSION: u32 = 1;

/// Training as it stood at the end of an epoch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Checkpoint {
    /// Always "nmt-checkpoint".
    pub format: String,
    /// [`CHECKPOINT_VERSION`].
    pub version: u32,
    /// How it is trained.
    pub config: TrainConfig,
    /// Seed of initial weights and shuffling.
    pub seed: u64,
    /// What it is trained on.
    pub dataset_hash: String,
    /// What computes the gradients.
    pub backend: Backend,
    /// Weights.
    pub parameters: Vec<f32>,
    /// Adam's moments.
    pub moments: AdamMoments,
    /// Weights with the least validation loss so far.
    pub best_parameters: Vec<f32>,
    /// Their epoch, from 1.
    pub best_epoch: u64,
    /// Losses of every epoch so far.
    pub history: Vec<Losses>,
}

/// Losses of an epoch.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Losses {
    /// Mean squared error over the training rows, while they were being learnt from.
    pub training: f64,
    /// Mean squared error over the validation rows after the epoch.
    pub validation: f64,
}

/// Why a checkpoint could not be continued from.
#[derive(Debug, thiserror::Error)]
pub enum CheckpointError {
    /// The file could not be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// It is not a checkpoint, or damaged.
    #[error("{}: not a checkpoint that this program can continue: {reason}; remove it to train anew", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// It has gone further than is asked for.
    #[error("{}: {done} epochs are done already, more than the {epochs} that are asked for; ask for at least {done}, \
        or train anew", path.display())]
    Further {
        /// The file.
        path: PathBuf,
        /// Epochs done.
        done: u64,
        /// Epochs asked for.
        epochs: u64,
    },
    /// It belongs to another training.
    #[error("{}: the checkpoint is of a training with another {what}; use the configuration it began with, or remove \
        it to train anew", path.display())]
    Other {
        /// The file.
        path: PathBuf,
        /// What differs.
        what: &'static str,
    },
}

/// Where the checkpoint of a model stands: beside it, `model.json` -> `model.checkpoint.json`.
pub fn path_for(model: &Path) -> PathBuf {
    model.with_extension("checkpoint.json")
}

/// What says that a training of a model is at work: beside it, `model.json` -> `model.checkpoint.lock`.
pub fn lock_path_for(model: &Path) -> PathBuf {
    model.with_extension("checkpoint.lock")
}

impl Checkpoint {
    /// Least validation loss so far.
    pub fn best_validation(&self) -> f64 {
        match self.best_epoch {
            0 => f64::INFINITY,
            epoch => self.history[epoch as usize - 1].validation,
        }
    }

    /// Adds an epoch; its parameters are the best where no epoch before had a lower validation loss.
    pub fn add(&mut self, losses: Losses, parameters: Vec<f32>, moments: AdamMoments) {
        if losses.validation < self.best_validation() {
            self.best_epoch = self.history.len() as u64 + 1;
            self.best_parameters.clone_from(&parameters);
        }
        self.parameters = parameters;
        self.moments = moments;
        self.history.push(losses);
    }

    /// Writes the checkpoint, in the place of an older one.
    ///
    /// # Errors
    /// [`FileError`]; the older checkpoint stays whole.
    pub fn save(&self, path: &Path) -> Result<(), FileError> {
        let text = serde_json::to_vec(self).expect("a checkpoint is plain data");
        write_atomically(path, Replace::Yes, |w| w.write_all(&text))
    }

    /// Reads a checkpoint.
    ///
    /// # Errors
    /// [`CheckpointError`].
    pub fn load(path: &Path) -> Result<Self, CheckpointError> {
        let unreadable = |reason: String| CheckpointError::Unreadable {
            path: path.to_owned(),
            reason,
        };
        let checkpoint: Self = serde_json::from_slice(&read(path)?).map_err(|e| unreadable(e.to_string()))?;
        if checkpoint.format != "nmt-checkpoint" || checkpoint.version != CHECKPOINT_VERSION {
            return Err(unreadable(format!(
                "format '{}' version {}, expected 'nmt-checkpoint' version {CHECKPOINT_VERSION}",
                checkpoint.format, checkpoint.version
            )));
        }
        Ok(checkpoint)
    }

    /// Checks that it belongs to a training; only the number of epochs may differ.
    ///
    /// # Errors
    /// [`CheckpointError::Other`] names what differs, [`CheckpointError::Unreadable`] where its arrays do not fit the
    /// network.
    pub fn check(
        &self,
        path: &Path,
        config: &TrainConfig,
        seed: u64,
        dataset_hash: &str,
        backend: Backend,
        parameters: usize,
    ) -> Result<(), CheckpointError> {
        let other = |what| {
            Err(CheckpointError::Other {
                path: path.to_owned(),
                what,
            })
        };
        // More epochs are more of the same only where the step size does not depend on their number.
        let may_grow = config.schedule == Schedule::Constant && config.seeds == 1;
        let epochs = if may_grow { config.epochs } else { self.config.epochs };
        if (TrainConfig {
            epochs,
            checkpoint_every: config.checkpoint_every,
            ..self.config.clone()
        }) != *config
        {
            return other("training configuration");
        }
        if self.seed != seed {
            return other("seed");
        }
        if self.dataset_hash != dataset_hash {
            return other("dataset");
        }
        if self.backend != backend {
            return other("backend");
        }
        let done = self.history.len() as u64;
        if done > config.epochs * config.seeds {
            return Err(CheckpointError::Further {
                path: path.to_owned(),
                done,
                epochs: config.epochs * config.seeds,
            });
        }
        let moments = &self.moments;
        let lengths = [
            self.parameters.len(),
            self.best_parameters.len(),
            moments.first.len(),
            moments.second.len(),
        ];
        let numbers = [&self.parameters, &self.best_parameters, &moments.first, &moments.second];
        if lengths != [parameters; 4] || !numbers.iter().all(|n| n.iter().all(|x| x.is_finite())) {
            return Err(CheckpointError::Unreadable {
                path: path.to_owned(),
                reason: "its arrays do not fit the network or are not finite".to_owned(),
            });
        }
        if moments.steps == 0 || self.best_epoch == 0 || self.best_epoch > self.history.len() as u64 {
            return Err(CheckpointError::Unreadable {
                path: path.to_owned(),
                reason: "its epochs contradict each other".to_owned(),
            });
        }
        Ok(())
    }
}
