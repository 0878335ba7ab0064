//! How fast: training, generation, inference and transparency methods, measured and never printed.
//!
//! What is compared is measured by turns: every repetition runs each subject once, so that a machine that slows down
//! slows all of them down, and ratios hold.

pub mod generate;
pub mod infer;
pub mod methods;
pub mod network;
pub mod peak;
pub mod summary;
pub mod tiles;
pub mod train;

pub use network::Network;
pub use summary::{Summary, comparison};

use crate::dataset::DatasetError;
use crate::model::ShapeError;
use crate::train::BackendError;
use std::time::{Duration, Instant};

/// Most calls of one repetition: a call that seems to take no time at all must not be made for ever.
const MAX_CALLS: u64 = 1 << 24;

/// How often something is measured, and for how long each time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plan {
    /// Repetitions, each a sample.
    pub repeat: usize,
    /// Least time of a repetition, as far as the warm-up foretells it \[s\]; it is filled with as many calls as it
    /// takes.
    pub sample_seconds: f64,
}

/// Why something could not be measured.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BenchError {
    /// A number is out of its range.
    #[error("{field} {value}: must be {expected}")]
    Value {
        /// What it is.
        field: &'static str,
        /// The number.
        value: String,
        /// What it must be.
        expected: &'static str,
    },
    /// The text names no network.
    #[error("network '{text}': {reason}; write sizes from the features to the one answer, such as 7-32-16-1")]
    Network {
        /// The text.
        text: String,
        /// What is wrong.
        reason: String,
    },
    /// The network and the rows have different widths.
    #[error(
        "network {network} takes {found} features, but the rows have {expected}; choose a network that starts with \
            {expected}"
    )]
    Width {
        /// The network.
        network: String,
        /// Its inputs.
        found: usize,
        /// Features of the rows.
        expected: usize,
    },
    /// There are fewer rows than a batch takes.
    #[error("{rows} rows are fewer than the {batch} of a batch; lower the batch, or take more rows")]
    Rows {
        /// Rows.
        rows: usize,
        /// Rows of a batch.
        batch: usize,
    },
    /// The network is none.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// Pixels could not be made.
    #[error(transparent)]
    Dataset(#[from] DatasetError),
    /// A backend cannot be had.
    #[error(transparent)]
    Backend(#[from] BackendError),
    /// Training failed.
    #[error("{0}")]
    Train(String),
    /// onnxruntime failed.
    #[error("onnxruntime: {0}")]
    Onnxruntime(String),
}

impl Plan {
    /// Checks both numbers.
    ///
    /// # Errors
    /// [`BenchError::Value`].
    pub fn validate(&self) -> Result<(), BenchError> {
        check(
            (1..=100_000).contains(&self.repeat),
            "repetitions",
            self.repeat,
            "from 1 to 100000",
        )?;
        let seconds = self.sample_seconds;
        check(
            seconds > 0.0 && seconds <= 3600.0,
            "seconds of a sample",
            seconds,
            "greater than 0 and at most 3600",
        )
    }
}

fn check(ok: bool, field: &'static str, value: impl ToString, expected: &'static str) -> Result<(), BenchError> {
    if ok {
        Ok(())
    } else {
        Err(BenchError::Value {
            field,
            value: value.to_string(),
            expected,
        })
    }
}

/// Something to measure.
pub struct Subject<'a> {
    call: Box<dyn FnMut() -> Result<u64, BenchError> + 'a>,
    rest: Duration,
}

impl<'a> Subject<'a> {
    /// A call that does some work and says how much: samples, pairs, rows, floating-point operations.
    pub fn new(call: impl FnMut() -> Result<u64, BenchError> + 'a) -> Self {
        Self {
            call: Box::new(call),
            rest: Duration::ZERO,
        }
    }

    /// The same with a pause after each of its repetitions: threads that wait for more work by spinning must not slow
    /// the next subject down.
    pub fn with_rest(self, rest: Duration) -> Self {
        Self { rest, ..self }
    }

    /// So many calls in a row: seconds, and the work done.
    fn time(&mut self, calls: u64) -> Result<(f64, u64), BenchError> {
        let start = Instant::now();
        let mut work = 0;
        for _ in 0..calls {
            work += (self.call)()?;
        }
        let seconds = start.elapsed().as_secs_f64();
        std::thread::sleep(self.rest);
        // A clock that stood still has counted less than its own step.
        Ok((seconds.max(1e-9), work))
    }

    /// Warms up, and says how many calls fill a sample.
    fn calls(&mut self, plan: Plan) -> Result<u64, BenchError> {
        self.time(1)?;
        calls_that_fill(plan.sample_seconds, |calls| {
            self.time(calls).map(|(seconds, _)| seconds)
        })
    }
}

/// Doubles the number of calls until they take half a sample's time, and goes on from there in proportion. `time` says
/// how long so many calls take \[s\].
fn calls_that_fill(
    sample_seconds: f64,
    mut time: impl FnMut(u64) -> Result<f64, BenchError>,
) -> Result<u64, BenchError> {
    let mut calls = 1;
    loop {
        let seconds = time(calls)?;
        if seconds >= 0.5 * sample_seconds || calls >= MAX_CALLS {
            return Ok(((calls as f64 * sample_seconds / seconds).ceil() as u64).clamp(1, MAX_CALLS));
        }
        calls *= 2;
    }
}

/// What the repetitions of one subject took.
#[derive(Debug, Clone, PartialEq)]
pub struct Samples {
    /// Calls of one repetition.
    pub calls: u64,
    /// Seconds of a call, the mean over a repetition's calls; one number a repetition.
    pub seconds: Vec<f64>,
    /// Work done in a second; one number a repetition.
    pub rates: Vec<f64>,
}

/// Measures subjects by turns: all warm up, then every repetition takes each of them once. `progress` is told how many
/// repetitions are done.
///
/// # Errors
/// [`Plan::validate`], and what a subject fails with.
pub fn measure(plan: Plan, subjects: &mut [Subject<'_>], progress: &dyn Fn(u64)) -> Result<Vec<Samples>, BenchError> {
    plan.validate()?;
    let mut samples = Vec::new();
    for subject in &mut *subjects {
        samples.push(Samples {
            calls: subject.calls(plan)?,
            seconds: Vec::new(),
            rates: Vec::new(),
        });
    }
    for repetition in 1..=plan.repeat {
        for (subject, samples) in subjects.iter_mut().zip(&mut samples) {
            let (seconds, work) = subject.time(samples.calls)?;
            samples.seconds.push(seconds / samples.calls as f64);
            samples.rates.push(work as f64 / seconds);
        }
        progress(repetition as u64);
    }
    Ok(samples)
}

/// A network's speed on one machine.
#[derive(Debug, Clone, PartialEq)]
pub struct Measurement {
    /// "7-32-16-1".
    pub network: String,
    /// What computed.
    pub backend: &'static str,
    /// Rows of a call.
    pub batch: usize,
    /// SIMD level where it is ours to choose.
    pub simd: Option<&'static str>,
    /// Name of the GPU where one computed.
    pub adapter: Option<String>,
    /// Floating-point operations of a row, a multiplication and an addition counted as two.
    pub flops: u64,
    /// What was measured; the work is counted in rows.
    pub samples: Samples,
    /// [`peak`] in the same turns; the work is counted in floating-point operations.
    pub peak: Samples,
    /// Greatest difference of an answer to that of the reference, where answers were compared.
    pub worst_difference: Option<f64>,
}

impl Measurement {
    /// Median of the rows a second.
    pub fn rows_per_second(&self) -> f64 {
        Summary::of(&self.samples.rates).median
    }

    /// Arithmetic that the median rate stands for [GFLOP/s].
    pub fn gflops(&self) -> f64 {
        self.rows_per_second() * self.flops as f64 * 1e-9
    }

    /// The multiply-add peak [GFLOP/s]: that of its fastest repetition, because it stands for what the machine can do
    /// at most.
    pub fn peak_gflops(&self) -> f64 {
        Summary::of(&self.peak.rates).max * 1e-9
    }

    /// [`Self::gflops`] as a share of [`Self::peak_gflops`].
    pub fn share_of_peak(&self) -> f64 {
        self.gflops() / self.peak_gflops()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::RefCell;

    const PLAN: Plan = Plan {
        repeat: 3,
        sample_seconds: 1e-5,
    };

    /// Repetitions take subjects in turn, each as often as its warm-up found, and count all its work.
    #[test]
    fn subjects_take_turns() {
        let log = RefCell::new(String::new());
        let told = RefCell::new(Vec::new());
        let subject = |name: char| {
            let log = &log;
            Subject::new(move || {
                std::thread::sleep(Duration::from_micros(200));
                log.borrow_mut().push(name);
                Ok(5)
            })
        };
        let samples = measure(PLAN, &mut [subject('a'), subject('b')], &|n| told.borrow_mut().push(n)).unwrap();
        assert_eq!(log.borrow().as_str(), "aabbababab");
        assert_eq!(told.into_inner(), [1, 2, 3]);
        for s in samples {
            assert_eq!((s.calls, s.seconds.len(), s.rates.len()), (1, 3, 3));
            assert!(
                s.seconds
                    .iter()
                    .zip(&s.rates)
                    .all(|(s, r)| *s >= 200e-6 && (s * r - 5.0).abs() < 1e-9)
            );
        }
    }

    #[test]
    fn short_calls_fill_a_sample() {
        let of = |seconds: f64| calls_that_fill(1.0, |calls| Ok(calls as f64 * seconds)).unwrap();
        assert_eq!([2.0, 1.0, 0.4, 1.0 / 1024.0].map(of), [1, 1, 3, 1024]);
        assert_eq!(of(1e-12), MAX_CALLS);
    }

    #[test]
    fn errors_end_the_measurement() {
        let mut subjects = [Subject::new(|| Err(BenchError::Onnxruntime("no".into())))];
        assert_eq!(
            measure(PLAN, &mut subjects, &|_| {}).unwrap_err().to_string(),
            "onnxruntime: no"
        );
        for plan in [
            Plan { repeat: 0, ..PLAN },
            Plan {
                sample_seconds: 0.0,
                ..PLAN
            },
            Plan {
                sample_seconds: f64::NAN,
                ..PLAN
            },
        ] {
            assert!(
                measure(plan, &mut [], &|_| {})
                    .unwrap_err()
                    .to_string()
                    .contains("must be")
            );
        }
    }
}
