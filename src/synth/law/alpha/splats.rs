//! Gaussian splats.

use super::{Draw, Law, opacity};
use crate::numeric::rng::Stream;
use crate::synth::config::{Range, SynthError, above_zero};
use crate::synth::law::numbers::{LogUniform, NumberLaw, fill};
use serde::{Deserialize, Serialize};

/// Gaussian splats: each object draws a peak opacity, log-uniform, and a fragment of it is seen somewhere on the
/// Gaussian's footprint down to where it has fallen to min: log-uniform in [min, peak]. Clusters are objects; under the
/// other depth laws each fragment is one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Splats {
    /// Opacity at which a splat is cut off, in (0, 1].
    pub min: f64,
    /// Peak opacities, at least min.
    pub peak: Range,
}

#[derive(Debug, Clone)]
pub(super) struct Prepared {
    min: f64,
    peak: LogUniform,
}

#[derive(Default)]
pub(super) struct Scratch {
    /// A unit for each fragment.
    units: Vec<f64>,
    /// Peak opacity of each object that was met.
    peaks: Vec<f32>,
}

impl Law for Splats {
    type Prepared = Prepared;

    fn validate(&self, at: &str) -> Result<(), SynthError> {
        let Self { min, peak } = *self;
        above_zero(&format!("{at}.peak"), peak)?;
        above_zero(at, Range { min, max: peak.min })
    }

    fn prepare(&self) -> Prepared {
        Prepared {
            min: self.min,
            peak: LogUniform::new(self.peak),
        }
    }
}

impl Draw for Prepared {
    type Scratch = Scratch;

    fn draw(&self, rng: &mut Stream, object: &[u32], Scratch { units, peaks }: &mut Scratch, out: &mut Vec<f32>) {
        peaks.clear();
        fill(rng, object.len(), units);
        out.extend(object.iter().zip(&*units).map(|(&o, &u)| {
            let o = o as usize;
            while peaks.len() <= o {
                peaks.push(self.peak.draw(rng) as f32);
            }
            let peak = f64::from(peaks[o]);
            opacity(peak * libm::exp(u * libm::log(self.min / peak)))
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
        let law = Splats {
            min: 0.004,
            peak: range(0.1, 1.0),
        };
        let text = "law = 'splats'\nmin = 0.004\npeak = { min = 0.1, max = 1 }";
        assert!(says::<AlphaLaw>(text, law));
    }

    /// A splat's opacities lie between where it is cut off and its peak, uniform in their logarithm.
    #[test]
    fn footprints() {
        let splats = Splats {
            min: 0.004,
            peak: range(0.5, 0.5),
        };
        let pixels = alphas(&splats, 100, 4000);
        assert!(pixels.iter().flatten().all(|a| (0.00399..=0.50001).contains(a)));
        let logarithms: Vec<f64> = pixels.iter().map(|a| libm::log(a[0].into())).collect();
        assert!(has_mean(&logarithms, |l| l, 0.5 * libm::log(0.004 * 0.5)));
    }
}
