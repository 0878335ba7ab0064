//! `nmt train` of the networks that answer with a pixel's colour.

use super::config::{colour_set, whole};
use super::train::{Train, remove_checkpoint, with_progress};
use super::ui::Ui;
use super::{Verdict, keep_inputs};
use crate::dataset::colour::{ColourLaw, ColourRows};
use crate::features::colour::ColourSet;
use crate::model::Provenance;
use crate::model::mlp::check_name;
use crate::numeric::file::{Lock, Replace, may_write};
use crate::synth::{Purpose, Synth, SynthConfig};
use crate::train::checkpoint::{lock_path_for, path_for};
use crate::train::colour::ColourDataset;
use crate::train::trainer::Job;
use crate::train::{Backend, TrainConfig};
use anyhow::{Context, bail};
use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};
use serde_json::json;
use std::path::Path;

/// A configuration of such a network.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ColourConfig {
    name: String,
    seed: u64,
    synth: SynthConfig,
    dataset: DatasetOptions,
    colours: ColourLaw,
    train: TrainConfig,
    /// What a file that is extended says of measuring; the validation loss is an error of the image already.
    #[serde(default, rename = "evaluate", skip_serializing)]
    _evaluate: IgnoredAny,
}

/// Its rows: one a pixel.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct DatasetOptions {
    features: ColourSet,
    training_pairs: u64,
    validation_pairs: u64,
    #[serde(default = "one")]
    rows_per_pixel: u32,
    #[serde(default)]
    refresh: f64,
}

fn one() -> u32 {
    1
}

/// Most pixels of a dataset.
const MAX_PIXELS: u64 = 1 << 24;

impl ColourConfig {
    /// Reads and validates a file that is about such a network; none of any other.
    pub fn load(path: &Path) -> anyhow::Result<Option<Self>> {
        let whole = whole(path)?;
        if colour_set(&whole).is_none() {
            return Ok(None);
        }
        let config: Self = whole
            .try_into()
            .map_err(|e: toml::de::Error| anyhow::anyhow!("{}: {}", path.display(), e.to_string().trim_end()))?;
        config.validate().with_context(|| path.display().to_string())?;
        Ok(Some(config))
    }

    fn validate(&self) -> anyhow::Result<()> {
        check_name(&self.name)?;
        self.synth.validate()?;
        self.train.validate()?;
        self.colours.validate().map_err(anyhow::Error::msg)?;
        let dataset = &self.dataset;
        for (field, value) in [
            ("training_pairs", dataset.training_pairs),
            ("validation_pairs", dataset.validation_pairs),
        ] {
            if !(1..=MAX_PIXELS).contains(&value) {
                bail!("dataset.{field} = {value}: must be from 1 to {MAX_PIXELS}, a pixel each");
            }
        }
        if dataset.rows_per_pixel != 1 || dataset.refresh != 0.0 {
            bail!("dataset: a network of colours has one row a pixel, all fixed; set rows_per_pixel = 1, refresh = 0");
        }
        Ok(())
    }
}

/// Generates the rows, trains, and writes the network.
pub fn train(config: ColourConfig, arguments: &Train, replace: Replace, ui: &Ui) -> anyhow::Result<Verdict> {
    let mut config = config;
    let options = &arguments.options;
    if arguments.dataset.is_some() {
        bail!("a network of colours trains in a minute from rows made in memory; leave out --dataset");
    }
    let backend = Backend::try_from(options.backend)?;
    backend.adapter().context("--backend")?;
    options.set_epochs(&mut config.train)?;
    keep_inputs(&[&arguments.config], &arguments.out)?;
    let _lock = Lock::acquire(&lock_path_for(&arguments.out))?;
    may_write(&arguments.out, replace)?;
    let checkpoint = path_for(&arguments.out);
    options.settle_checkpoint(&checkpoint)?;
    let synth = Synth::new(config.synth.clone(), config.seed)?;
    let rows = |purpose, pixels: u64| {
        ColourRows::of(
            &synth,
            config.seed,
            purpose,
            pixels as usize,
            config.colours,
            config.dataset.features,
        )
    };
    let dataset = ColourDataset::new(
        rows(Purpose::Training, config.dataset.training_pairs),
        rows(Purpose::Validation, config.dataset.validation_pairs),
    );
    let job = Job {
        name: &config.name,
        config: &config.train,
        seed: config.seed,
        backend,
        checkpoint: &checkpoint,
        resume: options.resume,
        provenance: Provenance::of_this_program(serde_json::to_value(&config).expect("a configuration is plain data")),
    };
    let Some(trained) = with_progress(&dataset, &job, ui)? else {
        return Ok(Verdict::Interrupted);
    };
    let network = &trained.mlp;
    network.save(&arguments.out, replace)?;
    remove_checkpoint(&checkpoint)?;
    let (p, seconds) = (&network.provenance, trained.seconds);
    if ui.json() {
        let result = json!({
            "network": network.shape(), "backend": p.backend, "epochs": p.epochs, "best_epoch": p.best_epoch,
            "training_loss": p.training_loss, "validation_loss": p.validation_loss, "seconds": seconds,
        });
        ui.print_json("train", vec![result])?;
    } else {
        ui.print(&format!(
            "{}: best validation loss {:.3e} in epoch {} of {}, {seconds:.1} s\n{}\n",
            network.shape(),
            p.validation_loss.unwrap_or(f64::NAN),
            p.best_epoch_text().unwrap_or_default(),
            p.epochs_text().unwrap_or_default(),
            arguments.out.display()
        ))?;
    }
    Ok(Verdict::Fine)
}
