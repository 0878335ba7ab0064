//! Drawing pixels from a law.
//!
//! Exact arithmetic and `libm` only: the mathematics of the platform would give other bytes on other machines.

use super::config::{AlphaLaw, AlphaReading, CountLaw, DepthLaw, DepthReading, FragmentCount, PixelLaw, Range};
use crate::numeric::doubles::{self, DOUBLES};
use crate::numeric::rng::{Stream, unit};
use crate::pixel::{CameraPlanes, LogWarp, ViewZ};
use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, f64x8};
use rand::Rng;
use rand_distr::{Distribution, Uniform};
use std::f64::consts::TAU;

/// Most materials that the objects of a pixel are made of.
const MAX_MATERIALS: usize = 4;

/// Least opacity of a nearly opaque fragment.
const NEARLY_OPAQUE: f64 = 0.9;

/// What fills a last vector up: in the domain of all that is computed here, and no special case of it.
const FILLER: f64 = 0.125;

/// A whole number below n of a random word, uniform but for a bias below n/2^32.
fn below(word: u32, n: usize) -> usize {
    ((u64::from(word) * n as u64) >> 32) as usize
}

/// Replaces all numbers by what becomes of them, eight at a time.
macro_rules! each {
    ($values:expr, $simd:ident, $x:ident => $becomes:expr) => {
        dispatch!(Level::new(), $simd => map($simd, $values, #[inline(always)] |$x| $becomes))
    };
}

#[inline(always)]
fn map<S: Simd>(simd: S, values: &mut [f64], becomes: impl Fn(f64x8<S>) -> f64x8<S>) {
    let (whole, rest) = values.as_chunks_mut::<DOUBLES>();
    for x in whole {
        becomes(f64x8::from_slice(simd, x)).store_slice(x);
    }
    if !rest.is_empty() {
        let mut x = [FILLER; DOUBLES];
        x[..rest.len()].copy_from_slice(rest);
        becomes(f64x8::from_slice(simd, &x)).store_slice(&mut x);
        rest.copy_from_slice(&x[..rest.len()]);
    }
}

/// The uniform law: low + scale u.
#[derive(Debug, Clone, Copy)]
struct UniformInclusive {
    low: f64,
    scale: f64,
}

impl UniformInclusive {
    /// On [min, max], both ends included: the greatest u, 1 − 2^−52, gives max.
    fn new(Range { min, max }: Range) -> Self {
        let greatest = 1.0 - f64::EPSILON;
        let mut scale = (max - min) / greatest;
        while scale * greatest + min > max {
            scale = scale.next_down();
        }
        Self { low: min, scale }
    }

    fn at(&self, u: f64) -> f64 {
        u * self.scale + self.low
    }

    fn draw(&self, rng: &mut Stream) -> f64 {
        self.at(rng.unit())
    }
}

/// A uniform law that never leaves [min, max], whatever rounding does: min + (max − min) u.
#[derive(Debug, Clone, Copy)]
struct UniformLerp(Range);

impl UniformLerp {
    fn at(&self, u: f64) -> f64 {
        let Range { min, max } = self.0;
        (min + (max - min) * u).min(max)
    }

    fn draw(&self, rng: &mut Stream) -> f64 {
        self.at(rng.unit())
    }
}

/// The log-uniform law on [min, max]: every octave is as likely as any other.
#[derive(Debug, Clone, Copy)]
struct LogUniform {
    range: Range,
    ln_min: f64,
    ln_ratio: f64,
}

impl LogUniform {
    fn new(range: Range) -> Self {
        let ln_min = libm::log(range.min);
        Self {
            range,
            ln_min,
            ln_ratio: libm::log(range.max) - ln_min,
        }
    }

    fn draw(&self, rng: &mut Stream) -> f64 {
        libm::exp(self.ln_min + self.ln_ratio * rng.unit()).clamp(self.range.min, self.range.max)
    }

    /// [`Self::draw`] of all these units.
    fn of_units(&self, units: &mut [f64]) {
        let Self {
            range,
            ln_min,
            ln_ratio,
        } = *self;
        each!(units, simd, u => {
            let splat = |x: f64| f64x8::splat(simd, x);
            doubles::exp(simd, splat(ln_min) + splat(ln_ratio) * u).max(splat(range.min)).min(splat(range.max))
        });
    }
}

/// The two standard normal numbers of each pair of units, in the places of those.
///
/// # Source
/// Box and Muller, *A note on the generation of random normal deviates*, 1958.
fn normals(radii: &mut [f64], angles: &mut [f64]) {
    #[inline(always)]
    fn all<S: Simd>(simd: S, radii: &mut [f64], angles: &mut [f64]) {
        let splat = |x: f64| f64x8::splat(simd, x);
        for (u, v) in radii
            .as_chunks_mut::<DOUBLES>()
            .0
            .iter_mut()
            .zip(angles.as_chunks_mut::<DOUBLES>().0)
        {
            // 1 − u is never 0.
            let r = (splat(-2.0) * doubles::ln(simd, splat(1.0) - f64x8::from_slice(simd, u))).sqrt();
            let (sin, cos) = doubles::sincos(simd, splat(TAU) * f64x8::from_slice(simd, v));
            (r * cos).store_slice(u);
            (r * sin).store_slice(v);
        }
    }
    assert!(
        radii.len() == angles.len() && radii.len().is_multiple_of(DOUBLES),
        "whole vectors"
    );
    dispatch!(Level::new(), simd => all(simd, radii, angles));
}

/// Units to come, each with its logarithm and with the sine and cosine of its share of a turn: which of them will serve
/// for what is not known beforehand, as draws that are rejected shift all that follow.
#[derive(Default)]
struct Ahead {
    units: Vec<f64>,
    /// ln(1 − u)
    ln: Vec<f64>,
    sin: Vec<f64>,
    cos: Vec<f64>,
    /// The next of them.
    at: usize,
    /// The second normal number of a pair.
    spare: Option<f64>,
}

impl Ahead {
    /// Units that are at hand after [`Self::provide`].
    const LEAST: usize = 4;

    /// Makes four units at least, and about as many as are wanted.
    #[inline]
    fn provide(&mut self, rng: &mut Stream, wanted: usize) {
        if self.units.len() - self.at < Self::LEAST {
            self.refill(rng, wanted);
        }
    }

    #[inline(never)]
    fn refill(&mut self, rng: &mut Stream, wanted: usize) {
        #[inline(always)]
        fn all<S: Simd>(
            simd: S,
            Ahead {
                units, ln, sin, cos, ..
            }: &mut Ahead,
        ) {
            let splat = |x: f64| f64x8::splat(simd, x);
            for out in [&mut *ln, sin, cos] {
                out.resize(units.len(), 0.0);
            }
            let outputs = ln
                .as_chunks_mut::<DOUBLES>()
                .0
                .iter_mut()
                .zip(sin.as_chunks_mut::<DOUBLES>().0)
                .zip(cos.as_chunks_mut::<DOUBLES>().0);
            for (u, ((ln, sin), cos)) in units.as_chunks::<DOUBLES>().0.iter().zip(outputs) {
                let u = f64x8::from_slice(simd, u);
                doubles::ln(simd, splat(1.0) - u).store_slice(ln);
                let (s, c) = doubles::sincos(simd, splat(TAU) * u);
                s.store_slice(sin);
                c.store_slice(cos);
            }
        }
        self.settle(rng);
        let words = rng.words().as_chunks().0;
        let words = &words[..words.len().min(wanted.max(Self::LEAST).next_multiple_of(DOUBLES))];
        self.units.extend(words.iter().map(|&pair| unit(pair)));
        let count = self.units.len();
        self.units.resize(count.next_multiple_of(DOUBLES), FILLER);
        dispatch!(Level::new(), simd => all(simd, self));
        self.units.truncate(count);
    }

    /// Uses up the units that were taken, and forgets the others.
    fn settle(&mut self, rng: &mut Stream) {
        rng.skip(2 * self.at);
        self.at = 0;
        self.units.clear();
    }

    /// A standard normal number; takes two units, or none.
    #[inline]
    fn normal(&mut self) -> f64 {
        if let Some(x) = self.spare.take() {
            return x;
        }
        let r = (-2.0 * self.ln[self.at]).sqrt();
        let (sin, cos) = (self.sin[self.at + 1], self.cos[self.at + 1]);
        self.at += 2;
        self.spare = Some(r * sin);
        r * cos
    }
}

/// The gamma law of unit scale.
struct Gamma {
    d: f64,
    c: f64,
    /// 1/a where the shape a is below 1.
    boost: Option<f64>,
}

impl Gamma {
    fn new(a: f64) -> Self {
        let d = if a < 1.0 { a + 1.0 } else { a } - 1.0 / 3.0;
        Self {
            d,
            c: 1.0 / (9.0 * d).sqrt(),
            boost: (a < 1.0).then(|| 1.0 / a),
        }
    }

    /// A number and the logarithm of its factor, which is 0 where there is none; `wanted` units will be taken in about
    /// all that follows.
    ///
    /// # Source
    /// Marsaglia and Tsang, *A simple method for generating gamma variables*, 2000; shapes below 1 by their Sec. 6:
    /// γ(a) = γ(a + 1) u^(1/a).
    #[inline]
    fn draw(&self, rng: &mut Stream, ahead: &mut Ahead, wanted: usize) -> (f64, f64) {
        let gamma = loop {
            ahead.provide(rng, wanted);
            let x = ahead.normal();
            let v = 1.0 + self.c * x;
            if v <= 0.0 {
                continue;
            }
            let v = v * v * v;
            let (u, ln) = (1.0 - ahead.units[ahead.at], ahead.ln[ahead.at]);
            ahead.at += 1;
            // The first test is cheap and settles most draws.
            if u < 1.0 - 0.0331 * (x * x) * (x * x) || ln < 0.5 * x * x + self.d * (1.0 - v + libm::log(v)) {
                break self.d * v;
            }
        };
        let Some(power) = self.boost else { return (gamma, 0.0) };
        ahead.at += 1;
        (gamma, power * ahead.ln[ahead.at - 1])
    }

    /// Applies the factors of which the logarithms are given; these become the factors on the way.
    fn boost(&self, gammas: &mut [f64], logarithms: &mut [f64]) {
        if self.boost.is_some() {
            each!(logarithms, simd, x => doubles::exp(simd, x));
            gammas
                .iter_mut()
                .zip(logarithms)
                .for_each(|(gamma, factor)| *gamma *= *factor);
        }
    }
}

/// Memory that the pixels of one task share.
#[derive(Default)]
pub(super) struct Scratch {
    /// Depth of each fragment: of the shape, in about [0, 1], then where it lies.
    depth: Vec<f64>,
    /// Units of opacities, then these.
    units: Vec<f64>,
    /// Units of normal numbers, which then take their places, and the fragments that they are for.
    radii: Vec<f64>,
    angles: Vec<f64>,
    soft: Vec<u32>,
    ahead: Ahead,
    /// Object of each fragment: whole numbers from 0.
    object: Vec<u32>,
    /// Centre and standard deviation of each cluster.
    clusters: Vec<(f64, f64)>,
    /// Opacity of each object, NaN until its first fragment is met.
    object_alpha: Vec<f32>,
}

/// One law, with all that its pixels share worked out.
#[derive(Debug, Clone)]
pub(super) struct Law {
    count: Count,
    depth: Depth,
    alpha: Alpha,
}

#[derive(Debug, Clone)]
enum Count {
    Uniform(Uniform<u32>),
    LogUniform { min: u32, max: u32, law: LogUniform },
}

#[derive(Debug, Clone)]
enum Depth {
    Window {
        law: UniformInclusive,
        reading: DepthReading,
    },
    Moment {
        shape: Shape,
        half: LogUniform,
    },
}

#[derive(Debug, Clone)]
enum Shape {
    Uniform,
    Clustered { clusters: Uniform<u32>, width: LogUniform },
    Paired { gap: LogUniform },
    Beta { a: LogUniform, b: LogUniform },
}

#[derive(Debug, Clone)]
enum Alpha {
    Uniform(UniformInclusive, AlphaReading),
    LogUniform(LogUniform, AlphaReading),
    Subrange(Range),
    Splats { min: f64, peak: LogUniform },
    NearOpaque { share: Range, low: LogUniform },
}

impl Law {
    /// Of a validated configuration.
    pub(super) fn new(config: &PixelLaw) -> Self {
        Self {
            count: Count::new(config.fragments),
            depth: Depth::new(config),
            alpha: Alpha::new(config.alpha),
        }
    }

    /// Appends one pixel.
    pub(super) fn draw(
        &self,
        rng: &mut Stream,
        camera: &Camera,
        scratch: &mut Scratch,
        view_z: &mut Vec<f32>,
        alpha: &mut Vec<f32>,
    ) {
        let n = self.count.draw(rng);
        self.depth.draw(rng, n, camera, scratch, view_z);
        self.alpha.draw(rng, n, scratch, alpha);
    }
}

/// From the depths that laws are in to the view depth that fragment lists carry.
#[derive(Debug, Clone)]
pub(super) struct Camera {
    planes: CameraPlanes,
    warp: LogWarp,
}

impl Camera {
    /// Of validated planes.
    pub(super) fn new(planes: CameraPlanes) -> Self {
        let [near, far] = [planes.near(), planes.far()].map(|v| ViewZ(v.into()));
        Self {
            planes,
            warp: LogWarp::new(near, far).expect("validated: 0 < near < far"),
        }
    }

    /// Appends the view depths of window depths, which these become on the way.
    fn of_window(&self, depth: &mut [f64], out: &mut Vec<f32>) {
        each!(depth, simd, w => self.planes.view_z_doubles(simd, w));
        self.within(depth, out);
    }

    /// The same of moment depths.
    fn of_moment(&self, depth: &mut [f64], out: &mut Vec<f32>) {
        each!(depth, simd, z => self.warp.view_z_doubles(simd, z));
        self.within(depth, out);
    }

    fn within(&self, view_z: &[f64], out: &mut Vec<f32>) {
        let (near, far) = (self.planes.near(), self.planes.far());
        out.extend(view_z.iter().map(|&v| (v as f32).clamp(near, far)));
    }
}

impl Count {
    fn new(FragmentCount { min, max, law }: FragmentCount) -> Self {
        match law {
            CountLaw::Uniform => Self::Uniform(Uniform::new_inclusive(min, max).expect("validated: min <= max")),
            CountLaw::LogUniform => Self::LogUniform {
                min,
                max,
                law: LogUniform::new(Range {
                    min: min.into(),
                    max: f64::from(max) + 1.0,
                }),
            },
        }
    }

    fn draw(&self, rng: &mut Stream) -> usize {
        match self {
            Self::Uniform(law) => law.sample(rng) as usize,
            Self::LogUniform { min, max, law } => (law.draw(rng) as u32).clamp(*min, *max) as usize,
        }
    }
}

impl Depth {
    fn new(config: &PixelLaw) -> Self {
        let shape = match config.depth {
            DepthLaw::Window { min, max, reading } => {
                return Self::Window {
                    law: UniformInclusive::new(Range { min, max }),
                    reading,
                };
            }
            DepthLaw::Uniform {} => Shape::Uniform,
            DepthLaw::Clustered { clusters, width } => Shape::Clustered {
                clusters: Uniform::new_inclusive(clusters.min, clusters.max).expect("validated: min <= max"),
                width: LogUniform::new(width),
            },
            DepthLaw::Paired { gap } => Shape::Paired {
                gap: LogUniform::new(gap),
            },
            DepthLaw::Beta { a, b } => Shape::Beta {
                a: LogUniform::new(a),
                b: LogUniform::new(b),
            },
        };
        Self::Moment {
            shape,
            half: LogUniform::new(config.range.expect("validated: laws in moment depth have a range").half),
        }
    }

    fn draw(&self, rng: &mut Stream, n: usize, camera: &Camera, scratch: &mut Scratch, view_z: &mut Vec<f32>) {
        match self {
            Self::Window { law, reading } => {
                scratch.object.clear();
                scratch.object.extend(0..n as u32);
                draw_window(rng, n, law, *reading, &mut scratch.depth);
                camera.of_window(&mut scratch.depth, view_z);
            }
            Self::Moment { shape, half } => {
                shape.draw(rng, n, scratch);
                let half = half.draw(rng);
                let center = (2.0 * rng.unit() - 1.0) * (1.0 - half);
                stretch(&mut scratch.depth, center, half);
                camera.of_moment(&mut scratch.depth, view_z);
            }
        }
    }
}

/// Window depths of n fragments.
fn draw_window(rng: &mut Stream, n: usize, law: &UniformInclusive, reading: DepthReading, depth: &mut Vec<f64>) {
    let anywhere = UniformInclusive::new(Range { min: 0.0, max: 1.0 });
    match reading {
        DepthReading::PerFragment => {
            fill(rng, n, depth);
            depth.iter_mut().for_each(|w| *w = law.at(*w));
        }
        DepthReading::PixelExtent if n == 1 => {
            depth.clear();
            depth.push(anywhere.draw(rng));
        }
        DepthReading::PixelExtent => {
            let extent = law.draw(rng);
            let start = anywhere.draw(rng) * (1.0 - extent);
            fill(rng, n - 2, depth);
            depth.iter_mut().for_each(|u| *u = anywhere.at(*u));
            depth.splice(..0, [0.0, 1.0]);
            depth
                .iter_mut()
                .for_each(|u| *u = (start + *u * extent).clamp(0.0, 1.0));
        }
    }
}

/// So many units in the place of what is there.
fn fill(rng: &mut Stream, n: usize, units: &mut Vec<f64>) {
    units.resize(n, 0.0);
    rng.units(units);
}

impl Shape {
    /// Depths and objects of n fragments.
    fn draw(&self, rng: &mut Stream, n: usize, scratch: &mut Scratch) {
        let Scratch {
            depth,
            units,
            object,
            clusters,
            radii,
            angles,
            soft,
            ahead,
            ..
        } = scratch;
        object.clear();
        match self {
            Self::Uniform => fill(rng, n, depth),
            Self::Clustered { clusters: count, width } => {
                clusters.clear();
                clusters.extend((0..count.sample(rng)).map(|_| (rng.unit(), width.draw(rng))));
                scatter(rng, n, clusters.len(), object, depth, [radii, angles], soft);
                for (x, &k) in depth.iter_mut().zip(&*object) {
                    let (center, width) = clusters[k as usize];
                    *x = center + width * *x;
                }
                return;
            }
            Self::Paired { gap } => {
                let gap = gap.draw(rng);
                fill(rng, n.next_multiple_of(2), depth);
                for [front, back] in depth.as_chunks_mut().0 {
                    *back = *front + gap * *back;
                }
                depth.truncate(n);
                object.extend((0..n as u32).map(|i| i / 2));
                return;
            }
            Self::Beta { a, b } => {
                let laws = [a, b].map(|shape| Gamma::new(shape.draw(rng)));
                let units_of_a_fragment = 4 + laws.iter().filter(|law| law.boost.is_some()).count();
                let [x, y] = [depth, units];
                for of_law in [&mut *x, y, radii, angles] {
                    of_law.resize(n, 0.0);
                }
                for i in 0..n {
                    let wanted = units_of_a_fragment * (n - i);
                    (x[i], radii[i]) = laws[0].draw(rng, ahead, wanted);
                    (y[i], angles[i]) = laws[1].draw(rng, ahead, wanted);
                }
                ahead.settle(rng);
                ahead.spare = None;
                laws[0].boost(x, radii);
                laws[1].boost(y, angles);
                x.iter_mut().zip(y).for_each(|(x, y)| *x /= *x + *y);
            }
        }
        object.extend(0..n as u32);
    }
}

/// Clusters of n fragments, and how far each lies from its cluster's centre, in standard deviations: half of them by
/// the normal and half by the uniform law.
///
/// Every fragment takes a word for its cluster, two to choose the law, and two or four more: normal numbers come in
/// pairs, of which the second takes none. Which words serve what is settled first, without a branch; then all normal
/// numbers are computed at once.
fn scatter(
    rng: &mut Stream,
    n: usize,
    clusters: usize,
    object: &mut Vec<u32>,
    out: &mut Vec<f64>,
    [radii, angles]: [&mut Vec<f64>; 2],
    soft: &mut Vec<u32>,
) {
    object.resize(n, 0);
    out.resize(n, 0.0);
    soft.resize(n, 0);
    for units in [&mut *radii, angles] {
        // Half of the fragments take a pair each at the most, and one place more is written ahead.
        units.resize((n / 2 + 2).next_multiple_of(DOUBLES), FILLER);
    }
    let (mut pairs, mut count, mut spare) = (0, 0, 0);
    for i in 0..n {
        let &[which, _, law, u0, u1, v0, v1, _] = rng.peek();
        object[i] = below(which, clusters) as u32;
        let (u, v) = (unit([u0, u1]), unit([v0, v1]));
        // √3 makes the uniform law's deviation 1.
        out[i] = (2.0 * u - 1.0) * 3f64.sqrt();
        (radii[pairs], angles[pairs], soft[count]) = (u, v, i as u32);
        // Units below ½ have no highest bit.
        let is_soft = (law >> 31 ^ 1) as usize;
        let takes_pair = is_soft & (spare ^ 1);
        (pairs, count, spare) = (pairs + takes_pair, count + is_soft, spare ^ is_soft);
        rng.skip(3 + 2 * (is_soft ^ 1) + 4 * takes_pair);
    }
    let whole = pairs.next_multiple_of(DOUBLES);
    normals(&mut radii[..whole], &mut angles[..whole]);
    for (j, &i) in soft[..count].iter().enumerate() {
        out[i as usize] = if j % 2 == 0 { radii[j / 2] } else { angles[j / 2] };
    }
}

/// Moves and scales depths until the least is center − half and the greatest is center + half, to the bit. Depths that
/// all tie go to the centre.
fn stretch(depth: &mut [f64], center: f64, half: f64) {
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

impl Alpha {
    fn new(law: AlphaLaw) -> Self {
        match law {
            AlphaLaw::Uniform { min, max, reading } => {
                Self::Uniform(UniformInclusive::new(Range { min, max }), reading)
            }
            AlphaLaw::LogUniform { min, max, reading } => {
                Self::LogUniform(LogUniform::new(Range { min, max }), reading)
            }
            AlphaLaw::Subrange { min, max } => Self::Subrange(Range { min, max }),
            AlphaLaw::Splats { min, peak } => Self::Splats {
                min,
                peak: LogUniform::new(peak),
            },
            AlphaLaw::NearOpaque { share, low } => Self::NearOpaque {
                share,
                low: LogUniform::new(low),
            },
        }
    }

    fn draw(&self, rng: &mut Stream, n: usize, scratch: &mut Scratch, out: &mut Vec<f32>) {
        let units = &mut scratch.units;
        match self {
            Self::Uniform(law, AlphaReading::PerFragment) => {
                fill(rng, n, units);
                out.extend(units.iter().map(|&u| opacity(law.at(u))));
            }
            Self::LogUniform(law, AlphaReading::PerFragment) => {
                fill(rng, n, units);
                law.of_units(units);
                out.extend(units.iter().map(|&alpha| opacity(alpha)));
            }
            Self::Uniform(law, reading) => draw_shared(rng, n, |rng| law.draw(rng), *reading, scratch, out),
            Self::LogUniform(law, reading) => draw_shared(rng, n, |rng| law.draw(rng), *reading, scratch, out),
            Self::Subrange(range) => {
                let (a, b) = (UniformLerp(*range).draw(rng), UniformLerp(*range).draw(rng));
                let law = UniformLerp(Range {
                    min: a.min(b),
                    max: a.max(b),
                });
                fill(rng, n, units);
                out.extend(units.iter().map(|&u| law.at(u) as f32));
            }
            Self::Splats { min, peak } => {
                let Scratch {
                    units,
                    object,
                    object_alpha,
                    ..
                } = scratch;
                object_alpha.clear();
                fill(rng, n, units);
                out.extend(object.iter().zip(units.iter()).map(|(&o, &u)| {
                    let o = o as usize;
                    while object_alpha.len() <= o {
                        object_alpha.push(peak.draw(rng) as f32);
                    }
                    let peak = f64::from(object_alpha[o]);
                    opacity(peak * libm::exp(u * libm::log(min / peak)))
                }));
            }
            Self::NearOpaque { share, low } => {
                let (share, low) = (UniformLerp(*share).draw(rng), low.draw(rng));
                fill(rng, 2 * n, units);
                out.extend(units.as_chunks().0.iter().map(|&[u, v]| {
                    let range = if u < share {
                        Range {
                            min: NEARLY_OPAQUE,
                            max: 1.0,
                        }
                    } else {
                        Range { min: 0.0, max: low }
                    };
                    UniformLerp(range).at(v) as f32
                }));
            }
        }
    }
}

fn opacity(alpha: f64) -> f32 {
    (alpha as f32).clamp(0.0, 1.0)
}

/// Opacities that several fragments share.
fn draw_shared(
    rng: &mut Stream,
    n: usize,
    law: impl Fn(&mut Stream) -> f64,
    reading: AlphaReading,
    Scratch {
        object, object_alpha, ..
    }: &mut Scratch,
    out: &mut Vec<f32>,
) {
    if reading == AlphaReading::PerPixel {
        let alpha = opacity(law(rng));
        out.extend(std::iter::repeat_n(alpha, n));
        return;
    }
    let mut materials = [0.0; MAX_MATERIALS];
    let materials = &mut materials[..1 + below(rng.next_u32(), MAX_MATERIALS)];
    materials.fill_with(|| opacity(law(rng)));
    object_alpha.clear();
    out.extend(object.iter().map(|&o| {
        let o = o as usize;
        if object_alpha.len() <= o {
            object_alpha.resize(o + 1, f32::NAN);
        }
        if object_alpha[o].is_nan() {
            object_alpha[o] = materials[below(rng.next_u32(), materials.len())];
        }
        object_alpha[o]
    }));
}

#[cfg(test)]
mod tests {
    use super::super::config::{CountRange, PixelRange, SynthConfig};
    use super::*;
    use crate::numeric::rng::stream;

    const DRAWS: usize = 50_000;

    fn rng() -> Stream {
        stream(7, 0x7e57, 0)
    }

    fn range(min: f64, max: f64) -> Range {
        Range { min, max }
    }

    fn draws(mut draw: impl FnMut(&mut Stream) -> f64) -> Vec<f64> {
        let mut rng = rng();
        (0..DRAWS).map(|_| draw(&mut rng)).collect()
    }

    fn mean(values: &[f64]) -> f64 {
        values.iter().sum::<f64>() / values.len() as f64
    }

    /// Whether the mean of `f` over the values is `expected`, within 5 standard errors as the values themselves have
    /// them.
    fn has_mean(values: &[f64], f: impl Fn(f64) -> f64, expected: f64) -> bool {
        let values: Vec<f64> = values.iter().map(|&x| f(x)).collect();
        let found = mean(&values);
        let variance = values.iter().map(|x| (x - found).powi(2)).sum::<f64>() / values.len() as f64;
        (found - expected).abs() < 5.0 * (variance / values.len() as f64).sqrt()
    }

    /// Shapes of n fragments each, with the objects of their fragments.
    fn shapes(depth: DepthLaw, n: usize, count: usize) -> Vec<(Vec<f64>, Vec<u32>)> {
        let config = PixelLaw {
            depth,
            range: Some(PixelRange { half: range(1.0, 1.0) }),
            ..SynthConfig::paper().pixels[0]
        };
        let Depth::Moment { shape, .. } = Depth::new(&config) else {
            panic!("a law in moment depth")
        };
        let (mut rng, mut scratch) = (rng(), Scratch::default());
        (0..count)
            .map(|_| {
                shape.draw(&mut rng, n, &mut scratch);
                (scratch.depth.clone(), scratch.object.clone())
            })
            .collect()
    }

    /// Opacities of pixels whose fragments 0 and 1 are one object, 2 and 3 the next, and so on.
    fn alphas(law: AlphaLaw, n: usize, count: usize) -> Vec<Vec<f32>> {
        let (law, mut rng) = (Alpha::new(law), rng());
        let mut scratch = Scratch {
            object: (0..n as u32).map(|i| i / 2).collect(),
            ..Scratch::default()
        };
        (0..count)
            .map(|_| {
                let mut out = Vec::new();
                law.draw(&mut rng, n, &mut scratch, &mut out);
                out
            })
            .collect()
    }

    #[test]
    fn the_basic_laws() {
        let u = draws(Stream::unit);
        assert!(u.iter().all(|u| (0.0..1.0).contains(u)));
        assert!(has_mean(&u, |u| u, 0.5) && has_mean(&u, |u| u * u, 1.0 / 3.0));
        // Control: the tolerance is narrower than a hundredth.
        assert!(!has_mean(&u, |u| u, 0.51));
        let k = draws(|rng| below(rng.next_u32(), 5) as f64);
        assert!((0..5).all(|i| has_mean(&k, |k| f64::from(u8::from(k == f64::from(i))), 0.2)));
        let log = draws(|rng| LogUniform::new(range(1e-3, 10.0)).draw(rng));
        assert!(log.iter().all(|x| (1e-3..=10.0).contains(x)));
        assert!(has_mean(&log, f64::log10, -1.0) && has_mean(&log, |x| x, (10.0 - 1e-3) / 1e4f64.ln()));
        let mut ahead = Ahead::default();
        let x = draws(|rng| {
            ahead.provide(rng, 100);
            ahead.normal()
        });
        let inside = |x: f64| f64::from(u8::from(x.abs() < 1.0));
        assert!(
            has_mean(&x, |x| x, 0.0)
                && has_mean(&x, |x| x * x, 1.0)
                && has_mean(&x, |x| x.powi(4), 3.0)
                && has_mean(&x, inside, 0.682_689_5)
        );
        // Those of one pair are independent.
        let products: Vec<f64> = x.chunks_exact(2).map(|x| x[0] * x[1]).collect();
        assert!(has_mean(&products, |p| p, 0.0));
    }

    /// Of a gamma variable, mean and variance are both a, and the mean of its logarithm is ψ(a).
    #[test]
    fn the_gamma_law() {
        for (a, digamma) in [(0.3, -3.502_524_222), (1.0, -0.577_215_665), (5.0, 1.506_117_668)] {
            let (gamma, mut ahead) = (Gamma::new(a), Ahead::default());
            let (mut x, mut logarithms): (Vec<f64>, Vec<f64>) = {
                let mut rng = rng();
                (0..DRAWS).map(|_| gamma.draw(&mut rng, &mut ahead, 100)).unzip()
            };
            gamma.boost(&mut x, &mut logarithms);
            assert!(x.iter().all(|&x| x > 0.0));
            assert!(
                has_mean(&x, |x| x, a) && has_mean(&x, |x| (x - a).powi(2), a) && has_mean(&x, f64::ln, digamma),
                "a = {a}"
            );
        }
    }

    #[test]
    fn counts() {
        let config = |min, max| FragmentCount {
            min,
            max,
            law: CountLaw::LogUniform,
        };
        let law = Count::new(config(3, 256));
        let n = draws(|rng| law.draw(rng) as f64);
        assert!(n.iter().all(|n| (3.0..=256.0).contains(n)));
        assert!(n.contains(&3.0) && n.contains(&256.0));
        // P(n) = ln((n + 1)/n)/ln(257/3).
        for k in [3.0f64, 10.0, 255.0] {
            assert!(
                has_mean(
                    &n,
                    |n| f64::from(u8::from(n == k)),
                    ((k + 1.0) / k).ln() / (257f64 / 3.0).ln()
                ),
                "{k}"
            );
        }
        let law = Count::new(config(7, 7));
        assert!(draws(|rng| law.draw(rng) as f64).iter().all(|&n| n == 7.0));
    }

    #[test]
    fn uniform_and_beta_shapes() {
        let depths = |law| {
            shapes(law, 8, DRAWS / 8)
                .into_iter()
                .flat_map(|(depth, _)| depth)
                .collect::<Vec<f64>>()
        };
        let x = depths(DepthLaw::Uniform {});
        assert!(has_mean(&x, |x| x, 0.5) && has_mean(&x, |x| x * x, 1.0 / 3.0));
        for (a, b) in [(0.3, 0.3), (0.5, 4.0), (5.0, 2.0), (0.1, 0.1)] {
            let x = depths(DepthLaw::Beta {
                a: range(a, a),
                b: range(b, b),
            });
            assert!(x.iter().all(|x| (0.0..=1.0).contains(x)));
            let m = a / (a + b);
            assert!(
                has_mean(&x, |x| x, m) && has_mean(&x, |x| (x - m).powi(2), a * b / ((a + b).powi(2) * (a + b + 1.0))),
                "a = {a}, b = {b}"
            );
        }
        // Fragments that stand alone are objects of their own.
        assert!(shapes(DepthLaw::Uniform {}, 5, 1)[0].1.iter().eq(&[0, 1, 2, 3, 4]));
    }

    #[test]
    fn clusters() {
        let law = |min, max, width| DepthLaw::Clustered {
            clusters: CountRange { min, max },
            width,
        };
        // One cluster of a known width: the variance is its square. Tolerance: 5 standard errors, sqrt(2/n) relative.
        let (x, object) = shapes(law(1, 1, range(0.05, 0.05)), DRAWS, 1).remove(0);
        let center = mean(&x);
        assert!(has_mean(&x, |x| (x - center).powi(2), 0.05f64.powi(2)) && object.iter().all(|&o| o == 0));
        // Narrow clusters: as many places as objects, and fragments of one object close together.
        for (depth, object) in shapes(law(2, 6, range(1e-6, 1e-5)), 200, 200) {
            let clusters = *object.iter().max().unwrap() + 1;
            assert!((2..=6).contains(&clusters));
            for (x, o) in depth.iter().zip(&object) {
                let first = object.iter().position(|p| p == o).unwrap();
                assert!((x - depth[first]).abs() < 1e-4);
            }
        }
        let wide = shapes(law(1, 6, range(1e-3, 0.3)), 2, 50_000);
        // A fragment's mean is that of the centres, wherever its cluster lies.
        assert!(has_mean(
            &wide.iter().map(|(x, _)| x[0]).collect::<Vec<_>>(),
            |x| x,
            0.5
        ));
    }

    /// Clusters and beta laws drawn number by number with scalar functions, in the order in which words are taken: the
    /// same depths to the bit as many at once, and as many words taken. Control: the pixel before.
    #[test]
    fn many_at_once_are_those_drawn_one_by_one() {
        struct Plain {
            spare: Option<f64>,
        }
        impl Plain {
            fn normal(&mut self, rng: &mut Stream) -> f64 {
                if let Some(x) = self.spare.take() {
                    return x;
                }
                let r = (-2.0 * libm::log(1.0 - rng.unit())).sqrt();
                let (sin, cos) = libm::sincos(TAU * rng.unit());
                self.spare = Some(r * sin);
                r * cos
            }

            fn gamma(&mut self, rng: &mut Stream, a: f64) -> f64 {
                let law = Gamma::new(a);
                let gamma = loop {
                    let x = self.normal(rng);
                    let v = 1.0 + law.c * x;
                    let v = v * v * v;
                    if v > 0.0 && libm::log(1.0 - rng.unit()) < 0.5 * x * x + law.d * (1.0 - v + libm::log(v)) {
                        break law.d * v;
                    }
                };
                if a < 1.0 {
                    gamma * libm::exp(1.0 / a * libm::log(1.0 - rng.unit()))
                } else {
                    gamma
                }
            }
        }
        let mut last = Vec::new();
        for pixel in 0..3000 {
            let mut many = stream(9, 0x7e57, pixel);
            // Words before the pixel, so that it starts anywhere.
            for _ in 0..pixel % 200 {
                many.next_u32();
            }
            let mut one = many.clone();
            let (n, mut scratch) = (1 + (pixel as usize * 7) % 150, Scratch::default());
            let mut plain = Plain { spare: None };
            let expected: Vec<f64> = if pixel % 2 == 0 {
                let (a, b) = (0.1 + 0.003 * (pixel % 1000) as f64, 0.1 + 0.01 * (pixel % 300) as f64);
                let shape = Shape::Beta {
                    a: LogUniform::new(range(a, a)),
                    b: LogUniform::new(range(b, b)),
                };
                shape.draw(&mut many, n, &mut scratch);
                let _ = (one.unit(), one.unit());
                (0..n)
                    .map(|_| {
                        let (x, y) = (plain.gamma(&mut one, a), plain.gamma(&mut one, b));
                        x / (x + y)
                    })
                    .collect()
            } else {
                let Scratch {
                    depth,
                    object,
                    radii,
                    angles,
                    soft,
                    ..
                } = &mut scratch;
                scatter(&mut many, n, 5, object, depth, [radii, angles], soft);
                (0..n)
                    .map(|i| {
                        assert_eq!(object[i] as usize, below(one.next_u32(), 5));
                        if one.unit() < 0.5 {
                            plain.normal(&mut one)
                        } else {
                            (2.0 * one.unit() - 1.0) * 3f64.sqrt()
                        }
                    })
                    .collect()
            };
            assert_eq!(scratch.depth, expected, "pixel {pixel}");
            assert_eq!(many.next_u64(), one.next_u64(), "pixel {pixel}");
            assert_ne!(expected, last);
            last = expected;
        }
    }

    /// The uniform law is that of `rand`, to the bit.
    #[test]
    fn the_uniform_law_is_rands() {
        for (min, max) in [
            (0.0, 1.0),
            (0.3, 1.0),
            (0.1, 0.5),
            (0.02, 0.95),
            (0.25, 0.25),
            (0.0, 0.0),
            (1.0 / 3.0, 0.7),
        ] {
            let (ours, theirs) = (
                UniformInclusive::new(range(min, max)),
                Uniform::new_inclusive(min, max).unwrap(),
            );
            let (mut a, mut b) = (rng(), rng());
            for _ in 0..1000 {
                let x = ours.draw(&mut a);
                assert!(x == theirs.sample(&mut b) && (min..=max).contains(&x));
            }
            assert_eq!(ours.at(0.0), min);
        }
    }

    #[test]
    fn pairs() {
        for (depth, object) in shapes(DepthLaw::Paired { gap: range(0.01, 0.1) }, 7, 2000) {
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
        let gaps: Vec<f64> = shapes(DepthLaw::Paired { gap: range(0.2, 0.2) }, 2, DRAWS)
            .iter()
            .map(|(x, _)| x[1] - x[0])
            .collect();
        assert!(has_mean(&gaps, |g| g, 0.1));
        let gaps: Vec<f64> = shapes(DepthLaw::Paired { gap: range(1e-3, 1.0) }, 2, DRAWS)
            .iter()
            .map(|(x, _)| x[1] - x[0])
            .collect();
        assert!(has_mean(&gaps, |g| g, 0.5 * (1.0 - 1e-3) / 1e3f64.ln()));
    }

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

    /// The ends of drawn pixels, read back from their view depths: half the range and the centre follow their laws.
    #[test]
    fn ranges_of_pixels() {
        let half = range(0.02, 0.5);
        let law = PixelLaw {
            depth: DepthLaw::Uniform {},
            range: Some(PixelRange { half }),
            ..SynthConfig::paper().pixels[0]
        };
        let planes = SynthConfig::paper().camera;
        let (law, camera, mut rng, mut scratch) = (Law::new(&law), Camera::new(planes), rng(), Scratch::default());
        let (mut halves, mut centers) = (Vec::new(), Vec::new());
        for _ in 0..10_000 {
            let (mut view_z, mut alpha) = (Vec::new(), Vec::new());
            law.draw(&mut rng, &camera, &mut scratch, &mut view_z, &mut alpha);
            assert!(view_z.iter().all(|v| (0.1..=100.0).contains(v)));
            let z: Vec<f64> = view_z.iter().map(|&v| camera.warp.moment(ViewZ(v.into())).0).collect();
            let (lo, hi) = z.iter().fold((1.0f64, -1.0f64), |(lo, hi), &z| (lo.min(z), hi.max(z)));
            let h = 0.5 * (hi - lo);
            // View depths are f32: 6e-8 relative is 2e-8 in moment depth.
            assert!((0.02 - 1e-7..=0.5 + 1e-7).contains(&h));
            halves.push(h);
            centers.push(0.5 * (hi + lo) / (1.0 - h));
        }
        assert!(has_mean(&halves, f64::ln, 0.5 * (0.02f64.ln() + 0.5f64.ln())));
        assert!(has_mean(&centers, |c| c, 0.0) && has_mean(&centers, |c| c * c, 1.0 / 3.0));
        assert!(centers.iter().all(|c| c.abs() < 1.0 + 1e-6));
    }

    #[test]
    fn alpha_readings() {
        for (law, log_mean) in [
            (
                AlphaLaw::LogUniform {
                    min: 0.01,
                    max: 1.0,
                    reading: AlphaReading::PerFragment,
                },
                Some(-1.0),
            ),
            (
                AlphaLaw::LogUniform {
                    min: 0.01,
                    max: 1.0,
                    reading: AlphaReading::PerPixel,
                },
                Some(-1.0),
            ),
            (
                AlphaLaw::LogUniform {
                    min: 0.01,
                    max: 1.0,
                    reading: AlphaReading::PerObject,
                },
                Some(-1.0),
            ),
            (
                AlphaLaw::Uniform {
                    min: 0.01,
                    max: 1.0,
                    reading: AlphaReading::PerObject,
                },
                None,
            ),
        ] {
            let pixels = alphas(law, 20, 10_000);
            // One fragment a pixel, so that the numbers are independent.
            let first: Vec<f64> = pixels.iter().map(|a| a[0].into()).collect();
            match log_mean {
                Some(expected) => assert!(has_mean(&first, f64::log10, expected), "{law:?}"),
                None => assert!(has_mean(&first, |a| a, 0.505), "{law:?}"),
            }
            let values: Vec<usize> = pixels
                .iter()
                .map(|a| {
                    a.iter()
                        .map(|a| a.to_bits())
                        .collect::<std::collections::HashSet<_>>()
                        .len()
                })
                .collect();
            match law {
                AlphaLaw::Uniform {
                    reading: AlphaReading::PerObject,
                    ..
                }
                | AlphaLaw::LogUniform {
                    reading: AlphaReading::PerObject,
                    ..
                } => {
                    assert!(pixels.iter().all(|a| a.chunks(2).all(|object| object[0] == object[1])));
                    assert!((1..=4).all(|n| values.contains(&n)) && values.iter().all(|n| (1..=4).contains(n)));
                }
                AlphaLaw::LogUniform {
                    reading: AlphaReading::PerPixel,
                    ..
                } => assert!(values.iter().all(|&n| n == 1)),
                _ => assert!(values.iter().all(|&n| n > 15)),
            }
        }
    }

    #[test]
    fn subranges_and_near_opaque() {
        let pixels = alphas(AlphaLaw::Subrange { min: 0.2, max: 0.8 }, 100, 4000);
        assert!(pixels.iter().flatten().all(|a| (0.2..=0.8).contains(a)));
        assert!(has_mean(
            &pixels.iter().map(|a| a[0].into()).collect::<Vec<_>>(),
            |a| a,
            0.5
        ));
        let extents: Vec<f64> = pixels
            .iter()
            .map(|a| f64::from(a.iter().copied().fold(0.0, f32::max) - a.iter().copied().fold(1.0, f32::min)))
            .collect();
        // The two ends are 0.6/3 apart on average; the extremes of 100 draws reach 99/101 of that.
        assert!(has_mean(&extents, |e| e, 0.2 * 99.0 / 101.0));

        // A splat's opacities lie between where it is cut off and its peak, uniform in their logarithm.
        let splats = AlphaLaw::Splats {
            min: 0.004,
            peak: range(0.5, 0.5),
        };
        let pixels = alphas(splats, 100, 4000);
        assert!(pixels.iter().flatten().all(|a| (0.00399..=0.50001).contains(a)));
        let logarithms: Vec<f64> = pixels.iter().map(|a| libm::log(a[0].into())).collect();
        assert!(has_mean(&logarithms, |l| l, 0.5 * libm::log(0.004 * 0.5)));

        let (share, low) = (range(0.1, 0.5), range(0.01, 0.3));
        let pixels = alphas(AlphaLaw::NearOpaque { share, low }, 200, 4000);
        assert!(
            pixels
                .iter()
                .flatten()
                .all(|a| (0.0..=0.3).contains(a) || (0.9..=1.0).contains(a))
        );
        let shares: Vec<f64> = pixels
            .iter()
            .map(|a| a.iter().filter(|&&a| a >= 0.9).count() as f64 / 200.0)
            .collect();
        assert!(has_mean(&shares, |s| s, 0.3));
        // Shares differ between pixels: the variance is that of the uniform law and of 200 fragments' binomial law.
        assert!(has_mean(
            &shares,
            |s| (s - 0.3).powi(2),
            0.16 / 12.0 + (0.3 * 0.7 - 0.16 / 12.0) / 200.0
        ));
    }

    #[test]
    fn degenerate_ranges_are_exact() {
        let constant = alphas(
            AlphaLaw::LogUniform {
                min: 0.3,
                max: 0.3,
                reading: AlphaReading::PerFragment,
            },
            5,
            100,
        );
        assert!(constant.iter().flatten().all(|&a| a == 0.3));
        let none = alphas(
            AlphaLaw::NearOpaque {
                share: range(0.0, 0.0),
                low: range(1.0, 1.0),
            },
            5,
            100,
        );
        assert!(none.iter().flatten().any(|&a| a < 0.9));
        let all = alphas(
            AlphaLaw::NearOpaque {
                share: range(1.0, 1.0),
                low: range(0.1, 0.1),
            },
            5,
            100,
        );
        assert!(all.iter().flatten().all(|a| (0.9..=1.0).contains(a)));
        let opaque = alphas(AlphaLaw::Subrange { min: 1.0, max: 1.0 }, 5, 100);
        assert!(opaque.iter().flatten().all(|&a| a == 1.0));
        // The whole range: every pixel's ends are the planes themselves. A single fragment lies halfway between them.
        let law = |n| {
            let config = SynthConfig::paper().pixels[0];
            let fragments = FragmentCount {
                min: n,
                max: n,
                law: CountLaw::LogUniform,
            };
            Law::new(&PixelLaw {
                fragments,
                depth: DepthLaw::Uniform {},
                range: Some(PixelRange { half: range(1.0, 1.0) }),
                ..config
            })
        };
        let (camera, mut rng, mut scratch) = (
            Camera::new(CameraPlanes::new(1.0, 16.0).unwrap()),
            rng(),
            Scratch::default(),
        );
        let (mut view_z, mut alpha) = (Vec::new(), Vec::new());
        law(4).draw(&mut rng, &camera, &mut scratch, &mut view_z, &mut alpha);
        assert_eq!(view_z.iter().copied().fold(f32::MAX, f32::min), 1.0);
        assert_eq!(view_z.iter().copied().fold(0.0, f32::max), 16.0);
        law(1).draw(&mut rng, &camera, &mut scratch, &mut view_z, &mut alpha);
        assert_eq!((view_z[4], view_z.len(), alpha.len()), (4.0, 5, 5));
    }
}
