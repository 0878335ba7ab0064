//! Training of the networks that answer with a pixel's colour: the loop of all, three outputs.

use super::feed::Feed;
use super::initial;
use super::trainer::{Job, Subject, TrainError};
use crate::dataset::colour::ColourRows;
use crate::features::Answer;
use crate::model::{ColourNetwork, Provenance, ShapeError};
use crate::numeric::digest::sha256_hex;
use rayon::prelude::*;

/// Rows that such a network is trained on and chosen by.
#[derive(Debug, Clone, PartialEq)]
pub struct ColourDataset {
    training: ColourRows,
    validation: ColourRows,
    hash: String,
}

impl ColourDataset {
    /// Of rows of one set.
    pub fn new(training: ColourRows, validation: ColourRows) -> Self {
        let arrays = [&training, &validation].map(|rows| [&rows.features, &rows.targets, &rows.weights]);
        let hash = sha256_hex(arrays.as_flattened().iter().map(|array| bytemuck::cast_slice(array)));
        Self {
            training,
            validation,
            hash,
        }
    }
}

impl Subject for ColourDataset {
    type Network = ColourNetwork;

    fn hash(&self) -> &str {
        &self.hash
    }

    fn rows(&self) -> [usize; 2] {
        [self.training.len(), self.validation.len()]
    }

    fn shapes(&self, hidden: &[usize]) -> Vec<(usize, usize)> {
        initial::shapes_to(self.training.set.columns().len(), hidden, 3)
    }

    fn answer(&self) -> Answer {
        Answer::Sigmoid
    }

    fn feed(&self, seed: u64, batch: usize, epochs: u64) -> Result<Feed, TrainError> {
        Ok(Feed::of_colours(&self.training, seed, batch, epochs))
    }

    fn network(
        &self,
        name: &str,
        shapes: &[(usize, usize)],
        parameters: &[f32],
        provenance: Provenance,
    ) -> Result<ColourNetwork, ShapeError> {
        let layers = initial::layers(shapes, parameters)?;
        Ok(ColourNetwork::new(name, self.training.set, layers, provenance).expect("layers of these shapes"))
    }

    fn validation_loss(&self, network: &ColourNetwork) -> f64 {
        mean_squared_error(network, &self.validation)
    }

    /// Its rows are no file that a hash could be compared with, and its seed is the configuration's.
    fn origin(&self, known: Provenance, job: &Job<'_>) -> Provenance {
        Provenance {
            seed: Some(job.seed),
            dataset_hash: None,
            ..known
        }
    }
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
    use super::super::{Backend, Outcome, TrainConfig, train};
    use super::*;
    use crate::dataset::colour::ColourLaw;
    use crate::features::colour::ColourSet;
    use crate::synth::{Purpose, Synth, SynthConfig};
    use std::path::Path;
    use std::sync::atomic::{AtomicU32, Ordering};

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

    fn job<'a>(config: &'a TrainConfig, seed: u64, checkpoint: &'a Path, resume: bool) -> Job<'a> {
        Job {
            name: "tiny",
            config,
            seed,
            backend: Backend::Fused,
            checkpoint,
            resume,
            provenance: Provenance::default(),
        }
    }

    fn finished(dataset: &ColourDataset, job: &Job<'_>) -> ColourNetwork {
        match train(dataset, job, &|| false, &mut |_| {}).unwrap() {
            Outcome::Finished { mlp, .. } => *mlp,
            other => panic!("{other:?}"),
        }
    }

    /// A tiny training comes below a third of the best constant colour's error, twice the same to the bit; the mean
    /// colour of the tail alone has a quarter. Control: another seed gives another network.
    #[test]
    fn it_learns_the_same_twice() {
        for set in ColourSet::ALL {
            let (training, validation) = (rows(set, Purpose::Training, 6000), rows(set, Purpose::Validation, 1500));
            let dataset = ColourDataset::new(training, validation.clone());
            let config = config();
            let trained = |seed| finished(&dataset, &job(&config, seed, Path::new("none"), false));
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

    /// Stopped amid an epoch of the first network or of the second and resumed: the same weights to the bit as without
    /// a stop. Control: another seed gives other weights.
    #[test]
    fn an_interruption_changes_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("c.json");
        let rows = |purpose, pixels| rows(ColourSet::Dfa, purpose, pixels);
        let dataset = ColourDataset::new(rows(Purpose::Training, 1500), rows(Purpose::Validation, 300));
        let config = TrainConfig {
            seeds: 2,
            epochs: 5,
            ..config()
        };
        let straight = finished(&dataset, &job(&config, 1, &path, false));
        let steps = dataset.training.len().div_ceil(config.batch) as u32;
        for epochs in [3, 7] {
            let asked = AtomicU32::new(0);
            let stop = || asked.fetch_add(1, Ordering::Relaxed) > epochs * steps;
            let outcome = train(&dataset, &job(&config, 1, &path, false), &stop, &mut |_| {}).unwrap();
            assert!(matches!(outcome, Outcome::Interrupted { epochs: done, .. } if done == u64::from(epochs)));
            assert_eq!(finished(&dataset, &job(&config, 1, &path, true)), straight);
        }
        let short = TrainConfig { seeds: 1, ..config };
        assert_ne!(finished(&dataset, &job(&short, 2, &path, false)), straight);
    }
}
