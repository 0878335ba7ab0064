//! Uniform opacities.

use super::reading::{AlphaReading, Shared};
use crate::synth::config::{Range, SynthError, unit};
use crate::synth::law::numbers;
use serde::{Deserialize, Serialize};

/// Uniform.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Uniform {
    /// Least, in [0, 1].
    pub min: f64,
    /// Greatest, in [0, 1].
    pub max: f64,
    /// Which fragments share a value.
    #[serde(default)]
    pub reading: AlphaReading,
}

impl super::Law for Uniform {
    type Prepared = Shared<numbers::UniformInclusive>;

    fn validate(&self, at: &str) -> Result<(), SynthError> {
        let Self { min, max, reading: _ } = *self;
        unit(at, Range { min, max })
    }

    fn prepare(&self) -> Self::Prepared {
        let Self { min, max, reading } = *self;
        Shared {
            law: numbers::UniformInclusive::new(Range { min, max }),
            reading,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{AlphaLaw, alphas};
    use super::*;
    use crate::synth::law::testing::{has_mean, says};

    #[test]
    fn in_a_file() {
        let law = Uniform {
            min: 0.0,
            max: 1.0,
            reading: AlphaReading::PerPixel,
        };
        let text = "law = 'uniform'\nmin = 0\nmax = 1\nreading = 'per-pixel'";
        assert!(says::<AlphaLaw>(text, law));
    }

    #[test]
    fn uniform_opacities() {
        for reading in [AlphaReading::PerFragment, AlphaReading::PerObject] {
            let law = Uniform {
                min: 0.01,
                max: 1.0,
                reading,
            };
            // One fragment a pixel, so that the numbers are independent.
            let first: Vec<f64> = alphas(&law, 20, 10_000).iter().map(|a| a[0].into()).collect();
            assert!(has_mean(&first, |a| a, 0.505), "{law:?}");
        }
    }
}
