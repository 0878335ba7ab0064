//! burn's autodiff and Adam, on any of its backends: the independent opinion on what our own kernel computes.

use super::{AdamMoments, Optimiser, TrainConfig, initial};
use crate::dataset::Batch;
use crate::features::{Answer, FeatureSet, MOST_LOG_ABSORBANCE};
use burn::optim::{Adam, AdamConfig, AdamState, AdaptiveMomentumState, Optimizer as _};
use burn::tensor::{Device, Tensor, TensorData, activation};

/// A network being fitted by burn.
pub struct BurnOptimiser {
    answer: Answer,
    shapes: Vec<(usize, usize)>,
    device: Device,
    adam: Adam,
    /// Weights `[in, out]` and biases `[1, out]` by turns.
    tensors: Vec<Tensor<2>>,
    states: Vec<Option<AdamState<2>>>,
}

/// burn's backends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Engine {
    /// burn-flex, on the CPU.
    Flex,
    /// burn-ndarray, on the CPU.
    Ndarray,
}

impl Engine {
    /// Its name on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Flex => "flex",
            Self::Ndarray => "ndarray",
        }
    }

    /// Where it computes.
    fn device(self) -> Device {
        match self {
            Self::Flex => Device::flex(),
            // Deprecated by burn 0.22 in favour of flex; kept because it was asked for by name.
            #[allow(deprecated)]
            Self::Ndarray => Device::ndarray(),
        }
    }
}

impl BurnOptimiser {
    /// An optimiser at the given weights.
    pub fn new(engine: Engine, set: FeatureSet, shapes: &[(usize, usize)], parameters: &[f32], config: &TrainConfig) -> Self {
        let adam = AdamConfig::new().with_beta_1(config.beta1 as f32).with_beta_2(config.beta2 as f32).with_epsilon(config.epsilon as f32).build();
        let (answer, device) = (set.answer(), engine.device());
        let mut optimiser = Self { answer, shapes: shapes.to_vec(), device, adam, tensors: Vec::new(), states: Vec::new() };
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

    /// Weighted mean squared error of a batch, and the gradient of every parameter tensor.
    fn backward(&self, batch: Batch<'_>) -> (f64, Vec<Tensor<2>>) {
        let (features, targets, weights) = batch.to_rows();
        let (n, width) = (targets.len(), self.shapes[0].0);
        let tracked = self.device.clone().autodiff();
        let column = |values: Vec<f32>| -> Tensor<2> { Tensor::from_data(TensorData::new(values, [n, 1]), &tracked) };
        let absorbance = match self.answer {
            Answer::Sigmoid => None,
            Answer::Fraction { column: at, offset } => {
                Some(column(features.chunks_exact(width).map(|row| (libm::expf(row[at].min(MOST_LOG_ABSORBANCE)) - offset).max(0.0)).collect()))
            }
        };
        let (y, weights) = (column(targets), column(weights));
        let x: Tensor<2> = Tensor::from_data(TensorData::new(features, [n, width]), &tracked);
        let leaves: Vec<Tensor<2>> = self.tensors.iter().map(|t| Tensor::from_inner(t.clone()).require_grad()).collect();
        let mut h = x;
        for (index, layer) in leaves.chunks_exact(2).enumerate() {
            h = h.matmul(layer[0].clone()) + layer[1].clone();
            h = if index + 1 < self.shapes.len() { activation::relu(h) } else { activation::sigmoid(h) };
        }
        if let Some(absorbance) = absorbance {
            h = (absorbance * h).neg().exp();
        }
        let loss = ((h - y).square() * weights).mean();
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
    fn step(&mut self, batch: Batch<'_>, learning_rate: f64) -> f64 {
        let (loss, gradients) = self.backward(batch);
        for ((tensor, state), gradient) in self.tensors.iter_mut().zip(&mut self.states).zip(gradients) {
            let (stepped, next) = self.adam.step(learning_rate, tensor.clone(), gradient, state.take());
            *tensor = stepped;
            *state = next;
        }
        loss
    }

    fn gradient(&mut self, batch: Batch<'_>) -> (f64, Vec<f32>) {
        let (loss, gradients) = self.backward(batch);
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
