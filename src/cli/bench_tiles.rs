//! `nmt bench tiles`

use super::Verdict;
use super::scene::{SceneOptions, load};
use super::ui::{Ui, table};
use crate::bench::Summary;
use crate::bench::tiles::{FrameSamples, Frames, Way, frames};
use crate::export::Format;
use crate::gpu::{Gpu, MethodShader};
use crate::model::file;
use anyhow::bail;
use clap::Args;
use serde_json::{Value, json};
use std::path::PathBuf;

#[derive(Args)]
pub struct BenchTiles {
    /// Scenes: fragment lists (.npz), deep images (.exr), scene files (.toml) or names of built-in scenes.
    #[arg(long, value_name = "F.npz|SCENE", num_args = 1.., default_values = ["teapots", "foliage", "hair"])]
    fragments: Vec<String>,
    /// Networks.
    #[arg(long, value_name = "MODEL.json", num_args = 1.., required = true)]
    model: Vec<PathBuf>,
    #[command(flatten)]
    options: SceneOptions,
    /// Repetitions; what is compared takes turns in each.
    #[arg(long, value_name = "N", default_value_t = 15)]
    repeat: usize,
}

impl BenchTiles {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        if !(1..=100_000).contains(&self.repeat) {
            bail!("--repeat {}: must be from 1 to 100000", self.repeat);
        }
        let mut methods = Vec::new();
        for path in &self.model {
            methods.push(MethodShader::neural(&file::load(path)?, Format::Wgsl)?);
        }
        let gpu = Gpu::shared()?;
        let progress = ui.progress("bench", (self.fragments.len() * methods.len() * self.repeat) as u64);
        let mut done = 0;
        let mut results: Vec<(&str, Frames)> = Vec::new();
        for scene in &self.fragments {
            let list = load(scene, &self.options)?;
            for method in &methods {
                let range = method.depth_range(&list, None, None)?;
                let told = |n| progress.set(done + n, format!("{scene}, {}", method.name));
                results.push((scene, frames(gpu, &list, method, range, self.repeat, &told)?));
                done += self.repeat as u64;
            }
        }
        progress.finish();
        if ui.json() {
            let all = results.iter().flat_map(|(scene, frames)| frames.samples.iter().map(|s| sample_json(scene, frames, s)));
            ui.print_json("bench", all.collect())?;
        } else {
            ui.print(&text(gpu, &results, self.repeat))?;
        }
        Ok(Verdict::Fine)
    }
}

fn sample_json(scene: &str, frames: &Frames, s: &FrameSamples) -> Value {
    json!({
        "benchmark": "tiles", "scene": scene, "method": frames.method, "adapter": frames.adapter, "passes": s.way.name(),
        "tiles_network": frames.tiles.network, "tiles_exact": frames.tiles.exact,
        "seconds_accumulate": Summary::of(&s.accumulate).median, "seconds_weights": Summary::of(&s.weights).median,
        "raw_seconds_accumulate": s.accumulate, "raw_seconds_weights": s.weights,
    })
}

fn text(gpu: &Gpu, results: &[(&str, Frames)], repeat: usize) -> String {
    let head = ["scene", "method", "passes", "pass 1 ms", "pass 2 ms", "min", "max", "tiles with network", "ratio"];
    let mut lines = vec![head.map(str::to_owned).to_vec()];
    for (scene, frames) in results {
        let of = |way| frames.samples.iter().find(|s| s.way == way).map(|s| Summary::of(&s.weights).median);
        let every = of(Way::EveryTile).unwrap_or(f64::NAN);
        for s in &frames.samples {
            let (first, second) = (Summary::of(&s.accumulate), Summary::of(&s.weights));
            let tiles = frames.tiles;
            let all = tiles.network + tiles.exact;
            lines.push(vec![
                (*scene).to_owned(),
                frames.method.clone(),
                s.way.name().to_owned(),
                format!("{:.3}", 1e3 * first.median),
                format!("{:.3}", 1e3 * second.median),
                format!("{:.3}", 1e3 * second.min),
                format!("{:.3}", 1e3 * second.max),
                if s.way == Way::TilesApart { format!("{} of {all}", tiles.network) } else { "-".to_owned() },
                format!("{:.2}", second.median / every),
            ]);
        }
    }
    format!(
        "{}{}, by {}, medians of {repeat} repetitions by turns; pass 2 with the resolve, and with telling tiles apart; ratio of pass 2 to compute over every \
         tile\n",
        table(&lines),
        gpu.name(),
        if gpu.stamps() { "timestamps" } else { "the clock" }
    )
}
