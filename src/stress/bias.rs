//! How much power moments must be moved away from the edge of what is a measure's: non-finite answers and errors
//! against `moment_bias`, by storage.

use super::Errors;
use super::cases::Case;
use super::classic::power_sums;
use super::subject::each_pixel;
use super::{Fragments, sweep};
use crate::moments::hamburger::{Bias, OVERESTIMATION, PowerCurve};
use crate::moments::storage::through_unorm16;
use crate::numeric::quantise::round_f16;
use crate::pixel::{LogWarp, MomentDepth, Pixel, ViewZ, absorbance, abuffer};
use serde::Serialize;

/// Strengths of the bias that are tried \[dimensionless\].
pub const STRENGTHS: [f64; 17] = [
    1e-8, 1e-7, 2e-7, 5e-7, 1e-6, 2e-6, 5e-6, 1e-5, 2e-5, 6e-5, 1e-4, 2e-4, 6e-4, 1e-3, 2.5e-3, 6e-3, 2e-2,
];

/// What keeps the moments.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kept {
    /// Single precision, in which everything else is computed too.
    F32,
    /// b_0 in half precision, the others in 16 bits each, rounded after every addition; the rest is computed in single
    /// precision.
    Unorm16,
}

impl Kept {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::Unorm16 => "unorm16",
        }
    }

    /// The bias published for it, and the measure that it moves towards.
    pub fn published(self, moments: usize) -> Bias {
        match self {
            Self::F32 => Bias::single_precision(moments),
            Self::Unorm16 => Bias::sixteen_bits(moments),
        }
    }
}

/// What one strength of the bias makes of random pixels.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct BiasPoint {
    /// Number of power moments.
    pub moments: usize,
    /// What keeps them.
    pub storage: Kept,
    /// `moment_bias` \[dimensionless\].
    pub moment_bias: f64,
    /// Whether it is the published one.
    pub published: bool,
    /// Fragments of random pixels as networks are trained on.
    pub fragments: u64,
    /// Their answers that are NaN or infinite.
    pub nonfinite: u64,
    /// Their finite answers' mean squared error of T.
    pub mse: Option<f64>,
    /// Fragments alone in their pixel.
    pub singles: u64,
    /// Their answers that are NaN or infinite.
    pub single_nonfinite: u64,
}

/// Every strength, number of moments and storage on the same pixels, `pixels` random ones and the case `single`.
pub fn points(pixels: usize) -> Vec<BiasPoint> {
    let usual = sweep::usual(pixels);
    let mut exact = vec![0.0; usual.len()];
    for p in 0..usual.pixels() {
        abuffer::transmittance(usual.pixel(p), &mut exact[usual.range(p)]);
    }
    let single = Case::all()
        .into_iter()
        .find(|c| c.name == "single")
        .expect("there is such a case")
        .fragments;
    let mut points = Vec::new();
    for storage in [Kept::F32, Kept::Unorm16] {
        for moments in [4, 6, 8] {
            let published = storage.published(moments);
            let mut strengths = STRENGTHS.to_vec();
            if !strengths.contains(&published.strength) {
                strengths.push(published.strength);
                strengths.sort_by(f64::total_cmp);
            }
            for strength in strengths {
                let bias = Bias { strength, ..published };
                let answers = |f: &Fragments| match moments {
                    4 => answers::<2, 5>(f, storage, &bias),
                    6 => answers::<3, 7>(f, storage, &bias),
                    _ => answers::<4, 9>(f, storage, &bias),
                };
                let nonfinite = |t: &[f64]| t.iter().filter(|t| !t.is_finite()).count() as u64;
                let (of_usual, of_single) = (answers(&usual), answers(&single));
                points.push(BiasPoint {
                    moments,
                    storage,
                    moment_bias: strength,
                    published: strength == published.strength,
                    fragments: usual.len() as u64,
                    nonfinite: nonfinite(&of_usual),
                    mse: Errors::of(&of_usual, &exact).map(|e| e.mse),
                    singles: single.len() as u64,
                    single_nonfinite: nonfinite(&of_single),
                });
            }
        }
    }
    points
}

/// The strength of least error among those that leave no answer without a number, for each number of moments and
/// storage.
pub fn recommended(points: &[BiasPoint]) -> Vec<BiasPoint> {
    let mut best: Vec<BiasPoint> = Vec::new();
    for p in points.iter().filter(|p| p.nonfinite == 0 && p.single_nonfinite == 0) {
        match best
            .iter_mut()
            .find(|b| (b.moments, b.storage) == (p.moments, p.storage))
        {
            Some(b) if p.mse.unwrap_or(f64::INFINITY) < b.mse.unwrap_or(f64::INFINITY) => *b = *p,
            Some(_) => {}
            None => best.push(*p),
        }
    }
    best
}

fn answers<const N: usize, const M: usize>(fragments: &Fragments, storage: Kept, bias: &Bias) -> Vec<f64> {
    let (v0, v1) = fragments.context.depth_range.unwrap_or((1.0, 1.0));
    let warp = LogWarp::new(ViewZ(v0.into()), ViewZ(v1.into())).expect("the range of a case");
    let z = |v: f32| MomentDepth(f64::from(warp.moment(ViewZ(v.into())).0 as f32));
    each_pixel(fragments, |pixel, out| {
        let b: [f32; M] = match storage {
            Kept::F32 => power_sums(pixel, z),
            Kept::Unorm16 => unorm16_sums(pixel, z),
        };
        if b[0] == 0.0 {
            return out.fill(1.0);
        }
        let curve = PowerCurve::<f32, N>::new(&b, bias);
        for (out, &v) in out.iter_mut().zip(pixel.view_z) {
            *out = curve.transmittance(z(v), OVERESTIMATION).into();
        }
    })
}

/// Sums that are rounded to 16 bits after every fragment.
fn unorm16_sums<const M: usize>(pixel: Pixel<'_>, z: impl Fn(f32) -> MomentDepth) -> [f32; M] {
    let mut b = [0.0; M];
    for (&v, &alpha) in pixel.view_z.iter().zip(pixel.alpha) {
        let (z, mut term) = (z(v).0, absorbance(alpha));
        for b in &mut b {
            *b += term;
            term *= z;
        }
        if b[0] > 0.0 {
            let normalised = through_unorm16(b.map(|x| x / b[0]));
            let total = round_f16(b[0]);
            b = std::array::from_fn(|k| if k == 0 { total } else { total * normalised[k] });
        }
    }
    b.map(|b| b as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A weak bias leaves NaN, a strong one costs accuracy, and what is recommended leaves none.
    #[test]
    fn weak_biases_fail_and_strong_ones_cost() {
        let points = points(300);
        let of = |moments, storage, strength: f64| {
            *points
                .iter()
                .find(|p| (p.moments, p.storage, p.moment_bias) == (moments, storage, strength))
                .expect("it is among those tried")
        };
        assert!(of(4, Kept::F32, 1e-8).nonfinite > 0 && of(4, Kept::Unorm16, 1e-7).nonfinite > 0);
        assert!(of(4, Kept::F32, 2e-2).mse > of(4, Kept::F32, 1e-5).mse);
        let best = recommended(&points);
        assert!(
            best.len() >= 4 && best.iter().all(|p| p.nonfinite + p.single_nonfinite == 0),
            "{best:?}"
        );
        assert_eq!(points.iter().filter(|p| p.published).count(), 6);
    }
}
