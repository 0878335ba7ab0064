//! `nmt bench methods`

use super::{Common, Turns, cells, merged};
use crate::bench::Summary;
use crate::bench::methods::{Candidate, Clock, Cost, NONE, Processor, Setting, Table};
use crate::chart::{Tradeoff, tradeoffs};
use crate::cli::Verdict;
use crate::cli::predict::SkipName;
use crate::cli::scene::{SceneOptions, ViewOptions, load};
use crate::cli::ui::{Ui, machine, table};
use crate::evaluate::Truth;
use crate::evaluate::picture::file_stem;
use crate::export::Format;
use crate::gpu::Gpu;
use crate::model::shipped;
use crate::numeric::file::{Replace, may_write, write_atomically};
use crate::oit::neural::Skip;
use crate::oit::{all_names, names_with_shader, parse};
use anyhow::{Context as _, bail};
use clap::{Args, ValueEnum};
use serde_json::{Value, json};
use std::collections::HashSet;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

#[derive(Args)]
pub struct BenchMethods {
    /// Scene: a fragment list (.npz), deep image (.exr), scene file (.toml) or the name of a built-in scene.
    #[arg(long, value_name = "F.npz|SCENE")]
    fragments: OsString,
    /// Methods, by name; "shaders" stands for every classic one that runs on the GPU, "all" for every classic one.
    #[arg(long, value_delimiter = ',', num_args = 1.., default_value = "shaders")]
    methods: Vec<String>,
    /// Networks to measure beside them.
    #[arg(long, value_name = "MODEL.json", value_delimiter = ',', num_args = 1..)]
    model: Vec<PathBuf>,
    /// Forms of the networks' shaders.
    #[arg(long, value_delimiter = ',', num_args = 1.., default_value = "wgsl", value_parser = wgsl)]
    format: Vec<Format>,
    /// Which fragments to run the networks for.
    #[arg(long, value_enum, default_value = "exact")]
    skip: SkipName,
    /// Where to measure.
    #[arg(long, value_enum, value_delimiter = ',', num_args = 1.., default_values = ["cpu", "gpu"])]
    device: Vec<Device>,
    /// Folder for results.json and the pictures of time against error.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    options: SceneOptions,
    #[command(flatten)]
    view: ViewOptions,
    /// Replace what is there.
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    common: Common,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Device {
    Cpu,
    Gpu,
}

const FORMATS: [Format; 4] = [
    Format::WGSL,
    Format::WGSL_PLAIN,
    Format::WGSL_F16,
    Format::WGSL_PLAIN_F16,
];

/// The file that holds all numbers.
const RESULTS: &str = "results.json";

fn wgsl(text: &str) -> Result<Format, String> {
    let names = FORMATS.map(Format::name).join(", ");
    FORMATS
        .into_iter()
        .find(|f| f.name() == text)
        .ok_or_else(|| format!("expected one of {names}"))
}

impl BenchMethods {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        let replace = if self.force { Replace::Yes } else { Replace::No };
        if let Some(out) = &self.out {
            may_write(&out.join(RESULTS), replace)?;
            let mut pictures = [Device::Cpu, Device::Gpu].iter().map(|d| out.join(picture(*d)));
            pictures.try_for_each(|path| may_write(&path, replace))?;
        }
        let context = self.view.context()?;
        let background = self.view.background()?;
        let (candidates, demanded) = self.candidates()?;
        let plan = self.common.prepare()?;
        let with_gpu = self.device.contains(&Device::Gpu);
        let gpu = if with_gpu { self.gpu(ui)? } else { None };

        let list = load(ui, &self.fragments, &self.options)?;
        let truth = Truth::new(&list, background);
        let setting = Setting {
            truth: &truth,
            context,
            plan,
            skip: self.skip.into(),
        };
        let tables = self.measure(ui, &setting, &candidates, gpu)?;

        let scene = Path::new(&self.fragments).file_stem().unwrap_or(&self.fragments);
        let scene = scene.to_string_lossy();
        let results = self.rows(&scene, &tables);
        let json = serde_json::to_string_pretty(&ui.report("bench", results))? + "\n";
        let written = match &self.out {
            Some(out) => write(out, replace, &scene, &tables, &json)?,
            None => String::new(),
        };
        if ui.json() {
            ui.print(&json)?;
        } else {
            let heading = format!(
                "{scene}: {} fragments in {} pixels, at most {} in one\n",
                list.len(),
                list.pixels(),
                list.depth_complexity()
            );
            let texts: Vec<String> = tables.iter().map(|(_, t)| table_text(t, plan.repeat)).collect();
            ui.print(&format!("{heading}\n{}{written}", texts.join("\n")))?;
        }
        let mut left_out = tables.iter().flat_map(|(_, t)| &t.left_out);
        if left_out.any(|l| !l.harmless && demanded.contains(&l.method)) {
            bail!("a method that was asked for by name could not be applied; see above");
        }
        Ok(Verdict::Fine)
    }

    /// A table for each device that was asked for and is there.
    fn measure(
        &self,
        ui: &Ui,
        setting: &Setting<'_>,
        candidates: &[Candidate],
        gpu: Option<&Gpu>,
    ) -> anyhow::Result<Vec<(Device, Table)>> {
        let on_cpu = self.device.contains(&Device::Cpu);
        let mut turns = Turns::new(ui, usize::from(on_cpu) + usize::from(gpu.is_some()), setting.plan);
        let mut tables = Vec::new();
        if on_cpu {
            let name = cpu_name();
            let measured = turns.take(&format!("on {name}"), |progress| {
                setting.on_cpu(&name, candidates, progress)
            })?;
            tables.push((Device::Cpu, measured));
        }
        if let Some(gpu) = gpu {
            let measured = turns.take(&format!("on {}", gpu.name()), |progress| {
                setting.on_gpu(gpu, candidates, &self.format, progress)
            })?;
            tables.push((Device::Gpu, measured));
        }
        let costs = tables.iter().flat_map(|(_, t)| &t.costs);
        let figure = |c: &Cost| (format!("{} on {}", label(c), c.adapter), Summary::of(&c.both));
        turns.finish(&costs.map(figure).collect::<Vec<_>>());
        Ok(tables)
    }

    /// The results file's rows: what was measured, then what was left out, of each device.
    fn rows(&self, scene: &str, tables: &[(Device, Table)]) -> Vec<Value> {
        let measured = |c: &Cost| {
            let mut row = row_json(scene, c);
            if let Some(row) = row.as_object_mut().filter(|_| c.network.is_some()) {
                row.insert("skip".to_owned(), json!(Skip::from(self.skip)));
            }
            row
        };
        let of_table = |table: &Table| {
            let left_out = table.left_out.iter();
            let left_out = left_out
                .map(|l| json!({ "scene": scene, "method": l.method, "adapter": table.adapter, "error": l.why }));
            table.costs.iter().map(measured).chain(left_out).collect::<Vec<_>>()
        };
        tables.iter().flat_map(|(_, table)| of_table(table)).collect()
    }

    /// What to measure, and the names of what was asked for by its own.
    fn candidates(&self) -> anyhow::Result<(Vec<Candidate>, HashSet<String>)> {
        let mut candidates = Vec::new();
        let (mut seen, mut demanded) = (HashSet::new(), HashSet::new());
        for name in &self.methods {
            let names = match name.as_str() {
                "all" => all_names(),
                "shaders" => names_with_shader(),
                _ => vec![name.clone()],
            };
            let by_name = !matches!(name.as_str(), "all" | "shaders");
            for name in names {
                let method = parse(&name)?;
                if by_name {
                    demanded.insert(method.name());
                }
                if seen.insert(method.name()) {
                    candidates.push(Candidate::Method(method));
                }
            }
        }
        for path in &self.model {
            let candidate = Candidate::Network(Box::new(shipped::open(path)?));
            demanded.insert(candidate.name());
            candidates.push(candidate);
        }
        Ok((candidates, demanded))
    }

    /// The GPU; none, said aloud, where there is none and the CPU is measured too.
    fn gpu(&self, ui: &Ui) -> anyhow::Result<Option<&'static Gpu>> {
        match Gpu::shared() {
            Ok(gpu) => Ok(Some(gpu)),
            Err(why) if self.device.contains(&Device::Cpu) => {
                ui.warn(&format!("note: not measured on a GPU, {why}"));
                Ok(None)
            }
            Err(why) => Err(why).context("--device gpu"),
        }
    }
}

/// The CPU with the threads that it is measured on.
fn cpu_name() -> String {
    let cpu = machine()["cpu"].as_str().unwrap_or("CPU").to_owned();
    format!("{cpu} ({} threads)", rayon::current_num_threads())
}

/// Writes pictures and results into a folder, and lists what was written.
fn write(out: &Path, replace: Replace, scene: &str, tables: &[(Device, Table)], json: &str) -> anyhow::Result<String> {
    let mut written = String::new();
    for (device, table) in tables {
        let path = out.join(picture(*device));
        let Some(text) = chart(scene, table) else { continue };
        write_atomically(&path, replace, |w| w.write_all(text.as_bytes()))?;
        written += &format!("{}\n", path.display());
    }
    let path = out.join(RESULTS);
    write_atomically(&path, replace, |w| w.write_all(json.as_bytes()))?;
    Ok(written + &format!("{}\n", path.display()))
}

fn picture(device: Device) -> String {
    let device = match device {
        Device::Cpu => "cpu",
        Device::Gpu => "gpu",
    };
    format!("{}.svg", file_stem(&format!("time-against-error-{device}")))
}

/// Name of a row, with the form of its shader where that is not the usual one.
fn label(cost: &Cost) -> String {
    let name = cost.method.strip_prefix("neural:").unwrap_or(&cost.method);
    match cost.format {
        Some(format) if format != Format::WGSL.name() => format!("{name} ({format})"),
        _ => name.to_owned(),
    }
}

fn row_json(scene: &str, c: &Cost) -> Value {
    let per_fragment = |seconds: f64| 1e9 * seconds / c.fragments as f64;
    let both = Summary::of(&c.both);
    let row = json!({
        "benchmark": "methods", "scene": scene, "method": c.method, "network": c.network, "format": c.format,
            "adapter": c.adapter,
        "arithmetic": c.arithmetic, "clock": c.clock.name(), "fragments": c.fragments,
        "transmittance_mse": c.transmittance_mse, "image_mse": c.image_mse, "flip_mean": c.flip_mean,
            "nonfinite": c.nonfinite,
        "image_nonfinite": c.image_nonfinite, "on_front": c.on_front,
        "seconds": both.median, "nanoseconds_per_fragment": per_fragment(both.median), "raw_seconds": c.both,
        "min_seconds": both.min, "max_seconds": both.max, "mad_seconds": both.mad,
        "calls_per_repetition": c.calls, "repetitions": c.both.len(), "threads": rayon::current_num_threads(),
    });
    let row = merged(row, json!(c.capabilities));
    let Some(passes) = &c.passes else { return row };
    let (accumulate, weights) = (
        Summary::of(&passes.accumulate).median,
        Summary::of(&passes.weights).median,
    );
    let apart = json!({
        "seconds_accumulate": accumulate, "seconds_weights": weights,
        "nanoseconds_per_fragment_accumulate": per_fragment(accumulate),
            "nanoseconds_per_fragment_weights": per_fragment(weights),
        "raw_seconds_accumulate": passes.accumulate, "raw_seconds_weights": passes.weights,
    });
    merged(row, apart)
}

/// One adapter's methods, the fastest first.
fn table_text(t: &Table, repeat: usize) -> String {
    let number = |x: Option<f64>, text: &dyn Fn(f64) -> String| match x {
        None => "-".to_owned(),
        Some(x) if x.is_nan() => "NaN".to_owned(),
        Some(x) => text(x),
    };
    let nanoseconds = |seconds: f64, c: &Cost| format!("{:.1}", 1e9 * seconds / c.fragments as f64);
    let mut rows = vec![cells([
        "",
        "method",
        "both ns",
        "min",
        "max",
        "pass 1 ns",
        "pass 2 ns",
        "image MSE",
        "FLIP",
        "T-MSE",
        "non-finite",
        "bits/pixel",
        "passes",
    ])];
    for c in &t.costs {
        let median =
            |samples: Option<&Vec<f64>>| samples.map_or("-".to_owned(), |s| nanoseconds(Summary::of(s).median, c));
        let s = Summary::of(&c.both);
        rows.push(vec![
            if c.on_front { "*" } else { "" }.to_owned(),
            label(c),
            nanoseconds(s.median, c),
            nanoseconds(s.min, c),
            nanoseconds(s.max, c),
            median(c.passes.as_ref().map(|p| &p.accumulate)),
            median(c.passes.as_ref().map(|p| &p.weights)),
            number(c.image_mse, &|x| format!("{x:.2e}")),
            number(c.flip_mean, &|x| format!("{x:.4}")),
            number(c.transmittance_mse, &|x| format!("{x:.2e}")),
            c.nonfinite.to_string(),
            c.capabilities.bits_text(),
            c.capabilities.geometry_passes.to_string(),
        ]);
    }
    let error = if t.costs.iter().any(|c| c.image_mse.is_some()) {
        "image MSE"
    } else {
        "T-MSE"
    };
    let what = match t.processor {
        Processor::Gpu => format!(
            "Pass 1 is a thread a pixel, pass 2 a thread a fragment. '{NONE}' weighs all by 1 and has only the \
                fragment and its pixel's total to load."
        ),
        Processor::Cpu => {
            "Classic methods are this program's f64 reference code, not SIMD; networks f32 SIMD, their passes not \
                apart. For a fair race see a GPU."
                .to_owned()
        }
    };
    let left: String = t
        .left_out
        .iter()
        .map(|l| format!("left out: {}, {}\n", l.method, l.why))
        .collect();
    format!(
        "{}, {}\n{}ns a fragment, medians of {repeat} interleaved repetitions. *: nothing else is as fast at as small \
            an {error}.\n{what}\n{left}",
        t.adapter,
        t.clock.name(),
        table(&rows)
    )
}

/// Time against error of one adapter; none where no method has a place on logarithmic axes.
fn chart(scene: &str, t: &Table) -> Option<String> {
    let methods: Vec<Tradeoff> = t
        .costs
        .iter()
        .filter(|c| c.method != NONE)
        .map(|c| Tradeoff {
            name: label(c),
            cost: 1e9 * t.time(c) / c.fragments as f64,
            spread: None,
            error: c.error().unwrap_or(f64::NAN),
            on_front: c.on_front,
            network: c.network.is_some(),
            title: label(c),
        })
        .collect();
    let error = if t.costs.iter().any(|c| c.image_mse.is_some()) {
        "image MSE"
    } else {
        "T-MSE"
    };
    let undrawn: Vec<String> = methods
        .iter()
        .filter(|m| !m.is_drawn())
        .map(|m| format!("{} ({})", m.name, if m.error == 0.0 { "exact" } else { "NaN" }))
        .collect();
    let empty = t
        .costs
        .iter()
        .find(|c| c.method == NONE)
        .map(|c| format!("Empty passes take {:.1} ns. ", 1e9 * t.time(c) / c.fragments as f64));
    let missing = if undrawn.is_empty() {
        String::new()
    } else {
        format!("Not drawn: {}.", undrawn.join(", "))
    };
    let clock = match t.clock {
        Clock::Device => "device timestamps",
        Clock::Wall => "wall clock",
    };
    let time = "both passes";
    let title = format!("{scene} on {}", t.adapter);
    let cost = format!("{time}, ns a fragment ({clock})");
    tradeoffs(format!("{title}: {cost} against {error}"), &cost, error, &methods)
        .document(&title, &format!("{}{missing}", empty.unwrap_or_default()))
}
