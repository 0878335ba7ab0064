//! `nmt bench tiles`

use crate::bench::Summary;
use crate::bench::tiles::{FrameSamples, Frames, Work, frames};
use crate::cli::Verdict;
use crate::cli::bench::Output;
use crate::cli::predict::SkipName;
use crate::cli::scene::{SceneOptions, load};
use crate::cli::ui::{Ui, table};
use crate::export::Format;
use crate::gpu::{Gpu, MethodShader};
use crate::model::shipped;
use crate::oit::neural::Skip;
use anyhow::bail;
use clap::Args;
use serde_json::{Value, json};
use std::ffi::OsString;
use std::path::PathBuf;

#[derive(Args)]
pub struct BenchTiles {
    /// Scenes: fragment lists (.npz), deep images (.exr), scene files (.toml) or names of built-in scenes.
    #[arg(long, value_name = "F.npz|SCENE", value_delimiter = ',', num_args = 1.., default_values = ["teapots",
        "foliage", "hair"])]
    fragments: Vec<OsString>,
    /// Networks.
    #[arg(long, value_name = "MODEL.json", value_delimiter = ',', num_args = 1.., required = true)]
    model: Vec<PathBuf>,
    /// Which fragments to run the network for.
    #[arg(long, value_enum, value_delimiter = ',', num_args = 1.., default_values = ["none", "exact", "visible"])]
    skip: Vec<SkipName>,
    #[command(flatten)]
    options: SceneOptions,
    /// Repetitions; each runs everything that is compared, one after the other.
    #[arg(long, value_name = "N", default_value_t = 15)]
    repeat: usize,
    #[command(flatten)]
    output: Output,
}

impl BenchTiles {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        self.output.check()?;
        if !(1..=100_000).contains(&self.repeat) {
            bail!("--repeat {}: must be from 1 to 100000", self.repeat);
        }
        let mut methods = Vec::new();
        for path in &self.model {
            methods.push(MethodShader::neural(&shipped::open(path)?, Format::WGSL)?);
        }
        let skips: Vec<Skip> = self.skip.iter().map(|&skip| skip.into()).collect();
        let gpu = Gpu::shared()?;
        let progress = ui.progress("bench", (self.fragments.len() * methods.len() * self.repeat) as u64);
        let mut done = 0;
        let mut results: Vec<(String, Frames)> = Vec::new();
        for scene in &self.fragments {
            let list = load(ui, scene, &self.options)?;
            let scene = scene.to_string_lossy().into_owned();
            for method in &methods {
                let range = method.depth_range(&list, None, None)?;
                let told = |n| progress.set(done + n, format!("{scene}, {}", method.name));
                results.push((
                    scene.clone(),
                    frames(gpu, &list, method, range, &skips, self.repeat, &told)?,
                ));
                done += self.repeat as u64;
            }
        }
        progress.finish();
        let all = results
            .iter()
            .flat_map(|(scene, frames)| frames.samples.iter().map(|s| sample_json(scene, frames, s)));
        self.output.give(ui, all.collect(), &text(gpu, &results, self.repeat))
    }
}

fn sample_json(scene: &str, frames: &Frames, s: &FrameSamples) -> Value {
    let pixels = s.work.and_then(|w| w.pixels);
    json!({
        "benchmark": "tiles", "scene": scene, "method": frames.method, "adapter": frames.adapter,
            "passes": s.way.name(), "skip": s.way.skip(),
        "fragments": frames.fragments, "fragments_evaluated": s.work.map(|w| w.evaluated),
        "pixels_network": pixels.map(|p| p.network), "pixels_hiding": pixels.map(|p| p.hiding),
            "pixels_known": pixels.map(|p| p.known),
        "greatest_change": s.work.map(|w| w.greatest_change), "flip_change": s.work.map(|w| w.flip_change),
            "speedup": frames.speedup(s),
        "seconds_accumulate": Summary::of(&s.accumulate).median, "seconds_weights": Summary::of(&s.weights).median,
        "raw_seconds_accumulate": s.accumulate, "raw_seconds_weights": s.weights,
    })
}

fn text(gpu: &Gpu, results: &[(String, Frames)], repeat: usize) -> String {
    let head = [
        "scene",
        "method",
        "passes",
        "skip",
        "pass 1 ms",
        "pass 2 ms",
        "min",
        "max",
        "against none",
        "pixels with network",
        "fragments avoided",
        "change",
        "FLIP",
    ];
    let mut lines = vec![head.map(str::to_owned).to_vec()];
    for (scene, frames) in results {
        for s in &frames.samples {
            let (first, second) = (Summary::of(&s.accumulate), Summary::of(&s.weights));
            let of = |text: &dyn Fn(&Work) -> String| s.work.as_ref().map_or_else(|| "-".to_owned(), text);
            lines.push(vec![
                (*scene).to_owned(),
                frames.method.clone(),
                s.way.name().to_owned(),
                match s.way.skip() {
                    Skip::None => "none",
                    Skip::Exact => "exact",
                    Skip::Visible => "visible",
                }
                .to_owned(),
                format!("{:.3}", 1e3 * first.median),
                format!("{:.3}", 1e3 * second.median),
                format!("{:.3}", 1e3 * second.min),
                format!("{:.3}", 1e3 * second.max),
                frames
                    .speedup(s)
                    .map_or_else(|| "-".to_owned(), |x| format!("{x:.2} x")),
                of(&|w| {
                    w.pixels.map_or_else(
                        || "all".to_owned(),
                        |p| format!("{} of {}", p.network, p.network + p.known),
                    )
                }),
                of(&|w| {
                    format!(
                        "{:.1} %",
                        100.0 * (1.0 - w.evaluated as f64 / frames.fragments.max(1) as f64)
                    )
                }),
                of(&|w| format!("{:.1e}", w.greatest_change)),
                of(&|w| format!("{:.1e}", w.flip_change)),
            ]);
        }
    }
    format!(
        "{}{}, by {}, medians of {repeat} repetitions by turns; pass 2 with the resolve, and with telling pixels \
            apart; speed of pass 2 against compute passes \
         that skip nothing, greatest change of a channel (1/512 = 2.0e-3) and FLIP against their image\n",
        table(&lines),
        gpu.name(),
        if gpu.stamps() { "timestamps" } else { "the clock" }
    )
}
