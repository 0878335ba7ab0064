//! Networks by their sizes, and the arithmetic that they take.

use super::BenchError;
use crate::dataset::Rows;
use crate::features::FeatureSet;
use crate::model::mlp::MAX_UNITS;
use crate::model::{Mlp, Provenance};
use crate::numeric::rng::stream;
use crate::train::initial;
use rand::RngExt;

/// Most rows that a benchmark holds in memory.
pub const MAX_ROWS: usize = 1 << 26;

/// Keeps the random rows of benchmarks apart from all other random numbers.
const PURPOSE: u64 = 0x100b;

/// Seed of random weights and rows: speed depends on neither.
const SEED: u64 = 1;

/// A network to be measured: sizes from the features to the one answer, and the feature set that the width stands for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Network {
    set: FeatureSet,
    sizes: Vec<usize>,
}

impl std::str::FromStr for Network {
    type Err = BenchError;

    /// "7-32-16-1", on the first feature set that is as wide: `paper` for 7, `recentred-6` for 9, `recentred-8` for 11.
    fn from_str(text: &str) -> Result<Self, BenchError> {
        let wrong = |reason: String| BenchError::Network {
            text: text.to_owned(),
            reason,
        };
        let sizes: Vec<usize> = text
            .split('-')
            .map(|part| part.parse())
            .collect::<Result<_, _>>()
            .map_err(|_| wrong("its sizes are not all numbers".to_owned()))?;
        if sizes.len() < 2 {
            return Err(wrong("it has no layer".to_owned()));
        }
        if let Some(size) = sizes.iter().find(|s| !(1..=MAX_UNITS).contains(*s)) {
            return Err(wrong(format!("a layer of {size} units is not from 1 to {MAX_UNITS}")));
        }
        if sizes[sizes.len() - 1] != 1 {
            return Err(wrong(format!("it ends in {} numbers", sizes[sizes.len() - 1])));
        }
        let set = FeatureSet::ALL
            .into_iter()
            .find(|set| set.width() == sizes[0])
            .ok_or_else(|| {
                let widths: Vec<String> = FeatureSet::ALL
                    .iter()
                    .map(|set| format!("{} ({})", set.width(), set.name()))
                    .collect();
                wrong(format!(
                    "no feature set is {} wide, but {}",
                    sizes[0],
                    widths.join(", ")
                ))
            })?;
        Ok(Self { set, sizes })
    }
}

impl std::fmt::Display for Network {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let sizes: Vec<String> = self.sizes.iter().map(usize::to_string).collect();
        f.write_str(&sizes.join("-"))
    }
}

impl Network {
    /// The same on another feature set.
    ///
    /// # Errors
    /// [`BenchError::Width`] where that has another width.
    pub fn on(self, set: FeatureSet) -> Result<Self, BenchError> {
        match set.width() == self.sizes[0] {
            true => Ok(Self { set, ..self }),
            false => Err(BenchError::Width {
                network: self.to_string(),
                found: self.sizes[0],
                expected: set.width(),
            }),
        }
    }

    /// Its feature set.
    pub fn feature_set(&self) -> FeatureSet {
        self.set
    }

    /// Units of its hidden layers.
    pub fn hidden(&self) -> &[usize] {
        &self.sizes[1..self.sizes.len() - 1]
    }

    /// (inputs, outputs) of every layer.
    pub fn shapes(&self) -> Vec<(usize, usize)> {
        initial::shapes(self.sizes[0], self.hidden())
    }

    /// Initial weights, the same for every backend.
    pub fn parameters(&self) -> Vec<f32> {
        initial::glorot(&self.shapes(), SEED)
    }

    /// As a network with [`Self::parameters`].
    ///
    /// # Errors
    /// [`BenchError::Shape`].
    pub fn mlp(&self) -> Result<Mlp, BenchError> {
        Ok(Mlp::new(
            "bench",
            self.set,
            initial::layers(&self.shapes(), &self.parameters())?,
            Provenance::default(),
        )?)
    }
}

/// Multiply-adds of one training sample: forward, gradients of all weights, and derivatives of all activations but the
/// inputs'. Biases are not counted.
pub fn training_multiply_adds(shapes: &[(usize, usize)]) -> u64 {
    let weights: usize = shapes.iter().map(|(i, o)| i * o).sum();
    (3 * weights - shapes[0].0 * shapes[0].1) as u64
}

/// Multiply-adds of one answer. Biases are not counted.
pub fn inference_multiply_adds(shapes: &[(usize, usize)]) -> u64 {
    shapes.iter().map(|(i, o)| i * o).sum::<usize>() as u64
}

/// Random features in [−1, 1) with random targets in [0, 1).
pub fn random_rows(set: FeatureSet, n: usize) -> Rows {
    let mut rng = stream(SEED, PURPOSE, 0);
    Rows {
        feature_set: set,
        features: (0..set.width() * n).map(|_| rng.random_range(-1.0..1.0)).collect(),
        targets: (0..n).map(|_| rng.random_range(0.0..1.0)).collect(),
        weights: Vec::new(),
        pixels: vec![0; n],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 7 · 32 + 32 · 16 + 16 = 752 forward; as much for the gradients of weights; without the first layer's 224 for
    /// those of activations.
    #[test]
    fn multiply_adds_by_hand() {
        let of = |text: &str| {
            let shapes = text.parse::<Network>().unwrap().shapes();
            (inference_multiply_adds(&shapes), training_multiply_adds(&shapes))
        };
        assert_eq!(of("7-32-16-1"), (752, 2032));
        assert_eq!(of("7-16-8-1"), (248, 632));
        assert_eq!(of("9-1"), (9, 18));
        // Control: derivatives of the inputs are nobody's business.
        assert_ne!(of("7-32-16-1").1, 3 * 752);
    }

    /// Counted in a backward pass written out, layer by layer.
    #[test]
    fn multiply_adds_of_loops_written_out() {
        let shapes = "11-5-3-1".parse::<Network>().unwrap().shapes();
        let mut counted = 0;
        for (layer, &(inputs, outputs)) in shapes.iter().enumerate() {
            for _ in 0..inputs * outputs {
                counted += 2 + u64::from(layer > 0);
            }
        }
        assert_eq!(training_multiply_adds(&shapes), counted);
    }

    #[test]
    fn texts_become_networks_or_errors() {
        for (text, set) in [
            ("7-32-16-1", FeatureSet::Paper),
            ("9-8-1", FeatureSet::Recentred6),
            ("11-1", FeatureSet::Recentred8),
        ] {
            let network: Network = text.parse().unwrap();
            assert_eq!((network.feature_set(), network.to_string().as_str()), (set, text));
            assert_eq!(network.mlp().unwrap().shape(), text);
        }
        let recentred = "7-4-1".parse::<Network>().unwrap().on(FeatureSet::Recentred).unwrap();
        assert_eq!(
            (recentred.feature_set(), recentred.hidden()),
            (FeatureSet::Recentred, &[4][..])
        );
        let errors = ["7", "", "7-x-1", "7-0-1", "7-32-16", "4-32-16-1", "7-99999-1"]
            .map(|text| text.parse::<Network>().unwrap_err().to_string());
        let other = recentred.on(FeatureSet::Recentred8).unwrap_err().to_string();
        insta::assert_snapshot!(errors.join("\n") + "\n" + &other);
    }
}
