//! Feature sets: what the network sees of a fragment. The only place that knows an order of columns.

pub mod core;
pub mod deep_weighted_blended;
pub mod paper;
pub mod passes;
pub mod recentred;
pub mod visible;
mod wide;

use crate::moments::storage::through_unorm16;
use crate::numeric::lanes::{self, LANES, Lanes};
use crate::numeric::quantise::round_f16;
use crate::numeric::rng::Stream;
use crate::pixel::absorbance_lanes;
use crate::pixel::{CameraPlanes, DepthError, FragmentList, LogWarp, Pixel, ViewZ, absorbance, abuffer};
use deep_weighted_blended::LinearRange;
use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, f32x16};
use rand::RngExt;
use recentred::{FragmentTerms, Pass2Input, PixelSums, Rounding};
use serde::{Deserialize, Serialize};

/// A feature set: which numbers, in which order, of which moments.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum FeatureSet {
    /// NMT24's seven features; see [`paper`].
    Paper,
    /// DWB22's three features; see [`deep_weighted_blended`].
    DeepWeightedBlended,
    /// What the other fragments look like from the pixel's own depth range, four moments; see [`recentred`].
    Recentred,
    /// [`Self::Recentred`] with six moments.
    #[serde(rename = "recentred-6")]
    Recentred6,
    /// [`Self::Recentred`] with eight moments.
    #[serde(rename = "recentred-8")]
    Recentred8,
}

/// What a network's output number means.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum OutputMeaning {
    /// The sigmoid is the transmittance T itself.
    Transmittance,
    /// The sigmoid is the front-to-back factor itself.
    FrontToBackFactor,
    /// The sigmoid s is the share of the other fragments' absorbance in front, and T = exp(−b_0' s).
    AbsorbanceShare,
}

/// Greatest ln b_0' that an answer is computed with; e^40 is more than anything absorbs, and a finite number in f32.
pub const MAX_LOG_ABSORBANCE: f32 = 40.0;

/// How a network's logit becomes its answer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Answer {
    /// The sigmoid s.
    Sigmoid,
    /// exp(−b s), b = e^min(f, 40) − offset, at least 0, f the feature of a column.
    AbsorbanceShare {
        /// The column.
        column: usize,
        /// What was added before the logarithm.
        offset: f32,
    },
}

/// What a dataset's rows are answered with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    /// Transmittance; see [`abuffer::transmittance`].
    Transmittance,
    /// Front-to-back factor; see [`abuffer::front_to_back_factor`].
    FrontToBackFactor,
}

impl Target {
    /// Its name in manifests.
    pub fn name(self) -> &'static str {
        match self {
            Self::Transmittance => "transmittance",
            Self::FrontToBackFactor => "front-to-back-factor",
        }
    }

    /// The exact answer for every fragment of a list, in its order, on all cores.
    pub fn of_list(self, list: &FragmentList) -> Vec<f64> {
        match self {
            Self::Transmittance => abuffer::list_transmittance(list),
            Self::FrontToBackFactor => abuffer::list_front_to_back_factor(list),
        }
    }
}

/// Depth that a feature set takes moments of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MomentDepthKind {
    /// z = 2w − 1, w the window depth.
    Window,
    /// z = 2 ln(v/v0)/ln(v1/v0) − 1, v the view depth, v0 and v1 its extremes in the scene.
    Log,
    /// It takes no moments.
    None,
}

impl FeatureSet {
    /// Every feature set.
    pub const ALL: [Self; 5] = [
        Self::Paper,
        Self::DeepWeightedBlended,
        Self::Recentred,
        Self::Recentred6,
        Self::Recentred8,
    ];

    /// Its name in configs, model files and file headers.
    pub fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::DeepWeightedBlended => "deep-weighted-blended",
            Self::Recentred => "recentred",
            Self::Recentred6 => "recentred-6",
            Self::Recentred8 => "recentred-8",
        }
    }

    /// Names of the columns, in order.
    pub fn columns(self) -> &'static [&'static str] {
        match self {
            Self::Paper => &paper::COLUMNS,
            Self::DeepWeightedBlended => &deep_weighted_blended::COLUMNS,
            Self::Recentred | Self::Recentred6 | Self::Recentred8 => recentred::columns(self.moments()),
        }
    }

    /// What the columns mean, line by line: part of header comments and metadata.
    pub fn description(self) -> &'static [&'static str] {
        match self {
            Self::Paper => &paper::DESCRIPTION,
            Self::DeepWeightedBlended => &deep_weighted_blended::DESCRIPTION,
            Self::Recentred | Self::Recentred6 | Self::Recentred8 => &recentred::DESCRIPTION,
        }
    }

    /// Number of columns, W.
    pub fn width(self) -> usize {
        self.columns().len()
    }

    /// What a network on these features is trained to give.
    pub fn output(self) -> OutputMeaning {
        match self {
            Self::Paper => OutputMeaning::Transmittance,
            Self::DeepWeightedBlended => OutputMeaning::FrontToBackFactor,
            Self::Recentred | Self::Recentred6 | Self::Recentred8 => OutputMeaning::AbsorbanceShare,
        }
    }

    /// How a logit becomes the answer: what [`Self::output`] means, as arithmetic.
    pub fn answer(self) -> Answer {
        match self.output() {
            OutputMeaning::Transmittance | OutputMeaning::FrontToBackFactor => Answer::Sigmoid,
            OutputMeaning::AbsorbanceShare => Answer::AbsorbanceShare {
                column: recentred::ABSORBANCE_COLUMN,
                offset: recentred::ABSORBANCE_OFFSET,
            },
        }
    }

    /// Moments that pass 1 adds up besides b_0.
    pub fn moments(self) -> usize {
        match self {
            Self::DeepWeightedBlended => 0,
            Self::Paper | Self::Recentred => 4,
            Self::Recentred6 => 6,
            Self::Recentred8 => 8,
        }
    }

    /// What its rows of a dataset are answered with.
    pub fn target(self) -> Target {
        match self {
            Self::Paper | Self::Recentred | Self::Recentred6 | Self::Recentred8 => Target::Transmittance,
            Self::DeepWeightedBlended => Target::FrontToBackFactor,
        }
    }

    /// Depth that its moments are taken of.
    pub fn moment_depth(self) -> MomentDepthKind {
        match self {
            Self::Paper => MomentDepthKind::Window,
            Self::DeepWeightedBlended => MomentDepthKind::None,
            Self::Recentred | Self::Recentred6 | Self::Recentred8 => MomentDepthKind::Log,
        }
    }
}

/// A feature set together with what it must know of the camera and the scene: turns pixels into rows of features.
#[derive(Debug, Clone, Copy)]
pub struct Extractor {
    set: FeatureSet,
    kind: Kind,
    storage: SumPrecision,
    frame: MomentFrame,
}

#[derive(Debug, Clone, Copy)]
enum Kind {
    Paper(CameraPlanes),
    DeepWeightedBlended(LinearRange),
    Recentred(LogWarp),
}

/// What moment depth −1 and 1 stand for while pass 1 adds moments up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MomentFrame {
    /// The extremes of the scene: one pass. A pixel much thinner than the scene loses moments to rounding.
    #[default]
    Scene,
    /// The pixel's own nearest and farthest fragment, which a prepass has found: whatever the pixel's range, rounding is that of the sums alone.
    Pixel,
}

/// Precision in which pass 1 adds moments up, and with it the noise that a network meets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum SumPrecision {
    /// RGBA32F targets: every sum is rounded to f32.
    #[default]
    F32,
    /// RGBA16F targets: every sum is rounded to f16.
    F16,
    /// RGBA16 targets: moments, normalised by an f32 b_0, go through the transform that fills their range and are rounded to 16 bits, once a pixel.
    Unorm16,
}

impl SumPrecision {
    /// What it does to moments.
    pub fn rounding(self) -> Rounding<f32> {
        match self {
            Self::F32 => Rounding::of_arithmetic(),
            // Ten bits after the point.
            Self::F16 => Rounding {
                unit: 1.0 / 1024.0,
                every_addition: true,
            },
            // Half a step through the transform's inverse, whose columns add up to 3.
            Self::Unorm16 => Rounding {
                unit: 1.5 / 65535.0,
                every_addition: false,
            },
        }
    }
}

/// Rows that [`Extractor::sample`] has made, and what it works in.
#[derive(Debug, Clone, Default)]
pub struct Sampled {
    /// `[N, W]`, row by row.
    pub features: Vec<f32>,
    /// Exact transmittances, `[N]`.
    pub targets: Vec<f32>,
    /// Opacities of the fragments, `[N]`.
    pub alpha: Vec<f32>,
    /// Rows of the last pixel.
    pub of_pixel: usize,
    /// Their view depths.
    before: Vec<f32>,
    /// View depths of the pixel's fragments; beyond the last, infinity.
    view_z: Vec<Lanes>,
    /// Opacities; beyond the last, 0.
    alpha_lanes: Vec<Lanes>,
    /// Depths of the feature set's kind.
    depth: Vec<Lanes>,
    absorbance: Vec<Lanes>,
    order: Vec<u32>,
}

impl Sampled {
    /// Room for so many rows more.
    pub fn reserve(&mut self, rows: usize, width: usize) {
        self.features.reserve(rows * width);
        self.targets.reserve(rows);
        self.alpha.reserve(rows);
    }

    /// Fills the lanes with a pixel: `to_depth` takes view depths to those that the feature set measures.
    fn transform_depths(&mut self, pixel: Pixel<'_>, to_depth: &impl ToDepth) {
        let n = pixel.len().div_ceil(LANES);
        for (lanes, values, rest) in [
            (&mut self.view_z, pixel.view_z, f32::INFINITY),
            (&mut self.alpha_lanes, pixel.alpha, 0.0),
        ] {
            lanes.clear();
            let (whole, last) = values.as_chunks();
            lanes.extend(whole.iter().map(|&chunk| Lanes(chunk)));
            if !last.is_empty() {
                let mut out = [rest; LANES];
                out[..last.len()].copy_from_slice(last);
                lanes.push(Lanes(out));
            }
        }
        self.depth.resize(n, Lanes::ZERO);
        self.absorbance.resize(n, Lanes::ZERO);
        let Self {
            view_z,
            alpha_lanes,
            depth,
            absorbance,
            ..
        } = self;
        dispatch!(Level::new(), simd => transform_lanes(simd, to_depth, view_z, alpha_lanes, depth, absorbance));
    }
}

impl Sampled {
    /// A fragment as both passes see it.
    fn terms(&self, i: usize) -> FragmentTerms<f32> {
        FragmentTerms {
            view_z: at(&self.view_z, i),
            z: at(&self.depth, i),
            absorbance: at(&self.absorbance, i),
        }
    }

    /// Makes rows of at most `most` of n fragments, chosen at random among those of which `row` makes one; it appends the features, or says that there are none.
    fn choose(&mut self, n: usize, most: usize, rng: &mut Stream, row: impl Fn(usize, &mut Self) -> bool) {
        self.order.clear();
        self.order.extend(0..n as u32);
        self.before.clear();
        for i in 0..n {
            if self.before.len() == most {
                break;
            }
            if most < n {
                self.order.swap(i, rng.random_range(i..n));
            }
            let chosen = self.order[i] as usize;
            if row(chosen, self) {
                self.before.push(at(&self.view_z, chosen));
                self.alpha.push(at(&self.alpha_lanes, chosen));
            }
        }
        self.of_pixel = self.before.len();
        let Self {
            view_z,
            absorbance,
            before,
            targets,
            ..
        } = self;
        dispatch!(Level::new(), simd => transmittances(simd, view_z, absorbance, before, targets));
    }
}

/// Number i of numbers that stand in lanes.
fn at(lanes: &[Lanes], i: usize) -> f32 {
    lanes[i / LANES].0[i % LANES]
}

/// From view depth to another, sixteen at once.
trait ToDepth {
    /// Depths of these view depths; of what is not finite, anything.
    fn lanes<S: Simd>(&self, simd: S, view_z: f32x16<S>) -> f32x16<S>;
}

/// Moment depth.
impl ToDepth for LogWarp {
    #[inline(always)]
    fn lanes<S: Simd>(&self, simd: S, view_z: f32x16<S>) -> f32x16<S> {
        self.moment_lanes(simd, view_z)
    }
}

/// Window depth.
impl ToDepth for CameraPlanes {
    #[inline(always)]
    fn lanes<S: Simd>(&self, simd: S, view_z: f32x16<S>) -> f32x16<S> {
        self.window_lanes(simd, view_z)
    }
}

#[inline(always)]
fn transform_lanes<S: Simd>(
    simd: S,
    to_depth: &impl ToDepth,
    view_z: &[Lanes],
    alpha: &[Lanes],
    depth: &mut [Lanes],
    absorbance: &mut [Lanes],
) {
    for (((v, a), z), out) in view_z.iter().zip(alpha).zip(depth).zip(absorbance) {
        z.store(to_depth.lanes(simd, v.load(simd)));
        out.store(absorbance_lanes(simd, a.load(simd)));
    }
}

/// Appends the transmittance of what lies in front of each of these view depths.
///
/// Absorbance is added up in sixteen partial sums, and those from the first to the last: in the same order at every SIMD level.
#[inline(always)]
fn transmittances<S: Simd>(simd: S, view_z: &[Lanes], absorbance: &[Lanes], before: &[f32], out: &mut Vec<f32>) {
    let zero = f32x16::splat(simd, 0.0);
    for before in before.chunks(LANES) {
        let mut partial = [Lanes::ZERO; LANES];
        for (partial, &before) in partial.iter_mut().zip(before) {
            let (mut sum, before) = (zero, f32x16::splat(simd, before));
            for (v, a) in view_z.iter().zip(absorbance) {
                sum += v.load(simd).simd_lt(before).select(a.load(simd), zero);
            }
            partial.store(sum);
        }
        let mut depth = Lanes::ZERO;
        for lane in 0..LANES {
            for (sum, partial) in depth.0.iter_mut().zip(&partial[..before.len()]) {
                *sum += partial.0[lane];
            }
        }
        depth.store(lanes::exp(simd, -depth.load(simd)));
        out.extend_from_slice(&depth.0[..before.len()]);
    }
}

/// [`PixelSums`] of n fragments and the depths of their ends: the same numbers to the bit as [`PixelSums::add`] gives, added up in the same order.
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
        let z = z.load(simd);
        let mut term = a.load(simd);
        let mut terms = [Lanes::ZERO; K];
        for terms in &mut terms {
            term *= z;
            terms.store(term);
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

/// What a feature set says of some fragments.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Extracted {
    /// Transmittance of every fragment where it is known without a network, NaN where the network is evaluated; `[F']`.
    pub known: Vec<f32>,
    /// Features of the fragments that the network is evaluated for, in the order of the fragments; `[Q, W]`, row by row.
    pub features: Vec<f32>,
}

impl Extractor {
    /// An extractor for pixels that a camera with these planes saw, of a scene whose view depths span this range.
    ///
    /// # Errors
    /// [`DepthError::NoPlanes`] where the set needs window depth and no planes are given; [`DepthError::NoRange`] where it needs depth relative to
    /// the scene and no range is given; [`DepthError::BadRange`] where that range is none.
    pub fn new(
        set: FeatureSet,
        planes: Option<CameraPlanes>,
        depth_range: Option<(f32, f32)>,
    ) -> Result<Self, DepthError> {
        let range = || {
            depth_range
                .ok_or(DepthError::NoRange)
                .map(|(v0, v1)| (ViewZ(v0.into()), ViewZ(v1.into())))
        };
        let kind = match set {
            FeatureSet::Paper => Kind::Paper(planes.ok_or(DepthError::NoPlanes)?),
            FeatureSet::DeepWeightedBlended => range()
                .and_then(|(v0, v1)| LinearRange::new(v0, v1))
                .map(Kind::DeepWeightedBlended)?,
            FeatureSet::Recentred | FeatureSet::Recentred6 | FeatureSet::Recentred8 => {
                range().and_then(|(v0, v1)| LogWarp::new(v0, v1)).map(Kind::Recentred)?
            }
        };
        Ok(Self {
            set,
            kind,
            storage: SumPrecision::F32,
            frame: MomentFrame::Scene,
        })
    }

    /// An extractor for the pixels of a list; planes and range that are not given are the list's own.
    ///
    /// # Errors
    /// As [`Self::new`], but a range is always known.
    pub fn for_list(
        set: FeatureSet,
        list: &FragmentList,
        planes: Option<CameraPlanes>,
        depth_range: Option<(f32, f32)>,
    ) -> Result<Self, DepthError> {
        // A list without fragments has no range, and nothing to apply one to.
        let depth_range = depth_range.or(list.depth_range()).unwrap_or((1.0, 1.0));
        Self::new(set, planes.or(list.planes()), Some(depth_range))
    }

    /// The same with moments in another precision; `paper`'s and `deep-weighted-blended`'s sums stay in f64, as they were published.
    pub fn with_storage(self, storage: SumPrecision) -> Self {
        Self { storage, ..self }
    }

    /// The same with moments in another frame; sets that take no moments of logarithmic depth have none but their own.
    pub fn with_frame(self, frame: MomentFrame) -> Self {
        Self { frame, ..self }
    }

    /// The feature set.
    pub fn set(&self) -> FeatureSet {
        self.set
    }

    /// Features of every fragment of a pixel, in the order of its fragments, and the transmittance where the set knows it.
    ///
    /// # Shapes
    /// `out: [n, W + 1]`, row by row: the features, then the known transmittance or NaN; features beside a known transmittance are 0.
    ///
    /// # Errors
    /// [`DepthError::OutsidePlanes`] where a fragment lies outside the camera's planes.
    ///
    /// # Panics
    /// If `out` has another length.
    pub fn pixel(&self, pixel: Pixel<'_>, out: &mut [f32]) -> Result<(), DepthError> {
        match self.kind {
            Kind::Recentred(warp) => {
                match self.set.moments() {
                    4 => self.recentred::<4>(pixel, warp, out),
                    6 => self.recentred::<6>(pixel, warp, out),
                    _ => self.recentred::<8>(pixel, warp, out),
                }
                Ok(())
            }
            Kind::Paper(planes) => unknown(self.set.width(), out, |rows| paper::extract(pixel, planes, rows)),
            Kind::DeepWeightedBlended(range) => unknown(self.set.width(), out, |rows| {
                deep_weighted_blended::extract(pixel, range, rows);
                Ok(())
            }),
        }
    }

    /// Pass 1 over a pixel: its fragments as both passes see them, the sums, and the moment depths of its ends.
    fn pass_1<const K: usize>(
        &self,
        pixel: Pixel<'_>,
        warp: LogWarp,
        terms: &mut Vec<FragmentTerms<f32>>,
    ) -> (PixelSums<f32, K>, [f32; 2]) {
        terms.clear();
        let warp = match self.frame {
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
            self.add(&mut sums, &mut ends, one);
            terms.push(one);
        }
        self.keep(&mut sums);
        (sums, ends)
    }

    fn recentred<const K: usize>(&self, pixel: Pixel<'_>, warp: LogWarp, out: &mut [f32]) {
        let width = self.set.width();
        assert_eq!(
            out.len(),
            pixel.len() * (width + 1),
            "one row of {} numbers a fragment",
            width + 1
        );
        let mut terms = Vec::with_capacity(pixel.len());
        let (sums, ends) = self.pass_1::<K>(pixel, warp, &mut terms);
        for (row, terms) in out.chunks_exact_mut(width + 1).zip(terms) {
            row[width] = match sums.classify_stored(terms, ends, self.storage.rounding()) {
                Pass2Input::Solved(t) => {
                    row[..width].fill(0.0);
                    t
                }
                Pass2Input::Query(first, measure) => {
                    row[..first.len()].copy_from_slice(&first);
                    row[first.len()..width].copy_from_slice(&measure);
                    f32::NAN
                }
            };
        }
    }

    /// Appends rows of at most `most` fragments of a pixel that the network is evaluated for, chosen at random: features, and the exact transmittance.
    ///
    /// The arithmetic is f32 throughout, multiplications and additions apart, so that rows are the same on every machine; they differ from those of
    /// [`Self::pixel`] by rounding (`sampled_rows_are_those_of_whole_pixels`).
    ///
    /// # Panics
    /// If the set is not trained on transmittances.
    pub fn sample(&self, pixel: Pixel<'_>, most: usize, rng: &mut Stream, rows: &mut Sampled) {
        assert_eq!(
            self.set.target(),
            Target::Transmittance,
            "rows are answered with transmittances"
        );
        match (self.kind, self.set.moments()) {
            (Kind::Recentred(warp), 4) => self.sample_of::<4>(pixel, warp, most, rng, rows),
            (Kind::Recentred(warp), 6) => self.sample_of::<6>(pixel, warp, most, rng, rows),
            (Kind::Recentred(warp), _) => self.sample_of::<8>(pixel, warp, most, rng, rows),
            (Kind::Paper(planes), _) => self.sample_paper(pixel, planes, most, rng, rows),
            (Kind::DeepWeightedBlended(_), _) => unreachable!("it is not trained on transmittances"),
        }
    }

    /// [`Self::sample`] of the paper's features, which ask the network about every fragment.
    fn sample_paper(&self, pixel: Pixel<'_>, planes: CameraPlanes, most: usize, rng: &mut Stream, rows: &mut Sampled) {
        let n = pixel.len();
        rows.transform_depths(pixel, &planes);
        let b = paper::describe_lanes(n, &mut rows.depth, &rows.absorbance);
        rows.choose(n, most, rng, |i, Sampled { depth, features, .. }| {
            features.extend_from_slice(&[at(depth, i), n as f32, b[0], b[1], b[2], b[3], b[4]]);
            true
        });
    }

    fn sample_of<const K: usize>(
        &self,
        pixel: Pixel<'_>,
        warp: LogWarp,
        most: usize,
        rng: &mut Stream,
        rows: &mut Sampled,
    ) {
        let n = pixel.len();
        let warp = match self.frame {
            MomentFrame::Pixel if n > 0 => own_warp(pixel.view_z),
            _ => warp,
        };
        rows.transform_depths(pixel, &warp);
        if self.frame == MomentFrame::Pixel {
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
        let (mut sums, ends) = if self.storage == SumPrecision::F16 {
            // Every sum is rounded.
            let (mut sums, mut ends) = (PixelSums::default(), [0.0; 2]);
            (0..n).for_each(|i| self.add(&mut sums, &mut ends, rows.terms(i)));
            (sums, ends)
        } else {
            dispatch!(Level::new(), simd => sums_lanes::<_, K>(simd, n, view_z, depth, absorbance))
        };
        self.keep(&mut sums);
        rows.choose(n, most, rng, |i, rows| {
            match sums.classify_stored(rows.terms(i), ends, self.storage.rounding()) {
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
    fn keep<const K: usize>(&self, sums: &mut PixelSums<f32, K>) {
        fn through<const M: usize>(b0: f32, b: &mut [f32]) {
            let b0 = f64::from(b0);
            let normalised = std::array::from_fn(|k| if k == 0 { 1.0 } else { f64::from(b[k - 1]) / b0 });
            for (b, kept) in b.iter_mut().zip(&through_unorm16::<M>(normalised)[1..]) {
                *b = (kept * b0) as f32;
            }
        }
        if self.storage == SumPrecision::Unorm16 && sums.b0 > 0.0 {
            match K {
                4 => through::<5>(sums.b0, &mut sums.b),
                6 => through::<7>(sums.b0, &mut sums.b),
                _ => through::<9>(sums.b0, &mut sums.b),
            }
        }
    }

    /// Pass 1: adds a fragment, in the precision of the storage.
    fn add<const K: usize>(&self, sums: &mut PixelSums<f32, K>, ends: &mut [f32; 2], terms: FragmentTerms<f32>) {
        sums.add(terms);
        if sums.nearest == terms.view_z {
            ends[0] = terms.z;
        }
        if sums.farthest == terms.view_z {
            ends[1] = terms.z;
        }
        if self.storage == SumPrecision::F16 {
            sums.b0 = round_f16(sums.b0.into()) as f32;
            sums.b = sums.b.map(|b| round_f16(b.into()) as f32);
        }
    }

    /// What the set says of every fragment of pixels `range` of a list, in the order of the list, on all cores.
    ///
    /// # Errors
    /// As [`Self::pixel`].
    pub fn list(&self, list: &FragmentList, range: std::ops::Range<usize>) -> Result<Extracted, DepthError> {
        let width = self.set().width();
        let fragments = (list.offsets()[range.end] - list.offsets()[range.start]) as usize;
        let mut rows = vec![0.0; fragments * (width + 1)];
        list.par_pixels(range, &mut rows, width + 1, |_, pixel, out| self.pixel(pixel, out))?;
        let known: Vec<f32> = rows.chunks_exact(width + 1).map(|row| row[width]).collect();
        // Rows of the asked close ranks in place.
        let mut kept = 0;
        for (i, known) in known.iter().enumerate() {
            if known.is_nan() {
                rows.copy_within(i * (width + 1)..i * (width + 1) + width, kept);
                kept += width;
            }
        }
        rows.truncate(kept);
        Ok(Extracted { known, features: rows })
    }
}

/// The log warp between the nearest and the farthest of a pixel's fragments.
fn own_warp(view_z: &[f32]) -> LogWarp {
    let (nearest, farthest) = view_z
        .iter()
        .fold((f32::INFINITY, 0.0f32), |(lo, hi), &v| (lo.min(v), hi.max(v)));
    LogWarp::new(ViewZ(nearest.into()), ViewZ(farthest.into())).expect("depths of a fragment are positive and finite")
}

/// Rows of a set that knows nothing without a network, spread out to make room for the column that says so.
fn unknown(
    width: usize,
    out: &mut [f32],
    extract: impl FnOnce(&mut [f32]) -> Result<(), DepthError>,
) -> Result<(), DepthError> {
    let rows = out.len() / (width + 1);
    extract(&mut out[..rows * width])?;
    for i in (0..rows).rev() {
        out.copy_within(i * width..(i + 1) * width, i * (width + 1));
        out[i * (width + 1) + width] = f32::NAN;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_files() {
        for set in FeatureSet::ALL {
            assert_eq!(serde_json::to_value(set).unwrap(), set.name());
            assert_eq!(set.width(), set.columns().len());
        }
    }

    #[test]
    fn what_is_missing_is_named() {
        let planes = CameraPlanes::new(0.5, 8.0).ok();
        assert_eq!(
            Extractor::new(FeatureSet::Paper, None, Some((1.0, 2.0))).unwrap_err(),
            DepthError::NoPlanes
        );
        assert_eq!(
            Extractor::new(FeatureSet::DeepWeightedBlended, planes, None).unwrap_err(),
            DepthError::NoRange
        );
        assert!(matches!(
            Extractor::new(FeatureSet::DeepWeightedBlended, None, Some((2.0, 1.0))),
            Err(DepthError::BadRange { .. })
        ));
        for set in FeatureSet::ALL {
            let none = FragmentList::new(vec![0, 0], vec![], vec![], None).unwrap();
            let extractor = Extractor::for_list(set, &none, planes, None).unwrap();
            assert_eq!(extractor.set(), set);
            assert_eq!(extractor.list(&none, 0..1).unwrap(), Extracted::default());
        }
    }

    /// The list's own range unless another is given.
    #[test]
    fn the_range_is_the_lists_unless_given() {
        let list = FragmentList::new(vec![0, 2, 3], vec![2.0, 3.0, 6.0], vec![0.5, 0.5, 1.0], None).unwrap();
        let depths = |range| {
            let extracted = Extractor::for_list(FeatureSet::DeepWeightedBlended, &list, None, range)
                .unwrap()
                .list(&list, 0..2)
                .unwrap();
            extracted.features.chunks_exact(3).map(|row| row[0]).collect::<Vec<_>>()
        };
        assert_eq!(depths(None), [0.0, 0.25, 1.0]);
        assert_eq!(depths(Some((1.0, 9.0))), [0.125, 0.25, 0.625]);
    }

    /// Sampled rows against those of [`Extractor::pixel`]: the same fragments, features to f32 rounding (for thin pixels what rounding of the moments makes of
    /// them), targets to 2e-6. Control: the row of the fragment before.
    #[test]
    fn sampled_rows_are_those_of_whole_pixels() {
        let planes = CameraPlanes::new(0.5, 20.0).unwrap();
        for set in [FeatureSet::Paper, FeatureSet::Recentred, FeatureSet::Recentred6] {
            let extractor = Extractor::new(set, Some(planes), Some((0.5, 20.0))).unwrap();
            let width = set.width();
            let mut rng = crate::numeric::rng::stream(1, 92, 0);
            let (mut compared, mut controls) = (0, 0);
            for round in 0..400 {
                let n = 1 + round % 40;
                let view_z: Vec<f32> = (0..n).map(|_| rng.random_range(1.0..15.0)).collect();
                let alpha: Vec<f32> = (0..n).map(|_| rng.random_range(0.01..0.9)).collect();
                let pixel = Pixel {
                    view_z: &view_z,
                    alpha: &alpha,
                    color: None,
                };
                let mut whole = vec![0.0; n * (width + 1)];
                extractor.pixel(pixel, &mut whole).unwrap();
                let mut exact = vec![0.0; n];
                abuffer::transmittance(pixel, &mut exact);
                let evaluated: Vec<usize> = (0..n).filter(|i| whole[i * (width + 1) + width].is_nan()).collect();
                let mut rows = Sampled::default();
                extractor.sample(pixel, usize::MAX, &mut rng, &mut rows);
                assert_eq!(
                    (rows.of_pixel, rows.targets.len(), rows.features.len()),
                    (evaluated.len(), evaluated.len(), evaluated.len() * width)
                );
                let off = |row: &[f32], i: usize| {
                    let expected = &whole[i * (width + 1)..][..width];
                    // The square root of a small spread makes much of rounding; its square does not.
                    let measured = |k: usize, x: f32| if set != FeatureSet::Paper && k >= 6 { x * x } else { x };
                    let bar = |k: usize| if set == FeatureSet::Paper || k < 5 { 2e-5 } else { 2e-2 };
                    row.iter().zip(expected).enumerate().any(|(k, (f, e))| {
                        let off = (measured(k, *f) - measured(k, *e)).abs();
                        off.is_nan() || off > bar(k) * (1.0 + e.abs())
                    })
                };
                for (k, (&i, row)) in evaluated.iter().zip(rows.features.chunks_exact(width)).enumerate() {
                    assert!(
                        !off(row, i) || width > 7,
                        "{set:?} n = {n}: {row:?} for {:?}",
                        &whole[i * (width + 1)..][..width]
                    );
                    assert!((f64::from(rows.targets[k]) - exact[i]).abs() <= 2e-6);
                    assert_eq!(rows.alpha[k], alpha[i]);
                    controls += usize::from(k > 0 && off(row, evaluated[k - 1]));
                    compared += 1;
                }
                // Some of them: as many as asked for, each one of the pixel's, none twice.
                let mut some = Sampled::default();
                extractor.sample(pixel, 3, &mut rng, &mut some);
                assert_eq!(some.of_pixel, evaluated.len().min(3));
                let mut seen: Vec<&[f32]> = some.features.chunks_exact(width).collect();
                assert!(
                    seen.iter()
                        .all(|row| rows.features.chunks_exact(width).any(|r| r == *row))
                );
                seen.dedup();
                assert_eq!(seen.len(), some.of_pixel);
            }
            assert!(compared > 5000 && controls > compared / 2);
        }
    }
}
