//! Which fragments of a pixel share an opacity.

use super::opacity;
use crate::numeric::rng::Stream;
use crate::synth::law::numbers::{NumberLaw, below, fill};
use rand::Rng;
use serde::{Deserialize, Serialize};

/// Most materials that the objects of a pixel are made of.
const MAX_MATERIALS: usize = 4;

/// Which fragments of a pixel share one opacity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum AlphaReading {
    /// None: each draws its own.
    #[default]
    PerFragment,
    /// All of the pixel.
    PerPixel,
    /// Those of one object. The pixel draws one to four materials, and each object is made of one of them. Front and
    /// back of a paired surface are one object, as is a cluster; under the other depth laws each fragment is an object
    /// of its own.
    PerObject,
}

/// A law of one opacity, and which fragments share it.
#[derive(Debug, Clone)]
pub(super) struct Shared<L> {
    pub law: L,
    pub reading: AlphaReading,
}

#[derive(Default)]
pub(super) struct Scratch {
    /// Units of opacities, then these.
    opacities: Vec<f64>,
    /// Opacity of each object, NaN until its first fragment is met.
    of_object: Vec<f32>,
}

impl<L: NumberLaw> super::Draw for Shared<L> {
    type Scratch = Scratch;

    fn draw(&self, rng: &mut Stream, object: &[u32], scratch: &mut Scratch, out: &mut Vec<f32>) {
        let Self { law, reading } = self;
        let Scratch { opacities, of_object } = scratch;
        match reading {
            AlphaReading::PerFragment => {
                fill(rng, object.len(), opacities);
                law.of_units(opacities);
                out.extend(opacities.iter().map(|&alpha| opacity(alpha)));
            }
            AlphaReading::PerPixel => {
                let alpha = opacity(law.draw(rng));
                out.extend(std::iter::repeat_n(alpha, object.len()));
            }
            AlphaReading::PerObject => {
                let mut materials = [0.0; MAX_MATERIALS];
                let materials = &mut materials[..1 + below(rng.next_u32(), MAX_MATERIALS)];
                materials.fill_with(|| opacity(law.draw(rng)));
                of_object.clear();
                out.extend(object.iter().map(|&o| {
                    let o = o as usize;
                    if of_object.len() <= o {
                        of_object.resize(o + 1, f32::NAN);
                    }
                    if of_object[o].is_nan() {
                        of_object[o] = materials[below(rng.next_u32(), materials.len())];
                    }
                    of_object[o]
                }));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{LogUniform, alphas};
    use super::*;
    use crate::synth::law::testing::has_mean;
    use std::collections::HashSet;

    #[test]
    fn alpha_readings() {
        for reading in [
            AlphaReading::PerFragment,
            AlphaReading::PerPixel,
            AlphaReading::PerObject,
        ] {
            let law = LogUniform {
                min: 0.01,
                max: 1.0,
                reading,
            };
            let pixels = alphas(&law, 20, 10_000);
            // One fragment a pixel, so that the numbers are independent.
            let first: Vec<f64> = pixels.iter().map(|a| a[0].into()).collect();
            assert!(has_mean(&first, f64::log10, -1.0), "{law:?}");
            let values: Vec<usize> = pixels
                .iter()
                .map(|a| a.iter().map(|a| a.to_bits()).collect::<HashSet<_>>().len())
                .collect();
            match reading {
                AlphaReading::PerObject => {
                    assert!(pixels.iter().all(|a| a.chunks(2).all(|object| object[0] == object[1])));
                    assert!((1..=4).all(|n| values.contains(&n)) && values.iter().all(|n| (1..=4).contains(n)));
                }
                AlphaReading::PerPixel => assert!(values.iter().all(|&n| n == 1)),
                AlphaReading::PerFragment => assert!(values.iter().all(|&n| n > 15)),
            }
        }
    }
}
