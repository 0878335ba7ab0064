//! Moments as render targets keep them: in single precision, in 16 bits after a linear transform, or as the non-linear
//! quantities that describe the distribution directly.

use crate::numeric::orthogonal::Orthogonal;
use crate::numeric::quantise::round_unorm16;

/// How the moments of a pixel are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MomentStorage {
    /// Double precision: no loss; the biases are those of single precision.
    F64,
    /// Single precision, rounded after every addition.
    F32,
    /// b_0 in half precision, the others divided by it, linearly transformed and kept in 16 bits each; rounded after
    /// every addition.
    Unorm16,
    /// b_0 in half precision and non-linear quantities in 16 bits each, converted once when all is added up.
    Nlqm,
}

impl MomentStorage {
    /// Suffix of a method's name.
    pub fn suffix(self) -> &'static str {
        match self {
            Self::F64 => "",
            Self::F32 => ":f32",
            Self::Unorm16 => ":unorm16",
            Self::Nlqm => ":nlqm",
        }
    }
}

/// Linear transform of the odd or of the even moments: quantised = v · forward + offset, v = (quantised − offset) ·
/// inverse.
#[derive(Debug, Clone, Copy)]
struct Part<const N: usize> {
    forward: [[f64; N]; N],
    inverse: [[f64; N]; N],
    offset: [f64; N],
}

/// The transforms of b_1, b_3, … and of b_2, b_4, ….
#[derive(Debug, Clone, Copy)]
struct Transform<const N: usize> {
    odd: Part<N>,
    even: Part<N>,
}

// Constants of MKKP18's supplementary document, dimensionless.

/// Transform of 4 power moments.
const TRANSFORM_4: Transform<2> = Transform {
    odd: Part {
        forward: [[1.5, 0.8660254037844386], [-2.0, -0.3849001794597504]],
        inverse: [[-0.3333333333333333, -0.75], [1.7320508075688772, 1.299038105676658]],
        offset: [0.5, 0.5],
    },
    even: Part {
        forward: [[4.0, 0.5], [-4.0, 0.5]],
        inverse: [[0.125, -0.125], [1.0, 1.0]],
        offset: [0.0, 0.0],
    },
};

/// Transform of 6 power moments.
const TRANSFORM_6: Transform<3> = Transform {
    odd: Part {
        forward: [
            [2.5, -1.8749986445, 1.26583039016],
            [-10.0, 4.20757543111, -1.47644882902],
            [8.0, -1.83257678661, 0.71061660238],
        ],
        inverse: [
            [-0.02877789192, 0.09995235706, 0.25893353755],
            [0.47635550422, 0.84532580931, 0.90779616657],
            [1.55242808973, 1.05472570761, 0.83327335647],
        ],
        offset: [0.5, 0.5, 0.5],
    },
    even: Part {
        forward: [
            [4.0, 9.0, -0.57759806484],
            [-4.0, -24.0, 4.61936647543],
            [0.0, 16.0, -3.07953906655],
        ],
        inverse: [
            [1.253044e-05, -0.24998746956, -0.37498825271],
            [0.16668494186, 0.16668494186, 0.21876713299],
            [0.86602540579, 0.86602540579, 0.81189881793],
        ],
        offset: [0.0, 0.0, 0.018888946],
    },
};

/// Transform of 8 power moments.
const TRANSFORM_8: Transform<4> = Transform {
    odd: Part {
        forward: [
            [3.48044635732474, 1.26797185782836, -2.1671560004294, 0.974332879165755],
            [
                -27.5760737514826,
                -0.928755808743913,
                6.17950199592966,
                -0.443426830933027,
            ],
            [
                55.1267384344761,
                -2.07520453231032,
                -0.276515571579297,
                -0.360491648368785,
            ],
            [
                -31.531111040318304,
                1.23598848322588,
                -4.23583042392097,
                0.310149466050223,
            ],
        ],
        inverse: [
            [
                -0.0048239970850238,
                -0.0233402218644408,
                -0.010888537031885,
                -0.0308713357806732,
            ],
            [
                -0.423201508674231,
                -0.832829097046478,
                -0.926393772997063,
                -0.937989172670245,
            ],
            [
                0.0348312382605129,
                0.0193406040499625,
                -0.11723394414779,
                -0.218033377677099,
            ],
            [1.67179208266592, 1.21021509068975, 0.983723301818275, 0.845991731322996],
        ],
        offset: [0.5, 0.5, 0.5, 0.5],
    },
    even: Part {
        forward: [
            [
                0.280504133158527,
                -2.01362265883247,
                -7.310104949853209,
                -15.8954215629556,
            ],
            [
                -0.757633844606942,
                0.221551373038988,
                13.9855979699139,
                79.6186327084103,
            ],
            [
                0.392179589334688,
                -1.06107954265125,
                -0.114305766176437,
                -127.45727899250198,
            ],
            [-0.887531871812237, 2.83887201588367, -7.4361899359832, 63.7349456687829],
        ],
        inverse: [
            [
                -0.976220278891035,
                -1.04828341778299,
                -1.03115268628604,
                -0.996038443434636,
            ],
            [
                -0.456139260269401,
                -0.229726640510149,
                -0.077844420809897,
                0.0175438624416783,
            ],
            [
                -0.0504335521016742,
                0.0259608334616091,
                0.0044340885101426,
                -0.0361414253243963,
            ],
            [
                0.0008388003906511,
                -0.0013363269320586,
                -0.0103744938457406,
                -0.0031783999402272,
            ],
        ],
        offset: [0.972481993925964, 1.0, 0.999179192513328, 0.991778293073131],
    },
};

fn row_times<const N: usize>(v: [f64; N], matrix: &[[f64; N]; N]) -> [f64; N] {
    std::array::from_fn(|j| (0..N).map(|i| v[i] * matrix[i][j]).sum())
}

impl<const N: usize> Part<N> {
    fn store(&self, v: [f64; N], round: impl Fn(f64) -> f64) -> [f64; N] {
        let mut q = row_times(v, &self.forward);
        for (q, offset) in q.iter_mut().zip(self.offset) {
            *q = round(*q + offset) - offset;
        }
        row_times(q, &self.inverse)
    }
}

/// What comes back of normalised power moments b_1..b_2N that were kept in 16 bits each: a linear transform that fills
/// the range of a 16-bit fraction, rounding, and back.
///
/// # Source
/// MKKP18 Sec. 4.1 and supplementary document.
///
/// # Shapes
/// `normalised: [M]`, M = 2N + 1 one of 5, 7, 9; b_0 = 1 stands first and is left alone.
///
/// # Panics
/// For another M.
pub fn through_unorm16<const M: usize>(normalised: [f64; M]) -> [f64; M] {
    fn with<const N: usize, const M: usize>(
        transform: &Transform<N>,
        b: [f64; M],
        round: impl Fn(f64) -> f64 + Copy,
    ) -> [f64; M] {
        let odd = transform.odd.store(std::array::from_fn(|i| b[2 * i + 1]), round);
        let even = transform.even.store(std::array::from_fn(|i| b[2 * i + 2]), round);
        std::array::from_fn(|k| match k {
            0 => b[0],
            k if k % 2 == 1 => odd[k / 2],
            k => even[k / 2 - 1],
        })
    }
    match M {
        5 => with(&TRANSFORM_4, normalised, round_unorm16),
        7 => with(&TRANSFORM_6, normalised, round_unorm16),
        9 => with(&TRANSFORM_8, normalised, round_unorm16),
        _ => panic!("{M} moments: only 5, 7 and 9 are defined"),
    }
}

/// One step of a 16-bit fraction.
const STEP: f64 = 1.0 / 65535.0;

/// What comes back of regularised moments of mass 1 that were kept as 2N non-linear quantities of 16 bits each: N
/// depths and N − 1 shares of the distribution that has the moments but the last, and the square root of how far the
/// last moment lies between its least and its greatest possible value.
///
/// Quantities are never rounded to where the distribution would degenerate: depths stay apart by a step, shares stay
/// positive.
///
/// # Source
/// The idea, depths and shares instead of four moments, is C. Peters' (*Non-linearly quantized moment shadow maps*, HPG
/// 2017); the encoding of the last quantity and the generalisation to 6 and 8 moments are this program's own.
///
/// # Shapes
/// `moments: [2N + 1]`, those of a measure of mass 1 on [−1, 1], regularised.
pub fn through_nlqm<const N: usize, const M: usize>(moments: &[f64; M]) -> Orthogonal<f64, N> {
    let polynomials = Orthogonal::<f64, N>::from_moments(moments);
    let (depths, shares) = polynomials.gauss();
    let stored_place = (polynomials.last_norm() / polynomials.greatest_last_norm(-1.0, 1.0)).sqrt();
    let mut kept = depths.map(|z| round_unorm16(0.5 * z + 0.5));
    for i in 0..N {
        let least = if i == 0 { STEP } else { kept[i - 1] + STEP };
        kept[i] = kept[i].min(1.0 - (N - i) as f64 * STEP).max(least);
    }
    let depths = kept.map(|q| 2.0 * q - 1.0);
    // The last share is what the others leave.
    let mut rest = 1.0;
    let mut kept_shares = shares;
    for i in 0..N - 1 {
        let left = (N - 1 - i) as f64 * STEP;
        kept_shares[i] = round_unorm16(shares[i]).max(STEP).min(rest - left);
        rest -= kept_shares[i];
    }
    kept_shares[N - 1] = rest;
    // A moment vector that is not a measure's shows here as NaN and stays NaN.
    let place = round_unorm16(stored_place);
    let place = if place < STEP { STEP } else { place };
    let free = Orthogonal::<f64, N>::from_atoms(&depths, &kept_shares, 1.0);
    Orthogonal::from_atoms(
        &depths,
        &kept_shares,
        place * place * free.greatest_last_norm(-1.0, 1.0),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::moments::hamburger::Bias;
    use crate::moments::power::power_moments;
    use crate::pixel::MomentDepth;
    use proptest::prelude::*;

    fn normalised<const M: usize>(fragments: &[(f64, f64)]) -> [f64; M] {
        let (z, a): (Vec<_>, Vec<_>) = fragments.iter().map(|&(z, a)| (MomentDepth(z), a)).unzip();
        let b: [f64; M] = power_moments(&z, &a);
        b.map(|x| x / b[0])
    }

    fn worst<const M: usize>(a: [f64; M], b: [f64; M]) -> f64 {
        a.iter().zip(b).fold(0.0, |worst, (a, b)| {
            if (a - b).is_nan() {
                f64::NAN
            } else {
                f64::max(worst, (a - b).abs())
            }
        })
    }

    proptest! {
        /// Without rounding the transforms are inverse to each other to the digits they are printed with (1e-9, 1e-5
        /// for eight); with it a moment moves by at most the rounding half step times the inverse's column sum, 5e-5,
        /// and does move.
        #[test]
        fn linear_transforms(fragments in prop::collection::vec((-1.0f64..=1.0, 0.01f64..2.0), 1..20)) {
            let (four, six, eight) = (normalised::<5>(&fragments), normalised::<7>(&fragments),
                normalised::<9>(&fragments));
            let exact = |b: f64| b;
            let part = |b: [f64; 5], p: &Part<2>, first: usize| worst(p.store([b[first], b[first + 2]], exact),
                [b[first], b[first + 2]]);
            prop_assert!(part(four, &TRANSFORM_4.odd, 1) < 1e-9 && part(four, &TRANSFORM_4.even, 2) < 1e-9);
            let back = [worst(through_unorm16(four), four), worst(through_unorm16(six), six),
                worst(through_unorm16(eight), eight)];
            prop_assert!(back.iter().all(|&e| e > 0.0 && e < 5e-5), "{back:?}");
        }

        /// Bounds after the non-linear storage stay near those before. Tolerance 1e-2 of the mass for four moments
        /// biased by 1e-3, and never NaN.
        #[test]
        fn non_linear_quantities(fragments in prop::collection::vec((-1.0f64..=1.0, 0.01f64..2.0), 1..20),
            z in -1.0f64..=1.0) {
            let bias = Bias { strength: 1e-3, ..Bias::single_precision(4) };
            let moments = bias.apply(normalised::<5>(&fragments));
            let (before, after) = (Orthogonal::<f64, 2>::from_moments(&moments).bounds(z).blend(0.25),
                through_nlqm::<2, 5>(&moments).bounds(z).blend(0.25));
            prop_assert!((before - after).abs() < 1e-2, "{before} {after}");
            for strength in [5e-7, 1e-9] {
                let single = Bias { strength, ..bias }.apply(normalised::<5>(&fragments[..1]));
                prop_assert!(through_nlqm::<2, 5>(&single).bounds(z).upper.is_finite());
            }
        }
    }
}
