//! `nmt bench train`

use super::{
    Common, Output, Turns, cells, measurement_json, measurement_table, merged, millions, milliseconds, networks,
    summaries, timing,
};
use crate::bench::train::{self, Streaming};
use crate::bench::{Samples, Summary, network};
use crate::cli::Verdict;
use crate::cli::config::Config;
use crate::cli::train::BackendName;
use crate::cli::ui::{Ui, table};
use crate::dataset::{Rows, file as dataset_file};
use crate::train::{Backend, Engine};
use anyhow::{Context, bail};
use clap::Args;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

#[derive(Args)]
pub struct BenchTrain {
    /// What computes the gradients [default: fused and burn's backends for the CPU; fused with --stream].
    #[arg(long, value_enum, value_delimiter = ',', num_args = 1..)]
    backend: Vec<BackendName>,
    /// Train whole epochs of a configuration with fresh pixels, against the same rows in memory and against generation
    /// alone.
    #[arg(long, value_name = "CONFIG", conflicts_with_all = ["network", "features", "batch", "rows", "dataset"])]
    stream: Option<PathBuf>,
    /// Sizes of networks; the first chooses the feature set by its width (7 paper, 9 recentred-6, 11 recentred-8).
    #[arg(long, value_name = "SIZES", value_delimiter = ',', num_args = 1.., default_values = ["7-32-16-1"])]
    network: Vec<String>,
    /// Feature set, instead of the first of that width.
    #[arg(long, value_name = "NAME", conflicts_with = "dataset")]
    features: Option<String>,
    /// Rows of one step, multiples of 16.
    #[arg(long, value_name = "N", value_delimiter = ',', num_args = 1.., default_values_t = [8192])]
    batch: Vec<usize>,
    /// Random rows in memory; at least one batch is made.
    #[arg(long, value_name = "N", default_value_t = 262_144)]
    rows: usize,
    /// Take the training rows of a dataset that `nmt generate` wrote, instead of random ones.
    #[arg(long, value_name = "DIR", conflicts_with = "rows")]
    dataset: Option<PathBuf>,
    #[command(flatten)]
    common: Common,
    #[command(flatten)]
    output: Output,
}

impl BenchTrain {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        self.output.check()?;
        let mut backends: Vec<Backend> = self
            .backend
            .iter()
            .map(|&name| name.try_into())
            .collect::<Result<_, _>>()
            .context("--backend")?;
        if backends.is_empty() {
            backends.push(Backend::Fused);
            if self.stream.is_none() {
                let on_cpu = |engine: &&Engine| matches!(engine.name(), "flex" | "ndarray");
                backends.extend(Engine::ALL.iter().filter(on_cpu).map(|&engine| Backend::Burn(engine)));
            }
        }
        for &backend in &backends {
            backend.adapter().context("--backend")?;
        }
        match &self.stream {
            Some(config) => self.streamed(config, &backends, ui),
            None => self.in_memory(&backends, ui),
        }
    }

    fn streamed(&self, config: &Path, backends: &[Backend], ui: &Ui) -> anyhow::Result<Verdict> {
        let config = Config::load(config)?;
        if config.dataset.refresh == 0.0 {
            bail!(
                "--stream: dataset.refresh of '{}' is 0, so nothing is streamed; set it above 0",
                config.name
            );
        }
        let plan = self.common.prepare()?;
        let dataset = crate::cli::generate::build(&config, ui)?;
        let mut turns = Turns::new(ui, backends.len(), plan);
        let mut results = Vec::new();
        for &backend in backends {
            let what = format!("{}, {}", config.name, backend.name());
            results.push(turns.take(&what, |progress| {
                train::stream_epochs(plan, &dataset, &config.train, config.seed, backend, progress)
            })?);
        }
        let all = results
            .iter()
            .flat_map(|s| figures(s).map(|(name, of)| (format!("{name} by {}", s.backend), Summary::of(&of.seconds))));
        turns.finish(&all.collect::<Vec<_>>());
        let json = results.iter().map(|s| streaming_json(&config.name, s)).collect();
        self.output.give(ui, json, &streaming_text(&results, plan.repeat))
    }

    fn in_memory(&self, backends: &[Backend], ui: &Ui) -> anyhow::Result<Verdict> {
        let networks = networks(&self.network, self.features.as_deref())?;
        if let Some(batch) = self.batch.iter().find(|&&b| b == 0 || b > network::MAX_ROWS) {
            bail!(
                "--batch {batch}: must be a multiple of 16, from 16 to {}",
                network::MAX_ROWS
            );
        }
        if self.rows > network::MAX_ROWS {
            bail!("--rows {}: must be at most {}", self.rows, network::MAX_ROWS);
        }
        let given = match &self.dataset {
            Some(folder) => Some(dataset_file::read_from(folder)?.training),
            None => None,
        };
        let plan = self.common.prepare()?;
        let mut turns = Turns::new(ui, networks.len() * self.batch.len(), plan);
        let mut groups = Vec::new();
        for network in &networks {
            for &batch in &self.batch {
                let random: Option<Rows> = given
                    .is_none()
                    .then(|| network::random_rows(network.feature_set(), self.rows.max(batch).next_multiple_of(batch)));
                let rows = given.as_ref().or(random.as_ref()).expect("one of the two");
                groups.push(turns.take(&format!("{network}, batch {batch}"), |progress| {
                    train::train(plan, network, backends, rows, batch, progress)
                })?);
            }
        }
        turns.finish(&summaries(&groups));
        let measured = groups.iter().flatten();
        let json = measured
            .map(|m| measurement_json("train", &["samples_per_second"], m))
            .collect();
        self.output.give(ui, json, &measurement_table("samples/s", &groups))
    }
}

/// What was measured of a configuration, by name.
fn figures(s: &Streaming) -> [(&'static str, &Samples); 3] {
    [
        ("in memory", &s.in_memory),
        ("streamed", &s.streamed),
        ("generation", &s.generation),
    ]
}

fn streaming_json(name: &str, s: &Streaming) -> Value {
    let [in_memory, generation] = [&s.in_memory, &s.generation].map(|of| Summary::of(&of.rates).median);
    let object = json!({
        "benchmark": "train", "stream": name, "network": s.network, "backend": s.backend, "adapter": s.adapter,
        "batch": s.batch, "rows": s.rows, "refresh": s.refresh, "samples_per_second": s.samples_per_second(),
        "in_memory_samples_per_second": in_memory, "pairs_per_second": generation,
            "bound_samples_per_second": s.bound(),
        "raw_in_memory_seconds": s.in_memory.seconds, "raw_generation_seconds": s.generation.seconds,
    });
    merged(object, timing(&s.streamed.seconds, s.streamed.calls))
}

fn streaming_text(results: &[Streaming], repeat: usize) -> String {
    let head = ["backend", "rows", "rows/s", "ms", "+- MAD", "of memory", "of bound"];
    let mut rows = vec![cells(head)];
    for s in results {
        let (training, bound) = (Summary::of(&s.in_memory.rates).median, s.bound());
        for (name, samples) in figures(s) {
            let (time, rate) = (Summary::of(&samples.seconds), Summary::of(&samples.rates).median);
            let share = |of: f64| match name {
                "streamed" => format!("{:.2}", rate / of),
                _ => "-".to_owned(),
            };
            rows.push(vec![
                s.backend.to_owned(),
                name.to_owned(),
                millions(rate),
                milliseconds(time.median),
                milliseconds(time.mad),
                share(training),
                share(bound),
            ]);
        }
    }
    let (first, threads) = (&results[0], rayon::current_num_threads());
    format!(
        "{}, batch {}\n{}Medians of {repeat} interleaved repetitions on {threads} threads, with their median absolute \
            deviation (MAD).\n\
         A call is an epoch of {} rows with its validation, or {:.0} % of as many rows generated.\n\
         The bound is what training and generation, both at full speed on the same cores, allow.\n",
        first.network,
        first.batch,
        table(&rows),
        first.rows,
        100.0 * first.refresh
    )
}
