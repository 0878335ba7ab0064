//! The training kernel: forward pass, loss, backward pass and gradient sums of a tile of rows in one go, on all cores,
//! in explicit SIMD.
//!
//! A batch is cut into chunks of 128 blocks whatever the number of threads; each chunk sums its own gradient in a fixed
//! order, and the chunks' gradients are added in order. So the result depends on the SIMD level alone.

use super::adam::Adam;
use super::{AdamMoments, Optimiser, TrainConfig};
use crate::dataset::{Batch, Blocks};
use crate::features::Answer;
use crate::model::kernel::{Padded, Row, TILE, ZEROS, absorbance, hidden, hidden_layers, logit, shipped_sizes, wide};
use crate::numeric::lanes::{self, Lanes, exp, sigmoid};
use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, f32x16};
use rayon::prelude::*;

/// Blocks of rows that one task takes: 2048 rows.
const CHUNK: usize = 128;

/// Errors and their derivatives below these are 0: what they would add is lost in rounding, and denormal numbers would
/// make every multiplication slow.
const MIN_ERROR: f32 = 1e-12;
const MIN_DERIVATIVE: f32 = 1e-18;

/// What a task works in; made once.
#[derive(Debug, Clone)]
struct Workspace {
    /// Inputs and activations of a tile, layer after layer; on the way back, activations give way to derivatives.
    rows: Vec<Row>,
    /// Derivatives of every output's logit.
    deltas: Vec<Row>,
    /// Sums of gradients, sixteen partial sums a parameter.
    sums: Vec<Lanes>,
    /// Sums of gradients.
    gradient: Vec<f32>,
    /// Weighted squared error.
    error: f64,
}

/// Gradient block: g\[k\]\[o\] += Σ x\[k\] d\[o\] over the rows of a tile, for inputs k.. of a layer.
#[inline(always)]
fn outer<S: Simd, const K: usize, const O: usize>(
    simd: S,
    k: usize,
    outputs: usize,
    x: &[Row],
    d: &[Row],
    g: &mut [Lanes],
) {
    let x = &x[k..k + K];
    for o in (0..outputs).step_by(O) {
        let d = &d[o..o + O];
        let mut sum: [[f32x16<S>; O]; K] = lanes::array(|i| lanes::array(|j| g[(k + i) * outputs + o + j].load(simd)));
        for v in 0..TILE {
            let x: [f32x16<S>; K] = lanes::array(|i| x[i][v].load(simd));
            let d: [f32x16<S>; O] = lanes::array(|j| d[j][v].load(simd));
            for i in 0..K {
                for j in 0..O {
                    sum[i][j] = x[i].mul_add(d[j], sum[i][j]);
                }
            }
        }
        for i in 0..K {
            for j in 0..O {
                g[(k + i) * outputs + o + j].store(sum[i][j]);
            }
        }
    }
}

/// Gradients of a hidden layer's weights and biases.
#[inline(always)]
fn layer_gradient<S: Simd>(simd: S, inputs: usize, outputs: usize, x: &[Row], d: &[Row], g: &mut [Lanes]) {
    let (weights, biases) = g.split_at_mut(inputs * outputs);
    let mut k = 0;
    if wide::<S>() {
        while k + 4 <= inputs {
            outer::<S, 4, 4>(simd, k, outputs, x, d, weights);
            k += 4;
        }
    }
    while k + 2 <= inputs {
        outer::<S, 2, 2>(simd, k, outputs, x, d, weights);
        k += 2;
    }
    if k < inputs {
        outer::<S, 1, 4>(simd, k, outputs, x, d, weights);
    }
    for (d, g) in d[..outputs].iter().zip(biases) {
        let mut sum = g.load(simd);
        for d in d {
            sum += d.load(simd);
        }
        g.store(sum);
    }
}

/// x\[k\] becomes its own derivative, Σ_o w\[k\]\[o\] d\[o\] where it was greater than 0, else 0.
#[inline(always)]
fn pull_back<S: Simd>(simd: S, inputs: usize, outputs: usize, w: &[f32], d: &[Row], x: &mut [Row]) {
    if wide::<S>() {
        pull_back_block::<S, 8, 2>(simd, inputs, outputs, w, d, x);
    } else {
        pull_back_block::<S, 4, 1>(simd, inputs, outputs, w, d, x);
    }
}

#[inline(always)]
fn pull_back_block<S: Simd, const K: usize, const V: usize>(
    simd: S,
    inputs: usize,
    outputs: usize,
    w: &[f32],
    d: &[Row],
    x: &mut [Row],
) {
    let (d, x) = (&d[..outputs], &mut x[..inputs]);
    let zero = f32x16::splat(simd, 0.0);
    for v in (0..TILE).step_by(V) {
        for k in (0..inputs).step_by(K) {
            let mut sum = [[zero; V]; K];
            for (o, d) in d.iter().enumerate() {
                let d: [f32x16<S>; V] = lanes::array(|n| d[v + n].load(simd));
                for i in 0..K {
                    let w = f32x16::splat(simd, w[(k + i) * outputs + o]);
                    for n in 0..V {
                        sum[i][n] = d[n].mul_add(w, sum[i][n]);
                    }
                }
            }
            for i in 0..K {
                for n in 0..V {
                    let cell = &mut x[k + i][v + n];
                    cell.store(cell.load(simd).simd_gt(zero).select(sum[i][n], zero));
                }
            }
        }
    }
}

/// The output layer: loss, its derivative by the logit, the layer's own gradient, and `h` turned into its derivative.
#[inline(always)]
#[allow(clippy::too_many_arguments)]
fn output<S: Simd>(
    simd: S,
    units: usize,
    parameters: &[f32],
    answer: Answer,
    batch: Batch<'_>,
    h: &mut [Row],
    delta: &mut Row,
    g: &mut [Lanes],
    scale: f32,
) -> f32x16<S> {
    let splat = |v: f32| f32x16::splat(simd, v);
    let (zero, one) = (splat(0.0), splat(1.0));
    let width = batch.blocks.width();
    let w = &parameters[..units];
    let mut error = zero;
    let mut bias = g[units].load(simd);
    for (v, delta) in delta.iter_mut().enumerate() {
        // Vectors that no block fills weigh nothing.
        let Some(&index) = batch.order.get(v) else {
            delta.store(zero);
            continue;
        };
        let block = batch.blocks.block(index as usize);
        let (target, weight) = (block[width].load(simd), block[width + 1].load(simd));
        let s = sigmoid(simd, logit(simd, w, parameters[units], &h[..units], v));
        let slope = s * (one - s);
        let (value, slope) = match answer {
            Answer::Sigmoid => (s, slope),
            Answer::AbsorbanceShare { column, offset } => {
                let absorbance = absorbance(simd, block[column].load(simd), offset);
                let value = exp(simd, -(absorbance * s));
                (value, -(value * absorbance) * slope)
            }
        };
        let e = value - target;
        let e = e.abs().simd_gt(splat(MIN_ERROR)).select(e, zero);
        error += weight * (e * e);
        let d = ((weight * e) * slope) * splat(scale);
        let d = d.abs().simd_gt(splat(MIN_DERIVATIVE)).select(d, zero);
        bias += d;
        delta.store(d);
    }
    g[units].store(bias);
    for ((h, &w), g) in h[..units].iter_mut().zip(w).zip(&mut *g) {
        let w = splat(w);
        let mut sum = g.load(simd);
        for (h, d) in h.iter_mut().zip(&*delta) {
            let (value, d) = (h.load(simd), d.load(simd));
            sum = value.mul_add(d, sum);
            h.store(value.simd_gt(zero).select(w * d, zero));
        }
        g.store(sum);
    }
    error
}

/// [`output`] of a network of several outputs, each of which answers with its sigmoid.
///
/// # Shapes
/// `parameters`, `g`: weights `[units][outputs]`, then biases `[outputs]`; `deltas: [outputs]`.
#[inline(always)]
#[allow(clippy::too_many_arguments)]
fn outputs<S: Simd>(
    simd: S,
    units: usize,
    parameters: &[f32],
    batch: Batch<'_>,
    h: &mut [Row],
    deltas: &mut [Row],
    g: &mut [Lanes],
    scale: f32,
) -> f32x16<S> {
    let splat = |v: f32| f32x16::splat(simd, v);
    let (zero, one) = (splat(0.0), splat(1.0));
    let (width, count) = (batch.blocks.width(), deltas.len());
    let (weights, biases) = parameters.split_at(units * count);
    let (weight_sums, bias_sums) = g.split_at_mut(units * count);
    let mut error = zero;
    for (o, (delta, bias_sum)) in deltas.iter_mut().zip(&mut *bias_sums).enumerate() {
        let mut bias = bias_sum.load(simd);
        for (v, delta) in delta.iter_mut().enumerate() {
            // Vectors that no block fills weigh nothing.
            let Some(&index) = batch.order.get(v) else {
                delta.store(zero);
                continue;
            };
            let block = batch.blocks.block(index as usize);
            let (target, weight) = (block[width + o].load(simd), block[width + count].load(simd));
            let mut logit = splat(biases[o]);
            for (k, h) in h[..units].iter().enumerate() {
                logit = h[v].load(simd).mul_add(splat(weights[k * count + o]), logit);
            }
            let s = sigmoid(simd, logit);
            let e = s - target;
            let e = e.abs().simd_gt(splat(MIN_ERROR)).select(e, zero);
            error += weight * (e * e);
            let d = ((weight * e) * (s * (one - s))) * splat(scale);
            let d = d.abs().simd_gt(splat(MIN_DERIVATIVE)).select(d, zero);
            bias += d;
            delta.store(d);
        }
        bias_sum.store(bias);
    }
    let of_units = weights.chunks_exact(count).zip(weight_sums.chunks_exact_mut(count));
    for (h, (weights, sums)) in h[..units].iter_mut().zip(of_units) {
        for (v, h) in h.iter_mut().enumerate() {
            let value = h.load(simd);
            let mut derivative = zero;
            for ((delta, &w), sum) in deltas.iter().zip(weights).zip(&mut *sums) {
                let d = delta[v].load(simd);
                derivative = d.mul_add(splat(w), derivative);
                sum.store(value.mul_add(d, sum.load(simd)));
            }
            h.store(value.simd_gt(zero).select(derivative, zero));
        }
    }
    error
}

/// Fills a tile's input rows from its blocks.
#[inline(always)]
fn fill(width: usize, batch: Batch<'_>, rows: &mut [Row]) {
    for (v, &index) in batch.order.iter().enumerate() {
        for (row, column) in rows[..width].iter_mut().zip(batch.blocks.block(index as usize)) {
            row[v] = *column;
        }
    }
    for row in &mut rows[..width] {
        row[batch.order.len()..].fill(Lanes::ZERO);
    }
}

/// Forward and backward through a tile of any network without a hidden layer or with many.
#[inline(always)]
fn tile<S: Simd>(
    simd: S,
    sizes: &[usize],
    p: &[f32],
    answer: Answer,
    batch: Batch<'_>,
    work: &mut Workspace,
    scale: f32,
) -> f32x16<S> {
    let Workspace { rows, deltas, sums, .. } = work;
    fill(sizes[0], batch, rows);
    let (mut row, mut at) = hidden_layers(simd, sizes, p, rows);
    let last = sizes[sizes.len() - 1];
    // Without a hidden layer the inputs' own derivatives would overwrite them; they are filled anew for the next tile.
    let (p_last, g_last, h) = (&p[at..], &mut sums[at..], &mut rows[row..]);
    let error = match deltas.as_mut_slice() {
        [delta] => output(simd, last, p_last, answer, batch, h, delta, g_last, scale),
        deltas => outputs(simd, last, p_last, batch, h, deltas, g_last, scale),
    };
    for index in (1..sizes.len()).rev() {
        let (inputs, outputs) = (sizes[index - 1], sizes[index]);
        at -= (inputs + 1) * outputs;
        let (x, d) = rows[row - inputs..].split_at_mut(inputs);
        layer_gradient(simd, inputs, outputs, x, d, &mut sums[at..at + (inputs + 1) * outputs]);
        if index > 1 {
            pull_back(simd, inputs, outputs, &p[at..at + inputs * outputs], d, x);
        }
        row -= inputs;
    }
    error
}

/// [`tile`] with two hidden layers, written out so that sizes known at compile time stay so.
#[inline(always)]
#[allow(clippy::too_many_arguments)]
fn tile_of_two<S: Simd>(
    simd: S,
    inputs: usize,
    h1: usize,
    h2: usize,
    p: &[f32],
    answer: Answer,
    batch: Batch<'_>,
    work: &mut Workspace,
    scale: f32,
) -> f32x16<S> {
    let Workspace { rows, deltas, sums, .. } = work;
    fill(inputs, batch, rows);
    let (x, rest) = rows.split_at_mut(inputs);
    let (y1, y2) = rest.split_at_mut(h1);
    let (p1, rest) = p.split_at((inputs + 1) * h1);
    let (p2, p3) = rest.split_at((h1 + 1) * h2);
    let (g1, rest) = sums.split_at_mut((inputs + 1) * h1);
    let (g2, g3) = rest.split_at_mut((h1 + 1) * h2);
    hidden(simd, inputs, h1, &p1[..inputs * h1], &p1[inputs * h1..], x, y1);
    hidden(simd, h1, h2, &p2[..h1 * h2], &p2[h1 * h2..], y1, y2);
    let error = output(simd, h2, p3, answer, batch, y2, &mut deltas[0], g3, scale);
    layer_gradient(simd, h1, h2, y1, y2, g2);
    pull_back(simd, h1, h2, &p2[..h1 * h2], y2, y1);
    layer_gradient(simd, inputs, h1, x, y1, g1);
    error
}

/// Sums the gradient of a chunk of a batch.
#[inline(always)]
fn chunk<S: Simd>(
    simd: S,
    batch: Batch<'_>,
    work: &mut Workspace,
    mut tile: impl FnMut(Batch<'_>, &mut Workspace) -> f32x16<S>,
) {
    work.sums.fill(Lanes::ZERO);
    work.error = 0.0;
    for order in batch.order.chunks(TILE) {
        let error = tile(Batch { order, ..batch }, work);
        work.error += f64::from(error.reduce_sum());
    }
    for (g, sums) in work.gradient.iter_mut().zip(&work.sums) {
        *g = sums.load(simd).reduce_sum();
    }
}

/// Gradient of a chunk: level, sizes, parameters, answer, batch, workspace, scale of the derivatives.
type Kernel = fn(Level, &[usize], &[f32], Answer, Batch<'_>, &mut Workspace, f32);

/// The kernel for networks whose sizes are known at compile time.
#[inline(never)]
fn fixed<const INPUTS: usize, const H1: usize, const H2: usize>(
    level: Level,
    _: &[usize],
    p: &[f32],
    answer: Answer,
    batch: Batch<'_>,
    work: &mut Workspace,
    scale: f32,
) {
    dispatch!(level, simd => chunk(simd, batch, work, #[inline(always)] |batch, work| {
        tile_of_two(simd, INPUTS, H1, H2, p, answer, batch, work, scale)
    }));
}

macro_rules! kernel_for {
    (@ [$([$inputs:literal, $h1:literal, $h2:literal])*] $sizes:expr) => {
        match $sizes {
            $([$inputs, $h1, $h2] => fixed::<$inputs, $h1, $h2>,)*
            _ => any,
        }
    };
}

/// The fastest kernel for layers of these sizes.
fn kernel_for(sizes: &[usize]) -> Kernel {
    shipped_sizes!(kernel_for, sizes)
}

#[inline(never)]
fn any(level: Level, sizes: &[usize], p: &[f32], answer: Answer, batch: Batch<'_>, work: &mut Workspace, scale: f32) {
    dispatch!(level, simd => chunk(simd, batch, work, #[inline(always)] |batch, work| tile(simd, sizes, p, answer,
        batch, work, scale)));
}

/// A network being fitted by the fused kernel.
pub struct Fused {
    network: Padded,
    answer: Answer,
    level: Level,
    kernel: Kernel,
    parameters: Vec<f32>,
    adam: Adam,
    works: Vec<Workspace>,
    gradient: Vec<f32>,
}

impl Fused {
    /// An optimiser at the given weights, on the best SIMD level of this machine.
    ///
    /// # Panics
    /// As [`Self::at_level`].
    pub fn new(answer: impl Into<Answer>, shapes: &[(usize, usize)], parameters: &[f32], config: &TrainConfig) -> Self {
        Self::at_level(Level::new(), answer, shapes, parameters, config)
    }

    /// An optimiser on a given SIMD level.
    ///
    /// # Panics
    /// If a network of several outputs answers with anything but their sigmoids.
    pub fn at_level(
        level: Level,
        answer: impl Into<Answer>,
        shapes: &[(usize, usize)],
        parameters: &[f32],
        config: &TrainConfig,
    ) -> Self {
        let (network, answer) = (Padded::new(shapes), answer.into());
        let (count, outputs) = (network.count(), network.outputs());
        assert!(
            outputs == 1 || answer == Answer::Sigmoid,
            "several outputs answer with their sigmoids"
        );
        Self {
            answer,
            parameters: network.pad(parameters),
            adam: Adam::new(count, config),
            kernel: if outputs == 1 { kernel_for(network.sizes()) } else { any },
            works: Vec::new(),
            gradient: vec![0.0; count],
            level,
            network,
        }
    }

    /// Name of the SIMD level.
    pub fn level_name(&self) -> &'static str {
        level_name(self.level)
    }

    /// Sums the gradient of a batch into `self.gradient`; the mean squared error is returned.
    fn backward(&mut self, batch: Batch<'_>) -> f64 {
        let rows = batch.rows();
        let chunks = batch.order.len().div_ceil(CHUNK);
        if self.works.len() < chunks {
            let count = self.network.count();
            let work = Workspace {
                rows: vec![ZEROS; self.network.rows()],
                deltas: vec![ZEROS; self.network.outputs()],
                sums: vec![Lanes::ZERO; count],
                gradient: vec![0.0; count],
                error: 0.0,
            };
            self.works.resize(chunks, work);
        }
        let Self {
            network,
            answer,
            level,
            kernel,
            parameters,
            works,
            gradient,
            ..
        } = self;
        let answers = rows * network.outputs();
        let scale = 2.0 / answers as f32;
        works[..chunks]
            .par_iter_mut()
            .zip(batch.order.par_chunks(CHUNK))
            .for_each(|(work, order)| {
                kernel(
                    *level,
                    network.sizes(),
                    parameters,
                    *answer,
                    Batch { order, ..batch },
                    work,
                    scale,
                );
            });
        gradient.copy_from_slice(&works[0].gradient);
        for work in &works[1..chunks] {
            for (g, part) in gradient.iter_mut().zip(&work.gradient) {
                *g += part;
            }
        }
        works[..chunks].iter().map(|w| w.error).sum::<f64>() / answers as f64
    }
}

/// Name of a SIMD level, as provenance and benchmarks state it.
pub fn level_name(level: Level) -> &'static str {
    match level {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        Level::Avx512(_) => "avx512",
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        Level::Avx2(_) => "avx2",
        #[cfg(target_arch = "aarch64")]
        Level::Neon(_) => "neon",
        _ => "baseline",
    }
}

impl Optimiser for Fused {
    fn step(&mut self, batch: Batch<'_>, learning_rate: f64) -> f64 {
        let error = self.backward(batch);
        self.adam.step(&mut self.parameters, &self.gradient, learning_rate);
        error
    }

    fn gradient(&mut self, batch: Batch<'_>) -> (f64, Vec<f32>) {
        let error = self.backward(batch);
        (error, self.network.unpad(&self.gradient))
    }

    fn parameters(&self) -> Vec<f32> {
        self.network.unpad(&self.parameters)
    }

    fn moments(&self) -> AdamMoments {
        self.adam.moments(|padded| self.network.unpad(padded))
    }

    fn restore(&mut self, parameters: &[f32], moments: &AdamMoments) {
        self.parameters = self.network.pad(parameters);
        self.adam.restore(moments, |plain| self.network.pad(plain));
    }
}

/// Rows in blocks, in their order: what tests and benchmarks step over.
pub fn all_blocks(blocks: &Blocks) -> Vec<u32> {
    (0..blocks.len() as u32).collect()
}
