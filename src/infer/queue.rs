//! Fragments of any pixels that wait until sixteen of them go through their arithmetic at once.

use super::passes::Column;
use crate::features::recentred::formulas::{Others, Pass2, others, place_in_thin, share_of_three};
use crate::features::recentred::{PixelSums, Rounding};
use crate::features::visible::{Noise, is_hidden, most_behind};
use crate::numeric::lanes::{self, LANES, Lanes};
use crate::numeric::real::{Real, c};
use fearless_simd::prelude::*;
use fearless_simd::{f32x16, mask32x16};

/// A pixel with fragments after pass 1, with what each of them needs in pass 2.
#[derive(Debug, Clone, Copy)]
pub(super) struct Summed<const K: usize> {
    pub(super) sums: PixelSums<f32, K>,
    pub(super) centre: f32,
    pub(super) half_range: f32,
    /// Whether places in its range are those of view depth.
    pub(super) thin: bool,
    /// Its first fragment, counted within the task.
    pub(super) first: u32,
}

/// Vectors of fragments that wait together, so that what was written last has reached the cache before it is read.
const VECTORS: usize = 4;

/// Fragments that wait: z, A, b_0, n, c, h, place in a thin pixel, then b_1..b_K.
pub(super) struct Queue<const K: usize> {
    fixed: [[Lanes; VECTORS]; 7],
    b: [[Lanes; VECTORS]; K],
    /// The fragment, or [`DROPPED`](super::passes) where it is known already: the network is run, its answer dropped.
    pub(super) fragment: [u32; VECTORS * LANES],
    /// Its pixel among those of the task.
    pub(super) pixel: [u32; VECTORS * LANES],
    len: usize,
}

impl<const K: usize> Queue<K> {
    pub(super) fn new() -> Self {
        let (fragment, pixel) = ([0; VECTORS * LANES], [0; VECTORS * LANES]);
        Self {
            fixed: [[Lanes([1.0; LANES]); VECTORS]; 7],
            b: [[Lanes::ZERO; VECTORS]; K],
            fragment,
            pixel,
            len: 0,
        }
    }

    #[inline(always)]
    pub(super) fn push(&mut self, view_z: f32, z: f32, absorbance: f32, of: &Summed<K>, fragment: u32, pixel: usize) {
        let (vector, lane) = (self.len / LANES, self.len % LANES);
        let place = if of.thin {
            place_in_thin(view_z, of.sums.nearest, of.sums.farthest)
        } else {
            2.0
        };
        for (lanes, value) in self.fixed.iter_mut().zip([
            z,
            absorbance,
            of.sums.b0,
            of.sums.count as f32,
            of.centre,
            of.half_range,
            place,
        ]) {
            lanes[vector].0[lane] = value;
        }
        for (lanes, value) in self.b.iter_mut().zip(of.sums.b) {
            lanes[vector].0[lane] = value;
        }
        self.fragment[self.len] = fragment;
        self.pixel[self.len] = pixel as u32;
        self.len += 1;
    }

    pub(super) fn is_full(&self) -> bool {
        self.len == VECTORS * LANES
    }

    #[inline(always)]
    pub(super) fn load<S: Simd>(&self, simd: S, v: usize) -> Sixteen<S, K> {
        let [z, absorbance, b0, n, centre, half_range, place] = lanes::array(|i| self.fixed[i][v].load(simd));
        Sixteen {
            pass2: Pass2 {
                z,
                absorbance,
                b0,
                b: lanes::array(|k| self.b[k][v].load(simd)),
                n,
                centre,
                half_range,
            },
            place,
        }
    }

    /// Empties it: first fragments and number of each vector of what stood there.
    pub(super) fn take(&mut self) -> impl Iterator<Item = (usize, usize)> + use<K> {
        let len = std::mem::take(&mut self.len);
        (0..len).step_by(LANES).map(move |at| (at, (len - at).min(LANES)))
    }
}

/// Sixteen fragments, of any pixels.
#[derive(Clone, Copy)]
pub(super) struct Sixteen<S: Simd, const K: usize> {
    pass2: Pass2<f32x16<S>, K>,
    /// Place in a thin pixel's range by view depth; more than 1 where the pixel is not thin.
    place: f32x16<S>,
}

impl<S: Simd, const K: usize> Sixteen<S, K> {
    #[inline(always)]
    fn others(&self) -> Others<f32x16<S>, K> {
        Others::new(&self.pass2, others(self.pass2.b0, self.pass2.absorbance))
    }

    /// Position in the pixel's range; in a thin pixel that of its view depth.
    #[inline(always)]
    fn position(&self, others: &Others<f32x16<S>, K>) -> f32x16<S> {
        Real::select(self.place.le(c(1.0)), self.place, others.along)
    }

    /// Optical depth in front of a fragment that is one of three or four.
    #[inline(always)]
    pub(super) fn closed_form(&self) -> f32x16<S> {
        let others = self.others();
        let rounded = others.rounded(&self.pass2, Rounding::of_arithmetic(others.absorbance));
        let mean = rounded.mean();
        let of_four = rounded.describe(mean).share_of_four(self.position(&others));
        others.absorbance * Real::select(self.pass2.n.eq(c(3.0)), share_of_three(mean), of_four)
    }

    /// Puts the features of those that are not hidden into the columns, and says which are; with `deep` unset none is.
    #[inline(always)]
    pub(super) fn fill(&self, deep: bool, columns: &mut [Column], row: usize) -> u64 {
        let others = self.others();
        let rounded = others.rounded(&self.pass2, Rounding::of_arithmetic(others.absorbance));
        let description = rounded.describe(rounded.mean());
        let first = rounded.first_columns(self.position(&others));
        let values = first.into_iter().chain(rounded.columns(&description));
        if deep {
            let hidden = self.hidden(&others);
            if hidden.any_true() {
                for (column, value) in columns.iter_mut().zip(values) {
                    value.compress(!hidden).store_slice(&mut column[row..row + LANES]);
                }
                return hidden.to_bitmask();
            }
        }
        for (column, value) in columns.iter_mut().zip(values) {
            value.store_slice(&mut column[row..row + LANES]);
        }
        0
    }

    /// Which of these fragments, if they lie deep enough to be looked at, are hidden.
    #[inline(always)]
    fn hidden(&self, others: &Others<f32x16<S>, K>) -> mask32x16<S> {
        let Pass2 { n, b0, absorbance, .. } = self.pass2;
        let unit = b0.like(f64::from(f32::EPSILON));
        let noise = Noise::of(n, b0, others.absorbance, others.half_range, others.noise_growth, unit);
        let behind = most_behind(others.along, lanes::array(|k| others.m[k]), &noise);
        is_hidden(others.absorbance, absorbance, n, behind, &noise)
    }
}
