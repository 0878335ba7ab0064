//! The network with its hidden layers in f16, as exports compute it: what half precision costs, by our own arithmetic.

use crate::features::{Answer, MAX_LOG_ABSORBANCE};
use crate::model::Mlp;
use crate::numeric::quantise::round_f16_of_f32 as half;
use crate::numeric::{Real, Scalar};
use rayon::prelude::*;

/// What the last layer sees of a row; `met` is shown every sum on the way.
fn hidden(mlp: &Mlp, limit: f32, row: &[f32], mut met: impl FnMut(f32)) -> Vec<f32> {
    let layers = &mlp.layers()[..mlp.layers().len() - 1];
    let mut x: Vec<f32> = row.to_vec();
    if !layers.is_empty() {
        x.iter_mut().for_each(|x| *x = half(x.clamp(-limit, limit)));
    }
    for dense in layers {
        let mut y: Vec<f32> = dense.biases.iter().map(|&b| half(b)).collect();
        for (x, weights) in x.iter().zip(dense.weights.chunks_exact(dense.outputs())) {
            for (y, &w) in y.iter_mut().zip(weights) {
                *y = half(*y + half(half(w) * x));
                met(*y);
            }
        }
        x = y.into_iter().map(|y| y.max(0.0)).collect();
    }
    x
}

/// Answers to rows of features. Features are clamped to `limit`; weights, products and sums of hidden layers are
/// rounded to f16 one by one, in the order of [`Mlp::forward`]; the last layer and the answer are f32.
///
/// # Shapes
/// `rows: [N, W]`, row by row; the result is `[N]`.
pub fn forward_batch(mlp: &Mlp, limit: f32, rows: &[f32]) -> Vec<f32> {
    let last = &mlp.layers()[mlp.layers().len() - 1];
    let answer = |row: &[f32]| {
        let x = hidden(mlp, limit, row, |_| {});
        let logit = x
            .iter()
            .zip(&last.weights)
            .fold(last.biases[0], |sum, (x, w)| sum + w * x);
        match mlp.feature_set().answer() {
            Answer::Sigmoid => logit.sigmoid(),
            Answer::AbsorbanceShare { column, offset } => {
                let absorbance = (Real::exp(row[column].min(MAX_LOG_ABSORBANCE)) - offset).max(0.0);
                Real::exp(-(absorbance * logit.sigmoid()).min(80.0))
            }
        }
    };
    rows.par_chunks(mlp.feature_set().width()).map(answer).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::shader::half_limit;
    use crate::model::mlp::tests::random_mlp;
    use crate::numeric::rng::stream;
    use rand::RngExt;

    /// Whatever the features are, no sum overflows within the limit, and that is no idle word: a limit of 1e30 lets
    /// some.
    #[test]
    fn sums_stay_finite_within_the_limit() {
        for (hidden_sizes, seed) in [(&[32, 16][..], 1), (&[8], 2), (&[16, 16, 16], 3)] {
            let mlp = random_mlp(hidden_sizes, seed);
            let limit = half_limit(&mlp).unwrap();
            let mut rng = stream(seed, 96, 0);
            let mut overflows = 0;
            for _ in 0..2000 {
                let row: Vec<f32> = (0..7)
                    .map(|_| libm::exp2f(rng.random_range(0.0..40.0)) * if rng.random() { 1.0 } else { -1.0 })
                    .collect();
                hidden(&mlp, limit, &row, |y| assert!(y.is_finite()));
                hidden(&mlp, 1e30, &row, |y| overflows += usize::from(!y.is_finite()));
            }
            assert!(overflows > 1000);
        }
    }

    /// Half precision is near the reference, but not it.
    #[test]
    fn answers_are_near_the_reference() {
        let mlp = random_mlp(&[32, 16], 1);
        let mut rng = stream(7, 96, 0);
        let rows: Vec<f32> = (0..7 * 500).map(|_| rng.random_range(-1.0..1.0)).collect();
        let exact = mlp.forward_batch::<f64>(&rows);
        let worst = forward_batch(&mlp, 64.0, &rows)
            .iter()
            .zip(&exact)
            .map(|(a, b)| (f64::from(*a) - b).abs())
            .fold(0.0, f64::max);
        assert!((1e-5..2e-2).contains(&worst), "{worst}");
        // Control: features beyond the limit are seen as the limit.
        let far: Vec<f32> = rows.iter().map(|x| x * 100.0).collect();
        assert_ne!(forward_batch(&mlp, 64.0, &far), forward_batch(&mlp, 16.0, &far));
    }
}
