//! Sixteen f32 side by side, and the functions on them that kernels need.
//!
//! Everything in this file multiplies and adds apart, so that it gives the same bits at every SIMD level; fused
//! multiply-adds are left to the kernels that say so.

use fearless_simd::prelude::*;
use fearless_simd::{f32x16, i32x16};

/// Numbers in one [`Lanes`].
pub const LANES: usize = 16;

/// Sixteen f32, aligned to a cache line: what kernels load and store at once.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(64))]
pub struct Lanes(pub [f32; LANES]);

impl Lanes {
    /// Sixteen zeros.
    pub const ZERO: Self = Self([0.0; LANES]);

    /// As a vector.
    #[inline(always)]
    pub fn load<S: Simd>(&self, simd: S) -> f32x16<S> {
        f32x16::from_slice(simd, &self.0)
    }

    /// From a vector.
    #[inline(always)]
    pub fn store<S: Simd>(&mut self, v: f32x16<S>) {
        v.store_slice(&mut self.0);
    }
}

/// [`std::array::from_fn`] that is always inlined. What lanes go through must be: functions of the standard library are
/// compiled without the vectors of the level in use, so that they call for each number and hand it on in memory.
#[inline(always)]
pub fn array<T: Copy, const N: usize>(mut f: impl FnMut(usize) -> T) -> [T; N] {
    if N == 0 {
        return std::array::from_fn(f);
    }
    let mut out = [f(0); N];
    for (i, out) in out.iter_mut().enumerate().skip(1) {
        *out = f(i);
    }
    out
}

/// e^x.
///
/// # Domain
/// Arguments are clamped to [−87.33, 88.37], so that the result is a normal number; NaN gives either end.
///
/// # Accuracy
/// At most 2 ULP there; measured by `exp_and_ln_stay_within_their_ulps`.
///
/// # Source
/// Cody–Waite reduction by ln 2 in two parts; the polynomial is the Taylor series of (e^r − 1 − r)/r² on |r| ≤ ln 2 / 2
/// to degree 5, which leaves 6e-9.
#[inline(always)]
pub fn exp<S: Simd>(simd: S, x: f32x16<S>) -> f32x16<S> {
    let splat = |v: f32| f32x16::splat(simd, v);
    let x = x.max(splat(-87.33)).min(splat(88.37));
    let n = (x * splat(std::f32::consts::LOG2_E)).round_ties_even();
    // The first part of ln 2 has 9 bits: its product with n is exact.
    let r = (x - n * splat(0.693_359_4)) + n * splat(2.121_944_4e-4);
    let mut p = splat(1.0 / 5040.0);
    for c in [1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5] {
        p = p * r + splat(c);
    }
    let y = (p * (r * r) + r) + splat(1.0);
    let n: i32x16<S> = n.to_int();
    y * ((n + 127) << 23).bitcast::<f32x16<S>>()
}

/// Natural logarithm.
///
/// # Domain
/// Normal positive numbers; anything else gives garbage, never a trap.
///
/// # Accuracy
/// At most 2 ULP; measured by `exp_and_ln_stay_within_their_ulps`.
///
/// # Source
/// x = 2^e m with m in [√½, √2); ln m = 2 atanh(s), s = (m − 1)/(m + 1), by the odd series of atanh to degree 11, which
/// leaves 3e-11.
#[inline(always)]
pub fn ln<S: Simd>(simd: S, x: f32x16<S>) -> f32x16<S> {
    let splat = |v: f32| f32x16::splat(simd, v);
    let bits: i32x16<S> = x.bitcast();
    // Adding the distance from √½ to 1 makes the exponent field count from √½.
    let shifted = bits + (0x3f80_0000 - 0x3f35_04f3);
    let e = (shifted >> 23) - 127;
    let m: f32x16<S> = (bits - (e << 23)).bitcast();
    let e: f32x16<S> = e.to_float();
    let t = m - splat(1.0);
    let s = t / (m + splat(1.0));
    let q = s * s;
    let mut p = splat(1.0 / 11.0);
    for c in [1.0 / 9.0, 1.0 / 7.0, 1.0 / 5.0, 1.0 / 3.0] {
        p = p * q + splat(c);
    }
    // 2s = t − s t: the leading term stays exact where m is near 1.
    let small = e * splat(-2.121_944_4e-4) + s * (splat(2.0) * (p * q) - t);
    (small + t) + e * splat(0.693_359_4)
}

/// 1/(1 + e^−x).
#[inline(always)]
pub fn sigmoid<S: Simd>(simd: S, x: f32x16<S>) -> f32x16<S> {
    let one = f32x16::splat(simd, 1.0);
    one / (one + exp(simd, -x))
}

#[cfg(test)]
mod tests {
    use super::*;
    use fearless_simd::{Level, dispatch};

    fn on_lanes(level: Level, x: &[f32], f: impl Fn(Level, &Lanes) -> Lanes) -> Vec<f32> {
        x.chunks_exact(LANES)
            .flat_map(|c| f(level, &Lanes(c.try_into().unwrap())).0)
            .collect()
    }

    fn exp_of(level: Level, x: &Lanes) -> Lanes {
        let mut out = Lanes::ZERO;
        dispatch!(level, simd => out.store(exp(simd, x.load(simd))));
        out
    }

    fn ln_of(level: Level, x: &Lanes) -> Lanes {
        let mut out = Lanes::ZERO;
        dispatch!(level, simd => out.store(ln(simd, x.load(simd))));
        out
    }

    /// Distance in units in the last place of the exact value.
    fn ulps(found: f32, exact: f64) -> f64 {
        let near = exact as f32;
        let ulp = f64::from(f32::from_bits(near.abs().to_bits() + 1)) - f64::from(near.abs());
        let off = (f64::from(found) - exact).abs() / ulp;
        if off.is_nan() { f64::INFINITY } else { off }
    }

    fn levels() -> Vec<Level> {
        vec![Level::new(), Level::baseline()]
    }

    /// Over the whole domain in small steps, against f64. Control: the same bound fails for the argument one step on.
    #[test]
    fn exp_and_ln_stay_within_their_ulps() {
        let arguments: Vec<f32> = (0..1_000_000).map(|i| -87.3 + 175.6 * i as f32 / 1e6).collect();
        let positive: Vec<f32> = (0..2_000_000u32)
            .map(|i| f32::from_bits(0x0080_0000 + i * 1065))
            .collect();
        let near_one: Vec<f32> = (0..1_600_000u32)
            .map(|i| f32::from_bits(0x3f00_0000 + i * 10))
            .collect();
        for level in levels() {
            let worst = |x: &[f32], found: &[f32], exact: &dyn Fn(f64) -> f64| {
                assert!(!found.is_empty());
                x.iter()
                    .zip(found)
                    .map(|(&x, &y)| ulps(y, exact(x.into())))
                    .fold(0.0, f64::max)
            };
            let found = on_lanes(level, &arguments, exp_of);
            assert!(
                worst(&arguments, &found, &libm::exp) <= 2.0,
                "{}",
                worst(&arguments, &found, &libm::exp)
            );
            assert!(worst(&arguments, &found[LANES..], &libm::exp) > 2.0);
            for x in [&positive, &near_one] {
                let found = on_lanes(level, x, ln_of);
                assert!(worst(x, &found, &libm::log) <= 2.0, "{}", worst(x, &found, &libm::log));
            }
        }
    }

    #[test]
    fn every_level_gives_the_same_bits() {
        let x: Vec<f32> = (0..160_000u32)
            .map(|i| f32::from_bits(0x3a00_0000 + i * 1009))
            .collect();
        let [a, b] =
            [Level::new(), Level::baseline()].map(|level| (on_lanes(level, &x, exp_of), on_lanes(level, &x, ln_of)));
        assert_eq!(a, b);
    }

    #[test]
    fn ends_are_finite() {
        let x = [
            f32::NEG_INFINITY,
            -1e30,
            -100.0,
            100.0,
            1e30,
            f32::INFINITY,
            0.0,
            -0.0,
            f32::NAN,
            1.0,
            2.0,
            3.0,
            4.0,
            5.0,
            6.0,
            7.0,
        ];
        let y = exp_of(Level::new(), &Lanes(x)).0;
        assert!(y.iter().all(|y| y.is_normal()), "{y:?}");
        assert_eq!((y[6], y[7]), (1.0, 1.0));
    }
}
