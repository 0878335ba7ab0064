//! Core and tail: single fragments of a pixel, and the sums of all others; with a network or with the beta law.

use super::registry::{Arguments, Entry, ParseError};
use super::{Accumulated, Context, Method, MethodError, MethodShader};
use crate::features::core::code::{Codes, MAX_HEAVY};
use crate::features::core::formulas::{share_by_law, transmittance};
use crate::features::core::pixel::{Answer, Passes, Query, codes_for, with_sums};
use crate::features::core::{CoreSet, FIXED};
use crate::model::{Mlp, Tiled};
use crate::numeric::lanes::LANES;
use crate::pixel::{DepthError, FragmentList, LogWarp, ViewZ};
use rayon::prelude::*;
use std::ops::Range;

/// Name on the command line.
pub const ENTRY: Entry = Entry {
    head: "core",
    pattern: "core:HEAVY",
    names,
    build,
};

/// Moments of the method without a network: mean and spread need two.
const MOMENTS: usize = 2;

/// Pixels of one task.
const TASK: usize = 256;

/// Greatest error of T at which the law answers in place of the network, half a display step.
pub const VISIBLE: f32 = 1.0 / 512.0;

fn names(head: &str) -> Vec<String> {
    ["4", "6"].iter().map(|k| format!("{head}:{k}")).collect()
}

fn build(arguments: &Arguments<'_>) -> Result<Box<dyn Method>, ParseError> {
    arguments.no_own()?;
    match arguments.argument.and_then(|k| k.parse::<usize>().ok()) {
        Some(heavy) if heavy <= MAX_HEAVY => Ok(Box::new(CoreAndTail::by_law(CoreSet::new(heavy, MOMENTS)))),
        _ => Err(arguments.wrong(format!("expected a number of heavy fragments from 0 to {MAX_HEAVY}"))),
    }
}

/// The method: which core, and who shares the tail out.
pub struct CoreAndTail {
    name: String,
    set: CoreSet,
    network: Option<Tiled>,
    /// Whether the law answers where its error cannot be seen.
    visible: bool,
}

/// Who answered how many fragments.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tally {
    /// All fragments.
    pub fragments: u64,
    /// Those that need no share: core alone, ends, closed forms.
    pub exact: u64,
    /// Those that the law answered.
    pub law: u64,
    /// Those that the network answered.
    pub network: u64,
}

impl Tally {
    fn add(self, other: Self) -> Self {
        Self {
            fragments: self.fragments + other.fragments,
            exact: self.exact + other.exact,
            law: self.law + other.law,
            network: self.network + other.network,
        }
    }
}

impl CoreAndTail {
    /// The tail by the beta law, without a network.
    pub fn by_law(set: CoreSet) -> Self {
        Self {
            name: format!("core:{}", set.heavy),
            set,
            network: None,
            visible: false,
        }
    }

    /// The tail by a network on this core's features.
    ///
    /// # Panics
    /// If the network has another number of inputs.
    pub fn with_network(name: String, set: CoreSet, mlp: &Mlp) -> Self {
        assert_eq!(
            mlp.sizes()[0],
            FIXED + set.moments,
            "a network on the features of {set:?}"
        );
        Self {
            name,
            set,
            network: Some(Tiled::new(mlp)),
            visible: false,
        }
    }

    /// The same, but the law answers where T cannot be off by more than half a display step.
    pub fn visible(self) -> Self {
        Self { visible: true, ..self }
    }

    /// Transmittance of every fragment of a list and who gave it, on all cores, for codes of the given depth range, or of
    /// the list's own.
    ///
    /// # Errors
    /// [`DepthError::BadRange`].
    pub fn transmittances(
        &self,
        list: &FragmentList,
        range: Option<(f32, f32)>,
    ) -> Result<(Vec<f32>, Tally), DepthError> {
        let range = range.or(list.depth_range());
        if let Some((v0, v1)) = range {
            LogWarp::new(ViewZ(v0.into()), ViewZ(v1.into()))?;
        }
        let codes = codes_for(&self.set.layout, range);
        let mut out = vec![0.0; list.len()];
        let mut tasks = Vec::new();
        let mut rest = out.as_mut_slice();
        for first in (0..list.pixels()).step_by(TASK) {
            let pixels = first..(first + TASK).min(list.pixels());
            let fragments = (list.offsets()[pixels.end] - list.offsets()[pixels.start]) as usize;
            let (own, other) = std::mem::take(&mut rest).split_at_mut(fragments);
            tasks.push((pixels, own));
            rest = other;
        }
        let tally = tasks
            .into_par_iter()
            .map(|(pixels, out)| with_sums!(self.set.moments, N => self.task::<N>(&codes, list, pixels, out)))
            .reduce(Tally::default, Tally::add);
        Ok((out, tally))
    }

    fn task<const N: usize>(&self, codes: &Codes, list: &FragmentList, pixels: Range<usize>, out: &mut [f32]) -> Tally {
        let mut passes = Passes::default();
        let mut waiting = self.network.as_ref().map(Waiting::new);
        let mut tally = Tally::default();
        let mut at = 0;
        for pixel in pixels {
            let between = passes.first::<N>(&self.set, codes, list.pixel(pixel));
            for &fragment in &passes.fragments {
                tally.fragments += 1;
                match between.answer(codes, fragment) {
                    Answer::Depth(depth) => {
                        tally.exact += 1;
                        out[at] = transmittance(depth, 0.0, 0.0);
                    }
                    Answer::Query(query) => match &mut waiting {
                        Some(waiting) if !(self.visible && uncertainty(&query) <= VISIBLE) => {
                            tally.network += 1;
                            waiting.push(&query, at, out);
                        }
                        _ => {
                            tally.law += 1;
                            out[at] = by_law(&query);
                        }
                    },
                }
                at += 1;
            }
        }
        if let Some(waiting) = &mut waiting {
            waiting.flush(out);
        }
        tally
    }
}

/// How far T may be off whatever the share.
fn uncertainty<const N: usize>(query: &Query<N>) -> f32 {
    transmittance(query.front, 0.0, 0.0) - transmittance(query.front, query.tail, 1.0)
}

/// Transmittance by the beta law; by the mean alone, half way, where there is no spread.
fn by_law<const N: usize>(query: &Query<N>) -> f32 {
    let spread = if N > 2 {
        query.described[N.min(3) - 1]
    } else {
        1.0 / 3.0
    };
    let share = share_by_law(query.fixed[0], query.described[1], spread);
    transmittance(query.front, query.tail, share)
}

/// Rows that wait for the network.
struct Waiting<'a> {
    network: &'a Tiled,
    work: Vec<crate::model::kernel::Row>,
    /// Fragment and optical depth in front, of each row.
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
        let row = self.who.len();
        let (vector, lane) = (row / LANES, row % LANES);
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

struct Answered<'a> {
    list: &'a FragmentList,
    transmittance: Vec<f32>,
}

impl Accumulated for Answered<'_> {
    fn weights(&self, p: usize, out: &mut [f64]) {
        for (out, &t) in out.iter_mut().zip(&self.transmittance[self.list.range(p)]) {
            *out = t.into();
        }
    }
}

impl Method for CoreAndTail {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn shader(&self) -> Option<MethodShader> {
        // A network's is made of its export.
        let law = self.network.is_none() && self.set.moments <= 4;
        law.then(|| MethodShader::of_core(self.name.clone(), self.set))
    }

    fn bits_per_pixel(&self) -> u32 {
        // RGBA32F colour and weight sum beside what pass 1 keeps.
        self.set.bits() + 128
    }

    fn accumulate<'a>(
        &'a self,
        list: &'a FragmentList,
        context: Context,
    ) -> Result<Box<dyn Accumulated + 'a>, MethodError> {
        let (transmittance, _) =
            self.transmittances(list, context.depth_range)
                .map_err(|source| MethodError::Depth {
                    method: self.name(),
                    source,
                })?;
        Ok(Box::new(Answered { list, transmittance }))
    }
}
