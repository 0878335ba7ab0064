//! `nmt train`

use super::colour::{self, ColourConfig};
use super::config::Config;
use super::ui::Ui;
use super::{Verdict, generate, interrupt, keep_inputs};
use crate::dataset::build::pixels_holding;
use crate::dataset::{Dataset, file as dataset_file};
use crate::evaluate::transmittance_error;
use crate::features::MomentDepthKind;
use crate::model::{Mlp, Provenance, file};
use crate::numeric::file::{FileError, Lock, Replace, may_write, write_atomically};
use crate::numeric::tolerance::AbsoluteError;
use crate::oit::{self, neural::Neural};
use crate::synth::{Purpose, Synth};
use crate::train::checkpoint::{Losses, lock_path_for, path_for};
use crate::train::trainer::Job;
use crate::train::{Backend, BackendError, Outcome, Subject, TrainConfig, train};
use anyhow::{Context, bail};
use clap::{Args, ValueEnum};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::time::Instant;

#[derive(Args)]
pub struct Train {
    /// Configuration file.
    pub(super) config: PathBuf,
    /// Model file to write.
    #[arg(long, value_name = "MODEL.json")]
    pub(super) out: PathBuf,
    /// Dataset that `nmt generate` wrote; without it the configured one is generated in memory.
    #[arg(long, value_name = "DIR")]
    pub(super) dataset: Option<PathBuf>,
    #[command(flatten)]
    pub(super) options: TrainOptions,
}

/// Options that `train` and `run` share.
#[derive(Args, Clone)]
pub struct TrainOptions {
    /// What computes the gradients.
    #[arg(long, value_enum, default_value = "fused")]
    pub backend: BackendName,
    /// Epochs, instead of the configured number.
    #[arg(long, value_name = "N")]
    pub epochs: Option<u64>,
    /// Continue an interrupted training from its checkpoint.
    #[arg(long)]
    pub resume: bool,
    /// Replace what is there, a checkpoint included.
    #[arg(long, conflicts_with = "resume")]
    pub force: bool,
}

#[derive(ValueEnum, Clone, Copy)]
pub enum BackendName {
    /// Our own kernel, the fastest by far.
    Fused,
    /// burn's flex, the successor of ndarray and the faster one.
    Flex,
    /// burn-ndarray.
    Ndarray,
    /// burn on a GPU through wgpu, where the program was built with --features wgpu.
    Wgpu,
    /// burn on a CUDA device, where the program was built with --features cuda.
    Cuda,
}

impl TryFrom<BackendName> for Backend {
    type Error = BackendError;

    fn try_from(name: BackendName) -> Result<Self, BackendError> {
        Self::named(match name {
            BackendName::Fused => "fused",
            BackendName::Flex => "flex",
            BackendName::Ndarray => "ndarray",
            BackendName::Wgpu => "wgpu",
            BackendName::Cuda => "cuda",
        })
    }
}

impl TrainOptions {
    /// Reads the configuration with the number of epochs that is asked for; a backend that cannot be had is refused
    /// before anything is made.
    pub fn configure(&self, path: &Path) -> anyhow::Result<Config> {
        Backend::try_from(self.backend)
            .and_then(Backend::adapter)
            .context("--backend")?;
        let mut config = Config::load(path)?;
        self.set_epochs(&mut config.train)?;
        Ok(config)
    }

    /// Replaces a configuration's number of epochs by the one that is asked for.
    pub fn set_epochs(&self, config: &mut TrainConfig) -> anyhow::Result<()> {
        if let Some(epochs) = self.epochs {
            config.epochs = epochs;
            config.validate().context("--epochs")?;
        }
        Ok(())
    }

    /// Refuses to run over a checkpoint unless told what to do about it.
    pub fn settle_checkpoint(&self, checkpoint: &Path) -> anyhow::Result<()> {
        match (checkpoint.exists(), self.resume) {
            (true, false) if !self.force => {
                bail!(
                    "{}: the checkpoint of an interrupted training; pass --resume to continue it, or --force to train \
                        anew",
                    checkpoint.display()
                )
            }
            (false, true) => bail!(
                "{}: there is no checkpoint to resume from; leave out --resume to train anew",
                checkpoint.display()
            ),
            _ => Ok(()),
        }
    }
}

impl Train {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        let replace = if self.options.force { Replace::Yes } else { Replace::No };
        if let Some(config) = ColourConfig::load(&self.config)? {
            return colour::train(config, &self, replace, ui);
        }
        let config = self.options.configure(&self.config)?;
        keep_inputs(&[&self.config], &self.out)?;
        if let Some(folder) = &self.dataset {
            refuse_other(folder, &config)?;
        }
        // Before anything is looked at that another training may be about to write.
        let _lock = Lock::acquire(&lock_path_for(&self.out))?;
        may_write(&self.out, replace)?;
        may_write(&losses_path(&self.out), replace)?;
        let checkpoint = path_for(&self.out);
        self.options.settle_checkpoint(&checkpoint)?;
        let dataset = match &self.dataset {
            Some(folder) => dataset_file::read_from(folder)?,
            None => generate::build(&config, ui)?,
        };
        let Some(mut trained) = fit(&config, &dataset, &self.options, &checkpoint, ui)? else {
            return Ok(Verdict::Interrupted);
        };
        // Pixels that were drawn from given lists have no distribution to draw others from.
        if dataset.manifest.synth.is_some() {
            trained.measure(&config)?;
        }
        trained.keep(&self.out, replace, &checkpoint)?;
        if ui.json() {
            ui.print_json("train", vec![trained.to_json()])?;
        } else {
            ui.print(&format!("{}{}\n", trained.summary(), self.out.display()))?;
        }
        Ok(Verdict::Fine)
    }
}

/// Refuses a dataset that another configuration made, by its manifest: before its arrays are read.
fn refuse_other(folder: &Path, config: &Config) -> anyhow::Result<()> {
    let manifest = dataset_file::manifest_of(folder)?;
    let wanted = config.dataset.features;
    if manifest.features != wanted {
        bail!(
            "{}: features '{}', but the configuration wants '{}'",
            folder.display(),
            manifest.features.name(),
            wanted.name()
        );
    }
    // Pixels that were drawn from given lists have no distribution to agree with.
    let other_synth = manifest.synth.as_ref().is_some_and(|synth| *synth != config.synth);
    if other_synth || manifest.dataset != config.dataset || manifest.seed != config.seed {
        bail!(
            "{}: generated by another configuration; generate it again, or train with its own",
            folder.display()
        );
    }
    Ok(())
}

/// Removes a checkpoint that has served.
pub fn remove_checkpoint(checkpoint: &Path) -> Result<(), FileError> {
    match std::fs::remove_file(checkpoint) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            Err(FileError::io(checkpoint, "cannot remove the checkpoint")(error))
        }
        _ => Ok(()),
    }
}

/// Where the losses of every epoch go: beside the model.
fn losses_path(model: &Path) -> PathBuf {
    model.with_extension("losses.csv")
}

/// A finished training.
pub struct Trained<N = Mlp> {
    pub mlp: N,
    pub history: Vec<Losses>,
    pub seconds: f64,
    pub samples_per_second: f64,
    /// Name of the GPU where one was trained on.
    pub adapter: Option<String>,
}

impl Trained {
    /// Error of T on fresh pixels of the configured distribution, over all fragments, those that need no network too;
    /// the network keeps it.
    pub fn measure(&mut self, config: &Config) -> anyhow::Result<AbsoluteError> {
        let synth = Synth::new(config.synth.clone(), config.seed)?;
        let list = pixels_holding(&synth, Purpose::Evaluation, config.evaluate.pairs, &|_| {});
        let camera = config.synth.camera;
        let set = self.mlp.feature_set();
        let depth_range = (set.moment_depth() == MomentDepthKind::Log).then(|| (camera.near(), camera.far()));
        let context = oit::Context {
            depth_range,
            ..oit::Context::default()
        };
        let answers = Neural::new(self.mlp.clone()).transmittance(&list, context, &|_| {})?;
        let error = transmittance_error(&answers, &set.target().of_list(&list));
        self.mlp.provenance.transmittance_mse = Some(error.mse());
        self.mlp.provenance.transmittance_worst_error = Some(error.worst());
        Ok(error)
    }

    /// Writes the model and, beside it, the losses of every epoch; the checkpoint has served.
    pub fn keep(&self, model: &Path, replace: Replace, checkpoint: &Path) -> Result<(), FileError> {
        file::save(model, replace, &self.mlp)?;
        let mut csv = "epoch,training_loss,validation_loss\n".to_owned();
        for (index, losses) in self.history.iter().enumerate() {
            csv += &format!("{},{:e},{:e}\n", index + 1, losses.training, losses.validation);
        }
        write_atomically(&losses_path(model), replace, |w| w.write_all(csv.as_bytes()))?;
        remove_checkpoint(checkpoint)
    }

    pub fn to_json(&self) -> Value {
        let p = &self.mlp.provenance;
        json!({
            "network": self.mlp.shape(), "backend": p.backend, "adapter": self.adapter, "epochs": p.epochs,
                "best_epoch": p.best_epoch,
            "training_loss": p.training_loss, "validation_loss": p.validation_loss,
            "seconds": self.seconds, "samples_per_second": self.samples_per_second,
        })
    }

    pub fn summary(&self) -> String {
        let p = &self.mlp.provenance;
        format!(
            "{}: best validation loss {:.3e} in epoch {} of {}, {:.1} s, {:.2} M samples/s{}\n",
            self.mlp.shape(),
            p.validation_loss.unwrap_or(f64::NAN),
            p.best_epoch_text().unwrap_or_default(),
            p.epochs_text().unwrap_or_default(),
            self.seconds,
            self.samples_per_second / 1e6,
            self.adapter
                .as_ref()
                .map(|name| format!(" on {name}"))
                .unwrap_or_default()
        )
    }
}

/// Trains by a configuration; none where it was interrupted.
pub fn fit(
    config: &Config,
    dataset: &Dataset,
    options: &TrainOptions,
    checkpoint: &Path,
    ui: &Ui,
) -> anyhow::Result<Option<Trained>> {
    let job = Job {
        name: &config.name,
        config: &config.train,
        seed: config.seed,
        backend: Backend::try_from(options.backend)?,
        checkpoint,
        resume: options.resume,
        provenance: Provenance::of_this_program(config.to_json()),
    };
    with_progress(dataset, &job, ui)
}

/// Trains with progress on stderr; none where it was interrupted, and then it is said what is left of it.
pub fn with_progress<S: Subject>(subject: &S, job: &Job<'_>, ui: &Ui) -> anyhow::Result<Option<Trained<S::Network>>>
where
    S::Network: Send,
{
    let adapter = job.backend.adapter()?;
    let progress = ui.progress("train", job.config.epochs * job.config.seeds);
    let start = Instant::now();
    let mut samples = 0;
    let outcome = interrupt::gracefully(|| {
        train(subject, job, &interrupt::requested, &mut |report| {
            samples = report.samples;
            let rate = samples as f64 / start.elapsed().as_secs_f64() / 1e6;
            let losses = report.losses;
            progress.set(
                report.epoch,
                format!(
                    "epochs, loss {:.3e}, validation {:.3e} (best {:.3e}), {rate:.2} M samples/s",
                    losses.training, losses.validation, report.best_validation
                ),
            );
        })
    });
    progress.finish();
    let seconds = start.elapsed().as_secs_f64();
    match outcome? {
        Outcome::Finished { mlp, history } => Ok(Some(Trained {
            mlp: *mlp,
            history,
            seconds,
            samples_per_second: samples as f64 / seconds,
            adapter,
        })),
        Outcome::Interrupted { epochs, checkpoint } => {
            match checkpoint {
                Some(path) => {
                    eprintln!(
                        "interrupted after {epochs} epochs; {} holds them, and the same command with --resume goes on",
                        path.display()
                    )
                }
                None => eprintln!("interrupted before the first epoch was done; nothing was kept"),
            }
            Ok(None)
        }
    }
}
