//! Adam on flat arrays.

use super::{AdamMoments, TrainConfig};

/// Moments below this are 0: what they would move a weight by is lost in rounding, and denormal numbers are slow.
const LEAST: f32 = 1e-30;

/// State of Adam for a flat array of parameters.
///
/// # Source
/// Kingma and Ba, *Adam: a method for stochastic optimization*, ICLR 2015, Algorithm 1.
#[derive(Debug, Clone)]
pub struct Adam {
    beta1: f64,
    beta2: f64,
    epsilon: f32,
    steps: u64,
    first: Vec<f32>,
    second: Vec<f32>,
}

impl Adam {
    /// Fresh moments for `count` parameters.
    pub fn new(count: usize, config: &TrainConfig) -> Self {
        Self {
            beta1: config.beta1,
            beta2: config.beta2,
            epsilon: config.epsilon as f32,
            steps: 0,
            first: vec![0.0; count],
            second: vec![0.0; count],
        }
    }

    /// One step against the gradient.
    pub fn step(&mut self, parameters: &mut [f32], gradient: &[f32], learning_rate: f64) {
        self.steps += 1;
        let correction = |beta: f64| 1.0 - libm::pow(beta, self.steps as f64);
        let (beta1, beta2) = (self.beta1 as f32, self.beta2 as f32);
        // m / (1 − β1^t) divided by sqrt(v / (1 − β2^t)) + ε.
        let rate = (learning_rate / correction(self.beta1)) as f32;
        let inverse = (1.0 / correction(self.beta2)) as f32;
        let epsilon = self.epsilon;
        for (((p, &g), m), v) in parameters
            .iter_mut()
            .zip(gradient)
            .zip(&mut self.first)
            .zip(&mut self.second)
        {
            let mean = beta1 * *m + (1.0 - beta1) * g;
            let square = beta2 * *v + (1.0 - beta2) * (g * g);
            *m = if mean.abs() > LEAST { mean } else { 0.0 };
            *v = if square > LEAST { square } else { 0.0 };
            *p -= rate * *m / ((*v * inverse).sqrt() + epsilon);
        }
    }

    /// The moments, each put into another order by `order`.
    pub fn moments(&self, order: impl Fn(&[f32]) -> Vec<f32>) -> AdamMoments {
        match self.steps {
            0 => AdamMoments::default(),
            steps => AdamMoments {
                steps,
                first: order(&self.first),
                second: order(&self.second),
            },
        }
    }

    /// Continues from given moments, each put into another order by `order`.
    pub fn restore(&mut self, moments: &AdamMoments, order: impl Fn(&[f32]) -> Vec<f32>) {
        self.steps = moments.steps;
        if moments.steps == 0 {
            self.first.fill(0.0);
            self.second.fill(0.0);
        } else {
            self.first = order(&moments.first);
            self.second = order(&moments.second);
        }
    }
}
