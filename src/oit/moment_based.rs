//! What the moment-based methods share: a pixel's moments in pass 1, a curve of transmittance over depth in pass 2, and
//! the exact rules of `+own`.

use super::capabilities::Capabilities;
use super::shader::{Composite, MethodShader, Offers, Pass1, WEIGHT};
use super::{Accumulated, Context, Method, MethodError, composite_with_total};
use crate::features::MomentDepthKind;
use crate::moments::hamburger::OVERESTIMATION;
use crate::pixel::{DepthError, FragmentList, LogWarp, MomentDepth, OfFilled, Pixel, ViewZ, absorbance};
use std::sync::OnceLock;

/// Share of the total absorbance below which nothing but the fragment itself is thought to be there.
pub(super) const NOTHING_ELSE: f64 = 1e-6;

/// A fragment as a moment-based method sees it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sample {
    /// Its depth.
    pub z: MomentDepth,
    /// Its absorbance.
    pub absorbance: f64,
}

/// A method that keeps numbers of each pixel and turns them into transmittance over depth.
pub(super) trait MomentBased: Send + Sync {
    /// What is kept of a pixel.
    type Moments: Copy + Send + Sync;
    /// Ready to be asked.
    type Curve: Send + Sync;

    fn name(&self) -> String;
    /// What it keeps and needs; `own` where both ends of the pixel are kept too.
    fn capabilities(&self, own: bool) -> Capabilities;
    /// Whether a stored sum is rounded with every fragment, so that it depends on their order by as much.
    fn rounds_sums(&self) -> bool {
        false
    }
    fn accumulate(&self, samples: &[Sample]) -> Self::Moments;
    /// Total absorbance as kept.
    fn total(&self, moments: &Self::Moments) -> f64;
    /// The same moments without one of the fragments.
    fn without(&self, moments: &Self::Moments, own: Sample) -> Self::Moments;
    fn curve(&self, moments: &Self::Moments) -> Self::Curve;
    fn transmittance(&self, curve: &Self::Curve, z: MomentDepth) -> f64;
    /// Its shader, where moments are what the GPU keeps.
    fn shader(&self) -> Option<MomentShader> {
        None
    }
    /// From the curve of the other fragments.
    fn transmittance_of_others(&self, curve: &Self::Curve, z: MomentDepth) -> f64 {
        self.transmittance(curve, z)
    }
}

/// What tells the shaders of moment-based methods apart.
pub(super) struct MomentShader {
    /// Numbers that are kept of a pixel.
    pub sums: usize,
    /// WGSL of the curve.
    pub curve_source: &'static str,
    /// The function that evaluates it.
    pub curve: String,
    /// WGSL of pass 1.
    pub accumulate: String,
}

impl MomentShader {
    /// The whole method; `own` takes the fragment's own absorbance out. (There the CPU's tries all moments before it
    /// gives up, which 16-bit storage needs; in f32 it would double the work of devices that run both sides of a
    /// branch, for what `gpu::twins::hard_pixels` meets in one answer of thousands.)
    fn method(self, name: String, own: bool) -> MethodShader {
        let weight = if own {
            let others: Vec<String> = (0..self.sums).map(|i| format!("p.sums[{i}] - own[{i}]")).collect();
            include_str!("moment_weight_own.wgsl")
                .replace("OIT_OTHERS", &others.join(", "))
                .replace("OIT_OVERESTIMATION", &format!("{OTHERS_OVERESTIMATION:?}"))
        } else {
            include_str!("moment_weight.wgsl").replace("OIT_OVERESTIMATION", &format!("{OVERESTIMATION:?}"))
        };
        let roots = include_str!("../numeric/roots.wgsl");
        MethodShader {
            name,
            sums: self.sums,
            range: own,
            depth: MomentDepthKind::Log,
            composite: Composite::Normalised,
            pass1: Pass1::Added,
            core: None,
            offers: Offers::default(),
            weight: WEIGHT,
            open: 0.0,
            source: format!(
                "{roots}\n{}{}{}",
                self.curve_source,
                self.accumulate,
                weight.replace("OIT_CURVE", &self.curve)
            ),
        }
    }
}

/// Overestimation where the fragment's own absorbance is gone: the middle of the bounds, for nothing is known to lie at
/// the depth itself.
///
/// On the paper's distribution (moments of 2w − 1) four moments then have a T-MSE of 4.4e-3, against 9.1e-3 with 0.25.
pub(super) const OTHERS_OVERESTIMATION: f64 = 0.5;

/// A moment-based method on every pixel by itself, with or without the fragment's own absorbance.
pub(super) struct PerPixel<F> {
    pub(super) family: F,
    pub(super) own: bool,
}

/// The log warp between the given depths or those of the list.
pub(super) fn warp(name: &dyn Fn() -> String, list: &FragmentList, context: &Context) -> Result<LogWarp, MethodError> {
    // A list without fragments asks for no depth.
    let (v0, v1) = context.depth_range.or(list.depth_range()).unwrap_or((1.0, 1.0));
    LogWarp::new(ViewZ(v0.into()), ViewZ(v1.into()))
        .map_err(|source: DepthError| MethodError::Depth { method: name(), source })
}

/// Samples of a pixel.
pub(super) fn samples(warp: &LogWarp, pixel: Pixel<'_>) -> Vec<Sample> {
    let sample = |(&v, &alpha): (&f32, &f32)| Sample {
        z: warp.moment(ViewZ(v.into())),
        absorbance: absorbance(alpha),
    };
    pixel.view_z.iter().zip(pixel.alpha).map(sample).collect()
}

/// Brings samples into an order that does not depend on that of the input, so that f64 sums of them are the same to the
/// bit.
pub(super) fn sort(samples: &mut [Sample]) {
    samples.sort_unstable_by(|a, b| a.z.0.total_cmp(&b.z.0).then(a.absorbance.total_cmp(&b.absorbance)));
}

/// The exact answer about a fragment where there is one: nearest, alone, farthest, in this order, decided on view depth
/// bit for bit.
///
/// # Domain
/// `ends`: least and greatest view depth of the pixel; `total`: its absorbance.
pub(super) fn exact(view_z: f32, ends: (f32, f32), absorbance: f64, total: f64) -> Option<f64> {
    let others = (total - absorbance).max(0.0);
    if view_z == ends.0 || others <= NOTHING_ELSE * total {
        Some(1.0)
    } else if view_z == ends.1 {
        Some(libm::exp(-others))
    } else {
        None
    }
}

/// Least and greatest view depth of a pixel.
pub(super) fn ends(pixel: Pixel<'_>) -> (f32, f32) {
    pixel
        .view_z
        .iter()
        .fold((f32::INFINITY, 0.0), |(lo, hi), &v| (lo.min(v), hi.max(v)))
}

impl<F: MomentBased> Method for PerPixel<F> {
    fn name(&self) -> String {
        format!("{}{}", self.family.name(), if self.own { "+own" } else { "" })
    }

    fn capabilities(&self) -> Capabilities {
        self.family.capabilities(self.own)
    }

    fn shader(&self) -> Option<MethodShader> {
        Some(self.family.shader()?.method(self.name(), self.own))
    }

    fn accumulate<'a>(
        &'a self,
        list: &'a FragmentList,
        context: Context,
    ) -> Result<Box<dyn Accumulated + 'a>, MethodError> {
        let warp = warp(&|| self.name(), list, &context)?;
        let moments = OfFilled::of(list, |p| {
            let mut samples = samples(&warp, list.pixel(p));
            if !self.family.rounds_sums() {
                sort(&mut samples);
            }
            self.family.accumulate(&samples)
        });
        Ok(Box::new(Pixels {
            method: self,
            list,
            warp,
            moments,
        }))
    }
}

/// Fragments of a pixel from which on threads share them; fewer are not worth handing over.
const SHARED: usize = 4096;

/// Fills in the answer to each fragment, of a very deep pixel on all threads.
fn each(out: &mut [f64], answer: impl Fn(usize) -> f64 + Sync) {
    use rayon::prelude::*;
    if out.len() < SHARED {
        out.iter_mut().enumerate().for_each(|(i, out)| *out = answer(i));
    } else {
        let out = out.par_iter_mut().with_min_len(SHARED / 4);
        out.enumerate().for_each(|(i, out)| *out = answer(i));
    }
}

struct Pixels<'a, F: MomentBased> {
    method: &'a PerPixel<F>,
    list: &'a FragmentList,
    warp: LogWarp,
    moments: OfFilled<F::Moments>,
}

impl<F: MomentBased> Accumulated for Pixels<'_, F> {
    fn weights(&self, p: usize, out: &mut [f64]) {
        let (pixel, family) = (self.list.pixel(p), &self.method.family);
        let Some(moments) = self.moments.get(p) else { return };
        let total = family.total(moments);
        if total == 0.0 {
            // Nothing absorbs anything.
            out.fill(1.0);
            return;
        }
        let place = |v: f32| self.warp.moment(ViewZ(v.into()));
        if !self.method.own {
            let curve = family.curve(moments);
            each(out, |i| family.transmittance(&curve, place(pixel.view_z[i])));
            return;
        }
        let ends = ends(pixel);
        let with_own = OnceLock::new();
        each(out, |i| {
            let (v, own) = (pixel.view_z[i], absorbance(pixel.alpha[i]));
            exact(v, ends, own, total).unwrap_or_else(|| {
                let sample = Sample {
                    z: place(v),
                    absorbance: own,
                };
                // Whatever rounding makes of it, between none and all of the others lie in front.
                let least = libm::exp(-(total - own).max(0.0));
                let others = family.transmittance_of_others(&family.curve(&family.without(moments, sample)), sample.z);
                if others.is_finite() {
                    return others.clamp(least, 1.0);
                }
                // What rounded storage leaves without the fragment need not be moments of any measure; with it they may
                // be; failing that, all that is known of the others' absorbance in front is that it lies between none
                // and all.
                let with_own = family.transmittance(with_own.get_or_init(|| family.curve(moments)), sample.z);
                if with_own.is_finite() {
                    with_own.clamp(least, 1.0)
                } else {
                    libm::exp(-OTHERS_OVERESTIMATION * (total - own).max(0.0))
                }
            })
        });
    }

    fn composite(&self, pixel: Pixel<'_>, p: usize, weights: &[f64], background: [f64; 3]) -> [f64; 3] {
        let total = self
            .moments
            .get(p)
            .map_or(0.0, |moments| self.method.family.total(moments));
        composite_with_total(pixel, weights, total, background)
    }
}
