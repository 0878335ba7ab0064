//! NMT24's features: `[d, n, b0, b1, b2, b3, b4]` on window depth.

use super::extract::{Extractor, Sampled, at};
use super::recentred::formulas::absorbance as absorbance_of;
use super::spec::{ExactRules, FeatureSpec, ShaderCalls, Sums, Tolerances};
use super::{Answer, MomentDepthKind, OutputMeaning, Target};
use crate::moments::power::power_moments;
use crate::numeric::lanes::{LANES, Lanes};
use crate::numeric::real::{Real, c};
use crate::numeric::rng::Stream;
use crate::numeric::source::{Source, Type};
use crate::pixel::{CameraPlanes, DepthError, Pixel, ViewZ, absorbance};
use crate::synth::SynthConfig;
use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, f32x16};

/// Names of the columns.
pub const COLUMNS: [&str; 7] = ["d", "n", "b0", "b1", "b2", "b3", "b4"];

/// What the columns mean.
pub const DESCRIPTION: [&str; 5] = [
    "w is window depth in [0, 1], as gl_FragCoord.z holds it; moments are taken of z = 2w - 1.",
    "d = (e^w - e^w_min) / (e^w_max - e^w_min) over the fragments of the pixel, 0 where w_min = w_max;",
    "n = number of fragments of the pixel; b0 = sum of A; b_k = sum of A z^k;",
    "A = min(-ln(1 - alpha), 10) is a fragment's absorbance, and every sum takes in all fragments of the pixel.",
    "The answer is T = exp(-sum of A over the fragments nearer than this one).",
];

/// NMT24's feature set.
pub const SPEC: FeatureSpec = FeatureSpec {
    name: "paper",
    columns: &COLUMNS,
    description: &DESCRIPTION,
    sums: Sums {
        moments: 4,
        // NMT24 Sec. 4: RGBA32F colour and normalisation, RGBA32F moments, RG32F b0 and weight sum, RG16F depth range.
        has_precisions: false,
    },
    core: None,
    depth: MomentDepthKind::Window,
    output: OutputMeaning::Transmittance,
    answer: Answer::Sigmoid,
    target: Target::Transmittance,
    exact: ExactRules::NONE,
    tolerances: Tolerances {
        // Raw features reach logits of 20, where f32 sums lose this much.
        single: 3e-5,
        half: 1e-1,
        half_mean: 2e-3,
        // Fragments and absorbance are counted.
        usual_feature_log2: 6,
    },
    default_pixels: SynthConfig::paper,
    pixel: |e, pixel, features, _| extract(pixel, e.scale.planes(), features),
    sample: Some(sample),
    is_sampled: false,
    shader: ShaderCalls {
        write_features,
        write_answers: |_| (),
        arguments: &["w", "w_min", "w_max", "n", "b0"],
        answer: "nmt_transmittance(nmt_features(HEAD, TAIL))",
    },
};

/// e^x − 1 for 0 ≤ x ≤ 1 by its series to degree 10, which leaves 3e-8 at x = 1.
#[inline(always)]
fn expm1<R: Real>(x: R) -> R {
    R::step(
        "expm1",
        "e^x - 1 for 0 <= x <= 1, without the cancellation of exp(x) - 1 near 0; relative error below 1e-7.",
        [("x", x)],
        #[inline(always)]
        |[x]| {
            let mut p = x.like(1.0 / 3_628_800.0);
            for factorial in [362_880.0, 40_320.0, 5040.0, 720.0, 120.0, 24.0, 6.0, 2.0, 1.0] {
                p = c(1.0 / factorial) + x * p;
            }
            x * p
        },
    )
}

fn write_features(source: &Source) {
    expm1(source.real("x"));
    absorbance_of(source.real("alpha"));
    let about = "Pass 1: what a fragment at window depth w adds to b1..b4; to b0 it adds its absorbance.";
    source.begin_function(
        "nmt_moments",
        about,
        &[("w", Type::Real), ("absorbance", Type::Real)],
        Type::Vec4,
    );
    let [w, a] = ["w", "absorbance"].map(|name| source.real(name));
    let z = (c(2.0) * w - c(1.0)).named("z");
    let mut term = a;
    let b = std::array::from_fn::<_, 4, _>(|k| {
        term = (term * z).named_at("b", k + 1);
        term
    });
    source.return_numbers(&b);
    let about = "Pass 2: the features of a fragment at window depth w, from what pass 1 left in its pixel: least and \
                 greatest window depth, number of fragments, total absorbance b0 and moments b1..b4.";
    let names = SPEC.shader.arguments;
    let parameters: Vec<_> = names
        .iter()
        .map(|&name| (name, Type::Real))
        .chain([("b1234", Type::Vec4)])
        .collect();
    source.begin_function("nmt_features", about, &parameters, Type::Reals(COLUMNS.len()));
    let [w, least, greatest, n, b0] = ["w", "w_min", "w_max", "n", "b0"].map(|name| source.real(name));
    let range = expm1(greatest - least).max(c(1e-30));
    let d = Real::select(greatest.gt(least), expm1(w - least) / range, w.like(0.0)).named("d");
    source.return_numbers(&[[d, n, b0].as_slice(), &source.vec4("b1234")].concat());
}

/// Rows of some fragments of a pixel, every one of which needs the network; see [`Extractor::sample`].
fn sample(e: &Extractor, pixel: Pixel<'_>, most: usize, rng: &mut Stream, rows: &mut Sampled) {
    let n = pixel.len();
    rows.transform_depths(pixel, &e.scale.planes());
    let b = describe_lanes(n, &mut rows.depth, &rows.absorbance);
    rows.choose(n, most, rng, |i, Sampled { depth, features, .. }| {
        features.extend_from_slice(&[at(depth, i), n as f32, b[0], b[1], b[2], b[3], b[4]]);
        true
    });
}

/// Relative depth of a fragment in its pixel: d = (e^w − e^wmin)/(e^wmax − e^wmin); 0 where wmin = wmax.
///
/// Written with e^x − 1 of the *differences*, which is the same number without the cancellation that thin pixels
/// suffer.
///
/// # Source
/// NMT24 Sec. 3.1, first feature, on window depth.
///
/// # Domain
/// 0 ≤ wmin ≤ w ≤ wmax ≤ 1; the result is in [0, 1].
pub fn relative_depth(w: f64, wmin: f64, wmax: f64) -> f64 {
    if wmax > wmin {
        libm::expm1(w - wmin) / libm::expm1(wmax - wmin)
    } else {
        0.0
    }
}

/// Features of every fragment of a pixel: relative depth, number of fragments, and the power moments b0..b4 of z = 2w −
/// 1, taken in f64 and rounded to f32 once.
///
/// # Source
/// NMT24 Sec. 3.1 and Eq. 5.
///
/// # Shapes
/// `out: [n, 7]`, row by row.
///
/// # Errors
/// [`DepthError::OutsidePlanes`].
///
/// # Panics
/// If `out` has another length.
pub fn extract(pixel: Pixel<'_>, planes: CameraPlanes, out: &mut [f32]) -> Result<(), DepthError> {
    const W: usize = COLUMNS.len();
    assert_eq!(out.len(), pixel.len() * W, "one row of {W} features a fragment");
    let mut windows = Vec::with_capacity(pixel.len());
    for &v in pixel.view_z {
        windows.push(planes.window(ViewZ(v.into()))?);
    }
    let (wmin, wmax) = windows.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), w| {
        (lo.min(w.0), hi.max(w.0))
    });
    let depths: Vec<_> = windows.iter().map(|w| w.to_moment()).collect();
    let absorbances: Vec<_> = pixel.alpha.iter().map(|&a| absorbance(a)).collect();
    let b: [f64; 5] = power_moments(&depths, &absorbances);
    for (row, w) in out.chunks_exact_mut(W).zip(&windows) {
        row[0] = relative_depth(w.0, wmin, wmax) as f32;
        row[1] = pixel.len() as f32;
        for (feature, b) in row[2..].iter_mut().zip(b) {
            *feature = b as f32;
        }
    }
    Ok(())
}

/// What [`extract`] makes of a pixel, in f32 lanes: window depths become relative depths, and b0..b4 are returned.
///
/// # Accuracy
/// 1e-6 of b0 in the moments and 2e-6 over the pixel's range of window depth in the depths;
/// `sampled_rows_are_those_of_whole_pixels`.
pub fn describe_lanes(n: usize, depth: &mut [Lanes], absorbance: &[Lanes]) -> [f32; 5] {
    let mut range = [f32::INFINITY, f32::NEG_INFINITY];
    for i in 0..n {
        let w = depth[i / LANES].0[i % LANES];
        range = [range[0].min(w), range[1].max(w)];
    }
    let mut sums = [Lanes::ZERO; 5];
    dispatch!(Level::new(), simd => describe(simd, range, depth, absorbance, &mut sums));
    // One order of the lanes at every SIMD level.
    sums.map(|s| s.0.iter().sum())
}

#[inline(always)]
fn describe<S: Simd>(
    simd: S,
    [wmin, wmax]: [f32; 2],
    depth: &mut [Lanes],
    absorbance: &[Lanes],
    sums: &mut [Lanes; 5],
) {
    let splat = |x: f32| f32x16::splat(simd, x);
    let mut b = [splat(0.0); 5];
    let scale = if wmax > wmin {
        (1.0 / libm::expm1(f64::from(wmax) - f64::from(wmin))) as f32
    } else {
        0.0
    };
    for (w, a) in depth.iter_mut().zip(absorbance) {
        let (depth, mut term) = (w.load(simd), a.load(simd));
        let z = depth * splat(2.0) - splat(1.0);
        b[0] += term;
        for b in &mut b[1..] {
            term *= z;
            *b += term;
        }
        let x = Real::clamp(depth - splat(wmin), c(0.0), c(1.0));
        w.store(Real::min(expm1(x) * splat(scale), c(1.0)));
    }
    for (sum, b) in sums.iter_mut().zip(b) {
        sum.store(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn features(view_z: &[f32], alpha: &[f32]) -> Vec<f32> {
        let mut out = vec![f32::NAN; view_z.len() * 7];
        extract(
            Pixel {
                view_z,
                alpha,
                color: None,
            },
            CameraPlanes::new(0.5, 10.0).unwrap(),
            &mut out,
        )
        .unwrap();
        out
    }

    /// Two fragments on the planes themselves: w = 0 and 1, z = −1 and 1, A = ln 2 each.
    #[test]
    fn two_fragments_by_hand() {
        let a = std::f32::consts::LN_2;
        assert_eq!(
            features(&[10.0, 0.5], &[0.5, 0.5]),
            [
                1.0,
                2.0,
                2.0 * a,
                0.0,
                2.0 * a,
                0.0,
                2.0 * a,
                0.0,
                2.0,
                2.0 * a,
                0.0,
                2.0 * a,
                0.0,
                2.0 * a
            ]
        );
    }

    #[test]
    fn one_fragment_and_ties_have_relative_depth_zero() {
        assert_eq!(features(&[3.0], &[0.5])[..2], [0.0, 1.0]);
        let tied = features(&[3.0, 3.0], &[0.5, 0.0]);
        assert_eq!((tied[0], tied[7]), (0.0, 0.0));
        assert!(features(&[], &[]).is_empty());
    }

    #[test]
    fn outside_the_planes_is_an_error() {
        let planes = CameraPlanes::new(0.5, 10.0).unwrap();
        let pixel = Pixel {
            view_z: &[11.0],
            alpha: &[0.5],
            color: None,
        };
        assert_eq!(
            extract(pixel, planes, &mut [0.0; 7]),
            Err(DepthError::OutsidePlanes {
                view_z: 11.0,
                near: 0.5,
                far: 10.0
            })
        );
    }

    proptest! {
        /// Against the formula as NMT24 prints it, where that is well conditioned. Tolerance 1e-13.
        #[test]
        fn relative_depth_is_the_printed_formula(lo in 0.0f64..0.4, hi in 0.6f64..1.0, u in 0.0f64..=1.0) {
            let w = lo + u * (hi - lo);
            let printed = (w.exp() - lo.exp()) / (hi.exp() - lo.exp());
            prop_assert!((relative_depth(w, lo, hi) - printed).abs() < 1e-13);
        }

        /// In the thinnest pixels d stays within [0, 1] and tends to the linear (w − wmin)/(wmax − wmin). Tolerance:
        /// the range itself.
        #[test]
        fn relative_depth_of_thin_pixels_is_linear(lo in 0.0f64..0.9, exponent in 2.0f64..12.0, u in 0.0f64..=1.0) {
            let range = 10f64.powf(-exponent);
            let (hi, w) = (lo + range, lo + u * range);
            let d = relative_depth(w, lo, hi);
            let linear = (w - lo) / (hi - lo);
            prop_assert!((0.0..=1.0).contains(&d) && (d - linear).abs() <= range);
        }
    }
}
