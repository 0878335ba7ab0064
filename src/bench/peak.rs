//! The multiply-add peak: how many floating-point operations a second all cores can do at most, as a yardstick for
//! kernels.
//!
//! Chains of f32 multiply-adds that depend on nothing but themselves, held in registers: no memory, no loads, nothing
//! but the arithmetic units. Matrix multiplication reaches a little less. At SIMD levels without a fused multiply-add,
//! it is a multiplication and an addition.

use super::Subject;
use crate::model::kernel::wide;
use crate::numeric::lanes::{self, LANES};
use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, f32x16};
use std::hint::black_box;

/// Multiply-adds of a chain in one call: enough to outweigh waking the threads.
const LENGTH: usize = 1 << 18;

/// Chains that hide a multiply-add's latency and fit the registers: vectors of sixteen where 32 registers hold one
/// each, half as many otherwise.
const WIDE_CHAINS: usize = 16;
const NARROW_CHAINS: usize = 6;

#[inline(always)]
fn chains<S: Simd, const N: usize>(simd: S) -> (f32, u64) {
    // x ← 0.999 x + 0.001 tends to 1 from anywhere: no denormal numbers, no infinities, and nothing for a compiler to
    // foresee.
    let (factor, summand) = (
        f32x16::splat(simd, black_box(0.999)),
        f32x16::splat(simd, black_box(0.001)),
    );
    let mut x: [f32x16<S>; N] = lanes::array(|i| f32x16::splat(simd, black_box(i as f32)));
    for _ in 0..LENGTH {
        for x in &mut x {
            *x = x.mul_add(factor, summand);
        }
    }
    let sum = x.into_iter().fold(f32x16::splat(simd, 0.0), |sum, x| sum + x);
    (sum.reduce_sum(), (2 * N * LANES * LENGTH) as u64)
}

#[inline(always)]
fn best<S: Simd>(simd: S) -> (f32, u64) {
    if wide::<S>() {
        chains::<S, WIDE_CHAINS>(simd)
    } else {
        chains::<S, NARROW_CHAINS>(simd)
    }
}

/// The sum of all chains on one core, and the floating-point operations that they took.
#[inline(never)]
fn burst(level: Level) -> (f32, u64) {
    dispatch!(level, simd => best(simd))
}

/// Bursts on all threads at once; the work is counted in floating-point operations.
pub fn subject() -> Subject<'static> {
    let level = Level::new();
    Subject::new(move || {
        let bursts = rayon::broadcast(|_| burst(level));
        Ok(bursts.into_iter().map(|(sum, flops)| (black_box(sum), flops).1).sum())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The chains are really computed: each of them ends at 1, at every SIMD level. Control: before the end they are
    /// not there.
    #[test]
    fn chains_tend_to_one() {
        for level in [Level::new(), Level::baseline()] {
            let (sum, flops) = burst(level);
            let values = flops as f32 / (2 * LENGTH) as f32;
            assert!((sum / values - 1.0).abs() < 1e-3, "{sum} of {values}");
        }
        let after = |steps: i32| 0.999f64.powi(steps) * 14.0;
        assert!(after(LENGTH as i32) < 1e-3 && after(1000) > 1.0);
    }
}
