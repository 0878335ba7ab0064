//! Both passes over one pixel on the CPU, in `f32` as a renderer has them.

use super::code::{CodeLayout, Codes, CoreFragment, EMPTY, MAX_SLOTS, Slot};
use super::formulas::{
    absorbance_feature, absorbance_of, count_feature, described, normalised, place_noise, range_feature, recentred,
    share_of_one, share_of_two, without,
};
use super::{CoreSet, FIXED};
use crate::pixel::{Pixel, absorbance};

/// A pixel after pass 1: N = M + 1 sums.
#[derive(Debug, Clone, Copy)]
pub struct Sums<const N: usize> {
    /// Slots of the core.
    pub slots: [u32; MAX_SLOTS],
    /// Number of fragments that absorb something.
    pub count: u32,
    /// b_0..b_M.
    pub b: [f32; N],
}

impl<const N: usize> Default for Sums<N> {
    fn default() -> Self {
        Self {
            slots: [EMPTY; MAX_SLOTS],
            count: 0,
            b: [0.0; N],
        }
    }
}

impl<const N: usize> Sums<N> {
    /// Pass 1: adds a fragment.
    #[inline(always)]
    pub fn add(&mut self, codes: &Codes, slots: usize, fragment: CoreFragment) {
        if fragment.absorbance_step == 0 {
            return;
        }
        codes.insert(&mut self.slots[..slots], fragment);
        self.count += 1;
        let z = codes.moment_depth(fragment.depth_step);
        let mut term = codes.absorbance(fragment.absorbance_step);
        for b in &mut self.b {
            *b += term;
            term *= z;
        }
    }
}

/// What pass 2 knows of a fragment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Answer<const N: usize> {
    /// The optical depth in front of it, without a network.
    Depth(f32),
    /// A tail that must be shared out.
    Query(Query<N>),
}

/// A fragment and the tail that it sees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Query<const N: usize> {
    /// Absorbance of the core in front.
    pub front: f32,
    /// Absorbance of the tail, b_0''.
    pub tail: f32,
    /// x, count, ln_b0, in_core, range.
    pub fixed: [f32; FIXED],
    /// 1, then means and spreads.
    pub described: [f32; N],
}

/// A pixel between the passes: the core in order of depth, and the tail's sums in the pixel's own range.
#[derive(Debug, Clone, Copy)]
pub struct Between<const N: usize> {
    core: [CoreFragment; MAX_SLOTS],
    absorbance: [f32; MAX_SLOTS],
    len: usize,
    /// Fragments of the tail.
    count: u32,
    farthest: u32,
    total: f32,
    tail: [f32; N],
    center: f32,
    per_h: f32,
    /// ln(h + 1e-4)/5
    range: f32,
    /// One depth step in the pixel's own range.
    step: f32,
}

impl<const N: usize> Between<N> {
    /// Takes the core out of the sums of a pixel.
    pub fn new(codes: &Codes, slots: usize, sums: &Sums<N>) -> Self {
        let mut core = [CoreFragment {
            depth_step: 0,
            absorbance_step: 0,
        }; MAX_SLOTS];
        let mut len = 0;
        let mut tail = sums.b;
        for (place, &code) in sums.slots[..slots].iter().enumerate() {
            if let Some(fragment) = codes.decode(Slot::at(place), code) {
                core[len] = fragment;
                len += 1;
                let z = codes.moment_depth(fragment.depth_step);
                tail = without(tail, codes.absorbance(fragment.absorbance_step), z);
            }
        }
        let (nearest, farthest) = (core[0].depth_step, core[usize::from(len > 1)].depth_step);
        let ends = [nearest, farthest].map(|step| codes.moment_depth(step));
        let step = codes.moment_depth(1) - codes.moment_depth(0);
        let h = (0.5 * (ends[1] - ends[0])).max(0.5 * step);
        let (center, per_h) = (0.5 * (ends[0] + ends[1]), 1.0 / h);
        core[..len].sort_unstable();
        Self {
            absorbance: core.map(|fragment| codes.absorbance(fragment.absorbance_step)),
            core,
            len,
            count: sums.count - len as u32,
            farthest,
            total: sums.b[0],
            tail: recentred(tail, center, per_h),
            center,
            per_h,
            range: range_feature(h),
            step: step * per_h,
        }
    }

    /// The core, in order of depth.
    pub fn core(&self) -> &[CoreFragment] {
        &self.core[..self.len]
    }

    /// Pass 2: what is known of a fragment that pass 1 has added.
    #[inline(always)]
    pub fn answer(&self, codes: &Codes, fragment: CoreFragment) -> Answer<N> {
        let (mut front, mut in_core) = (0.0, false);
        for (core, absorbance) in self.core[..self.len].iter().zip(self.absorbance) {
            if core.depth_step < fragment.depth_step {
                front += absorbance;
            }
            in_core |= *core == fragment;
        }
        if self.len == 0 || fragment.depth_step <= self.core[0].depth_step {
            return Answer::Depth(0.0);
        }
        let in_tail = !in_core && fragment.absorbance_step > 0;
        let count = self.count - u32::from(in_tail && self.count > 0);
        if count == 0 {
            return Answer::Depth(front);
        }
        let x = ((codes.moment_depth(fragment.depth_step) - self.center) * self.per_h).clamp(-1.0, 1.0);
        let tail = if in_tail {
            without(self.tail, codes.absorbance(fragment.absorbance_step), x)
        } else {
            self.tail
        };
        let absorbance = absorbance_of(tail);
        if fragment.depth_step >= self.farthest {
            return Answer::Depth(front + absorbance);
        }
        let m = normalised(tail);
        if count == 1 || (count == 2 && N > 3) {
            let noise = place_noise(self.total, absorbance, self.center, self.per_h);
            let share = if count == 1 || N <= 3 {
                share_of_one(x, m[1], self.step, noise)
            } else {
                share_of_two(x, [m[1], m[2], m[3.min(N - 1)]], self.step, noise)
            };
            return Answer::Depth(front + absorbance * share);
        }
        Answer::Query(Query {
            front,
            tail: absorbance,
            fixed: [
                x,
                count_feature(count as f32),
                absorbance_feature(absorbance),
                if in_core { 1.0 } else { 0.0 },
                self.range,
            ],
            described: described(m),
        })
    }
}

/// Both passes of one pixel.
#[derive(Debug, Clone, Default)]
pub struct Passes {
    /// Its fragments, as their codes have them.
    pub fragments: Vec<CoreFragment>,
}

impl Passes {
    /// Pass 1 over a pixel, in the order of its fragments, and what stands between the passes.
    pub fn first<const N: usize>(&mut self, set: &CoreSet, codes: &Codes, pixel: Pixel<'_>) -> Between<N> {
        assert_eq!(N, set.moments + 1, "one sum more than moments");
        let mut sums = Sums::<N>::default();
        self.fragments.clear();
        for (&view_z, &alpha) in pixel.view_z.iter().zip(pixel.alpha) {
            let fragment = codes.fragment(view_z, absorbance(alpha) as f32);
            sums.add(codes, set.slots(), fragment);
            self.fragments.push(fragment);
        }
        Between::new(codes, set.slots(), &sums)
    }
}

/// Codes for view depths in a range; all depths are one where the range is none.
pub fn codes_for(layout: &CodeLayout, range: Option<(f32, f32)>) -> Codes {
    let (v0, v1) = range.unwrap_or((1.0, 1.0));
    layout.codes(v0, v1)
}

/// Runs a body with N = M + 1 as a constant.
macro_rules! with_sums {
    ($moments:expr, $n:ident => $body:expr) => {
        match $moments {
            1 => {
                const $n: usize = 2;
                $body
            }
            2 => {
                const $n: usize = 3;
                $body
            }
            3 => {
                const $n: usize = 4;
                $body
            }
            4 => {
                const $n: usize = 5;
                $body
            }
            5 => {
                const $n: usize = 6;
                $body
            }
            _ => {
                const $n: usize = 7;
                $body
            }
        }
    };
}
pub(crate) use with_sums;
