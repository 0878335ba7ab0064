//! Nearly opaque fragments among faint ones.

use super::{Draw, Law};
use crate::numeric::rng::Stream;
use crate::synth::config::{Range, SynthError, above_zero, unit};
use crate::synth::law::numbers::{LogUniform, NumberLaw, UniformLerp, fill};
use serde::{Deserialize, Serialize};

/// Least opacity of a nearly opaque fragment.
const NEARLY_OPAQUE: f64 = 0.9;

/// Some fragments nearly opaque, uniform in [0.9, 1], the others faint, uniform in [0, low].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct NearOpaque {
    /// A fragment's probability of being nearly opaque, uniform, drawn once a pixel, in [0, 1].
    pub share: Range,
    /// Greatest opacity of the faint ones, log-uniform, drawn once a pixel, in (0, 1].
    pub low: Range,
}

#[derive(Debug, Clone)]
pub(super) struct Prepared {
    share: UniformLerp,
    low: LogUniform,
}

#[derive(Default)]
pub(super) struct Scratch {
    /// Two units for each fragment: which it is, and its opacity.
    units: Vec<f64>,
}

impl Law for NearOpaque {
    type Prepared = Prepared;

    fn validate(&self, at: &str) -> Result<(), SynthError> {
        unit(&format!("{at}.share"), self.share)?;
        above_zero(&format!("{at}.low"), self.low)
    }

    fn prepare(&self) -> Prepared {
        Prepared {
            share: UniformLerp(self.share),
            low: LogUniform::new(self.low),
        }
    }
}

impl Draw for Prepared {
    type Scratch = Scratch;

    fn draw(&self, rng: &mut Stream, object: &[u32], Scratch { units }: &mut Scratch, out: &mut Vec<f32>) {
        let (share, low) = (self.share.draw(rng), self.low.draw(rng));
        fill(rng, 2 * object.len(), units);
        out.extend(units.as_chunks().0.iter().map(|&[u, v]| {
            let range = if u < share {
                Range {
                    min: NEARLY_OPAQUE,
                    max: 1.0,
                }
            } else {
                Range { min: 0.0, max: low }
            };
            UniformLerp(range).at(v) as f32
        }));
    }
}

#[cfg(test)]
mod tests {
    use super::super::{AlphaLaw, alphas};
    use super::*;
    use crate::synth::law::testing::{has_mean, range, says};

    #[test]
    fn in_a_file() {
        let law = NearOpaque {
            share: range(0.0, 0.5),
            low: range(0.01, 0.5),
        };
        let text = "law = 'near-opaque'\nshare = { min = 0, max = 0.5 }\nlow = { min = 0.01, max = 0.5 }";
        assert!(says::<AlphaLaw>(text, law));
    }

    #[test]
    fn shares() {
        let (share, low) = (range(0.1, 0.5), range(0.01, 0.3));
        let pixels = alphas(&NearOpaque { share, low }, 200, 4000);
        assert!(
            pixels
                .iter()
                .flatten()
                .all(|a| (0.0..=0.3).contains(a) || (0.9..=1.0).contains(a))
        );
        let shares: Vec<f64> = pixels
            .iter()
            .map(|a| a.iter().filter(|&&a| a >= 0.9).count() as f64 / 200.0)
            .collect();
        assert!(has_mean(&shares, |s| s, 0.3));
        // Shares differ between pixels: the variance is that of the uniform law and of 200 fragments' binomial law.
        assert!(has_mean(
            &shares,
            |s| (s - 0.3).powi(2),
            0.16 / 12.0 + (0.3 * 0.7 - 0.16 / 12.0) / 200.0
        ));
    }

    #[test]
    fn degenerate_shares_are_exact() {
        let of = |share, low| NearOpaque {
            share: range(share, share),
            low: range(low, low),
        };
        let none = alphas(&of(0.0, 1.0), 5, 100);
        assert!(none.iter().flatten().any(|&a| a < 0.9));
        let all = alphas(&of(1.0, 0.1), 5, 100);
        assert!(all.iter().flatten().all(|a| (0.9..=1.0).contains(a)));
    }
}
