//! The forward pass on many rows: tiles of 256 rows in explicit SIMD, with the sizes of shipped networks known at
//! compile time.

use super::passes::Column;
use crate::features::Answer;
use crate::model::Mlp;
use crate::model::kernel::{Padded, Row, TILE, ZEROS, absorbance, hidden_layers, logit, shipped_sizes};
use crate::numeric::lanes::{self, LANES, Lanes};
use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch};
use rayon::prelude::*;

/// Runs code at a SIMD level with sizes of layers that are literals where they are those of a shipped network.
macro_rules! with_sizes {
    ($level:expr, $sizes:expr, |$simd:ident, $name:ident| $code:expr) => {
        shipped_sizes!(with_sizes, $level, $sizes, |$simd, $name| $code)
    };
    (@ [$([$($size:literal),*])*] $level:expr, $sizes:expr, |$simd:ident, $name:ident| $code:expr) => {
        match *$sizes {
            $([$($size),*] => dispatch!($level, $simd => { let $name = &[$($size),*]; $code }),)*
            _ => dispatch!($level, $simd => { let $name = $sizes; $code }),
        }
    };
}

impl Mlp {
    /// Answers to many rows on all cores in explicit SIMD with fused multiply-adds: what renderers of fragment lists
    /// want.
    ///
    /// Each row's answer depends on that row and on the SIMD level alone.
    ///
    /// # Shapes
    /// `rows: [N, W]`, row by row; the result is `[N]`.
    ///
    /// # Accuracy
    /// As far from [`Self::forward`] in f64 as that is in f32, within a factor of three;
    /// `batched_answers_follow_the_reference` holds it there.
    ///
    /// # Panics
    /// If the length of `rows` is not a multiple of W.
    pub fn predict(&self, rows: &[f32]) -> Vec<f32> {
        let width = self.layers()[0].inputs();
        assert_eq!(rows.len() % width, 0, "whole rows of {width} features");
        let mut out = vec![0.0; rows.len() / width];
        let network = Batched::new(self);
        let level = Level::new();
        // Several tiles a task outweigh handing it over.
        const TASK: usize = 8 * TILE * LANES;
        out.par_chunks_mut(TASK)
            .zip(rows.par_chunks(TASK * width))
            .for_each_init(
                || vec![ZEROS; network.padded.rows()],
                |work, (out, rows)| network.run(level, rows, out, work),
            );
        out
    }
}

/// A network as [`Mlp::predict`] runs it.
struct Batched {
    padded: Padded,
    parameters: Vec<f32>,
    answer: Answer,
}

impl Batched {
    fn new(mlp: &Mlp) -> Self {
        let padded = Padded::new(
            &mlp.layers()
                .iter()
                .map(|l| (l.inputs(), l.outputs()))
                .collect::<Vec<_>>(),
        );
        let plain: Vec<f32> = mlp
            .layers()
            .iter()
            .flat_map(|l| l.weights.iter().chain(&l.biases).copied())
            .collect();
        Self {
            parameters: padded.pad(&plain),
            padded,
            answer: mlp.feature_set().answer(),
        }
    }

    fn run(&self, level: Level, rows: &[f32], out: &mut [f32], work: &mut [Row]) {
        with_sizes!(level, self.padded.sizes(), |simd, sizes| self
            .tiles(simd, sizes, rows, out, work));
    }

    #[inline(always)]
    fn tiles<S: Simd>(&self, simd: S, sizes: &[usize], rows: &[f32], out: &mut [f32], work: &mut [Row]) {
        let width = sizes[0];
        for (out, rows) in out.chunks_mut(TILE * LANES).zip(rows.chunks(TILE * LANES * width)) {
            for (at, row) in rows.chunks_exact(width).enumerate() {
                for (column, &feature) in work[..width].iter_mut().zip(row) {
                    column[at / LANES].0[at % LANES] = feature;
                }
            }
            self.tile(simd, sizes, out, work);
        }
    }

    /// Answers of one tile, whose features are the first rows of `work`.
    #[inline(always)]
    fn tile<S: Simd>(&self, simd: S, sizes: &[usize], out: &mut [f32], work: &mut [Row]) {
        let (first, at) = hidden_layers(simd, sizes, &self.parameters, work);
        let units = sizes[sizes.len() - 1];
        let (w, b) = (&self.parameters[at..at + units], self.parameters[at + units]);
        let h = &work[first..first + units];
        for (v, out) in out.chunks_mut(LANES).enumerate() {
            let s = lanes::sigmoid(simd, logit(simd, w, b, h, v));
            let value = match self.answer {
                Answer::Sigmoid => s,
                Answer::AbsorbanceShare { column, offset } => {
                    let absorbance = absorbance(simd, work[column][v].load(simd), offset);
                    lanes::exp(simd, -(absorbance * s))
                }
            };
            let mut lanes = Lanes::ZERO;
            lanes.store(value);
            out.copy_from_slice(&lanes.0[..out.len()]);
        }
    }
}

/// A network made ready to answer tiles of rows that stand column by column, without turning them around:
/// [`Mlp::predict`] for those who make rows in lanes.
pub struct Tiled {
    network: Batched,
    level: Level,
}

impl Tiled {
    /// Most rows of a tile.
    pub const ROWS: usize = TILE * LANES;

    /// The network.
    pub fn new(mlp: &Mlp) -> Self {
        Self {
            network: Batched::new(mlp),
            level: Level::new(),
        }
    }

    /// What one thread works in.
    pub fn work(&self) -> Vec<Row> {
        vec![ZEROS; self.network.padded.rows()]
    }

    /// Answers to `out.len()` rows, the same to the bit as [`Mlp::predict`]'s.
    ///
    /// # Shapes
    /// `work`: as [`Self::work`] made it, the features in its first W rows; `out`: at most [`Self::ROWS`].
    ///
    /// # Panics
    /// If either is too short or too long.
    pub fn answer(&self, work: &mut [Row], out: &mut [f32]) {
        assert!(out.len() <= Self::ROWS, "at most {} rows", Self::ROWS);
        let network = &self.network;
        with_sizes!(self.level, network.padded.sizes(), |simd, sizes| network
            .tile(simd, sizes, out, work));
    }

    /// What a thread asks: a function that answers the first `out.len()` rows of columns, at most [`Self::ROWS`].
    pub fn answers_to_columns(&self) -> impl FnMut(&[Column], &mut [f32]) + '_ {
        let mut work = self.work();
        move |columns, out| {
            let vectors = out.len().div_ceil(LANES);
            for (row, column) in work.iter_mut().zip(columns) {
                for (lanes, values) in row.iter_mut().zip(column.chunks_exact(LANES)).take(vectors) {
                    lanes.0.copy_from_slice(values);
                }
            }
            self.answer(&mut work, out);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::features::FeatureSet;
    use crate::model::Provenance;
    use crate::model::mlp::tests::random_mlp;
    use crate::numeric::rng::stream;
    use rand::RngExt;

    /// Answers in SIMD are as close to f64 as three times our own f32, whatever the sizes and the number of rows, and
    /// the same for any company of rows.
    #[test]
    fn batched_answers_follow_the_reference() {
        for (hidden, seed) in [(&[32, 16][..], 1), (&[5], 2), (&[], 3), (&[3, 9, 4], 4), (&[16, 8], 5)] {
            let mlp = random_mlp(hidden, seed);
            for set in [FeatureSet::Paper, FeatureSet::Recentred] {
                let mlp = Mlp::new("m", set, mlp.layers().to_vec(), Provenance::default()).unwrap();
                let mut rng = stream(2, 0, 0);
                let rows: Vec<f32> = (0..7 * 5000).map(|_| rng.random_range(-3.0..3.0)).collect();
                let exact = mlp.forward_batch::<f64>(&rows);
                let worst = |found: &[f32]| {
                    found
                        .iter()
                        .zip(&exact)
                        .map(|(f, e)| (f64::from(*f) - e).abs())
                        .fold(0.0, |m: f64, e| if e.is_nan() { 9.0 } else { m.max(e) })
                };
                let all = mlp.predict(&rows);
                let bar = 3.0 * worst(&mlp.forward_batch::<f32>(&rows)).max(6e-8);
                assert!(worst(&all) <= bar, "{hidden:?}: {} > {bar}", worst(&all));
                // Control: the answers of the rows one on.
                assert!(worst(&mlp.predict(&[&rows[7..], &rows[..7]].concat())) > bar);
                for n in [0, 1, 17, 255, 257] {
                    assert_eq!(mlp.predict(&rows[..7 * n]), all[..n]);
                }
                let tiled = Tiled::new(&mlp);
                let (mut work, mut tile) = (tiled.work(), vec![f32::NAN; 250]);
                for (i, &x) in rows[..7 * 250].iter().enumerate() {
                    work[i % 7][i / 7 / LANES].0[i / 7 % LANES] = x;
                }
                tiled.answer(&mut work, &mut tile);
                assert_eq!(tile, all[..250]);
            }
        }
    }
}
