//! Front and back of thin closed surfaces.

use super::{Draw, Law, Shape};
use crate::numeric::rng::Stream;
use crate::synth::config::{Range, SynthError, above_zero};
use crate::synth::law::numbers::{LogUniform, NumberLaw, fill};
use serde::{Deserialize, Serialize};

/// Thin closed surfaces: each has a front, uniform, and a back behind it. An odd last fragment is a front.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Paired {
    /// Greatest distance from front to back, log-uniform, > 0; a pixel draws it once, and each of its surfaces is
    /// uniform in [0, gap].
    pub gap: Range,
}

#[derive(Debug, Clone)]
pub(super) struct Prepared {
    gap: LogUniform,
}

impl Law for Paired {
    type Prepared = Prepared;

    fn validate(&self, at: &str) -> Result<(), SynthError> {
        above_zero(&format!("{at}.gap"), self.gap)
    }

    fn prepare(&self) -> Prepared {
        Prepared {
            gap: LogUniform::new(self.gap),
        }
    }
}

impl Draw for Prepared {
    type Scratch = ();

    fn draw(&self, rng: &mut Stream, n: usize, (): &mut (), Shape { depth, object }: &mut Shape) {
        let gap = self.gap.draw(rng);
        fill(rng, n.next_multiple_of(2), depth);
        for [front, back] in depth.as_chunks_mut().0 {
            *back = *front + gap * *back;
        }
        depth.truncate(n);
        object.clear();
        object.extend((0..n as u32).map(|i| i / 2));
    }
}

#[cfg(test)]
mod tests {
    use super::super::{DepthLaw, shapes};
    use super::*;
    use crate::synth::law::testing::{DRAWS, has_mean, range, says};

    #[test]
    fn in_a_file() {
        let law = Paired { gap: range(1e-3, 1.0) };
        assert!(says::<DepthLaw>("law = 'paired'\ngap = { min = 1e-3, max = 1 }", law));
    }

    #[test]
    fn pairs() {
        for (depth, object) in shapes(&Paired { gap: range(0.01, 0.1) }, 7, 2000) {
            assert_eq!(depth.len(), 7);
            assert_eq!(object, [0, 0, 1, 1, 2, 2, 3]);
            assert!(
                depth
                    .chunks(2)
                    .all(|pair| (0.0..1.0).contains(&pair[0]) && pair.len() == 1
                        || (0.0..=0.1).contains(&(pair[1] - pair[0])))
            );
        }
        // Each surface's gap is uniform below the pixel's: half of it on average.
        let gaps = |gap| -> Vec<f64> {
            shapes(&Paired { gap }, 2, DRAWS)
                .iter()
                .map(|(x, _)| x[1] - x[0])
                .collect()
        };
        assert!(has_mean(&gaps(range(0.2, 0.2)), |g| g, 0.1));
        assert!(has_mean(
            &gaps(range(1e-3, 1.0)),
            |g| g,
            0.5 * (1.0 - 1e-3) / 1e3f64.ln()
        ));
    }
}
