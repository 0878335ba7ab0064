//! Speed of training: whole steps of Adam over rows in memory; whole epochs with fresh pixels.

use super::network::training_multiply_adds;
use super::{BenchError, Measurement, Network, Plan, Samples, Subject, Summary, measure, peak};
use crate::dataset::file::Manifest;
use crate::dataset::{Batch, Blocks, Dataset, RowStream, Rows};
use crate::model::{Mlp, Provenance};
use crate::numeric::lanes::LANES;
use crate::numeric::rng::stream;
use crate::synth::Purpose;
use crate::train::feed::Feed;
use crate::train::trainer::mean_squared_error;
use crate::train::{Backend, Schedule, TrainConfig, TrainError, fused, initial};
use fearless_simd::Level;
use rand::seq::SliceRandom;

/// Keeps the order of rows apart from all other random numbers.
const PURPOSE: u64 = 0x100c;

/// Samples a second of every backend, by turns with one another and with the multiply-add peak.
///
/// A call is one step on the next batch: blocks of rows in random order, gradient, Adam. Rows that are left over after
/// the last whole batch are not used.
///
/// # Errors
/// [`BenchError`] where the rows do not fit the network or are fewer than a batch, or the batch is no multiple of
/// sixteen.
pub fn train(
    plan: Plan,
    network: &Network,
    backends: &[Backend],
    rows: &Rows,
    batch: usize,
    progress: &dyn Fn(u64),
) -> Result<Vec<Measurement>, BenchError> {
    let network = network.clone().on(rows.feature_set)?;
    super::check(
        batch >= 1 && batch.is_multiple_of(LANES),
        "batch",
        batch,
        "a multiple of 16, at least 16",
    )?;
    if rows.len() < batch {
        return Err(BenchError::Rows {
            rows: rows.len(),
            batch,
        });
    }
    let config = TrainConfig {
        hidden: network.hidden().to_vec(),
        epochs: 1,
        batch,
        learning_rate: 1e-3,
        schedule: Schedule::Constant,
        warmup_steps: 0,
        seeds: 1,
        beta1: 0.9,
        beta2: 0.999,
        epsilon: 1e-7,
        checkpoint_every: 1,
    };
    let mut order: Vec<u32> = (0..rows.len() as u32).collect();
    order.truncate(rows.len() / batch * batch);
    let blocks = Blocks::of(rows, &order);
    let mut order = fused::all_blocks(&blocks);
    order.shuffle(&mut stream(1, PURPOSE, 0));
    let batches: Vec<Batch<'_>> = order
        .chunks_exact(batch / LANES)
        .map(|order| Batch { blocks: &blocks, order })
        .collect();

    let mut subjects: Vec<Subject<'_>> = Vec::new();
    let mut adapters = Vec::new();
    for backend in backends {
        adapters.push(backend.adapter()?);
        let mut optimiser =
            backend.optimiser(network.feature_set(), &network.shapes(), &network.parameters(), &config)?;
        let mut batches = batches.iter().cycle();
        let learning_rate = config.learning_rate;
        subjects.push(Subject::new(move || {
            let batch = *batches.next().expect("one batch or more");
            std::hint::black_box(optimiser.step(batch, learning_rate));
            Ok(batch.rows() as u64)
        }));
    }
    subjects.push(peak::subject());
    let mut samples = measure(plan, &mut subjects, progress)?;
    let peak = samples.pop().expect("one for each subject");
    let flops = 2 * training_multiply_adds(&network.shapes());
    let of = |((&backend, samples), adapter)| Measurement {
        network: network.to_string(),
        backend: Backend::name(backend),
        batch,
        simd: (backend == Backend::Fused).then(|| fused::level_name(Level::new())),
        adapter,
        flops,
        samples,
        peak: peak.clone(),
        worst_difference: None,
    };
    Ok(backends.iter().zip(samples).zip(adapters).map(of).collect())
}

/// Speed of training on fresh pixels, beside what it is made of.
#[derive(Debug, Clone, PartialEq)]
pub struct Streaming {
    /// "7-32-16-1".
    pub network: String,
    /// What computed.
    pub backend: &'static str,
    /// Name of the GPU where one computed.
    pub adapter: Option<String>,
    /// Rows of a step.
    pub batch: usize,
    /// Rows of an epoch.
    pub rows: usize,
    /// Share of them that fresh ones replace after every epoch.
    pub refresh: f64,
    /// Whole epochs, validation with them, on rows that stay what they are; the work is counted in samples.
    pub in_memory: Samples,
    /// The same epochs with fresh rows.
    pub streamed: Samples,
    /// Generation alone, of as many rows as an epoch replaces; the work is counted in rows.
    pub generation: Samples,
}

impl Streaming {
    /// Samples a second that epochs with fresh rows could have at best, where the same cores make them: all time goes
    /// into training and generation alone.
    pub fn bound(&self) -> f64 {
        let [training, generation] =
            [&self.in_memory, &self.generation].map(|samples| Summary::of(&samples.rates).median);
        1.0 / (1.0 / training + self.refresh / generation)
    }

    /// Median of the samples a second with fresh rows.
    pub fn samples_per_second(&self) -> f64 {
        Summary::of(&self.streamed.rates).median
    }
}

/// Samples a second of whole epochs with fresh pixels, by turns with the same rows in memory and with generation alone.
/// A call is one epoch, validation with it.
///
/// # Errors
/// [`BenchError`] where the dataset has no fresh pixels, or the backend cannot be had.
pub fn stream_epochs(
    plan: Plan,
    dataset: &Dataset,
    config: &TrainConfig,
    seed: u64,
    backend: Backend,
    progress: &dyn Fn(u64),
) -> Result<Streaming, BenchError> {
    let manifest = &dataset.manifest;
    let refresh = manifest.dataset.refresh;
    super::check(
        refresh > 0.0,
        "dataset.refresh",
        refresh,
        "greater than 0, so that there are fresh pixels",
    )?;
    let failed = |error: TrainError| BenchError::Train(error.to_string());
    let set = dataset.training.feature_set;
    let shapes = initial::shapes(set.width(), &config.hidden);
    let mut fixed = Manifest::clone(manifest);
    fixed.dataset.refresh = 0.0;
    let mut subjects: Vec<Subject<'_>> = Vec::new();
    for manifest in [&fixed, manifest] {
        let mut optimiser = backend.optimiser(set, &shapes, &initial::glorot(&shapes, seed), config)?;
        let mut feed = Feed::new(&dataset.training, manifest, seed, config.batch, 0).map_err(failed)?;
        let (mut epoch, shapes) = (0, &shapes);
        subjects.push(Subject::new(move || {
            epoch += 1;
            let error = feed
                .epoch(epoch, true, optimiser.as_mut(), &|_| config.learning_rate, &|| false)
                .map_err(failed)?;
            let mlp = Mlp::new(
                "bench",
                set,
                initial::layers(shapes, &optimiser.parameters())?,
                Provenance::default(),
            )?;
            std::hint::black_box((error, mean_squared_error(&mlp, &dataset.validation)));
            Ok(feed.rows() as u64)
        }));
    }
    let synth = manifest.synth.as_ref().ok_or_else(|| failed(TrainError::NoStream))?;
    let mut stream = RowStream::new(manifest.seed, synth, &manifest.dataset, Purpose::Training)?;
    let fresh = (refresh * dataset.training.len() as f64).ceil() as usize;
    subjects.push(Subject::new(move || Ok(stream.take(fresh, &|_| {})?.len() as u64)));
    let samples = measure(plan, &mut subjects, progress)?;
    let [in_memory, streamed, generation] = samples.try_into().expect("one for each subject");
    let network = std::iter::once(set.width())
        .chain(shapes.iter().map(|s| s.1))
        .map(|n| n.to_string())
        .collect::<Vec<_>>()
        .join("-");
    let rows = dataset.training.len();
    Ok(Streaming {
        network,
        backend: backend.name(),
        adapter: backend.adapter()?,
        batch: config.batch,
        rows,
        refresh,
        in_memory,
        streamed,
        generation,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::network::random_rows;
    use crate::dataset::{DatasetConfig, build};
    use crate::features::FeatureSet;
    use crate::synth::SynthConfig;

    /// Whole epochs are counted, and the bound is what two rates allow: a third of a second for training and two thirds
    /// for generation make one.
    #[test]
    fn streamed_epochs_are_bounded_by_their_parts() {
        let sizes = DatasetConfig {
            refresh: 0.5,
            rows_per_pixel: 4,
            ..DatasetConfig::of(FeatureSet::Recentred, 300, 100)
        };
        let dataset = build("s", 3, &SynthConfig::wide(), &sizes, &|_| {}).unwrap();
        let config: TrainConfig = toml::from_str("hidden = [8]\nepochs = 1\nbatch = 64\nlearning_rate = 1e-3").unwrap();
        let measured = stream_epochs(PLAN, &dataset, &config, 1, Backend::Fused, &|_| {}).unwrap();
        assert_eq!(
            (measured.network.as_str(), measured.rows, measured.refresh),
            ("7-8-1", dataset.training.len(), 0.5)
        );
        for samples in [&measured.in_memory, &measured.streamed] {
            assert!(
                samples
                    .rates
                    .iter()
                    .zip(&samples.seconds)
                    .all(|(r, s)| (r * s / measured.rows as f64 - 1.0).abs() < 1e-9)
            );
        }
        assert!(measured.samples_per_second() > 0.0);
        let of = |rate: f64| Samples {
            calls: 1,
            seconds: vec![1.0],
            rates: vec![rate],
        };
        assert!(
            (Streaming {
                in_memory: of(3.0),
                generation: of(0.75),
                ..measured
            }
            .bound()
                - 1.0)
                .abs()
                < 1e-12
        );
        let fixed = build(
            "s",
            3,
            &SynthConfig::wide(),
            &DatasetConfig { refresh: 0.0, ..sizes },
            &|_| {},
        )
        .unwrap();
        let error = stream_epochs(PLAN, &fixed, &config, 1, Backend::Fused, &|_| {}).unwrap_err();
        assert!(error.to_string().contains("fresh pixels"), "{error}");
    }

    const PLAN: Plan = Plan {
        repeat: 2,
        sample_seconds: 1e-4,
    };

    #[test]
    fn what_does_not_fit_is_refused() {
        let network: Network = "7-8-1".parse().unwrap();
        let rows = random_rows(FeatureSet::Recentred, 100);
        let error = |rows: &Rows, batch| {
            train(PLAN, &network, &[Backend::Fused], rows, batch, &|_| {})
                .unwrap_err()
                .to_string()
        };
        assert!(error(&rows, 0).contains("multiple of 16"));
        assert!(error(&rows, 40).contains("multiple of 16"));
        assert!(error(&rows, 112).contains("100 rows are fewer than the 112"));
        assert!(error(&random_rows(FeatureSet::Recentred6, 100), 16).contains("takes 7 features"));
        // Control: what fits is measured.
        #[cfg(feature = "burn")]
        let backends = [Backend::Fused, Backend::Burn(crate::train::Engine::Ndarray)];
        #[cfg(not(feature = "burn"))]
        let backends = [Backend::Fused];
        let measured = train(PLAN, &network, &backends, &rows, 48, &|_| {}).unwrap();
        assert_eq!(
            measured.iter().map(|m| m.backend).collect::<Vec<_>>(),
            backends.map(Backend::name)
        );
        for m in measured {
            assert_eq!(
                (m.samples.rates.len(), m.peak.rates.len(), m.flops),
                (2, 2, 2 * (3 * 64 - 56))
            );
            assert!(m.rows_per_second() > 0.0 && m.share_of_peak() > 0.0 && m.peak_gflops().is_finite());
        }
    }
}
