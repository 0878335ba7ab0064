//! Eight f64 side by side, and the functions on them that random pixels need: to the bit what [`libm`] gives, at every
//! SIMD level.
//!
//! Published seeds are pinned to the bytes that `libm`'s functions gave them. `libm` follows fdlibm, so the functions
//! here do too: the same reduction, the same polynomials, multiplications and additions apart and in the same order,
//! eight times at once.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

/// Numbers in one vector.
pub const DOUBLES: usize = 8;

/// ln 2 in two parts; the first has so few bits that its product with an exponent is exact.
const LN_2: [f64; 2] = [
    f64::from_bits(0x3fe6_2e42_fee0_0000),
    f64::from_bits(0x3dea_39ef_3579_3c76),
];

/// π/2 in two parts; the first has 33 bits.
const HALF_PI: [f64; 2] = [
    f64::from_bits(0x3ff9_21fb_5440_0000),
    f64::from_bits(0x3dd0_b461_1a62_6331),
];

/// The least number whose upper half is greater than `high`.
const fn above(high: u32) -> f64 {
    f64::from_bits((high as u64 + 1) << 32)
}

/// Σ_i c\[i\] x^i, the bits of the coefficients given.
#[inline(always)]
fn polynomial<S: Simd, const N: usize>(simd: S, c: [u64; N], x: f64x8<S>) -> f64x8<S> {
    let mut p = f64x8::splat(simd, f64::from_bits(c[N - 1]));
    for i in (0..N - 1).rev() {
        p = f64x8::splat(simd, f64::from_bits(c[i])) + x * p;
    }
    p
}

/// e^x.
///
/// # Domain
/// |x| ≤ 700, so that the result is a normal number.
///
/// # Accuracy
/// [`libm::exp`] to the bit.
///
/// # Source
/// Sun Microsystems, fdlibm 5.3, 1993: e^r = 1 + 2r/(2 − c) by a rational function of r = x − k ln 2.
#[inline(always)]
pub fn exp<S: Simd>(simd: S, x: f64x8<S>) -> f64x8<S> {
    let splat = |v: f64| f64x8::splat(simd, v);
    let (zero, one) = (splat(0.0), splat(1.0));
    let size = x.abs();
    let k = (splat(std::f64::consts::LOG2_E) * x + splat(0.5).copysign(x)).trunc();
    let k = size.simd_ge(splat(above(0x3fd6_2e42))).select(k, zero);
    let (hi, lo) = (x - k * splat(LN_2[0]), k * splat(LN_2[1]));
    let r = hi - lo;
    let square = r * r;
    let p = polynomial(
        simd,
        [
            0x3fc5_5555_5555_553e,
            0xbf66_c16c_16be_bd93,
            0x3f11_566a_af25_de2c,
            0xbebb_bd41_c5d2_6bf1,
            0x3e66_3769_72be_a4d0,
        ],
        square,
    );
    let c = r - square * p;
    let y = one + ((r * c / (splat(2.0) - c) - lo) + hi);
    // Adding 1.5 · 2^52 leaves k in the lowest bits.
    let exponent = ((k + splat(1.5 * (1u64 << 52) as f64)).to_bits() + 1023) << 52;
    let y = y * f64x8::from_bits(exponent);
    size.simd_ge(splat(above(0x3e30_0000))).select(y, one + x)
}

/// Natural logarithm.
///
/// # Domain
/// Normal positive numbers.
///
/// # Accuracy
/// [`libm::log`] to the bit.
///
/// # Source
/// Sun Microsystems, fdlibm 5.3, 1993: x = 2^k (1 + f) with 1 + f in [√½, √2), and ln(1 + f) by a polynomial in s =
/// f/(2 + f).
#[inline(always)]
pub fn ln<S: Simd>(simd: S, x: f64x8<S>) -> f64x8<S> {
    let splat = |v: f64| f64x8::splat(simd, v);
    // The upper half of √½.
    const ROOT: u64 = 0x3fe6_a09e << 32;
    let bits = x.to_bits() + ((0x3ff0_0000 << 32) - ROOT);
    // The exponent field, as the lowest bits of 2^52, becomes a number.
    let k = f64x8::from_bits((bits >> 52) | 0x4330_0000_0000_0000) - splat((1u64 << 52) as f64 + 1023.0);
    let f = f64x8::from_bits((bits & 0x000f_ffff_ffff_ffff) + ROOT) - splat(1.0);
    let half_square = splat(0.5) * f * f;
    let s = f / (splat(2.0) + f);
    let z = s * s;
    let w = z * z;
    let odd = [0x3fd9_9999_9997_fa04, 0x3fcc_71c5_1d8e_78af, 0x3fc3_9a09_d078_c69f];
    let even = [
        0x3fe5_5555_5555_5593,
        0x3fd2_4924_9422_9359,
        0x3fc7_4664_96cb_03de,
        0x3fc2_f112_df3e_5244,
    ];
    let r = z * polynomial(simd, even, w) + w * polynomial(simd, odd, w);
    (((s * (half_square + r) + k * splat(LN_2[1])) - half_square) + f) + k * splat(LN_2[0])
}

/// Sine and cosine.
///
/// # Domain
/// From 0 to 2π.
///
/// # Accuracy
/// [`libm::sincos`] to the bit.
///
/// # Source
/// Sun Microsystems, fdlibm 5.3, 1993: reduction to [−π/4, π/4] by multiples of π/2, then polynomials.
#[inline(always)]
pub fn sincos<S: Simd>(simd: S, x: f64x8<S>) -> (f64x8<S>, f64x8<S>) {
    let splat = |v: f64| f64x8::splat(simd, v);
    let (zero, one) = (splat(0.0), splat(1.0));
    // The number of the quarter turn that x is next to, by the upper half of x.
    let mut quarter = zero;
    for high in [0x3fe9_21fb, 0x4002_d97c, 0x400f_6a7a, 0x4015_fdbc] {
        quarter += x.simd_ge(splat(above(high))).select(one, zero);
    }
    let turned = x - quarter * splat(HALF_PI[0]);
    let rest = quarter * splat(HALF_PI[1]);
    let y = turned - rest;
    let tail = (turned - y) - rest;
    let z = y * y;
    let (w, v) = (z * z, z * y);
    let bits = |bits: u64| f64x8::splat(simd, f64::from_bits(bits));
    let s1 = bits(0xbfc5_5555_5555_5549);
    let low = bits(0x3f81_1111_1110_f8a6) + z * (bits(0xbf2a_01a0_19c1_61d5) + z * bits(0x3ec7_1de3_57b1_fe7d));
    let r = low + (z * w) * (bits(0xbe5a_e5e6_8a2b_9ceb) + z * bits(0x3de5_d93a_5acf_d57c));
    let near = y + v * (s1 + z * r);
    let far = y - ((z * (splat(0.5) * tail - v * r) - tail) - v * s1);
    let sin = quarter.simd_eq(zero).select(near, far);
    let low = bits(0x3fa5_5555_5555_554c) + z * (bits(0xbf56_c16c_16c1_5177) + z * bits(0x3efa_01a0_19cb_1590));
    let high = bits(0xbe92_7e4f_809c_52ad) + z * (bits(0x3e21_ee9e_bdb4_b1c4) + z * bits(0xbda8_fae9_be88_38d4));
    let r = z * low + (w * w) * high;
    let half = splat(0.5) * z;
    let w = one - half;
    let cos = w + (((one - w) - half) + (z * r - y * tail));
    // Quarter turns: (s, c), (c, −s), (−s, −c), (−c, s), and (s, c) again.
    let (first, second, third) = (
        quarter.simd_eq(one),
        quarter.simd_eq(splat(2.0)),
        quarter.simd_eq(splat(3.0)),
    );
    let (odd, back, down) = (first | third, second | third, first | second);
    let (s, c) = (odd.select(cos, sin), odd.select(sin, cos));
    let (mut s, mut c) = (back.select(-s, s), down.select(-c, c));
    // Next to a multiple of π/2 the reduction cancels, and takes more digits of π than it has here.
    let high = x.to_bits() >> 32;
    let cancels = (high.simd_eq(0x3ff9_21fb) | high.simd_eq(0x4009_21fb))
        | (high.simd_eq(0x4012_d97c) | high.simd_eq(0x4019_21fb));
    if cancels.any_true() {
        let (x, lanes): ([f64; DOUBLES], u64) = (x.into(), cancels.to_bitmask());
        let (mut sines, mut cosines): ([f64; DOUBLES], [f64; DOUBLES]) = (s.into(), c.into());
        for lane in (0..DOUBLES).filter(|lane| lanes >> lane & 1 == 1) {
            (sines[lane], cosines[lane]) = libm::sincos(x[lane]);
        }
        (s, c) = (f64x8::from_slice(simd, &sines), f64x8::from_slice(simd, &cosines));
    }
    (s, c)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::rng::{Stream, stream};
    use fearless_simd::{Level, dispatch};
    use rand::Rng;

    /// Applies a function to all numbers, whose count is a multiple of eight.
    fn all<const N: usize>(x: &[f64], f: impl Fn(&[f64]) -> [[f64; DOUBLES]; N]) -> [Vec<f64>; N] {
        let mut out = std::array::from_fn(|_| Vec::new());
        for x in x.chunks_exact(DOUBLES) {
            for (out, values) in out.iter_mut().zip(f(x)) {
                out.extend(values);
            }
        }
        out
    }

    fn levels() -> [Level; 2] {
        [Level::new(), Level::baseline()]
    }

    fn units(rng: &mut Stream, n: usize) -> Vec<f64> {
        (0..n).map(|_| (rng.next_u64() >> 12) as f64 * f64::EPSILON).collect()
    }

    /// Numbers of every size below `most`, those of the given upper halves and their neighbours, and some more.
    fn arguments(most: f64, highs: &[u32], more: &[f64]) -> Vec<f64> {
        let mut rng = stream(3, 94, 0);
        let mut x: Vec<f64> = units(&mut rng, 200_000).iter().map(|u| most * u).collect();
        x.extend(units(&mut rng, 20_000).iter().map(|u| most * u * libm::exp(-100.0 * u)));
        for &high in highs {
            for high in high - 2..=high + 2 {
                let low: Vec<u32> = [0, 1, u32::MAX]
                    .into_iter()
                    .chain((0..50).map(|_| rng.next_u32()))
                    .collect();
                x.extend(
                    low.iter()
                        .map(|&low| f64::from_bits(u64::from(high) << 32 | u64::from(low))),
                );
            }
        }
        x.extend(more);
        x.resize(x.len().next_multiple_of(DOUBLES), 1.0);
        x
    }

    fn bits(x: impl IntoIterator<Item = f64>) -> Vec<u64> {
        x.into_iter().map(f64::to_bits).collect()
    }

    /// Against `libm` itself, at both ends of the SIMD levels. Control: the next argument has another result.
    #[test]
    fn bits_are_those_of_libm() {
        let x = arguments(
            20.0,
            &[0x3fd6_2e42, 0x3ff0_a2b2, 0x3e30_0000],
            &[0.0, -0.0, 700.0, -700.0, 1e-300],
        );
        let x: Vec<f64> = x
            .iter()
            .flat_map(|&x| [x, -x])
            .chain((-700..700).map(f64::from))
            .collect();
        let positive = arguments(
            2.0,
            &[0x3fe6_a09e, 0x3ff0_0000, 0x0010_0002, 0x7fef_fffd],
            &[1.0, 1.0 - f64::EPSILON, f64::MIN_POSITIVE, f64::MAX],
        );
        let positive: Vec<f64> = positive
            .into_iter()
            .map(|x| if x.is_normal() { x } else { 1.0 })
            .collect();
        let turn = std::f64::consts::TAU;
        let highs = [
            0x3fe9_21fb,
            0x4002_d97c,
            0x400f_6a7a,
            0x4015_fdbc,
            0x3ff9_21fb,
            0x4009_21fb,
            0x4012_d97c,
            0x3e46_a09e,
            0x3e40_0000,
        ];
        let angles = arguments(
            turn,
            &highs,
            &[
                0.0,
                turn,
                turn * (1.0 - f64::EPSILON),
                turn / 4.0,
                turn / 2.0,
                0.75 * turn,
                turn / 8.0,
            ],
        );
        for level in levels() {
            let [found] = all(
                &x,
                |x| dispatch!(level, simd => [exp(simd, f64x8::from_slice(simd, x)).into()]),
            );
            assert!(bits(found.clone()) == bits(x.iter().map(|&x| libm::exp(x))));
            assert_ne!(bits(found)[1..], bits(x.iter().map(|&x| libm::exp(x)))[..x.len() - 1]);
            let [found] = all(
                &positive,
                |x| dispatch!(level, simd => [ln(simd, f64x8::from_slice(simd, x)).into()]),
            );
            assert!(bits(found) == bits(positive.iter().map(|&x| libm::log(x))));
            let [sines, cosines] = all(&angles, |x| {
                dispatch!(level, simd => {
                    let (s, c) = sincos(simd, f64x8::from_slice(simd, x));
                    [s.into(), c.into()]
                })
            });
            assert!(bits(sines) == bits(angles.iter().map(|&x| libm::sincos(x).0)));
            assert!(bits(cosines) == bits(angles.iter().map(|&x| libm::sincos(x).1)));
        }
    }
}
