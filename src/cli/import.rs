//! `nmt import`

use super::ui::Ui;
use super::{Verdict, keep_inputs};
use crate::features::FeatureSet;
use crate::model::file;
use crate::model::mlp::name_for;
use crate::numeric::file::Replace;
use anyhow::Context;
use clap::Args;
use serde_json::json;
use std::path::PathBuf;

#[derive(Args)]
pub struct Import {
    /// JSON with `layers`, each `{"weights": [in][out], "biases": [out]}`; ReLU between them, a sigmoid at the end.
    weights: PathBuf,
    /// Model file to write.
    #[arg(long, value_name = "MODEL.json")]
    out: PathBuf,
    /// Feature set that the weights were trained on.
    #[arg(long, default_value = "paper")]
    features: String,
    /// Name of the network; the model file's own without it.
    #[arg(long)]
    name: Option<String>,
    /// Replace what is there.
    #[arg(long)]
    force: bool,
}

impl Import {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        let set: FeatureSet = self.features.parse().context("--features")?;
        keep_inputs(&[&self.weights], &self.out)?;
        let name = self.name.unwrap_or_else(|| name_for(&self.out));
        let mlp = file::import(&self.weights, &name, set)?;
        file::save(&self.out, if self.force { Replace::Yes } else { Replace::No }, &mlp)?;
        if ui.json() {
            ui.print_json(
                "import",
                vec![json!({ "network": mlp.shape(), "features": set.name(), "file": self.out })],
            )?;
        } else {
            ui.print(&format!(
                "{}, features '{}'\n{}\n",
                mlp.shape(),
                set.name(),
                self.out.display()
            ))?;
        }
        Ok(Verdict::Fine)
    }
}
