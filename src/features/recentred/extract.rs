//! Recentred features pixel by pixel, with sums in the precision that storage leaves.

use super::formulas::moments;
use super::{FragmentTerms, Pass2Input, PixelSums, columns};
use crate::features::extract::{Extractor, Known, MomentFrame, Sampled, SumPrecision};
use crate::moments::storage::through_unorm16;
use crate::numeric::lanes::{LANES, Lanes};
use crate::numeric::quantise::round_f16;
use crate::numeric::rng::Stream;
use crate::pixel::{DepthError, LogWarp, Pixel, ViewZ, absorbance};
use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, f32x16};

/// Pass 1 over a pixel: its fragments as both passes see them, the sums, and the moment depths of its ends.
fn pass_1<const K: usize>(
    e: &Extractor,
    pixel: Pixel<'_>,
    warp: LogWarp,
    terms: &mut Vec<FragmentTerms<f32>>,
) -> (PixelSums<f32, K>, [f32; 2]) {
    terms.clear();
    let warp = match e.frame {
        MomentFrame::Pixel if !pixel.is_empty() => own_warp(pixel.view_z),
        _ => warp,
    };
    let mut sums = PixelSums::<f32, K>::default();
    let mut ends = [0.0; 2];
    for (&view_z, &alpha) in pixel.view_z.iter().zip(pixel.alpha) {
        let one = FragmentTerms {
            view_z,
            z: warp.moment(ViewZ(view_z.into())).0 as f32,
            absorbance: absorbance(alpha) as f32,
        };
        add(e, &mut sums, &mut ends, one);
        terms.push(one);
    }
    keep(e, &mut sums);
    (sums, ends)
}

/// Features of every fragment of a pixel, and what is known without the network; see [`Extractor::pixel`].
pub(super) fn pixel<const K: usize>(
    e: &Extractor,
    pixel: Pixel<'_>,
    features: &mut [f32],
    known: &mut [Known],
) -> Result<(), DepthError> {
    let mut terms = Vec::with_capacity(pixel.len());
    let (sums, ends) = pass_1::<K>(e, pixel, e.scale.log_warp(), &mut terms);
    let rows = features.chunks_exact_mut(columns(K).len()).zip(known);
    for ((row, known), terms) in rows.zip(terms) {
        match sums.classify_stored(terms, ends, e.precision.rounding()) {
            Pass2Input::Solved(t) => {
                row.fill(0.0);
                *known = Known::Transmittance(t);
            }
            Pass2Input::Query(first, measure) => {
                row[..first.len()].copy_from_slice(&first);
                row[first.len()..].copy_from_slice(&measure);
            }
        }
    }
    Ok(())
}

/// Rows of some fragments of a pixel; see [`Extractor::sample`].
pub(super) fn sample<const K: usize>(
    e: &Extractor,
    pixel: Pixel<'_>,
    most: usize,
    rng: &mut Stream,
    rows: &mut Sampled,
) {
    let n = pixel.len();
    let warp = match e.frame {
        MomentFrame::Pixel if n > 0 => own_warp(pixel.view_z),
        _ => e.scale.log_warp(),
    };
    rows.transform_depths(pixel, &warp);
    if e.frame == MomentFrame::Pixel {
        // Sixteen logarithms at once are too coarse for ratios near 1.
        for (i, &v) in pixel.view_z.iter().enumerate() {
            rows.depth[i / LANES].0[i % LANES] = warp.moment(ViewZ(v.into())).0 as f32;
        }
    }
    let Sampled {
        view_z,
        depth,
        absorbance,
        ..
    } = &*rows;
    let (mut sums, ends) = if e.precision == SumPrecision::F16 {
        // Every sum is rounded.
        let (mut sums, mut ends) = (PixelSums::default(), [0.0; 2]);
        (0..n).for_each(|i| add(e, &mut sums, &mut ends, rows.terms(i)));
        (sums, ends)
    } else {
        dispatch!(Level::new(), simd => sums_lanes::<_, K>(simd, n, view_z, depth, absorbance))
    };
    keep(e, &mut sums);
    rows.choose(n, most, rng, |i, rows| {
        match sums.classify_stored(rows.terms(i), ends, e.precision.rounding()) {
            Pass2Input::Query(first, measure) => {
                rows.features.extend_from_slice(&first);
                rows.features.extend_from_slice(&measure);
                true
            }
            Pass2Input::Solved(_) => false,
        }
    });
}

/// What the storage keeps of whole sums.
fn keep<const K: usize>(e: &Extractor, sums: &mut PixelSums<f32, K>) {
    fn through<const M: usize>(b0: f32, b: &mut [f32]) {
        let b0 = f64::from(b0);
        let normalised = std::array::from_fn(|k| if k == 0 { 1.0 } else { f64::from(b[k - 1]) / b0 });
        for (b, kept) in b.iter_mut().zip(&through_unorm16::<M>(normalised)[1..]) {
            *b = (kept * b0) as f32;
        }
    }
    if e.precision == SumPrecision::Unorm16 && sums.b0 > 0.0 {
        match K {
            4 => through::<5>(sums.b0, &mut sums.b),
            6 => through::<7>(sums.b0, &mut sums.b),
            _ => through::<9>(sums.b0, &mut sums.b),
        }
    }
}

/// Pass 1: adds a fragment, in the precision of the storage.
fn add<const K: usize>(e: &Extractor, sums: &mut PixelSums<f32, K>, ends: &mut [f32; 2], terms: FragmentTerms<f32>) {
    sums.add(terms);
    if sums.nearest == terms.view_z {
        ends[0] = terms.z;
    }
    if sums.farthest == terms.view_z {
        ends[1] = terms.z;
    }
    if e.precision == SumPrecision::F16 {
        sums.b0 = round_f16(sums.b0.into()) as f32;
        sums.b = sums.b.map(|b| round_f16(b.into()) as f32);
    }
}

/// The log warp between the nearest and the farthest of a pixel's fragments.
fn own_warp(view_z: &[f32]) -> LogWarp {
    let (nearest, farthest) = view_z
        .iter()
        .fold((f32::INFINITY, 0.0f32), |(lo, hi), &v| (lo.min(v), hi.max(v)));
    LogWarp::new(ViewZ(nearest.into()), ViewZ(farthest.into())).expect("depths of a fragment are positive and finite")
}

/// [`PixelSums`] of n fragments and the depths of their ends: the same numbers to the bit as [`PixelSums::add`] gives,
/// added up in the same order.
#[inline(always)]
fn sums_lanes<S: Simd, const K: usize>(
    simd: S,
    n: usize,
    view_z: &[Lanes],
    depth: &[Lanes],
    absorbance: &[Lanes],
) -> (PixelSums<f32, K>, [f32; 2]) {
    let splat = |x: f32| f32x16::splat(simd, x);
    let (infinity, none) = (splat(f32::INFINITY), splat(f32::NEG_INFINITY));
    let mut sums = PixelSums {
        count: n as u32,
        ..PixelSums::default()
    };
    let (mut nearest, mut farthest) = (infinity, none);
    for (index, ((v, z), a)) in view_z.iter().zip(depth).zip(absorbance).enumerate() {
        // What fills the last vector up lies at infinity.
        let v = v.load(simd);
        nearest = nearest.min(v);
        farthest = farthest.max(v.simd_lt(infinity).select(v, none));
        let mut terms = [Lanes::ZERO; K];
        for (lanes, term) in terms.iter_mut().zip(moments::<_, K>(z.load(simd), a.load(simd))) {
            lanes.store(term);
        }
        for lane in 0..(n - index * LANES).min(LANES) {
            sums.b0 += a.0[lane];
            for (b, terms) in sums.b.iter_mut().zip(&terms) {
                *b += terms.0[lane];
            }
        }
    }
    (sums.nearest, sums.farthest) = (nearest.reduce_min(), farthest.reduce_max());
    // Depths grow with view depths, and equal ones are equal.
    let (nearest, farthest) = (splat(sums.nearest), splat(sums.farthest));
    let mut ends = [none; 2];
    for (v, z) in view_z.iter().zip(depth) {
        let (v, z) = (v.load(simd), z.load(simd));
        ends[0] = ends[0].max(v.simd_eq(nearest).select(z, none));
        ends[1] = ends[1].max(v.simd_eq(farthest).select(z, none));
    }
    (sums, [ends[0].reduce_max(), ends[1].reduce_max()])
}
