//! How many fragments a pixel has.

use super::numbers::{LogUniform, NumberLaw};
use crate::numeric::rng::Stream;
use crate::synth::config::Range;
use rand_distr::{Distribution, Uniform};
use serde::{Deserialize, Serialize};

/// How many fragments a pixel has, ends included.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct FragmentCount {
    /// Least.
    pub min: u32,
    /// Greatest.
    pub max: u32,
    /// What is uniform between them.
    #[serde(default)]
    pub law: CountLaw,
}

/// What is uniform between the least and the greatest count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum CountLaw {
    /// The count.
    #[default]
    Uniform,
    /// Its logarithm: n is the whole part of a log-uniform number in [min, max + 1).
    LogUniform,
}

/// A [`FragmentCount`], ready to draw.
#[derive(Debug, Clone)]
pub(super) enum Prepared {
    Uniform(Uniform<u32>),
    LogUniform { min: u32, max: u32, law: LogUniform },
}

impl Prepared {
    /// Of a validated configuration.
    pub(super) fn new(FragmentCount { min, max, law }: FragmentCount) -> Self {
        match law {
            CountLaw::Uniform => Self::Uniform(Uniform::new_inclusive(min, max).expect("validated: min <= max")),
            CountLaw::LogUniform => Self::LogUniform {
                min,
                max,
                law: LogUniform::new(Range {
                    min: min.into(),
                    max: f64::from(max) + 1.0,
                }),
            },
        }
    }

    pub(super) fn draw(&self, rng: &mut Stream) -> usize {
        match self {
            Self::Uniform(law) => law.sample(rng) as usize,
            Self::LogUniform { min, max, law } => (law.draw(rng) as u32).clamp(*min, *max) as usize,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{draws, has_mean};
    use super::*;

    #[test]
    fn counts() {
        let config = |min, max| FragmentCount {
            min,
            max,
            law: CountLaw::LogUniform,
        };
        let law = Prepared::new(config(3, 256));
        let n = draws(|rng| law.draw(rng) as f64);
        assert!(n.iter().all(|n| (3.0..=256.0).contains(n)));
        assert!(n.contains(&3.0) && n.contains(&256.0));
        // P(n) = ln((n + 1)/n)/ln(257/3).
        for k in [3.0f64, 10.0, 255.0] {
            assert!(
                has_mean(
                    &n,
                    |n| f64::from(u8::from(n == k)),
                    ((k + 1.0) / k).ln() / (257f64 / 3.0).ln()
                ),
                "{k}"
            );
        }
        let law = Prepared::new(config(7, 7));
        assert!(draws(|rng| law.draw(rng) as f64).iter().all(|&n| n == 7.0));
    }
}
