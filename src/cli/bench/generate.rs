//! `nmt bench generate`

use super::{Common, Output, Turns, cells, merged, millions, milliseconds, timing};
use crate::bench::{Summary, comparison, generate};
use crate::cli::Verdict;
use crate::cli::config::Config;
use crate::cli::ui::{Ui, table};
use crate::dataset::DatasetConfig;
use crate::features::FeatureSet;
use crate::synth::SynthConfig;
use clap::Args;
use serde_json::json;
use std::path::PathBuf;

#[derive(Args)]
pub struct BenchGenerate {
    /// Configurations whose pixels to draw, instead of the paper's distribution with its features.
    #[arg(long, value_name = "FILE", value_delimiter = ',', num_args = 1..)]
    config: Vec<PathBuf>,
    /// Pairs of one call.
    #[arg(long, value_name = "N", default_value_t = 262_144)]
    pairs: usize,
    #[command(flatten)]
    common: Common,
    #[command(flatten)]
    output: Output,
}

impl BenchGenerate {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        self.output.check()?;
        let sources = if self.config.is_empty() {
            let dataset = DatasetConfig::of(FeatureSet::Paper, 1, 1);
            vec![generate::Source {
                name: "paper".to_owned(),
                seed: 1,
                synth: SynthConfig::paper(),
                dataset,
            }]
        } else {
            let load = |path: &PathBuf| {
                let Config {
                    name,
                    seed,
                    synth,
                    dataset,
                    ..
                } = Config::load(path)?;
                anyhow::Ok(generate::Source {
                    name,
                    seed,
                    synth,
                    dataset,
                })
            };
            self.config.iter().map(load).collect::<anyhow::Result<_>>()?
        };
        let plan = self.common.prepare()?;
        let mut turns = Turns::new(ui, 1, plan);
        let results = turns.take("pixels", |progress| {
            generate::generate(plan, &sources, self.pairs, progress)
        })?;
        turns.finish(
            &results
                .iter()
                .map(|g| (g.name.clone(), Summary::of(&g.samples.seconds)))
                .collect::<Vec<_>>(),
        );
        let of = |g: &generate::Generation| {
            let object = json!({
                "benchmark": "generate", "config": g.name, "features": g.features, "pairs_per_call": self.pairs,
                "pairs_per_second": Summary::of(&g.samples.rates).median,
            });
            merged(object, timing(&g.samples.seconds, g.samples.calls))
        };
        let json = results.iter().map(of).collect();
        let mut rows = vec![cells(["config", "features", "pairs/s", "ms", "+- MAD"])];
        for g in &results {
            let s = Summary::of(&g.samples.seconds);
            rows.push(vec![
                g.name.clone(),
                g.features.to_owned(),
                millions(Summary::of(&g.samples.rates).median),
                milliseconds(s.median),
                milliseconds(s.mad),
            ]);
        }
        let samples: Vec<(&str, &[f64])> = results
            .iter()
            .map(|g| (g.name.as_str(), g.samples.seconds.as_slice()))
            .collect();
        let text = format!(
            "{}Medians of {} interleaved repetitions on {} threads, with their median absolute deviation (MAD); ms of \
                {} pairs.\n{}",
            table(&rows),
            plan.repeat,
            rayon::current_num_threads(),
            self.pairs,
            comparison(&samples)
        );
        self.output.give(ui, json, &text)
    }
}
