//! Speed of generation: random pixels, their features and exact answers, as training streams them.

use super::network::MAX_ROWS;
use super::{BenchError, Plan, Samples, Subject, measure};
use crate::dataset::{DatasetConfig, RowStream};
use crate::synth::{Purpose, SynthConfig};

/// What to generate.
#[derive(Debug, Clone)]
pub struct Source {
    /// How it is called.
    pub name: String,
    /// Seed of the random pixels.
    pub seed: u64,
    /// Distribution of the pixels.
    pub synth: SynthConfig,
    /// Feature set, choice of rows and weights.
    pub dataset: DatasetConfig,
}

/// Speed of one source.
#[derive(Debug, Clone, PartialEq)]
pub struct Generation {
    /// How the source is called.
    pub name: String,
    /// Its feature set.
    pub features: &'static str,
    /// What was measured; the work is counted in pairs of features and answer.
    pub samples: Samples,
}

/// Pairs a second of every source, by turns. A call takes `pairs` rows of pixels that were not drawn before.
///
/// # Errors
/// [`BenchError::Dataset`] where a source is invalid.
pub fn generate(
    plan: Plan,
    sources: &[Source],
    pairs: usize,
    progress: &dyn Fn(u64),
) -> Result<Vec<Generation>, BenchError> {
    super::check((1..=MAX_ROWS).contains(&pairs), "pairs", pairs, "from 1 to 67108864")?;
    let streams: Vec<RowStream> = sources
        .iter()
        .map(|s| RowStream::new(s.seed, &s.synth, &s.dataset, Purpose::Training))
        .collect::<Result<_, _>>()?;
    let mut subjects: Vec<Subject<'_>> = streams
        .into_iter()
        .map(|mut stream| Subject::new(move || Ok(stream.take(pairs, &|_| {})?.len() as u64)))
        .collect();
    let samples = measure(plan, &mut subjects, progress)?;
    let of = |(source, samples): (&Source, _)| Generation {
        name: source.name.clone(),
        features: source.dataset.features.name(),
        samples,
    };
    Ok(sources.iter().zip(samples).map(of).collect())
}
