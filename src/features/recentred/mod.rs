//! Recentred features: what the other fragments of a pixel look like from the pixel's own depth range, with everything
//! taken out that is known exactly.
//!
//! Pass 1 adds up b_0..b_K, counts fragments and keeps the nearest and the farthest view depth. Pass 2 removes the
//! fragment's own absorbance, moves the moments to the pixel's own range [−1, 1], and describes the measure μ of the
//! other fragments' absorbance by means and spreads: of μ itself, then of (1 − x²) μ, which no longer holds the two
//! known fragments at the ends, and so on. Each spread is the variance as a share of the greatest that the mean allows,
//! so that every feature has its range whatever the others are (canonical moments are built alike).

mod extract;
pub mod formulas;
pub mod source;

use super::spec::{ExactRules, FeatureSpec, ShaderCalls, Sums, Tolerances};
use super::{Answer, MomentDepthKind, OutputMeaning, Target};
use crate::numeric::Scalar;
use crate::numeric::real::{Real, c};
use crate::synth::SynthConfig;
use formulas::{
    ALONE, Others, Pass2, half_range, is_thin, moments, others, place_in_thin, share_of_three, transmittance,
};
pub use formulas::{absorbance, moment_depth};

/// Added to b_0' before its logarithm is taken, so that a faint pixel stays finite.
pub const ABSORBANCE_OFFSET: f32 = 0.05;

/// Column of ln(b_0' + [`ABSORBANCE_OFFSET`]).
pub const ABSORBANCE_COLUMN: usize = 2;

/// Columns before the description of the measure.
const FIXED: usize = 3;

/// Names of the columns with 8 moments; with fewer, the first ones.
const COLUMNS: [&str; 11] = [
    "x",
    "count",
    "ln_b0",
    "mean",
    "spread",
    "inner_mean",
    "inner_spread",
    "inner2_mean",
    "inner2_spread",
    "inner3_mean",
    "inner3_spread",
];

/// Names of the columns with K moments.
pub fn columns(moments: usize) -> &'static [&'static str] {
    &COLUMNS[..FIXED + moments]
}

/// What the columns mean.
pub const DESCRIPTION: [&str; 12] = [
    "v is distance along the view direction and z = 2 ln(v/v0)/ln(v1/v0) - 1 moment depth, v0 and v1 the scene's least \
        and greatest v;",
    "pass 1 adds up b_k = sum of A z^k, counts fragments (n) and keeps the pixel's least and greatest v as f32.",
    "A = min(-ln(1 - alpha), 10) is a fragment's absorbance; primed quantities leave out the fragment's own, b_k' = \
        b_k - A z^k.",
    "c and h are middle and half of the pixel's range of z; m_k = moments of the others in (z - c)/h, normalised by \
        b_0'.",
    "x = (z - c)/h, count = log2(n)/3 - 1, ln_b0 = ln(b_0' + 0.05);",
    "mean = m_1, spread = (m_2 - m_1^2)/(1 - m_1^2); inner_ of (1 - x^2) times the measure: mean = (m_1 - m_3)/(1 - \
        m_2),",
    "spread = the square root of the same ratio of its own; inner2_ and inner3_ of (1 - x^2)^2 and (1 - x^2)^3, faded \
        out where f32 leaves noise.",
    "The answer is T = exp(-b_0' s), s the network's sigmoid: the share of the other absorbance that lies in front.",
    "Not part of the network, and to be applied before it, in this order: nearest in its pixel (v compared bit for \
        bit): T = 1;",
    "b_0' <= 1e-6 b_0: T = 1; farthest: T = exp(-b_0'); three fragments: T = exp(-b_0' (1 - m_1)/2);",
    "four fragments: the closed form in nmt_recentred.",
    "So pixels of up to four fragments, and all that is nearest or farthest, never need the network.",
];

const fn spec<const K: usize>(name: &'static str, answer: &'static str) -> FeatureSpec {
    FeatureSpec {
        name,
        columns: COLUMNS.split_at(FIXED + K).0,
        description: &DESCRIPTION,
        sums: Sums {
            moments: K,
            // RGBA32F colour and weight sum, R32F b0, R16F count, RG32F depth range, and as many f32 as there are
            // moments.
            has_precisions: true,
        },
        core: None,
        depth: MomentDepthKind::Log,
        output: OutputMeaning::AbsorbanceShare,
        answer: Answer::AbsorbanceShare {
            column: ABSORBANCE_COLUMN,
            offset: ABSORBANCE_OFFSET,
        },
        target: Target::Transmittance,
        exact: ExactRules {
            ends: true,
            closed_forms: 4,
        },
        tolerances: Tolerances {
            single: 5e-6,
            // f16 keeps 11 bits of a sum, and a logit that is off by 0.02 beside great absorbance is rare, but there.
            half: 1e-1,
            half_mean: 1e-3,
            // Features are of the order of 1, with logarithms up to 10.
            usual_feature_log2: 4,
        },
        default_pixels: SynthConfig::wide,
        pixel: extract::pixel::<K>,
        sample: Some(extract::sample::<K>),
        is_sampled: true,
        shader: ShaderCalls {
            write_features: source::write_features::<K>,
            write_answers: source::write_answers::<K>,
            arguments: &source::PASS2_PARAMETERS,
            answer,
        },
    }
}

/// The feature set with four moments.
pub const FOUR_MOMENTS: FeatureSpec = spec::<4>("recentred", "nmt_fragment_transmittance(HEAD, TAIL)");

/// The feature set with six moments.
pub const SIX_MOMENTS: FeatureSpec = spec::<6>("recentred-6", "nmt_fragment_transmittance(HEAD, TAIL)");

/// The feature set with eight moments.
pub const EIGHT_MOMENTS: FeatureSpec = spec::<8>("recentred-8", "nmt_fragment_transmittance(HEAD, TAIL)");

/// A pixel after pass 1.
///
/// # Source
/// NMT24 Eq. 5; count and depth range as NMT24 Sec. 4, but the range as f32 view depth.
#[derive(Debug, Clone, Copy)]
pub struct PixelSums<R, const K: usize> {
    /// Σ A.
    pub b0: R,
    /// Σ A z^k, k = 1..=K.
    pub b: [R; K],
    /// Number of fragments.
    pub count: u32,
    /// Least view depth.
    pub nearest: f32,
    /// Greatest view depth.
    pub farthest: f32,
}

impl<R: Scalar, const K: usize> Default for PixelSums<R, K> {
    fn default() -> Self {
        Self {
            b0: R::ZERO,
            b: [R::ZERO; K],
            count: 0,
            nearest: f32::INFINITY,
            farthest: f32::NEG_INFINITY,
        }
    }
}

/// A fragment as both passes see it.
#[derive(Debug, Clone, Copy)]
pub struct FragmentTerms<R> {
    /// View depth, as the depth range keeps it.
    pub view_z: f32,
    /// Moment depth.
    pub z: R,
    /// Absorbance.
    pub absorbance: R,
}

/// What storage does to moments: what pass 2 must know of it to see where it has left nothing but noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rounding<R> {
    /// About the greatest that one rounding does to a moment, as a share of b_0.
    pub unit: R,
    /// Whether every addition rounds, so that errors grow as the root of the number of fragments; else the finished sum
    /// alone is rounded.
    pub every_addition: bool,
}

impl<R: Real> Rounding<R> {
    /// Of sums in the arithmetic of a number itself.
    #[inline(always)]
    pub fn of_arithmetic(like: R) -> Self {
        Self {
            unit: like.like(R::ROUNDING),
            every_addition: true,
        }
    }

    /// The usual error of a moment of n fragments, as a share of [`Self::unit`].
    ///
    /// # Accuracy
    /// Measured over random pixels of 3 to 256 fragments: 0.05 to 0.1 √n for the fourth moment, 0.1 to 0.2 √n for the
    /// first.
    #[inline(always)]
    fn usual(&self, n: R) -> R {
        if self.every_addition {
            c(USUAL_NOISE) * n.sqrt()
        } else {
            n.like(0.3)
        }
    }
}

/// What pass 2 knows of a fragment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Pass2Input<R, const K: usize> {
    /// Its transmittance, without a network.
    Solved(R),
    /// Features for the network: x, count, ln_b0, then mean and spread by turns.
    Query([R; 3], [R; K]),
}

/// Least half-range of a pixel in moment depth; f32 hardly tells nearer depths apart.
pub const MIN_HALF_RANGE: f64 = 1e-8;

/// Greatest absorbance of a pixel that is computed with; more can only come of numbers that are none.
pub const MAX_ABSORBANCE: f64 = 1e30;

/// Range of a pixel, relative to its nearest view depth, below which a fragment's place is taken from view depth; what
/// the expansion leaves out is 1e-5 of the range.
pub const THIN: f64 = 0.01;

impl<R: Scalar, const K: usize> PixelSums<R, K> {
    /// Pass 1: adds a fragment.
    pub fn add(&mut self, terms: FragmentTerms<R>) {
        self.b0 += terms.absorbance;
        for (b, term) in self.b.iter_mut().zip(moments::<R, K>(terms.z, terms.absorbance)) {
            *b += term;
        }
        self.count += 1;
        self.nearest = self.nearest.min(terms.view_z);
        self.farthest = self.farthest.max(terms.view_z);
    }

    /// Pass 2: the exact rules, the closed forms, and where they end the features.
    ///
    /// `ends` are the moment depths of the nearest and the farthest view depth.
    ///
    /// # Domain
    /// A fragment that pass 1 has added. Whatever rounding has done to the sums, the answer is in [0, 1] and the
    /// features are finite and within their ranges.
    pub fn classify(&self, terms: FragmentTerms<R>, ends: [R; 2]) -> Pass2Input<R, K> {
        self.classify_stored(terms, ends, Rounding::of_arithmetic(R::ONE))
    }

    /// [`Self::classify`] at sums that storage has rounded more than the arithmetic would.
    pub fn classify_stored(&self, terms: FragmentTerms<R>, ends: [R; 2], rounding: Rounding<R>) -> Pass2Input<R, K> {
        let absorbance = others(self.b0, terms.absorbance);
        if terms.view_z == self.nearest || absorbance <= c(ALONE) * self.b0 {
            return Pass2Input::Solved(R::ONE);
        }
        if terms.view_z == self.farthest {
            return Pass2Input::Solved(transmittance(absorbance));
        }
        let n = R::from_f64(f64::from(self.count));
        let [centre, half_range] = half_range(ends);
        let pass2 = Pass2 {
            z: terms.z,
            absorbance: terms.absorbance,
            b0: self.b0,
            b: self.b,
            n,
            centre,
            half_range,
        };
        let others = Others::new(&pass2, absorbance);
        let rounded = others.rounded(&pass2, rounding);
        let mean = rounded.mean();
        if self.count == 3 {
            return Pass2Input::Solved(transmittance(absorbance * share_of_three(mean)));
        }
        let [v, nearest, farthest] = [terms.view_z, self.nearest, self.farthest].map(R::from_f32);
        let x = if is_thin(nearest, farthest) {
            place_in_thin(v, nearest, farthest)
        } else {
            others.along
        };
        if K < 4 {
            let mut columns = [mean; K];
            columns[1] = rounded.two_columns()[1];
            return Pass2Input::Query(rounded.first_columns(x), columns);
        }
        let description = rounded.describe(mean);
        if self.count == 4 {
            return Pass2Input::Solved(transmittance(absorbance * description.share_of_four(x)));
        }
        Pass2Input::Query(rounded.first_columns(x), rounded.columns(&description))
    }
}

/// Least mass of (1 − x²) μ that is divided by.
pub const MIN_MASS: f64 = 1e-6;

/// Usual error of the first moment of one fragment, as a share of the rounding of a stored moment.
pub const USUAL_NOISE: f64 = 0.12;

/// How much errors of moments grow from one to the next, as a share of the bound.
pub const NOISE_GROWTH: f64 = 0.87;

/// Roundings of the arithmetic itself within which two places are taken for one, whatever the sums; devices' quotients
/// are a few ULP off.
pub const ARITHMETIC: f64 = 8.0;

/// A quantity of random pixels of n fragments, as a + b/n.
///
/// # Source
/// Fitted to the pixels that networks are trained on, 5 to 256 fragments, within a tenth.
#[derive(Debug, Clone, Copy)]
pub struct ByCount {
    /// Of many fragments.
    pub many: f64,
    /// What few add.
    pub few: f64,
}

/// Standard deviation of the mean of a pixel's measure about 0.
pub const MEAN_DEVIATION: ByCount = ByCount { many: 0.22, few: 0.7 };

/// What is expected of the spread: few atoms scatter more than a cloud.
pub const USUAL_SPREAD: ByCount = ByCount { many: 0.3, few: 1.8 };

/// Standard deviation of the spread about what is expected.
pub const SPREAD_DEVIATION: ByCount = ByCount { many: 0.12, few: 0.5 };

/// Standard deviation of the inner mean about what mean and spread lead to expect, as a share of the spread.
pub const INNER_MEAN_DEVIATION: ByCount = ByCount { many: 0.17, few: 3.1 };

/// What is expected of the square of the inner spread, as a share of that of the beta law, where the spread is small
/// and the inner mean is what mean and spread lead to expect.
pub const USUAL_INNER_SPREAD: ByCount = ByCount { many: 0.94, few: -3.8 };

/// How much more is expected of that share, times the fourth power of the spread: what is spread out most gathers in
/// several places, not at the ends alone.
pub const INNER_SPREAD_OF_SPREAD: f64 = 4.0;

/// How much less is expected of it, times the square of (1 + spread) (inner mean − what is expected of that): what is
/// off to a side is narrow.
pub const INNER_SPREAD_OF_OFFSET: f64 = 1.2;

/// Standard deviation of the square of the inner spread about what is expected, as a share of the spread.
pub const INNER_SPREAD_DEVIATION: ByCount = ByCount { many: 0.12, few: 1.4 };

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::rng::stream;
    use crate::pixel::{Pixel, absorbance, abuffer};
    use rand::RngExt;

    /// A pixel in moment depth; view depth is e^z, so that both order alike.
    struct Case {
        z: Vec<f64>,
        alpha: Vec<f32>,
    }

    impl Case {
        fn random(rng: &mut crate::numeric::rng::Stream, n: usize, half: f64, least_gap: f64) -> Self {
            let c = rng.random_range(half - 1.0..1.0 - half);
            let gap = 2.0 * half * least_gap;
            let z = loop {
                let mut z: Vec<f64> = [-1.0, 1.0]
                    .into_iter()
                    .chain((2..n).map(|_| rng.random_range(-1.0..1.0)))
                    .map(|x| c + half * x)
                    .take(n)
                    .collect();
                let mut sorted = z.clone();
                sorted.sort_by(f64::total_cmp);
                if sorted.windows(2).all(|w| w[1] - w[0] >= gap) {
                    z.rotate_left(1);
                    break z;
                }
            };
            // Absorbances from 1e-3 to the clamp.
            let alpha = (0..n)
                .map(|_| -libm::expm1(-libm::exp(rng.random_range(-6.9..2.4))) as f32)
                .collect();
            Self { z, alpha }
        }

        /// Depths as keys that compare as the moment depths do.
        fn keys(&self) -> Vec<f32> {
            let mut sorted = self.z.clone();
            sorted.sort_by(f64::total_cmp);
            self.z
                .iter()
                .map(|z| 1.0 + sorted.iter().position(|s| s == z).unwrap() as f32)
                .collect()
        }

        fn exact(&self) -> Vec<f64> {
            let keys = self.keys();
            let mut out = vec![0.0; keys.len()];
            abuffer::transmittance(
                Pixel {
                    view_z: &keys,
                    alpha: &self.alpha,
                    color: None,
                },
                &mut out,
            );
            out
        }

        fn classify<R: Scalar, const K: usize>(&self) -> Vec<Pass2Input<R, K>> {
            let keys = self.keys();
            let terms: Vec<FragmentTerms<R>> = (0..keys.len())
                .map(|i| FragmentTerms {
                    view_z: keys[i],
                    z: R::from_f64(self.z[i]),
                    absorbance: R::from_f64(absorbance(self.alpha[i])),
                })
                .collect();
            let mut sums = PixelSums::<R, K>::default();
            terms.iter().for_each(|&s| sums.add(s));
            let end = |key: f32| terms.iter().find(|s| s.view_z == key).unwrap().z;
            let ends = [end(sums.nearest), end(sums.farthest)];
            terms.iter().map(|&s| sums.classify(s, ends)).collect()
        }
    }

    /// One, two and three fragments in f64: 1e-9, whatever their depths and absorbances. Control: transmittances of the
    /// reversed pixel.
    #[test]
    fn up_to_three_fragments_are_exact() {
        let mut rng = stream(1, 90, 0);
        let mut controls = 0;
        for i in 0..30_000 {
            let half = 10f64.powf(rng.random_range(-2.0..0.0));
            let case = Case::random(&mut rng, 1 + i % 3, half, 1e-3);
            let exact = case.exact();
            for (known, &t) in case.classify::<f64, 4>().into_iter().zip(&exact) {
                let Pass2Input::Solved(found) = known else {
                    panic!("{} fragments need no network", exact.len())
                };
                assert!((found - t).abs() <= 1e-9, "{found} for {t}");
            }
            let reversed = Case {
                z: case.z.iter().map(|z| -z).collect(),
                alpha: case.alpha.clone(),
            };
            controls += usize::from(reversed.exact().iter().zip(&exact).any(|(a, b)| (a - b).abs() > 1e-9));
        }
        assert!(controls > 15_000);
    }

    /// Worst and mean squared error of the closed form of four fragments.
    fn four<R: Scalar>(half: f64, least_gap: f64, cases: usize) -> (f64, f64) {
        let mut rng = stream(2, 90, 0);
        let (mut worst, mut sum) = (0.0f64, 0.0);
        for _ in 0..cases {
            let case = Case::random(&mut rng, 4, half, least_gap);
            for (known, t) in case.classify::<R, 4>().into_iter().zip(case.exact()) {
                let Pass2Input::Solved(found) = known else {
                    panic!("four fragments need no network")
                };
                let e = (found.to_f64() - t).abs();
                worst = if e.is_nan() { f64::INFINITY } else { worst.max(e) };
                sum += e * e / (4 * cases) as f64;
            }
        }
        (worst, sum)
    }

    /// Four fragments in f64, pixel half-range 0.1 and more, gaps of 5 % of the range: to 1e-9. Nearer together or
    /// thinner, rounding of the moments grows with the third power of 1/half-range; in f32 the mean squared error stays
    /// below twice what was measured. Control: the thinnest pixels break the bound of the others.
    #[test]
    fn four_fragments_are_exact_where_rounding_allows() {
        for (half, gap, bar) in [(0.5, 0.05, 1e-9), (0.1, 0.05, 1e-9)] {
            let (worst, _) = four::<f64>(half, gap, 20_000);
            println!("f64, half-range {half}, gaps {gap}: worst error {worst:.1e}");
            assert!(worst <= bar, "half-range {half}: worst {worst}");
        }
        for (half, bar) in [(0.5, 6e-10), (0.1, 1.6e-6), (0.02, 9e-4), (1e-3, 1e-2)] {
            let (worst, mse) = four::<f32>(half, 1e-3, 20_000);
            println!("f32, half-range {half}: worst error {worst:.1e}, mean squared {mse:.1e}");
            assert!(mse <= bar && (half > 0.01 || mse > 9e-4), "half-range {half}: {mse}");
        }
    }

    /// Pixels of four with sums rounded to f32, however thin: a hundredth of a rounding of any moment moves T by next
    /// to nothing. Control: ten roundings move it by a tenth now and then.
    #[test]
    fn four_fragments_leave_no_jump() {
        let mut rng = stream(5, 90, 0);
        let (mut worst, mut controls) = (0.0f64, 0);
        for _ in 0..4000 {
            let half = 10f64.powf(rng.random_range(-3.0..-0.3));
            let case = Case::random(&mut rng, 4, half, 1e-3);
            let exact: Vec<FragmentTerms<f64>> = (0..4)
                .map(|i| FragmentTerms {
                    view_z: case.keys()[i],
                    z: case.z[i],
                    absorbance: absorbance(case.alpha[i]),
                })
                .collect();
            let mut sums = PixelSums::<f64, 4>::default();
            exact.iter().for_each(|&s| sums.add(s));
            let middle = exact.iter().find(|s| s.view_z == 2.0).copied().unwrap();
            let end = |key: f32| exact.iter().find(|s| s.view_z == key).unwrap().z;
            let ends = [end(sums.nearest), end(sums.farthest)];
            let t = |sums: &PixelSums<f64, 4>| match sums.classify_stored(
                middle,
                ends,
                Rounding {
                    unit: f64::from(f32::EPSILON),
                    every_addition: true,
                },
            ) {
                Pass2Input::Solved(t) => t,
                Pass2Input::Query(..) => f64::NAN,
            };
            let before = t(&sums);
            // A hundredth of a rounding of f32.
            for k in 0..4 {
                let mut moved = sums;
                moved.b[k] *= 1.0 + 0.01 * f64::from(f32::EPSILON);
                let step = (t(&moved) - before).abs();
                worst = if step.is_nan() { f64::INFINITY } else { worst.max(step) };
                moved.b[k] *= 1.0 + 10.0 * f64::from(f32::EPSILON);
                controls += usize::from((t(&moved) - before).abs() > 0.1);
            }
        }
        println!("greatest step {worst}, {controls} controls");
        assert!(worst <= 0.02 && controls > 100, "{worst}, {controls} controls");
    }

    /// Features of μ against their definition in the pixel's own range, in f64: 1e-9 for pixels of half-range 0.3, so
    /// for every number of moments.
    #[test]
    fn features_follow_their_definition() {
        fn compare<const K: usize>() {
            let mut rng = stream(3, 90, K as u64);
            for _ in 0..2000 {
                let n = rng.random_range(5..40);
                let case = Case::random(&mut rng, n, 0.3, 0.0);
                let (lo, hi) = case.z.iter().fold((1.0f64, -1.0f64), |(l, h), &z| (l.min(z), h.max(z)));
                for (i, known) in case.classify::<f64, K>().into_iter().enumerate() {
                    let Pass2Input::Query([x, count, ln_b0], measure) = known else {
                        continue;
                    };
                    let own_x = |z: f64| (2.0 * z - lo - hi) / (hi - lo);
                    let others: Vec<(f64, f64)> = (0..n)
                        .filter(|&j| j != i)
                        .map(|j| (own_x(case.z[j]), absorbance(case.alpha[j])))
                        .collect();
                    let b0: f64 = others.iter().map(|o| o.1).sum();
                    let mut expected = vec![
                        own_x(case.z[i]),
                        (n as f64).log2() / 3.0 - 1.0,
                        (b0 + f64::from(ABSORBANCE_OFFSET)).ln(),
                    ];
                    for level in 0..K / 2 {
                        // ∫ x^k (1 − x²)^level dμ
                        let integral = |k: i32| {
                            others
                                .iter()
                                .map(|&(x, a)| a / b0 * x.powi(k) * (1.0 - x * x).powi(level as i32))
                                .sum::<f64>()
                        };
                        let mass = integral(0).max(1e-6);
                        let mean = integral(1) / mass;
                        let spread = (integral(2) / mass - mean * mean) / (1.0 - mean * mean);
                        // In f64 rounding fades nothing out here.
                        expected.extend([mean, if level == 0 { spread } else { spread.sqrt() }]);
                    }
                    let found: Vec<f64> = [x, count, ln_b0].into_iter().chain(measure).collect();
                    // Each level divides by the mass that the one before left.
                    for (k, (f, e)) in found.iter().zip(&expected).enumerate() {
                        let bar = [1e-9, 1e-7, 1e-5, 1e-3][k.saturating_sub(3) / 2];
                        let inner = others.iter().map(|&(x, a)| a / b0 * (1.0 - x * x).powi(3)).sum::<f64>();
                        assert!((f - e).abs() <= bar || inner < 1e-2, "K = {K}, column {k}: {f} for {e}");
                    }
                }
            }
        }
        compare::<4>();
        compare::<6>();
        compare::<8>();
    }

    /// Sums that no pixel has: finite features within their ranges, transmittances in [0, 1].
    #[test]
    fn nonsense_stays_in_range() {
        let mut rng = stream(4, 90, 0);
        let odd = [0.0f32, -0.0, 1e-39, 1e-20, 1e-7, 0.5, 1.0, 10.0, -3.0, 1e4];
        for _ in 0..200_000 {
            let mut pick = || odd[rng.random_range(0..odd.len())];
            let sums = PixelSums::<f32, 4> {
                b0: pick().abs(),
                b: [pick(), pick(), pick(), pick()],
                count: 3 + pick().abs() as u32,
                nearest: 1.0,
                farthest: 2.0,
            };
            let terms = FragmentTerms {
                view_z: 1.5,
                z: pick().clamp(-1.0, 1.0),
                absorbance: pick().abs().min(10.0),
            };
            let end = pick().clamp(-1.0, 1.0);
            match sums.classify(terms, [end, (end + pick().abs()).min(1.0)]) {
                Pass2Input::Solved(t) => assert!((0.0..=1.0).contains(&t), "{t}"),
                Pass2Input::Query([x, count, ln_b0], measure) => {
                    assert!((-1.0..=1.0).contains(&x) && count.is_finite() && ln_b0.is_finite());
                    assert!(measure.iter().all(|m| (-1.0..=1.0).contains(m)), "{measure:?}");
                }
            }
        }
    }
}
