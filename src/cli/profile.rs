//! `nmt profile`

use super::Verdict;
use super::scene::{SceneOptions, load};
use super::ui::{Ui, table};
use crate::model::file;
use crate::oit::Context;
use crate::profile::{Scene, skip};
use clap::Args;
use serde_json::json;
use std::path::PathBuf;

#[derive(Args)]
pub struct Profile {
    /// Scene: a fragment list (.npz), a deep image (.exr), a scene file (.toml) or the name of a built-in scene.
    #[arg(long, value_name = "F.npz|SCENE")]
    fragments: String,
    /// Networks to look into.
    #[arg(long, value_name = "MODEL.json", num_args = 1..)]
    model: Vec<PathBuf>,
    #[command(flatten)]
    options: SceneOptions,
    #[arg(long, value_name = "N", default_value_t = 11)]
    repeat: usize,
}

impl Profile {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        let list = load(&self.fragments, &self.options)?;
        let scene = Scene::new(&list, Context::default(), [1.0; 3]);
        for path in &self.model {
            let mlp = file::load(path)?;
            let found = skip::measure(&scene, &mlp, self.repeat, &|_| {})?;
            if ui.json() {
                ui.print_json("profile", found.iter().map(|s| json!(s)).collect())?;
                continue;
            }
            let mut rows = vec![["skip", "avoided", "ms", "min", "speedup", "MSE x1e-4", "change", "added", "flip"].map(str::to_owned).to_vec()];
            for s in &found {
                let im = s.image.unwrap();
                rows.push(vec![
                    s.skip.to_owned(),
                    format!("{:.4}", s.avoided),
                    format!("{:.2}", 1e3 * s.seconds),
                    format!("{:.2}", 1e3 * s.raw_seconds_pass_2.iter().copied().fold(f64::INFINITY, f64::min)),
                    format!("{:.2}", s.speedup),
                    format!("{:.4}", 1e4 * im.image_mse),
                    format!("{:.2e}", im.greatest_change),
                    format!("{:.2e}", im.greatest_added_error),
                    format!("{:.2e}", im.flip_change),
                ]);
            }
            ui.print(&table(&rows))?;
        }
        Ok(Verdict::Fine)
    }
}
