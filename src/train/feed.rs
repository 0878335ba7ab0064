//! What every epoch learns from: rows in shuffled blocks, some of them replaced by those of fresh pixels where the
//! dataset says so.
//!
//! The rows stand in segments, a ring: before epoch e > 1, segment e − 2 (modulo their number) is filled anew from
//! pixels (e − 1) · 2^32 on. So what an epoch learns from depends on the seed and the epoch alone, and an interrupted
//! training can go on.
//!
//! Whatever an epoch needs is made while the steps of the epoch before are taken, one segment ahead and never more:
//! small tasks on the threads that train, which take one where a step leaves them nothing to do. No thread waits for
//! another while anything is left to be made.

use super::Optimiser;
use super::trainer::TrainError;
use crate::dataset::colour::ColourRows;
use crate::dataset::file::Manifest;
use crate::dataset::stream::Making;
use crate::dataset::{Batch, Blocks, DatasetError, RowStream, Rows};
use crate::numeric::lanes::LANES;
use crate::numeric::rng::stream;
use crate::synth::Purpose;
use rand::seq::SliceRandom;
use rayon::Scope;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// How rows and blocks are shuffled.
#[derive(Clone, Copy)]
struct Shuffling {
    /// Keeps its random numbers apart from all others.
    purpose: u64,
    /// Whether an epoch shuffles on from the order of the epoch before, and not from the order of the rows.
    on: bool,
}

/// Of the rows of a dataset.
const SHUFFLING: Shuffling = Shuffling {
    purpose: 0x1002,
    on: false,
};

/// Of the rows of networks that answer with a colour; their weights have always come of it.
const SHUFFLING_OF_COLOURS: Shuffling = Shuffling {
    purpose: 0x1011,
    on: true,
};

/// Rows to learn from, epoch after epoch.
pub struct Feed {
    blocks: Blocks,
    blocks_of_step: usize,
    source: Source,
    /// What the next epoch needs, where it is made already.
    next: Option<Prepared>,
    /// The order that the next epoch shuffles on from, where it does and is not made yet.
    before: Option<Vec<u32>>,
}

/// All that decides what an epoch learns from.
struct Source {
    seed: u64,
    shuffling: Shuffling,
    rows: usize,
    blocks: usize,
    segments: u64,
    stream: Option<RowStream>,
}

/// What an epoch needs that the one before it did not.
struct Prepared {
    epoch: u64,
    order: Vec<u32>,
    /// Fresh rows, and the place of the first of them.
    fresh: Option<(usize, Blocks)>,
}

impl Feed {
    /// The feed of these rows as it stands after so many epochs, for steps of `batch` rows; the manifest says where
    /// fresh ones come from, if anywhere.
    ///
    /// # Errors
    /// [`TrainError::NoStream`] where fresh pixels are asked for and no distribution is known; [`TrainError::Dataset`]
    /// where it is invalid.
    pub fn new(rows: &Rows, manifest: &Manifest, seed: u64, batch: usize, epochs: u64) -> Result<Self, TrainError> {
        let blocks = Blocks::of(rows, &SHUFFLING.first(seed, rows.len()));
        let refresh = manifest.dataset.refresh;
        let stream = match (refresh > 0.0, &manifest.synth) {
            (false, _) => None,
            (true, None) => return Err(TrainError::NoStream),
            (true, Some(synth)) => {
                let stream = RowStream::new(manifest.seed, synth, &manifest.dataset, Purpose::Training)?;
                Some(stream.expecting(rows.len(), manifest.training.pixels))
            }
        };
        let segments = if refresh > 0.0 {
            (1.0 / refresh).round().min(rows.len() as f64) as u64
        } else {
            1
        };
        let source = Source {
            seed,
            shuffling: SHUFFLING,
            rows: rows.len(),
            blocks: blocks.len(),
            segments,
            stream,
        };
        let mut feed = Self {
            blocks,
            blocks_of_step: batch / LANES,
            source,
            next: None,
            before: None,
        };
        for epoch in (epochs + 1).saturating_sub(segments).max(2)..=epochs {
            let prepared = feed.source.prepare(epoch, None)?;
            feed.take_in(&prepared);
        }
        Ok(feed)
    }

    /// The feed of rows with colours as it stands after so many epochs; none is ever replaced.
    pub fn of_colours(rows: &ColourRows, seed: u64, batch: usize, epochs: u64) -> Self {
        let order = SHUFFLING_OF_COLOURS.first(seed, rows.len());
        let width = rows.set.columns().len();
        let blocks = Blocks::from_fn(width, 3, 0, rows.len(), |at| rows.row(order[at] as usize));
        let source = Source {
            seed,
            shuffling: SHUFFLING_OF_COLOURS,
            rows: rows.len(),
            blocks: blocks.len(),
            segments: 1,
            stream: None,
        };
        let before = (1..=epochs).fold(source.in_order(), |order, epoch| source.shuffled(order, epoch));
        Self {
            blocks,
            blocks_of_step: batch / LANES,
            source,
            next: None,
            before: Some(before),
        }
    }

    /// Rows of an epoch.
    pub fn rows(&self) -> usize {
        self.source.rows
    }

    /// Steps of an epoch.
    pub fn steps(&self) -> u64 {
        self.source.blocks.div_ceil(self.blocks_of_step) as u64
    }

    /// Takes the steps of an epoch, `rate` giving the step size of each, from 1; the mean squared error over its rows,
    /// while they were being learnt from, is returned. Where `more` says so, what the next epoch needs is made
    /// meanwhile. `stop` is asked before every step; none is returned once it says true.
    ///
    /// # Errors
    /// [`TrainError::Dataset`] where fresh pixels have no rows.
    pub fn epoch(
        &mut self,
        epoch: u64,
        more: bool,
        fitted: &mut dyn Optimiser,
        rate: &(dyn Fn(u64) -> f64 + Sync),
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<f64>, TrainError> {
        let prepared = match self.next.take() {
            Some(next) if next.epoch == epoch => next,
            _ => self.source.prepare(epoch, self.before.take().as_deref())?,
        };
        self.take_in(&prepared);
        let (blocks, order) = (&self.blocks, &prepared.order);
        let before = self.source.shuffling.on.then_some(order.as_slice());
        let preparation = Preparation::new(&self.source, epoch + 1, before);
        let squared_error = rayon::scope(|scope| {
            if more {
                preparation.spawn(scope);
            }
            let mut squared_error = 0.0;
            for (step, order) in (1..).zip(order.chunks(self.blocks_of_step)) {
                if stop() {
                    preparation.cancelled.store(true, Ordering::Relaxed);
                    return None;
                }
                let batch = Batch { blocks, order };
                squared_error += fitted.step(batch, rate(step)) * batch.rows() as f64;
            }
            Some(squared_error)
        });
        let Some(squared_error) = squared_error else {
            return Ok(None);
        };
        if more {
            self.next = Some(preparation.finish()?);
        } else {
            self.before = before.map(<[u32]>::to_vec);
        }
        Ok(Some(squared_error / self.source.rows as f64))
    }

    fn take_in(&mut self, prepared: &Prepared) {
        if let Some((start, fresh)) = &prepared.fresh {
            self.blocks.splice(*start, fresh);
        }
    }
}

impl Shuffling {
    /// The order that rows stand in from the first epoch on.
    fn first(self, seed: u64, rows: usize) -> Vec<u32> {
        let mut order: Vec<u32> = (0..rows as u32).collect();
        order.shuffle(&mut stream(seed, self.purpose, 0));
        order
    }
}

impl Source {
    /// The blocks as they stand.
    fn in_order(&self) -> Vec<u32> {
        (0..self.blocks as u32).collect()
    }

    /// The order of an epoch, of the one that it is shuffled from.
    fn shuffled(&self, mut order: Vec<u32>, epoch: u64) -> Vec<u32> {
        order.shuffle(&mut stream(self.seed, self.shuffling.purpose, epoch));
        order
    }

    /// The rows that fresh ones replace before an epoch, and the pixel that they start from.
    fn segment(&self, epoch: u64) -> (Range<usize>, u64) {
        let (segment, rows) = ((epoch - 2) % self.segments, self.rows as u64);
        (
            (segment * rows / self.segments) as usize..((segment + 1) * rows / self.segments) as usize,
            (epoch - 1) << 32,
        )
    }

    /// Makes what an epoch needs on all threads; `before` is the order that it shuffles on from, if any.
    fn prepare(&self, epoch: u64, before: Option<&[u32]>) -> Result<Prepared, DatasetError> {
        let preparation = Preparation::new(self, epoch, before);
        rayon::scope(|scope| preparation.spawn(scope));
        preparation.finish()
    }
}

/// What an epoch needs, in the making.
struct Preparation<'a> {
    source: &'a Source,
    epoch: u64,
    /// The order that it shuffles on from, if any.
    before: Option<&'a [u32]>,
    /// Fresh rows where there are any, and which places they take.
    making: Option<(Making<'a>, Range<usize>)>,
    /// Tasks of it that are not done.
    left: AtomicUsize,
    cancelled: AtomicBool,
    order: Mutex<Vec<u32>>,
    fresh: Mutex<Option<Result<Blocks, DatasetError>>>,
}

impl<'a> Preparation<'a> {
    fn new(source: &'a Source, epoch: u64, before: Option<&'a [u32]>) -> Self {
        let making = source.stream.as_ref().filter(|_| epoch >= 2).map(|stream| {
            let (range, pixel) = source.segment(epoch);
            (Making::new(stream, pixel, range.len(), usize::MAX), range)
        });
        let left = AtomicUsize::new(making.as_ref().map_or(0, |(making, _)| making.tasks()));
        Self {
            source,
            epoch,
            before,
            making,
            left,
            cancelled: AtomicBool::new(false),
            order: Mutex::default(),
            fresh: Mutex::default(),
        }
    }

    /// Hands all work to the scope's threads.
    fn spawn<'scope>(&'scope self, scope: &Scope<'scope>) {
        scope.spawn(|_| self.shuffle());
        let Some((making, range)) = &self.making else { return };
        for task in 0..making.tasks() {
            scope.spawn(move |scope| {
                if self.cancelled.load(Ordering::Relaxed) {
                    return;
                }
                making.run(task);
                if self.left.fetch_sub(1, Ordering::AcqRel) == 1 {
                    // A task of its own, so that the thread that takes the steps goes on with them where another is
                    // free.
                    scope.spawn(|_| self.place(making, range.clone()));
                }
            });
        }
    }

    /// The order of the blocks.
    fn shuffle(&self) {
        let from = self.before.map_or_else(|| self.source.in_order(), <[u32]>::to_vec);
        let order = self.source.shuffled(from, self.epoch);
        *self.order.lock().unwrap_or_else(PoisonError::into_inner) = order;
    }

    /// Puts fresh rows in random order, as they will stand among the others.
    fn place(&self, making: &Making<'_>, range: Range<usize>) {
        let placed = making.finish().map(|parts| {
            let mut order: Vec<(u32, u32)> = (0..)
                .zip(&parts)
                .flat_map(|(p, part)| (0..part.len() as u32).map(move |row| (p, row)))
                .collect();
            order.shuffle(&mut stream(
                self.source.seed,
                self.source.shuffling.purpose,
                (1 << 63) | self.epoch,
            ));
            let width = making.width();
            Blocks::from_fn(width, 1, range.start % LANES, range.len(), |at| {
                let (part, row) = order[at];
                parts[part as usize].row(row as usize, width)
            })
        });
        *self.fresh.lock().unwrap_or_else(PoisonError::into_inner) = Some(placed);
    }

    fn finish(self) -> Result<Prepared, DatasetError> {
        let order = self.order.into_inner().unwrap_or_else(PoisonError::into_inner);
        let fresh = self
            .fresh
            .into_inner()
            .unwrap_or_else(PoisonError::into_inner)
            .transpose()?;
        Ok(Prepared {
            epoch: self.epoch,
            order,
            fresh: self.making.map(|(_, range)| range.start).zip(fresh),
        })
    }
}
