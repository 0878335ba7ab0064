//! `nmt predict`

use super::ui::Ui;
use super::{Verdict, keep_inputs};
use crate::evaluate::transmittance_error;
use crate::features::OutputMeaning;
use crate::model::file;
use crate::numeric::file::{Replace, may_write};
use crate::numeric::npy::write_npy;
use crate::oit::{Context, neural::Neural};
use crate::pixel::{CameraPlanes, abuffer};
use crate::scene;
use anyhow::bail;
use clap::Args;
use ndarray::ArrayView1;
use serde_json::json;
use std::path::PathBuf;
use std::time::Instant;

#[derive(Args)]
pub struct Predict {
    /// Model file.
    model: PathBuf,
    /// Fragment list to answer; a deep image (.exr) is taken too.
    #[arg(long, value_name = "F.npz")]
    fragments: PathBuf,
    /// NumPy array to write: transmittance of every fragment, f32, in the order of the list.
    #[arg(long, value_name = "T.npy")]
    out: PathBuf,
    /// Near plane of the camera, instead of the list's own [scene units].
    #[arg(long, requires = "far")]
    near: Option<f32>,
    /// Far plane of the camera, instead of the list's own [scene units].
    #[arg(long, requires = "near")]
    far: Option<f32>,
    /// Replace what is there.
    #[arg(long)]
    force: bool,
}

impl Predict {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        let replace = if self.force { Replace::Yes } else { Replace::No };
        keep_inputs(&[&self.model, &self.fragments], &self.out)?;
        may_write(&self.out, replace)?;
        let mlp = file::load(&self.model)?;
        let planes = self.near.zip(self.far).map(|(near, far)| CameraPlanes::new(near, far)).transpose()?;
        if mlp.feature_set().output() == OutputMeaning::FrontToBackFactor {
            bail!("{}: its answer is not a transmittance; 'nmt evaluate --model' shows what it is good for", self.model.display());
        }
        let list = scene::read(&self.fragments)?;
        let shape = mlp.shape();
        let method = Neural::new(mlp);
        let progress = ui.progress("predict", list.len() as u64);
        let start = Instant::now();
        let transmittance = method.transmittance(&list, Context { planes, ..Context::default() }, &|n| progress.set(n, "fragments"));
        let seconds = start.elapsed().as_secs_f64();
        progress.finish();
        let transmittance = transmittance?;
        write_npy(&self.out, replace, ArrayView1::from(&transmittance))?;
        let error = transmittance_error(&transmittance, &abuffer::list_transmittance(&list));
        let rate = list.len() as f64 / seconds;
        if ui.json() {
            ui.print_json(
                "predict",
                vec![json!({
                    "network": shape, "fragments": list.len(), "pixels": list.pixels(), "depth_complexity": list.depth_complexity(),
                    "transmittance_mse": error.mse(), "transmittance_worst_error": error.worst(), "nonfinite": error.nonfinite(),
                    "seconds": seconds, "fragments_per_second": rate, "file": self.out,
                })],
            )?;
        } else {
            let against = match list.is_empty() {
                true => "nothing to compare".to_owned(),
                false => format!("against the A-buffer: T-MSE {:.3e}, worst error {:.3}", error.mse(), error.worst()),
            };
            ui.print(&format!(
                "{} fragments in {} pixels (at most {} in one), {:.2} M fragments/s\n{against}\n{}\n",
                list.len(),
                list.pixels(),
                list.depth_complexity(),
                rate / 1e6,
                self.out.display()
            ))?;
        }
        Ok(Verdict::Fine)
    }
}
