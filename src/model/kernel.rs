//! The forward pass of a network on many rows at once: what training and batched inference share.
//!
//! Rows lie side by side in [`Lanes`], a tile of T of them together; a layer is computed for a few units and a few
//! vectors of rows at a time, so that every weight and every input that is loaded serves several fused multiply-adds
//! from registers.

use crate::features::MAX_LOG_ABSORBANCE;
use crate::numeric::lanes::{self, LANES, Lanes, exp};
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

/// Hands a macro the sizes of the shipped networks, inputs and hidden layers, for kernels that know them at compile
/// time: `shipped_sizes!(callback, arguments)` is `callback!(@ [[7, 32, 16] ...] arguments)`. This is their one place.
macro_rules! shipped_sizes {
    ($callback:ident, $($arguments:tt)*) => {
        $callback!(@ [[7, 32, 16] [9, 32, 16] [7, 16, 8] [9, 16, 8]] $($arguments)*)
    };
}
pub(crate) use shipped_sizes;

/// Layers as the kernels read them: hidden ones padded to whole registers with units that are always 0, the parameters
/// of all in one array.
#[derive(Debug, Clone)]
pub struct Padded {
    /// Inputs, then hidden layers with their padding.
    sizes: Vec<usize>,
    /// (inputs, outputs) of every layer, without padding.
    shapes: Vec<(usize, usize)>,
}

impl Padded {
    /// Layers of these (inputs, outputs).
    pub fn new(shapes: &[(usize, usize)]) -> Self {
        let hidden = shapes[..shapes.len() - 1].iter().map(|s| s.1.next_multiple_of(UNITS));
        Self {
            sizes: std::iter::once(shapes[0].0).chain(hidden).collect(),
            shapes: shapes.to_vec(),
        }
    }

    /// Number of inputs, then of every hidden layer's units with the padding.
    pub fn sizes(&self) -> &[usize] {
        &self.sizes
    }

    /// Rows that a tile's inputs and activations take.
    pub fn rows(&self) -> usize {
        self.sizes.iter().sum()
    }

    /// Number of outputs of the network.
    pub fn outputs(&self) -> usize {
        self.shapes[self.shapes.len() - 1].1
    }

    /// Number of padded parameters: of every layer weights, then biases; those of the output layer have no padding but
    /// that of its inputs.
    pub fn count(&self) -> usize {
        let hidden: usize = self.sizes.windows(2).map(|s| (s[0] + 1) * s[1]).sum();
        hidden + (self.sizes[self.sizes.len() - 1] + 1) * self.outputs()
    }

    /// Calls with the padded and the plain place of every parameter.
    fn places(&self, mut visit: impl FnMut(usize, usize)) {
        let (mut padded_at, mut at) = (0, 0);
        for (index, &(inputs, outputs)) in self.shapes.iter().enumerate() {
            let padded_inputs = self.sizes[index];
            let padded_outputs = self.sizes.get(index + 1).copied().unwrap_or(self.outputs());
            for i in 0..inputs {
                for o in 0..outputs {
                    visit(padded_at + i * padded_outputs + o, at);
                    at += 1;
                }
            }
            padded_at += padded_inputs * padded_outputs;
            for o in 0..outputs {
                visit(padded_at + o, at);
                at += 1;
            }
            padded_at += padded_outputs;
        }
    }

    /// Padded parameters from plain ones: layer by layer, weights `[in][out]`, then biases.
    pub fn pad(&self, plain: &[f32]) -> Vec<f32> {
        let mut out = vec![0.0; self.count()];
        self.places(|padded, at| out[padded] = plain[at]);
        out
    }

    /// Plain parameters from padded ones.
    pub fn unpad(&self, padded: &[f32]) -> Vec<f32> {
        let mut out = vec![0.0; self.shapes.iter().map(|(i, o)| (i + 1) * o).sum()];
        self.places(|padded_at, at| out[at] = padded[padded_at]);
        out
    }
}

/// All hidden layers of a tile, whose inputs stand in the first rows: the activations of each layer come to stand
/// behind its inputs.
///
/// Returned are the row where the output layer's inputs begin, and the place where its parameters do.
///
/// # Shapes
/// `sizes`, `parameters` and `rows` as [`Padded`] says.
#[inline(always)]
pub fn hidden_layers<S: Simd>(simd: S, sizes: &[usize], parameters: &[f32], rows: &mut [Row]) -> (usize, usize) {
    let (mut row, mut at) = (0, 0);
    for s in sizes.windows(2) {
        let (x, y) = rows[row..].split_at_mut(s[0]);
        let (w, b) = parameters[at..].split_at(s[0] * s[1]);
        hidden(simd, s[0], s[1], w, b, x, y);
        row += s[0];
        at += (s[0] + 1) * s[1];
    }
    (row, at)
}

/// The absorbance b that [`Answer::AbsorbanceShare`](crate::features::Answer::AbsorbanceShare) scales, from the feature
/// that is ln(b + offset).
#[inline(always)]
pub fn absorbance<S: Simd>(simd: S, log: f32x16<S>, offset: f32) -> f32x16<S> {
    let splat = |x: f32| f32x16::splat(simd, x);
    (exp(simd, log.min(splat(MAX_LOG_ABSORBANCE))) - splat(offset)).max(splat(0.0))
}

/// Whether the registers of this level hold a whole vector of sixteen: then there are 32 of them, and larger blocks
/// pay.
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
fn hidden_block<S: Simd, const O: usize, const V: usize>(
    simd: S,
    inputs: usize,
    outputs: usize,
    w: &[f32],
    b: &[f32],
    x: &[Row],
    y: &mut [Row],
) {
    let (x, y) = (&x[..inputs], &mut y[..outputs]);
    let zero = f32x16::splat(simd, 0.0);
    for v in (0..TILE).step_by(V) {
        for o in (0..outputs).step_by(O) {
            let mut sum: [[f32x16<S>; V]; O] = lanes::array(|j| [f32x16::splat(simd, b[o + j]); V]);
            for (k, x) in x.iter().enumerate() {
                let x: [f32x16<S>; V] = lanes::array(|n| x[v + n].load(simd));
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Every parameter has a place of its own, and what fills up is 0.
    #[test]
    fn padding_is_undone() {
        for sizes in [
            &[7, 32, 16, 1][..],
            &[7, 5, 9, 3, 1],
            &[9, 1],
            &[3, 8, 1],
            &[10, 30, 3],
            &[5, 3],
        ] {
            let shapes: Vec<_> = sizes.windows(2).map(|s| (s[0], s[1])).collect();
            let network = Padded::new(&shapes);
            let count: usize = shapes.iter().map(|(i, o)| (i + 1) * o).sum();
            let plain: Vec<f32> = (1..=count).map(|i| i as f32).collect();
            let padded = network.pad(&plain);
            assert_eq!((padded.len(), network.unpad(&padded)), (network.count(), plain));
            assert_eq!(padded.iter().filter(|p| **p == 0.0).count(), network.count() - count);
            assert!(
                network.sizes()[1..].iter().all(|s| s % UNITS == 0)
                    && network.rows() == network.sizes().iter().sum::<usize>()
            );
        }
    }
}
