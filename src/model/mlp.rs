//! A multilayer perceptron as plain arrays, with the forward pass that every export is held to.

use super::Provenance;
use crate::features::{Answer, FeatureSet, MAX_LOG_ABSORBANCE};
use crate::numeric::Scalar;
use crate::numeric::lanes::LANES;
use rayon::prelude::*;

/// Most units of one layer.
pub const MAX_UNITS: usize = 4096;

/// One fully connected layer: y = x W + b.
#[derive(Debug, Clone, PartialEq)]
pub struct Dense {
    inputs: usize,
    outputs: usize,
    /// `[inputs][outputs]`, flat.
    pub weights: Vec<f32>,
    /// `[outputs]`.
    pub biases: Vec<f32>,
}

/// What is wrong with the shapes or the numbers of a network.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ShapeError {
    /// The name cannot be that of a file.
    #[error(
        "name '{0}': only letters, digits, '-', '_' and '.' may stand in it, not first a '.', and at most 64 of them"
    )]
    Name(String),
    /// There is no layer.
    #[error("a network needs at least one layer")]
    NoLayers,
    /// A layer is empty or absurdly wide.
    #[error("layer {layer} has {inputs} inputs and {outputs} outputs; each must be from 1 to {MAX_UNITS}")]
    Width {
        /// The layer, from 1.
        layer: usize,
        /// Its inputs.
        inputs: usize,
        /// Its outputs.
        outputs: usize,
    },
    /// An array does not fit the layer.
    #[error("layer {layer}: {name} holds {found} numbers; {expected} are needed")]
    Length {
        /// The layer, from 1.
        layer: usize,
        /// The array.
        name: &'static str,
        /// Its length.
        found: usize,
        /// The right length.
        expected: usize,
    },
    /// Neighbouring layers do not fit.
    #[error("layer {layer} takes {found} inputs, but {expected} come in")]
    Chain {
        /// The layer, from 1.
        layer: usize,
        /// Its inputs.
        found: usize,
        /// Outputs of the layer before it, or the width of the feature set.
        expected: usize,
    },
    /// The last layer gives more than one number.
    #[error("the last layer has {0} outputs; one is needed, the transmittance")]
    Outputs(usize),
    /// A weight or bias is NaN or infinite.
    #[error("layer {layer}: {name}[{index}] = {value} is not finite")]
    NotFinite {
        /// The layer, from 1.
        layer: usize,
        /// The array.
        name: &'static str,
        /// Place in it.
        index: usize,
        /// The number.
        value: f32,
    },
}

impl Dense {
    /// A layer from its arrays.
    ///
    /// # Shapes
    /// `weights: [inputs][outputs]` flat, `biases: [outputs]`.
    ///
    /// # Errors
    /// [`ShapeError::Width`], [`ShapeError::Length`]; layers are numbered from 1 by [`Mlp::new`], and named 1 here.
    pub fn new(inputs: usize, outputs: usize, weights: Vec<f32>, biases: Vec<f32>) -> Result<Self, ShapeError> {
        let dense = Self {
            inputs,
            outputs,
            weights,
            biases,
        };
        dense.check(1).map(|()| dense)
    }

    fn check(&self, layer: usize) -> Result<(), ShapeError> {
        let Self { inputs, outputs, .. } = *self;
        if !(1..=MAX_UNITS).contains(&inputs) || !(1..=MAX_UNITS).contains(&outputs) {
            return Err(ShapeError::Width { layer, inputs, outputs });
        }
        for (name, values, expected) in [
            ("weights", &self.weights, inputs * outputs),
            ("biases", &self.biases, outputs),
        ] {
            if values.len() != expected {
                return Err(ShapeError::Length {
                    layer,
                    name,
                    found: values.len(),
                    expected,
                });
            }
            if let Some(index) = values.iter().position(|v| !v.is_finite()) {
                return Err(ShapeError::NotFinite {
                    layer,
                    name,
                    index,
                    value: values[index],
                });
            }
        }
        Ok(())
    }

    /// Number of inputs.
    pub fn inputs(&self) -> usize {
        self.inputs
    }

    /// Number of outputs.
    pub fn outputs(&self) -> usize {
        self.outputs
    }

    /// Weight from input i to output o.
    pub fn weight(&self, i: usize, o: usize) -> f32 {
        self.weights[i * self.outputs + o]
    }
}

/// A small network with what one must know to feed it: fully connected layers, ReLU between them, a sigmoid at the end.
///
/// The one central value: trainers produce it, everything else consumes it.
#[derive(Debug, Clone, PartialEq)]
pub struct Mlp {
    name: String,
    feature_set: FeatureSet,
    layers: Vec<Dense>,
    /// Where it comes from.
    pub provenance: Provenance,
}

/// Checks that a name can be a file's stem and stand in a comment.
///
/// # Errors
/// [`ShapeError::Name`].
pub fn check_name(name: &str) -> Result<(), ShapeError> {
    let allowed = name.chars().all(|c| c.is_ascii_alphanumeric() || "-_.".contains(c));
    if allowed && (1..=64).contains(&name.len()) && !name.starts_with('.') {
        Ok(())
    } else {
        Err(ShapeError::Name(name.to_owned()))
    }
}

impl Mlp {
    /// A network from its layers.
    ///
    /// # Errors
    /// [`ShapeError`] where the name cannot be that of a file, the layers do not chain from the width of the feature
    /// set to one output, or a number is not finite.
    pub fn new(
        name: impl Into<String>,
        feature_set: FeatureSet,
        layers: Vec<Dense>,
        provenance: Provenance,
    ) -> Result<Self, ShapeError> {
        let name = name.into();
        check_name(&name)?;
        let mut expected = feature_set.width();
        for (index, dense) in layers.iter().enumerate() {
            dense.check(index + 1)?;
            if dense.inputs != expected {
                return Err(ShapeError::Chain {
                    layer: index + 1,
                    found: dense.inputs,
                    expected,
                });
            }
            expected = dense.outputs;
        }
        match layers.last() {
            None => Err(ShapeError::NoLayers),
            Some(last) if last.outputs != 1 => Err(ShapeError::Outputs(last.outputs)),
            Some(_) => Ok(Self {
                name,
                feature_set,
                layers,
                provenance,
            }),
        }
    }

    /// Its name: a file stem, and part of a header comment.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What it must be fed.
    pub fn feature_set(&self) -> FeatureSet {
        self.feature_set
    }

    /// Its layers, first to last.
    pub fn layers(&self) -> &[Dense] {
        &self.layers
    }

    /// Number of inputs, of every hidden layer's units and of outputs: `[7, 32, 16, 1]`.
    pub fn sizes(&self) -> Vec<usize> {
        std::iter::once(self.layers[0].inputs)
            .chain(self.layers.iter().map(|l| l.outputs))
            .collect()
    }

    /// Its sizes as text: "7-32-16-1".
    pub fn shape(&self) -> String {
        self.sizes().iter().map(usize::to_string).collect::<Vec<_>>().join("-")
    }

    /// Multiply-adds of one forward pass, biases not counted.
    pub fn multiply_adds(&self) -> usize {
        self.layers.iter().map(|l| l.weights.len()).sum()
    }

    /// The network's answer to one row of features: the reference that every export is held to.
    ///
    /// Each unit starts from its bias and adds weight × input in the order of the inputs, multiplication and addition
    /// rounded apart; ReLU between layers; then [`Scalar::sigmoid`], and what the feature set makes of it
    /// ([`FeatureSet::answer`]).
    ///
    /// # Panics
    /// If the row is not as wide as the feature set.
    pub fn forward<R: Scalar>(&self, features: &[f32]) -> R {
        assert_eq!(features.len(), self.layers[0].inputs, "one feature an input");
        let mut out = [R::ZERO];
        self.forward_block::<R, 1>(features, &mut out);
        out[0]
    }

    /// [`Self::forward`] of many rows, on all cores; the same numbers to the bit.
    ///
    /// # Shapes
    /// `rows: [N, W]`, row by row; the result is `[N]`.
    ///
    /// # Panics
    /// If the length of `rows` is not a multiple of W.
    pub fn forward_batch<R: Scalar>(&self, rows: &[f32]) -> Vec<R> {
        let width = self.layers[0].inputs;
        assert_eq!(rows.len() % width, 0, "whole rows of {width} features");
        let mut out = vec![R::ZERO; rows.len() / width];
        // One task takes enough rows to outweigh handing it over.
        const TASK: usize = 64 * LANES;
        out.par_chunks_mut(TASK)
            .zip(rows.par_chunks(TASK * width))
            .for_each(|(out, rows)| {
                for (out, rows) in out.chunks_mut(LANES).zip(rows.chunks(LANES * width)) {
                    if out.len() == LANES {
                        self.forward_block::<R, LANES>(rows, out);
                    } else {
                        for (out, row) in out.iter_mut().zip(rows.chunks_exact(width)) {
                            self.forward_block::<R, 1>(row, std::slice::from_mut(out));
                        }
                    }
                }
            });
        out
    }

    /// L rows side by side: every lane does what a single row would, so that lanes can share vector registers and still
    /// agree to the bit.
    fn forward_block<R: Scalar, const L: usize>(&self, rows: &[f32], out: &mut [R]) {
        let width = self.layers[0].inputs;
        let mut x: Vec<[R; L]> = (0..width)
            .map(|i| std::array::from_fn(|lane| R::from_f32(rows[lane * width + i])))
            .collect();
        let mut y: Vec<[R; L]> = Vec::new();
        for (index, dense) in self.layers.iter().enumerate() {
            y.clear();
            y.extend(dense.biases.iter().map(|&b| [R::from_f32(b); L]));
            for (x, weights) in x.iter().zip(dense.weights.chunks_exact(dense.outputs)) {
                for (y, &w) in y.iter_mut().zip(weights) {
                    let w = R::from_f32(w);
                    for lane in 0..L {
                        y[lane] += w * x[lane];
                    }
                }
            }
            if index + 1 < self.layers.len() {
                for y in y.iter_mut().flatten() {
                    *y = y.max(R::ZERO);
                }
            }
            std::mem::swap(&mut x, &mut y);
        }
        let answer = self.feature_set.answer();
        for (lane, (out, logit)) in out.iter_mut().zip(x[0]).enumerate() {
            let s = logit.sigmoid();
            *out = match answer {
                Answer::Sigmoid => s,
                Answer::AbsorbanceShare { column, offset } => {
                    let log = R::from_f32(rows[lane * width + column].min(MAX_LOG_ABSORBANCE));
                    let absorbance = (log.exp() - R::from_f32(offset)).max(R::ZERO);
                    // e^−x is lost in rounding long before x = 100, and stays a normal number.
                    (-(absorbance * s).min(R::from_f64(80.0))).exp()
                }
            };
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::numeric::rng::stream;
    use rand::RngExt;

    /// A network of the given hidden sizes with weights in [−1, 1).
    pub(crate) fn random_mlp(hidden: &[usize], seed: u64) -> Mlp {
        let mut rng = stream(seed, 99, 0);
        let sizes: Vec<usize> = [7].into_iter().chain(hidden.iter().copied()).chain([1]).collect();
        let layers = sizes
            .windows(2)
            .map(|s| {
                let weights = (0..s[0] * s[1]).map(|_| rng.random_range(-1.0f32..1.0)).collect();
                let biases = (0..s[1]).map(|_| rng.random_range(-1.0f32..1.0)).collect();
                Dense::new(s[0], s[1], weights, biases).unwrap()
            })
            .collect();
        Mlp::new("random", FeatureSet::Paper, layers, Provenance::default()).unwrap()
    }

    /// 1 − 2 + 3 = 2 through ReLU, and a unit that is cut off.
    #[test]
    fn a_forward_pass_by_hand() {
        let mut first = vec![0.0; 14];
        (first[0], first[2], first[4]) = (1.0, -1.0, 1.0); // unit 0: f0 − f1 + f2
        first[1] = -1.0; // unit 1: −f0, cut off by ReLU
        let layers = vec![
            Dense::new(7, 2, first, vec![0.0, 0.0]).unwrap(),
            Dense::new(2, 1, vec![0.5, 100.0], vec![-1.0]).unwrap(),
        ];
        let mlp = Mlp::new("hand", FeatureSet::Paper, layers, Provenance::default()).unwrap();
        // 0.5 · 2 − 1 = 0, and the sigmoid of 0 is 1/2.
        assert_eq!(mlp.forward::<f64>(&[1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 0.0]), 0.5);
        assert_eq!((mlp.shape(), mlp.multiply_adds()), ("7-2-1".to_owned(), 16));
    }

    #[test]
    fn batches_agree_with_single_rows_to_the_bit() {
        let mlp = random_mlp(&[32, 16], 1);
        let mut rng = stream(2, 0, 0);
        for n in [0, 1, 15, 16, 17, 1000, 2049] {
            let rows: Vec<f32> = (0..7 * n).map(|_| rng.random_range(-3.0..3.0)).collect();
            let batch = mlp.forward_batch::<f32>(&rows);
            assert_eq!(batch.len(), n);
            for (row, b) in rows.chunks_exact(7).zip(&batch) {
                assert_eq!(mlp.forward::<f32>(row).to_bits(), b.to_bits());
            }
        }
    }

    #[test]
    fn f32_follows_f64_and_a_perturbed_weight_does_not() {
        let mlp = random_mlp(&[32, 16], 3);
        let mut rng = stream(4, 0, 0);
        let rows: Vec<f32> = (0..7 * 500).map(|_| rng.random_range(-3.0..3.0)).collect();
        let worst = |a: &[f32], b: &[f64]| {
            a.iter()
                .zip(b)
                .map(|(a, b)| (f64::from(*a) - b).abs())
                .fold(0.0, f64::max)
        };
        let exact = mlp.forward_batch::<f64>(&rows);
        assert!(worst(&mlp.forward_batch(&rows), &exact) < 5e-6);
        let mut perturbed = mlp.clone();
        perturbed.layers[2].weights[0] += 1e-2;
        assert!(worst(&perturbed.forward_batch(&rows), &exact) > 5e-6);
    }

    #[test]
    fn shapes_are_validated() {
        let dense = |i: usize, o: usize| Dense {
            inputs: i,
            outputs: o,
            weights: vec![0.0; i * o],
            biases: vec![0.0; o],
        };
        let error = |layers| {
            Mlp::new("x", FeatureSet::Paper, layers, Provenance::default())
                .unwrap_err()
                .to_string()
        };
        let mut not_finite = dense(7, 1);
        not_finite.weights[3] = f32::NAN;
        let mut short = dense(7, 1);
        short.biases.clear();
        insta::assert_snapshot!(
            [
                error(vec![]),
                error(vec![dense(6, 1)]),
                error(vec![dense(7, 4), dense(5, 1)]),
                error(vec![dense(7, 2)]),
                error(vec![dense(7, 0)]),
                error(vec![not_finite]),
                error(vec![short]),
                Mlp::new("../x", FeatureSet::Paper, vec![dense(7, 1)], Provenance::default())
                    .unwrap_err()
                    .to_string(),
            ]
            .join("\n")
        );
    }
}
