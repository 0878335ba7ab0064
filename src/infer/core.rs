//! Answers for sets with a core: both passes, sixteen fragments of a pixel at once, the tail shared out by a network or
//! by the beta law.
//!
//! Steps, codes and what they stand for are made for a run of pixels in lanes; the chain of slots and the sums are
//! taken fragment by fragment; pass 2 takes the fragments of a pixel sixteen at a time, by [`Between::answers`], which
//! rows of training take one at a time.

use super::classes::{Class, Switches, Tally};
use super::passes::{Column, ROWS};
use super::tiled::Tiled;
#[cfg(target_arch = "x86_64")]
use crate::features::FeatureSet;
use crate::features::core::code::{Codes, CoreFragment, Slot};
use crate::features::core::formulas::{allowed, share_by_law, transmittance};
use crate::features::core::pixel::{Between, Query, Sums, with_sums};
use crate::features::core::{CoreSet, FIXED};
use crate::numeric::Real;
use crate::numeric::lanes::{LANES, Lanes};
use crate::pixel::{FragmentList, absorbance_lanes};
use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, f32x16, mask32x16};
use rayon::prelude::*;
use std::ops::Range;
use std::time::Instant;

/// Pixels of one task.
const TASK: usize = 256;

/// Greatest error of T, whatever share of the tail its moments allow, at which the middle of what they allow stands for
/// the network's answer: half a display step.
pub const VISIBLE: f32 = 1.0 / 512.0;

/// Who shares tails out.
#[derive(Clone, Copy)]
pub enum Tail<'a> {
    /// The beta law with the tail's mean and spread.
    Law,
    /// A network on the features of the set.
    Network(&'a Tiled),
}

/// Answers for every fragment of some pixels of a list, on all cores.
///
/// # Shapes
/// `out` and `classes`: one for each of the pixels' fragments.
pub fn run(
    (set, codes): (&CoreSet, &Codes),
    tail: Tail<'_>,
    list: &FragmentList,
    pixels: Range<usize>,
    switches: Switches,
    out: &mut [f32],
    classes: &mut [Class],
) -> Tally {
    let start = Instant::now();
    let mut tasks = Vec::new();
    let (mut rest, mut rest_of_classes) = (out, classes);
    for first in pixels.clone().step_by(TASK) {
        let own = first..(first + TASK).min(pixels.end);
        let fragments = (list.offsets()[own.end] - list.offsets()[own.start]) as usize;
        let (out, others) = std::mem::take(&mut rest).split_at_mut(fragments);
        let (classes, other_classes) = std::mem::take(&mut rest_of_classes).split_at_mut(fragments);
        tasks.push((own, out, classes));
        (rest, rest_of_classes) = (others, other_classes);
    }
    let new = || Workspace {
        codes,
        slots: set.slots(),
        coded: Coded::default(),
        waiting: match tail {
            Tail::Law => None,
            Tail::Network(network) => Some(Waiting::new(network, FIXED + set.moments)),
        },
        is_faint_known: switches.faint,
        tally: Tally::default(),
    };
    let mut tally = tasks
        .into_par_iter()
        .map_init(new, |workspace, (own, out, classes)| {
            with_sums!(set.moments, N => workspace.run::<N>(list, own, out, classes));
            std::mem::take(&mut workspace.tally)
        })
        .reduce(Tally::default, |mut one, other| {
            one.add(&other);
            one
        });
    tally.seconds_pass_2 = start.elapsed().as_secs_f64();
    tally
}

/// Fragments of some pixels as their codes have them, column by column, with a vector of padding.
#[derive(Default)]
struct Coded {
    depth_step: Vec<u32>,
    absorbance_step: Vec<u32>,
    /// Codes in the slots of the nearest, the farthest and the heavy.
    codes: [Vec<u32>; 3],
    /// Moment depth and absorbance that the steps stand for.
    z: Vec<f32>,
    absorbance: Vec<f32>,
}

impl Coded {
    #[inline(always)]
    fn fill<S: Simd>(&mut self, simd: S, codes: &Codes, view_z: &[f32], alpha: &[f32]) {
        let len = view_z.len().next_multiple_of(LANES) + LANES;
        let [nearest, farthest, heavy] = &mut self.codes;
        for column in [
            &mut self.depth_step,
            &mut self.absorbance_step,
            nearest,
            farthest,
            heavy,
        ] {
            column.resize(len, 0);
        }
        self.z.resize(len, 0.0);
        self.absorbance.resize(len, 0.0);
        for (index, (view_z, alpha)) in view_z.chunks(LANES).zip(alpha.chunks(LANES)).enumerate() {
            let (mut v, mut a) = ([1.0; LANES], Lanes::ZERO);
            v[..view_z.len()].copy_from_slice(view_z);
            a.0[..alpha.len()].copy_from_slice(alpha);
            a.store(absorbance_lanes(simd, a.load(simd)));
            let fragments: [CoreFragment; LANES] = std::array::from_fn(|i| codes.fragment(v[i], a.0[i]));
            let own = index * LANES..(index + 1) * LANES;
            self.depth_step[own.clone()].copy_from_slice(&fragments.map(|f| f.depth_step));
            self.absorbance_step[own.clone()].copy_from_slice(&fragments.map(|f| f.absorbance_step));
            let [nearest, farthest, heavy] = &mut self.codes;
            nearest[own.clone()].copy_from_slice(&fragments.map(|f| codes.encode(Slot::Nearest, f)));
            farthest[own.clone()].copy_from_slice(&fragments.map(|f| codes.encode(Slot::Farthest, f)));
            heavy[own.clone()].copy_from_slice(&fragments.map(|f| codes.encode(Slot::Heavy, f)));
            self.z[own.clone()].copy_from_slice(&fragments.map(|f| codes.moment_depth(f.depth_step)));
            self.absorbance[own].copy_from_slice(&fragments.map(|f| codes.absorbance(f.absorbance_step)));
        }
    }

    /// Pass 1 over a pixel: [`Sums::add`] of each fragment, but that a fragment no greater than what its slots hold is
    /// left out of the chain at once.
    #[inline(always)]
    fn sums<const N: usize>(&self, codes: &Codes, slots: usize, own: Range<usize>) -> Sums<N> {
        let mut sums = Sums::<N>::default();
        for i in own {
            let fragment = CoreFragment {
                depth_step: self.depth_step[i],
                absorbance_step: self.absorbance_step[i],
            };
            if fragment.absorbance_step == 0 {
                continue;
            }
            let is_heavy = slots > 2 && self.codes[2][i] > sums.slots[slots - 1];
            if is_heavy | (self.codes[0][i] > sums.slots[0]) | (self.codes[1][i] > sums.slots[1]) {
                codes.insert(&mut sums.slots[..slots], fragment);
            }
            sums.count += 1;
            sums.add_moments(self.z[i], self.absorbance[i]);
        }
        sums
    }
}

/// Whether some feature set that is listed has a core with so many moments.
#[cfg(target_arch = "x86_64")]
const fn is_usual(moments: usize) -> bool {
    let mut sets: &[FeatureSet] = &FeatureSet::ALL;
    while let [set, others @ ..] = sets {
        if let FeatureSet::Core(shape) = set
            && shape.moments() == moments
        {
            return true;
        }
        sets = others;
    }
    false
}

/// What one thread works in.
struct Workspace<'a> {
    codes: &'a Codes,
    slots: usize,
    coded: Coded,
    waiting: Option<Waiting<'a>>,
    is_faint_known: bool,
    tally: Tally,
}

impl Workspace<'_> {
    fn run<const N: usize>(
        &mut self,
        list: &FragmentList,
        pixels: Range<usize>,
        out: &mut [f32],
        classes: &mut [Class],
    ) {
        self.on_lanes::<N>(list, pixels, out, classes);
        for class in classes {
            self.tally.classes[*class as usize] += 1;
        }
    }

    /// [`Self::both_passes`] on the widest vectors that there are; where no usual set has so many moments, on those of
    /// every x86-64, since each level of each number of moments takes its time in every build.
    fn on_lanes<const N: usize>(
        &mut self,
        list: &FragmentList,
        pixels: Range<usize>,
        out: &mut [f32],
        classes: &mut [Class],
    ) {
        #[cfg(target_arch = "x86_64")]
        if const { !is_usual(N - 1) } {
            let simd = Level::baseline().as_sse2().expect("SSE2, which every x86-64 has");
            return self.both_passes::<_, N>(simd, list, pixels, out, classes);
        }
        dispatch!(Level::new(), simd => self.both_passes::<_, N>(simd, list, pixels, out, classes));
    }

    #[inline(always)]
    fn both_passes<S: Simd, const N: usize>(
        &mut self,
        simd: S,
        list: &FragmentList,
        pixels: Range<usize>,
        out: &mut [f32],
        classes: &mut [Class],
    ) {
        let offsets = &list.offsets()[pixels.start..=pixels.end];
        let all = offsets[0] as usize..offsets[pixels.len()] as usize;
        self.coded
            .fill(simd, self.codes, &list.view_z()[all.clone()], &list.alpha()[all]);
        for of in offsets.windows(2).filter(|of| of[0] < of[1]) {
            let own = (of[0] - offsets[0]) as usize..(of[1] - offsets[0]) as usize;
            if own.len() <= self.slots.min(LANES) {
                self.all_in_core(simd, own, out, classes);
                continue;
            }
            let sums = self.coded.sums::<N>(self.codes, self.slots, own.clone());
            let between = Between::new(self.codes, self.slots, &sums);
            self.pass_2(simd, &between, own, out, classes);
        }
        if let Some(waiting) = &mut self.waiting {
            waiting.flush(out);
        }
    }

    /// Both passes over a pixel whose fragments are all in the core.
    #[inline(always)]
    fn all_in_core<S: Simd>(&self, simd: S, own: Range<usize>, out: &mut [f32], classes: &mut [Class]) {
        let [z, zero] =
            [&self.coded.z[own.start..own.start + LANES], &[0.0; LANES]].map(|v| f32x16::from_slice(simd, v));
        let mut front = zero;
        for i in own.clone() {
            let [core_z, core_absorbance] =
                [self.coded.z[i], self.coded.absorbance[i]].map(|value| f32x16::splat(simd, value));
            front += Select::select(core_z.simd_lt(z), core_absorbance, zero);
        }
        let mut lanes = Lanes::ZERO;
        lanes.store(transmittance(front, zero, zero));
        out[own.clone()].copy_from_slice(&lanes.0[..own.len()]);
        classes[own].fill(Class::Known);
    }

    #[inline(always)]
    fn pass_2<S: Simd, const N: usize>(
        &mut self,
        simd: S,
        between: &Between<N>,
        own: Range<usize>,
        out: &mut [f32],
        classes: &mut [Class],
    ) {
        for at in own.clone().step_by(LANES) {
            let len = (own.end - at).min(LANES);
            let [z, absorbance] =
                [&self.coded.z, &self.coded.absorbance].map(|column| f32x16::from_slice(simd, &column[at..at + LANES]));
            let answers = between.answers(z, absorbance);
            let zero = f32x16::splat(simd, 0.0);
            let mut t = transmittance(answers.depth, zero, zero);
            let (out_of, class_of) = (&mut out[at..at + len], &mut classes[at..at + len]);
            class_of.fill(Class::Known);
            let mut unknown = !answers.is_known.to_bitmask() & ((1 << len) - 1);
            if unknown != 0 {
                let query = &answers.query;
                match &mut self.waiting {
                    None => t = Select::select(answers.is_known, t, by_law(query)),
                    Some(waiting) => {
                        if self.is_faint_known {
                            let [_, _, _, lower, upper] = query.fixed;
                            let noise = between.bounds_noise(query);
                            let [most, least] = allowed(query.front, query.tail, [lower, upper], noise);
                            let is_faint = (most - least).simd_le(f32x16::splat(simd, 2.0 * VISIBLE));
                            let faint = unknown & is_faint.to_bitmask();
                            if faint != 0 {
                                let middle = (most + least) * f32x16::splat(simd, 0.5);
                                t = Select::select(answers.is_known, t, middle);
                                for_each_lane(faint, |lane| class_of[lane] = Class::Faint);
                                unknown &= !faint;
                            }
                        }
                        if unknown.count_ones() as usize == len {
                            class_of.fill(Class::Network);
                        } else {
                            for_each_lane(unknown, |lane| class_of[lane] = Class::Network);
                        }
                        self.tally.rows += u64::from(unknown.count_ones());
                        waiting.push(simd, query, unknown, at..at + len);
                    }
                }
            }
            let mut lanes = Lanes::ZERO;
            lanes.store(t);
            out_of.copy_from_slice(&lanes.0[..len]);
            if let Some(waiting) = &mut self.waiting
                && waiting.is_full()
            {
                waiting.flush(out);
            }
        }
    }
}

#[inline(always)]
fn for_each_lane(mut lanes: u64, mut f: impl FnMut(usize)) {
    while lanes != 0 {
        f(lanes.trailing_zeros() as usize);
        lanes &= lanes - 1;
    }
}

/// Transmittance by the beta law; with the spread of the uniform law where there is only a mean.
#[inline(always)]
fn by_law<R: Real, const N: usize>(query: &Query<N, R>) -> R {
    let spread = query.described.get(2).copied().unwrap_or(query.tail.like(1.0 / 3.0));
    let share = share_by_law(query.fixed[0], query.described[1], spread);
    transmittance(query.front, query.tail, share)
}

/// What answers rows of features, given as columns.
type Answer<'a> = dyn FnMut(&[Column], &mut [f32]) + 'a;

/// Rows that wait for the network.
struct Waiting<'a> {
    answer: Box<Answer<'a>>,
    columns: Vec<Column>,
    /// Transmittance of the core in front of each.
    front: Column,
    /// The fragment of each.
    fragments: Vec<u32>,
}

impl<'a> Waiting<'a> {
    fn new(network: &'a Tiled, width: usize) -> Self {
        Self {
            answer: Box::new(network.answers_to_columns()),
            columns: vec![[0.0; ROWS]; width],
            front: [0.0; ROWS],
            fragments: Vec::with_capacity(ROWS),
        }
    }

    /// Whether another vector might not fit.
    fn is_full(&self) -> bool {
        self.fragments.len() > ROWS - LANES
    }

    /// Adds those fragments of a vector whose bits are set.
    #[inline(always)]
    fn push<S: Simd, const N: usize>(
        &mut self,
        simd: S,
        query: &Query<N, f32x16<S>>,
        lanes: u64,
        fragments: Range<usize>,
    ) {
        let row = self.fragments.len();
        let zero = f32x16::splat(simd, 0.0);
        let front = transmittance(query.front, zero, zero);
        let values = query.fixed.iter().chain(&query.described[1..]).chain([&front]);
        let columns = self.columns.iter_mut().chain([&mut self.front]);
        if lanes.count_ones() as usize == fragments.len() {
            for (column, value) in columns.zip(values) {
                value.store_slice(&mut column[row..row + LANES]);
            }
            self.fragments.extend(fragments.map(|fragment| fragment as u32));
        } else {
            let mask = mask32x16::from_bitmask(simd, lanes);
            for (column, value) in columns.zip(values) {
                value.compress(mask).store_slice(&mut column[row..row + LANES]);
            }
            for_each_lane(lanes, |lane| self.fragments.push((fragments.start + lane) as u32));
        }
    }

    fn flush(&mut self, out: &mut [f32]) {
        let mut answers = [0.0; ROWS];
        let answers = &mut answers[..self.fragments.len()];
        (self.answer)(&self.columns, answers);
        for ((fragment, front), of_tail) in self.fragments.drain(..).zip(self.front).zip(answers) {
            out[fragment as usize] = front * *of_tail;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::features::core::pixel::{Answer, Passes};
    use crate::numeric::rng::stream;
    use rand::RngExt;

    fn random_list(seed: u64) -> FragmentList {
        let mut rng = stream(seed, 122, 0);
        let (mut offsets, mut view_z, mut alpha) = (vec![0], Vec::new(), Vec::new());
        for _ in 0..600 {
            let n = rng.random_range(0..70usize);
            let far = [1.001f32, 1.5, 8.0][rng.random_range(0..3usize)];
            for _ in 0..n {
                view_z.push(rng.random_range(1.0..far));
                alpha.push(match rng.random_range(0..20) {
                    0 => 0.0,
                    1 => 1.0,
                    2 => 1e-5,
                    _ => rng.random_range(0.0..0.9),
                });
            }
            if n > 8 && rng.random_bool(0.3) {
                let last = view_z.len() - 1;
                view_z[last] = view_z[last - 3];
            }
            offsets.push(view_z.len() as u64);
        }
        FragmentList::new(offsets, view_z, alpha, None).unwrap()
    }

    /// Answers one by one, by the law.
    fn one_by_one<const N: usize>(set: &CoreSet, codes: &Codes, list: &FragmentList) -> (Vec<f32>, usize) {
        let (mut passes, mut all, mut asked) = (Passes::default(), Vec::new(), 0);
        for p in 0..list.pixels() {
            let between = passes.first::<N>(set, codes, list.pixel(p));
            for &fragment in &passes.fragments {
                all.push(match between.answer(codes, fragment) {
                    Answer::Depth(depth) => transmittance(depth, 0.0, 0.0),
                    Answer::Query(query) => {
                        asked += 1;
                        by_law(&query)
                    }
                });
            }
        }
        (all, asked)
    }

    /// Sixteen at once are as one by one: within 1e-4, the root of the mean square within 1e-6 (absorbances in lanes
    /// may round to the next step). Control: the answers of the fragments beside.
    #[test]
    fn lanes_answer_as_one_by_one() {
        fn check<const N: usize>(heavy: usize, seed: u64) {
            let set = CoreSet::new(heavy, N - 1);
            let list = random_list(seed);
            let (v0, v1) = list.depth_range().unwrap();
            let codes = set.layout.codes(v0, v1);
            let (expected, asked) = one_by_one::<N>(&set, &codes, &list);
            let mut found = vec![f32::NAN; list.len()];
            let mut classes = vec![Class::Network; list.len()];
            let switches = Switches::default();
            let tally = run(
                (&set, &codes),
                Tail::Law,
                &list,
                0..list.pixels(),
                switches,
                &mut found,
                &mut classes,
            );
            assert!(asked > 1000 && tally.fragments() == list.len() as u64);
            let errors = |found: &[f32]| {
                let squares = found.iter().zip(&expected).map(|(f, e)| f64::from(f - e).powi(2));
                squares.fold((0.0, 0.0f64), |(sum, most), e| {
                    (sum + e, if e.is_nan() { f64::INFINITY } else { most.max(e) })
                })
            };
            let (sum, most) = errors(&found);
            let mean = (sum / list.len() as f64).sqrt();
            assert!(
                mean <= 1e-6 && most.sqrt() <= 1e-4,
                "{heavy} {N}: {mean} {}",
                most.sqrt()
            );
            found.rotate_left(1);
            assert!(errors(&found).1.sqrt() > 0.1);
        }
        for seed in 0..3 {
            check::<2>(3, seed);
            check::<3>(4, seed);
            check::<5>(0, seed);
            check::<5>(1, seed);
            check::<5>(4, seed);
            check::<7>(8, seed);
        }
    }
}
