//! `nmt generate`

use super::config::Config;
use super::scene::{SceneOptions, load, look_at};
use super::ui::Ui;
use super::{Verdict, keep_inputs, shown, ui};
use crate::dataset::{self, Dataset, file};
use crate::numeric::file::{Replace, may_write};
use crate::pixel::FragmentList;
use crate::scene::npz;
use clap::Args;
use serde_json::json;
use std::ffi::OsStr;
use std::path::PathBuf;
use std::time::Instant;

#[derive(Args)]
pub struct Generate {
    /// Configuration file.
    config: PathBuf,
    /// Folder for the dataset.
    #[arg(long)]
    out: PathBuf,
    /// Write the raw pixels too, as a fragment list: training pixels, then validation pixels.
    #[arg(long, value_name = "F.npz")]
    fragments: Option<PathBuf>,
    /// Take the pixels of these scenes (as `nmt evaluate` names them) instead of random ones.
    #[arg(long, value_name = "F.npz|SCENE", value_delimiter = ',', num_args = 1.., conflicts_with = "fragments")]
    from: Vec<String>,
    #[command(flatten)]
    options: SceneOptions,
    /// Replace what is there.
    #[arg(long)]
    force: bool,
}

impl Generate {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        let replace = if self.force { Replace::Yes } else { Replace::No };
        let config = Config::load(&self.config)?;
        self.from.iter().try_for_each(|scene| look_at(OsStr::new(scene)))?;
        file::may_write_to(&self.out, replace)?;
        if let Some(path) = &self.fragments {
            keep_inputs(&[&self.config], path)?;
            may_write(path, replace)?;
        }
        let start = Instant::now();
        let dataset = if self.from.is_empty() {
            build(&config, ui)?
        } else {
            self.build_from_scenes(&config, ui)?
        };
        let seconds = start.elapsed().as_secs_f64();
        file::write(&self.out, replace, &dataset)?;
        if let Some(path) = &self.fragments
            && let Some([training, validation]) = dataset::pixels_of(&dataset.manifest)?
        {
            npz::write(path, replace, &training.followed_by(&validation))?;
        }
        let pairs = dataset.training.len() + dataset.validation.len();
        let part =
            |name: &str, part: &file::Part| vec![name.to_owned(), part.pixels.to_string(), part.pairs.to_string()];
        if ui.json() {
            ui.print_json(
                "generate",
                vec![json!({
                    "dataset": shown(&self.out), "hash": dataset.manifest.hash,
                        "pairs_per_second": pairs as f64 / seconds, "seconds": seconds,
                    "training_pixels": dataset.manifest.training.pixels,
                        "training_pairs": dataset.manifest.training.pairs,
                    "validation_pixels": dataset.manifest.validation.pixels,
                        "validation_pairs": dataset.manifest.validation.pairs,
                })],
            )?;
        } else {
            ui.print(&ui::table(&[
                ["part", "pixels", "pairs"].map(str::to_owned).to_vec(),
                part("training", &dataset.manifest.training),
                part("validation", &dataset.manifest.validation),
            ]))?;
            ui.print(&format!("hash {}\n{}\n", dataset.manifest.hash, self.out.display()))?;
        }
        Ok(Verdict::Fine)
    }

    fn build_from_scenes(&self, config: &Config, ui: &Ui) -> anyhow::Result<Dataset> {
        let lists = self
            .from
            .iter()
            .map(|name| load(ui, name, &self.options))
            .collect::<anyhow::Result<Vec<_>>>()?;
        let named: Vec<(&str, &FragmentList)> = self.from.iter().map(String::as_str).zip(&lists).collect();
        Ok(dataset::build_from_lists(
            &config.name,
            config.seed,
            &named,
            &config.dataset,
        )?)
    }
}

/// The dataset of a configuration.
pub fn build(config: &Config, ui: &Ui) -> anyhow::Result<Dataset> {
    let progress = ui.progress(
        "generate",
        config.dataset.training_pairs + config.dataset.validation_pairs,
    );
    let built = dataset::build(&config.name, config.seed, &config.synth, &config.dataset, &|n| {
        progress.set(n, "pairs")
    });
    progress.finish();
    Ok(built?)
}
