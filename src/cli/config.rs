//! The configuration file.

use crate::dataset::DatasetConfig;
use crate::features::colour::ColourSet;
use crate::model::mlp::check_name;
use crate::numeric::file::{read, without_mark};
use crate::synth::SynthConfig;
use crate::train::TrainConfig;
use anyhow::{Context, bail};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use toml::{Table, Value};

/// What a configuration file says: all that decides a result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Config {
    /// Name of the network and of its files.
    pub name: String,
    /// Seed of everything random.
    pub seed: u64,
    /// Random pixels.
    pub synth: SynthConfig,
    /// The rows that are made of them.
    pub dataset: DatasetConfig,
    /// How the network is trained.
    pub train: TrainConfig,
    /// How its error is measured in the end.
    #[serde(default)]
    pub evaluate: EvaluateConfig,
}

/// What a file says of itself.
#[derive(Deserialize)]
struct Head {
    /// A file beside it, whose every value holds that this one does not give.
    extends: Option<PathBuf>,
}

/// The configuration that a word was probably meant for: a file of that name with its ending, here or in `configs`.
fn meant(path: &Path) -> Option<PathBuf> {
    let file = path.with_added_extension("toml");
    let candidates = [
        file.clone(),
        Path::new("configs").join(path),
        Path::new("configs").join(file),
    ];
    candidates.into_iter().find(|candidate| candidate.is_file())
}

fn text_of(path: &Path) -> anyhow::Result<String> {
    let bytes = read(path).map_err(|error| match meant(path) {
        Some(meant) => anyhow::anyhow!("{error}; did you mean '{}'?", meant.display()),
        None if path.extension().is_none() => {
            anyhow::anyhow!("{error}; a configuration is a file that ends in .toml, such as configs/paper.toml")
        }
        None => error.into(),
    })?;
    let text = std::str::from_utf8(without_mark(&bytes));
    let text = text.with_context(|| {
        format!(
            "{}: not UTF-8, which TOML is written in; save the file as UTF-8",
            path.display()
        )
    })?;
    Ok(text.to_owned())
}

/// Puts values over others; tables are merged, everything else is replaced.
fn merge(base: &mut Table, changes: Table) {
    for (key, value) in changes {
        match (base.get_mut(&key), value) {
            (Some(Value::Table(base)), Value::Table(changes)) => merge(base, changes),
            (_, value) => {
                base.insert(key, value);
            }
        }
    }
}

/// What a file says, and where it extends another, what that one says besides.
pub fn whole(path: &Path) -> anyhow::Result<Table> {
    let parsed = |path: &Path| -> anyhow::Result<Table> {
        toml::from_str(&text_of(path)?).map_err(|e| anyhow::anyhow!("{}: {}", path.display(), e.to_string().trim_end()))
    };
    let mut changes = parsed(path)?;
    let Some(base) = changes.remove("extends") else {
        return Ok(changes);
    };
    let Some(base) = base.as_str() else {
        bail!("{}: extends = {base}: must be the name of a file", path.display());
    };
    let base = path.with_file_name(base);
    let mut whole = parsed(&base)?;
    if whole.contains_key("extends") {
        bail!(
            "{}: extends another file itself; only one step is followed",
            base.display()
        );
    }
    merge(&mut whole, changes);
    Ok(whole)
}

/// The set of a network that answers with a pixel's colour, where the file is about one.
pub fn colour_set(whole: &Table) -> Option<ColourSet> {
    let name = whole.get("dataset")?.get("features")?.as_str()?;
    ColourSet::ALL.into_iter().find(|set| set.name() == name)
}

/// How the final error is measured.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct EvaluateConfig {
    /// Fragments, at least, of fresh pixels.
    pub pairs: u64,
}

impl Default for EvaluateConfig {
    fn default() -> Self {
        Self { pairs: 500_000 }
    }
}

impl Config {
    /// Reads and validates a file, and the one that it extends.
    pub fn load(path: &Path) -> anyhow::Result<Self> {
        let wrong =
            |path: &Path, e: toml::de::Error| anyhow::anyhow!("{}: {}", path.display(), e.to_string().trim_end());
        let text = text_of(path)?;
        let head: Head = toml::from_str(&text).map_err(|e| wrong(path, e))?;
        let whole = whole(path)?;
        if let Some(set) = colour_set(&whole) {
            bail!(
                "{}: dataset.features = '{}' is a network that answers with a pixel's colour; 'nmt train' trains it, \
                    and no other command takes it",
                path.display(),
                set.name()
            );
        }
        let config: Self = match head.extends {
            // Straight from the text, so that errors show the place.
            None => toml::from_str(&text).map_err(|e| wrong(path, e))?,
            Some(_) => whole.try_into().map_err(|e| wrong(path, e))?,
        };
        config.validate().with_context(|| path.display().to_string())?;
        Ok(config)
    }

    fn validate(&self) -> anyhow::Result<()> {
        check_name(&self.name)?;
        self.synth.validate()?;
        self.dataset.validate()?;
        self.train.validate()?;
        if !(1..=crate::dataset::build::MAX_PAIRS).contains(&self.evaluate.pairs) {
            bail!(
                "evaluate.pairs = {}: must be from 1 to {}",
                self.evaluate.pairs,
                crate::dataset::build::MAX_PAIRS
            );
        }
        Ok(())
    }

    /// The configuration as it is kept in a model's provenance.
    pub fn to_json(&self) -> serde_json::Value {
        serde_json::to_value(self).expect("a configuration is plain data")
    }
}
