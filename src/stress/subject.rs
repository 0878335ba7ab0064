//! What is put under stress: methods as they are, networks in every arithmetic and storage, and whatever else answers
//! fragments.

use super::arithmetic::{Flushed, Fused, Rough, Worst};
use super::cases::Fragments;
use crate::features::recentred::{self, FragmentTerms, Pass2Input, PixelSums, Rounding};
use crate::features::{Extractor, FeatureSet, MomentFrame, SumPrecision};
use crate::model::{Dense, Mlp, ShapeError};
use crate::numeric::Scalar;
use crate::numeric::quantise::round_f16;
use crate::oit::neural::Neural;
use crate::oit::{self, Method};
use crate::pixel::{LogWarp, Pixel, ViewZ, absorbance};
use rayon::prelude::*;
use serde::Serialize;
use std::collections::HashMap;

/// What is promised of a method's answers, whatever it is fed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Promise {
    /// Nothing: it is as published, and its failures are its own.
    None,
    /// Every answer is finite and in [0, 1].
    Range,
    /// That, and exactly 1 for the nearest fragment of a pixel, so for a single one.
    Ends,
}

/// An answer to every fragment, or why there is none.
pub type Answers = Result<Vec<f64>, String>;

type Run<'a> = Box<dyn Fn(&Fragments) -> Answers + Send + Sync + 'a>;

/// Something that answers fragments, under its name.
pub struct Subject<'a> {
    /// Its name: that of the method, and after an `@` how it is run.
    pub name: String,
    /// What it is held to.
    pub promise: Promise,
    /// Whether its answers are transmittances, so that errors can be stated.
    pub transmittance: bool,
    run: Run<'a>,
    double: Option<(String, Run<'a>)>,
}

impl<'a> Subject<'a> {
    /// Anything that answers fragments: `run` gets them unvalidated, and says why where it refuses them.
    pub fn new(
        name: impl Into<String>,
        promise: Promise,
        run: impl Fn(&Fragments) -> Answers + Send + Sync + 'a,
    ) -> Self {
        Self {
            name: name.into(),
            promise,
            transmittance: true,
            run: Box::new(run),
            double: None,
        }
    }

    /// The same with what the method would answer in double precision, so that rounding can be told from approximation.
    /// Subjects whose double has the same name share its answers.
    pub fn with_double(
        self,
        name: impl Into<String>,
        double: impl Fn(&Fragments) -> Answers + Send + Sync + 'a,
    ) -> Self {
        Self {
            double: Some((name.into(), Box::new(double))),
            ..self
        }
    }

    /// The same with another method as the one without rounding.
    pub fn with_method_as_double(self, double: Box<dyn Method>) -> Self {
        self.with_double(double.name(), move |f| run_method(&*double, f))
    }

    /// The same with a network in double precision as the method without rounding.
    pub fn with_network_as_double(self, mlp: &Mlp) -> Self {
        let mlp = mlp.clone();
        self.with_double(format!("neural:{}", mlp.name()), move |f| double_precision(&mlp, f))
    }

    /// A method, and where there is one the same method without rounding.
    pub fn method(method: Box<dyn Method>, double: Option<Box<dyn Method>>) -> Self {
        let name = method.name();
        let promise = if name.ends_with("+own") || name == oit::abuffer::NAME {
            Promise::Ends
        } else {
            Promise::None
        };
        let transmittance = method.weights_are_transmittance();
        let subject = Self {
            transmittance,
            ..Self::new(name, promise, move |f| run_method(&*method, f))
        };
        match double {
            Some(double) => subject.with_method_as_double(double),
            None => subject,
        }
    }

    /// A network, run in one of the ways there are.
    ///
    /// # Errors
    /// [`ShapeError`] where the weights of a format that is too small for them become infinite.
    pub fn network(mlp: &Mlp, execution: Execution) -> Result<Self, ShapeError> {
        let quantised = execution.weights.of(mlp)?;
        let name = format!("neural:{}{}", mlp.name(), execution.suffix());
        let set = mlp.feature_set();
        let promise = if is_recentred(set) {
            Promise::Ends
        } else {
            Promise::Range
        };
        let subject = Self::new(name, promise, move |f| execution.run(&quantised, f));
        Ok(Self {
            transmittance: set != FeatureSet::DeepWeightedBlended,
            ..subject
        }
        .with_network_as_double(mlp))
    }

    /// Its answers.
    ///
    /// # Errors
    /// In words, why it does not take these fragments.
    pub fn answers(&self, fragments: &Fragments) -> Answers {
        checked((self.run)(fragments), fragments)
    }

    /// Its answers without rounding, where it has such and takes the fragments; `doubles` holds those of the same
    /// fragments that are known already.
    pub fn double<'d>(&self, fragments: &Fragments, doubles: &'d mut Doubles) -> Option<&'d [f64]> {
        let (name, double) = self.double.as_ref()?;
        let answers = doubles
            .0
            .entry(name.clone())
            .or_insert_with(|| checked(double(fragments), fragments));
        answers.as_deref().ok()
    }
}

/// Answers without rounding to one set of fragments, by the name of what gave them.
#[derive(Debug, Default)]
pub struct Doubles(HashMap<String, Answers>);

fn checked(answers: Answers, fragments: &Fragments) -> Answers {
    match answers {
        Ok(a) if a.len() != fragments.len() => Err(format!("{} answers to {} fragments", a.len(), fragments.len())),
        other => other,
    }
}

fn is_recentred(set: FeatureSet) -> bool {
    set.spec().sums.has_precisions
}

fn run_method(method: &dyn Method, fragments: &Fragments) -> Answers {
    let list = fragments.list().map_err(|e| e.to_string())?;
    let accumulated = method.accumulate(&list, fragments.context).map_err(|e| e.to_string())?;
    Ok(oit::weights(&list, &*accumulated))
}

/// Arithmetic that a network's whole method is computed in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Arithmetic {
    /// As `nmt predict` does: in f32, sixteen fragments at once where moments are kept in f32.
    #[default]
    Usual,
    /// Every operation as the shaders write it, rounded to f32.
    Shader,
    /// That with fused multiply-adds.
    Fused,
    /// That with quotients, roots, exponentials and logarithms as inexact as WGSL allows.
    Rough,
    /// That with subnormal numbers flushed to 0.
    Flushed,
    /// All three.
    Worst,
}

impl Arithmetic {
    /// Its name; empty for the usual one.
    pub fn name(self) -> &'static str {
        match self {
            Self::Usual => "",
            Self::Shader => "shader",
            Self::Fused => "fused",
            Self::Rough => "rough",
            Self::Flushed => "flushed",
            Self::Worst => "worst",
        }
    }
}

/// Format that a network's weights are rounded to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Weights {
    /// As they are.
    #[default]
    F32,
    /// Half precision.
    F16,
    /// The upper half of single precision: 8 bits of mantissa.
    Bf16,
    /// Whole numbers from −127 to 127 times a scale a unit; biases stay as they are.
    Int8,
}

impl Weights {
    /// What stands behind a network's name: nothing where weights are as they are.
    pub fn suffix(self) -> &'static str {
        match self {
            Self::F32 => "",
            Self::F16 => " @ f16 weights",
            Self::Bf16 => " @ bf16 weights",
            Self::Int8 => " @ int8 weights",
        }
    }

    /// The network with rounded weights.
    ///
    /// # Errors
    /// [`ShapeError::NotFinite`].
    pub fn of(self, mlp: &Mlp) -> Result<Mlp, ShapeError> {
        let round = |x: &f32| match self {
            Self::F32 | Self::Int8 => *x,
            Self::F16 => round_f16(f64::from(*x)) as f32,
            Self::Bf16 => round_bf16(*x),
        };
        let layer = |dense: &Dense| {
            let mut weights: Vec<f32> = dense.weights.iter().map(round).collect();
            if self == Self::Int8 {
                for unit in 0..dense.outputs() {
                    let greatest = (0..dense.inputs())
                        .map(|i| dense.weight(i, unit).abs())
                        .fold(0.0, f32::max);
                    let scale = if greatest > 0.0 { greatest / 127.0 } else { 1.0 };
                    for w in weights.iter_mut().skip(unit).step_by(dense.outputs()) {
                        *w = (*w / scale).round() * scale;
                    }
                }
            }
            Dense::new(
                dense.inputs(),
                dense.outputs(),
                weights,
                dense.biases.iter().map(round).collect(),
            )
        };
        let layers = mlp.layers().iter().map(layer).collect::<Result<_, _>>()?;
        Mlp::new(mlp.name(), mlp.feature_set(), layers, mlp.provenance.clone())
    }
}

/// Nearest number with 8 bits of mantissa, ties to even.
fn round_bf16(x: f32) -> f32 {
    let bits = x.to_bits();
    f32::from_bits((bits + 0x7fff + ((bits >> 16) & 1)) & 0xffff_0000)
}

/// How a network is run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Execution {
    /// What computes.
    pub arithmetic: Arithmetic,
    /// What keeps the moments; 16-bit formats go with the usual arithmetic.
    pub storage: SumPrecision,
    /// What moments are taken about.
    pub frame: MomentFrame,
    /// What keeps the weights.
    pub weights: Weights,
}

impl Execution {
    /// The ways to run a network on these features that differ from the usual one in one thing, and all at once.
    pub fn all(set: FeatureSet) -> Vec<Self> {
        let usual = Self::default();
        let weights = [Weights::F16, Weights::Bf16, Weights::Int8].map(|weights| Self { weights, ..usual });
        if !is_recentred(set) {
            return [vec![usual], weights.to_vec()].concat();
        }
        let arithmetic = [
            Arithmetic::Shader,
            Arithmetic::Fused,
            Arithmetic::Rough,
            Arithmetic::Flushed,
            Arithmetic::Worst,
        ];
        let pixel = Self {
            frame: MomentFrame::Pixel,
            ..usual
        };
        let mut all = vec![usual, pixel];
        all.extend(arithmetic.map(|arithmetic| Self { arithmetic, ..usual }));
        all.push(Self {
            arithmetic: Arithmetic::Worst,
            ..pixel
        });
        for storage in [SumPrecision::F16, SumPrecision::Unorm16] {
            all.extend([Self { storage, ..usual }, Self { storage, ..pixel }]);
        }
        all.extend(weights);
        all
    }

    /// What stands behind the network's name: nothing for the usual way.
    fn suffix(&self) -> String {
        let mut parts = Vec::new();
        if self.frame == MomentFrame::Pixel {
            parts.push("prepass");
        }
        parts.extend(Some(self.arithmetic.name()).filter(|name| !name.is_empty()));
        parts.extend(match self.storage {
            SumPrecision::F32 => None,
            SumPrecision::F16 => Some("f16"),
            SumPrecision::Unorm16 => Some("unorm16"),
        });
        parts.extend(Some(self.weights.suffix().trim_start_matches(" @ ")).filter(|name| !name.is_empty()));
        if parts.is_empty() {
            String::new()
        } else {
            format!(" @ {}", parts.join(", "))
        }
    }

    fn run(&self, mlp: &Mlp, fragments: &Fragments) -> Answers {
        match self.arithmetic {
            Arithmetic::Usual => {
                let list = fragments.list().map_err(|e| e.to_string())?;
                let method = Neural::new(mlp.clone())
                    .with_precision(self.storage)
                    .with_frame(self.frame);
                let answers = method
                    .transmittance(&list, fragments.context, &|_| {})
                    .map_err(|e| e.to_string())?;
                Ok(answers.into_iter().map(f64::from).collect())
            }
            Arithmetic::Shader => as_shader::<f32>(mlp, fragments, self.frame),
            Arithmetic::Fused => as_shader::<Fused>(mlp, fragments, self.frame),
            Arithmetic::Rough => as_shader::<Rough>(mlp, fragments, self.frame),
            Arithmetic::Flushed => as_shader::<Flushed>(mlp, fragments, self.frame),
            Arithmetic::Worst => as_shader::<Worst>(mlp, fragments, self.frame),
        }
    }
}

/// Rounds to a number of significant binary digits, halves away from 0.
pub(super) fn to_digits(x: f64, digits: u32) -> f64 {
    let dropped = 53 - digits;
    if dropped == 0 || !x.is_finite() {
        return x;
    }
    f64::from_bits((x.to_bits() + (1 << (dropped - 1))) & !((1 << dropped) - 1))
}

/// A network whose moments are kept with so many significant binary digits, rounded after every addition; everything
/// else is in double precision.
///
/// # Panics
/// Unless there are 2 to 53 digits.
pub fn with_digits(mlp: &Mlp, digits: u32, frame: MomentFrame) -> Subject<'static> {
    assert!((2..=53).contains(&digits), "{digits} digits");
    let name = format!(
        "neural:{}{}",
        mlp.name(),
        if frame == MomentFrame::Pixel { " @ prepass" } else { "" }
    );
    let rounding = Rounding {
        unit: libm::exp2(1.0 - f64::from(digits)),
        every_addition: true,
    };
    let network = mlp.clone();
    Subject::new(name, Promise::Ends, move |f| {
        let (v0, v1) = f.context.depth_range.unwrap_or((1.0, 1.0));
        on_pixels(&network, f, |pixel, out| {
            let range = if frame == MomentFrame::Pixel {
                ends(pixel)
            } else {
                (v0, v1)
            };
            let depth = LogWarp::new(ViewZ(range.0.into()), ViewZ(range.1.into()));
            let z = |v: f32| depth.as_ref().map_or(f64::NAN, |warp| warp.moment(ViewZ(v.into())).0);
            match network.feature_set().moments() {
                4 => answer_digits::<4>(&network, pixel, z, digits, rounding, out),
                6 => answer_digits::<6>(&network, pixel, z, digits, rounding, out),
                _ => answer_digits::<8>(&network, pixel, z, digits, rounding, out),
            }
        })
    })
    .with_network_as_double(mlp)
}

fn answer_digits<const K: usize>(
    mlp: &Mlp,
    pixel: Pixel<'_>,
    z: impl Fn(f32) -> f64,
    digits: u32,
    rounding: Rounding<f64>,
    out: &mut [f64],
) {
    let (nearest, farthest) = ends(pixel);
    let terms: Vec<FragmentTerms<f64>> = terms_of(pixel, &z);
    let mut sums = PixelSums::<f64, K>::default();
    for &s in &terms {
        sums.add(s);
        sums.b = sums.b.map(|b| to_digits(b, digits));
        sums.b0 = to_digits(sums.b0, digits);
    }
    for (out, &s) in out.iter_mut().zip(&terms) {
        *out = match sums.classify_stored(s, [z(nearest), z(farthest)], rounding) {
            Pass2Input::Solved(t) => t,
            Pass2Input::Query(first, measure) => {
                let row: Vec<f32> = first.iter().chain(&measure).map(|&f| f as f32).collect();
                mlp.forward::<f64>(&row)
            }
        };
    }
}

/// Fragments of a pixel in double precision.
fn terms_of(pixel: Pixel<'_>, z: impl Fn(f32) -> f64) -> Vec<FragmentTerms<f64>> {
    let one = |(&view_z, &alpha): (&f32, &f32)| FragmentTerms {
        view_z,
        z: z(view_z),
        absorbance: absorbance(alpha),
    };
    pixel.view_z.iter().zip(pixel.alpha).map(one).collect()
}

/// Two moments in double precision, in two readings: what a method that keeps no more can know of a pixel.
///
/// Both take the fragment's own absorbance out and answer the ends exactly, as networks do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TwoMoments {
    /// The middle of the sharp bounds on the absorbance in front that two moments leave.
    Bounds,
    /// A network whose features of the third and fourth moment are those of the beta law that has the first two.
    Beta,
}

impl TwoMoments {
    /// The method; a network is asked in the second reading only.
    pub fn subject(self, mlp: &Mlp) -> Subject<'static> {
        let name = match self {
            Self::Bounds => "two moments, bounds @ f64".to_owned(),
            Self::Beta => format!("two moments, neural:{} @ f64", mlp.name()),
        };
        let mlp = mlp.clone();
        Subject::new(name, Promise::Ends, move |f| {
            on_pixels(&mlp, f, |pixel, out| {
                let (nearest, farthest) = ends(pixel);
                let depth = LogWarp::new(ViewZ(nearest.into()), ViewZ(farthest.into()));
                let z = |v: f32| depth.as_ref().map_or(f64::NAN, |warp| warp.moment(ViewZ(v.into())).0);
                let terms = terms_of(pixel, z);
                let mut sums = PixelSums::<f64, 2>::default();
                terms.iter().for_each(|&s| sums.add(s));
                for (out, &s) in out.iter_mut().zip(&terms) {
                    *out = match sums.classify(s, [z(nearest), z(farthest)]) {
                        Pass2Input::Solved(t) => t,
                        Pass2Input::Query([x, count, log], [mean, spread]) => match self {
                            Self::Bounds => {
                                let others = libm::exp(log) - f64::from(recentred::ABSORBANCE_OFFSET);
                                let variance = spread * (1.0 - mean * mean);
                                let gap = x - mean;
                                // Cantelli: the mass on the far side of x is at most that of the atom at x and another
                                // one.
                                let far = variance / (variance + gap * gap);
                                let share = if gap > 0.0 { 1.0 - 0.5 * far } else { 0.5 * far };
                                libm::exp(-others * share)
                            }
                            Self::Beta => {
                                let row = [
                                    x,
                                    count,
                                    log,
                                    mean,
                                    spread,
                                    mean * (1.0 - spread) / (1.0 + spread),
                                    (spread / (1.0 + 2.0 * spread)).sqrt(),
                                ];
                                mlp.forward::<f64>(&row.map(|f| f as f32))
                            }
                        },
                    };
                }
            })
        })
    }
}

/// A network's method without rounding: moments in f64 about the pixel's own centre, where they lose nothing.
fn double_precision(mlp: &Mlp, fragments: &Fragments) -> Answers {
    if !is_recentred(mlp.feature_set()) {
        let list = fragments.list().map_err(|e| e.to_string())?;
        let context = fragments.context;
        let extractor = Extractor::for_list(mlp.feature_set(), &list, context.planes, context.depth_range)
            .map_err(|e| e.to_string())?;
        let extracted = extractor.list(&list, 0..list.pixels()).map_err(|e| e.to_string())?;
        return Ok(mlp.forward_batch(&extracted.features));
    }
    on_pixels(mlp, fragments, |pixel, out| {
        let (nearest, farthest) = ends(pixel);
        let depth = LogWarp::new(ViewZ(nearest.into()), ViewZ(farthest.into()));
        let z = |v: f32| depth.as_ref().map_or(f64::NAN, |warp| warp.moment(ViewZ(v.into())).0);
        answer_pixel::<f64>(mlp, pixel, [z(nearest), z(farthest)], z, absorbance, out);
    })
}

/// What the exported shader computes, operation by operation, in arithmetic `R`: pass 1, what is known of each
/// fragment, the network.
fn as_shader<R: Scalar>(mlp: &Mlp, fragments: &Fragments, frame: MomentFrame) -> Answers {
    let whole = fragments
        .context
        .depth_range
        .or_else(|| fragments.list().ok().and_then(|list| list.depth_range()))
        .unwrap_or((1.0, 1.0));
    on_pixels(mlp, fragments, |pixel, out| {
        let (nearest, farthest) = ends(pixel);
        let range = match frame {
            MomentFrame::Scene => [whole.0, whole.1],
            MomentFrame::Pixel => [nearest, farthest],
        };
        let z = |v: f32| recentred::moment_depth(R::from_f32(v), range.map(R::from_f32));
        answer_pixel::<R>(
            mlp,
            pixel,
            [z(nearest), z(farthest)],
            z,
            |alpha| recentred::absorbance(R::from_f32(alpha)),
            out,
        );
    })
}

/// Least and greatest view depth, as a prepass keeps them.
fn ends(pixel: Pixel<'_>) -> (f32, f32) {
    pixel
        .view_z
        .iter()
        .fold((f32::INFINITY, f32::NEG_INFINITY), |(lo, hi), &v| {
            (lo.min(v), hi.max(v))
        })
}

fn on_pixels(mlp: &Mlp, fragments: &Fragments, answer: impl Fn(Pixel<'_>, &mut [f64]) + Sync) -> Answers {
    if !is_recentred(mlp.feature_set()) {
        return Err(format!(
            "the features of '{}' are computed in one way only",
            mlp.feature_set().name()
        ));
    }
    Ok(each_pixel(fragments, answer))
}

/// Answers pixel by pixel, on all cores.
pub(super) fn each_pixel(fragments: &Fragments, answer: impl Fn(Pixel<'_>, &mut [f64]) + Sync) -> Vec<f64> {
    let mut out = vec![0.0; fragments.len()];
    let mut rest = out.as_mut_slice();
    let mut jobs = Vec::with_capacity(fragments.pixels());
    for p in 0..fragments.pixels() {
        let (own, others) = rest.split_at_mut(fragments.range(p).len());
        rest = others;
        jobs.push((p, own));
    }
    jobs.into_par_iter()
        .with_min_len(16)
        .for_each(|(p, out)| answer(fragments.pixel(p), out));
    out
}

/// Both passes over a pixel.
fn answer_pixel<R: Scalar>(
    mlp: &Mlp,
    pixel: Pixel<'_>,
    ends: [R; 2],
    z: impl Fn(f32) -> R,
    absorbance: impl Fn(f32) -> R,
    out: &mut [f64],
) {
    match mlp.feature_set().moments() {
        4 => answer_of::<R, 4>(mlp, pixel, ends, z, absorbance, out),
        6 => answer_of::<R, 6>(mlp, pixel, ends, z, absorbance, out),
        _ => answer_of::<R, 8>(mlp, pixel, ends, z, absorbance, out),
    }
}

fn answer_of<R: Scalar, const K: usize>(
    mlp: &Mlp,
    pixel: Pixel<'_>,
    ends: [R; 2],
    z: impl Fn(f32) -> R,
    absorbance: impl Fn(f32) -> R,
    out: &mut [f64],
) {
    let terms: Vec<FragmentTerms<R>> = pixel
        .view_z
        .iter()
        .zip(pixel.alpha)
        .map(|(&view_z, &alpha)| FragmentTerms {
            view_z,
            z: z(view_z),
            absorbance: absorbance(alpha),
        })
        .collect();
    let mut sums = PixelSums::<R, K>::default();
    terms.iter().for_each(|&s| sums.add(s));
    for (out, &s) in out.iter_mut().zip(&terms) {
        *out = match sums.classify(s, ends) {
            Pass2Input::Solved(t) => t.to_f64(),
            Pass2Input::Query(first, measure) => {
                let row: Vec<f32> = first.iter().chain(&measure).map(|f| f.to_f64() as f32).collect();
                // As nmt_fragment_transmittance does.
                mlp.forward::<R>(&row).min(R::ONE).to_f64()
            }
        };
    }
}
