//! Speed of training: whole steps of Adam over rows in memory.

use super::network::training_multiply_adds;
use super::{BenchError, Measurement, Network, Plan, Subject, measure, peak};
use crate::dataset::{Batch, Blocks, Rows};
use crate::numeric::lanes::LANES;
use crate::numeric::rng::stream;
use crate::train::{Backend, Schedule, TrainConfig, fused};
use fearless_simd::Level;
use rand::seq::SliceRandom;

/// Keeps the order of rows apart from all other random numbers.
const PURPOSE: u64 = 0x100c;

/// Samples a second of every backend, by turns with one another and with the multiply-add peak.
///
/// A call is one step on the next batch: blocks of rows in random order, gradient, Adam. Rows that are left over after the last whole batch are not used.
///
/// # Errors
/// [`BenchError`] where the rows do not fit the network or are fewer than a batch, or the batch is no multiple of sixteen.
pub fn train(
    plan: Plan,
    network: &Network,
    backends: &[Backend],
    rows: &Rows,
    batch: usize,
    progress: &dyn Fn(u64),
) -> Result<Vec<Measurement>, BenchError> {
    let network = network.clone().on(rows.feature_set)?;
    super::check(batch >= 1 && batch.is_multiple_of(LANES), "batch", batch, "a multiple of 16, at least 16")?;
    if rows.len() < batch {
        return Err(BenchError::Rows { rows: rows.len(), batch });
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
    let batches: Vec<Batch<'_>> = order.chunks_exact(batch / LANES).map(|order| Batch { blocks: &blocks, order }).collect();

    let mut subjects: Vec<Subject<'_>> = backends
        .iter()
        .map(|backend| {
            let mut optimiser = backend.optimiser(network.feature_set(), &network.shapes(), &network.parameters(), &config);
            let mut batches = batches.iter().cycle();
            Subject::new(move || {
                let batch = *batches.next().expect("one batch or more");
                std::hint::black_box(optimiser.step(batch, config.learning_rate));
                Ok(batch.rows() as u64)
            })
        })
        .collect();
    subjects.push(peak::subject());
    let mut samples = measure(plan, &mut subjects, progress)?;
    let peak = samples.pop().expect("one for each subject");
    let flops = 2 * training_multiply_adds(&network.shapes());
    let of = |(&backend, samples)| Measurement {
        network: network.to_string(),
        backend: Backend::name(backend),
        batch,
        simd: (backend == Backend::Fused).then(|| fused::level_name(Level::new())),
        flops,
        samples,
        peak: peak.clone(),
        worst_difference: None,
    };
    Ok(backends.iter().zip(samples).map(of).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::network::random_rows;
    use crate::features::FeatureSet;

    const PLAN: Plan = Plan { repeat: 2, sample_seconds: 1e-4 };

    #[test]
    fn what_does_not_fit_is_refused() {
        let network: Network = "7-8-1".parse().unwrap();
        let rows = random_rows(FeatureSet::Recentred, 100);
        let error = |rows: &Rows, batch| train(PLAN, &network, &[Backend::Fused], rows, batch, &|_| {}).unwrap_err().to_string();
        assert!(error(&rows, 0).contains("multiple of 16"));
        assert!(error(&rows, 40).contains("multiple of 16"));
        assert!(error(&rows, 112).contains("100 rows are fewer than the 112"));
        assert!(error(&random_rows(FeatureSet::Recentred6, 100), 16).contains("takes 7 features"));
        // Control: what fits is measured.
        let measured = train(PLAN, &network, &[Backend::Fused, Backend::Flex], &rows, 48, &|_| {}).unwrap();
        assert_eq!(measured.iter().map(|m| m.backend).collect::<Vec<_>>(), ["fused", "flex"]);
        for m in measured {
            assert_eq!((m.samples.rates.len(), m.peak.rates.len(), m.flops), (2, 2, 2 * (3 * 64 - 56)));
            assert!(m.rows_per_second() > 0.0 && m.share_of_peak() > 0.0 && m.peak_gflops().is_finite());
        }
    }
}
