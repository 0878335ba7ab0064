//! `nmt bench infer`

use super::{Common, Output, Turns, measurement_json, measurement_table, networks, summaries};
use crate::bench::{Network, infer, network};
use crate::check::onnx::library;
use crate::cli::Verdict;
use crate::cli::ui::Ui;
use crate::model::{Mlp, shipped};
use anyhow::bail;
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub struct BenchInfer {
    /// Sizes of networks with random weights; the first chooses the feature set by its width.
    #[arg(long, value_name = "SIZES", value_delimiter = ',', num_args = 1.., default_values = ["7-32-16-1"],
        conflicts_with = "model")]
    network: Vec<String>,
    /// Feature set, instead of the first of that width.
    #[arg(long, value_name = "NAME", conflicts_with = "model")]
    features: Option<String>,
    /// Model files, instead of random weights.
    #[arg(long, value_name = "MODEL.json", value_delimiter = ',', num_args = 1..)]
    model: Vec<PathBuf>,
    /// Rows answered in one call.
    #[arg(long, value_name = "N", value_delimiter = ',', num_args = 1.., default_values_t = [8192, 1_048_576])]
    batch: Vec<usize>,
    #[command(flatten)]
    common: Common,
    #[command(flatten)]
    output: Output,
}

impl BenchInfer {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        self.output.check()?;
        let mlps: Vec<Mlp> = if self.model.is_empty() {
            networks(&self.network, self.features.as_deref())?
                .iter()
                .map(Network::mlp)
                .collect::<Result<_, _>>()?
        } else {
            self.model
                .iter()
                .map(|path| shipped::open(path))
                .collect::<Result<_, _>>()?
        };
        if let Some(batch) = self.batch.iter().find(|&&b| b == 0 || b > network::MAX_ROWS) {
            bail!("--batch {batch}: must be from 1 to {}", network::MAX_ROWS);
        }
        let plan = self.common.prepare()?;
        let library = library();
        if let Err(why) = &library {
            ui.warn(&format!("note: not compared with onnxruntime, {why}"));
        }
        let mut turns = Turns::new(ui, mlps.len() * self.batch.len(), plan);
        let mut groups = Vec::new();
        for mlp in &mlps {
            for &batch in &self.batch {
                let what = format!("{}, batch {batch}", mlp.shape());
                groups.push(turns.take(&what, |progress| {
                    infer::infer(plan, mlp, batch, library.as_deref().ok(), progress)
                })?);
            }
        }
        turns.finish(&summaries(&groups));
        let rates = ["fragments_per_second", "rows_per_second"];
        let measured = groups.iter().flatten();
        let json = measured.map(|m| measurement_json("infer", &rates, m)).collect();
        self.output.give(ui, json, &measurement_table("rows/s", &groups))
    }
}
