//! Both passes over many pixels, sixteen fragments at once: what [`Extractor::pixel`](super::Extractor::pixel) says of one, made fast, with a network in the middle.
//!
//! Pass 2 first sorts fragments into classes with little arithmetic. What is known leaves its optical depth; what a closed form or the network must answer waits in
//! a queue until sixteen wait, of whatever pixels, and goes through its arithmetic in lanes. So every fragment's answer depends on that fragment and the sums of its pixel alone, not
//! on its company, and to leave out the network where its answer is not used changes no bit of the rest.

use super::recentred::{FragmentTerms, MIN_HALF_RANGE, PixelSums, is_thin, place_in_thin};
use super::visible::{FAINT, MIN_WEIGHT, first_hidden_depth};
use super::wide::{Fragments, moment_depth};
use super::{Extractor, Kind, MomentFrame, SumPrecision};
use crate::numeric::lanes::{LANES, Lanes, exp};
use crate::pixel::{FragmentList, LogWarp, absorbance_lanes};
use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, f32x16, mask32x16};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Which fragments the network is spared. Those that are known stay known: a switch that is off only runs the network for them too.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Switches {
    /// Nearest, farthest, and those with nothing else in their pixel.
    pub ends: bool,
    /// Pixels of three and four in closed form.
    pub short: bool,
    /// Pixels that absorb next to nothing; see [`visible`](super::visible).
    pub faint: bool,
    /// What lies behind so much that it is not seen; see [`visible`](super::visible).
    pub hidden: bool,
}

/// What decides a fragment's answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[repr(u8)]
pub enum Class {
    /// Nearest of its pixel: T = 1.
    Nearest,
    /// The others absorb nothing: T = 1.
    Alone,
    /// Farthest of its pixel: T = e^−b_0'.
    Farthest,
    /// One of three: closed form.
    Three,
    /// One of four: closed form.
    Four,
    /// Known without the network, which rule said so not being told apart.
    Known,
    /// Of a faint pixel: e^(−b_0'/2).
    Faint,
    /// Hidden: e^−b_0'.
    Hidden,
    /// The network.
    Network,
}

impl Class {
    /// Every class.
    pub const ALL: [Self; 9] = [
        Self::Nearest,
        Self::Alone,
        Self::Farthest,
        Self::Three,
        Self::Four,
        Self::Known,
        Self::Faint,
        Self::Hidden,
        Self::Network,
    ];

    /// Its name in tables and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Nearest => "nearest",
            Self::Alone => "alone",
            Self::Farthest => "farthest",
            Self::Three => "three",
            Self::Four => "four",
            Self::Known => "known",
            Self::Faint => "faint",
            Self::Hidden => "hidden",
            Self::Network => "network",
        }
    }
}

/// Rows of features that wait for the network, column by column.
pub type Column = [f32; ROWS];

/// Rows that the network is evaluated for at once.
pub const ROWS: usize = 256;

/// Answers rows.
pub trait Network {
    /// Answers to the first `out.len()` rows.
    fn answer(&mut self, columns: &[Column], out: &mut [f32]);
}

/// No network: its answers are NaN.
pub struct Silent;

impl Network for Silent {
    fn answer(&mut self, _: &[Column], out: &mut [f32]) {
        out.fill(f32::NAN);
    }
}

/// A pixel with fragments after pass 1, with what each of them needs in pass 2.
#[derive(Debug, Clone, Copy)]
struct Summed<const K: usize> {
    sums: PixelSums<f32, K>,
    c: f32,
    h: f32,
    /// Whether places in its range are those of view depth.
    thin: bool,
    /// Its first fragment, counted within the task.
    first: u32,
}

/// Vectors of fragments that wait together, so that what was written last has reached the cache before it is read.
const VECTORS: usize = 4;

/// Fragments that wait: z, A, b_0, n, c, h, place in a thin pixel, then b_1..b_K.
struct Queue<const K: usize> {
    fixed: [[Lanes; VECTORS]; 7],
    b: [[Lanes; VECTORS]; K],
    /// The fragment, or [`DROPPED`] where it is known already: the network is run, its answer dropped.
    fragment: [u32; VECTORS * LANES],
    /// Its pixel among those of the task.
    pixel: [u32; VECTORS * LANES],
    len: usize,
}

impl<const K: usize> Queue<K> {
    fn new() -> Self {
        let (fragment, pixel) = ([0; VECTORS * LANES], [0; VECTORS * LANES]);
        Self {
            fixed: [[Lanes([1.0; LANES]); VECTORS]; 7],
            b: [[Lanes::ZERO; VECTORS]; K],
            fragment,
            pixel,
            len: 0,
        }
    }

    #[inline(always)]
    fn push(&mut self, view_z: f32, z: f32, absorbance: f32, of: &Summed<K>, fragment: u32, pixel: usize) {
        let (vector, lane) = (self.len / LANES, self.len % LANES);
        let place = if of.thin {
            place_in_thin(view_z, of.sums.nearest, of.sums.farthest)
        } else {
            2.0
        };
        for (lanes, value) in
            self.fixed
                .iter_mut()
                .zip([z, absorbance, of.sums.b0, of.sums.count as f32, of.c, of.h, place])
        {
            lanes[vector].0[lane] = value;
        }
        for (lanes, value) in self.b.iter_mut().zip(of.sums.b) {
            lanes[vector].0[lane] = value;
        }
        self.fragment[self.len] = fragment;
        self.pixel[self.len] = pixel as u32;
        self.len += 1;
    }

    fn is_full(&self) -> bool {
        self.len == VECTORS * LANES
    }

    #[inline(always)]
    fn load<S: Simd>(&self, simd: S, v: usize) -> Fragments<S, K> {
        let [z, absorbance, b0, count, c, h, place] = std::array::from_fn(|i| self.fixed[i][v].load(simd));
        Fragments {
            z,
            absorbance,
            b0,
            b: std::array::from_fn(|k| self.b[k][v].load(simd)),
            count,
            c,
            h,
            place,
        }
    }

    /// Empties it: first fragments and number of each vector of what stood there.
    fn take(&mut self) -> impl Iterator<Item = (usize, usize)> + use<K> {
        let len = std::mem::take(&mut self.len);
        (0..len).step_by(LANES).map(move |at| (at, (len - at).min(LANES)))
    }
}

/// What one thread works in.
struct Workspace<const K: usize> {
    level: Level,
    switches: Switches,
    /// Fragments that a closed form answers.
    short: Queue<K>,
    /// Fragments that the network will answer, and those that may be hidden.
    evaluated: [Queue<K>; 2],
    columns: Vec<Column>,
    /// The fragment of each row, or [`DROPPED`].
    who: Vec<u32>,
    /// Pixels with hidden fragments.
    hiding: Vec<u32>,
    /// Rows that the network was run for.
    rows: u64,
}

const DROPPED: u32 = u32::MAX;

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

/// What pass 2 did, and how long it took.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Tally {
    /// Fragments of every class, in the order of [`Class::ALL`].
    pub classes: [u64; Class::ALL.len()],
    /// Rows that the network was run for.
    pub rows: u64,
    /// Time of pass 1 \[s\].
    pub seconds_pass_1: f64,
    /// Time of pass 2 \[s\].
    pub seconds_pass_2: f64,
}

impl Tally {
    /// Fragments of a class.
    pub fn of(&self, class: Class) -> u64 {
        self.classes[class as usize]
    }

    /// All fragments.
    pub fn fragments(&self) -> u64 {
        self.classes.iter().sum()
    }

    /// Adds what was done elsewhere.
    pub fn add(&mut self, other: &Self) {
        self.classes.iter_mut().zip(other.classes).for_each(|(a, b)| *a += b);
        self.rows += other.rows;
        self.seconds_pass_1 += other.seconds_pass_1;
        self.seconds_pass_2 += other.seconds_pass_2;
    }
}

impl<const K: usize> Workspace<K> {
    fn new(switches: Switches, columns: usize) -> Self {
        Self {
            level: Level::new(),
            switches,
            short: Queue::new(),
            evaluated: [Queue::new(), Queue::new()],
            columns: vec![[0.0; ROWS]; columns],
            who: Vec::with_capacity(ROWS),
            hiding: Vec::new(),
            rows: 0,
        }
    }

    /// The closed forms of what waits for them.
    fn flush_short(&mut self, task: &mut Task<'_, K>, network: &mut impl Network) {
        for (at, len) in self.short.take() {
            let mut depth = Lanes::ZERO;
            let short = &self.short;
            dispatch!(self.level, simd => {
                let fragments = short.load(simd, at / LANES);
                depth.store(fragments.closed_form(simd, &fragments.describe(simd)));
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

    /// The network, unless the fragment is hidden; only deep ones may be.
    #[inline(always)]
    fn ask(
        &mut self,
        task: &mut Task<'_, K>,
        network: &mut impl Network,
        of: &Summed<K>,
        fragment: usize,
        pixel: usize,
        deep: bool,
    ) {
        // No branch, which nobody could predict.
        let queue = &mut self.evaluated[usize::from(deep)];
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

    /// The network, whose answer is not used.
    fn run_for_nothing(
        &mut self,
        task: &mut Task<'_, K>,
        network: &mut impl Network,
        of: &Summed<K>,
        fragment: usize,
        pixel: usize,
    ) {
        self.evaluated[0].push(
            task.view_z[fragment],
            task.z[fragment],
            task.absorbance[fragment],
            of,
            DROPPED,
            pixel,
        );
        if self.evaluated[0].is_full() {
            self.flush(false, task, network);
        }
    }

    /// Features of what waits and, of the deep ones, is not hidden.
    fn flush(&mut self, deep: bool, task: &mut Task<'_, K>, network: &mut impl Network) {
        for (at, len) in self.evaluated[usize::from(deep)].take() {
            let queue = &self.evaluated[usize::from(deep)];
            let (columns, row) = (&mut self.columns, self.who.len());
            let mut hidden = 0;
            dispatch!(self.level, simd => hidden = describe(simd, &queue.load(simd, at / LANES), deep, columns, row));
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
    fn flush_rows(&mut self, task: &mut Task<'_, K>, network: &mut impl Network) {
        let mut out = [0.0; ROWS];
        let rows = self.who.len();
        network.answer(&self.columns, &mut out[..rows]);
        self.rows += rows as u64;
        for (fragment, t) in self.who.drain(..).zip(out) {
            if fragment != DROPPED {
                task.out[fragment as usize] = t;
            }
        }
    }

    fn flush_all(&mut self, task: &mut Task<'_, K>, network: &mut impl Network) {
        self.flush_short(task, network);
        self.flush(true, task, network);
        self.flush(false, task, network);
        self.flush_rows(task, network);
    }

    /// Pass 2.
    fn pass_2(&mut self, task: &mut Task<'_, K>, network: &mut impl Network) {
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
                let (near, alone) = (view_z == nearest, others <= 1e-6 * b0);
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
                    self.ask(task, network, &of, fragment, at, task.z[fragment] >= deep_from);
                }
            }
        }
        self.flush_all(task, network);
        let (level, out, class) = (self.level, &mut *task.out, &*task.class);
        dispatch!(level, simd => transmittances(simd, out, class));
        self.recheck_hidden(task, network);
    }

    /// Asks the network about hidden fragments after all where the weights of their pixel sum to too little for the bound to hold.
    fn recheck_hidden(&mut self, task: &mut Task<'_, K>, network: &mut impl Network) {
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
                        self.evaluated[0].push(
                            task.view_z[fragment],
                            task.z[fragment],
                            task.absorbance[fragment],
                            &of,
                            fragment as u32,
                            pixel as usize,
                        );
                        if self.evaluated[0].is_full() {
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
            let h = (0.5 * (ends[1] - ends[0])).max(MIN_HALF_RANGE as f32);
            let thin = is_thin(sums.nearest, sums.farthest);
            self.summed.push(Summed {
                sums,
                c: 0.5 * (ends[0] + ends[1]),
                h,
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
        let range = [nearest, farthest].map(|v| f32x16::splat(simd, v));
        for (view_z, z) in view_z[own.clone()].chunks(LANES).zip(z[own].chunks_mut(LANES)) {
            let n = z.len();
            let mut lanes = Lanes([nearest; LANES]);
            lanes.0[..n].copy_from_slice(view_z);
            lanes.store(moment_depth(simd, lanes.load(simd), range));
            z.copy_from_slice(&lanes.0[..n]);
        }
    }
}

/// Puts the features of those of sixteen fragments that are not hidden into the columns, and says which are; none is where one does not look.
#[inline(always)]
fn describe<S: Simd, const K: usize>(
    simd: S,
    fragments: &Fragments<S, K>,
    look: bool,
    columns: &mut [Column],
    row: usize,
) -> u64 {
    let described = fragments.describe(simd);
    let (first, measure) = fragments.features(simd, &described);
    let values = first.into_iter().chain(measure);
    if look {
        let hidden = fragments.hidden(simd, &described);
        if hidden.any_true() {
            let shown = !hidden;
            for (column, value) in columns.iter_mut().zip(values) {
                value.compress(shown).store_slice(&mut column[row..row + LANES]);
            }
            return hidden.to_bitmask();
        }
    }
    for (column, value) in columns.iter_mut().zip(values) {
        value.store_slice(&mut column[row..row + LANES]);
    }
    0
}

/// Both passes over the pixels of a list.
#[derive(Debug, Clone, Copy)]
pub struct Passes {
    moments: usize,
    width: usize,
    warp: LogWarp,
    frame: MomentFrame,
}

impl Extractor {
    /// Both passes of this feature set, where they are made for many pixels: recentred ones with moments summed in f32.
    pub fn passes(&self) -> Option<Passes> {
        match (self.kind, self.storage) {
            (Kind::Recentred(warp), SumPrecision::F32) => Some(Passes {
                moments: self.set.moments(),
                width: self.set.width(),
                warp,
                frame: self.frame,
            }),
            _ => None,
        }
    }
}

impl Passes {
    /// Transmittances of every fragment of pixels `range`, in the order of the list, and what decided each, on all cores. `network` makes what a thread asks.
    ///
    /// # Accuracy
    /// What is known and the features differ from [`Extractor::pixel`]'s by rounding in f32; `passes_follow_the_extractor`.
    ///
    /// # Shapes
    /// `out`, `class`: one a fragment of the range.
    ///
    /// # Panics
    /// If either has another length.
    pub fn run<N: Network>(
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

    fn run_of<const K: usize, N: Network>(
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
    use crate::features::{FeatureSet, visible};
    use crate::numeric::rng::{Stream, stream};
    use crate::pixel::{absorbance, abuffer};
    use rand::RngExt;

    /// Pixels of every kind: few and many fragments, faint and opaque ones, bunches, ties, alpha 0 and 1; colours at the ends of their range.
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

    /// Keeps the rows that it is given.
    struct Listener<'a>(&'a std::sync::Mutex<Vec<Vec<f32>>>);

    impl Network for Listener<'_> {
        fn answer(&mut self, columns: &[Column], out: &mut [f32]) {
            // The answer is the first feature, so that rows can be told apart.
            let mut rows = self.0.lock().unwrap();
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
        let rows = std::sync::Mutex::new(Vec::new());
        let (mut out, mut class) = (vec![f32::NAN; list.len()], vec![Class::Network; list.len()]);
        let passes = extractor.passes().unwrap();
        let tally = passes.run(
            list,
            0..list.pixels(),
            switches,
            || Listener(&rows),
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

    /// Against [`Extractor::pixel`]: the network is evaluated for the same fragments; what is known to 1e-5, in pixels of four that are not thin to 1e-3, and the features of pixels that are
    /// not thin to f32 rounding. Controls: the values one fragment on.
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
            let mut known_before = f32::NAN;
            for p in 0..list.pixels() {
                let range = list.range(p);
                let mut whole = vec![0.0; range.len() * (width + 1)];
                extractor.pixel(list.pixel(p), &mut whole).unwrap();
                let (near, far) = list
                    .pixel(p)
                    .view_z
                    .iter()
                    .fold((f32::INFINITY, 0.0f32), |(a, b), &v| (a.min(v), b.max(v)));
                let thin = far < 1.6 * near;
                for (i, row) in range.clone().zip(whole.chunks_exact(width + 1)) {
                    assert_eq!(row[width].is_nan(), class[i] == Class::Network);
                    if class[i] != Class::Network {
                        // Moments of thin pixels are what rounding makes of them; in pixels of three only the mean counts.
                        let bar = match class[i] {
                            Class::Three => 0.03,
                            Class::Four if thin => 1.0,
                            Class::Four => 1e-3,
                            _ => 1e-5,
                        };
                        assert!(
                            (out[i] - row[width]).abs() <= bar,
                            "{:?}: {} for {}",
                            class[i],
                            out[i],
                            row[width]
                        );
                        controls += usize::from((out[i] - known_before).abs() > 1e-5);
                        known_before = row[width];
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

    /// The same to the bit in any company, on any number of threads, and with switches off but for what they run in vain.
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
        let passes = extractor.passes().unwrap();
        for range in [0..1, 17..18, 100..333, 0..list.pixels()] {
            let fragments = list.offsets()[range.start] as usize..list.offsets()[range.end] as usize;
            let (mut out, mut class) = (vec![0.0; fragments.len()], vec![Class::Network; fragments.len()]);
            let rows = std::sync::Mutex::new(Vec::new());
            passes.run(&list, range, EXACT, || Listener(&rows), &mut out, &mut class);
            assert_eq!(out, all[fragments]);
        }
    }

    /// What every pixel's hidden fragments weigh in the exact image, in f64: at most 1/1024 in all; and the lanes decide as the f64 rule would, never more boldly than its truth allows.
    /// Control: the fragments that are not hidden weigh more.
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
