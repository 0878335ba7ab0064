//! The formulas of the recentred features, each once, for every kind of number: reference code, lanes, devices and
//! shader source.

use super::{
    ABSORBANCE_OFFSET, ARITHMETIC, ByCount, INNER_MEAN_DEVIATION, INNER_SPREAD_DEVIATION, INNER_SPREAD_OF_OFFSET,
    INNER_SPREAD_OF_SPREAD, MAX_ABSORBANCE, MEAN_DEVIATION, MIN_HALF_RANGE, MIN_MASS, NOISE_GROWTH, Rounding,
    SPREAD_DEVIATION, THIN, USUAL_INNER_SPREAD, USUAL_SPREAD,
};
use crate::numeric::lanes;
use crate::numeric::real::{Divisor, Real, c, square};

/// Share of a pixel's absorbance up to which the others of a fragment count as none.
pub const ALONE: f64 = 1e-6;

/// Absorbance of a fragment, min(−ln(1 − alpha), 10).
///
/// # Source
/// MKKP18 Sec. 3.1; the series of −ln(1 − alpha) where a rounded 1 − alpha would keep little of alpha.
#[inline(always)]
pub fn absorbance<R: Real>(alpha: R) -> R {
    R::step(
        "absorbance",
        "Absorbance of a fragment, min(-ln(1 - alpha), 10), accurate for faint fragments too.",
        [("alpha", alpha)],
        #[inline(always)]
        |[alpha]| {
            let series = c(0.33333334) + alpha * (c(0.25) + alpha * c(0.2));
            let faint = (alpha * (c(1.0) + alpha * (c(0.5) + alpha * series))).named("faint");
            R::select(alpha.lt(c(0.03)), faint, -(c(1.0) - alpha).max(c(0.000045399931)).ln())
        },
    )
}

/// ln(a/b), as accurate relative to itself where a is near b as elsewhere: a quotient near 1 keeps little of what made
/// it differ from 1, and devices' logarithms are coarse there.
#[inline(always)]
pub fn log_ratio<R: Real>(a: R, b: R) -> R {
    R::step(
        "log_ratio",
        "ln(a / b), as accurate relative to itself where a is near b as elsewhere.",
        [("a", a), ("b", b)],
        #[inline(always)]
        |[a, b]| {
            // ln(a/b) = 2 artanh(s)
            let s = ((a - b) / (a + b)).named("s");
            let q = square(s).named("q");
            let series = c(0.33333334) + q * (c(0.2) + q * (c(0.14285715) + q * c(0.11111111)));
            R::select(s.abs().lt(c(0.2)), (s + s) * (c(1.0) + q * series), (a / b).ln())
        },
    )
}

/// Moment depth of view depth v between v0 and v1; 0 where they are equal.
///
/// # Source
/// MKKP18 Sec. 3.3.
#[inline(always)]
pub fn moment_depth<R: Real>(v: R, [v0, v1]: [R; 2]) -> R {
    R::step(
        "moment_depth",
        "Moment depth of view depth v; v0 and v1 are the least and the greatest of the scene. Where a prepass has \
         found the pixel's own nearest and farthest view depth, these may be v0 and v1 in both passes: then no pixel \
         is too thin for its moments.",
        [("v", v), ("v0", v0), ("v1", v1)],
        #[inline(always)]
        |[v, v0, v1]| {
            let warped = c(2.0) * log_ratio(v, v0) / log_ratio(v1, v0).max(c(1e-30)) - c(1.0);
            R::select(v1.gt(v0), warped.clamp(c(-1.0), c(1.0)), v.like(0.0))
        },
    )
}

/// What a fragment adds to b_1..b_K; pass 2 takes away the same numbers.
#[inline(always)]
pub fn moments<R: Real, const K: usize>(z: R, absorbance: R) -> [R; K] {
    R::step_array(
        "moments",
        "Pass 1: what a fragment at moment depth z adds to b1, b2 and so on; to b0 it adds its absorbance, to n it \
            adds 1.",
        [("z", z), ("absorbance", absorbance)],
        ("", []),
        "own",
        #[inline(always)]
        |[z, absorbance], []| {
            let mut term = absorbance;
            lanes::array(
                #[inline(always)]
                |k| {
                    term = (term * z).named_at("moment", k + 1);
                    term
                },
            )
        },
    )
}

/// Absorbance of the other fragments, b_0'.
#[inline(always)]
pub fn others<R: Real>(b0: R, absorbance: R) -> R {
    (b0 - absorbance).clamp(c(0.0), c(MAX_ABSORBANCE))
}

/// m_1..m_K, the moments of the others in the pixel's own range, in [−1, 1] whatever rounding has done.
#[inline(always)]
fn recentred_moments<R: Real, const K: usize>(
    z: R,
    absorbance: R,
    centre: R,
    per_h: R,
    per_b0: R,
    b: [R; K],
) -> [R; K] {
    R::step_array(
        "recentred_moments",
        "Moments of the other fragments in the pixel's own range, centre c and half-range 1 / per_h, normalised by \
         their absorbance 1 / per_b0.",
        [
            ("z", z),
            ("absorbance", absorbance),
            ("c", centre),
            ("per_h", per_h),
            ("per_b0", per_b0),
        ],
        ("b", b),
        "m",
        #[inline(always)]
        |[z, absorbance, centre, per_h, per_b0], b| {
            let own = moments::<R, K>(z, absorbance);
            let mut m: [R; K] = lanes::array(|k| ((b[k] - own[k]) * per_b0).named_at("m", k + 1));
            m[0] = m[0].note("Moments of z - c, one factor at a time.");
            // E[z^{k−j} (z − c)^j] = E[z^{k−j+1} (z − c)^{j−1}] − c E[z^{k−j} (z − c)^{j−1}]
            for pass in 0..K {
                for k in (pass..K).rev() {
                    let shifted = if k == 0 {
                        m[k] - centre
                    } else {
                        m[k] - centre * m[k - 1]
                    };
                    m[k] = shifted.named_at("m", k + 1);
                }
            }
            // No factor overflows, so that 0 stays 0 however thin the pixel.
            let h2 = square(per_h).named("per_h2");
            let powers = [per_h, h2, (h2 * per_h).named("per_h3"), square(h2).named("per_h4")];
            lanes::array(
                #[inline(always)]
                |k| {
                    let scaled = if k < 4 {
                        m[k] * powers[k]
                    } else {
                        m[k] * powers[3] * powers[k - 4]
                    };
                    scaled.clamp(c(-1.0), c(1.0))
                },
            )
        },
    )
}

/// Whether the range of a pixel is so small that places in it are those of view depth.
#[inline(always)]
pub fn is_thin<R: Real>(nearest: R, farthest: R) -> R::Mask {
    ((farthest - nearest) / nearest).lt(c(THIN))
}

/// Place of a view depth between the nearest and the farthest of a thin pixel, in [−1, 1].
#[inline(always)]
pub fn place_in_thin<R: Real>(v: R, nearest: R, farthest: R) -> R {
    R::step(
        "place_in_thin",
        "Place of view depth v in the range of a thin pixel, in [-1, 1], where view depth says more than moment depth.",
        [("v", v), ("nearest", nearest), ("farthest", farthest)],
        #[inline(always)]
        |[v, nearest, farthest]| {
            let range = (farthest - nearest).named("range");
            let t = ((v - nearest) / range.max(c(1e-30))).named("t");
            // ln(1 + r t)/ln(1 + r) to the first order in r = range/nearest
            let x = (t * (c(1.0) + c(0.5) * (range / nearest) * (c(1.0) - t))).named("x");
            (x + x - c(1.0)).clamp(c(-1.0), c(1.0))
        },
    )
}

/// A value or, as the noise in it grows beyond its usual deviation, what is expected of it.
#[inline(always)]
fn shrink_to_prior<R: Real>(value: R, expected: R, noise: R, deviation: R) -> R {
    R::step(
        "shrink_to_prior",
        "Shrinks a noisy value towards what is expected of it, as far as the noise exceeds the usual deviation.",
        [
            ("value", value),
            ("expected", expected),
            ("noise", noise),
            ("deviation", deviation),
        ],
        #[inline(always)]
        |[value, expected, noise, deviation]| {
            // So that its square does not overflow.
            let bounded = noise.min(c(1e15)).named("bounded");
            let trust = square(deviation).named("trust");
            expected + (value - expected) * (trust / (trust + square(bounded)))
        },
    )
}

/// Share of the others' absorbance in front of one of three fragments: the other two are the ends, and their mean says
/// how they share.
#[inline(always)]
pub fn share_of_three<R: Real>(mean: R) -> R {
    (c(0.5) - c(0.5) * mean).clamp(c(0.0), c(1.0))
}

/// Share of the others' absorbance in front of place x in a pixel of four.
///
/// The nearest and the farthest are known atoms at −1 and 1; (1 − x²) μ holds the third alone, so its place u is the
/// inner mean. With (1 − m_2) = (1 − u²) a for its mass a, the ends weigh (1 ∓ m_1 − (1 − m_2)/(1 ± u))/2. In front lie
/// the near end and, where it is nearer than x, the third: all but the far end then, which says the same and is well
/// conditioned where the near end is not. Rounding leaves u uncertain by the transition width; so much to either side
/// of it the one goes over to the other, and as mean, spread and inner mean fade to what is expected, so does the
/// share: it is continuous in the moments.
#[inline(always)]
pub fn share_of_four<R: Real>(x: R, [mean, spread, u]: [R; 3], transition_width: R) -> R {
    R::step(
        "share_of_four",
        "Share of the others' absorbance in front of place x in a pixel of four: atoms at -1, u and 1 have this mean \
         and spread. Within the transition width of u, in front and behind go over into one another.",
        [
            ("x", x),
            ("mean", mean),
            ("spread", spread),
            ("u", u),
            ("transition_width", transition_width),
        ],
        #[inline(always)]
        |[x, mean, spread, u, transition_width]| {
            // 1 − m_2
            let inner = ((c(1.0) - spread) * (c(1.0) - mean * mean)).named("inner");
            let end =
                |toward: R, u_toward: R| (c(0.5) * (toward - inner / u_toward.max(c(MIN_MASS)))).clamp(c(0.0), c(1.0));
            let near = end(c(1.0) - mean, c(1.0) + u).named("near_end");
            let far = end(c(1.0) + mean, c(1.0) - u).named("far_end");
            let behind = (c(0.5) + c(0.5) * (x - u) / transition_width)
                .clamp(c(0.0), c(1.0))
                .named("behind");
            (near + behind * (c(1.0) - far - near)).clamp(c(0.0), c(1.0))
        },
    )
}

/// T = e^−A, never above 1 however coarse the exponential.
#[inline(always)]
pub fn transmittance<R: Real>(absorbance: R) -> R {
    (-absorbance).exp().min(c(1.0))
}

impl ByCount {
    #[inline(always)]
    fn of<R: Real>(self, per_n: R) -> R {
        c(self.many) + c(self.few) * per_n
    }
}

/// A fragment and the sums of its pixel, as pass 2 meets them.
#[derive(Debug, Clone, Copy)]
pub struct Pass2<R, const K: usize> {
    /// Moment depth of the fragment.
    pub z: R,
    /// Its absorbance.
    pub absorbance: R,
    /// Total absorbance of the pixel, Σ A.
    pub b0: R,
    /// Σ A z^k, k = 1..=K.
    pub b: [R; K],
    /// Number of fragments of the pixel.
    pub n: R,
    /// Centre of the pixel's range of moment depth.
    pub centre: R,
    /// Half of that range; see [`half_range`].
    pub half_range: R,
}

/// Centre and half of a pixel's range of moment depth, from the moment depths of its nearest and farthest view depth.
#[inline(always)]
pub fn half_range<R: Real>([z_nearest, z_farthest]: [R; 2]) -> [R; 2] {
    let centre = (c(0.5) * (z_nearest + z_farthest)).named("c");
    [centre, (c(0.5) * (z_farthest - z_nearest)).max(c(MIN_HALF_RANGE))]
}

/// The other fragments of a pixel, seen from the pixel's own range.
#[derive(Debug, Clone, Copy)]
pub struct Others<R, const K: usize> {
    /// Their absorbance, b_0'.
    pub absorbance: R,
    /// m_1..m_K.
    pub m: [R; K],
    /// Place of the fragment in the pixel's range by moment depth; in thin pixels [`place_in_thin`] says more.
    pub along: R,
    /// How much more rounding does to each next moment.
    pub noise_growth: R,
    /// Half of the pixel's range.
    pub half_range: Divisor<R>,
    /// [`Self::absorbance`], and never 0.
    left: Divisor<R>,
}

impl<R: Real, const K: usize> Others<R, K> {
    /// Takes the fragment's own terms out of the sums and moves the moments to the pixel's range; `absorbance` is
    /// [`others`].
    #[inline(always)]
    pub fn new(p: &Pass2<R, K>, absorbance: R) -> Self {
        // Where next to nothing is left its moments are not used, and stay finite.
        let left = Divisor::new(absorbance.max(p.b0 * c(ALONE)).max(c(1e-30))).named("per_b0");
        let half_range = Divisor::new(p.half_range).named("per_h");
        Self {
            absorbance,
            m: recentred_moments(p.z, p.absorbance, p.centre, half_range.reciprocal, left.reciprocal, p.b),
            along: (p.z - p.centre).over(half_range).clamp(c(-1.0), c(1.0)),
            noise_growth: (c(1.0) + (c(2.0) * p.centre.abs()).over(half_range)).named("noise_growth"),
            half_range,
            left,
        }
    }

    /// With what rounding has done to their moments.
    #[inline(always)]
    pub fn rounded(self, p: &Pass2<R, K>, rounding: Rounding<R>) -> Rounded<R, K> {
        let moment_noise = (rounding.unit * self.noise_growth * p.b0)
            .over(self.left)
            .named("moment_noise");
        Rounded {
            others: self,
            moment_noise,
            noise1: (moment_noise * rounding.usual(p.n)).named("noise1"),
            n: p.n,
            per_n: (c(1.0) / p.n).named("per_n"),
        }
    }
}

/// The other fragments of a pixel by moments that rounding may have made noise of.
///
/// As the noise of a mean or a spread grows beyond what it differs from pixel to pixel anyhow, it goes over to what the
/// moments before it lead to expect: the inner mean and spread to about those of the beta law that has the measure's
/// mean and spread, the spread to what is usual, the mean to 0. So a pixel that is ever thinner for its storage is
/// described by four moments, then by two, then by its mean, without a jump. From the fifth moment on a mean goes to 0
/// and a spread to ½.
#[derive(Debug, Clone, Copy)]
pub struct Rounded<R, const K: usize> {
    others: Others<R, K>,
    /// What one rounding may have done to m_1.
    moment_noise: R,
    /// What rounding usually has done to m_1.
    noise1: R,
    n: R,
    per_n: R,
}

/// What four moments say of a measure and of what is left of it as (1 − x²) takes its ends out.
#[derive(Debug, Clone, Copy)]
pub struct Description<R> {
    /// Mean and spread.
    mean0: R,
    spread0: R,
    /// Mean of (1 − x²) times the measure.
    mean1: R,
    /// How far the latter may usually be off, by noise or, where that is more than is known anyhow, by what it differs
    /// from pixel to pixel.
    transition_width: R,
    /// One over the mass of (1 − x²) times the measure.
    per_mass1: R,
    /// What rounding usually has done to m_4.
    noise4: R,
}

impl<R: Real> Description<R> {
    /// [`share_of_four`]
    #[inline(always)]
    pub fn share_of_four(&self, x: R) -> R {
        share_of_four(x, [self.mean0, self.spread0, self.mean1], self.transition_width)
    }
}

impl<R: Real, const K: usize> Rounded<R, K> {
    /// Mean of the measure.
    #[inline(always)]
    pub fn mean(&self) -> R {
        let m1 = self.others.m[0];
        shrink_to_prior(m1, m1.like(0.0), self.noise1, MEAN_DEVIATION.of(self.per_n)).named("mean0")
    }

    /// Spread of the measure, whose mean is [`Self::mean`].
    #[inline(always)]
    fn spread(&self, mean0: R, noise2: R) -> R {
        let most0 = (c(1.0) - square(mean0)).max(c(MIN_MASS)).named("most0");
        let raw = ((self.others.m[1] - square(mean0)) / most0)
            .clamp(c(0.0), c(1.0))
            .named("raw_spread0");
        let (expected, deviation) = (USUAL_SPREAD.of(self.per_n), SPREAD_DEVIATION.of(self.per_n));
        shrink_to_prior(raw, expected, noise2 / most0, deviation).named("spread0")
    }

    /// Spread and inner mean of the measure, whose mean is [`Self::mean`]; for K of 4 and more.
    #[inline(always)]
    pub fn describe(&self, mean0: R) -> Description<R> {
        let m = &self.others.m;
        let further = (self.others.noise_growth * c(NOISE_GROWTH)).named("further");
        let noise2 = (self.noise1 * further).named("noise2");
        let noise3 = (noise2 * further).named("noise3");
        let spread0 = self.spread(mean0, noise2);
        let per_mass1 = (c(1.0) / (c(1.0) - m[1]).max(c(MIN_MASS)))
            .note("The same of (1 - x^2) times the measure, which does not hold the ends.")
            .named("per_mass1");
        let raw = ((m[0] - m[2]) * per_mass1).clamp(c(-1.0), c(1.0)).named("raw_mean1");
        let expected = (mean0 * (c(1.0) - spread0) / (c(1.0) + spread0)).named("expected_mean1");
        let deviation = (INNER_MEAN_DEVIATION.of(self.per_n) * (spread0 + c(0.02))).named("deviation");
        let noise = (noise3 * per_mass1).named("noise");
        let all = (noise + c(ARITHMETIC * R::ROUNDING) * per_mass1).named("all_noise");
        Description {
            mean0,
            spread0,
            mean1: shrink_to_prior(raw, expected, noise, deviation).named("mean1"),
            transition_width: (all * deviation / (all + deviation)).named("transition_width"),
            per_mass1,
            noise4: noise3 * further,
        }
    }

    /// The first three columns: x, count, ln_b0.
    #[inline(always)]
    pub fn first_columns(&self, x: R) -> [R; 3] {
        // log2(n)/3 − 1
        let count = self.n.ln() * c(std::f64::consts::LOG2_E / 3.0) - c(1.0);
        [
            x,
            count,
            (self.others.absorbance + c(f64::from(ABSORBANCE_OFFSET))).ln(),
        ]
    }

    /// The other columns, mean and spread in turn, level by level; for K of 4 and more.
    #[inline(always)]
    pub fn columns(&self, d: &Description<R>) -> [R; K] {
        let mut out = [d.mean0; K];
        (out[1], out[2], out[3]) = (d.spread0, d.mean1, self.inner_spread(d));
        if K > 4 {
            self.beyond(&mut out);
        }
        out
    }

    /// The columns of two moments alone.
    #[inline(always)]
    pub fn two_columns(&self) -> [R; 2] {
        let mean0 = self.mean();
        [
            mean0,
            self.spread(mean0, self.noise1 * (self.others.noise_growth * c(NOISE_GROWTH))),
        ]
    }

    #[inline(always)]
    fn inner_spread(&self, d: &Description<R>) -> R {
        let Description {
            mean0, spread0, mean1, ..
        } = *d;
        let m = &self.others.m;
        let most1 = (c(1.0) - square(mean1)).max(c(MIN_MASS)).named("most1");
        let raw = (((m[1] - m[3]) * d.per_mass1 - square(mean1)) / most1)
            .clamp(c(0.0), c(1.0))
            .named("raw_square1");
        let deviation = INNER_SPREAD_DEVIATION.of(self.per_n) * (spread0 + c(0.02));
        let offset = (mean1 * (c(1.0) + spread0) - mean0 * (c(1.0) - spread0)).named("offset");
        let square0 = square(spread0).named("square0");
        let usual = USUAL_INNER_SPREAD.of(self.per_n) + c(INNER_SPREAD_OF_SPREAD) * square0 * square0
            - c(INNER_SPREAD_OF_OFFSET) * offset * offset;
        let expected = usual * spread0 / (c(1.0) + spread0 + spread0);
        let expected = expected.clamp(c(0.0), c(1.0)).named("expected_square1");
        let square1 = shrink_to_prior(raw, expected, d.noise4 * d.per_mass1 / most1, deviation);
        square1.sqrt().named("spread1")
    }

    /// Moments of (1 − x²)² μ and so on: differences of differences, faded out as rounding leaves noise of them.
    #[inline(always)]
    fn beyond(&self, out: &mut [R; K]) {
        let one = self.n.like(1.0);
        let mut q = [one; 9];
        q[1..=K].copy_from_slice(&self.others.m);
        for level in 1..K / 2 {
            for k in 0..=K - 2 * level {
                q[k] = (q[k] - q[k + 2]).named_at("q", k);
            }
            if level == 1 {
                continue;
            }
            let per_mass = (c(1.0) / q[0].max(c(MIN_MASS))).named_at("per_mass", level);
            let mean = (q[1] * per_mass).clamp(c(-1.0), c(1.0)).named_at("raw_mean", level);
            let most = (c(1.0) - square(mean)).max(c(MIN_MASS));
            let spread = ((q[2] * per_mass - square(mean)) / most).clamp(c(0.0), c(1.0)).sqrt();
            let growth = self.others.noise_growth;
            let noise = (1..2 * level)
                .fold(self.moment_noise * growth, |noise, _| noise * growth)
                .named("noise");
            let mean = mean * trust(noise * per_mass);
            out[2 * level] = mean.named_at("mean", level);
            let spread = c(0.5) + (spread - c(0.5)) * trust(noise * growth * per_mass);
            out[2 * level + 1] = spread.named_at("spread", level);
        }
    }
}

/// 1/(1 + noise²)
#[inline(always)]
fn trust<R: Real>(noise: R) -> R {
    let rounded = noise.named("rounded");
    c(1.0) / (c(1.0) + square(rounded))
}
