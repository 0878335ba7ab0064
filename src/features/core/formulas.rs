//! Arithmetic of core and tail, each formula once, over every kind of number.

use super::FIXED;
use crate::numeric::lanes;
use crate::numeric::real::{Real, c};

/// Added to b_0'' before its logarithm is taken, so that a faint tail stays finite.
pub const ABSORBANCE_OFFSET: f32 = 0.05;

/// Least absorbance of a tail that is divided by.
const MIN_ABSORBANCE: f64 = 1e-12;

/// Least mass of (1 − x²) times the tail that is divided by.
const MIN_MASS: f64 = 1e-6;

/// How much of the uniform law's moments is blended into those that bounds are taken of.
const BOUNDS_BIAS: f64 = 1e-4;

/// Least variance of a tail that bounds are taken of.
const MIN_VARIANCE: f64 = 1e-7;

/// Roundings of a sum that two places may be apart and still be taken for one.
const ROUNDINGS: f64 = 16.0;

/// Moments b_k − A z^k: a measure without one fragment. The products are those that were added, in the same order.
#[inline(always)]
pub fn without<R: Real, const N: usize>(b: [R; N], absorbance: R, z: R) -> [R; N] {
    let mut term = absorbance;
    lanes::array(|k| {
        let rest = b[k] - term;
        term *= z;
        rest
    })
}

/// Moments of (z − c)/h from those of z, not normalised.
#[inline(always)]
pub fn recentred<R: Real, const N: usize>(b: [R; N], center: R, per_h: R) -> [R; N] {
    let mut m = b;
    // One factor at a time: ∫ z^(k−j) (z − c)^j = ∫ z^(k−j+1) (z − c)^(j−1) − c ∫ z^(k−j) (z − c)^(j−1).
    for pass in 0..N - 1 {
        for k in (pass + 1..N).rev() {
            m[k] -= center * m[k - 1];
        }
    }
    let mut scale = per_h;
    for m in &mut m[1..] {
        *m *= scale;
        scale *= per_h;
    }
    m
}

/// Absorbance of a tail, at least 0.
#[inline(always)]
pub fn absorbance_of<R: Real, const N: usize>(tail: [R; N]) -> R {
    tail[0].clamp(c(0.0), c(1e30))
}

/// Normalised moments m_1..m_M of a tail, each in [−1, 1] whatever rounding has done; the first is m_0 = 1.
#[inline(always)]
pub fn normalised<R: Real, const N: usize>(tail: [R; N]) -> [R; N] {
    let per = (c(1.0) / tail[0].max(c(MIN_ABSORBANCE))).named("per_b0");
    lanes::array(|k| {
        if k == 0 {
            tail[0].like(1.0)
        } else {
            (tail[k] * per).clamp(c(-1.0), c(1.0))
        }
    })
}

/// Means and spreads of a measure with moments 1, m_1.., then of (1 − x²) times it, and so on. Each spread is the
/// variance
/// as a share of the greatest that the mean allows; from the second on it is the root of that.
#[inline(always)]
pub fn described<R: Real, const N: usize>(m: [R; N]) -> [R; N] {
    let mut q = m;
    let mut out = m;
    let mut first = 1;
    while first < N {
        let per_mass = c(1.0) / q[0].max(c(MIN_MASS));
        let mean = (q[1] * per_mass).clamp(c(-1.0), c(1.0)).named("mean");
        out[first] = mean;
        let left = N - first;
        if left > 1 {
            let most = (c(1.0) - mean * mean).max(c(MIN_MASS));
            let spread = ((q[2] * per_mass - mean * mean) / most).clamp(c(0.0), c(1.0));
            out[first + 1] = if first == 1 { spread } else { spread.sqrt() };
            for k in 0..left - 1 {
                q[k] -= q[k + 2];
            }
        }
        first += 2;
    }
    out
}

/// How far a place that comes from sums may be off, in the pixel's own range: `total` is b_0, `tail` b_0''.
#[inline(always)]
pub fn place_noise<R: Real>(total: R, tail: R, center: R, per_h: R) -> R {
    total / tail.max(c(MIN_ABSORBANCE)) * (per_h + center.abs() * per_h) * c(ROUNDINGS * R::ROUNDING)
}

/// Whether what lies at `place` is in front of x: 0 at the same depth step and behind, 1 from the step before on, and
/// in
/// between where the place is off by `noise`. `step` is one depth step in the pixel's own range.
#[inline(always)]
pub fn in_front<R: Real>(x: R, place: R, step: R, noise: R) -> R {
    ((x - place - step * c(0.25)) / (step * c(0.5) + noise)).clamp(c(0.0), c(1.0))
}

/// Share in front of x of a tail that is one fragment: it lies at the mean.
#[inline(always)]
pub fn share_of_one<R: Real>(x: R, mean: R, step: R, noise: R) -> R {
    in_front(x, mean, step, noise)
}

/// Share in front of x of a tail that is two fragments, from its moments m_1..m_3: the nodes of the quadrature of
/// Gauss.
#[inline(always)]
pub fn share_of_two<R: Real>(x: R, m: [R; 3], step: R, noise: R) -> R {
    let [m1, m2, m3] = m;
    let variance = (m2 - m1 * m1).max(c(1e-9)).named("variance");
    // About the mean the nodes sum to the third moment over the variance, and multiply to minus the variance.
    let third = m3 - c(3.0) * m1 * m2 + c(2.0) * m1 * m1 * m1;
    let sum = (third / variance).clamp(c(-2.0), c(2.0)).named("sum");
    let root = (sum * sum + c(4.0) * variance).sqrt().named("root");
    let near = (c(0.5) * (sum - root)).named("near");
    let far = (c(0.5) * (sum + root)).named("far");
    let of_near = (far / root).clamp(c(0.0), c(1.0)).named("of_near");
    let place = x - m1;
    // Places err the more, the nearer together the two lie.
    let noise = noise + noise / variance.sqrt().max(c(1e-4));
    of_near * in_front(place, near, step, noise) + (c(1.0) - of_near) * in_front(place, far, step, noise)
}

/// Share in front of x by the beta law that has the measure's mean and spread, without a network: the log-odds of a
/// beta variable as a normal one with a little skewness, and the normal law's distribution function as a sigmoid.
///
/// # Accuracy
/// Within 0.0025 of the beta law's distribution function, root mean square over means in ±0.7 and spreads from 0.02 to
/// 0.45, and 0.04 at worst; the constants are fitted to that.
#[inline(always)]
pub fn share_by_law<R: Real>(x: R, mean: R, spread: R) -> R {
    R::step(
        "share_by_law",
        "Share of the tail in front of x by the beta law with its mean and spread.",
        [("x", x), ("mean", mean), ("spread", spread)],
        #[inline(always)]
        |[x, mean, spread]| {
            let x = x.clamp(c(-0.9999), c(0.9999)).named("place");
            let middle = (c(0.5) + c(0.5) * mean).clamp(c(1e-3), c(0.999)).named("middle");
            let total = (c(1.0) / spread.clamp(c(1e-4), c(0.95)) - c(1.0)).named("total");
            let a = (middle * total).named("a");
            let b = (total - a).max(c(1e-5)).named("b");
            let per_a = (c(1.0) / a).named("per_a");
            let per_b = (c(1.0) / b).named("per_b");
            let odds =
                ((c(1.0) + x) / (c(1.0) - x) * (b + c(0.394)) / (a + c(0.394))).ln() + c(0.885) * (per_a - per_b);
            let variance =
                c(1.0) / (a + c(0.168)) + c(1.0) / (b + c(0.168)) + c(0.516) * (per_a * per_a + per_b * per_b);
            let y = (odds / variance.sqrt()).named("y");
            let skew = (c(0.222) * (per_a.sqrt() - per_b.sqrt())).named("skew");
            // Where the parabola would turn back it stays.
            let turned = y * skew * c(2.0);
            let y = R::select(turned.lt(c(-1.0)), c(-0.5) / skew, y).named("held");
            let normal = (y + skew * (y * y - c(1.0))).clamp(c(-8.0), c(8.0)).named("normal");
            let logit = normal * (c(1.5976) + c(0.07056) * normal * normal);
            c(1.0) / (c(1.0) + (-logit).exp())
        },
    )
}

/// What moments say of the share of a measure that lies in front of a place.
#[derive(Debug, Clone, Copy)]
pub struct Bounds<R> {
    /// The least share and the greatest.
    pub share: [R; 2],
    /// By how much more they err than the moments that they come from.
    pub gain: R,
}

/// Markov's bounds: the least share of a measure on \[−1, 1\] with these moments, the first 1, that may lie in front
/// of x, and the greatest. They are those of the measure of the fewest points that has its moments and a point at x: x
/// and one more where there are two or three moments, x and two more where there are four. Where those leave \[−1, 1\]
/// both ends take the place of one of them. Of the two measures the one with less mass at x is inside.
///
/// # Source
/// Akhiezer, *The Classical Moment Problem*, 1965, Sec. 2.5; Kreĭn and Nudel'man, *The Markov Moment Problem and
/// Extremal Problems*, 1977, Ch. III and IV, of measures on an interval. The bounds of moment-based transparency
/// (MKKP18 Sec. 3.2) are those of measures on the whole line, of all of the pixel. Here they are of the tail alone and
/// about its mean, where the polynomials need no system of equations.
///
/// # Accuracy
/// Moments are blended with those of the uniform law by `BOUNDS_BIAS`, which keeps the bounds of few points finite
/// and smooth, and moves them by about as much.
#[inline(always)]
pub fn bounds<R: Real, const N: usize>(x: R, m: [R; N]) -> Bounds<R> {
    let [lower, upper, gain] = match N {
        0..=2 => bounds_of_one(x, m[1]),
        3..=4 => bounds_of_two(x, [m[1], m[2.min(N - 1)]]),
        _ => bounds_of_four(x, lanes::array(|k| m[(k + 1).min(N - 1)])),
    };
    Bounds {
        share: [lower, upper],
        gain,
    }
}

/// What bounds are called in shaders.
const BOUNDS: (&str, &str) = (
    "bounds",
    "Least and greatest share of the tail that may lie in front of x, from its moments, and by how much more they err \
     than these: Markov's bounds.",
);

/// A moment with a little of the uniform law's.
#[inline(always)]
fn biased<R: Real>(m: R, uniform: f64) -> R {
    m * c(1.0 - BOUNDS_BIAS) + c(uniform * BOUNDS_BIAS)
}

/// [`bounds`] from the mean alone.
#[inline(always)]
fn bounds_of_one<R: Real>(x: R, mean: R) -> [R; 3] {
    [
        ((x - mean) / (c(1.0) + x).max(c(MIN_MASS))).clamp(c(0.0), c(1.0)),
        ((c(1.0) - mean) / (c(1.0) - x).max(c(MIN_MASS))).clamp(c(0.0), c(1.0)),
        x.like(1.0),
    ]
}

/// [`bounds`] from two moments.
#[inline(always)]
fn bounds_of_two<R: Real>(x: R, m: [R; 2]) -> [R; 3] {
    R::step_array(
        BOUNDS.0,
        BOUNDS.1,
        [("x", x), ("m1", m[0]), ("m2", m[1])],
        ("", []),
        "bounds",
        #[inline(always)]
        |[x, m1, m2], []| {
            let mean = (m1 * c(1.0 - BOUNDS_BIAS)).named("mean");
            let second = biased(m2, 1.0 / 3.0).named("second");
            let variance = (second - mean * mean).max(c(MIN_VARIANCE)).named("variance");
            let place = (x - mean).named("place");
            let at = (variance / (variance + place * place)).named("at");
            let lower = R::select(place.lt(c(0.0)), x.like(0.0), c(1.0) - at).named("lower");
            // Both ends and x.
            let ended = ((c(1.0) - second) / (c(1.0) - x * x).max(c(MIN_MASS))).named("ended");
            let at_end = c(0.5) * (c(1.0) - mean - ended * (c(1.0) - x));
            let [lower, at] = inside([lower, at], [at_end, ended]);
            [lower, lower + at, c(1.0) / variance]
        },
    )
}

/// [`bounds`] from four moments.
#[inline(always)]
fn bounds_of_four<R: Real>(x: R, m: [R; 4]) -> [R; 3] {
    R::step_array(
        BOUNDS.0,
        BOUNDS.1,
        [("x", x), ("m1", m[0]), ("m2", m[1]), ("m3", m[2]), ("m4", m[3])],
        ("", []),
        "bounds",
        #[inline(always)]
        |[x, m1, m2, m3, m4], []| {
            let mean = (m1 * c(1.0 - BOUNDS_BIAS)).named("mean");
            let second = biased(m2, 1.0 / 3.0).named("second");
            let third = (m3 * c(1.0 - BOUNDS_BIAS)).named("third");
            let fourth = biased(m4, 0.2).named("fourth");
            let square = (mean * mean).named("square");
            // Central moments, in units of the deviation: skewness g and kurtosis d + g² + 1.
            let variance = (second - square).max(c(MIN_VARIANCE)).named("variance");
            let per_deviation = (c(1.0) / variance.sqrt()).named("per_deviation");
            let per_variance = (per_deviation * per_deviation).named("per_variance");
            let central3 = third - mean * (c(3.0) * second - c(2.0) * square);
            let central4 = fourth - mean * (c(4.0) * third - mean * (c(6.0) * second - c(3.0) * square));
            let g = (central3 * per_variance * per_deviation)
                .clamp(c(-30.0), c(30.0))
                .named("skewness");
            let d = (central4 * per_variance * per_variance - g * g - c(1.0))
                .clamp(c(1e-3), c(1e4))
                .named("d");
            // The orthonormal polynomials at y: 1, y and √d q. Mass 1/Σ of their squares is the most that may lie at x.
            let y = ((x - mean) * per_deviation).named("y");
            let per_d = (c(1.0) / d).named("per_d");
            let q = ((y * (y - g) - c(1.0)) * per_d).named("q");
            let at = (c(1.0) / (c(1.0) + y * y + q * q * d)).named("at");
            let rest = (c(1.0) - at).named("rest");
            // The other two points are the roots of q u² + (y − q g) u + 1 − q: one on either side of y where q < 0,
            // both on one side of it elsewhere.
            let linear = (y - q * g).named("linear");
            let per_root =
                (c(1.0) / (linear * linear - c(4.0) * q * (c(1.0) - q)).max(c(1e-12)).sqrt()).named("per_root");
            let between = c(0.5) * rest * (c(1.0) + linear * per_root) - at * y * q * per_root;
            let between = between.clamp(c(0.0), rest).named("between");
            let outside = R::select(y.gt(c(0.5) * g), rest, x.like(0.0));
            let lower = R::select(q.lt(c(0.0)), between, outside).named("lower");
            let [lower, at] = inside([lower, at], with_both_ends(x, [mean, second, third, fourth]));
            [lower, lower + at, per_variance * per_variance * per_d]
        },
    )
}

/// The measure with less mass at x of two: least share in front of it, and mass at it.
#[inline(always)]
fn inside<R: Real>([lower, at]: [R; 2], [lower_ended, ended]: [R; 2]) -> [R; 2] {
    let is_ended = ended.lt(at);
    [
        R::select(is_ended, lower_ended, lower).named("least"),
        R::select(is_ended, ended, at).named("most"),
    ]
}

/// The measure of both ends, x and a fourth point that has these moments: share in front of x, and mass at it. That
/// mass is the bound of two moments of (1 − x²) times the measure.
#[inline(always)]
fn with_both_ends<R: Real>(x: R, [mean, second, third, fourth]: [R; 4]) -> [R; 2] {
    let inner = (c(1.0) - second).max(c(MIN_MASS)).named("inner");
    let per_inner = (c(1.0) / inner).named("per_inner");
    let inner_mean = ((mean - third) * per_inner).named("inner_mean");
    let inner_second = ((second - fourth) * per_inner).named("inner_second");
    let width = (inner_second - inner_mean * inner_mean)
        .max(c(MIN_VARIANCE))
        .named("width");
    let place = (inner_mean - x).named("place");
    let of_inner = (width / (width + place * place)).named("of_inner");
    let ended = (inner * of_inner / (c(1.0) - x * x).max(c(MIN_MASS))).named("ended");
    // Mass at the end in front where the fourth point lies behind x; mirrored where it lies in front.
    let is_mirrored = place.lt(c(0.0));
    let side = R::select(is_mirrored, x.like(-1.0), x.like(1.0)).named("side");
    let away = (place.abs() + inner_second - x * inner_mean).max(c(MIN_MASS));
    let of_fourth = (inner * (c(1.0) - of_inner) * place.abs() / away).named("of_fourth");
    let at_end = c(0.5) * (c(1.0) - side * mean - ended * (c(1.0) - side * x) - of_fourth);
    let at_end = at_end.clamp(c(0.0), (c(1.0) - ended).max(c(0.0))).named("at_end");
    [R::select(is_mirrored, c(1.0) - ended - at_end, at_end), ended]
}

/// How far rounding of the sums in f32 has moved [`bounds`] at the most, but for a fragment in a thousand: `total` is
/// b_0, `tail` b_0''. What it may have moved them in theory is ten times as much.
#[inline(always)]
pub fn bounds_noise<R: Real, const N: usize>(total: R, tail: R, [center, per_h]: [R; 2], gain: R) -> R {
    // Each further moment in the pixel's own range is off by so much more.
    let growth = (c(1.0) + center.abs()) * per_h + c(1.0);
    let square = growth * growth;
    let (growth, share) = match N {
        0..=2 => (growth, 0.5),
        3..=4 => (square, 0.5),
        _ => (square * square, 0.125),
    };
    total / tail.max(c(MIN_ABSORBANCE)) * growth * gain * c(share * R::ROUNDING)
}

/// The greatest and the least T that bounds of the share in front allow, where rounding may have moved them by `noise`.
#[inline(always)]
pub fn allowed<R: Real>(front: R, tail: R, [lower, upper]: [R; 2], noise: R) -> [R; 2] {
    [
        transmittance(front, tail, (lower - noise).max(c(0.0))),
        transmittance(front, tail, (upper + noise).min(c(1.0))),
    ]
}

/// The features that stand in front of means and spreads: x, count, ln_b0, lower, upper. `count` and `tail` are number
/// and absorbance of the tail, `[lower, upper]` the bounds of its share in front.
#[inline(always)]
pub fn fixed_features<R: Real>(x: R, count: R, tail: R, [lower, upper]: [R; 2]) -> [R; FIXED] {
    [x, count_feature(count), absorbance_feature(tail), lower, upper]
}

/// log2(n)/3 − 1
#[inline(always)]
fn count_feature<R: Real>(n: R) -> R {
    n.log2() * c(1.0 / 3.0) - c(1.0)
}

/// ln(b_0'' + 0.05)
#[inline(always)]
fn absorbance_feature<R: Real>(tail: R) -> R {
    (tail + c(0.05)).ln()
}

/// T = exp(−front − b_0'' s), never above 1.
#[inline(always)]
pub fn transmittance<R: Real>(front: R, tail: R, share: R) -> R {
    (-(front + tail * share)).exp().min(c(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::rng::stream;
    use rand::RngExt;

    /// The law against values of the beta distribution from SciPy (`scipy.stats.beta.cdf`), within 0.06; it rises from
    /// 0 to 1.
    /// Control: the law of the mirrored mean.
    #[test]
    fn the_law_is_near_the_beta_law() {
        for (x, mean, spread, exact) in BETA {
            let found = share_by_law(x, mean, spread);
            assert!(
                (found - exact).abs() <= 0.03,
                "{x} {mean} {spread}: {found} for {exact}"
            );
            assert!(mean == 0.0 || (share_by_law(x, -mean, spread) - exact).abs() > 0.03);
            let mut before = 0.0;
            for i in 0..=100 {
                let share = share_by_law(-1.0 + 0.02 * f64::from(i), mean, spread);
                assert!(share >= before && share <= 1.0);
                before = share;
            }
        }
        for x in [-1.0f32, 0.0, 1.0] {
            for mean in [-1.0, 0.0, 1.0] {
                for spread in [0.0, 0.5, 1.0] {
                    assert!((0.0..=1.0).contains(&share_by_law(x, mean, spread)));
                }
            }
        }
    }

    /// x, mean and spread on [−1, 1], and the distribution function.
    const BETA: [(f64, f64, f64, f64); 8] = [
        (0.1, 0.3, 0.1, 0.253729),
        (-0.5, -0.4, 0.05, 0.337604),
        (0.8, 0.6, 0.2, 0.618397),
        (-0.2, -0.3, 0.3, 0.611016),
        (0.0, 0.25, 0.02, 0.037970),
        (0.5, 0.4, 0.5, 0.422826),
        (-0.7, -0.5, 0.15, 0.335249),
        (0.3, 0.2, 0.01, 0.845287),
    ];

    /// Bounds hold for random measures of one to twelve points to 1e-3, in f64 and in f32, and are often narrow.
    /// Control: the bounds of the mirrored place.
    #[test]
    fn shares_lie_within_their_bounds() {
        let mut rng = stream(1, 123, 0);
        let (mut broken, mut wide) = (0, 0);
        for round in 0..20_000 {
            let n = 1 + round % 12;
            let points: Vec<(f64, f64)> = (0..n)
                .map(|_| (rng.random_range(0.01..1.0), rng.random_range(-1.0..1.0)))
                .collect();
            let total: f64 = points.iter().map(|p| p.0).sum();
            let m: [f64; 5] =
                std::array::from_fn(|k| points.iter().map(|(a, z)| a * z.powi(k as i32)).sum::<f64>() / total);
            let x = rng.random_range(-1.0..1.0);
            let share = points.iter().filter(|p| p.1 < x).map(|p| p.0).sum::<f64>() / total;
            let check = |[lower, upper]: [f64; 2], slack: f64| {
                assert!(lower >= 0.0 && upper <= 1.0 + 1e-6 && lower <= upper, "{lower} {upper}");
                assert!(
                    lower - slack <= share && share <= upper + slack,
                    "{share} in {lower} to {upper}: {points:?} at {x}"
                );
            };
            check(bounds(x, [m[0], m[1]]).share, 1e-9);
            check(bounds(x, [m[0], m[1], m[2]]).share, 1e-3);
            let four = bounds(x, m).share;
            check(four, 1e-3);
            check(bounds(x as f32, m.map(|m| m as f32)).share.map(f64::from), 1e-3);
            let [lower, upper] = bounds(-x, m).share;
            broken += usize::from(share < lower - 3e-2 || share > upper + 3e-2);
            wide += usize::from(four[1] - four[0] > 0.5);
        }
        assert!(broken > 2000 && wide < 10_000, "{broken} {wide}");
    }

    /// The uniform law's bounds at points of quadratures: Gauss's of three points in the middle, Lobatto's of three and
    /// of four points, whose ends are those of the interval. To 1e-9.
    /// Control: a place beside the point.
    #[test]
    fn bounds_of_the_uniform_law_are_quadratures() {
        let [two, four] = [[1.0, 0.0, 1.0 / 3.0, 0.0, 0.0], [1.0, 0.0, 1.0 / 3.0, 0.0, 0.2]];
        let at = 0.2f64.sqrt();
        for (x, found, expected) in [
            (0.0, bounds(0.0, [two[0], two[1], two[2]]), [1.0 / 6.0, 5.0 / 6.0]),
            (0.0, bounds(0.0, four), [5.0 / 18.0, 13.0 / 18.0]),
            (at, bounds(at, four), [0.5, 11.0 / 12.0]),
            (-at, bounds(-at, four), [1.0 / 12.0, 0.5]),
        ] {
            for (found, expected) in found.share.iter().zip(expected) {
                assert!((found - expected).abs() <= 1e-9, "{x}: {found} for {expected}");
            }
        }
        assert!((bounds(at + 0.01, four).share[0] - 0.5).abs() > 1e-3);
    }

    /// Bounds of sums in f32 differ from those in f64 by no more than the noise that is foreseen, in all but a
    /// thousandth of random pixels, thin ones and deep ones, out of which heavy fragments are taken.
    /// Control: a thirtieth of that noise is not enough for as many.
    #[test]
    fn rounding_stays_within_the_noise() {
        fn of<R: Real, const N: usize>(fragments: &[[f32; 2]], heavy: usize, place: f32, zero: R) -> (Bounds<R>, R, R) {
            let numbers = |values: &[f32; 2]| values.map(|value| zero.like(value.into()));
            let mut b = [zero; N];
            for fragment in fragments {
                let [z, mut term] = numbers(fragment);
                for b in &mut b {
                    *b += term;
                    term *= z;
                }
            }
            let total = b[0];
            for fragment in &fragments[..heavy] {
                let [z, absorbance] = numbers(fragment);
                b = without(b, absorbance, z);
            }
            let [near, far] = [f32::min, f32::max].map(|of| fragments.iter().map(|f| f[0]).reduce(of).unwrap());
            let [near, far] = numbers(&[near, far]);
            let center = (near + far) * c(0.5);
            let per_h = zero.like(1.0) / ((far - near) * c(0.5));
            let tail = recentred(b, center, per_h);
            let x = (zero.like(place.into()) - center) * per_h;
            let bounds = bounds(x, normalised(tail));
            let noise = bounds_noise::<R, N>(total, absorbance_of(tail), [center, per_h], bounds.gain);
            (bounds, noise, absorbance_of(tail))
        }
        fn exceeded<const N: usize>(fragments: &[[f32; 2]], heavy: usize, place: f32) -> [bool; 2] {
            let (short, noise, tail) = of::<f32, N>(fragments, heavy, place, 0.0);
            let (exact, ..) = of::<f64, N>(fragments, heavy, place, 0.0);
            let off = short
                .share
                .iter()
                .zip(exact.share)
                .map(|(s, e)| (f64::from(*s) - e).abs());
            let off = off.fold(0.0, f64::max);
            // Beyond that no fragment is spared.
            let is_asked = tail > 1e-6 && noise < 0.05;
            [1.0, 1.0 / 30.0].map(|share| is_asked && off > f64::from(noise * share) + 1e-6)
        }
        const ROUNDS: usize = 40_000;
        let mut rng = stream(2, 123, 0);
        let mut found = [[0; 2]; 2];
        for round in 0..ROUNDS {
            let n = 6 + round % 60;
            let half: f32 = 10f32.powf(rng.random_range(-2.0..0.0));
            let center = rng.random_range(-1.0..1.0) * (1.0 - half);
            let thickness = 10f32.powf(rng.random_range(-3.0..1.0));
            let mut fragments: Vec<[f32; 2]> = (0..n)
                .map(|_| {
                    [
                        center + half * rng.random_range(-1.0..1.0),
                        thickness * rng.random_range(0.01..1.0),
                    ]
                })
                .collect();
            fragments.sort_by(|a, b| b[1].total_cmp(&a[1]));
            let (heavy, place) = (rng.random_range(0..5), fragments[5][0]);
            let of_both = [
                exceeded::<3>(&fragments, heavy, place),
                exceeded::<5>(&fragments, heavy, place),
            ];
            for (sum, more) in found.iter_mut().flatten().zip(of_both.into_iter().flatten()) {
                *sum += usize::from(more);
            }
        }
        for [all, thirtieth] in found {
            assert!(all <= ROUNDS / 1000 && thirtieth > ROUNDS / 1000, "{found:?}");
        }
    }

    /// Recentring against its definition, in f64.
    #[test]
    fn recentred_moments_follow_their_definition() {
        let fragments = [(0.3, 0.1), (1.5, -0.2), (0.7, 0.25)];
        let (center, h) = (0.05, 0.3);
        let sums = |place: &dyn Fn(f64) -> f64| -> [f64; 7] {
            std::array::from_fn(|k| fragments.iter().map(|(a, z)| a * place(*z).powi(k as i32)).sum())
        };
        let (found, expected) = (recentred(sums(&|z| z), center, 1.0 / h), sums(&|z| (z - center) / h));
        for (f, e) in found.iter().zip(expected) {
            assert!((f - e).abs() <= 1e-9, "{f} for {e}");
        }
        let left = fragments.iter().fold(sums(&|z| z), |b, &(a, z)| without(b, a, z));
        assert!(left.iter().all(|b| b.abs() <= 1e-12));
    }
}
