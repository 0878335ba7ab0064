//! `nmt run`: the main job in one go.

use super::check::{CheckArguments, findings, to_json, verdict};
use super::train::{TrainOptions, Trained, fit};
use super::ui::{Ui, table};
use super::{Verdict, generate, shown};
use crate::check::{Finding, Status};
use crate::dataset::file as dataset_file;
use crate::export::{self, Format};
use crate::numeric::file::{FileError, Lock, Replace, remove_stale_files, write_atomically};
use crate::numeric::tolerance::AbsoluteError;
use crate::train::checkpoint::{lock_path_for, path_for};
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

/// The file that marks a folder as one of `run`'s: it holds the configuration from the start, and the results in the
/// end.
const MARKER: &str = "run.json";

/// The file that says that a run is at work in a folder.
const LOCK: &str = "run.lock";

impl Run {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        let config = self.train.configure(&self.config)?;
        let out = self.out.unwrap_or_else(|| Path::new("target/nmt").join(&config.name));
        let model = out.join("model.json");
        let checkpoint = path_for(&model);
        let settings = config.to_json();
        let (_folder, same) = claim(&out, &settings, self.train.force)?;
        let _training = Lock::acquire(&lock_path_for(&model))?;
        self.train.settle_checkpoint(&checkpoint)?;
        let (dataset_folder, exports) = (out.join("dataset"), out.join("exports"));
        for folder in [&out, &dataset_folder, &exports] {
            remove_stale_files(folder)?;
        }
        clear(&out, self.train.resume, same)?;
        let started = json!({ "name": config.name, "config": settings });
        write_json(&out.join(MARKER), &ui.report("run", vec![started]))?;

        let stages = ui.stage();
        let start = Instant::now();
        let dataset = generate::build(&config, &stages)?;
        dataset_file::write(&dataset_folder, Replace::Yes, &dataset)?;
        let generated = start.elapsed().as_secs_f64();

        let Some(mut trained) = fit(&config, &dataset, &self.train, &checkpoint, &stages)? else {
            return Ok(Verdict::Interrupted);
        };
        let error = trained.measure(&config)?;
        trained.keep(&model, Replace::Yes, &checkpoint)?;

        export::write(&trained.mlp, &exports, &Format::DEFAULT, None, Replace::Yes)?;
        let findings = findings(&trained.mlp, &exports, &Format::DEFAULT, &self.check, &stages)?;

        let mut summary = trained.to_json();
        let more = json!({
            "name": config.name, "config": settings, "transmittance_mse": error.mse(),
                "transmittance_worst_error": error.worst(), "nonfinite": error.nonfinite(),
            "fragments": error.count(), "generate_seconds": generated, "total_seconds": start.elapsed().as_secs_f64(),
            "checks": findings.iter().map(to_json).collect::<Vec<_>>(), "folder": shown(&out),
        });
        if let (Some(summary), Value::Object(more)) = (summary.as_object_mut(), more) {
            summary.extend(more);
        }
        let report = ui.report("run", vec![summary]);
        write_json(&out.join(MARKER), &report)?;
        if ui.json() {
            ui.print(&format!("{}\n", serde_json::to_string_pretty(&report)?))?;
        } else {
            ui.print(&text(&out, &trained, &error, &findings, start.elapsed().as_secs_f64()))?;
        }
        Ok(verdict(&findings))
    }
}

/// Takes a folder for this run: its lock, and whether it is that of the same configuration.
///
/// Refused is a folder in which another run is at work, one that holds something `run` did not make, and, unless
/// forced, one that holds a finished model or a checkpoint of another configuration.
fn claim(out: &Path, settings: &Value, force: bool) -> anyhow::Result<(Lock, bool)> {
    let holds_something = match std::fs::read_dir(out) {
        Ok(mut entries) => entries.next().is_some(),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => false,
        Err(error) => return Err(FileError::io(out, "cannot be used as the output folder")(error).into()),
    };
    // A run that has just begun has its lock and no marker yet.
    if holds_something && !out.join(MARKER).exists() && !out.join(LOCK).exists() {
        bail!(
            "{}: holds files that 'nmt run' did not make; choose another --out",
            out.display()
        );
    }
    let lock = Lock::acquire(&out.join(LOCK))?;
    let earlier = std::fs::read(out.join(MARKER))
        .ok()
        .and_then(|text| serde_json::from_slice::<Value>(&text).ok());
    let Some(earlier) = earlier else {
        return Ok((lock, true));
    };
    let before = &earlier["results"][0];
    let model = out.join("model.json");
    let kept = model.exists() || path_for(&model).exists();
    match difference(&before["config"], settings, "") {
        None => Ok((lock, true)),
        Some(_) if force || !kept => Ok((lock, false)),
        Some(difference) => bail!(
            "{}: holds the run of the configuration '{}', which is another ({difference}); choose another --out, or \
                pass --force to replace it",
            out.display(),
            before["name"].as_str().unwrap_or("of an earlier version")
        ),
    }
}

/// The first place at which two configurations differ, and how.
fn difference(before: &Value, now: &Value, place: &str) -> Option<String> {
    match (before, now) {
        (Value::Object(a), Value::Object(b)) => {
            let mut keys: Vec<&String> = a.keys().chain(b.keys()).collect();
            keys.sort_unstable();
            keys.dedup();
            keys.into_iter().find_map(|key| {
                let place = if place.is_empty() {
                    key.clone()
                } else {
                    format!("{place}.{key}")
                };
                difference(
                    a.get(key).unwrap_or(&Value::Null),
                    b.get(key).unwrap_or(&Value::Null),
                    &place,
                )
            })
        }
        _ if before == now => None,
        _ if place.is_empty() => Some("it does not say which".to_owned()),
        _ => Some(format!("{place} was {before} and is {now}")),
    }
}

/// Takes away what an earlier run left and what does not belong to what comes; the rest is replaced file by file, once
/// there is something to replace it by.
fn clear(out: &Path, resume: bool, same: bool) -> Result<(), FileError> {
    let checkpoint = (!resume).then_some("model.checkpoint.json");
    let finished = (!same).then_some(["model.json", "model.losses.csv"]);
    for name in finished.into_iter().flatten().chain(checkpoint) {
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
