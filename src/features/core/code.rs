//! Codes of single fragments: 32 bits, whole numbers throughout, so that the core of a pixel is the same whatever order
//! its fragments come in.
//!
//! # A fragment
//!
//! A fragment is known by two whole numbers, its *depth step* q and its *absorbance step* a. Everything after this
//! point, in both passes and on every device, is a function of (q, a): the sums of pass 1 add up the absorbance and the
//! depth that the steps stand for, so that the core can be taken out of them again to the last bit of what was put in.
//! No floating-point logarithm is needed: the bits of a positive `f32`, read as an integer, are a logarithm of base 2
//! that is linear within each octave and rises with the number. For depth a parabola is added, in integers again, which
//! brings it within 0.0081 octaves of the logarithm with hardly a kink ([`log2_bits`]). So codes come out alike
//! everywhere.
//!
//! With D = [`CodeLayout::depth_bits`], B = [`CodeLayout::octave_bits`], and `bits` the integer with the bits of an
//! `f32`:
//!
//! * log2_bits(u) of the bits u of a positive number, in units of 2^−23 octaves:
//!   m = u & (2^23 − 1), h = m >> 11, l = m & 2047,
//!   t = ((h (4096 − h)) >> 1) + ((l (2048 − h)) >> 11), the second product and shift *signed*;
//!   log2_bits = u + ((11 t) >> 5).
//! * depth, v the view depth, v0 and v1 the scene's least and greatest: w = (log2_bits(clamp(bits(v), bits(v0),
//!   bits(v1))) − log2_bits(bits(v0))) >> shift, clamped as *signed* integers; q = (w · multiplier) >> (31 − D), in
//!   0..2^D, 0 the nearest; it stands for moment depth z = (2q + 1)/2^D − 1, an exact `f32` within (−1, 1). `shift` is
//!   the least that leaves w below 2^(D+1), and `multiplier` = ⌊2^31/(W + 1)⌋, W the greatest w; the product is below
//!   2^31. (Rounding the multiplier down leaves the last few steps unused: up to 66 of 65,536 for D = 16.)
//! * absorbance, A in [0, 10], A0 = 2^−10: a = (bits(A + A0) − bits(A0) + 2^(22−B)) >> (23 − B); it stands for
//!   float(bits(A0) + (a << (23 − B))) − A0, which is an exact difference. So steps are 2^B to the octave where A is
//!   well above A0 and linear below; a = 0 stands for 0, and A = 10 is the last of them.
//!
//! # Codes
//!
//! p = 2^D − 1 − q is the nearness. A slot holds the *greatest* code that it was offered; 0 is the empty slot.
//!
//! | slot | code | greatest first |
//! |---|---|---|
//! | nearest | p << (32 − D) \| a | nearer; among equal depth steps the heavier |
//! | farthest | q << (32 − D) \| a | farther; among equal depth steps the heavier |
//! | heavy | (a + term(p)) << D \| p, term(p) = (p · slope) >> D | greater key; among equal keys the nearer |
//!
//! The key a + term(p) is, in steps of 2^B to the octave, the logarithm of A / v^k, k = [`CodeLayout::key_exponent`]:
//! `slope` = k · octaves of depth in the scene · 2^B, or as much as the bits hold (2^(32−D) − 1 − the last a), which
//! makes k less in scenes whose depths span many octaves. a comes back from the key exactly, since q stands beside it.
//!
//! # The chain
//!
//! Slots stand in the order nearest, farthest, heavy 1, ..., heavy K. A fragment is offered to the first; each slot
//! keeps the greater of two codes and hands the other on to the next, in the next slot's code. What falls off the end
//! is in the tail. Each slot thus passes on everything but what it ends with, and so the slots end with the nearest,
//! the farthest of the others, and the K heaviest of the rest in falling order, whatever the order and however walks
//! interleave, as long as keeping the greater is one atomic step. A fragment whose code is not greater than that of
//! heavy K need not walk along the heavy slots at all: slots only grow, and there are K codes no less than it.
//!
//! # Special cases
//!
//! * A fragment with a = 0 (alpha below about 2e-7) absorbs nothing and is not offered. It may lie in front of the
//!   nearest or behind the farthest.
//! * A pixel's only fragment stands in the slot of the nearest; the farthest is empty. With two the heavy slots are
//!   empty.
//! * Fragments of one depth step are ties: none is in front of another. Which of them is an end is decided by a, and
//!   codes that are equal cannot be told apart, nor need they: both would say the same. A fragment recognises itself by
//!   (q, a); where its double fell off the chain, that one takes itself for the one that stayed.
//! * Opaque fragments have A = 10 like all that is clamped.
//! * A fragment outside the scene's depth range has the first or the last depth step and is tied with what is there.

use crate::pixel::absorbance::ABSORBANCE_MAX;

/// Absorbance below which steps are linear \[dimensionless\]: a fragment of alpha 0.001.
pub const LINEAR_BELOW: f32 = 1.0 / 1024.0;

/// Most heavy fragments of a core.
pub const MAX_HEAVY: usize = 8;

/// Most slots of a core: both ends and the heavy ones.
pub const MAX_SLOTS: usize = MAX_HEAVY + 2;

/// The empty slot.
pub const EMPTY: u32 = 0;

/// How the 32 bits are shared out and what the key weighs: part of a feature set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CodeLayout {
    /// Bits of a depth step, D, from 12 to 20.
    pub depth_bits: u32,
    /// Steps of absorbance to the octave as a power of two, B, from 6 to 12.
    pub octave_bits: u32,
    /// k of the key A / v^k, at least 0.
    pub key_exponent: f32,
}

/// A fragment as its code has it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct CoreFragment {
    /// Depth step q: 0 is the scene's nearest.
    pub depth_step: u32,
    /// Absorbance step a: 0 absorbs nothing.
    pub absorbance_step: u32,
}

/// What a slot of a core keeps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Slot {
    /// The nearest fragment.
    Nearest,
    /// The farthest of the others.
    Farthest,
    /// One of the heaviest of the rest.
    Heavy,
}

impl Slot {
    /// Which slot stands at a place of the chain.
    pub fn at(place: usize) -> Self {
        match place {
            0 => Self::Nearest,
            1 => Self::Farthest,
            _ => Self::Heavy,
        }
    }
}

/// Codes of a scene: a layout together with the scene's depth range. Its numbers are what a shader is given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Codes {
    /// D.
    pub depth_bits: u32,
    /// B.
    pub octave_bits: u32,
    /// bits(v0).
    pub first_bits: i32,
    /// bits(v1).
    pub last_bits: i32,
    /// log2_bits(bits(v0)).
    pub first_log2: i32,
    /// By how much the bits of depth are shifted first.
    pub shift: u32,
    /// By what they are multiplied then.
    pub multiplier: u32,
    /// How much nearness adds to the key over the whole range.
    pub slope: u32,
}

impl CodeLayout {
    /// The last absorbance step, that of A = 10.
    pub fn last_absorbance_step(&self) -> u32 {
        absorbance_step(self.octave_bits, ABSORBANCE_MAX as f32)
    }

    /// k 2^(B − 15): what 2^8 steps of the bits of depth add to the key. One product of it, rounded down, is the slope,
    /// so that a shader finds the same.
    pub fn key_scale(&self) -> f32 {
        self.key_exponent * 2f32.powi(self.octave_bits as i32 - 15)
    }

    /// Whether the numbers are within their ranges and the key has room.
    pub fn is_valid(&self) -> bool {
        (12..=20).contains(&self.depth_bits)
            && (6..=12).contains(&self.octave_bits)
            && self.key_exponent >= 0.0
            && self.key_exponent.is_finite()
            && self.last_absorbance_step() < 1 << (32 - self.depth_bits)
    }

    /// Codes of a scene whose view depths lie in [v0, v1].
    ///
    /// # Panics
    /// If the layout is not valid, or not 0 < v0 ≤ v1, both finite.
    pub fn codes(&self, v0: f32, v1: f32) -> Codes {
        assert!(self.is_valid(), "{self:?}");
        assert!(v0 > 0.0 && v0 <= v1 && v1.is_finite(), "depth range [{v0}, {v1}]");
        let (first_bits, last_bits) = (v0.to_bits() as i32, v1.to_bits() as i32);
        let first_log2 = log2_bits(first_bits);
        let range = (log2_bits(last_bits) - first_log2) as u32;
        let shift = (32 - range.leading_zeros()).saturating_sub(self.depth_bits + 1);
        let multiplier = ((1u64 << 31) / (u64::from(range >> shift) + 1)).min(u64::from(u32::MAX)) as u32;
        let room = (1u32 << (32 - self.depth_bits)) - 1 - self.last_absorbance_step();
        let slope = (range >> 8) as f32 * self.key_scale();
        Codes {
            depth_bits: self.depth_bits,
            octave_bits: self.octave_bits,
            first_bits,
            last_bits,
            first_log2,
            shift,
            multiplier,
            slope: (slope as u32).min(room),
        }
    }
}

/// Logarithm of base 2 of the positive number with these bits, in units of 2^−23 octaves, 127 octaves added.
///
/// # Accuracy
/// Within 0.0081 octaves of the logarithm; it never falls where the number rises (`log2_bits_is_a_logarithm`).
#[inline(always)]
pub fn log2_bits(bits: i32) -> i32 {
    let m = bits & 0x007f_ffff;
    // m (2^23 − m) / 2^23 without its last bit.
    let (h, l) = (m >> 11, m & 2047);
    let t = ((h * (4096 - h)) >> 1) + ((l * (2048 - h)) >> 11);
    bits + ((11 * t) >> 5)
}

/// Absorbance step of an absorbance; NaN has none and counts as 0.
#[inline(always)]
pub fn absorbance_step(octave_bits: u32, absorbance: f32) -> u32 {
    let a = absorbance.max(0.0).min(ABSORBANCE_MAX as f32) + LINEAR_BELOW;
    (a.to_bits() - LINEAR_BELOW.to_bits() + (1 << (22 - octave_bits))) >> (23 - octave_bits)
}

/// Absorbance that an absorbance step stands for.
#[inline(always)]
pub fn absorbance_of_step(octave_bits: u32, step: u32) -> f32 {
    f32::from_bits(LINEAR_BELOW.to_bits() + (step << (23 - octave_bits))) - LINEAR_BELOW
}

impl Codes {
    /// A fragment of this view depth and absorbance.
    #[inline(always)]
    pub fn fragment(&self, view_z: f32, absorbance: f32) -> CoreFragment {
        CoreFragment {
            depth_step: self.depth_step(view_z),
            absorbance_step: absorbance_step(self.octave_bits, absorbance),
        }
    }

    /// Depth step of a view depth.
    #[inline(always)]
    pub fn depth_step(&self, view_z: f32) -> u32 {
        let bits = (view_z.to_bits() as i32).max(self.first_bits).min(self.last_bits);
        let w = (log2_bits(bits) - self.first_log2) as u32 >> self.shift;
        w.wrapping_mul(self.multiplier) >> (31 - self.depth_bits)
    }

    /// Moment depth that a depth step stands for, within (−1, 1).
    #[inline(always)]
    pub fn moment_depth(&self, depth_step: u32) -> f32 {
        (2 * depth_step + 1) as f32 * (1.0 / (1u32 << self.depth_bits) as f32) - 1.0
    }

    /// Absorbance that an absorbance step stands for.
    #[inline(always)]
    pub fn absorbance(&self, absorbance_step: u32) -> f32 {
        absorbance_of_step(self.octave_bits, absorbance_step)
    }

    /// The last depth step.
    #[inline(always)]
    pub fn last_depth_step(&self) -> u32 {
        (1 << self.depth_bits) - 1
    }

    /// What nearness adds to the key.
    #[inline(always)]
    fn term(&self, nearness: u32) -> u32 {
        nearness.wrapping_mul(self.slope) >> self.depth_bits
    }

    /// A fragment's code in a slot.
    #[inline(always)]
    pub fn encode(&self, slot: Slot, fragment: CoreFragment) -> u32 {
        let CoreFragment {
            depth_step,
            absorbance_step,
        } = fragment;
        let nearness = self.last_depth_step() - depth_step;
        match slot {
            Slot::Nearest => nearness << (32 - self.depth_bits) | absorbance_step,
            Slot::Farthest => depth_step << (32 - self.depth_bits) | absorbance_step,
            Slot::Heavy => (absorbance_step + self.term(nearness)) << self.depth_bits | nearness,
        }
    }

    /// The fragment that a slot's code stands for; `None` of an empty slot.
    #[inline(always)]
    pub fn decode(&self, slot: Slot, code: u32) -> Option<CoreFragment> {
        if code == EMPTY {
            return None;
        }
        let last = self.last_depth_step();
        let (high, low) = (
            code >> (32 - self.depth_bits),
            code & ((1 << (32 - self.depth_bits)) - 1),
        );
        Some(match slot {
            Slot::Nearest => CoreFragment {
                depth_step: last - high,
                absorbance_step: low,
            },
            Slot::Farthest => CoreFragment {
                depth_step: high,
                absorbance_step: low,
            },
            Slot::Heavy => {
                let nearness = code & last;
                CoreFragment {
                    depth_step: last - nearness,
                    absorbance_step: (code >> self.depth_bits) - self.term(nearness),
                }
            }
        })
    }

    /// The chain: offers a fragment to slots in the order nearest, farthest, heavy, and gives back what falls off.
    ///
    /// A fragment that absorbs nothing is not offered and falls off at once.
    pub fn insert(&self, slots: &mut [u32], fragment: CoreFragment) -> Option<CoreFragment> {
        let mut fragment = fragment;
        if fragment.absorbance_step == 0 {
            return Some(fragment);
        }
        let last = slots.len().checked_sub(1).filter(|&last| last >= 2);
        for place in 0..slots.len() {
            let slot = Slot::at(place);
            let code = self.encode(slot, fragment);
            // The heavy slots hold K codes no less.
            if place == 2 && last.is_some_and(|last| code <= slots[last]) {
                return Some(fragment);
            }
            let old = slots[place];
            if code > old {
                slots[place] = code;
                fragment = self.decode(slot, old)?;
            }
        }
        Some(fragment)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::rng::stream;
    use crate::pixel::absorbance;
    use proptest::prelude::*;
    use rand::RngExt;

    const LAYOUTS: [CodeLayout; 4] = [
        CodeLayout {
            depth_bits: 16,
            octave_bits: 11,
            key_exponent: 6.0,
        },
        CodeLayout {
            depth_bits: 16,
            octave_bits: 10,
            key_exponent: 0.0,
        },
        CodeLayout {
            depth_bits: 15,
            octave_bits: 12,
            key_exponent: 20.0,
        },
        CodeLayout {
            depth_bits: 20,
            octave_bits: 7,
            key_exponent: 10.0,
        },
    ];

    /// Scenes of every size: a point, one rounding deep, thin, usual, and 1e6 and 1e30 deep.
    const RANGES: [(f32, f32); 7] = [
        (1.0, 1.0),
        (1.0, 1.0 + f32::EPSILON),
        (3.0, 3.001),
        (2.5, 5.6),
        (0.1, 100.0),
        (1e-3, 1e3),
        (1e-15, 1e15),
    ];

    /// The content of a core by sorting: what the chain must end with.
    fn sorted(codes: &Codes, heavy: usize, fragments: &[CoreFragment]) -> Vec<u32> {
        let mut rest: Vec<CoreFragment> = fragments.iter().copied().filter(|f| f.absorbance_step > 0).collect();
        (0..heavy + 2)
            .map(|place| {
                let slot = Slot::at(place);
                let Some(best) = (0..rest.len()).max_by_key(|&i| codes.encode(slot, rest[i])) else {
                    return EMPTY;
                };
                codes.encode(slot, rest.swap_remove(best))
            })
            .collect()
    }

    fn chained(codes: &Codes, heavy: usize, fragments: &[CoreFragment]) -> (Vec<u32>, Vec<CoreFragment>) {
        let mut slots = vec![EMPTY; heavy + 2];
        let tail = fragments.iter().filter_map(|&f| codes.insert(&mut slots, f)).collect();
        (slots, tail)
    }

    /// Every depth step, absorbance step and slot comes back; codes of a slot are distinct and greater than that of the
    /// empty slot.
    #[test]
    fn fragments_come_back_from_their_codes() {
        for layout in LAYOUTS {
            for (v0, v1) in RANGES {
                let codes = layout.codes(v0, v1);
                let last = codes.last_depth_step();
                let most = layout.last_absorbance_step();
                let mut rng = stream(1, 120, 0);
                for i in 0..20_000 {
                    let fragment = CoreFragment {
                        depth_step: [0, last, rng.random_range(0..=last)][i % 3],
                        absorbance_step: [1, most, rng.random_range(1..=most)][i / 3 % 3],
                    };
                    for slot in [Slot::Nearest, Slot::Farthest, Slot::Heavy] {
                        let code = codes.encode(slot, fragment);
                        assert!(code > EMPTY);
                        assert_eq!(
                            codes.decode(slot, code),
                            Some(fragment),
                            "{layout:?} {v0} {v1} {slot:?}"
                        );
                    }
                }
            }
        }
    }

    /// Every significand. Control: without the parabola it is off by a twelfth of an octave.
    #[test]
    fn log2_bits_is_a_logarithm() {
        let (mut before, mut worst, mut control) = (i32::MIN, 0.0f64, 0.0f64);
        for bits in 0x3f80_0000..=0x4000_0000 {
            let found = log2_bits(bits);
            assert!(found >= before);
            before = found;
            if bits % 64 == 0 {
                let exact = libm::log2(f32::from_bits(bits as u32).into()) + 127.0;
                worst = worst.max((f64::from(found) / 8_388_608.0 - exact).abs());
                control = control.max((f64::from(bits) / 8_388_608.0 - exact).abs());
            }
        }
        assert!(worst <= 0.0081 && control > 0.08, "{worst} {control}");
        for octave in [1, 100, 254] {
            assert_eq!(log2_bits(octave << 23), octave << 23);
        }
    }

    /// Steps rise with what they are steps of, cover their range, and lie within half a step of it; what they stand for
    /// has the same step again.
    #[test]
    fn steps_follow_depth_and_absorbance() {
        for layout in LAYOUTS {
            for (v0, v1) in RANGES {
                let codes = layout.codes(v0, v1);
                let last = codes.last_depth_step();
                // The multiplier is rounded down.
                let slack = 1.0 / f64::from(codes.multiplier);
                let mut before = 0;
                for i in 0..=10_000 {
                    let v = (v0 * (v1 / v0).powf(i as f32 / 10_000.0)).clamp(v0, v1);
                    let q = codes.depth_step(v);
                    assert!(
                        (before..=last).contains(&q),
                        "{layout:?} {v0} {v1} {v}: {q} after {before}"
                    );
                    before = q;
                    // The place between the logarithms of the ends, as a share of the whole: to two steps.
                    let log = |v: f32| f64::from(log2_bits(v.to_bits() as i32));
                    let range = log(v1) - log(v0) + 1.0;
                    let place = (log(v) - log(v0)) / range;
                    let step = 2.0 / f64::from(last) + 2.0 / range + slack;
                    assert!((f64::from(codes.moment_depth(q)) - (2.0 * place - 1.0)).abs() <= 2.0 * step);
                }
                assert_eq!(codes.depth_step(v0), 0);
                if (v1.to_bits() - v0.to_bits()) >> layout.depth_bits > 0 {
                    let short = f64::from(last - before) / f64::from(last);
                    assert!(
                        short <= slack + 2.0 / f64::from(last),
                        "{layout:?} {v0} {v1}: {before} of {last}"
                    );
                }
                for (outside, q) in [
                    (0.0, 0),
                    (-1.0, 0),
                    (f32::NEG_INFINITY, 0),
                    (f32::MIN_POSITIVE, 0),
                    (f32::INFINITY, before),
                    (f32::NAN, before),
                ] {
                    assert_eq!(codes.depth_step(outside), q, "{outside}");
                }
                assert!(codes.moment_depth(0) > -1.0 && codes.moment_depth(last) < 1.0);
            }
            let b = layout.octave_bits;
            let mut before = 0;
            for i in 0..=100_000 {
                let alpha = if i < 50_000 {
                    i as f32 / 50_000.0
                } else {
                    2f32.powf(-(i - 50_000) as f32 / 1500.0)
                };
                let exact = absorbance(alpha) as f32;
                let step = absorbance_step(b, exact);
                let back = absorbance_of_step(b, step);
                assert_eq!(absorbance_step(b, back), step);
                let bar = (exact + LINEAR_BELOW) / (1u32 << b) as f32 * 0.51;
                assert!((back - exact).abs() <= bar, "alpha {alpha}: {exact}, {back}");
                assert!(i == 0 || i >= 50_000 || step >= before);
                before = step;
            }
            assert_eq!((absorbance_step(b, 0.0), absorbance_of_step(b, 0)), (0, 0.0));
            assert_eq!(absorbance_step(b, f32::NAN), 0);
            assert_eq!(absorbance_step(b, -1.0), 0);
            assert_eq!(absorbance_step(b, f32::INFINITY), layout.last_absorbance_step());
        }
    }

    /// The key orders by A / v^k: to within what reading bits as a logarithm is off: 0.0861 octaves of absorbance,
    /// 0.0081 of depth.
    #[test]
    fn keys_weigh_absorbance_against_depth() {
        let layout = LAYOUTS[0];
        let codes = layout.codes(2.0, 6.0);
        let mut rng = stream(2, 120, 0);
        let (mut compared, mut controls) = (0, 0);
        for _ in 0..20_000 {
            let mut draw = || (rng.random_range(2.0f32..6.0), rng.random_range(0.05f32..5.0));
            let [one, other] = [draw(), draw()];
            let log_key = |(v, a): (f32, f32)| a.log2() - layout.key_exponent * v.log2();
            let code = |(v, a)| codes.encode(Slot::Heavy, codes.fragment(v, a));
            let difference = log_key(one) - log_key(other);
            if difference.abs() > 2.0 * (0.0861 + 0.0081 * layout.key_exponent) + 0.01 {
                assert_eq!(difference > 0.0, code(one) > code(other), "{one:?} {other:?}");
                compared += 1;
                controls += usize::from((one.1 > other.1) != (code(one) > code(other)));
            }
        }
        assert!(compared > 10_000 && controls > 1000, "{compared} {controls}");
    }

    fn fragments() -> impl Strategy<Value = Vec<(u32, u32)>> {
        // Few steps, so that ties, coplanar fragments and doubles are common.
        prop::collection::vec((0u32..6, 0u32..5), 0..24)
    }

    proptest! {
        /// Whatever the order: the content found by sorting, and core and tail together are what was put in.
        #[test]
        fn the_core_does_not_depend_on_the_order(
            (steps, shuffled) in fragments().prop_flat_map(|f| (Just(f.clone()), Just(f).prop_shuffle())),
            heavy in 0usize..=MAX_HEAVY,
            layout in 0usize..LAYOUTS.len(),
        ) {
            let codes = LAYOUTS[layout].codes(2.5, 5.6);
            let most = LAYOUTS[layout].last_absorbance_step();
            // Alpha 0 and 1 among them.
            let spread = |f: &[(u32, u32)]| -> Vec<CoreFragment> {
                f.iter()
                    .map(|&(q, a)| CoreFragment { depth_step: q * codes.last_depth_step() / 5,
                        absorbance_step: a * most / 4 })
                    .collect()
            };
            let (one, other) = (spread(&steps), spread(&shuffled));
            let (slots, tail) = chained(&codes, heavy, &one);
            prop_assert_eq!(&slots, &sorted(&codes, heavy, &one));
            prop_assert_eq!(&slots, &chained(&codes, heavy, &other).0);
            let mut all: Vec<CoreFragment> = slots
                .iter()
                .enumerate()
                .filter_map(|(place, &code)| codes.decode(Slot::at(place), code))
                .chain(tail)
                .collect();
            let mut expected = one;
            all.sort();
            expected.sort();
            prop_assert_eq!(all, expected);
        }
    }

    /// Control of the above: a chain that forgets to hand the loser on ends with other contents.
    #[test]
    fn a_chain_that_loses_fragments_is_found_out() {
        let codes = LAYOUTS[0].codes(2.5, 5.6);
        let mut rng = stream(3, 120, 0);
        let mut differences = 0;
        for _ in 0..200 {
            let fragments: Vec<CoreFragment> = (0..12)
                .map(|_| codes.fragment(rng.random_range(2.5..5.6), rng.random_range(0.1..2.0)))
                .collect();
            let mut slots = [EMPTY; 4];
            for &fragment in &fragments {
                for (place, kept) in slots.iter_mut().enumerate() {
                    *kept = codes.encode(Slot::at(place), fragment).max(*kept);
                }
            }
            differences += usize::from(slots.as_slice() != sorted(&codes, 2, &fragments));
        }
        assert!(differences > 150, "{differences}");
    }
}
