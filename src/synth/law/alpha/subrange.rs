//! Opacities in a range that each pixel draws.

use super::{Draw, Law};
use crate::numeric::rng::Stream;
use crate::synth::config::{Range, SynthError, unit};
use crate::synth::law::numbers::{UniformLerp, fill};
use serde::{Deserialize, Serialize};

/// Each pixel draws a range of its own, both ends uniform in [min, max], and each fragment is uniform in that.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Subrange {
    /// Least, in [0, 1].
    pub min: f64,
    /// Greatest, in [0, 1].
    pub max: f64,
}

#[derive(Debug, Clone)]
pub(super) struct Prepared {
    end: UniformLerp,
}

#[derive(Default)]
pub(super) struct Scratch {
    /// A unit for each fragment.
    units: Vec<f64>,
}

impl Law for Subrange {
    type Prepared = Prepared;

    fn validate(&self, at: &str) -> Result<(), SynthError> {
        let Self { min, max } = *self;
        unit(at, Range { min, max })
    }

    fn prepare(&self) -> Prepared {
        let Self { min, max } = *self;
        Prepared {
            end: UniformLerp(Range { min, max }),
        }
    }
}

impl Draw for Prepared {
    type Scratch = Scratch;

    fn draw(&self, rng: &mut Stream, object: &[u32], Scratch { units }: &mut Scratch, out: &mut Vec<f32>) {
        let (a, b) = (self.end.draw(rng), self.end.draw(rng));
        let law = UniformLerp(Range {
            min: a.min(b),
            max: a.max(b),
        });
        fill(rng, object.len(), units);
        out.extend(units.iter().map(|&u| law.at(u) as f32));
    }
}

#[cfg(test)]
mod tests {
    use super::super::{AlphaLaw, alphas};
    use super::*;
    use crate::synth::law::testing::{has_mean, says};

    #[test]
    fn in_a_file() {
        let text = "law = 'subrange'\nmin = 0\nmax = 1";
        assert!(says::<AlphaLaw>(text, Subrange { min: 0.0, max: 1.0 }));
    }

    #[test]
    fn subranges() {
        let pixels = alphas(&Subrange { min: 0.2, max: 0.8 }, 100, 4000);
        assert!(pixels.iter().flatten().all(|a| (0.2..=0.8).contains(a)));
        let first: Vec<f64> = pixels.iter().map(|a| a[0].into()).collect();
        assert!(has_mean(&first, |a| a, 0.5));
        let extents: Vec<f64> = pixels
            .iter()
            .map(|a| f64::from(a.iter().copied().fold(0.0, f32::max) - a.iter().copied().fold(1.0, f32::min)))
            .collect();
        // The two ends are 0.6/3 apart on average; the extremes of 100 draws reach 99/101 of that.
        assert!(has_mean(&extents, |e| e, 0.2 * 99.0 / 101.0));
        let opaque = alphas(&Subrange { min: 1.0, max: 1.0 }, 5, 100);
        assert!(opaque.iter().flatten().all(|&a| a == 1.0));
    }
}
