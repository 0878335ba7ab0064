//! A uniform shape.

use super::{Draw, Law, Shape};
use crate::numeric::rng::Stream;
use crate::synth::config::SynthError;
use crate::synth::law::numbers::fill;
use serde::{Deserialize, Serialize};

/// Uniform.
// A unit struct would take any field without an error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Uniform {}

impl Law for Uniform {
    type Prepared = Self;

    fn validate(&self, _: &str) -> Result<(), SynthError> {
        Ok(())
    }

    fn prepare(&self) -> Self {
        *self
    }
}

impl Draw for Uniform {
    type Scratch = ();

    fn draw(&self, rng: &mut Stream, n: usize, (): &mut (), shape: &mut Shape) {
        fill(rng, n, &mut shape.depth);
        shape.stand_alone(n);
    }
}

#[cfg(test)]
mod tests {
    use super::super::{DepthLaw, shapes};
    use super::*;
    use crate::synth::law::testing::{DRAWS, has_mean, says};

    #[test]
    fn in_a_file() {
        assert!(says::<DepthLaw>("law = 'uniform'", Uniform {}));
    }

    #[test]
    fn uniform_shapes() {
        let x: Vec<f64> = shapes(&Uniform {}, 8, DRAWS / 8)
            .into_iter()
            .flat_map(|(depth, _)| depth)
            .collect();
        assert!(has_mean(&x, |x| x, 0.5) && has_mean(&x, |x| x * x, 1.0 / 3.0));
        // Fragments that stand alone are objects of their own.
        assert_eq!(shapes(&Uniform {}, 5, 1)[0].1, [0, 1, 2, 3, 4]);
    }
}
