//! The configuration file.

use crate::dataset::DatasetConfig;
use crate::model::mlp::check_name;
use crate::numeric::file::read;
use crate::synth::SynthConfig;
use crate::train::TrainConfig;
use anyhow::{Context, bail};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// What a configuration file says: all that decides a result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Config {
    /// Name of the network and of its files.
    pub name: String,
    /// Seed of everything random.
    pub seed: u64,
    pub synth: SynthConfig,
    pub dataset: DatasetConfig,
    pub train: TrainConfig,
    pub evaluate: EvaluateConfig,
}

/// How the final error is measured.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EvaluateConfig {
    /// Fragments, at least, of fresh pixels.
    pub pairs: u64,
}

impl Config {
    /// Reads and validates a file.
    pub fn load(path: &Path) -> anyhow::Result<Self> {
        let bytes = read(path)?;
        let text = std::str::from_utf8(&bytes).with_context(|| format!("{}: not a text file", path.display()))?;
        let config: Self = toml::from_str(text).map_err(|e| anyhow::anyhow!("{}: {}", path.display(), e.to_string().trim_end()))?;
        config.validate().with_context(|| path.display().to_string())?;
        Ok(config)
    }

    fn validate(&self) -> anyhow::Result<()> {
        check_name(&self.name)?;
        self.synth.validate()?;
        self.dataset.validate()?;
        self.train.validate()?;
        if !(1..=crate::dataset::build::MOST_PAIRS).contains(&self.evaluate.pairs) {
            bail!("evaluate.pairs = {}: must be from 1 to {}", self.evaluate.pairs, crate::dataset::build::MOST_PAIRS);
        }
        Ok(())
    }

    /// The configuration as it is kept in a model's provenance.
    pub fn to_json(&self) -> serde_json::Value {
        serde_json::to_value(self).expect("a configuration is plain data")
    }
}
