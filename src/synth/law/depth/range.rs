//! Where between the camera's planes a shape is put.

use crate::numeric::doubles::DOUBLES;
use crate::synth::config::Range;
use crate::synth::law::numbers::each;
use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, f64x8};
use serde::{Deserialize, Serialize};

/// How much of the space between the planes a pixel fills, in moment depth.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct PixelRange {
    /// Half the pixel's range, h: log-uniform, in (0, 1]. The centre c is uniform in [h − 1, 1 − h], and the drawn
    /// shape is stretched until its nearest fragment lies at c − h and its farthest at c + h. Fragments that all tie,
    /// or a single one, lie at c.
    pub half: Range,
}

/// Moves and scales depths until the least is center − half and the greatest is center + half, to the bit. Depths that
/// all tie go to the centre.
pub(super) fn stretch(depth: &mut [f64], center: f64, half: f64) {
    #[inline(always)]
    fn ends<S: Simd>(simd: S, x: &[f64]) -> (f64, f64) {
        let (whole, rest) = x.as_chunks::<DOUBLES>();
        let (mut lo, mut hi) = (f64x8::splat(simd, f64::INFINITY), f64x8::splat(simd, f64::NEG_INFINITY));
        for x in whole {
            let x = f64x8::from_slice(simd, x);
            (lo, hi) = (lo.min(x), hi.max(x));
        }
        let (mut lo, mut hi) = (lo.reduce_min(), hi.reduce_max());
        for &x in rest {
            (lo, hi) = (lo.min(x), hi.max(x));
        }
        (lo, hi)
    }
    let (lo, hi) = dispatch!(Level::new(), simd => ends(simd, depth));
    if lo < hi {
        // Divided, not multiplied by a reciprocal: the farthest must give 1.
        each!(depth, simd, x => {
            let splat = |x: f64| f64x8::splat(simd, x);
            let place = (x - splat(lo)) / splat(hi - lo);
            splat(center) + splat(half) * (splat(2.0) * place - splat(1.0))
        });
    } else {
        depth.fill(center);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synth::law::numbers::{LogUniform, NumberLaw, below};
    use crate::synth::law::testing::{range, rng};
    use rand::Rng;

    #[test]
    fn stretched_extremes_are_exactly_at_the_ends() {
        let mut rng = rng();
        for _ in 0..1000 {
            let mut x: Vec<f64> = (0..2 + below(rng.next_u32(), 30))
                .map(|_| 3.0 * rng.unit() - 1.0)
                .collect();
            let half = LogUniform::new(range(1e-4, 1.0)).draw(&mut rng);
            let center = (2.0 * rng.unit() - 1.0) * (1.0 - half);
            let order = |x: &[f64]| {
                let mut order: Vec<usize> = (0..x.len()).collect();
                order.sort_by(|&i, &j| x[i].total_cmp(&x[j]));
                order
            };
            let before = order(&x);
            stretch(&mut x, center, half);
            assert_eq!(order(&x), before);
            assert_eq!(
                (x[before[0]], x[before[before.len() - 1]]),
                (center - half, center + half)
            );
        }
        for ties in [&mut [0.3][..], &mut [0.3, 0.3]] {
            stretch(ties, 0.25, 0.5);
            assert!(ties.iter().all(|&x| x == 0.25));
        }
    }
}
