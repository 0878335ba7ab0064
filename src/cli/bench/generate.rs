//! `nmt bench generate`

use super::{Common, Turns, cells, merged, millions, milliseconds, timing};
use crate::bench::{Summary, generate};
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
    #[arg(long, value_name = "FILE", num_args = 1..)]
    config: Vec<PathBuf>,
    /// Pairs of one call.
    #[arg(long, value_name = "N", default_value_t = 262_144)]
    pairs: usize,
    #[command(flatten)]
    common: Common,
}

impl BenchGenerate {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
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
        if ui.json() {
            let of = |g: &generate::Generation| {
                let object = json!({
                    "benchmark": "generate", "config": g.name, "features": g.features, "pairs_per_call": self.pairs,
                    "pairs_per_second": Summary::of(&g.samples.rates).median,
                });
                merged(object, timing(&g.samples.seconds, g.samples.calls))
            };
            return ui
                .print_json("bench", results.iter().map(of).collect())
                .map(|()| Verdict::Fine);
        }
        let mut rows = vec![cells(["config", "features", "pairs/s", "ms", "min", "max", "MAD"])];
        for g in &results {
            let s = Summary::of(&g.samples.seconds);
            let times = [s.median, s.min, s.max, s.mad].map(milliseconds);
            rows.push(
                [
                    vec![
                        g.name.clone(),
                        g.features.to_owned(),
                        millions(Summary::of(&g.samples.rates).median),
                    ],
                    times.to_vec(),
                ]
                .concat(),
            );
        }
        let threads = rayon::current_num_threads();
        ui.print(&format!(
            "{}medians of {} repetitions on {threads} threads; ms of {} pairs\n",
            table(&rows),
            plan.repeat,
            self.pairs
        ))?;
        Ok(Verdict::Fine)
    }
}
