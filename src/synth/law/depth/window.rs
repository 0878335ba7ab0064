//! Window depths in a range.

use super::{Draw, Law, Shape, Space};
use crate::numeric::rng::Stream;
use crate::synth::config::{Range, SynthError, unit};
use crate::synth::law::numbers::{NumberLaw, UniformInclusive, fill};
use serde::{Deserialize, Serialize};

/// Window depths uniform in a range.
///
/// # Source
/// NMT24 Sec. 3.2 gives "fragment depth ranges 0.3 to 1.0" and leaves open what it is a range of; [`DepthReading`] has
/// the readings.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Window {
    /// Least, in [0, 1].
    pub min: f64,
    /// Greatest, in [0, 1].
    pub max: f64,
    /// What the range is a range of.
    #[serde(default)]
    pub reading: DepthReading,
}

/// What the window depth range is a range of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum DepthReading {
    /// Each fragment's window depth is uniform in the range.
    #[default]
    PerFragment,
    /// A pixel's extent e = zmax − zmin is uniform in the range, its place uniform within [0, 1 − e]; one fragment lies
    /// at each end and the others are uniform between. A single fragment is uniform in [0, 1].
    PixelExtent,
}

#[derive(Debug, Clone)]
pub(super) struct Prepared {
    law: UniformInclusive,
    reading: DepthReading,
}

impl Law for Window {
    type Prepared = Prepared;

    fn space(&self) -> Space {
        Space::Window
    }

    fn validate(&self, at: &str) -> Result<(), SynthError> {
        let Self { min, max, reading: _ } = *self;
        unit(at, Range { min, max })
    }

    fn prepare(&self) -> Prepared {
        let Self { min, max, reading } = *self;
        Prepared {
            law: UniformInclusive::new(Range { min, max }),
            reading,
        }
    }
}

impl Draw for Prepared {
    type Scratch = ();

    fn draw(&self, rng: &mut Stream, n: usize, (): &mut (), shape: &mut Shape) {
        let Self { law, reading } = self;
        shape.stand_alone(n);
        let depth = &mut shape.depth;
        let anywhere = UniformInclusive::new(Range { min: 0.0, max: 1.0 });
        match reading {
            DepthReading::PerFragment => {
                fill(rng, n, depth);
                law.of_units(depth);
            }
            DepthReading::PixelExtent if n == 1 => {
                depth.clear();
                depth.push(anywhere.draw(rng));
            }
            DepthReading::PixelExtent => {
                let extent = law.draw(rng);
                let start = anywhere.draw(rng) * (1.0 - extent);
                fill(rng, n - 2, depth);
                anywhere.of_units(depth);
                depth.splice(..0, [0.0, 1.0]);
                depth
                    .iter_mut()
                    .for_each(|u| *u = (start + *u * extent).clamp(0.0, 1.0));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{DepthLaw, shapes};
    use super::*;
    use crate::synth::law::testing::{has_mean, says};

    #[test]
    fn in_a_file() {
        let window = |reading| Window {
            min: 0.3,
            max: 1.0,
            reading,
        };
        let text = "law = 'window'\nmin = 0.3\nmax = 1";
        assert!(says::<DepthLaw>(text, window(DepthReading::PerFragment)));
        let text = format!("{text}\nreading = 'pixel-extent'");
        assert!(says::<DepthLaw>(&text, window(DepthReading::PixelExtent)));
    }

    #[test]
    fn depths_and_extents() {
        let pixels = |reading, n| {
            let law = Window {
                min: 0.3,
                max: 0.7,
                reading,
            };
            shapes(&law, n, 10_000).into_iter().map(move |(depth, object)| {
                assert!(object.iter().copied().eq(0..n as u32));
                depth
            })
        };
        let first: Vec<f64> = pixels(DepthReading::PerFragment, 5).map(|depth| depth[3]).collect();
        assert!(first.iter().all(|w| (0.3..=0.7).contains(w)) && has_mean(&first, |w| w, 0.5));
        let extents: Vec<f64> = pixels(DepthReading::PixelExtent, 5)
            .map(|depth| {
                assert!(depth.iter().all(|w| (depth[0]..=depth[1]).contains(w)));
                depth[1] - depth[0]
            })
            .collect();
        assert!(extents.iter().all(|e| (0.3 - 1e-15..=0.7 + 1e-15).contains(e)) && has_mean(&extents, |e| e, 0.5));
        let single: Vec<f64> = pixels(DepthReading::PixelExtent, 1).map(|depth| depth[0]).collect();
        assert!(has_mean(&single, |w| w, 0.5) && has_mean(&single, |w| w * w, 1.0 / 3.0));
    }
}
