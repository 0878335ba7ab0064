//! burn's autodiff and Adam, on either of its CPU backends.

use super::{AdamMoments, Backend, Optimiser, TrainConfig, initial};
use burn::optim::{Adam, AdamConfig, AdamState, AdaptiveMomentumState, Optimizer as _};
use burn::tensor::{Device, Tensor, TensorData, activation};

/// A network being fitted by burn.
pub struct BurnOptimiser {
    shapes: Vec<(usize, usize)>,
    device: Device,
    adam: Adam,
    /// Weights `[in, out]` and biases `[1, out]` by turns.
    tensors: Vec<Tensor<2>>,
    states: Vec<Option<AdamState<2>>>,
}

fn device(backend: Backend) -> Device {
    match backend {
        Backend::Flex => Device::flex(),
        // Deprecated by burn 0.22 in favour of flex; kept because it was asked for by name.
        #[allow(deprecated)]
        Backend::Ndarray => Device::ndarray(),
    }
}

impl BurnOptimiser {
    /// An optimiser at the given weights.
    pub fn new(backend: Backend, shapes: &[(usize, usize)], parameters: &[f32], config: &TrainConfig) -> Self {
        let adam = AdamConfig::new().with_beta_1(config.beta1 as f32).with_beta_2(config.beta2 as f32).with_epsilon(config.epsilon as f32).build();
        let mut optimiser = Self { shapes: shapes.to_vec(), device: device(backend), adam, tensors: Vec::new(), states: Vec::new() };
        optimiser.restore(parameters, &AdamMoments::default());
        optimiser
    }

    /// `[rows, columns]` of every parameter tensor.
    fn tensor_shapes(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        self.shapes.iter().flat_map(|&(i, o)| [[i, o], [1, o]])
    }

    fn tensors_of(&self, flat: &[f32]) -> Vec<Tensor<2>> {
        assert_eq!(flat.len(), initial::count(&self.shapes), "one number a parameter");
        let mut rest = flat;
        self.tensor_shapes()
            .map(|[rows, columns]| {
                let (head, tail) = rest.split_at(rows * columns);
                rest = tail;
                Tensor::from_data(TensorData::new(head.to_vec(), [rows, columns]), &self.device)
            })
            .collect()
    }

    /// Mean squared error of a batch, and the gradient of every parameter tensor.
    fn backward(&self, features: &[f32], targets: &[f32]) -> (f64, Vec<Tensor<2>>) {
        let (n, width) = (targets.len(), self.shapes[0].0);
        let tracked = self.device.clone().autodiff();
        let x: Tensor<2> = Tensor::from_data(TensorData::new(features.to_vec(), [n, width]), &tracked);
        let y: Tensor<2> = Tensor::from_data(TensorData::new(targets.to_vec(), [n, 1]), &tracked);
        let leaves: Vec<Tensor<2>> = self.tensors.iter().map(|t| Tensor::from_inner(t.clone()).require_grad()).collect();
        let mut h = x;
        for (index, layer) in leaves.chunks_exact(2).enumerate() {
            h = h.matmul(layer[0].clone()) + layer[1].clone();
            h = if index + 1 < self.shapes.len() { activation::relu(h) } else { activation::sigmoid(h) };
        }
        let loss = (h - y).square().mean();
        let mut gradients = loss.backward();
        let loss: f32 = loss.into_scalar();
        let gradients = leaves.iter().map(|leaf| leaf.grad_remove(&mut gradients).expect("every parameter takes part in the loss")).collect();
        (loss.into(), gradients)
    }
}

fn numbers(tensor: Tensor<2>) -> Vec<f32> {
    tensor.into_data().try_to_vec::<f32>().expect("a float tensor")
}

impl Optimiser for BurnOptimiser {
    fn step(&mut self, features: &[f32], targets: &[f32], learning_rate: f64) -> f64 {
        let (loss, gradients) = self.backward(features, targets);
        for ((tensor, state), gradient) in self.tensors.iter_mut().zip(&mut self.states).zip(gradients) {
            let (stepped, next) = self.adam.step(learning_rate, tensor.clone(), gradient, state.take());
            *tensor = stepped;
            *state = next;
        }
        loss
    }

    fn gradient(&self, features: &[f32], targets: &[f32]) -> (f64, Vec<f32>) {
        let (loss, gradients) = self.backward(features, targets);
        (loss, gradients.into_iter().flat_map(numbers).collect())
    }

    fn parameters(&self) -> Vec<f32> {
        self.tensors.iter().cloned().flat_map(numbers).collect()
    }

    fn moments(&self) -> AdamMoments {
        let states: Option<Vec<_>> = self.states.iter().cloned().collect();
        let Some(states) = states else { return AdamMoments::default() };
        AdamMoments {
            steps: states[0].momentum.time as u64,
            first: states.iter().flat_map(|s| numbers(s.momentum.moment_1.clone())).collect(),
            second: states.iter().flat_map(|s| numbers(s.momentum.moment_2.clone())).collect(),
        }
    }

    fn restore(&mut self, parameters: &[f32], moments: &AdamMoments) {
        self.tensors = self.tensors_of(parameters);
        self.states = if moments.steps == 0 {
            vec![None; self.tensors.len()]
        } else {
            let pairs = self.tensors_of(&moments.first).into_iter().zip(self.tensors_of(&moments.second));
            pairs.map(|(first, second)| Some(AdamState::new(AdaptiveMomentumState::new(moments.steps as usize, first, second)))).collect()
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::features::FeatureSet;
    use crate::model::{Mlp, Provenance};
    use crate::numeric::rng::stream;
    use rand::RngExt;

    const BACKENDS: [Backend; 2] = [Backend::Flex, Backend::Ndarray];

    fn config() -> TrainConfig {
        toml::from_str("hidden = [8, 4]\nepochs = 1\nbatch = 64\nlearning_rate = 1e-3").unwrap()
    }

    fn batch(n: usize) -> (Vec<f32>, Vec<f32>) {
        let mut rng = stream(1, 0, 0);
        ((0..7 * n).map(|_| rng.random_range(-1.0..1.0)).collect(), (0..n).map(|_| rng.random_range(0.0..1.0)).collect())
    }

    fn loss(shapes: &[(usize, usize)], parameters: &[f32], features: &[f32], targets: &[f32]) -> f64 {
        let mlp = Mlp::new("fd", FeatureSet::Paper, initial::layers(shapes, parameters).unwrap(), Provenance::default()).unwrap();
        let out = mlp.forward_batch::<f64>(features);
        out.iter().zip(targets).map(|(o, &t)| (o - f64::from(t)).powi(2)).sum::<f64>() / targets.len() as f64
    }

    /// Gradients of every parameter against central differences of our own f64 forward pass. Tolerance: 1e-3 of the largest gradient (the
    /// step of 2^−11 crosses a few ReLU kinks). Control: the gradients of another batch are further off than that.
    #[test]
    fn gradients_agree_with_finite_differences() {
        let shapes = initial::shapes(7, &[8, 4]);
        let parameters = initial::glorot(&shapes, 5);
        let (features, targets) = batch(96);
        let differences: Vec<f64> = (0..parameters.len())
            .map(|i| {
                let at = |h: f32| {
                    let mut moved = parameters.clone();
                    moved[i] += h;
                    (f64::from(moved[i]), loss(&shapes, &moved, &features, &targets))
                };
                let ((x1, l1), (x0, l0)) = (at(1.0 / 2048.0), at(-1.0 / 2048.0));
                (l1 - l0) / (x1 - x0)
            })
            .collect();
        let largest = differences.iter().fold(0.0f64, |m, d| m.max(d.abs()));
        let off = |gradient: &[f32]| {
            let e = gradient.iter().zip(&differences).map(|(&g, d)| (f64::from(g) - d).abs());
            e.fold(0.0f64, |m, e| if e.is_nan() { f64::INFINITY } else { m.max(e) }) / largest
        };
        for backend in BACKENDS {
            let optimiser = backend.optimiser(&shapes, &parameters, &config());
            let (value, gradient) = optimiser.gradient(&features, &targets);
            assert_eq!(gradient.len(), parameters.len());
            assert!((value - loss(&shapes, &parameters, &features, &targets)).abs() < 1e-6);
            assert!(off(&gradient) < 1e-3, "{backend:?}: {}", off(&gradient));
            let (_, other) = optimiser.gradient(&features[..7 * 48], &targets[..48]);
            assert!(off(&other) > 1e-3, "the control passed");
        }
    }

    /// One step of Adam from fresh moments moves every parameter by lr · g/(|g| + ε·…): the closed form of its first step. Tolerance 1e-6.
    #[test]
    fn first_step_of_adam_has_its_closed_form() {
        let shapes = initial::shapes(7, &[8, 4]);
        let parameters = initial::glorot(&shapes, 6);
        let (features, targets) = batch(64);
        for backend in BACKENDS {
            let mut optimiser = backend.optimiser(&shapes, &parameters, &config());
            let (_, gradient) = optimiser.gradient(&features, &targets);
            optimiser.step(&features, &targets, 1e-3);
            for ((after, before), g) in optimiser.parameters().iter().zip(&parameters).zip(gradient) {
                if g.abs() > 1e-4 {
                    assert!((after - before + 1e-3 * g.signum()).abs() < 3e-6, "{backend:?}: {before} -> {after}, gradient {g}");
                }
            }
            assert_eq!(optimiser.moments().steps, 1);
        }
    }

    /// Steps after a restore are the steps without one, to the bit.
    #[test]
    fn restored_moments_continue_the_same_path() {
        let shapes = initial::shapes(7, &[8, 4]);
        let parameters = initial::glorot(&shapes, 7);
        let (features, targets) = batch(64);
        for backend in BACKENDS {
            let mut straight = backend.optimiser(&shapes, &parameters, &config());
            for _ in 0..3 {
                straight.step(&features, &targets, 1e-3);
            }
            let mut resumed = backend.optimiser(&shapes, &parameters, &config());
            resumed.restore(&straight.parameters(), &straight.moments());
            assert_eq!(resumed.step(&features, &targets, 1e-3), straight.step(&features, &targets, 1e-3));
            assert_eq!(resumed.parameters(), straight.parameters());
            assert_eq!(resumed.moments(), straight.moments());
        }
    }
}
