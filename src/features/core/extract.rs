//! Rows of features, pixel by pixel: for datasets and for training.

use super::code::{Codes, CoreFragment};
use super::pixel::{Answer, Between, Passes, Query, with_sums};
use super::{CoreSet, FIXED};
use crate::features::{Extractor, Known, Sampled};
use crate::numeric::rng::Stream;
use crate::pixel::{DepthError, Pixel, absorbance};
use rand::RngExt;

/// [`FeatureSpec::pixel`](crate::features::FeatureSpec::pixel) of sets with a core.
pub(super) fn pixel(
    e: &Extractor,
    pixel: Pixel<'_>,
    features: &mut [f32],
    known: &mut [Known],
) -> Result<(), DepthError> {
    let (set, codes) = e.codes();
    with_sums!(set.moments, N => {
        let mut passes = Passes::default();
        let between: Between<N> = passes.first(&set, &codes, pixel);
        let rows = features.chunks_exact_mut(FIXED + set.moments).zip(known);
        for ((row, known), &fragment) in rows.zip(&passes.fragments) {
            match between.answer(&codes, fragment) {
                Answer::Depth(depth) => {
                    row.fill(0.0);
                    *known = Known::Transmittance((-depth).exp());
                }
                Answer::Query(query) => {
                    write(&query, row);
                    *known = Known::Front((-query.front).exp());
                }
            }
        }
    });
    Ok(())
}

/// [`FeatureSpec::sample`](crate::features::FeatureSpec::sample) of sets with a core.
pub(super) fn sample(e: &Extractor, pixel: Pixel<'_>, most: usize, rng: &mut Stream, rows: &mut Sampled) {
    let (set, codes) = e.codes();
    let mut made = TrainingRows {
        features: std::mem::take(&mut rows.features),
        targets: std::mem::take(&mut rows.targets),
        fragments: Vec::new(),
    };
    sampled_rows(&set, &codes, pixel, most, rng, &mut made);
    (rows.features, rows.targets) = (made.features, made.targets);
    rows.of_pixel = made.fragments.len();
}

/// Rows of a pixel that a network is trained on.
#[derive(Debug, Clone, Default)]
pub struct TrainingRows {
    /// `[N, W]`, row by row.
    pub features: Vec<f32>,
    /// Transmittance of the tail alone, `[N]`: e^−(absorbance of the tail strictly in front).
    pub targets: Vec<f32>,
    /// The fragments.
    pub fragments: Vec<u32>,
}

fn write<const N: usize>(query: &Query<N>, row: &mut [f32]) {
    row[..FIXED].copy_from_slice(&query.fixed);
    row[FIXED..].copy_from_slice(&query.described[1..]);
}

/// Appends rows of at most `most` fragments of a pixel that need a network, chosen at random.
///
/// An error of the tail's transmittance is an error of T times e^−(core in front). So that squared errors count as
/// those of T do, a fragment is chosen with probability e^−2(core in front).
pub fn sampled_rows(
    set: &CoreSet,
    codes: &Codes,
    pixel: Pixel<'_>,
    most: usize,
    rng: &mut Stream,
    rows: &mut TrainingRows,
) {
    with_sums!(set.moments, N => {
        let mut passes = Passes::default();
        let between: Between<N> = passes.first(set, codes, pixel);
        let n = pixel.len();
        let mut order: Vec<u32> = (0..n as u32).collect();
        let mut tail = Vec::new();
        let mut taken = 0;
        for i in 0..n {
            if taken == most {
                break;
            }
            order.swap(i, rng.random_range(i..n));
            let at = order[i] as usize;
            let Answer::Query(query) = between.answer(codes, passes.fragments[at]) else {
                continue;
            };
            if rng.unit() >= f64::from((-2.0 * query.front).exp()) {
                continue;
            }
            if tail.is_empty() {
                tail_of(&between, codes, &passes.fragments, pixel, &mut tail);
            }
            let in_front: f32 = tail.iter().filter(|(v, _)| *v < pixel.view_z[at]).map(|(_, a)| a).sum();
            let first = rows.features.len();
            rows.features.resize(first + FIXED + set.moments, 0.0);
            write(&query, &mut rows.features[first..]);
            rows.targets.push((-in_front).exp());
            rows.fragments.push(at as u32);
            taken += 1;
        }
    });
}

/// View depths and absorbances of the fragments that are not in the core.
fn tail_of<const N: usize>(
    between: &Between<N>,
    codes: &Codes,
    fragments: &[CoreFragment],
    pixel: Pixel<'_>,
    out: &mut Vec<(f32, f32)>,
) {
    let mut core = between.core().to_vec();
    for ((&fragment, &view_z), &alpha) in fragments.iter().zip(pixel.view_z).zip(pixel.alpha) {
        match core.iter().position(|&kept| kept == fragment) {
            Some(place) => drop(core.swap_remove(place)),
            None => out.push((view_z, absorbance(alpha) as f32)),
        }
    }
    debug_assert!(core.is_empty(), "{codes:?}");
}
