//! The training loop: epochs, shuffling, fresh pixels, validation, the best weights, checkpoints. It knows no backend.

use super::checkpoint::{CHECKPOINT_VERSION, Checkpoint, CheckpointError, Losses};
use super::feed::Feed;
use super::{AdamMoments, Backend, BackendError, TrainConfig, TrainConfigError, initial};
use crate::dataset::{Dataset, DatasetError, Rows};
use crate::features::Answer;
use crate::model::{Mlp, Provenance, ShapeError};
use crate::numeric::file::FileError;
use std::path::{Path, PathBuf};

/// Why training ended without a network.
#[derive(Debug, thiserror::Error)]
pub enum TrainError {
    /// The configuration is invalid.
    #[error(transparent)]
    Config(#[from] TrainConfigError),
    /// The backend cannot be had.
    #[error(transparent)]
    Backend(#[from] BackendError),
    /// The checkpoint cannot be continued from.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    /// The checkpoint could not be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// Fresh pixels could not be drawn.
    #[error(transparent)]
    Dataset(#[from] DatasetError),
    /// Fresh pixels are asked for, but there is no distribution to draw them from.
    #[error("dataset.refresh needs random pixels, and this dataset was made from fragment lists; set it to 0")]
    NoStream,
    /// Nothing to learn from, or to choose by.
    #[error("the dataset has no {0} rows")]
    NoRows(&'static str),
    /// The loss is no longer a number.
    #[error("the loss is not finite in epoch {epoch}; lower train.learning_rate")]
    Diverged {
        /// The epoch, from 1.
        epoch: u64,
    },
    /// The trained layers do not make a network.
    #[error(transparent)]
    Shape(#[from] ShapeError),
}

/// What is known after an epoch.
#[derive(Debug, Clone, Copy)]
pub struct EpochReport {
    /// The epoch, from 1.
    pub epoch: u64,
    /// Its losses.
    pub losses: Losses,
    /// Least validation loss so far.
    pub best_validation: f64,
    /// Rows learnt from in this process so far.
    pub samples: u64,
}

/// How training ended.
#[derive(Debug)]
pub enum Outcome<N = Mlp> {
    /// All epochs are done.
    Finished {
        /// The network with the least validation loss.
        mlp: Box<N>,
        /// Losses of every epoch.
        history: Vec<Losses>,
    },
    /// It was asked to stop; the checkpoint holds everything up to the last whole epoch.
    Interrupted {
        /// Epochs that are done.
        epochs: u64,
        /// The checkpoint; none where not one epoch was done.
        checkpoint: Option<PathBuf>,
    },
}

/// What a training is: besides the rows, all that decides its result.
#[derive(Debug, Clone)]
pub struct Job<'a> {
    /// Name of the network.
    pub name: &'a str,
    /// How to train.
    pub config: &'a TrainConfig,
    /// Seed of initial weights and shuffling.
    pub seed: u64,
    /// What computes the gradients.
    pub backend: Backend,
    /// Where checkpoints go.
    pub checkpoint: &'a Path,
    /// Whether to continue from the checkpoint that stands there.
    pub resume: bool,
    /// What is already known of the network's origin; losses and the like are filled in.
    pub provenance: Provenance,
}

/// What the loop trains on: rows, and the networks that it makes of parameters.
pub trait Subject: Sync {
    /// What is trained.
    type Network;
    /// Identifies the rows.
    fn hash(&self) -> &str;
    /// Training rows, and validation rows.
    fn rows(&self) -> [usize; 2];
    /// (inputs, outputs) of every layer of a network with these hidden ones.
    fn shapes(&self, hidden: &[usize]) -> Vec<(usize, usize)>;
    /// How logits become answers.
    fn answer(&self) -> Answer;
    /// The training rows as they stand after so many epochs.
    ///
    /// # Errors
    /// As of [`Feed::new`].
    fn feed(&self, seed: u64, batch: usize, epochs: u64) -> Result<Feed, TrainError>;
    /// A network of these parameters.
    ///
    /// # Errors
    /// [`ShapeError`] where a number is not finite.
    fn network(
        &self,
        name: &str,
        shapes: &[(usize, usize)],
        parameters: &[f32],
        provenance: Provenance,
    ) -> Result<Self::Network, ShapeError>;
    /// Mean squared error over the validation rows.
    fn validation_loss(&self, network: &Self::Network) -> f64;
    /// What a network says of its origin, of what the loop knows of it.
    fn origin(&self, known: Provenance, _: &Job<'_>) -> Provenance {
        known
    }
}

impl Subject for Dataset {
    type Network = Mlp;

    fn hash(&self) -> &str {
        &self.manifest.hash
    }

    fn rows(&self) -> [usize; 2] {
        [self.training.len(), self.validation.len()]
    }

    fn shapes(&self, hidden: &[usize]) -> Vec<(usize, usize)> {
        initial::shapes(self.training.feature_set.width(), hidden)
    }

    fn answer(&self) -> Answer {
        self.training.feature_set.answer()
    }

    fn feed(&self, seed: u64, batch: usize, epochs: u64) -> Result<Feed, TrainError> {
        Feed::new(&self.training, &self.manifest, seed, batch, epochs)
    }

    fn network(
        &self,
        name: &str,
        shapes: &[(usize, usize)],
        parameters: &[f32],
        provenance: Provenance,
    ) -> Result<Mlp, ShapeError> {
        let layers = initial::layers(shapes, parameters)?;
        Mlp::new(name, self.training.feature_set, layers, provenance)
    }

    fn validation_loss(&self, network: &Mlp) -> f64 {
        mean_squared_error(network, &self.validation)
    }
}

/// Trains a network, or as many as the configuration says, and keeps the best.
///
/// `observe` is called after every epoch; `stop` is asked before every step, and once it says true the checkpoint is
/// written and training ends. A training that was interrupted and resumed takes the same steps as one that was not.
///
/// # Errors
/// [`TrainError`]. A checkpoint that was there stays.
pub fn train<S: Subject>(
    subject: &S,
    job: &Job<'_>,
    stop: &(dyn Fn() -> bool + Sync),
    observe: &mut (dyn FnMut(&EpochReport) + Send),
) -> Result<Outcome<S::Network>, TrainError>
where
    S::Network: Send,
{
    // On a thread of the pool, whose other threads then wait for work close by.
    rayon::scope(|_| fit(subject, job, stop, observe))
}

fn fit<S: Subject>(
    subject: &S,
    job: &Job<'_>,
    stop: &(dyn Fn() -> bool + Sync),
    observe: &mut (dyn FnMut(&EpochReport) + Send),
) -> Result<Outcome<S::Network>, TrainError> {
    job.config.validate()?;
    for (name, rows) in ["training", "validation"].into_iter().zip(subject.rows()) {
        if rows == 0 {
            return Err(TrainError::NoRows(name));
        }
    }
    let Job { config, seed, .. } = *job;
    let shapes = subject.shapes(&config.hidden);
    let network = |parameters: &[f32], provenance| subject.network(job.name, &shapes, parameters, provenance);
    let optimiser = |parameters: &[f32]| job.backend.optimiser(subject.answer(), &shapes, parameters, config);

    let parameters = initial::glorot(&shapes, seed);
    let mut fitted = optimiser(&parameters)?;
    let mut done = begin(subject.hash(), job, parameters);
    if job.resume {
        done = continued(done, job.checkpoint)?;
        fitted.restore(&done.parameters, &done.moments);
    }

    let (first, last) = (done.history.len() as u64 + 1, config.epochs * config.seeds);
    let mut feed = subject.feed(seed, config.batch, first - 1)?;
    let steps_of_epoch = feed.steps();
    let mut samples = 0;
    // Networks follow each other; epochs are counted through.
    for epoch in first..=last {
        let (index, of_network) = ((epoch - 1) / config.epochs, (epoch - 1) % config.epochs);
        if of_network == 0 && epoch > 1 {
            fitted = optimiser(&initial::glorot(&shapes, seed + index))?;
        }
        let rate = |step| config.learning_rate_at(of_network * steps_of_epoch + step, config.epochs * steps_of_epoch);
        let Some(training) = feed.epoch(epoch, epoch < last, fitted.as_mut(), &rate, stop)? else {
            return interrupted(&done, job.checkpoint);
        };
        samples += feed.rows() as u64;
        let parameters = fitted.parameters();
        if !training.is_finite() || parameters.iter().any(|p| !p.is_finite()) {
            return Err(TrainError::Diverged { epoch });
        }
        let validation = subject.validation_loss(&network(&parameters, Provenance::default())?);
        if !validation.is_finite() {
            return Err(TrainError::Diverged { epoch });
        }
        let losses = Losses { training, validation };
        done.add(losses, parameters, fitted.moments());
        observe(&EpochReport {
            epoch,
            losses,
            best_validation: done.best_validation(),
            samples,
        });
        if epoch % config.checkpoint_every == 0 && epoch < last {
            done.save(job.checkpoint)?;
        }
    }
    let mlp = network(&done.best_parameters, subject.origin(provenance(job, &done), job))?;
    Ok(Outcome::Finished {
        mlp: Box::new(mlp),
        history: done.history,
    })
}

/// The checkpoint of a training before its first epoch.
fn begin(dataset_hash: &str, job: &Job<'_>, parameters: Vec<f32>) -> Checkpoint {
    Checkpoint {
        format: "nmt-checkpoint".to_owned(),
        version: CHECKPOINT_VERSION,
        config: job.config.clone(),
        seed: job.seed,
        dataset_hash: dataset_hash.to_owned(),
        backend: job.backend,
        best_parameters: parameters.clone(),
        parameters,
        moments: AdamMoments::default(),
        best_epoch: 0,
        history: Vec::new(),
    }
}

/// The checkpoint that a training goes on from, where it is of the same training.
fn continued(begun: Checkpoint, path: &Path) -> Result<Checkpoint, CheckpointError> {
    let earlier = Checkpoint::load(path)?;
    earlier.check(
        path,
        &begun.config,
        begun.seed,
        &begun.dataset_hash,
        begun.backend,
        begun.parameters.len(),
    )?;
    Ok(Checkpoint {
        config: begun.config,
        ..earlier
    })
}

/// What is known of the origin of the best network.
fn provenance(job: &Job<'_>, done: &Checkpoint) -> Provenance {
    let best = done.history[done.best_epoch as usize - 1];
    Provenance {
        seed: Some(job.seed + (done.best_epoch - 1) / job.config.epochs),
        dataset_hash: Some(done.dataset_hash.clone()),
        backend: Some(job.backend.name().to_owned()),
        epochs: Some(done.history.len() as u64),
        best_epoch: Some(done.best_epoch),
        training_loss: Some(best.training),
        validation_loss: Some(best.validation),
        ..job.provenance.clone()
    }
}

fn interrupted<N>(done: &Checkpoint, path: &Path) -> Result<Outcome<N>, TrainError> {
    let epochs = done.history.len() as u64;
    if epochs == 0 {
        return Ok(Outcome::Interrupted {
            epochs,
            checkpoint: None,
        });
    }
    done.save(path)?;
    Ok(Outcome::Interrupted {
        epochs,
        checkpoint: Some(path.to_owned()),
    })
}

/// Mean squared error of a network over rows, in f64 over its f32 answers.
pub fn mean_squared_error(mlp: &Mlp, rows: &Rows) -> f64 {
    let out = mlp.predict(&rows.features);
    out.iter()
        .zip(&rows.targets)
        .map(|(&o, &t)| (f64::from(o) - f64::from(t)).powi(2))
        .sum::<f64>()
        / rows.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::build::tests::sizes;
    use crate::dataset::{DatasetConfig, build};
    use crate::features::FeatureSet;
    use crate::synth::SynthConfig;
    use std::sync::atomic::{AtomicU32, Ordering};

    fn dataset() -> Dataset {
        let config = DatasetConfig {
            features: FeatureSet::Paper,
            training_pairs: 1000,
            validation_pairs: 300,
            ..sizes()
        };
        build("t", 3, &SynthConfig::paper(), &config, &|_| {}).unwrap()
    }

    fn config(epochs: u64) -> TrainConfig {
        toml::from_str(&format!(
            "hidden = [8]\nepochs = {epochs}\nbatch = 256\nlearning_rate = 1e-3\ncheckpoint_every = 2"
        ))
        .unwrap()
    }

    fn job<'a>(config: &'a TrainConfig, checkpoint: &'a Path, resume: bool) -> Job<'a> {
        Job {
            name: "t",
            config,
            seed: 11,
            backend: Backend::Fused,
            checkpoint,
            resume,
            provenance: Provenance::default(),
        }
    }

    fn finished(outcome: Outcome) -> (Mlp, Vec<Losses>) {
        match outcome {
            Outcome::Finished { mlp, history } => (*mlp, history),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn learns_and_keeps_the_best_on_validation() {
        let folder = tempfile::tempdir().unwrap();
        let (dataset, config) = (dataset(), config(30));
        let path = folder.path().join("m.checkpoint.json");
        let mut reports = Vec::new();
        let (mlp, history) = finished(
            train(&dataset, &job(&config, &path, false), &|| false, &mut |r| {
                reports.push(*r)
            })
            .unwrap(),
        );
        assert_eq!((history.len(), reports.len()), (30, 30));
        assert_eq!(reports[29].samples, 30 * dataset.training.len() as u64);
        assert!(history[29].training < 0.5 * history[0].training);
        let least = history.iter().map(|l| l.validation).fold(f64::INFINITY, f64::min);
        assert_eq!(mlp.provenance.validation_loss, Some(least));
        assert_eq!(mean_squared_error(&mlp, &dataset.validation), least);
    }

    /// Stopped amid an epoch and resumed: the same weights to the bit as without a stop.
    #[test]
    fn an_interruption_changes_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let (dataset, config) = (dataset(), config(7));
        let path = folder.path().join("m.checkpoint.json");
        let straight = finished(train(&dataset, &job(&config, &path, false), &|| false, &mut |_| {}).unwrap());
        let stop = stop_after(4 * 3 + 2);
        match train(&dataset, &job(&config, &path, false), &stop, &mut |_| {}).unwrap() {
            Outcome::Interrupted {
                epochs: 3,
                checkpoint: Some(at),
            } => assert_eq!(at, path),
            other => panic!("{other:?}"),
        }
        let resumed = finished(train(&dataset, &job(&config, &path, true), &|| false, &mut |_| {}).unwrap());
        assert_eq!(resumed, straight);
    }

    /// Says stop when asked once more than `steps` times.
    fn stop_after(steps: u32) -> impl Fn() -> bool + Sync {
        let asked = AtomicU32::new(0);
        move || asked.fetch_add(1, Ordering::Relaxed) >= steps
    }

    /// The same with fresh pixels every epoch, the fused kernel, a falling step size and two networks, wherever it
    /// stops.
    #[test]
    fn an_interruption_changes_nothing_of_a_stream() {
        let folder = tempfile::tempdir().unwrap();
        let sizes = DatasetConfig {
            features: FeatureSet::Recentred,
            training_pairs: 2000,
            validation_pairs: 300,
            refresh: 0.25,
            ..sizes()
        };
        let dataset = build("t", 3, &SynthConfig::paper(), &sizes, &|_| {}).unwrap();
        let config: TrainConfig = toml::from_str(
            "hidden = [8]\nepochs = 7\nbatch = 512\nlearning_rate = 1e-2\nschedule = \"cosine\"\nseeds = 2",
        )
        .unwrap();
        let path = folder.path().join("m.checkpoint.json");
        let of = |resume| Job {
            backend: Backend::Fused,
            ..job(&config, &path, resume)
        };
        let straight = finished(train(&dataset, &of(false), &|| false, &mut |_| {}).unwrap());
        assert_eq!(straight.1.len(), 14);
        for steps in [4 * 6 + 1, 4 * 7, 4 * 11 + 3] {
            assert!(matches!(
                train(&dataset, &of(false), &stop_after(steps), &mut |_| {}).unwrap(),
                Outcome::Interrupted { .. }
            ));
            let resumed = finished(train(&dataset, &of(true), &|| false, &mut |_| {}).unwrap());
            assert_eq!(resumed, straight, "stopped before step {}", steps + 1);
        }
        // Control: without fresh pixels it is another training.
        let mut fixed = dataset;
        fixed.manifest.dataset.refresh = 0.0;
        assert_ne!(
            finished(train(&fixed, &of(false), &|| false, &mut |_| {}).unwrap()).1,
            straight.1
        );
    }

    #[test]
    fn stopped_before_the_first_epoch_there_is_nothing_to_keep() {
        let folder = tempfile::tempdir().unwrap();
        let config = config(3);
        let path = folder.path().join("c.json");
        let outcome = train(&dataset(), &job(&config, &path, false), &|| true, &mut |_| {}).unwrap();
        assert!(
            matches!(
                outcome,
                Outcome::Interrupted {
                    epochs: 0,
                    checkpoint: None
                }
            ) && !path.exists()
        );
    }

    #[test]
    fn foreign_checkpoints_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let (dataset, config) = (dataset(), config(4));
        let path = folder.path().join("c.json");
        let error = |job: &Job<'_>| train(&dataset, job, &|| false, &mut |_| {}).unwrap_err().to_string();
        assert!(error(&job(&config, &path, true)).contains("cannot read"));
        std::fs::write(&path, "{}").unwrap();
        assert!(error(&job(&config, &path, true)).contains("not a checkpoint"));
        train(&dataset, &job(&config, &path, false), &|| false, &mut |_| {}).unwrap();
        let faster = TrainConfig {
            learning_rate: 1e-2,
            ..config.clone()
        };
        assert!(error(&job(&faster, &path, true)).contains("another training configuration"));
        assert!(
            error(&Job {
                seed: 12,
                ..job(&config, &path, true)
            })
            .contains("another seed")
        );
        #[cfg(feature = "burn")]
        assert!(
            error(&Job {
                backend: Backend::Burn(crate::train::Engine::Ndarray),
                ..job(&config, &path, true)
            })
            .contains("another backend")
        );
        let shorter = TrainConfig {
            epochs: 1,
            ..config.clone()
        };
        assert!(error(&job(&shorter, &path, true)).contains("2 epochs are done already"));
        let longer = TrainConfig { epochs: 6, ..config };
        assert_eq!(
            finished(train(&dataset, &job(&longer, &path, true), &|| false, &mut |_| {}).unwrap())
                .1
                .len(),
            6
        );
    }

    #[test]
    fn divergence_and_bad_configurations_are_errors() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("c.json");
        let mut dataset = dataset();
        let bad = TrainConfig { batch: 0, ..config(1) };
        assert!(
            train(&dataset, &job(&bad, &path, false), &|| false, &mut |_| {})
                .unwrap_err()
                .to_string()
                .contains("train.batch = 0")
        );
        dataset.training.targets[0] = f32::INFINITY;
        let config = config(1);
        assert!(matches!(
            train(&dataset, &job(&config, &path, false), &|| false, &mut |_| {}),
            Err(TrainError::Diverged { epoch: 1 })
        ));
    }
}
