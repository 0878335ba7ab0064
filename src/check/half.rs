//! The network with its hidden layers in f16, as exports compute it: what half precision costs, by our own arithmetic.

use crate::features::{Answer, MOST_LOG_ABSORBANCE};
use crate::model::Mlp;
use crate::numeric::Real;
use crate::numeric::quantise::round_f16_of_f32 as half;
use rayon::prelude::*;

/// Answers to rows of features. Features are clamped to `limit`; weights, products and sums of hidden layers are rounded to f16 one by one, in the order of
/// [`Mlp::forward`]; the last layer and the answer are f32.
///
/// # Shapes
/// `rows: [N, W]`, row by row; the result is `[N]`.
pub fn forward_batch(mlp: &Mlp, limit: f32, rows: &[f32]) -> Vec<f32> {
    let (last, hidden) = mlp.layers().split_last().expect("at least one layer");
    let answer = |row: &[f32]| {
        let mut x: Vec<f32> = row.to_vec();
        if !hidden.is_empty() {
            x.iter_mut().for_each(|x| *x = half(x.clamp(-limit, limit)));
        }
        for dense in hidden {
            let mut y: Vec<f32> = dense.biases.iter().map(|&b| half(b)).collect();
            for (x, weights) in x.iter().zip(dense.weights.chunks_exact(dense.outputs())) {
                for (y, &w) in y.iter_mut().zip(weights) {
                    *y = half(*y + half(half(w) * x));
                }
            }
            x = y.into_iter().map(|y| y.max(0.0)).collect();
        }
        let logit = x.iter().zip(&last.weights).fold(last.biases[0], |sum, (x, w)| sum + w * x);
        match mlp.feature_set().answer() {
            Answer::Sigmoid => logit.sigmoid(),
            Answer::Fraction { column, offset } => {
                let absorbance = (Real::exp(row[column].min(MOST_LOG_ABSORBANCE)) - offset).max(0.0);
                Real::exp(-(absorbance * logit.sigmoid()).min(80.0))
            }
        }
    };
    rows.par_chunks(mlp.feature_set().width()).map(answer).collect()
}
