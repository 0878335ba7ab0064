//! `nmt run`: the main job in one go.

use super::check::{CheckArguments, findings, to_json, verdict};
use super::config::Config;
use super::train::{TrainOptions, Trained, fit};
use super::ui::{Ui, report, table};
use super::{Verdict, generate};
use crate::check::{Finding, Status};
use crate::dataset::build::pixels_holding;
use crate::dataset::file as dataset_file;
use crate::evaluate::transmittance_error;
use crate::export::{self, Format};
use crate::features::MomentDepthKind;
use crate::model::Mlp;
use crate::numeric::file::{FileError, Replace, create_folder, write_atomically};
use crate::numeric::tolerance::AbsoluteError;
use crate::oit::{Context, neural::Neural};
use crate::synth::{Purpose, Synth};
use crate::train::checkpoint::path_for;
use anyhow::bail;
use clap::Args;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::time::Instant;

#[derive(Args)]
pub struct Run {
    /// Configuration file.
    config: PathBuf,
    /// Folder for everything; target/nmt/NAME without it. A folder that `run` made itself is replaced.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    train: TrainOptions,
    #[command(flatten)]
    check: CheckArguments,
}

/// The file that marks a folder as one of `run`'s, and holds its results in the end.
const MARKER: &str = "run.json";

impl Run {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        let config = self.train.configure(&self.config)?;
        let out = self.out.unwrap_or_else(|| Path::new("target/nmt").join(&config.name));
        let model = out.join("model.json");
        let checkpoint = path_for(&model);
        claim(&out, &config.name, self.train.force)?;
        self.train.settle_checkpoint(&checkpoint)?;
        let (dataset_folder, exports) = (out.join("dataset"), out.join("exports"));
        clear(&out, self.train.resume)?;
        write_json(&out.join(MARKER), &report("run", vec![json!({ "name": config.name })]))?;

        let stages = ui.stage();
        let start = Instant::now();
        let dataset = generate::build(&config, &stages)?;
        dataset_file::write(&dataset_folder, Replace::Yes, &dataset)?;
        let generated = start.elapsed().as_secs_f64();

        let Some(mut trained) = fit(&config, &dataset, &self.train, &checkpoint, &stages)? else {
            return Ok(Verdict::Interrupted);
        };
        let error = evaluate(&config, &trained.mlp)?;
        trained.mlp.provenance.transmittance_mse = Some(error.mse());
        trained.mlp.provenance.transmittance_worst_error = Some(error.worst());
        trained.keep(&model, Replace::Yes, &checkpoint)?;

        export::write(&trained.mlp, &exports, &Format::DEFAULT, None, Replace::Yes)?;
        let findings = findings(&trained.mlp, &exports, &Format::DEFAULT, &self.check, &stages)?;

        let mut summary = trained.to_json();
        let more = json!({
            "name": config.name, "transmittance_mse": error.mse(), "transmittance_worst_error": error.worst(), "nonfinite": error.nonfinite(),
            "fragments": error.count(), "generate_seconds": generated, "total_seconds": start.elapsed().as_secs_f64(),
            "checks": findings.iter().map(to_json).collect::<Vec<_>>(), "folder": out,
        });
        if let (Some(summary), Value::Object(more)) = (summary.as_object_mut(), more) {
            summary.extend(more);
        }
        let report = report("run", vec![summary]);
        write_json(&out.join(MARKER), &report)?;
        if ui.json() {
            ui.print(&format!("{}\n", serde_json::to_string_pretty(&report)?))?;
        } else {
            ui.print(&text(&out, &trained, &error, &findings, start.elapsed().as_secs_f64()))?;
        }
        Ok(verdict(&findings))
    }
}

/// Refuses a folder that holds something and that `run` did not make, or made of another configuration.
fn claim(out: &Path, name: &str, force: bool) -> anyhow::Result<()> {
    let holds_something = match std::fs::read_dir(out) {
        Ok(mut entries) => entries.next().is_some(),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => false,
        Err(error) => return Err(FileError::io(out, "cannot be used as the output folder")(error).into()),
    };
    if holds_something && !out.join(MARKER).exists() {
        bail!(
            "{}: holds files that 'nmt run' did not make; choose another --out",
            out.display()
        );
    }
    let marker = std::fs::read(out.join(MARKER))
        .ok()
        .and_then(|text| serde_json::from_slice::<Value>(&text).ok());
    if let Some(other) = marker
        .as_ref()
        .and_then(|m| m["results"][0]["name"].as_str())
        .filter(|other| *other != name && !force)
    {
        bail!(
            "{}: holds the run of the configuration '{other}'; choose another --out, or pass --force to replace it",
            out.display()
        );
    }
    create_folder(out)?;
    Ok(())
}

/// Takes away an earlier run's model, which does not belong to what comes; its dataset and exports are replaced file by file.
fn clear(out: &Path, resume: bool) -> Result<(), FileError> {
    let checkpoint = (!resume).then_some("model.checkpoint.json");
    for name in ["model.json", "model.losses.csv"].into_iter().chain(checkpoint) {
        let path = out.join(name);
        match std::fs::remove_file(&path) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                return Err(FileError::io(&path, "cannot remove an earlier run's")(error));
            }
            _ => {}
        }
    }
    Ok(())
}

fn write_json(path: &Path, value: &Value) -> anyhow::Result<()> {
    let text = serde_json::to_string_pretty(value)? + "\n";
    Ok(write_atomically(path, Replace::Yes, |w| w.write_all(text.as_bytes()))?)
}

/// Error of T on fresh pixels of the configured distribution, over all fragments, those that need no network too.
fn evaluate(config: &Config, mlp: &Mlp) -> anyhow::Result<AbsoluteError> {
    let synth = Synth::new(config.synth.clone(), config.seed)?;
    let list = pixels_holding(&synth, Purpose::Evaluation, config.evaluate.pairs, &|_| {});
    let camera = config.synth.camera;
    let depth_range = (mlp.feature_set().moment_depth() == MomentDepthKind::Log).then(|| (camera.near(), camera.far()));
    let answers = Neural::new(mlp.clone()).transmittance(
        &list,
        Context {
            planes: None,
            depth_range,
        },
        &|_| {},
    )?;
    Ok(transmittance_error(
        &answers,
        &mlp.feature_set().target().of_list(&list),
    ))
}

fn text(out: &Path, trained: &Trained, error: &AbsoluteError, findings: &[Finding], seconds: f64) -> String {
    let mut text = trained.summary();
    text += &format!(
        "validation T-MSE   {:.3e}\n",
        trained.mlp.provenance.validation_loss.unwrap_or(f64::NAN)
    );
    text += &format!(
        "fresh pixels T-MSE {:.3e} over {} fragments, worst error {:.3}\n\n",
        error.mse(),
        error.count(),
        error.worst()
    );
    let mut rows = vec![
        ["format", "worst export error", "checks", "file"]
            .map(str::to_owned)
            .to_vec(),
    ];
    let mut reasons: Vec<String> = Vec::new();
    for format in Format::DEFAULT {
        let of_format: Vec<&Finding> = findings.iter().filter(|f| f.format == format).collect();
        let worst = of_format
            .iter()
            .filter_map(|f| f.worst_in_distribution())
            .fold(None, |m: Option<f64>, e| {
                Some(m.map_or(e, |m| if m >= e { m } else { e }))
            });
        let count = |wanted: fn(&Status) -> bool| of_format.iter().filter(|f| wanted(&f.status)).count();
        let (failed, skipped) = (
            count(|s| matches!(s, Status::Failed(_))),
            count(|s| matches!(s, Status::Skipped(_))),
        );
        let mut checks = format!("{} ok", of_format.len() - failed - skipped);
        for (n, word) in [(failed, "FAILED"), (skipped, "skipped")] {
            if n > 0 {
                checks += &format!(", {n} {word}");
            }
        }
        for f in of_format {
            let line = match &f.status {
                Status::Passed => continue,
                Status::Failed(why) => format!("FAILED {}, {}: {why}", f.format.name(), f.tool),
                Status::Skipped(why) => format!("skipped: {}, {}: {why}", f.tool, f.question),
            };
            if !reasons.contains(&line) {
                reasons.push(line);
            }
        }
        rows.push(vec![
            format.name().to_owned(),
            worst.map_or("-".to_owned(), |e| format!("{e:.2e}")),
            checks,
            format.path(&out.join("exports"), &trained.mlp).display().to_string(),
        ]);
    }
    text += &table(&rows);
    for reason in reasons {
        text += &format!("{reason}\n");
    }
    text + &format!(
        "\nmodel {}\ndataset {}\n{seconds:.1} s in all\n",
        out.join("model.json").display(),
        out.join("dataset").display()
    )
}
