//! Training of the networks that answer with a pixel's colour: the same optimisers, three outputs.

use super::trainer::TrainError;
use super::{Backend, TrainConfig, initial};
use crate::dataset::colour::ColourRows;
use crate::dataset::{Batch, Blocks};
use crate::features::Answer;
use crate::model::{ColourNetwork, Provenance};
use crate::numeric::lanes::LANES;
use crate::numeric::rng::stream;
use rand::seq::SliceRandom;
use rayon::prelude::*;

/// Keeps the random numbers of shuffling apart from all others.
const PURPOSE: u64 = 0x1011;

/// What a training is, besides its rows.
#[derive(Debug, Clone)]
pub struct ColourJob<'a> {
    /// Name of the network.
    pub name: &'a str,
    /// How to train.
    pub config: &'a TrainConfig,
    /// Seed of initial weights and shuffling.
    pub seed: u64,
    /// What computes the gradients.
    pub backend: Backend,
    /// What is already known of the network's origin; losses and the like are filled in.
    pub provenance: Provenance,
}

/// Trains a network, or as many as the configuration says, and keeps the weights with the least validation loss; none
/// once `stop` says true, which is asked before every step. `observe` is told the epoch and both losses.
///
/// # Errors
/// [`TrainError`].
pub fn train_colours(
    training: &ColourRows,
    validation: &ColourRows,
    job: ColourJob<'_>,
    stop: &dyn Fn() -> bool,
    observe: &mut dyn FnMut(u64, f64, f64),
) -> Result<Option<ColourNetwork>, TrainError> {
    let ColourJob {
        name,
        config,
        seed,
        backend,
        mut provenance,
    } = job;
    config.validate()?;
    for (name, rows) in [("training", training), ("validation", validation)] {
        if rows.is_empty() {
            return Err(TrainError::NoRows(name));
        }
    }
    let shapes = initial::shapes_to(training.set.columns().len(), &config.hidden, 3);
    let network = |parameters: &[f32], provenance| -> Result<ColourNetwork, TrainError> {
        let layers = initial::layers(&shapes, parameters)?;
        Ok(ColourNetwork::new(name, training.set, layers, provenance).expect("layers of these shapes"))
    };
    let mut rows: Vec<usize> = (0..training.len()).collect();
    rows.shuffle(&mut stream(seed, PURPOSE, 0));
    let blocks = Blocks::from_fn(shapes[0].0, 3, 0, rows.len(), |at| training.row(rows[at]));
    let (per_step, mut order) = (config.batch / LANES, (0..blocks.len() as u32).collect::<Vec<_>>());
    let steps_of_epoch = order.len().div_ceil(per_step) as u64;
    let mut best: Option<(f64, Vec<f32>)> = None;
    for index in 0..config.seeds {
        let initial = initial::glorot(&shapes, seed + index);
        let mut fitted = backend.optimiser(Answer::Sigmoid, &shapes, &initial, config)?;
        for of_network in 0..config.epochs {
            let epoch = index * config.epochs + of_network + 1;
            order.shuffle(&mut stream(seed, PURPOSE, epoch));
            let mut squared = 0.0;
            for (step, order) in (of_network * steps_of_epoch + 1..).zip(order.chunks(per_step)) {
                if stop() {
                    return Ok(None);
                }
                let batch = Batch { blocks: &blocks, order };
                let rate = config.learning_rate_at(step, config.epochs * steps_of_epoch);
                squared += fitted.step(batch, rate) * batch.rows() as f64;
            }
            let parameters = fitted.parameters();
            if !squared.is_finite() || parameters.iter().any(|p| !p.is_finite()) {
                return Err(TrainError::Diverged { epoch });
            }
            let training_loss = squared / training.len() as f64;
            let loss = mean_squared_error(&network(&parameters, Provenance::default())?, validation);
            if best.as_ref().is_none_or(|(least, _)| loss < *least) {
                best = Some((loss, parameters));
                provenance.best_epoch = Some(epoch);
                provenance.training_loss = Some(training_loss);
                provenance.validation_loss = Some(loss);
            }
            observe(epoch, training_loss, loss);
        }
    }
    provenance.seed = Some(seed);
    provenance.backend = Some(backend.name().to_owned());
    provenance.epochs = Some(config.epochs * config.seeds);
    let (_, parameters) = best.ok_or(TrainError::Diverged { epoch: 1 })?;
    network(&parameters, provenance).map(Some)
}

/// Weighted mean squared error of a network's answers over rows and channels.
fn mean_squared_error(network: &ColourNetwork, rows: &ColourRows) -> f64 {
    let of_row = |index: usize| {
        let row = rows.row(index);
        let answers = network.forward(row.features).into_iter().zip(row.targets);
        f64::from(row.weight) * answers.map(|(o, &t)| (o - f64::from(t)).powi(2)).sum::<f64>()
    };
    let errors: Vec<f64> = (0..rows.len()).into_par_iter().map(of_row).collect();
    errors.iter().sum::<f64>() / (3 * rows.len()) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::colour::ColourLaw;
    use crate::features::colour::ColourSet;
    use crate::synth::{Purpose, Synth, SynthConfig};

    fn config() -> TrainConfig {
        toml::from_str("hidden = [16, 8]\nepochs = 12\nbatch = 256\nlearning_rate = 1e-2\nschedule = \"cosine\"")
            .unwrap()
    }

    fn rows(set: ColourSet, purpose: Purpose, pixels: usize) -> ColourRows {
        let law = ColourLaw {
            palette: 4,
            shading: 0.5,
        };
        ColourRows::of(
            &Synth::new(SynthConfig::paper(), 3).unwrap(),
            3,
            purpose,
            pixels,
            law,
            set,
        )
    }

    /// A tiny training comes below a third of the best constant colour's error, twice the same to the bit; the mean
    /// colour of the tail alone has a quarter. Control: another seed gives another network.
    #[test]
    fn it_learns_the_same_twice() {
        for set in ColourSet::ALL {
            let (training, validation) = (rows(set, Purpose::Training, 6000), rows(set, Purpose::Validation, 1500));
            let trained = |seed| {
                let config = config();
                let job = ColourJob {
                    name: "tiny",
                    config: &config,
                    seed,
                    backend: Backend::Fused,
                    provenance: Provenance::default(),
                };
                train_colours(&training, &validation, job, &|| false, &mut |_, _, _| {})
                    .unwrap()
                    .unwrap()
            };
            let network = trained(1);
            let total: f64 = validation.weights.iter().map(|&w| f64::from(w)).sum();
            let mut variance = 0.0;
            for c in 0..3 {
                let of = |f: &dyn Fn(f64) -> f64| {
                    let rows = (0..validation.len()).map(|i| validation.row(i));
                    rows.map(|r| f64::from(r.weight) * f(r.targets[c].into())).sum::<f64>()
                };
                let mean = of(&|t| t) / total;
                variance += of(&|t| (t - mean).powi(2)) / (3 * validation.len()) as f64;
            }
            let loss = network.provenance.validation_loss.unwrap();
            assert!(loss < 0.33 * variance, "{set:?}: {loss:e} of {variance:e}");
            assert_eq!(mean_squared_error(&network, &validation), loss);
            assert_eq!(trained(1), network);
            assert_ne!(trained(2), network);
        }
    }

    #[test]
    fn what_is_asked_to_stop_stops() {
        let rows = rows(ColourSet::StarNt, Purpose::Training, 300);
        let config = config();
        let job = ColourJob {
            name: "tiny",
            config: &config,
            seed: 1,
            backend: Backend::Fused,
            provenance: Provenance::default(),
        };
        assert_eq!(
            train_colours(&rows, &rows, job, &|| true, &mut |_, _, _| {}).unwrap(),
            None
        );
    }
}
