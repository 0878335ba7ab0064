//! `nmt stress`

use super::Verdict;
use super::ui::{Ui, report, table};
use crate::export::Format;
use crate::features::{FeatureSet, MomentFrame};
use crate::gpu::{self, Gpu, MethodShader};
use crate::model::{Mlp, file};
use crate::numeric::file::{Replace, create_folder, may_write, write_atomically};
use crate::oit::{Method, all_names, parse};
use crate::stress::bias::{self, BiasPoint, Kept};
use crate::stress::plot::{Chart, Line};
use crate::stress::random::{Counts, hunt};
use crate::stress::rows;
use crate::stress::subject::{TwoMoments, with_digits};
use crate::stress::sweep::{self, Point};
use crate::stress::{Case, Classic, Doubles, Execution, Fragments, Promise, Report, Subject, measure};
use anyhow::bail;
use clap::Args;
use serde_json::{Value, json};
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::time::Instant;

#[derive(Args)]
pub struct Stress {
    /// Networks, each run in every arithmetic, storage and format of weights.
    #[arg(long, value_name = "MODEL.json", num_args = 1..)]
    model: Vec<PathBuf>,
    /// Methods, by name; "all" stands for every classic one, "none" for none.
    #[arg(long, value_delimiter = ',', default_values = DEFAULT_METHODS)]
    methods: Vec<String>,
    /// Cases, by name, instead of all.
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    cases: Vec<String>,
    /// Also ask every network about so many random fragments, once in one pass and once after a prepass.
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

/// What networks are put beside.
const DEFAULT_METHODS: [&str; 9] = [
    "moment-power-4:f32",
    "moment-power-8:f32",
    "moment-trig-4:f32",
    "moment-power-4:unorm16",
    "moment-power-8:unorm16",
    "moment-trig-4:unorm16",
    "moment-power-4:f32+own",
    "moment-trig-4:f32+own",
    "moment-power-4:unorm16+own",
];

/// Methods drawn in charts beside the networks.
const DRAWN_METHODS: [&str; 5] = [
    "moment-power-4:f32",
    "moment-power-8:f32",
    "moment-trig-4:f32",
    "moment-power-4:unorm16",
    "moment-power-4:f32+own",
];

/// Files in the folder.
const RESULTS: &str = "results.json";
const CHARTS: [&str; 3] = ["range.svg", "count.svg", "digits.svg"];

/// Columns of a terminal that tables stay within where they can.
const WIDTH: usize = 140;

/// Least and greatest number of pixels at a place of a chart.
const PIXELS: std::ops::RangeInclusive<usize> = 10..=1_000_000;

/// Fragments of the longest pixels of a chart stay below this.
const MAX_CHART_FRAGMENTS: usize = 200_000;

/// Random fragments of a network, in one frame.
struct Found {
    network: String,
    frame: MomentFrame,
    counts: Counts,
    promise: Promise,
    seconds: f64,
}

impl Found {
    fn broken(&self) -> Vec<String> {
        let c = &self.counts;
        let ends = self.promise == Promise::Ends;
        let kinds = [
            (true, c.nonfinite, "are not finite"),
            (true, c.out_of_range, "are outside [0, 1]"),
            (ends, c.nearest_not_one, "to the nearest fragment are not 1"),
            (ends, c.single_not_one, "to a single fragment are not 1"),
        ];
        let of = |(promised, count, what): (bool, u64, &str)| {
            (promised && count > 0)
                .then(|| format!("{}: random: {count} of {} answers {what}", self.network, c.fragments))
        };
        kinds.into_iter().filter_map(of).collect()
    }
}

impl Stress {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        let replace = if self.force { Replace::Yes } else { Replace::No };
        if let Some(out) = &self.out {
            for name in CHARTS.iter().chain([&RESULTS]) {
                may_write(&out.join(name), replace)?;
            }
        }
        if !PIXELS.contains(&self.pixels) {
            bail!(
                "--pixels {}: must be from {} to {}",
                self.pixels,
                PIXELS.start(),
                PIXELS.end()
            );
        }
        let mlps: Vec<Mlp> = self
            .model
            .iter()
            .map(|path| file::load(path))
            .collect::<Result<_, _>>()?;
        let (networks, executions, classic) = (plain(&mlps)?, executions(&mlps)?, self.classic()?);
        let cases = self.cases()?;
        let on_gpu = if self.gpu { self.on_gpu(&mlps)? } else { Vec::new() };
        let executions = [executions, on_gpu].into_iter().flatten().collect::<Vec<_>>();
        let subjects: Vec<&Subject<'_>> = networks.iter().chain(&classic).chain(&executions).collect();
        let reports = run(ui, &cases, &subjects);
        let features: Vec<Report> = mlps.iter().map(rows::reports).collect::<Result<Vec<_>, _>>()?.concat();
        let found = self.random(ui, &mlps)?;
        let biases = if self.bias {
            bias::points(self.pixels)
        } else {
            Vec::new()
        };
        let points = if self.out.is_some() {
            self.sweeps(ui, &mlps)?
        } else {
            Vec::new()
        };

        let broken: Vec<String> = reports
            .iter()
            .flatten()
            .chain(&features)
            .flat_map(Report::broken)
            .chain(found.iter().flat_map(Found::broken))
            .collect();
        let results = results(&cases, &reports, &features, &found, &biases, &points);
        if let Some(out) = &self.out {
            create_folder(out)?;
            let text = serde_json::to_string_pretty(&report("stress", results.clone()))? + "\n";
            write_atomically(&out.join(RESULTS), replace, |w| w.write_all(text.as_bytes()))?;
            charts(out, replace, &points)?;
        }
        if ui.json() {
            ui.print_json("stress", results)?;
        } else {
            let shown = networks.len() + classic.len();
            ui.print(&case_tables(&cases, &reports[..shown]))?;
            ui.print(&execution_table(
                &[&reports[..networks.len()], &reports[shown..]].concat(),
            ))?;
            ui.print(&feature_table(&features))?;
            ui.print(&range_table(&points))?;
            ui.print(&random_table(&found))?;
            ui.print(&bias_table(&biases))?;
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

    fn cases(&self) -> anyhow::Result<Vec<Case>> {
        let mut cases = Case::all();
        if !self.cases.is_empty() {
            let names: Vec<&str> = cases.iter().map(|c| c.name).collect();
            if let Some(unknown) = self.cases.iter().find(|name| !names.contains(&name.as_str())) {
                bail!(
                    "--cases '{unknown}': there is no such case; there are {}",
                    names.join(", ")
                );
            }
            cases.retain(|c| self.cases.iter().any(|name| name == c.name));
        }
        Ok(cases)
    }

    /// Classic methods: those asked for as they are, and beside the usual ones the same with all their arithmetic in single precision.
    fn classic(&self) -> anyhow::Result<Vec<Subject<'static>>> {
        let mut subjects = Vec::new();
        let mut seen = HashSet::new();
        for name in self.methods.iter().filter(|name| *name != "none") {
            let names = if name == "all" { all_names() } else { vec![name.clone()] };
            for name in names {
                if seen.insert(name.clone()) {
                    subjects.push(classic(&name)?);
                }
            }
        }
        if self.methods == DEFAULT_METHODS || self.methods.iter().any(|name| name == "all") {
            subjects.extend(Classic::ALL.map(Classic::subject));
        }
        Ok(subjects)
    }

    /// Both passes in compute shaders, by the sources that `nmt export` writes.
    fn on_gpu(&self, mlps: &[Mlp]) -> anyhow::Result<Vec<Subject<'static>>> {
        let gpu = Gpu::shared()?;
        let run = |shader: MethodShader| {
            move |f: &Fragments| {
                let list = f.list().map_err(|e| e.to_string())?;
                let weights = gpu::list::weights(gpu, &shader, &list, f.context.planes, f.context.depth_range)
                    .map_err(|e| e.to_string())?;
                Ok(weights.into_iter().map(f64::from).collect())
            }
        };
        let mut subjects = Vec::new();
        for mlp in mlps
            .iter()
            .filter(|mlp| mlp.feature_set() != FeatureSet::DeepWeightedBlended)
        {
            let promise = Subject::network(mlp, Execution::default())?.promise;
            let shader = MethodShader::neural(mlp, Format::Wgsl)?;
            subjects.push(
                Subject::new(format!("{} @ {}", shader.name, gpu.name()), promise, run(shader))
                    .with_network_as_double(mlp),
            );
        }
        let mut names: Vec<String> = Vec::new();
        for name in &self.methods {
            let plain = name.replace(":f32", "");
            if !names.contains(&plain) {
                names.push(plain);
            }
        }
        for name in names {
            let Some(shader) = MethodShader::classic(&name) else {
                continue;
            };
            let promise = if name.ends_with("+own") {
                Promise::Ends
            } else {
                Promise::None
            };
            subjects.push(
                Subject::new(format!("{name} @ {}", gpu.name()), promise, run(shader))
                    .with_method_as_double(parse(&name)?),
            );
        }
        Ok(subjects)
    }

    fn random(&self, ui: &Ui, mlps: &[Mlp]) -> anyhow::Result<Vec<Found>> {
        let mut found = Vec::new();
        if self.random == 0 {
            return Ok(found);
        }
        for mlp in mlps {
            let plain = Subject::network(mlp, Execution::default())?;
            let frames = if plain.promise == Promise::Ends {
                &[MomentFrame::Scene, MomentFrame::Pixel][..]
            } else {
                &[MomentFrame::Scene]
            };
            for &frame in frames {
                let subject = Subject::network(
                    mlp,
                    Execution {
                        frame,
                        ..Execution::default()
                    },
                )?;
                let progress = ui.progress("random", self.random);
                let start = Instant::now();
                let counts = hunt(mlp, frame, self.random, self.seed, &|n| {
                    progress.set(n, subject.name.as_str())
                })?;
                progress.finish();
                let seconds = start.elapsed().as_secs_f64();
                found.push(Found {
                    network: subject.name,
                    frame,
                    counts,
                    promise: subject.promise,
                    seconds,
                });
            }
        }
        Ok(found)
    }

    /// Every place of the three charts.
    fn sweeps(&self, ui: &Ui, mlps: &[Mlp]) -> anyhow::Result<Vec<Point>> {
        let prepass = Execution {
            frame: MomentFrame::Pixel,
            ..Execution::default()
        };
        let mut subjects = Vec::new();
        for mlp in mlps {
            subjects.push(Subject::network(mlp, Execution::default())?);
            if subjects.last().is_some_and(|s| s.promise == Promise::Ends) {
                subjects.push(Subject::network(mlp, prepass)?);
            }
        }
        let recentred = mlps
            .iter()
            .find(|mlp| Subject::network(mlp, Execution::default()).is_ok_and(|s| s.promise == Promise::Ends));
        let first = recentred.filter(|mlp| mlp.feature_set().moments() == 4);
        subjects.extend(first.map(|mlp| TwoMoments::Beta.subject(mlp)));
        subjects.extend(recentred.map(|mlp| TwoMoments::Bounds.subject(mlp)));
        for name in DRAWN_METHODS {
            subjects.push(classic(name)?);
        }
        let places = sweep::HALF_RANGES.len() + sweep::COUNTS.len() + sweep::DIGITS.len();
        let progress = ui.progress("sweep", places as u64);
        let mut points = Vec::new();
        let mut done = 0;
        let mut step = |what: &str| {
            progress.set(done, what);
            done += 1;
        };
        for half in sweep::HALF_RANGES {
            step("half-range");
            points.extend(sweep::points(
                "half_range",
                half,
                &sweep::of_half_range(half, self.pixels),
                &subjects,
            ));
        }
        for n in sweep::COUNTS {
            step("number of fragments");
            let pixels = self.pixels.min(MAX_CHART_FRAGMENTS / n as usize).max(10);
            points.extend(sweep::points(
                "fragments_per_pixel",
                n.into(),
                &sweep::of_count(n, pixels),
                &subjects,
            ));
        }
        let usual = sweep::usual(self.pixels);
        for digits in sweep::DIGITS {
            step("digits");
            let mut subjects = Vec::new();
            for mlp in mlps
                .iter()
                .filter(|mlp| Subject::network(mlp, Execution::default()).is_ok_and(|s| s.promise == Promise::Ends))
            {
                subjects.extend([MomentFrame::Scene, MomentFrame::Pixel].map(|frame| with_digits(mlp, digits, frame)));
            }
            subjects.extend(Classic::power_with_digits(digits));
            points.extend(sweep::points("storage_digits", digits.into(), &usual, &subjects));
        }
        progress.finish();
        Ok(points)
    }
}

/// A classic method by its name, with what it would be without the rounding of its storage.
fn classic(name: &str) -> anyhow::Result<Subject<'static>> {
    let plain = [":f32", ":unorm16", ":nlqm"]
        .iter()
        .fold(name.to_owned(), |name, suffix| name.replace(suffix, ""));
    let double: Option<Box<dyn Method>> = if plain == name { None } else { Some(parse(&plain)?) };
    Ok(Subject::method(parse(name)?, double))
}

fn plain(mlps: &[Mlp]) -> anyhow::Result<Vec<Subject<'static>>> {
    mlps.iter()
        .map(|mlp| Ok(Subject::network(mlp, Execution::default())?))
        .collect()
}

/// Networks in all ways but the usual one.
fn executions(mlps: &[Mlp]) -> anyhow::Result<Vec<Subject<'static>>> {
    let mut subjects = Vec::new();
    for mlp in mlps {
        for execution in Execution::all(mlp.feature_set())
            .into_iter()
            .filter(|e| *e != Execution::default())
        {
            subjects.push(Subject::network(mlp, execution)?);
        }
    }
    Ok(subjects)
}

/// Reports by subject, then by case.
fn run(ui: &Ui, cases: &[Case], subjects: &[&Subject<'_>]) -> Vec<Vec<Report>> {
    let progress = ui.progress("stress", (cases.len() * subjects.len()) as u64);
    let mut reports: Vec<Vec<Report>> = subjects.iter().map(|_| Vec::new()).collect();
    let mut done = 0;
    for case in cases {
        let mut doubles = Doubles::default();
        for (subject, reports) in subjects.iter().zip(&mut reports) {
            progress.set(done, format!("{}: {}", case.name, subject.name));
            reports.push(measure(case, subject, &mut doubles));
            done += 1;
        }
    }
    progress.finish();
    reports
}

fn results(
    cases: &[Case],
    reports: &[Vec<Report>],
    features: &[Report],
    found: &[Found],
    biases: &[BiasPoint],
    points: &[Point],
) -> Vec<Value> {
    let kind = |name: &str, mut value: Value| {
        if let Some(object) = value.as_object_mut() {
            object.insert("kind".to_owned(), name.into());
        }
        value
    };
    let plain = |value: Result<Value, serde_json::Error>| value.expect("results are plain data");
    let mut results = Vec::new();
    let what = |name: &str| {
        cases
            .iter()
            .map(|c| (c.name, c.what))
            .chain(rows::KINDS)
            .find(|c| c.0 == name)
            .map(|c| c.1)
    };
    results.extend(
        reports
            .iter()
            .flatten()
            .map(|r| ("case", r))
            .chain(features.iter().map(|r| ("features", r)))
            .map(|(name, r)| {
                let mut value = plain(serde_json::to_value(r));
                value["what"] = json!(what(&r.case));
                kind(name, value)
            }),
    );
    results.extend(found.iter().map(|f| {
        let mut value = plain(serde_json::to_value(f.counts));
        value["method"] = json!(f.network);
        value["frame"] = json!(f.frame);
        value["seconds"] = json!(f.seconds);
        value["fragments_per_second"] = json!(f.counts.fragments as f64 / f.seconds);
        kind("random", value)
    }));
    results.extend(
        biases
            .iter()
            .map(|p| kind("moment_bias", plain(serde_json::to_value(p)))),
    );
    results.extend(points.iter().map(|p| kind("sweep", plain(serde_json::to_value(p)))));
    results
}

/// A number of three digits: 0.031, 4e-7.
fn short(x: Option<f64>) -> String {
    match x {
        None => "-".to_owned(),
        Some(0.0) => "0".to_owned(),
        Some(x) if (0.0095..100.0).contains(&x) => format!("{x:.2}"),
        Some(x) => format!("{x:.0e}"),
    }
}

fn percent(share: f64) -> String {
    if share < 1e-3 {
        "<0.1%".to_owned()
    } else {
        format!("{:.1}%", 100.0 * share)
    }
}

/// Root mean square and worst error, and a mark for what is not finite or out of range.
fn cell(report: &Report) -> String {
    if report.refused.is_some() {
        return "refused".to_owned();
    }
    let mut text = match (report.mse, report.worst_error) {
        (None, None) => "-".to_owned(),
        (mse, worst) => format!("{} {}", short(mse.map(f64::sqrt)), short(worst)),
    };
    let share = |count: u64| percent(count as f64 / report.fragments.max(1) as f64);
    if report.nonfinite > 0 {
        text += &format!(" NaN {}", share(report.nonfinite));
    }
    if report.out_of_range > 0 {
        text += &format!(" out {}", share(report.out_of_range));
    }
    text
}

/// Cases by methods, as many methods side by side as fit.
fn case_tables(cases: &[Case], reports: &[Vec<Report>]) -> String {
    let mut columns: Vec<Vec<String>> = vec![
        std::iter::once("case".to_owned())
            .chain(cases.iter().map(|c| c.name.to_owned()))
            .collect(),
    ];
    for of_subject in reports.iter().filter(|r| !r.is_empty()) {
        columns.push(
            std::iter::once(of_subject[0].method.clone())
                .chain(of_subject.iter().map(cell))
                .collect(),
        );
    }
    let width = |column: &Vec<String>| column.iter().map(|t| t.chars().count()).max().unwrap_or(0) + 2;
    let mut text =
        "error of T, root mean square and worst over the finite answers; NaN, out: shares of answers that are not finite, outside [0, 1]\n\n"
            .to_owned();
    let mut next = 1;
    while next < columns.len() {
        let mut end = next + 1;
        let mut taken = width(&columns[0]) + width(&columns[next]);
        while end < columns.len() && taken + width(&columns[end]) <= WIDTH {
            taken += width(&columns[end]);
            end += 1;
        }
        let block: Vec<&Vec<String>> = std::iter::once(&columns[0]).chain(&columns[next..end]).collect();
        let rows: Vec<Vec<String>> = (0..=cases.len())
            .map(|i| block.iter().map(|c| c[i].clone()).collect())
            .collect();
        text += &table(&rows);
        text += "\n";
        next = end;
    }
    let what: Vec<Vec<String>> = std::iter::once(["case", "what it is"])
        .chain(cases.iter().map(|c| [c.name, c.what]))
        .map(cells)
        .collect();
    text + &table(&what) + "\n"
}

fn cells<const N: usize>(texts: [&str; N]) -> Vec<String> {
    texts.map(str::to_owned).to_vec()
}

/// Feature rows by formats of weights.
fn feature_table(reports: &[Report]) -> String {
    if reports.is_empty() {
        return String::new();
    }
    let mut rows = vec![cells([
        "features alone",
        "rows",
        "not finite",
        "out of range",
        "worst against f64",
        "rms against f64",
    ])];
    for r in reports {
        let counts = [r.fragments, r.nonfinite, r.out_of_range].map(|n| n.to_string());
        let errors = [short(r.worst_rounding), short(r.rounding_mse.map(f64::sqrt))];
        rows.push(
            [
                vec![format!("{}: {}", r.method, r.case)],
                counts.to_vec(),
                errors.to_vec(),
            ]
            .concat(),
        );
    }
    format!("{}\n", table(&rows))
}

/// Cases whose errors the ways of running a network are compared by.
const TELLING: [&str; 6] = [
    "usual",
    "thin",
    "far-from-origin",
    "many-faint",
    "extreme-absorbance",
    "window-depth",
];

/// Ways of running networks, a row each.
fn execution_table(reports: &[Vec<Report>]) -> String {
    let mut rows = vec![vec![
        "network".to_owned(),
        "not finite".to_owned(),
        "out of range".to_owned(),
        "pair, worst".to_owned(),
    ]];
    rows[0].extend(TELLING.map(str::to_owned));
    rows[0].extend(["order spread", "rises"].map(str::to_owned));
    for of_subject in reports.iter().filter(|r| !r.is_empty()) {
        let sum = |of: fn(&Report) -> u64| of_subject.iter().map(of).sum::<u64>();
        let case = |name: &str| of_subject.iter().find(|r| r.case == name && r.refused.is_none());
        let mut row = vec![
            of_subject[0].method.clone(),
            sum(|r| r.nonfinite).to_string(),
            sum(|r| r.out_of_range).to_string(),
        ];
        row.push(short(case("pair").and_then(|r| r.worst_error)));
        row.extend(TELLING.map(|name| {
            case(name).and_then(|r| r.mse).map_or("-".to_owned(), |mse| {
                if mse < 100.0 {
                    format!("{:.4}", mse.sqrt())
                } else {
                    short(Some(mse.sqrt()))
                }
            })
        }));
        row.push(short(of_subject.iter().map(|r| r.order_spread).reduce(f64::max)));
        row.push(percent(sum(|r| r.rises) as f64 / sum(|r| r.fragments).max(1) as f64));
        rows.push(row);
    }
    if rows.len() == 1 {
        return String::new();
    }
    format!(
        "ways of running a network: answers over all cases, then errors of T as root mean squares; order spread is the greatest difference that another order makes, \
         rises the share of fragments with more light than one in front of them\n\n{}\n",
        table(&rows)
    )
}

/// What rounding adds along the half-range.
fn range_table(points: &[Point]) -> String {
    let of_range: Vec<&Point> = points.iter().filter(|p| p.sweep == "half_range").collect();
    let Some(first) = of_range.first() else {
        return String::new();
    };
    let methods: Vec<&Point> = of_range.iter().copied().take_while(|p| p.x == first.x).collect();
    let mut rows = vec![
        std::iter::once("half-range".to_owned())
            .chain(methods.iter().map(|p| p.method.clone()))
            .collect::<Vec<_>>(),
    ];
    for line in of_range.chunks(methods.len()) {
        let cell = |p: &&Point| {
            let mse = p.mse.map_or("-".to_owned(), |mse| format!("{mse:.2e}"));
            let added = p
                .added()
                .map_or(String::new(), |added| format!(" {:+.0}%", 100.0 * added));
            let nan = if p.nonfinite > 0 {
                format!(" NaN {}", percent(p.nonfinite as f64 / p.fragments as f64))
            } else {
                String::new()
            };
            format!("{mse}{added}{nan}")
        };
        rows.push(
            std::iter::once(format!("{}", line[0].x))
                .chain(line.iter().map(cell))
                .collect(),
        );
    }
    // Methods in rows where they are many.
    let turned: Vec<Vec<String>> = (0..rows[0].len())
        .map(|i| rows.iter().step_by(3).map(|row| row[i].clone()).collect())
        .collect();
    format!(
        "T-MSE by half-range of the pixel in moment depth, and what rounding adds to it\n\n{}\n",
        table(&turned)
    )
}

fn random_table(found: &[Found]) -> String {
    if found.is_empty() {
        return String::new();
    }
    let head = [
        "random fragments",
        "fragments",
        "evaluated",
        "not finite",
        "out of range",
        "nearest not 1",
        "single not 1",
        "M/s",
    ];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for f in found {
        let c = &f.counts;
        let counts = [
            c.fragments,
            c.evaluated,
            c.nonfinite,
            c.out_of_range,
            c.nearest_not_one,
            c.single_not_one,
        ]
        .map(|n| n.to_string());
        let rate = format!("{:.1}", c.fragments as f64 / f.seconds / 1e6);
        rows.push([vec![f.network.clone()], counts.to_vec(), vec![rate]].concat());
    }
    format!("{}\n", table(&rows))
}

/// Strengths in rows, number of moments and storage in columns.
fn bias_table(biases: &[BiasPoint]) -> String {
    if biases.is_empty() {
        return String::new();
    }
    let mut columns: Vec<(usize, Kept)> = Vec::new();
    let mut strengths: Vec<f64> = Vec::new();
    for p in biases {
        if !columns.contains(&(p.moments, p.storage)) {
            columns.push((p.moments, p.storage));
        }
        if !strengths.contains(&p.moment_bias) {
            strengths.push(p.moment_bias);
        }
    }
    strengths.sort_by(f64::total_cmp);
    let best = bias::recommended(biases);
    let head = columns
        .iter()
        .map(|(m, storage)| format!("moment-power-{m}:{}", storage.name()));
    let mut rows = vec![
        std::iter::once("moment_bias".to_owned())
            .chain(head)
            .collect::<Vec<_>>(),
    ];
    for strength in strengths {
        let cell = |&(moments, storage): &(usize, Kept)| {
            let Some(p) = biases
                .iter()
                .find(|p| (p.moments, p.storage, p.moment_bias) == (moments, storage, strength))
            else {
                return String::new();
            };
            let mut text = p.mse.map_or("-".to_owned(), |mse| format!("{mse:.2e}"));
            for (name, count, of) in [
                ("NaN", p.nonfinite, p.fragments),
                ("single", p.single_nonfinite, p.singles),
            ] {
                if count > 0 {
                    text += &format!(" {name} {}", percent(count as f64 / of as f64));
                }
            }
            text += if p.published { " p" } else { "" };
            text += if best.contains(p) { " *" } else { "" };
            text
        };
        rows.push(
            std::iter::once(format!("{strength:e}"))
                .chain(columns.iter().map(cell))
                .collect(),
        );
    }
    format!(
        "T-MSE of the finite answers by moment_bias; NaN, single: shares of answers without a number on random pixels, on single fragments; p: published; *: least \
         error without NaN\n\n{}\n",
        table(&rows)
    )
}

/// Charts of the three sweeps.
fn charts(out: &Path, replace: Replace, points: &[Point]) -> anyhow::Result<()> {
    let labels = [
        (
            "half_range",
            "Error of transmittance against the pixel's range",
            "half of the pixel's range in moment depth",
            true,
        ),
        (
            "fragments_per_pixel",
            "Error of transmittance against depth complexity",
            "fragments in the pixel",
            true,
        ),
        (
            "storage_digits",
            "Error of transmittance against the precision of stored moments",
            "significant binary digits",
            false,
        ),
    ];
    for ((sweep, title, x, log_x), name) in labels.into_iter().zip(CHARTS) {
        let mut lines: Vec<Line> = Vec::new();
        for p in points.iter().filter(|p| p.sweep == sweep) {
            let Some(mse) = p.mse.filter(|&mse| mse > 0.0) else {
                continue;
            };
            let line = match lines.iter_mut().find(|l| l.name == p.method) {
                Some(line) => line,
                None => {
                    lines.push(Line {
                        name: p.method.clone(),
                        points: Vec::new(),
                        marked: Vec::new(),
                    });
                    lines.last_mut().expect("one was pushed")
                }
            };
            line.points.push((p.x, mse));
            if p.nonfinite > 0 {
                line.marked.push((p.x, mse));
            }
        }
        let chart = Chart {
            title,
            x,
            y: "mean squared error of T (crosses: some answers are NaN)",
            log_x,
            lines: &lines,
        };
        if let Some(svg) = chart.svg().map_err(anyhow::Error::msg)? {
            write_atomically(&out.join(name), replace, |w| w.write_all(svg.as_bytes()))?;
        }
    }
    Ok(())
}
