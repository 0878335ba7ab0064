//! The forward pass of a fully connected layer on many rows at once: what training and batched inference share.
//!
//! Rows lie side by side in [`Lanes`], a tile of T of them together; a layer is computed for a few units and a few vectors of rows at a time, so that every weight
//! and every input that is loaded serves several fused multiply-adds from registers.

use crate::numeric::lanes::{LANES, Lanes};
use fearless_simd::f32x16;
use fearless_simd::prelude::*;

/// Vectors of rows that a tile holds: 256 rows, whose activations stay in the caches next to the core.
pub const TILE: usize = 16;

/// Values of one unit, or one input, for the rows of a tile.
pub type Row = [Lanes; TILE];

/// Zeros.
pub const ZEROS: Row = [Lanes::ZERO; TILE];

/// Units that are computed together; hidden layers are padded to a multiple.
pub const UNITS: usize = 8;

/// A hidden layer's size, padded with units that are always 0.
pub fn padded(units: usize) -> usize {
    units.next_multiple_of(UNITS)
}

/// Whether the registers of this level hold a whole vector of sixteen: then there are 32 of them, and larger blocks pay.
#[inline(always)]
pub fn wide<S: Simd>() -> bool {
    S::f32s::LEN == LANES
}

/// y\[o\] = max(b\[o\] + Σ_k w\[k\]\[o\] x\[k\], 0) for every row of a tile.
///
/// # Shapes
/// `w: [inputs][outputs]` flat, `b: [outputs]`, `x: [inputs]`, `y: [outputs]`; outputs a multiple of [`UNITS`].
#[inline(always)]
pub fn hidden<S: Simd>(simd: S, inputs: usize, outputs: usize, w: &[f32], b: &[f32], x: &[Row], y: &mut [Row]) {
    if wide::<S>() {
        hidden_block::<S, UNITS, 2>(simd, inputs, outputs, w, b, x, y);
    } else {
        hidden_block::<S, 4, 1>(simd, inputs, outputs, w, b, x, y);
    }
}

#[inline(always)]
fn hidden_block<S: Simd, const O: usize, const V: usize>(simd: S, inputs: usize, outputs: usize, w: &[f32], b: &[f32], x: &[Row], y: &mut [Row]) {
    let (x, y) = (&x[..inputs], &mut y[..outputs]);
    let zero = f32x16::splat(simd, 0.0);
    for v in (0..TILE).step_by(V) {
        for o in (0..outputs).step_by(O) {
            let mut sum: [[f32x16<S>; V]; O] = std::array::from_fn(|j| [f32x16::splat(simd, b[o + j]); V]);
            for (k, x) in x.iter().enumerate() {
                let x: [f32x16<S>; V] = std::array::from_fn(|n| x[v + n].load(simd));
                let w = &w[k * outputs + o..][..O];
                for j in 0..O {
                    let w = f32x16::splat(simd, w[j]);
                    for n in 0..V {
                        sum[j][n] = x[n].mul_add(w, sum[j][n]);
                    }
                }
            }
            for j in 0..O {
                for n in 0..V {
                    y[o + j][v + n].store(sum[j][n].max(zero));
                }
            }
        }
    }
}

/// b + Σ_k w\[k\] x\[k\] for vector v of a tile's rows, in four partial sums.
#[inline(always)]
pub fn logit<S: Simd>(simd: S, w: &[f32], b: f32, x: &[Row], v: usize) -> f32x16<S> {
    let zero = f32x16::splat(simd, 0.0);
    let mut sum = [f32x16::splat(simd, b), zero, zero, zero];
    for (k, (x, &w)) in x.iter().zip(w).enumerate() {
        sum[k % 4] = x[v].load(simd).mul_add(f32x16::splat(simd, w), sum[k % 4]);
    }
    (sum[0] + sum[1]) + (sum[2] + sum[3])
}
