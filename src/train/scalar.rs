//! The twin of [`super::fused`] in plain loops over single rows: what the fast kernel is tested against, and readable.

use super::adam::Adam;
use super::{AdamMoments, Optimiser, TrainConfig};
use crate::dataset::Batch;
use crate::features::{Answer, MAX_LOG_ABSORBANCE};

/// A network being fitted one row after the other, in f64.
pub struct Scalar {
    answer: Answer,
    shapes: Vec<(usize, usize)>,
    parameters: Vec<f32>,
    adam: Adam,
}

impl Scalar {
    /// An optimiser at the given weights.
    pub fn new(answer: impl Into<Answer>, shapes: &[(usize, usize)], parameters: &[f32], config: &TrainConfig) -> Self {
        Self {
            answer: answer.into(),
            shapes: shapes.to_vec(),
            parameters: parameters.to_vec(),
            adam: Adam::new(parameters.len(), config),
        }
    }

    /// Squared error of one row, summed over the outputs, and its gradient added to `g`.
    fn row(&self, features: &[f32], targets: &[f32], weight: f64, g: &mut [f64]) -> f64 {
        // Forward: the inputs of every layer are kept.
        let mut inputs: Vec<Vec<f64>> = vec![features.iter().map(|&f| f.into()).collect()];
        let mut at = 0;
        for (index, &(i, o)) in self.shapes.iter().enumerate() {
            let (w, b) = self.parameters[at..].split_at(i * o);
            let x = &inputs[index];
            let out = (0..o).map(|u| f64::from(b[u]) + (0..i).map(|k| f64::from(w[k * o + u]) * x[k]).sum::<f64>());
            let hidden = index + 1 < self.shapes.len();
            let out = out.map(|y| if hidden { y.max(0.0) } else { y }).collect();
            inputs.push(out);
            at += (i + 1) * o;
        }
        let mut error = 0.0;
        let mut delta = Vec::new();
        for (logit, &target) in inputs[self.shapes.len()].iter().zip(targets) {
            let s = 1.0 / (1.0 + libm::exp(-logit));
            let (value, slope) = match self.answer {
                Answer::Sigmoid => (s, s * (1.0 - s)),
                Answer::AbsorbanceShare { column, offset } => {
                    let absorbance =
                        (libm::exp(features[column].min(MAX_LOG_ABSORBANCE).into()) - f64::from(offset)).max(0.0);
                    let value = libm::exp(-absorbance * s);
                    (value, -value * absorbance * s * (1.0 - s))
                }
            };
            let e = value - f64::from(target);
            error += weight * e * e;
            delta.push(2.0 * weight * e * slope);
        }
        // Backward.
        for (index, &(i, o)) in self.shapes.iter().enumerate().rev() {
            at -= (i + 1) * o;
            let x = &inputs[index];
            for u in 0..o {
                for k in 0..i {
                    g[at + k * o + u] += x[k] * delta[u];
                }
                g[at + i * o + u] += delta[u];
            }
            let w = &self.parameters[at..at + i * o];
            delta = (0..i)
                .map(|k| {
                    if x[k] > 0.0 {
                        (0..o).map(|u| f64::from(w[k * o + u]) * delta[u]).sum()
                    } else {
                        0.0
                    }
                })
                .collect();
        }
        error
    }
}

impl Optimiser for Scalar {
    fn step(&mut self, batch: Batch<'_>, learning_rate: f64) -> f64 {
        let (error, gradient) = self.gradient(batch);
        self.adam.step(&mut self.parameters, &gradient, learning_rate);
        error
    }

    fn gradient(&mut self, batch: Batch<'_>) -> (f64, Vec<f32>) {
        let (features, targets, weights) = batch.to_rows();
        let width = batch.blocks.width();
        let mut g = vec![0.0; self.parameters.len()];
        let mut error = 0.0;
        let rows = features
            .chunks_exact(width)
            .zip(targets.chunks_exact(batch.blocks.outputs()));
        for ((row, targets), &weight) in rows.zip(&weights) {
            error += self.row(row, targets, weight.into(), &mut g);
        }
        let n = targets.len() as f64;
        (error / n, g.into_iter().map(|g| (g / n) as f32).collect())
    }

    fn parameters(&self) -> Vec<f32> {
        self.parameters.clone()
    }

    fn moments(&self) -> AdamMoments {
        self.adam.moments(<[f32]>::to_vec)
    }

    fn restore(&mut self, parameters: &[f32], moments: &AdamMoments) {
        self.parameters = parameters.to_vec();
        self.adam.restore(moments, <[f32]>::to_vec);
    }
}
