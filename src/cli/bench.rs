//! `nmt bench`

mod methods;

use super::Verdict;
use super::config::Config;
use super::train::BackendName;
use super::ui::{Progress, Ui, table};
use crate::bench::train::Streaming;
use crate::bench::{Measurement, Network, Plan, Summary, generate, infer, network, train};
use crate::check::onnx::library;
use crate::dataset::{DatasetConfig, Rows, file as dataset_file};
use crate::features::FeatureSet;
use crate::model::{Mlp, file};
use crate::synth::SynthConfig;
use crate::train::{Backend, Engine};
use anyhow::{Context, bail};
use clap::{Args, Subcommand};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

#[derive(Args)]
pub struct Bench {
    #[command(subcommand)]
    what: What,
}

#[derive(Subcommand)]
enum What {
    /// Samples a second of every training backend.
    Train(BenchTrain),
    /// Pairs of features and answer a second, from random pixels.
    Generate(BenchGenerate),
    /// Rows a second that a network answers, against the reference and onnxruntime.
    Infer(BenchInfer),
    /// Time of transparency methods and networks on a fragment list against their error, on the CPU and the GPU.
    Methods(methods::BenchMethods),
    /// Time of a frame on the GPU: drawn, in compute passes, and with the network only for the fragments that need it or can be seen.
    Tiles(super::bench_tiles::BenchTiles),
}

/// Options of every benchmark.
#[derive(Args)]
struct Common {
    /// Repetitions; what is compared takes turns in each.
    #[arg(long, value_name = "N", default_value_t = 15)]
    repeat: usize,
    /// Least time of a repetition in seconds.
    #[arg(long, value_name = "S", default_value_t = 0.1)]
    sample_seconds: f64,
    /// Threads, instead of one a core.
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
}

#[derive(Args)]
struct BenchTrain {
    /// What computes the gradients [default: fused and burn's backends for the CPU; fused with --stream].
    #[arg(long, value_enum, value_delimiter = ',')]
    backend: Vec<BackendName>,
    /// Train whole epochs of a configuration with fresh pixels, against the same rows in memory and against generation alone.
    #[arg(long, value_name = "CONFIG", conflicts_with_all = ["network", "features", "batch", "rows", "dataset"])]
    stream: Option<PathBuf>,
    /// Sizes of networks; the first chooses the feature set by its width (7 paper, 9 recentred-6, 11 recentred-8).
    #[arg(long, value_name = "SIZES", value_delimiter = ',', default_values = ["7-32-16-1"])]
    network: Vec<String>,
    /// Feature set, instead of the first of that width.
    #[arg(long, value_name = "NAME", conflicts_with = "dataset")]
    features: Option<String>,
    /// Rows of one step, multiples of 16.
    #[arg(long, value_name = "N", value_delimiter = ',', default_values_t = [8192])]
    batch: Vec<usize>,
    /// Random rows in memory; at least one batch is made.
    #[arg(long, value_name = "N", default_value_t = 262_144)]
    rows: usize,
    /// Take the training rows of a dataset that `nmt generate` wrote, instead of random ones.
    #[arg(long, value_name = "DIR", conflicts_with = "rows")]
    dataset: Option<PathBuf>,
    #[command(flatten)]
    common: Common,
}

#[derive(Args)]
struct BenchGenerate {
    /// Configurations whose pixels to draw, instead of the paper's distribution with its features.
    #[arg(long, value_name = "FILE", num_args = 1..)]
    config: Vec<PathBuf>,
    /// Pairs of one call.
    #[arg(long, value_name = "N", default_value_t = 262_144)]
    pairs: usize,
    #[command(flatten)]
    common: Common,
}

#[derive(Args)]
struct BenchInfer {
    /// Sizes of networks with random weights; the first chooses the feature set by its width.
    #[arg(long, value_name = "SIZES", value_delimiter = ',', default_values = ["7-32-16-1"], conflicts_with = "model")]
    network: Vec<String>,
    /// Feature set, instead of the first of that width.
    #[arg(long, value_name = "NAME", conflicts_with = "model")]
    features: Option<String>,
    /// Model files, instead of random weights.
    #[arg(long, value_name = "MODEL.json", num_args = 1..)]
    model: Vec<PathBuf>,
    /// Rows answered in one call.
    #[arg(long, value_name = "N", value_delimiter = ',', default_values_t = [8192, 1_048_576])]
    batch: Vec<usize>,
    #[command(flatten)]
    common: Common,
}

impl Common {
    /// Starts as many threads as are asked for.
    fn prepare(&self) -> anyhow::Result<Plan> {
        let plan = Plan {
            repeat: self.repeat,
            sample_seconds: self.sample_seconds,
        };
        plan.validate().context("--repeat, --sample-seconds")?;
        if let Some(threads) = self.threads {
            if !(1..=4096).contains(&threads) {
                bail!("--threads {threads}: must be from 1 to 4096");
            }
            rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build_global()
                .context("--threads")?;
        }
        Ok(plan)
    }
}

/// Networks of the given sizes, on a feature set of that name where one is given.
fn networks(texts: &[String], features: Option<&str>) -> anyhow::Result<Vec<Network>> {
    let set = match features {
        None => None,
        Some(name) => Some(
            FeatureSet::ALL
                .into_iter()
                .find(|set| set.name() == name)
                .with_context(|| {
                    let names: Vec<&str> = FeatureSet::ALL.iter().map(|set| set.name()).collect();
                    format!(
                        "--features '{name}': no such feature set; there are {}",
                        names.join(", ")
                    )
                })?,
        ),
    };
    let of = |text: &String| {
        let network: Network = text.parse().context("--network")?;
        set.map_or(Ok(network.clone()), |set| network.on(set))
            .context("--features")
    };
    texts.iter().map(of).collect()
}

/// Progress over the repetitions of several measurements, and what is told of them.
struct Turns<'a> {
    ui: &'a Ui,
    progress: Progress,
    repeat: u64,
    done: u64,
}

impl<'a> Turns<'a> {
    fn new(ui: &'a Ui, measurements: usize, plan: Plan) -> Self {
        let repeat = plan.repeat as u64;
        Self {
            ui,
            progress: ui.progress("bench", measurements as u64 * repeat),
            repeat,
            done: 0,
        }
    }

    /// Makes one measurement of `repeat` repetitions.
    fn take<T, E>(&mut self, what: &str, work: impl FnOnce(&dyn Fn(u64)) -> Result<T, E>) -> Result<T, E> {
        let (progress, before) = (&self.progress, self.done);
        progress.set(before, format!("{what}, warming up"));
        let made = work(&|n| progress.set(before + n, what));
        self.done += self.repeat;
        made
    }

    /// Takes the bar away and warns of figures that a restless machine made.
    fn finish(self, results: &[(String, Summary)]) {
        self.progress.finish();
        let restless: Vec<&(String, Summary)> = results.iter().filter(|(_, s)| s.is_restless()).collect();
        let Some((name, worst)) = restless.iter().max_by(|a, b| a.1.spread().total_cmp(&b.1.spread())) else {
            return;
        };
        self.ui.warn(&format!(
            "warning: {} of {} figures are uncertain; the slowest repetition of {name} took {:.1} times as long as the fastest. Something else may be \
             running: stop it and measure again, or try --repeat {} and a longer --sample-seconds",
            restless.len(),
            results.len(),
            worst.spread(),
            3 * self.repeat
        ));
    }
}

/// Median and spread of the seconds of a call, with the raw samples.
fn timing(seconds: &[f64], calls: u64) -> Value {
    let s = Summary::of(seconds);
    json!({
        "seconds": s.median, "min_seconds": s.min, "max_seconds": s.max, "mad_seconds": s.mad, "raw_seconds": seconds, "calls_per_repetition": calls,
        "repetitions": seconds.len(), "threads": rayon::current_num_threads(),
    })
}

/// One object of both.
fn merged(mut first: Value, second: Value) -> Value {
    if let (Value::Object(first), Value::Object(mut second)) = (&mut first, second) {
        first.append(&mut second);
    }
    first
}

fn measurement_json(what: &str, rates: &[&str], m: &Measurement) -> Value {
    let mut object = json!({
        "benchmark": what, "network": m.network, "backend": m.backend, "batch": m.batch, "simd": m.simd, "adapter": m.adapter,
        "gflops": m.gflops(), "share_of_peak": m.share_of_peak(),
        "multiply_add_peak_gflops": m.peak_gflops(), "raw_multiply_add_peak_flops_per_second": m.peak.rates,
    });
    for &rate in rates {
        object[rate] = json!(m.rows_per_second());
    }
    if let Some(worst) = m.worst_difference {
        object["worst_difference"] = json!(worst);
    }
    merged(object, timing(&m.samples.seconds, m.samples.calls))
}

/// A rate: "12.3 M".
fn millions(rate: f64) -> String {
    format!("{:.2} M", rate / 1e6)
}

fn milliseconds(seconds: f64) -> String {
    format!("{:.3}", 1e3 * seconds)
}

fn cells<const N: usize>(texts: [&str; N]) -> Vec<String> {
    texts.map(str::to_owned).to_vec()
}

/// A table of networks, each group against its first.
fn measurement_table(unit: &str, groups: &[Vec<Measurement>]) -> String {
    let mut rows = vec![cells([
        "network", "batch", "backend", "simd", unit, "ms", "min", "max", "MAD", "GFLOP/s", "of peak", "ratio",
    ])];
    for m in groups
        .iter()
        .flat_map(|group| group.iter().map(move |m| (m, &group[0])))
        .map(|(m, first)| {
            let s = Summary::of(&m.samples.seconds);
            vec![
                m.network.clone(),
                m.batch.to_string(),
                m.backend.to_owned(),
                m.simd.unwrap_or("-").to_owned(),
                millions(m.rows_per_second()),
                milliseconds(s.median),
                milliseconds(s.min),
                milliseconds(s.max),
                milliseconds(s.mad),
                format!("{:.1}", m.gflops()),
                format!("{:.1} %", 100.0 * m.share_of_peak()),
                format!("{:.2}", m.rows_per_second() / first.rows_per_second()),
            ]
        })
    {
        rows.push(m);
    }
    let peaks: Vec<f64> = groups.iter().map(|group| group[0].peak_gflops()).collect();
    let peak = Summary::of(&peaks);
    let range = if peaks.len() == 1 {
        format!("{:.1}", peak.median)
    } else {
        format!("{:.1} to {:.1}", peak.min, peak.max)
    };
    let first = groups[0][0].samples.seconds.len();
    let on_gpus: String = groups[0]
        .iter()
        .filter_map(|m| m.adapter.as_ref().map(|name| format!("; {} on {name}", m.backend)))
        .collect();
    format!(
        "{}medians of {first} repetitions by turns on {} threads; ms of one call; multiply-add peak {range} GFLOP/s, the best of the same turns{on_gpus}\n",
        table(&rows),
        rayon::current_num_threads()
    )
}

fn summaries(groups: &[Vec<Measurement>]) -> Vec<(String, Summary)> {
    groups
        .iter()
        .flatten()
        .map(|m| {
            (
                format!("{} on {} rows by {}", m.network, m.batch, m.backend),
                Summary::of(&m.samples.seconds),
            )
        })
        .collect()
}

impl Bench {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        match self.what {
            What::Train(c) => c.execute(ui),
            What::Generate(c) => c.execute(ui),
            What::Infer(c) => c.execute(ui),
            What::Methods(c) => c.execute(ui),
            What::Tiles(c) => c.execute(ui),
        }
    }
}

impl BenchTrain {
    fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
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
        let dataset = super::generate::build(&config, ui)?;
        let mut turns = Turns::new(ui, backends.len(), plan);
        let mut results = Vec::new();
        for &backend in backends {
            let what = format!("{}, {}", config.name, backend.name());
            results.push(turns.take(&what, |progress| {
                train::stream_epochs(plan, &dataset, &config.train, config.seed, backend, progress)
            })?);
        }
        let figures = |s: &Streaming| {
            [
                ("in memory", &s.in_memory),
                ("streamed", &s.streamed),
                ("generation", &s.generation),
            ]
            .map(|(n, s)| (n, s.clone()))
        };
        let all = results
            .iter()
            .flat_map(|s| figures(s).map(|(name, of)| (format!("{name} by {}", s.backend), Summary::of(&of.seconds))));
        turns.finish(&all.collect::<Vec<_>>());
        if ui.json() {
            let of = |s: &Streaming| {
                let [in_memory, generation] = [&s.in_memory, &s.generation].map(|of| Summary::of(&of.rates).median);
                let object = json!({
                    "benchmark": "train", "stream": config.name, "network": s.network, "backend": s.backend, "adapter": s.adapter, "batch": s.batch,
                    "rows": s.rows, "refresh": s.refresh, "samples_per_second": s.samples_per_second(), "in_memory_samples_per_second": in_memory,
                    "pairs_per_second": generation, "bound_samples_per_second": s.bound(), "raw_in_memory_seconds": s.in_memory.seconds,
                    "raw_generation_seconds": s.generation.seconds,
                });
                merged(object, timing(&s.streamed.seconds, s.streamed.calls))
            };
            return ui
                .print_json("bench", results.iter().map(of).collect())
                .map(|()| Verdict::Fine);
        }
        let mut rows = vec![cells([
            "network",
            "batch",
            "backend",
            "rows",
            "rate",
            "ms",
            "min",
            "max",
            "MAD",
            "of memory",
            "of bound",
        ])];
        for s in &results {
            let (training, bound) = (Summary::of(&s.in_memory.rates).median, s.bound());
            for (name, samples) in figures(s) {
                let (time, rate) = (Summary::of(&samples.seconds), Summary::of(&samples.rates).median);
                let share = |of: f64| {
                    if name == "streamed" {
                        format!("{:.2}", rate / of)
                    } else {
                        "-".to_owned()
                    }
                };
                let times = [time.median, time.min, time.max, time.mad].map(milliseconds);
                let head = [
                    s.network.clone(),
                    s.batch.to_string(),
                    s.backend.to_owned(),
                    name.to_owned(),
                    millions(rate),
                ];
                rows.push([head.to_vec(), times.to_vec(), vec![share(training), share(bound)]].concat());
            }
        }
        let (first, threads) = (&results[0], rayon::current_num_threads());
        ui.print(&format!(
            "{}medians of {} repetitions by turns on {threads} threads; rows/s, ms of one call: an epoch of {} rows with its validation, or {:.0} % of as many \
             rows generated; the bound is what both at full speed on the same cores allow\n",
            table(&rows),
            plan.repeat,
            first.rows,
            100.0 * first.refresh
        ))?;
        Ok(Verdict::Fine)
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
        if ui.json() {
            ui.print_json(
                "bench",
                groups
                    .iter()
                    .flatten()
                    .map(|m| measurement_json("train", &["samples_per_second"], m))
                    .collect(),
            )?;
        } else {
            ui.print(&measurement_table("samples/s", &groups))?;
        }
        Ok(Verdict::Fine)
    }
}

impl BenchGenerate {
    fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
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

impl BenchInfer {
    fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        let mlps: Vec<Mlp> = if self.model.is_empty() {
            networks(&self.network, self.features.as_deref())?
                .iter()
                .map(Network::mlp)
                .collect::<Result<_, _>>()?
        } else {
            self.model
                .iter()
                .map(|path| file::load(path))
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
        if ui.json() {
            let rates = ["fragments_per_second", "rows_per_second"];
            ui.print_json(
                "bench",
                groups
                    .iter()
                    .flatten()
                    .map(|m| measurement_json("infer", &rates, m))
                    .collect(),
            )?;
        } else {
            ui.print(&measurement_table("rows/s", &groups))?;
        }
        Ok(Verdict::Fine)
    }
}
