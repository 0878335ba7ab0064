//! Features of fragments, pixel by pixel: what [`FeatureSpec`](super::FeatureSpec) names, with what must be known of
//! the camera and the scene.

use super::core::CoreSet;
use super::core::code::Codes;
use super::deep_weighted_blended::LinearRange;
use super::recentred::{FragmentTerms, Rounding};
use super::{FeatureSet, MomentDepthKind};
use crate::numeric::lanes::{self, LANES, Lanes};
use crate::numeric::rng::Stream;
use crate::pixel::{CameraPlanes, DepthError, FragmentList, LogWarp, Pixel, ViewZ, absorbance_lanes};
use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, f32x16};
use rand::RngExt;
use serde::{Deserialize, Serialize};

/// A feature set together with what it must know of the camera and the scene: turns pixels into rows of features.
#[derive(Debug, Clone, Copy)]
pub struct Extractor {
    set: FeatureSet,
    pub(super) scale: DepthScale,
    /// View depths of the scene, where they are known.
    depth_range: Option<(f32, f32)>,
    pub(super) precision: SumPrecision,
    pub(super) frame: MomentFrame,
}

/// What a feature set measures depth by, one for each [`MomentDepthKind`].
#[derive(Debug, Clone, Copy)]
pub(super) enum DepthScale {
    Window(CameraPlanes),
    Linear(LinearRange),
    Log(LogWarp),
}

impl DepthScale {
    /// # Panics
    /// If it is another one.
    pub(super) fn log_warp(self) -> LogWarp {
        match self {
            Self::Log(warp) => warp,
            _ => panic!("the set measures no logarithmic depth"),
        }
    }

    /// # Panics
    /// If it is another one.
    pub(super) fn planes(self) -> CameraPlanes {
        match self {
            Self::Window(planes) => planes,
            _ => panic!("the set measures no window depth"),
        }
    }

    /// # Panics
    /// If it is another one.
    pub(super) fn linear_range(self) -> LinearRange {
        match self {
            Self::Linear(range) => range,
            _ => panic!("the set measures no linear depth"),
        }
    }
}

/// What moment depth −1 and 1 stand for while pass 1 adds moments up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MomentFrame {
    /// The extremes of the scene: one pass. A pixel much thinner than the scene loses moments to rounding.
    #[default]
    Scene,
    /// The pixel's own nearest and farthest fragment, which a prepass has found: whatever the pixel's range, rounding
    /// is that of the sums alone.
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
    /// RGBA16 targets: moments, normalised by an f32 b_0, go through the transform that fills their range and are
    /// rounded to 16 bits, once a pixel.
    Unorm16,
}

impl SumPrecision {
    /// What it does to moments.
    pub fn rounding(self) -> Rounding<f32> {
        match self {
            Self::F32 => Rounding::of_arithmetic(1.0),
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
    /// Rows of the last pixel.
    pub of_pixel: usize,
    /// Their view depths.
    before: Vec<f32>,
    /// View depths of the pixel's fragments; beyond the last, infinity.
    pub(super) view_z: Vec<Lanes>,
    /// Opacities; beyond the last, 0.
    alpha_lanes: Vec<Lanes>,
    /// Depths of the feature set's kind.
    pub(super) depth: Vec<Lanes>,
    pub(super) absorbance: Vec<Lanes>,
    order: Vec<u32>,
}

impl Sampled {
    /// Room for so many rows more.
    pub fn reserve(&mut self, rows: usize, width: usize) {
        self.features.reserve(rows * width);
        self.targets.reserve(rows);
    }

    /// Fills the lanes with a pixel: `to_depth` takes view depths to those that the feature set measures.
    pub(super) fn transform_depths(&mut self, pixel: Pixel<'_>, to_depth: &impl ToDepth) {
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
    pub(super) fn terms(&self, i: usize) -> FragmentTerms<f32> {
        FragmentTerms {
            view_z: at(&self.view_z, i),
            z: at(&self.depth, i),
            absorbance: at(&self.absorbance, i),
        }
    }

    /// Makes rows of at most `most` of n fragments, chosen at random among those of which `row` makes one; it appends
    /// the features, or says that there are none.
    pub(super) fn choose(&mut self, n: usize, most: usize, rng: &mut Stream, row: impl Fn(usize, &mut Self) -> bool) {
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
pub(super) fn at(lanes: &[Lanes], i: usize) -> f32 {
    lanes[i / LANES].0[i % LANES]
}

/// From view depth to another, sixteen at once.
pub(super) trait ToDepth {
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
/// Absorbance is added up in sixteen partial sums, and those from the first to the last: in the same order at every
/// SIMD level.
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

/// What a feature set knows of a fragment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Known {
    /// Its transmittance: no network is needed.
    Transmittance(f32),
    /// What a network's answer is multiplied by: the transmittance of the core in front, 1 where there is no core.
    Front(f32),
}

impl Known {
    /// What it says of T: all of it, or a factor.
    pub fn factor(&self) -> f32 {
        let (Self::Transmittance(t) | Self::Front(t)) = self;
        *t
    }
}

/// What a feature set says of some fragments.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Extracted {
    /// What is known of every fragment; `[F']`.
    pub known: Vec<Known>,
    /// Features of the fragments that the network is evaluated for, in the order of the fragments; `[Q, W]`, row by
    /// row.
    pub features: Vec<f32>,
}

impl Extractor {
    /// An extractor for pixels that a camera with these planes saw, of a scene whose view depths span this range.
    ///
    /// # Errors
    /// [`DepthError::NoPlanes`] where the set needs window depth and no planes are given; [`DepthError::NoRange`] where
    /// it needs depth relative to the scene and no range is given; [`DepthError::BadRange`] where that range is none.
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
        let scale = match set.moment_depth() {
            MomentDepthKind::Window => DepthScale::Window(planes.ok_or(DepthError::NoPlanes)?),
            MomentDepthKind::None => range()
                .and_then(|(v0, v1)| LinearRange::new(v0, v1))
                .map(DepthScale::Linear)?,
            MomentDepthKind::Log => range().and_then(|(v0, v1)| LogWarp::new(v0, v1)).map(DepthScale::Log)?,
        };
        Ok(Self {
            set,
            scale,
            depth_range,
            precision: SumPrecision::F32,
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

    /// The same with moments in another precision; `paper`'s and `deep-weighted-blended`'s sums stay in f64, as they
    /// were published.
    pub fn with_precision(self, precision: SumPrecision) -> Self {
        Self { precision, ..self }
    }

    /// The same with moments in another frame; sets that take no moments of logarithmic depth have none but their own.
    pub fn with_frame(self, frame: MomentFrame) -> Self {
        Self { frame, ..self }
    }

    /// Codes of single fragments, for sets that keep a core.
    ///
    /// # Panics
    /// If the set keeps none.
    pub fn codes(&self) -> (CoreSet, Codes) {
        let set = self.set.spec().core.expect("the set keeps a core");
        let (v0, v1) = self.depth_range.expect("logarithmic depth has a range");
        (set, set.layout.codes(v0, v1))
    }

    /// Precision of the moments.
    pub fn precision(&self) -> SumPrecision {
        self.precision
    }

    /// Frame of the moments.
    pub fn frame(&self) -> MomentFrame {
        self.frame
    }

    /// What logarithmic depth is measured by.
    ///
    /// # Panics
    /// If the set measures depth otherwise.
    pub fn log_warp(&self) -> LogWarp {
        self.scale.log_warp()
    }

    /// The feature set.
    pub fn set(&self) -> FeatureSet {
        self.set
    }

    /// Features of every fragment of a pixel, in the order of its fragments, and what is known of it.
    ///
    /// # Shapes
    /// `features: [n, W]`, row by row, 0 beside a known transmittance; `known: [n]`.
    ///
    /// # Errors
    /// [`DepthError::OutsidePlanes`] where a fragment lies outside the camera's planes.
    ///
    /// # Panics
    /// If a slice has another length.
    pub fn pixel(&self, pixel: Pixel<'_>, features: &mut [f32], known: &mut [Known]) -> Result<(), DepthError> {
        assert_eq!(features.len(), pixel.len() * self.set.width(), "W features a fragment");
        assert_eq!(known.len(), pixel.len(), "one entry a fragment");
        known.fill(Known::Front(1.0));
        (self.set.spec().pixel)(self, pixel, features, known)
    }

    /// Appends rows of at most `most` fragments of a pixel that the network is evaluated for, chosen at random:
    /// features, and the exact transmittance.
    ///
    /// The arithmetic is f32 throughout, multiplications and additions apart, so that rows are the same on every
    /// machine; they differ from those of [`Self::pixel`] by rounding (`sampled_rows_are_those_of_whole_pixels`).
    ///
    /// # Panics
    /// If the set is not trained on transmittances.
    pub fn sample(&self, pixel: Pixel<'_>, most: usize, rng: &mut Stream, rows: &mut Sampled) {
        let sample = self.set.spec().sample;
        sample.expect("rows are answered with transmittances")(self, pixel, most, rng, rows);
    }

    /// What the set says of every fragment of pixels `range` of a list, in the order of the list, on all cores.
    ///
    /// # Errors
    /// As [`Self::pixel`].
    pub fn list(&self, list: &FragmentList, range: std::ops::Range<usize>) -> Result<Extracted, DepthError> {
        let width = self.set().width();
        let fragments = (list.offsets()[range.end] - list.offsets()[range.start]) as usize;
        let (mut features, mut known) = (vec![0.0; fragments * width], vec![Known::Front(1.0); fragments]);
        list.par_pixels_of_two(
            range,
            (&mut features, width),
            (&mut known, 1),
            |_, pixel, features, known| self.pixel(pixel, features, known),
        )?;
        // Rows that the network answers close ranks in place.
        let mut kept = 0;
        for (i, known) in known.iter().enumerate() {
            if matches!(known, Known::Front(_)) {
                features.copy_within(i * width..(i + 1) * width, kept);
                kept += width;
            }
        }
        features.truncate(kept);
        Ok(Extracted { known, features })
    }
}
