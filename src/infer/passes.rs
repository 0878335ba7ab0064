//! Both passes over many pixels, sixteen fragments at once: what [`Extractor::pixel`] says of one, made fast, with a
//! network in the middle.
//!
//! Pass 2 first sorts fragments into classes with little arithmetic. What is known leaves its optical depth; what a
//! closed form or the network must answer waits in a queue until sixteen wait, of whatever pixels, and goes through its
//! arithmetic in lanes. So every fragment's answer depends on that fragment and the sums of its pixel alone, not on its
//! company, and to leave out the network where its answer is not used changes no bit of the rest.

use super::classes::{Class, Switches, Tally};
use super::queue::{Queue, Summed};
use crate::features::recentred::formulas::{ALONE, half_range, is_thin, moment_depth};
use crate::features::recentred::{FragmentTerms, PixelSums};
use crate::features::visible::{FAINT, MIN_WEIGHT, first_hidden_depth};
use crate::features::{Extractor, MomentFrame, SumPrecision};
use crate::numeric::lanes::{LANES, Lanes, exp};
use crate::pixel::{FragmentList, LogWarp, absorbance_lanes};
use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, f32x16, mask32x16};
use rayon::prelude::*;

/// Rows of features that wait for the network, column by column.
pub type Column = [f32; ROWS];

/// Rows that the network is evaluated for at once.
pub const ROWS: usize = 256;

/// What one thread works in.
struct Workspace<const K: usize> {
    level: Level,
    switches: Switches,
    /// Fragments that a closed form answers.
    short: Queue<K>,
    /// Fragments that the network will answer, and those that may be hidden.
    waiting: [Queue<K>; 2],
    columns: Vec<Column>,
    /// The fragment of each row, or [`DROPPED`].
    who: Vec<u32>,
    /// Pixels with hidden fragments.
    hiding: Vec<u32>,
    /// Rows that the network was run for.
    rows: u64,
}

pub(super) const DROPPED: u32 = u32::MAX;

/// Pixels that one thread takes at once, and their fragments.
struct Task<'a, const K: usize> {
    /// Of the list.
    pixels: std::ops::Range<usize>,
    view_z: &'a [f32],
    alpha: &'a [f32],
    /// Those pixels that hold fragments.
    summed: Vec<Summed<K>>,
    z: &'a mut [f32],
    absorbance: &'a mut [f32],
    out: &'a mut [f32],
    class: &'a mut [Class],
}

impl<const K: usize> Workspace<K> {
    fn new(switches: Switches, columns: usize) -> Self {
        Self {
            level: Level::new(),
            switches,
            short: Queue::new(),
            waiting: [Queue::new(), Queue::new()],
            columns: vec![[0.0; ROWS]; columns],
            who: Vec::with_capacity(ROWS),
            hiding: Vec::new(),
            rows: 0,
        }
    }

    /// The closed forms of what waits for them.
    fn flush_short(&mut self, task: &mut Task<'_, K>, network: &mut impl FnMut(&[Column], &mut [f32])) {
        for (at, len) in self.short.take() {
            let mut depth = Lanes::ZERO;
            let short = &self.short;
            dispatch!(self.level, simd => {
                let fragments = short.load(simd, at / LANES);
                depth.store(fragments.closed_form());
            });
            for (lane, &depth) in depth.0[..len].iter().enumerate() {
                let (fragment, pixel) = (
                    self.short.fragment[at + lane] as usize,
                    self.short.pixel[at + lane] as usize,
                );
                let of = task.summed[pixel];
                task.out[fragment] = depth;
                task.class[fragment] = if of.sums.count == 3 { Class::Three } else { Class::Four };
                if !self.switches.short {
                    self.run_for_nothing(task, network, &of, fragment, pixel);
                }
            }
        }
    }

    /// Puts a fragment into the queue of the network, or of those that may be hidden if it lies deep enough.
    #[inline(always)]
    fn enqueue(
        &mut self,
        task: &mut Task<'_, K>,
        network: &mut impl FnMut(&[Column], &mut [f32]),
        of: &Summed<K>,
        fragment: usize,
        pixel: usize,
        deep: bool,
    ) {
        // Branch-free: this would mispredict.
        let queue = &mut self.waiting[usize::from(deep)];
        queue.push(
            task.view_z[fragment],
            task.z[fragment],
            task.absorbance[fragment],
            of,
            fragment as u32,
            pixel,
        );
        if queue.is_full() {
            self.flush(deep, task, network);
        }
    }

    /// Runs the network for a fragment whose answer is known, and drops what it says.
    fn run_for_nothing(
        &mut self,
        task: &mut Task<'_, K>,
        network: &mut impl FnMut(&[Column], &mut [f32]),
        of: &Summed<K>,
        fragment: usize,
        pixel: usize,
    ) {
        self.waiting[0].push(
            task.view_z[fragment],
            task.z[fragment],
            task.absorbance[fragment],
            of,
            DROPPED,
            pixel,
        );
        if self.waiting[0].is_full() {
            self.flush(false, task, network);
        }
    }

    /// Features of what waits and, of the deep ones, is not hidden.
    fn flush(&mut self, deep: bool, task: &mut Task<'_, K>, network: &mut impl FnMut(&[Column], &mut [f32])) {
        for (at, len) in self.waiting[usize::from(deep)].take() {
            let queue = &self.waiting[usize::from(deep)];
            let (columns, row) = (&mut self.columns, self.who.len());
            let mut hidden = 0;
            dispatch!(self.level, simd => hidden = queue.load(simd, at / LANES).fill(deep, columns, row));
            hidden &= (1 << len) - 1;
            let fragments = &queue.fragment[at..at + len];
            if hidden == 0 {
                self.who.extend_from_slice(fragments);
            } else {
                self.who.extend(
                    fragments
                        .iter()
                        .enumerate()
                        .filter(|(lane, _)| hidden >> lane & 1 == 0)
                        .map(|(_, f)| f),
                );
            }
            while hidden != 0 {
                let lane = hidden.trailing_zeros() as usize;
                hidden &= hidden - 1;
                let (fragment, pixel) = (fragments[lane] as usize, queue.pixel[at + lane]);
                task.out[fragment] = task.summed[pixel as usize].sums.b0 - task.absorbance[fragment];
                task.class[fragment] = Class::Hidden;
                if self.hiding.last() != Some(&pixel) {
                    self.hiding.push(pixel);
                }
            }
            if self.who.len() > ROWS - LANES {
                self.flush_rows(task, network);
            }
        }
    }

    /// The network's answers to what waits.
    fn flush_rows(&mut self, task: &mut Task<'_, K>, network: &mut impl FnMut(&[Column], &mut [f32])) {
        let mut out = [0.0; ROWS];
        let rows = self.who.len();
        network(&self.columns, &mut out[..rows]);
        self.rows += rows as u64;
        for (fragment, t) in self.who.drain(..).zip(out) {
            if fragment != DROPPED {
                task.out[fragment as usize] = t;
            }
        }
    }

    fn flush_all(&mut self, task: &mut Task<'_, K>, network: &mut impl FnMut(&[Column], &mut [f32])) {
        self.flush_short(task, network);
        self.flush(true, task, network);
        self.flush(false, task, network);
        self.flush_rows(task, network);
    }

    /// Pass 2.
    fn pass_2(&mut self, task: &mut Task<'_, K>, network: &mut impl FnMut(&[Column], &mut [f32])) {
        let Switches {
            ends, faint, hidden, ..
        } = self.switches;
        task.class.fill(Class::Network);
        for at in 0..task.summed.len() {
            let of = task.summed[at];
            let PixelSums {
                b0,
                count,
                nearest,
                farthest,
                ..
            } = of.sums;
            let faint = faint && b0 <= FAINT;
            let deep_from = if hidden {
                first_hidden_depth(b0, of.sums.b[0], of.sums.b[1])
            } else {
                f32::INFINITY
            };
            for fragment in of.first as usize..(of.first + count) as usize {
                let (view_z, absorbance) = (task.view_z[fragment], task.absorbance[fragment]);
                let others = (b0 - absorbance).max(0.0);
                let (near, alone) = (view_z == nearest, others <= ALONE as f32 * b0);
                if near | alone | (view_z == farthest) {
                    task.out[fragment] = if near | alone { 0.0 } else { others };
                    let behind = if alone { Class::Alone } else { Class::Farthest };
                    task.class[fragment] = if near { Class::Nearest } else { behind };
                    if !ends {
                        self.run_for_nothing(task, network, &of, fragment, at);
                    }
                } else if count <= 4 {
                    self.short
                        .push(view_z, task.z[fragment], absorbance, &of, fragment as u32, at);
                    if self.short.is_full() {
                        self.flush_short(task, network);
                    }
                } else if faint {
                    task.faint(&of, fragment);
                } else {
                    self.enqueue(task, network, &of, fragment, at, task.z[fragment] >= deep_from);
                }
            }
        }
        self.flush_all(task, network);
        let (level, out, class) = (self.level, &mut *task.out, &*task.class);
        dispatch!(level, simd => transmittances(simd, out, class));
        self.recheck_hidden(task, network);
    }

    /// Evaluates the network for hidden fragments after all where the weights of their pixel sum to too little for the
    /// bound to hold.
    fn recheck_hidden(&mut self, task: &mut Task<'_, K>, network: &mut impl FnMut(&[Column], &mut [f32])) {
        let mut hiding = std::mem::take(&mut self.hiding);
        for &pixel in &hiding {
            let of = task.summed[pixel as usize];
            let own = of.first as usize..(of.first + of.sums.count) as usize;
            let weight: f32 = task.alpha[own.clone()]
                .iter()
                .zip(&task.out[own.clone()])
                .map(|(&a, &t)| a * t)
                .sum();
            if weight < MIN_WEIGHT {
                for fragment in own {
                    if task.class[fragment] == Class::Hidden {
                        task.class[fragment] = Class::Network;
                        self.waiting[0].push(
                            task.view_z[fragment],
                            task.z[fragment],
                            task.absorbance[fragment],
                            &of,
                            fragment as u32,
                            pixel as usize,
                        );
                        if self.waiting[0].is_full() {
                            self.flush(false, task, network);
                        }
                    }
                }
            }
        }
        self.flush_all(task, network);
        hiding.clear();
        self.hiding = hiding;
    }
}

/// Optical depths become transmittances; the network's answers are.
#[inline(always)]
fn transmittances<S: Simd>(simd: S, out: &mut [f32], class: &[Class]) {
    for (out, class) in out.chunks_mut(LANES).zip(class.chunks(LANES)) {
        let n = out.len();
        let mut lanes = Lanes::ZERO;
        lanes.0[..n].copy_from_slice(out);
        let answered = class
            .iter()
            .enumerate()
            .fold(0, |mask, (lane, &c)| mask | u64::from(c == Class::Network) << lane);
        let (value, answered) = (lanes.load(simd), mask32x16::from_bitmask(simd, answered));
        lanes.store(answered.select(value, exp(simd, -value)));
        out.copy_from_slice(&lanes.0[..n]);
    }
}

impl<const K: usize> Task<'_, K> {
    #[inline(always)]
    fn faint(&mut self, of: &Summed<K>, fragment: usize) {
        self.out[fragment] = 0.5 * (of.sums.b0 - self.absorbance[fragment]);
        self.class[fragment] = Class::Faint;
    }

    /// Pass 1.
    fn pass_1(&mut self, list: &FragmentList, warp: &LogWarp, frame: MomentFrame) {
        let (view_z, alpha, z, absorbance) = (self.view_z, self.alpha, &mut *self.z, &mut *self.absorbance);
        dispatch!(Level::new(), simd => transform_depths(simd, warp, view_z, alpha, z, absorbance));
        let offsets = &list.offsets()[self.pixels.start..=self.pixels.end];
        if frame == MomentFrame::Pixel {
            // The prepass, and depths in each pixel's own range.
            dispatch!(Level::new(), simd => transform_depths_by_pixel(simd, offsets, view_z, z));
        }
        self.summed.reserve_exact(self.pixels.len().min(self.z.len()));
        for of in offsets.windows(2).filter(|of| of[0] < of[1]) {
            let own = (of[0] - offsets[0]) as usize..(of[1] - offsets[0]) as usize;
            let mut sums = PixelSums::<f32, K>::default();
            let mut ends = [0.0; 2];
            let first = own.start as u32;
            for ((&view_z, &z), &absorbance) in self.view_z[own.clone()]
                .iter()
                .zip(&self.z[own.clone()])
                .zip(&self.absorbance[own])
            {
                sums.add(FragmentTerms { view_z, z, absorbance });
                if sums.nearest == view_z {
                    ends[0] = z;
                }
                if sums.farthest == view_z {
                    ends[1] = z;
                }
            }
            let [centre, half_range] = half_range(ends);
            let thin = is_thin(sums.nearest, sums.farthest);
            self.summed.push(Summed {
                sums,
                centre,
                half_range,
                thin,
                first,
            });
        }
    }
}

/// Moment depths and absorbances.
#[inline(always)]
fn transform_depths<S: Simd>(
    simd: S,
    warp: &LogWarp,
    view_z: &[f32],
    alpha: &[f32],
    z: &mut [f32],
    absorbance: &mut [f32],
) {
    let chunks = view_z
        .chunks(LANES)
        .zip(alpha.chunks(LANES))
        .zip(z.chunks_mut(LANES).zip(absorbance.chunks_mut(LANES)));
    for ((view_z, alpha), (z, absorbance)) in chunks {
        let n = z.len();
        let mut lanes = Lanes([1.0; LANES]);
        lanes.0[..n].copy_from_slice(view_z);
        lanes.store(warp.moment_lanes(simd, lanes.load(simd)));
        z.copy_from_slice(&lanes.0[..n]);
        lanes.0[..n].copy_from_slice(alpha);
        lanes.store(absorbance_lanes(simd, lanes.load(simd)));
        absorbance.copy_from_slice(&lanes.0[..n]);
    }
}

/// Moment depths between the nearest and the farthest fragment of every pixel; `offsets` count from those of the first.
#[inline(always)]
fn transform_depths_by_pixel<S: Simd>(simd: S, offsets: &[u64], view_z: &[f32], z: &mut [f32]) {
    for of in offsets.windows(2) {
        let own = (of[0] - offsets[0]) as usize..(of[1] - offsets[0]) as usize;
        let (nearest, farthest) = view_z[own.clone()]
            .iter()
            .fold((f32::INFINITY, 0.0f32), |(lo, hi), &v| (lo.min(v), hi.max(v)));
        let range = [f32x16::splat(simd, nearest), f32x16::splat(simd, farthest)];
        for (view_z, z) in view_z[own.clone()].chunks(LANES).zip(z[own].chunks_mut(LANES)) {
            let n = z.len();
            let mut lanes = Lanes([nearest; LANES]);
            lanes.0[..n].copy_from_slice(view_z);
            lanes.store(moment_depth(lanes.load(simd), range));
            z.copy_from_slice(&lanes.0[..n]);
        }
    }
}

/// Both passes over the pixels of a list.
#[derive(Debug, Clone, Copy)]
pub struct Passes {
    moments: usize,
    width: usize,
    warp: LogWarp,
    frame: MomentFrame,
}

impl Passes {
    /// Both passes of a feature set, where they are made for many pixels: recentred ones with moments summed in f32.
    pub fn of(extractor: &Extractor) -> Option<Self> {
        let set = extractor.set();
        let has_lanes = set.spec().sums.has_precisions && extractor.precision() == SumPrecision::F32;
        has_lanes.then(|| Self {
            moments: set.moments(),
            width: set.width(),
            warp: extractor.log_warp(),
            frame: extractor.frame(),
        })
    }

    /// Transmittances of every fragment of pixels `range`, in the order of the list, and what decided each, on all
    /// cores. `network` makes the function that a thread asks: it answers the first `out.len()` rows of columns.
    ///
    /// # Accuracy
    /// What is known and the features differ from [`Extractor::pixel`]'s by rounding in f32;
    /// `passes_follow_the_extractor`.
    ///
    /// # Shapes
    /// `out`, `class`: one a fragment of the range.
    ///
    /// # Panics
    /// If either has another length.
    pub fn run<N: FnMut(&[Column], &mut [f32])>(
        &self,
        list: &FragmentList,
        range: std::ops::Range<usize>,
        switches: Switches,
        network: impl Fn() -> N + Sync,
        out: &mut [f32],
        class: &mut [Class],
    ) -> Tally {
        match self.moments {
            4 => self.run_of::<4, N>(list, range, switches, network, out, class),
            6 => self.run_of::<6, N>(list, range, switches, network, out, class),
            _ => self.run_of::<8, N>(list, range, switches, network, out, class),
        }
    }

    fn run_of<const K: usize, N: FnMut(&[Column], &mut [f32])>(
        &self,
        list: &FragmentList,
        range: std::ops::Range<usize>,
        switches: Switches,
        network: impl Fn() -> N + Sync,
        out: &mut [f32],
        class: &mut [Class],
    ) -> Tally {
        // Fragments of one task, about.
        const TASK: u64 = 4096;
        let offsets = list.offsets();
        let fragments = (offsets[range.end] - offsets[range.start]) as usize;
        assert_eq!(
            (out.len(), class.len()),
            (fragments, fragments),
            "one answer a fragment"
        );
        let start = std::time::Instant::now();
        let (mut z, mut absorbance) = (vec![0.0; fragments], vec![0.0; fragments]);
        let mut tasks: Vec<Task<'_, K>> = Vec::new();
        let mut rest = (z.as_mut_slice(), absorbance.as_mut_slice(), out, class);
        let mut first = range.start;
        while first < range.end {
            // Empty pixels take a little time too.
            let most = range.end.min(first + 4 * TASK as usize);
            let end = offsets[..=most]
                .partition_point(|&o| o < offsets[first] + TASK)
                .clamp(first + 1, most);
            let own = offsets[first] as usize..offsets[end] as usize;
            let (z, z_rest) = rest.0.split_at_mut(own.len());
            let (absorbance, absorbance_rest) = rest.1.split_at_mut(own.len());
            let (out, out_rest) = rest.2.split_at_mut(own.len());
            let (class, class_rest) = rest.3.split_at_mut(own.len());
            rest = (z_rest, absorbance_rest, out_rest, class_rest);
            let (view_z, alpha) = (&list.view_z()[own.clone()], &list.alpha()[own]);
            tasks.push(Task {
                pixels: first..end,
                view_z,
                alpha,
                summed: Vec::new(),
                z,
                absorbance,
                out,
                class,
            });
            first = end;
        }
        tasks
            .par_iter_mut()
            .for_each(|task| task.pass_1(list, &self.warp, self.frame));
        let seconds_pass_1 = start.elapsed().as_secs_f64();
        let start = std::time::Instant::now();
        let mut tally: Tally = tasks
            .par_iter_mut()
            .map_init(
                || (Workspace::<K>::new(switches, self.width), network()),
                |(work, network), task| {
                    work.rows = 0;
                    work.pass_2(task, network);
                    let mut tally = Tally {
                        rows: work.rows,
                        ..Tally::default()
                    };
                    task.class.iter().for_each(|&c| tally.classes[c as usize] += 1);
                    tally
                },
            )
            .reduce(Tally::default, |mut a, b| {
                a.add(&b);
                a
            });
        tally.seconds_pass_1 = seconds_pass_1;
        tally.seconds_pass_2 = start.elapsed().as_secs_f64();
        tally
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::features::{FeatureSet, Known, visible};
    use crate::numeric::rng::{Stream, stream};
    use crate::pixel::{absorbance, abuffer};
    use rand::RngExt;
    use std::sync::Mutex;

    /// Pixels of every kind: few and many fragments, faint and opaque ones, bunches, ties, alpha 0 and 1; colours at
    /// the ends of their range.
    pub(crate) fn pixels(rng: &mut Stream, pixels: usize) -> FragmentList {
        let (mut offsets, mut view_z, mut alpha, mut color) = (vec![0], vec![], vec![], vec![]);
        for _ in 0..pixels {
            let n = [0, 1, 2, 3, 4, 5, 6, 9, 17, 40, 130][rng.random_range(0..11)];
            let (near, range) = (rng.random_range(1.0..50.0f32), libm::expf(rng.random_range(-9.0..0.0)));
            let most: f32 = [1.0, 0.999, 0.95, 0.5, 0.02, 0.004][rng.random_range(0..6)];
            let bunch = rng.random_range(0.0..1.0f32);
            for i in 0..n {
                let t: f32 = match rng.random_range(0..4) {
                    0 => bunch,
                    1 => bunch * bunch * rng.random_range(0.9..1.0f32),
                    _ => rng.random_range(0.0..1.0),
                };
                view_z.push(near * (1.0 + range * t));
                let a: f32 = match (i + n) % 7 {
                    0 => most,
                    1 => 0.0,
                    _ => most * rng.random_range(0.0..1.0f32),
                };
                alpha.push(a);
                color.push(std::array::from_fn(|_| f32::from(rng.random_range(0..2u8))));
            }
            offsets.push(view_z.len() as u64);
        }
        FragmentList::new(offsets, view_z, alpha, Some(color)).unwrap()
    }

    /// Keeps the rows that it is given, row by row, and answers the first feature, so that rows can be told apart.
    fn listener(rows: &Mutex<Vec<Vec<f32>>>) -> impl Fn(&[Column], &mut [f32]) + '_ {
        |columns, out| {
            let mut rows = rows.lock().unwrap();
            for (row, out) in out.iter_mut().enumerate() {
                rows.push(columns.iter().map(|c| c[row]).collect());
                *out = columns[0][row];
            }
        }
    }

    fn run(
        extractor: &Extractor,
        list: &FragmentList,
        switches: Switches,
    ) -> (Vec<f32>, Vec<Class>, Tally, Vec<Vec<f32>>) {
        let rows = Mutex::new(Vec::new());
        let (mut out, mut class) = (vec![f32::NAN; list.len()], vec![Class::Network; list.len()]);
        let passes = Passes::of(extractor).unwrap();
        let tally = passes.run(
            list,
            0..list.pixels(),
            switches,
            || listener(&rows),
            &mut out,
            &mut class,
        );
        (out, class, tally, rows.into_inner().unwrap())
    }

    const EXACT: Switches = Switches {
        ends: true,
        short: true,
        faint: false,
        hidden: false,
    };
    const VISIBLE: Switches = Switches {
        ends: true,
        short: true,
        faint: true,
        hidden: true,
    };

    /// Against [`Extractor::pixel`]: the network is evaluated for the same fragments; what is known to 1e-5, in pixels
    /// of four that are not thin to 1e-3, and the features of pixels that are not thin to f32 rounding. Controls: the
    /// values one fragment on.
    #[test]
    fn passes_follow_the_extractor() {
        for set in [FeatureSet::Recentred, FeatureSet::Recentred6, FeatureSet::Recentred8] {
            let list = pixels(&mut stream(1, 94, 0), 1500);
            let extractor = Extractor::for_list(set, &list, None, None).unwrap();
            let (out, class, tally, rows) = run(&extractor, &list, EXACT);
            let evaluated: Vec<usize> = (0..list.len()).filter(|&i| class[i] == Class::Network).collect();
            assert_eq!(
                (tally.rows as usize, rows.len(), tally.of(Class::Network) as usize),
                (evaluated.len(), evaluated.len(), evaluated.len())
            );
            assert_eq!(tally.fragments() as usize, list.len());
            let width = set.width();
            let (mut controls, mut compared) = (0, 0);
            let mut known_before = None;
            for p in 0..list.pixels() {
                let range = list.range(p);
                let (mut whole, mut known) = (vec![0.0; range.len() * width], vec![Known::Front(0.0); range.len()]);
                extractor.pixel(list.pixel(p), &mut whole, &mut known).unwrap();
                let (near, far) = list
                    .pixel(p)
                    .view_z
                    .iter()
                    .fold((f32::INFINITY, 0.0f32), |(a, b), &v| (a.min(v), b.max(v)));
                let thin = far < 1.6 * near;
                for ((i, row), known) in range.clone().zip(whole.chunks_exact(width)).zip(known) {
                    assert_eq!(known == Known::Front(1.0), class[i] == Class::Network);
                    if let Known::Transmittance(known) = known {
                        // Moments of thin pixels are what rounding makes of them; in pixels of three only the mean
                        // counts.
                        let bar = match class[i] {
                            Class::Three => 0.03,
                            Class::Four if thin => 1.0,
                            Class::Four => 1e-3,
                            _ => 1e-5,
                        };
                        assert!((out[i] - known).abs() <= bar, "{:?}: {} for {known}", class[i], out[i]);
                        controls += usize::from(known_before.is_none_or(|before: f32| (out[i] - before).abs() > 1e-5));
                        known_before = Some(known);
                    } else {
                        if thin {
                            continue;
                        }
                        let found = rows.iter().find(|r| {
                            (r[0] - row[0]).abs() < 1e-5 && (r[2] - row[2]).abs() < 1e-5 && (r[3] - row[3]).abs() < 1e-3
                        });
                        let found = found.unwrap_or_else(|| panic!("no row like {row:?}"));
                        for (k, (f, e)) in found.iter().zip(&row[..7]).enumerate() {
                            // The square root of a small spread makes much of rounding; its square does not.
                            let (f, e) = if k == 6 { (f * f, e * e) } else { (*f, *e) };
                            assert!(
                                (f - e).abs() <= if k < 5 { 1e-3 } else { 2e-2 },
                                "{set:?}, column {k}: {found:?} for {row:?}"
                            );
                        }
                        compared += 1;
                    }
                }
            }
            assert!(compared > 100 && controls > 500, "{compared} {controls}");
        }
    }

    /// The same to the bit in any company, on any number of threads, and with switches off but for what they run in
    /// vain.
    #[test]
    fn company_threads_and_switches_change_no_bit() {
        let list = pixels(&mut stream(2, 94, 0), 3000);
        let extractor = Extractor::for_list(FeatureSet::Recentred, &list, None, None).unwrap();
        let (all, class, tally, _) = run(&extractor, &list, EXACT);
        let (none, class_none, tally_none, _) = run(&extractor, &list, Switches::default());
        assert_eq!(
            all.iter().map(|t| t.to_bits()).collect::<Vec<_>>(),
            none.iter().map(|t| t.to_bits()).collect::<Vec<_>>()
        );
        assert_eq!(class, class_none);
        assert!(tally_none.rows as usize == list.len() && tally.rows < tally_none.rows);
        let one = rayon::ThreadPoolBuilder::new()
            .num_threads(1)
            .build()
            .unwrap()
            .install(|| run(&extractor, &list, EXACT).0);
        assert_eq!(all, one);
        let passes = Passes::of(&extractor).unwrap();
        for range in [0..1, 17..18, 100..333, 0..list.pixels()] {
            let fragments = list.offsets()[range.start] as usize..list.offsets()[range.end] as usize;
            let (mut out, mut class) = (vec![0.0; fragments.len()], vec![Class::Network; fragments.len()]);
            let rows = Mutex::new(Vec::new());
            passes.run(&list, range, EXACT, || listener(&rows), &mut out, &mut class);
            assert_eq!(out, all[fragments]);
        }
    }

    /// What every pixel's hidden fragments weigh in the exact image, in f64: at most 1/1024 in all; and the lanes
    /// decide as the f64 rule would, never more boldly than its truth allows. Control: the fragments that are not
    /// hidden weigh more.
    #[test]
    fn hidden_fragments_weigh_next_to_nothing() {
        for set in [FeatureSet::Recentred, FeatureSet::Recentred8] {
            let list = pixels(&mut stream(3, 94, 0), 20_000);
            let extractor = Extractor::for_list(set, &list, None, None).unwrap();
            let (_, class, tally, _) = run(&extractor, &list, VISIBLE);
            let truth = abuffer::list_transmittance(&list);
            let (mut worst, mut hidden, mut rest) = (0.0f64, 0, 0.0f64);
            for p in 0..list.pixels() {
                let weight = |class_is: &dyn Fn(Class) -> bool| -> f64 {
                    list.range(p)
                        .filter(|&i| class_is(class[i]))
                        .map(|i| f64::from(list.alpha()[i]) * truth[i])
                        .sum()
                };
                worst = worst.max(weight(&|c| c == Class::Hidden));
                rest = rest.max(weight(&|c| c == Class::Network));
                hidden += list.range(p).filter(|&i| class[i] == Class::Hidden).count();
                if tally.of(Class::Faint) > 0 && list.range(p).any(|i| class[i] == Class::Faint) {
                    let b0: f64 = list.pixel(p).alpha.iter().map(|&a| absorbance(a)).sum();
                    assert!(b0 <= f64::from(visible::FAINT) * (1.0 + 1e-5));
                }
            }
            assert!(
                worst <= 1.0 / 1024.0 && hidden > 1000 && rest > 0.1,
                "{worst} of {hidden}; {rest}"
            );
            assert!(tally.of(Class::Faint) > 1000);
        }
    }
}
