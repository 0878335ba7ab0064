//! Log-uniform opacities.

use super::reading::{AlphaReading, Shared};
use crate::synth::config::{Range, SynthError, above_zero};
use crate::synth::law::numbers;
use serde::{Deserialize, Serialize};

/// Log-uniform.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct LogUniform {
    /// Least, in (0, 1].
    pub min: f64,
    /// Greatest, in (0, 1].
    pub max: f64,
    /// Which fragments share a value.
    #[serde(default)]
    pub reading: AlphaReading,
}

impl super::Law for LogUniform {
    type Prepared = Shared<numbers::LogUniform>;

    fn validate(&self, at: &str) -> Result<(), SynthError> {
        let Self { min, max, reading: _ } = *self;
        above_zero(at, Range { min, max })
    }

    fn prepare(&self) -> Self::Prepared {
        let Self { min, max, reading } = *self;
        Shared {
            law: numbers::LogUniform::new(Range { min, max }),
            reading,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{AlphaLaw, alphas};
    use super::*;
    use crate::synth::law::testing::says;

    #[test]
    fn in_a_file() {
        let law = LogUniform {
            min: 0.01,
            max: 1.0,
            reading: AlphaReading::PerObject,
        };
        let text = "law = 'log-uniform'\nmin = 0.01\nmax = 1\nreading = 'per-object'";
        assert!(says::<AlphaLaw>(text, law));
    }

    /// Tests of the readings check the law itself.
    #[test]
    fn a_degenerate_range_is_exact() {
        let law = LogUniform {
            min: 0.3,
            max: 0.3,
            reading: AlphaReading::PerFragment,
        };
        assert!(alphas(&law, 5, 100).iter().flatten().all(|&a| a == 0.3));
    }
}
