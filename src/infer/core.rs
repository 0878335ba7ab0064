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
use crate::features::core::code::{Codes, EMPTY, Slot};
use crate::features::core::formulas::{allowed, share_by_law, transmittance};
use crate::features::core::pixel::{Between, Query, Sums, with_sums};
use crate::features::core::{CoreSet, FIXED};
use crate::numeric::Real;
use crate::numeric::lanes::{self, LANES, Lanes};
use crate::pixel::{FragmentList, absorbance_lanes};
use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, f32x16, mask32x16};
use rayon::prelude::*;
use std::ops::Range;
use std::time::Instant;

/// Pixels of one task.
const TASK: usize = 256;

/// Greatest error of what a fragment adds to the image, whatever share of the tail its moments allow, at which the
/// middle of what they allow stands for the network's answer: a quarter of a display step, so that several of a pixel
/// hardly add up to half a step.
pub const VISIBLE: f32 = 1.0 / 1024.0;

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
        tail,
        waiting: None,
        is_faint_known: switches.faint,
        tally: Tally::default(),
    };
    let mut tally = tasks
        .into_par_iter()
        .map_init(new, |workspace, (own, out, classes)| {
            with_sums!(set.moments, N => workspace.on_lanes::<N>(list, own, out, classes));
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
    /// Codes in the slots of the nearest, the farthest and the heavy; that of the empty slot where nothing is absorbed.
    codes: [Vec<u32>; 3],
    /// Moment depth and absorbance that the steps stand for.
    z: Vec<f32>,
    absorbance: Vec<f32>,
}

impl Coded {
    #[inline(always)]
    fn fill<S: Simd>(&mut self, simd: S, codes: &Codes, view_z: &[f32], alpha: &[f32]) {
        let len = view_z.len().next_multiple_of(LANES) + LANES;
        for column in &mut self.codes {
            column.resize(len, EMPTY);
        }
        self.z.resize(len, 0.0);
        self.absorbance.resize(len, 0.0);
        for (index, (view_z, alpha)) in view_z.chunks(LANES).zip(alpha.chunks(LANES)).enumerate() {
            let (v, mut a) = (padded(view_z, 1.0), Lanes(padded(alpha, 0.0)));
            a.store(absorbance_lanes(simd, a.load(simd)));
            let at = index * LANES;
            let [nearest, farthest, heavy] = self.codes.each_mut().map(|column| vector(column, at));
            let (z, absorbance) = (vector(&mut self.z, at), vector(&mut self.absorbance, at));
            // A loop and no closure: only what is inlined here is compiled for this level's vectors.
            for i in 0..LANES {
                let fragment = codes.fragment(v[i], a.0[i]);
                let offered = u32::from(fragment.absorbance_step > 0).wrapping_neg();
                nearest[i] = codes.encode(Slot::Nearest, fragment) & offered;
                farthest[i] = codes.encode(Slot::Farthest, fragment) & offered;
                heavy[i] = codes.encode(Slot::Heavy, fragment) & offered;
                z[i] = codes.moment_depth(fragment.depth_step);
                absorbance[i] = codes.absorbance(fragment.absorbance_step);
            }
        }
    }

    /// Pass 1 over a pixel of two fragments or more: what [`Sums::add`] of each makes. The slots end with the nearest,
    /// the farthest of the others and the heaviest of the rest, so that they can be chosen one after the other here.
    #[inline(always)]
    fn sums<const N: usize>(&self, slots: usize, own: Range<usize>) -> Sums<N> {
        let mut sums = Sums::<N>::default();
        let [nearest, farthest, heavy] = self.codes.each_ref().map(|column| &column[own.clone()]);
        let (z, absorbance) = (&self.z[own.clone()], &self.absorbance[own]);
        for (&z, &absorbance) in z.iter().zip(absorbance) {
            sums.count += u32::from(absorbance > 0.0);
            sums.add_moments(z, absorbance);
        }
        let first = greatest(nearest, usize::MAX);
        let last = greatest(farthest, first);
        (sums.slots[0], sums.slots[1]) = (nearest[first], farthest[last]);
        let kept = &mut sums.slots[2..slots];
        if let Some(least) = kept.len().checked_sub(1) {
            for (i, &code) in heavy.iter().enumerate() {
                if code > kept[least] && i != first && i != last {
                    let mut code = code;
                    for slot in &mut *kept {
                        (*slot, code) = (code.max(*slot), code.min(*slot));
                    }
                }
            }
        }
        sums
    }
}

/// Sixteen numbers of a column.
#[inline(always)]
fn vector<T>(column: &mut [T], at: usize) -> &mut [T; LANES] {
    column[at..].first_chunk_mut().expect("columns end with a whole vector")
}

/// Where the greatest code stands, but for one place; at that place where there is no other.
#[inline(always)]
fn greatest(codes: &[u32], except: usize) -> usize {
    let (mut at, mut most) = (except, None);
    for (i, &code) in codes.iter().enumerate() {
        if i != except && most.is_none_or(|most| code > most) {
            (at, most) = (i, Some(code));
        }
    }
    at
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
    tail: Tail<'a>,
    /// Made for the first fragment that needs the network.
    waiting: Option<Waiting<'a>>,
    is_faint_known: bool,
    tally: Tally,
}

impl Workspace<'_> {
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
            let sums = self.coded.sums::<N>(self.slots, own.clone());
            let between = Between::new(self.codes, self.slots, &sums);
            self.pass_2(simd, &between, own, out, classes);
        }
        if let Some(waiting) = &mut self.waiting {
            waiting.flush(out);
        }
    }

    /// Both passes over a pixel whose fragments are all in the core.
    #[inline(always)]
    fn all_in_core<S: Simd>(&mut self, simd: S, own: Range<usize>, out: &mut [f32], classes: &mut [Class]) {
        let z = f32x16::from_slice(simd, &self.coded.z[own.start..own.start + LANES]);
        let zero = f32x16::splat(simd, 0.0);
        let mut front = zero;
        for i in own.clone() {
            let core_z = f32x16::splat(simd, self.coded.z[i]);
            let core_absorbance = f32x16::splat(simd, self.coded.absorbance[i]);
            front += Select::select(core_z.simd_lt(z), core_absorbance, zero);
        }
        store(transmittance(front, zero, zero).into(), &own, out);
        self.store_classes([0, 0], own, classes);
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
            let some = at..own.end.min(at + LANES);
            let z = f32x16::from_slice(simd, &self.coded.z[at..at + LANES]);
            let absorbance = f32x16::from_slice(simd, &self.coded.absorbance[at..at + LANES]);
            let answers = between.answers(z, absorbance);
            let zero = f32x16::splat(simd, 0.0);
            let mut t = transmittance(answers.depth, zero, zero);
            let (mut unknown, mut faint) = (!answers.is_known.to_bitmask() & ((1 << some.len()) - 1), 0);
            if unknown != 0 {
                let query = &answers.query;
                match self.tail {
                    Tail::Law => {
                        t = Select::select(answers.is_known, t, by_law(query));
                        unknown = 0;
                    }
                    Tail::Network(network) => {
                        if self.is_faint_known {
                            let [_, _, _, lower, upper] = query.fixed;
                            let noise = between.bounds_noise(query);
                            let [most, least] = allowed(query.front, query.tail, [lower, upper], noise);
                            let opacity = f32x16::splat(simd, 1.0) - transmittance(absorbance, zero, zero);
                            let is_faint = (opacity * (most - least)).simd_le(f32x16::splat(simd, 2.0 * VISIBLE));
                            faint = unknown & is_faint.to_bitmask();
                            if faint != 0 {
                                let middle = (most + least) * f32x16::splat(simd, 0.5);
                                t = Select::select(answers.is_known, t, middle);
                                unknown &= !faint;
                            }
                        }
                        if unknown != 0 {
                            self.waiting
                                .get_or_insert_with(|| Waiting::new(network, FIXED + N - 1))
                                .push(simd, query, unknown, some.clone());
                        }
                    }
                }
            }
            store(t.into(), &some, out);
            self.store_classes([unknown, faint], some, classes);
            if let Some(waiting) = &mut self.waiting
                && waiting.is_full()
            {
                waiting.flush(out);
            }
        }
    }

    /// Writes down and counts what decided some fragments of a vector: the network for those whose bits are set, bounds
    /// that leave next to nothing open, and else what is known.
    #[inline(always)]
    fn store_classes(&mut self, [network, faint]: [u64; 2], fragments: Range<usize>, classes: &mut [Class]) {
        let of = |lane: usize| match (network >> lane & 1, faint >> lane & 1) {
            (0, 0) => Class::Known,
            (0, _) => Class::Faint,
            _ => Class::Network,
        };
        store(lanes::array(of), &fragments, classes);
        let [network, faint] = [network, faint].map(|lanes| u64::from(lanes.count_ones()));
        self.tally.rows += network;
        self.tally.classes[Class::Network as usize] += network;
        self.tally.classes[Class::Faint as usize] += faint;
        self.tally.classes[Class::Known as usize] += fragments.len() as u64 - network - faint;
    }
}

/// Writes what there is of some fragments of a vector. Fragments behind them get something too, where there are any,
/// which is written over: pixels are gone through in order, and those that wait for the network lie in front.
#[inline(always)]
fn store<T: Copy>(of_lanes: [T; LANES], fragments: &Range<usize>, out: &mut [T]) {
    match out[fragments.start..].first_chunk_mut() {
        Some(out) => *out = of_lanes,
        None => out[fragments.clone()].copy_from_slice(&of_lanes[..fragments.len()]),
    }
}

/// Numbers of a vector, with a filler behind them where they are fewer.
#[inline(always)]
fn padded(values: &[f32], filler: f32) -> [f32; LANES] {
    match values.first_chunk() {
        Some(values) => *values,
        None => std::array::from_fn(|i| values.get(i).copied().unwrap_or(filler)),
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

    /// Pass 1 by choosing is pass 1 by the chain: the same slots, count and sums to the bit, with doubles, ties, and
    /// fragments that absorb nothing. Control: the pixel without its last fragment.
    #[test]
    fn chosen_cores_are_those_of_the_chain() {
        let mut changed = 0;
        for seed in 0..6 {
            let list = random_list(seed);
            let (v0, v1) = list.depth_range().unwrap();
            let set = CoreSet::new((3 * seed as usize) % 9, 4);
            let codes = set.layout.codes(v0, v1);
            let mut coded = Coded::default();
            dispatch!(Level::new(), simd => coded.fill(simd, &codes, list.view_z(), list.alpha()));
            for own in list.offsets().windows(2).filter(|of| of[1] - of[0] > 1) {
                let own = own[0] as usize..own[1] as usize;
                let mut expected = Sums::<5>::default();
                for i in own.clone() {
                    if let Some(fragment) = codes.decode(Slot::Heavy, coded.codes[2][i]) {
                        expected.add(&codes, set.slots(), fragment);
                    }
                }
                let parts = |sums: Sums<5>| (sums.slots, sums.count, sums.b.map(f32::to_bits));
                let found = parts(coded.sums(set.slots(), own.clone()));
                assert_eq!(found, parts(expected), "{set:?} {own:?}");
                changed +=
                    usize::from(own.len() > 2 && found != parts(coded.sums(set.slots(), own.start..own.end - 1)));
            }
        }
        assert!(changed > 1000);
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
