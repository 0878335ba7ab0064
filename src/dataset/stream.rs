//! Rows from random pixels, made while they are needed.

use super::build::{DatasetConfig, DatasetError};
use super::{Row, Rows};
use crate::features::{Extractor, Sampled};
use crate::numeric::rng::stream;
use crate::synth::{Purpose, Sketch, Synth, SynthConfig};
use rayon::prelude::*;
use std::sync::{Mutex, PoisonError};

/// Keeps the random numbers that choose among a pixel's rows apart from all others.
const CHOICE_PURPOSE: u64 = 0x1005;

/// Pixels of one task: enough to pay for handing it over, few enough that little is made in vain and that no one waits
/// long for its end.
const TASK: usize = 128;

/// Tasks after which [`RowStream::take`] puts their rows where they belong and tells how many there are.
const WAVE: usize = 256;

/// Pixels without a single row after which one gives up.
const MAX_EMPTY_PIXELS: u64 = 1 << 20;

/// Rows of neighbouring pixels.
#[derive(Debug, Clone, Default)]
pub struct Part {
    /// `[N, W]`, row by row.
    features: Vec<f32>,
    targets: Vec<f32>,
    /// Rows of each pixel.
    counts: Vec<u32>,
}

impl Part {
    /// Number of rows.
    pub fn len(&self) -> usize {
        self.targets.len()
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.targets.is_empty()
    }

    /// One of the rows, of features so wide.
    #[inline]
    pub fn row(&self, index: usize, width: usize) -> Row<'_> {
        Row {
            features: &self.features[index * width..][..width],
            targets: &self.targets[index..=index],
            weight: 1.0,
        }
    }

    /// Number of each row's pixel, that of the part's first pixel given.
    fn pixels(&self, first: u32) -> impl Iterator<Item = u32> {
        self.counts
            .iter()
            .zip(first..)
            .flat_map(|(&n, pixel)| std::iter::repeat_n(pixel, n as usize))
    }

    /// Keeps no more pixels than it takes to hold so many rows.
    fn truncate(&mut self, rows: usize, width: usize) {
        let mut kept = 0;
        let pixels = self.counts.iter().position(|&n| {
            kept += n as usize;
            kept >= rows
        });
        if let Some(last) = pixels {
            self.counts.truncate(last + 1);
            self.features.truncate(kept * width);
            self.targets.truncate(kept);
        }
    }
}

/// Rows from random pixels, pixel after pixel for as long as one asks.
#[derive(Debug, Clone)]
pub struct RowStream {
    source: Synth,
    purpose: Purpose,
    seed: u64,
    config: DatasetConfig,
    extractor: Extractor,
    /// The next pixel.
    next: u64,
    /// Rows and pixels so far, by which work is foreseen.
    made: (u64, u64),
}

impl RowStream {
    /// A stream from pixel 0 on. Moment depth is that of the configured camera: its planes are the extremes of the
    /// scene.
    ///
    /// # Errors
    /// [`DatasetError`] names the field that is wrong.
    pub fn new(seed: u64, synth: &SynthConfig, config: &DatasetConfig, purpose: Purpose) -> Result<Self, DatasetError> {
        config.validate()?;
        if config.features.spec().sample.is_none() {
            return Err(DatasetError::NoStream(config.features.name()));
        }
        let source = Synth::new(synth.clone(), seed)?;
        let extractor = Extractor::new(
            config.features,
            Some(synth.camera),
            Some((synth.camera.near(), synth.camera.far())),
        )?;
        let made = (
            if config.rows_per_pixel == 0 {
                16
            } else {
                config.rows_per_pixel.min(16).into()
            },
            1,
        );
        Ok(Self {
            source,
            purpose,
            seed,
            config: config.clone(),
            extractor: extractor.with_precision(config.storage),
            next: 0,
            made,
        })
    }

    /// The same where so many rows of so many pixels are known: how much work it takes is foreseen by them. No row
    /// depends on it.
    pub fn expecting(self, rows: usize, pixels: usize) -> Self {
        if rows == 0 || pixels == 0 {
            self
        } else {
            Self {
                made: (rows as u64, pixels as u64),
                ..self
            }
        }
    }

    /// Features of a row, W.
    pub fn width(&self) -> usize {
        self.config.features.width()
    }

    /// Goes on from a given pixel.
    pub fn skip_to(&mut self, pixel: u64) {
        self.next = pixel;
    }

    /// The next pixel.
    pub fn position(&self) -> u64 {
        self.next
    }

    /// Tasks that may well be enough for so many rows.
    fn tasks(&self, rows: usize) -> usize {
        let pixels = rows as f64 * self.made.1 as f64 / self.made.0 as f64;
        ((1.01 * pixels / TASK as f64).ceil() as usize).max(1)
    }

    /// At least `pairs` rows of whole pixels, the pixel that reaches the number being the last. `progress` is told how
    /// many there are so far.
    ///
    /// # Errors
    /// [`DatasetError::NothingToLearn`].
    pub fn take(&mut self, pairs: usize, progress: &dyn Fn(u64)) -> Result<Rows, DatasetError> {
        let set = self.config.features;
        let mut out = Rows {
            feature_set: set,
            features: vec![0.0; pairs * set.width()],
            targets: vec![0.0; pairs],
            weights: Vec::new(),
            pixels: vec![0; pairs],
        };
        let (first, mut rows) = (self.next, 0);
        while rows < pairs {
            let parts = Making::new(self, self.next, pairs - rows, WAVE).run_all();
            let (of_parts, pixels) = count(&parts);
            place(&mut out, rows, &parts, (self.next - first) as u32);
            rows += of_parts;
            self.next += pixels;
            if rows > 0 {
                self.made = (rows as u64, self.next - first);
            } else if self.next - first > MAX_EMPTY_PIXELS {
                return Err(DatasetError::NothingToLearn);
            }
            progress(rows as u64);
        }
        Ok(out)
    }

    /// Rows of so many pixels from `first` on.
    fn part(&self, first: u64, pixels: usize) -> Part {
        let most = if self.config.rows_per_pixel == 0 {
            usize::MAX
        } else {
            self.config.rows_per_pixel as usize
        };
        let (mut sketch, mut rows, mut part) = (Sketch::default(), Sampled::default(), Part::default());
        rows.reserve(
            (pixels as u64 * self.made.0 / self.made.1) as usize * 9 / 8,
            self.width(),
        );
        part.counts.reserve(pixels);
        for index in first..first + pixels as u64 {
            let pixel = self.source.pixel(self.purpose, index, &mut sketch);
            self.extractor
                .sample(pixel, most, &mut stream(self.seed, CHOICE_PURPOSE, index), &mut rows);
            part.counts.push(rows.of_pixel as u32);
        }
        Part {
            features: rows.features,
            targets: rows.targets,
            ..part
        }
    }
}

/// Puts parts where rows `at..` stand, all at once; what goes beyond the last is appended. `first` is the first pixel.
fn place(out: &mut Rows, at: usize, parts: &[Part], first: u32) {
    fn split<'a, T>(rest: &mut &'a mut [T], n: usize) -> &'a mut [T] {
        let n = n.min(rest.len());
        let (head, tail) = std::mem::take(rest).split_at_mut(n);
        *rest = tail;
        head
    }
    let width = out.feature_set.width();
    let mut features = &mut out.features[at * width..];
    let (mut targets, mut pixels) = (&mut out.targets[at..], &mut out.pixels[at..]);
    let mut next = first;
    let mut places = Vec::with_capacity(parts.len());
    for part in parts {
        let n = part.len();
        places.push((
            part,
            next,
            split(&mut features, n * width),
            split(&mut targets, n),
            split(&mut pixels, n),
        ));
        next += part.counts.len() as u32;
    }
    let beyond = places
        .last()
        .map(|(part, first, _, targets, ..)| (*part, *first, targets.len()));
    places
        .into_par_iter()
        .for_each(|(part, first, features, targets, pixels)| {
            features.copy_from_slice(&part.features[..features.len()]);
            targets.copy_from_slice(&part.targets[..targets.len()]);
            pixels
                .iter_mut()
                .zip(part.pixels(first))
                .for_each(|(to, pixel)| *to = pixel);
        });
    if let Some((part, first, n)) = beyond {
        out.features.extend_from_slice(&part.features[n * width..]);
        out.targets.extend_from_slice(&part.targets[n..]);
        out.pixels.extend(part.pixels(first).skip(n));
    }
}

/// Rows in the making: tasks that any threads take in any order, and whose rows are put together in the order of their
/// pixels.
#[derive(Debug)]
pub struct Making<'a> {
    stream: &'a RowStream,
    first: u64,
    pairs: usize,
    parts: Vec<Mutex<Part>>,
}

impl<'a> Making<'a> {
    /// So many rows from pixel `first` on, as far as at most so many tasks make them.
    pub fn new(stream: &'a RowStream, first: u64, pairs: usize, most_tasks: usize) -> Self {
        let tasks = stream.tasks(pairs).min(most_tasks);
        Self {
            stream,
            first,
            pairs,
            parts: std::iter::repeat_with(Mutex::default).take(tasks).collect(),
        }
    }

    /// Number of tasks.
    pub fn tasks(&self) -> usize {
        self.parts.len()
    }

    /// Features of a row, W.
    pub fn width(&self) -> usize {
        self.stream.width()
    }

    /// Does one of the tasks.
    pub fn run(&self, task: usize) {
        let part = self.stream.part(self.first + (task * TASK) as u64, TASK);
        *self.parts[task].lock().unwrap_or_else(PoisonError::into_inner) = part;
    }

    /// Does all of them, and gives what they have made in the order of the pixels; the pixel that reaches the number of
    /// rows is the last.
    fn run_all(&self) -> Vec<Part> {
        (0..self.tasks()).into_par_iter().for_each(|task| self.run(task));
        self.made()
    }

    /// What the tasks have made.
    fn made(&self) -> Vec<Part> {
        let mut rows = 0;
        let mut out = Vec::with_capacity(self.tasks());
        for part in &self.parts {
            if rows >= self.pairs {
                break;
            }
            let mut part = std::mem::take(&mut *part.lock().unwrap_or_else(PoisonError::into_inner));
            part.truncate(self.pairs - rows, self.stream.width());
            rows += part.len();
            out.push(part);
        }
        out
    }

    /// Whole pixels with at least as many rows as were asked for, once all tasks are done: where those fell short,
    /// others follow.
    ///
    /// # Errors
    /// [`DatasetError::NothingToLearn`].
    pub fn finish(&self) -> Result<Vec<Part>, DatasetError> {
        let mut parts = self.made();
        loop {
            let (rows, pixels) = count(&parts);
            if rows >= self.pairs {
                return Ok(parts);
            }
            if rows == 0 && pixels > MAX_EMPTY_PIXELS {
                return Err(DatasetError::NothingToLearn);
            }
            parts.extend(Making::new(self.stream, self.first + pixels, self.pairs - rows, WAVE).run_all());
        }
    }
}

/// Rows and pixels of parts.
fn count(parts: &[Part]) -> (usize, u64) {
    parts.iter().fold((0, 0), |(rows, pixels), part| {
        (rows + part.len(), pixels + part.counts.len() as u64)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::build::tests::sizes;
    use crate::features::{FeatureSet, SumPrecision};

    /// Bytes of sampled rows, the same at every SIMD level and on every machine.
    #[test]
    fn bytes_of_sampled_rows_are_pinned() {
        let hash = |features: FeatureSet| {
            let config = DatasetConfig {
                features,
                rows_per_pixel: 4,
                ..sizes()
            };
            let synth = if features == FeatureSet::Paper {
                SynthConfig::paper()
            } else {
                SynthConfig::wide()
            };
            let rows = RowStream::new(7, &synth, &config, Purpose::Training)
                .unwrap()
                .take(2000, &|_| {})
                .unwrap();
            let bytes: Vec<u8> = rows
                .features
                .iter()
                .chain(&rows.targets)
                .flat_map(|v| v.to_le_bytes())
                .collect();
            crate::numeric::digest::sha256_hex([bytes.as_slice()])
        };
        insta::assert_snapshot!(format!("{}\n{}", hash(FeatureSet::Paper), hash(FeatureSet::Recentred6)));
    }

    fn streamed(change: impl FnOnce(&mut DatasetConfig)) -> Rows {
        let mut config = DatasetConfig {
            features: FeatureSet::Recentred,
            rows_per_pixel: 4,
            ..sizes()
        };
        change(&mut config);
        RowStream::new(7, &SynthConfig::wide(), &config, Purpose::Training)
            .unwrap()
            .take(3000, &|_| {})
            .unwrap()
    }

    /// At most four rows of a pixel, whole pixels; targets in (0, 1]; features finite and, but for the logarithms, in
    /// [−1, 1].
    #[test]
    fn streamed_rows_are_in_their_domain() {
        for rows in [
            streamed(|_| {}),
            streamed(|c| c.storage = SumPrecision::F16),
            streamed(|c| c.storage = SumPrecision::Unorm16),
        ] {
            assert!(rows.len() >= 3000 && rows.len() < 3004);
            assert!(rows.pixels.chunk_by(|a, b| a == b).all(|of_one| of_one.len() <= 4));
            assert!(rows.targets.iter().all(|t| (0.0..=1.0).contains(t)));
            for row in rows.features.chunks_exact(7) {
                assert!(
                    row.iter().all(|f| f.is_finite())
                        && (-1.0..=1.0).contains(&row[0])
                        && row[3..].iter().all(|f| (-1.0..=1.0).contains(f)),
                    "{row:?}"
                );
            }
        }
    }

    /// Rounding to 16 bits moves the features of the same fragments, and not their answers.
    #[test]
    fn storage_is_what_moments_are_rounded_to() {
        let all = |storage| streamed(|c| (c.rows_per_pixel, c.storage) = (0, storage));
        let single = all(SumPrecision::F32);
        for storage in [SumPrecision::F16, SumPrecision::Unorm16] {
            compare(&single, &all(storage));
        }
    }

    fn compare(single: &Rows, half: &Rows) {
        // Closed forms answer fewer fragments from coarser moments, so rows differ in number; compare pixels that have
        // as many.
        let of = |rows: &Rows| -> Vec<(u32, Vec<f32>, Vec<f32>)> {
            let mut at = 0;
            let pixels = rows.pixels.chunk_by(|a, b| a == b);
            pixels
                .map(|p| {
                    let range = at..at + p.len();
                    at = range.end;
                    (
                        p[0],
                        rows.features[7 * range.start..7 * range.end].to_vec(),
                        rows.targets[range].to_vec(),
                    )
                })
                .collect()
        };
        let half: std::collections::HashMap<u32, (Vec<f32>, Vec<f32>)> =
            of(half).into_iter().map(|(p, f, t)| (p, (f, t))).collect();
        let same: Vec<_> = of(single)
            .into_iter()
            .filter_map(|(p, f, t)| half.get(&p).filter(|h| h.1.len() == t.len()).map(|h| (f, t, h)))
            .collect();
        assert!(same.len() > 30, "{}", same.len());
        assert!(same.iter().all(|(_, t, half)| *t == half.1));
        assert!(same.iter().filter(|(f, _, half)| *f != half.0).count() > same.len() / 2);
    }

    #[test]
    fn what_cannot_be_streamed_is_named() {
        let error =
            |config: &DatasetConfig, synth: &SynthConfig| match RowStream::new(1, synth, config, Purpose::Training) {
                Err(error) => error.to_string(),
                Ok(mut stream) => stream.take(10, &|_| {}).unwrap_err().to_string(),
            };
        let deep = DatasetConfig {
            features: FeatureSet::DeepWeightedBlended,
            ..sizes()
        };
        assert_eq!(
            error(&deep, &SynthConfig::paper()),
            "dataset.features = 'deep-weighted-blended': its pixels cannot be streamed; set dataset.refresh to 0"
        );
        let mut few = SynthConfig::paper();
        few.pixels[0].fragments.max = 3;
        let recentred = DatasetConfig {
            features: FeatureSet::Recentred,
            ..sizes()
        };
        assert!(error(&recentred, &few).contains("none needs the network"));
        let wrong = DatasetConfig {
            refresh: 1.5,
            ..sizes()
        };
        assert_eq!(
            error(&wrong, &SynthConfig::paper()),
            "dataset.refresh = 1.5: must be from 0 to 1"
        );
    }

    /// Whatever is asked for at a time, however wrong the foresight and however many the threads: the same rows of the
    /// same pixels.
    #[test]
    fn rows_depend_on_their_pixels_alone() {
        let config = DatasetConfig {
            features: FeatureSet::Recentred,
            rows_per_pixel: 4,
            ..sizes()
        };
        let fresh = || RowStream::new(7, &SynthConfig::wide(), &config, Purpose::Training).unwrap();
        let mut stream = fresh();
        let whole = stream.take(5000, &|_| {}).unwrap();
        assert!(whole.len() < 5004 && whole.pixels.is_sorted());
        let (rows, pixels) = (whole.len(), stream.position());
        assert_eq!(u64::from(whole.pixels[rows - 1]) + 1, pixels);
        for expected in [(1, 1), (100, 1), (1, 100)] {
            for threads in [1, 3] {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                let again = pool
                    .install(|| fresh().expecting(expected.0, expected.1).take(5000, &|_| {}))
                    .unwrap();
                assert!(again == whole, "{expected:?} on {threads} threads");
                let parts = pool
                    .install(|| Making::new(&fresh().expecting(expected.0, expected.1), 0, 5000, 7).finish())
                    .unwrap();
                assert_eq!(count(&parts), (rows, pixels));
                let all = parts
                    .iter()
                    .flat_map(|part| (0..part.len()).map(move |i| part.row(i, 7)));
                assert!(all.eq((0..rows).map(|i| whole.row(i))));
            }
        }
        // In two goes, the second of them from where the first ended.
        let mut stream = fresh();
        let first = stream.take(1234, &|n| assert!(n >= 1234)).unwrap();
        let second = stream.take(rows - first.len(), &|_| {}).unwrap();
        assert_eq!(stream.position(), pixels);
        assert!([first.targets, second.targets].concat() == whole.targets);
        assert!([first.features, second.features].concat() == whole.features);
        // Control: other pixels have other rows. None is asked for, none is made.
        stream.skip_to(1);
        assert!(stream.take(5000, &|_| {}).unwrap().targets != whole.targets);
        assert!(stream.take(0, &|_| {}).unwrap().is_empty());
    }
}
