//! Answers for sets with a core: both passes pixel by pixel, the tail shared out by a network or by the beta law.

use super::classes::{Class, Switches, Tally};
use super::tiled::Tiled;
use crate::features::core::CoreSet;
use crate::features::core::code::Codes;
use crate::features::core::formulas::{share_by_law, transmittance};
use crate::features::core::pixel::{Answer, Passes, Query, with_sums};
use crate::model::kernel::Row;
use crate::numeric::lanes::LANES;
use crate::pixel::FragmentList;
use rayon::prelude::*;
use std::ops::Range;
use std::time::Instant;

/// Pixels of one task.
const TASK: usize = 256;

/// Greatest error of T, whatever the share of the tail, at which the law answers in place of the network: half a
/// display step.
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
    let task = |(own, out, classes): (Range<usize>, &mut [f32], &mut [Class])| {
        let mut task = Task {
            set,
            codes,
            waiting: match tail {
                Tail::Law => None,
                Tail::Network(network) => Some(Waiting::new(network)),
            },
            switches,
            out,
            classes,
            tally: Tally::default(),
        };
        with_sums!(set.moments, N => task.run::<N>(list, own));
        task.tally
    };
    let mut tally = tasks
        .into_par_iter()
        .map(task)
        .reduce(Tally::default, |mut one, other| {
            one.add(&other);
            one
        });
    tally.seconds_pass_2 = start.elapsed().as_secs_f64();
    tally
}

struct Task<'a> {
    set: &'a CoreSet,
    codes: &'a Codes,
    waiting: Option<Waiting<'a>>,
    switches: Switches,
    out: &'a mut [f32],
    classes: &'a mut [Class],
    tally: Tally,
}

impl Task<'_> {
    fn run<const N: usize>(&mut self, list: &FragmentList, pixels: Range<usize>) {
        let mut passes = Passes::default();
        let mut at = 0;
        for pixel in pixels {
            let between = passes.first::<N>(self.set, self.codes, list.pixel(pixel));
            for &fragment in &passes.fragments {
                let class = match between.answer(self.codes, fragment) {
                    Answer::Depth(depth) => {
                        self.out[at] = transmittance(depth, 0.0, 0.0);
                        Class::Known
                    }
                    Answer::Query(query) => self.query(&query, at),
                };
                self.classes[at] = class;
                self.tally.classes[class as usize] += 1;
                at += 1;
            }
        }
        if let Some(waiting) = &mut self.waiting {
            waiting.flush(self.out);
        }
    }

    #[inline(always)]
    fn query<const N: usize>(&mut self, query: &Query<N>, at: usize) -> Class {
        match &mut self.waiting {
            Some(waiting) if !(self.switches.faint && uncertainty(query) <= VISIBLE) => {
                self.tally.rows += 1;
                waiting.push(query, at, self.out);
                Class::Network
            }
            Some(_) => {
                self.out[at] = by_law(query);
                Class::Faint
            }
            None => {
                self.out[at] = by_law(query);
                Class::Known
            }
        }
    }
}

/// How far T may be off whatever the share.
fn uncertainty<const N: usize>(query: &Query<N>) -> f32 {
    transmittance(query.front, 0.0, 0.0) - transmittance(query.front, query.tail, 1.0)
}

/// Transmittance by the beta law; with the spread of the uniform law where there is only a mean.
fn by_law<const N: usize>(query: &Query<N>) -> f32 {
    let spread = query.described.get(2).copied().unwrap_or(1.0 / 3.0);
    let share = share_by_law(query.fixed[0], query.described[1], spread);
    transmittance(query.front, query.tail, share)
}

/// Rows that wait for the network.
struct Waiting<'a> {
    network: &'a Tiled,
    work: Vec<Row>,
    /// Fragment and absorbance of the core in front, of each row.
    who: Vec<(usize, f32)>,
}

impl<'a> Waiting<'a> {
    fn new(network: &'a Tiled) -> Self {
        Self {
            network,
            work: network.work(),
            who: Vec::with_capacity(Tiled::ROWS),
        }
    }

    #[inline(always)]
    fn push<const N: usize>(&mut self, query: &Query<N>, fragment: usize, out: &mut [f32]) {
        let (vector, lane) = (self.who.len() / LANES, self.who.len() % LANES);
        for (column, &value) in self
            .work
            .iter_mut()
            .zip(query.fixed.iter().chain(&query.described[1..]))
        {
            column[vector].0[lane] = value;
        }
        self.who.push((fragment, query.front));
        if self.who.len() == Tiled::ROWS {
            self.flush(out);
        }
    }

    fn flush(&mut self, out: &mut [f32]) {
        let mut answers = [0.0; Tiled::ROWS];
        let answers = &mut answers[..self.who.len()];
        self.network.answer(&mut self.work, answers);
        for ((fragment, front), of_tail) in self.who.drain(..).zip(answers) {
            out[fragment] = transmittance(front, 0.0, 0.0) * *of_tail;
        }
    }
}
