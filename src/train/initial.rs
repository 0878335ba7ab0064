//! Initial weights, and the flat order of parameters.

use crate::model::{Dense, ShapeError};
use crate::numeric::rng::stream;
use rand_distr::{Distribution, Uniform};

/// Keeps these random numbers apart from those of pixels and of shuffling.
const PURPOSE: u64 = 0x1001;

/// (inputs, outputs) of every layer of a network of one output.
pub fn shapes(inputs: usize, hidden: &[usize]) -> Vec<(usize, usize)> {
    shapes_to(inputs, hidden, 1)
}

/// (inputs, outputs) of every layer of a network of so many outputs.
pub fn shapes_to(inputs: usize, hidden: &[usize], outputs: usize) -> Vec<(usize, usize)> {
    let sizes: Vec<usize> = [inputs]
        .into_iter()
        .chain(hidden.iter().copied())
        .chain([outputs])
        .collect();
    sizes.windows(2).map(|s| (s[0], s[1])).collect()
}

/// Glorot's uniform initialisation, biases 0: weights of a layer uniform in ±sqrt(6/(inputs + outputs)).
///
/// # Source
/// Glorot and Bengio, *Understanding the difficulty of training deep feedforward neural networks*, AISTATS 2010, Eq.
/// 16.
pub fn glorot(shapes: &[(usize, usize)], seed: u64) -> Vec<f32> {
    let mut parameters = Vec::new();
    for (layer, &(inputs, outputs)) in shapes.iter().enumerate() {
        let limit = (6.0 / (inputs + outputs) as f64).sqrt();
        let law = Uniform::new_inclusive(-limit, limit).expect("a finite range");
        let mut rng = stream(seed, PURPOSE, layer as u64);
        parameters.extend((0..inputs * outputs).map(|_| law.sample(&mut rng) as f32));
        parameters.extend(std::iter::repeat_n(0.0, outputs));
    }
    parameters
}

/// Layers from flat parameters.
///
/// # Errors
/// [`ShapeError`] where a number is not finite.
///
/// # Panics
/// If there are fewer parameters than the shapes need.
pub fn layers(shapes: &[(usize, usize)], parameters: &[f32]) -> Result<Vec<Dense>, ShapeError> {
    let mut rest = parameters;
    let mut take = |n: usize| {
        let (head, tail) = rest.split_at(n);
        rest = tail;
        head.to_vec()
    };
    shapes
        .iter()
        .map(|&(inputs, outputs)| Dense::new(inputs, outputs, take(inputs * outputs), take(outputs)))
        .collect()
}

/// Number of parameters.
pub fn count(shapes: &[(usize, usize)]) -> usize {
    shapes.iter().map(|(i, o)| i * o + o).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_and_counts() {
        let shapes = shapes(7, &[32, 16]);
        assert_eq!(shapes, [(7, 32), (32, 16), (16, 1)]);
        assert_eq!(count(&shapes), 801);
        let parameters = glorot(&shapes, 1);
        assert_eq!(parameters.len(), 801);
        let layers = layers(&shapes, &parameters).unwrap();
        for layer in &layers {
            let limit = (6.0 / (layer.inputs() + layer.outputs()) as f64).sqrt() as f32;
            let greatest = layer.weights.iter().fold(0.0f32, |m, w| m.max(w.abs()));
            assert!(greatest <= limit && greatest > 0.7 * limit, "{greatest} of {limit}");
            assert!(layer.biases.iter().all(|&b| b == 0.0));
        }
        assert_ne!(glorot(&shapes, 2), parameters);
    }
}
