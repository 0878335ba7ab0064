//! `nmt predict`

use super::scene::{SceneOptions, load, look_at, refuse_outside};
use super::ui::Ui;
use super::{Verdict, keep_inputs, shown};
use crate::evaluate::transmittance_error;
use crate::features::{MomentFrame, OutputMeaning};
use crate::infer::{Answered, Class, Skip, Tally};
use crate::model::shipped;
use crate::numeric::file::{Replace, may_write};
use crate::numeric::npy::write_npy;
use crate::numeric::tolerance::AbsoluteError;
use crate::oit::Context;
use crate::oit::neural::Neural;
use crate::pixel::{CameraPlanes, FragmentList, abuffer};
use anyhow::bail;
use clap::{Args, ValueEnum};
use ndarray::ArrayView1;
use serde_json::{Value, json};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::time::Instant;

#[derive(Args)]
pub struct Predict {
    /// Model file.
    model: PathBuf,
    /// Fragments to answer: a fragment list (.npz), a deep image (.exr), a scene file (.toml) or the name of a built-in
    /// scene.
    #[arg(long, value_name = "F.npz|SCENE")]
    fragments: OsString,
    /// NumPy array to write: transmittance of every fragment, f32, in the order of the list.
    #[arg(long, value_name = "T.npy")]
    out: PathBuf,
    #[command(flatten)]
    options: SceneOptions,
    /// Near plane of the camera, instead of the list's own [scene units].
    #[arg(long, requires = "far")]
    near: Option<f32>,
    /// Far plane of the camera, instead of the list's own [scene units].
    #[arg(long, requires = "near")]
    far: Option<f32>,
    /// Which fragments to run the network for.
    #[arg(long, value_enum, default_value = "exact")]
    skip: SkipName,
    /// Take moments between each pixel's own nearest and farthest fragment, which a prepass has found: no pixel is too
    /// thin then.
    #[arg(long)]
    prepass: bool,
    /// Replace what is there.
    #[arg(long)]
    force: bool,
}

#[derive(ValueEnum, Clone, Copy)]
pub enum SkipName {
    /// All; what is known exactly then replaces its answers.
    None,
    /// Those whose answer is used: the same numbers as with none.
    Exact,
    /// Those that can be seen: no channel of the image changes by more than 1/512.
    Visible,
}

impl From<SkipName> for Skip {
    fn from(name: SkipName) -> Self {
        match name {
            SkipName::None => Self::None,
            SkipName::Exact => Self::Exact,
            SkipName::Visible => Self::Visible,
        }
    }
}

impl Predict {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        let replace = if self.force { Replace::Yes } else { Replace::No };
        keep_inputs(&[&self.model, Path::new(&self.fragments)], &self.out)?;
        let mlp = shipped::open(&self.model)?;
        look_at(&self.fragments)?;
        may_write(&self.out, replace)?;
        let planes = self
            .near
            .zip(self.far)
            .map(|(near, far)| CameraPlanes::new(near, far))
            .transpose()?;
        if mlp.feature_set().output() == OutputMeaning::FrontToBackFactor {
            bail!(
                "{}: its answer is not a transmittance; 'nmt evaluate --model' shows what it is good for",
                self.model.display()
            );
        }
        let list = load(ui, &self.fragments, &self.options)?;
        refuse_outside(&list, planes)?;
        if matches!(self.skip, SkipName::Visible) {
            say_visible_bound(ui, &list);
        }
        let shape = mlp.shape();
        let skip = Skip::from(self.skip);
        let frame = if self.prepass {
            MomentFrame::Pixel
        } else {
            MomentFrame::Scene
        };
        let method = Neural::new(mlp).with_skip(skip).with_frame(frame);
        let progress = ui.progress("predict", list.len() as u64);
        let start = Instant::now();
        let answered = method.answers(
            &list,
            Context {
                planes,
                ..Context::default()
            },
            &|n| progress.set(n, "fragments"),
        );
        let seconds = start.elapsed().as_secs_f64();
        progress.finish();
        let Answered {
            transmittance, tally, ..
        } = answered?;
        write_npy(&self.out, replace, ArrayView1::from(&transmittance))?;
        let error = transmittance_error(&transmittance, &abuffer::list_transmittance(&list));
        let rate = list.len() as f64 / seconds;
        if ui.json() {
            ui.print_json(
                "predict",
                vec![json!({
                    "network": shape, "fragments": list.len(), "pixels": list.pixels(),
                        "depth_complexity": list.depth_complexity(),
                    "transmittance_mse": error.mse(), "transmittance_worst_error": error.worst(),
                        "nonfinite": error.nonfinite(),
                    "seconds": seconds, "fragments_per_second": rate, "file": shown(&self.out), "skip": skip,
                        "frame": frame, "network_rows": tally.rows,
                    "seconds_pass_1": tally.seconds_pass_1, "seconds_pass_2": tally.seconds_pass_2,
                        "fragments_by_class": by_class(&tally),
                })],
            )?;
        } else {
            let done = (rate, &error, summary(&tally));
            ui.print(&format!("{}{}\n", text(&list, done), self.out.display()))?;
        }
        Ok(Verdict::Fine)
    }
}

/// What a person reads: the list, how fast it was, how far off, and which fragments needed the network.
fn text(list: &FragmentList, (rate, error, classes): (f64, &AbsoluteError, String)) -> String {
    let against = match list.is_empty() {
        true => "nothing to compare".to_owned(),
        false => format!(
            "against the A-buffer: T-MSE {:.3e}, worst error {:.3}",
            error.mse(),
            error.worst()
        ),
    };
    format!(
        "{} fragments in {} pixels (at most {} in one), {:.2} M fragments/s\n{classes}\n{against}\n",
        list.len(),
        list.pixels(),
        list.depth_complexity(),
        rate / 1e6,
    )
}

/// Says how far the promise of `--skip visible` scales with colours beyond 1.
pub fn say_visible_bound(ui: &Ui, list: &FragmentList) {
    let brightest = list.brightest();
    if brightest > 1.0 {
        ui.warn(&format!(
            "--skip visible: colours reach {brightest}, so channels of the image change by up to {brightest}/512 \
                instead of 1/512"
        ));
    }
}

/// Fragments of every class, by its name.
fn by_class(tally: &Tally) -> Value {
    Class::ALL
        .iter()
        .map(|&class| (class.name().to_owned(), json!(tally.of(class))))
        .collect::<serde_json::Map<_, _>>()
        .into()
}

/// What the network was run for, and what decided the rest.
fn summary(tally: &Tally) -> String {
    let share = |n: u64| format!("{:.1} %", 100.0 * n as f64 / tally.fragments().max(1) as f64);
    let classes: Vec<String> = Class::ALL
        .iter()
        .filter(|&&c| tally.of(c) > 0)
        .map(|&c| format!("{} {}", c.name(), share(tally.of(c))))
        .collect();
    format!(
        "network run for {} of them; {}; pass 1 {:.1} ms, pass 2 {:.1} ms",
        tally.rows,
        if classes.is_empty() {
            "none to answer".to_owned()
        } else {
            classes.join(", ")
        },
        1e3 * tally.seconds_pass_1,
        1e3 * tally.seconds_pass_2
    )
}
