//! `nmt stress`

mod tables;

use super::Verdict;
use super::ui::{Ui, report};
use crate::model::{Mlp, shipped};
use crate::numeric::file::{Replace, create_folder, may_write, write_atomically};
use crate::stress::bias::{self, BiasPoint};
use crate::stress::rows;
use crate::stress::suite::{self, CHARTS, DEFAULT_METHODS, RandomReport};
use crate::stress::sweep::Point;
use crate::stress::{Case, Report, Subject};
use anyhow::{Context, bail};
use clap::Args;
use serde_json::{Value, json};
use std::path::PathBuf;

#[derive(Args)]
pub struct Stress {
    /// Networks, each run in every arithmetic, storage and format of weights.
    #[arg(long, value_name = "MODEL.json", value_delimiter = ',', num_args = 1..)]
    model: Vec<PathBuf>,
    /// Methods, by name; "all" stands for every classic one, "none" for none.
    #[arg(long, value_delimiter = ',', num_args = 1.., default_values = DEFAULT_METHODS)]
    methods: Vec<String>,
    /// Cases, by name, instead of all.
    #[arg(long, value_name = "NAME", value_delimiter = ',', num_args = 1..)]
    cases: Vec<String>,
    /// Also evaluate every network for so many random fragments, once in one pass and once after a prepass.
    #[arg(long, value_name = "N", default_value_t = 0)]
    random: u64,
    /// Seed of the random fragments.
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Also measure what moment_bias each storage needs.
    #[arg(long)]
    bias: bool,
    /// Also run networks, and the classic methods that have a shader, on the GPU.
    #[arg(long)]
    gpu: bool,
    /// Folder for results.json and for charts of error against half-range, number of fragments and digits of storage.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Random pixels at each place of a chart.
    #[arg(long, value_name = "N", default_value_t = 2000)]
    pixels: usize,
    /// Replace what is there.
    #[arg(long)]
    force: bool,
}

/// The file that holds all numbers.
const RESULTS: &str = "results.json";

/// Least and greatest number of pixels at a place of a chart.
const PIXELS: std::ops::RangeInclusive<usize> = 10..=1_000_000;

impl Stress {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        let replace = if self.force { Replace::Yes } else { Replace::No };
        if let Some(out) = &self.out {
            for name in CHARTS.iter().chain([&RESULTS]) {
                may_write(&out.join(name), replace)?;
            }
        }
        if !PIXELS.contains(&self.pixels) {
            let (min, max) = (PIXELS.start(), PIXELS.end());
            bail!("--pixels {}: must be from {min} to {max}", self.pixels);
        }
        let measured = self.measure(ui)?;
        let broken = measured.broken();
        let results = measured.results();
        if let Some(out) = &self.out {
            create_folder(out)?;
            let text = serde_json::to_string_pretty(&report("stress", results.clone()))? + "\n";
            write_atomically(&out.join(RESULTS), replace, |w| w.write_all(text.as_bytes()))?;
            for (name, svg) in suite::charts(&measured.points) {
                write_atomically(&out.join(name), replace, |w| w.write_all(svg.as_bytes()))?;
            }
        }
        if ui.json() {
            ui.print_json("stress", results)?;
        } else {
            ui.print(&measured.text())?;
            for line in &broken {
                ui.print(&format!("BROKEN {line}\n"))?;
            }
            if broken.is_empty() {
                ui.print("no promise is broken\n")?;
            }
            if let Some(out) = &self.out {
                ui.print(&format!("{}\n", out.display()))?;
            }
        }
        Ok(if broken.is_empty() {
            Verdict::Fine
        } else {
            Verdict::CheckFailed
        })
    }

    /// Runs all that is asked for.
    fn measure(&self, ui: &Ui) -> anyhow::Result<Measured> {
        let mlps: Vec<Mlp> = self
            .model
            .iter()
            .map(|path| shipped::open(path))
            .collect::<Result<_, _>>()?;
        let (networks, mut executions) = (suite::networks(&mlps)?, suite::executions(&mlps)?);
        let classic = suite::classic(&self.methods)?;
        let cases = suite::cases(&self.cases).with_context(|| format!("--cases '{}'", self.cases.join(",")))?;
        if self.gpu {
            executions.extend(suite::on_gpu(&mlps, &self.methods)?);
        }
        let subjects: Vec<&Subject<'_>> = networks.iter().chain(&classic).chain(&executions).collect();
        let progress = ui.progress("stress", (cases.len() * subjects.len()) as u64);
        let reports = suite::run(&cases, &subjects, &|done, case, subject| {
            progress.set(done, format!("{case}: {subject}"))
        });
        progress.finish();
        let features = mlps.iter().map(rows::reports).collect::<Result<Vec<_>, _>>()?.concat();
        let mut random = Vec::new();
        if self.random > 0 {
            let progress = ui.progress("random", self.random);
            random = suite::random(&mlps, self.random, self.seed, &|name, n| progress.set(n, name))?;
            progress.finish();
        }
        let mut points = Vec::new();
        let biases = if self.bias {
            bias::points(self.pixels)
        } else {
            Vec::new()
        };
        if self.out.is_some() {
            let progress = ui.progress("sweep", suite::PLACES as u64);
            points = suite::sweeps(&mlps, self.pixels, &|done, what| progress.set(done, what))?;
            progress.finish();
        }
        Ok(Measured {
            cases,
            reports,
            networks: networks.len(),
            classic: classic.len(),
            features,
            random,
            biases,
            points,
        })
    }
}

/// All that was measured.
struct Measured {
    cases: Vec<Case>,
    /// By subject, then by case: first networks, then classic methods, then other ways of running both.
    reports: Vec<Vec<Report>>,
    networks: usize,
    classic: usize,
    features: Vec<Report>,
    random: Vec<RandomReport>,
    biases: Vec<BiasPoint>,
    points: Vec<Point>,
}

impl Measured {
    /// Promises that were broken, in words.
    fn broken(&self) -> Vec<String> {
        self.reports
            .iter()
            .flatten()
            .chain(&self.features)
            .flat_map(Report::broken)
            .chain(self.random.iter().flat_map(RandomReport::broken))
            .collect()
    }

    /// All tables.
    fn text(&self) -> String {
        let shown = self.networks + self.classic;
        let executions = [&self.reports[..self.networks], &self.reports[shown..]].concat();
        [
            tables::cases(&self.cases, &self.reports[..shown]),
            tables::executions(&executions),
            tables::features(&self.features),
            tables::ranges(&self.points),
            tables::random(&self.random),
            tables::biases(&self.biases),
        ]
        .concat()
    }

    /// A JSON object for each report.
    fn results(&self) -> Vec<Value> {
        let kind = |name: &str, mut value: Value| {
            if let Some(object) = value.as_object_mut() {
                object.insert("kind".to_owned(), name.into());
            }
            value
        };
        let plain = |value: Result<Value, serde_json::Error>| value.expect("results are plain data");
        let mut results = Vec::new();
        let what = |name: &str| {
            self.cases
                .iter()
                .map(|c| (c.name, c.what))
                .chain(rows::KINDS)
                .find(|c| c.0 == name)
                .map(|c| c.1)
        };
        results.extend(
            self.reports
                .iter()
                .flatten()
                .map(|r| ("case", r))
                .chain(self.features.iter().map(|r| ("features", r)))
                .map(|(name, r)| {
                    let mut value = plain(serde_json::to_value(r));
                    value["what"] = json!(what(&r.case));
                    kind(name, value)
                }),
        );
        results.extend(self.random.iter().map(|f| {
            let mut value = plain(serde_json::to_value(f.counts));
            value["method"] = json!(f.network);
            value["frame"] = json!(f.frame);
            value["seconds"] = json!(f.seconds);
            value["fragments_per_second"] = json!(f.counts.fragments as f64 / f.seconds);
            kind("random", value)
        }));
        results.extend(
            self.biases
                .iter()
                .map(|p| kind("moment_bias", plain(serde_json::to_value(p)))),
        );
        results.extend(
            self.points
                .iter()
                .map(|p| kind("sweep", plain(serde_json::to_value(p)))),
        );
        results
    }
}
