//! `nmt bench`: what every benchmark shares, and a file for each.

mod generate;
mod infer;
mod methods;
mod tiles;
mod train;

use super::ui::{Progress, Ui, table};
use super::{Verdict, examples};
use crate::bench::{Measurement, Network, Plan, Summary, comparison};
use crate::features::FeatureSet;
use crate::numeric::file::{Replace, may_write, write_atomically};
use anyhow::{Context, bail};
use clap::{Args, Subcommand};
use serde_json::{Value, json};
use std::path::PathBuf;

#[derive(Args)]
pub struct Bench {
    #[command(subcommand)]
    what: What,
}

#[derive(Subcommand)]
enum What {
    /// Samples a second of every training backend.
    #[command(after_help = examples::BENCH_TRAIN)]
    Train(train::BenchTrain),
    /// Pairs of features and answer a second, from random pixels.
    #[command(after_help = examples::BENCH_GENERATE)]
    Generate(generate::BenchGenerate),
    /// Rows a second that a network answers, against the reference and onnxruntime.
    #[command(after_help = examples::BENCH_INFER)]
    Infer(infer::BenchInfer),
    /// Time of transparency methods and networks on a fragment list against their error, on the CPU and the GPU.
    #[command(after_help = examples::BENCH_METHODS)]
    Methods(methods::BenchMethods),
    /// Time of a frame on the GPU: drawn, in compute passes, and with the network only for the fragments that need it
    /// or can be seen.
    #[command(after_help = examples::BENCH_TILES)]
    Tiles(tiles::BenchTiles),
}

/// Options of every benchmark.
#[derive(Args)]
struct Common {
    /// Repetitions; each runs everything that is compared, one after the other.
    #[arg(long, value_name = "N", default_value_t = 15)]
    repeat: usize,
    /// Least time of a repetition in seconds.
    #[arg(long, value_name = "S", default_value_t = 0.1)]
    sample_seconds: f64,
    /// Threads, instead of one a core.
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
}

/// Where a benchmark's numbers go besides the terminal.
#[derive(Args)]
struct Output {
    /// Folder for results.json, which holds all numbers with their raw samples.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace what is there.
    #[arg(long)]
    force: bool,
}

/// The file that holds all numbers.
const RESULTS: &str = "results.json";

impl Output {
    fn replace(&self) -> Replace {
        if self.force { Replace::Yes } else { Replace::No }
    }

    /// Refuses, before anything is measured, to write over what is there.
    fn check(&self) -> anyhow::Result<()> {
        if let Some(out) = &self.out {
            may_write(&out.join(RESULTS), self.replace())?;
        }
        Ok(())
    }

    /// Writes the numbers, and prints them or the text.
    fn give(&self, ui: &Ui, results: Vec<Value>, text: &str) -> anyhow::Result<Verdict> {
        let json = serde_json::to_string_pretty(&ui.report("bench", results))? + "\n";
        let mut written = String::new();
        if let Some(out) = &self.out {
            let path = out.join(RESULTS);
            write_atomically(&path, self.replace(), |w| w.write_all(json.as_bytes()))?;
            written = format!("{}\n", path.display());
        }
        if ui.json() {
            ui.print(&json)?;
        } else {
            ui.print(&format!("{text}{written}"))?;
        }
        Ok(Verdict::Fine)
    }
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
    let set: Option<FeatureSet> = features.map(str::parse).transpose().context("--features")?;
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
            "warning: {} of {} figures are uncertain; the slowest repetition of {name} took {:.1} times as long as the \
                fastest. Something else may be \
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
        "seconds": s.median, "min_seconds": s.min, "max_seconds": s.max, "mad_seconds": s.mad, "raw_seconds": seconds,
            "calls_per_repetition": calls,
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
        "benchmark": what, "network": m.network, "backend": m.backend, "batch": m.batch, "simd": m.simd,
            "adapter": m.adapter,
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
    let head = [
        "network", "batch", "backend", "simd", unit, "ms", "+- MAD", "of peak", "ratio",
    ];
    let mut rows = vec![cells(head)];
    for group in groups {
        for m in group {
            let s = Summary::of(&m.samples.seconds);
            rows.push(vec![
                m.network.clone(),
                m.batch.to_string(),
                m.backend.to_owned(),
                m.simd.unwrap_or("-").to_owned(),
                millions(m.rows_per_second()),
                milliseconds(s.median),
                milliseconds(s.mad),
                format!("{:.1} %", 100.0 * m.share_of_peak()),
                format!("{:.2}", m.rows_per_second() / group[0].rows_per_second()),
            ]);
        }
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
    let sentences: String = groups
        .iter()
        .map(|group| {
            let samples: Vec<(&str, &[f64])> = group
                .iter()
                .map(|m| (m.backend, m.samples.seconds.as_slice()))
                .collect();
            let of = &group[0];
            let what = (groups.len() > 1).then(|| format!("{}, batch {}: ", of.network, of.batch));
            what.unwrap_or_default() + &comparison(&samples)
        })
        .collect();
    format!(
        "{}Medians of {first} interleaved repetitions on {} threads, with their median absolute deviation (MAD); ms of \
            one call.\n\
         Multiply-add peak {range} GFLOP/s, the best of the same repetitions{on_gpus}.\n\n{sentences}",
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
