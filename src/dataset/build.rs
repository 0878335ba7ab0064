//! Building datasets from random pixels.

use super::file::{MANIFEST_VERSION, Manifest, Part};
use super::{Dataset, Rows};
use crate::features::{Extractor, FeatureSet};
use crate::pixel::{DepthError, FragmentList, abuffer};
use crate::synth::{Purpose, Synth, SynthConfig, SynthError};
use serde::{Deserialize, Serialize};

/// Most rows that a dataset may be configured to have.
pub const MOST_PAIRS: u64 = 1 << 30;

/// How large a dataset is and what its columns are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DatasetConfig {
    /// The feature set of its columns.
    pub features: FeatureSet,
    /// Least number of training rows; the pixel that reaches it is kept whole.
    pub training_pairs: u64,
    /// Least number of validation rows, of pixels of their own.
    pub validation_pairs: u64,
}

/// Why a dataset could not be built.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DatasetError {
    /// The number of rows is 0 or absurd.
    #[error("dataset.{field} = {value}: must be from 1 to {MOST_PAIRS}")]
    Size {
        /// The field.
        field: &'static str,
        /// Its value.
        value: u64,
    },
    /// The distribution is invalid.
    #[error(transparent)]
    Synth(#[from] SynthError),
    /// A fragment's depth does not fit the feature set.
    #[error(transparent)]
    Depth(#[from] DepthError),
}

impl DatasetConfig {
    /// Checks the sizes.
    ///
    /// # Errors
    /// [`DatasetError::Size`].
    pub fn validate(&self) -> Result<(), DatasetError> {
        for (field, value) in [("training_pairs", self.training_pairs), ("validation_pairs", self.validation_pairs)] {
            if !(1..=MOST_PAIRS).contains(&value) {
                return Err(DatasetError::Size { field, value });
            }
        }
        Ok(())
    }
}

/// Features and exact transmittance of every fragment of a list.
///
/// # Errors
/// [`DepthError`] where a fragment's depth does not fit the feature set.
pub fn rows(list: &FragmentList, extractor: &Extractor) -> Result<Rows, DepthError> {
    let features = extractor.list(list, 0..list.pixels())?;
    let targets = abuffer::list_transmittance(list).into_iter().map(|t| t as f32).collect();
    let pixels = (0..list.pixels()).flat_map(|p| std::iter::repeat_n(p as u32, list.pixel(p).len())).collect();
    Ok(Rows { feature_set: extractor.set(), features, targets, pixels })
}

/// Whole pixels of a purpose, from pixel 0 on, as many as it takes to hold `pairs` fragments. `progress` is told how many there are so far.
pub fn pixels_holding(synth: &Synth, purpose: Purpose, pairs: u64, progress: &dyn Fn(u64)) -> FragmentList {
    const CHUNK: usize = 4096;
    let mut offsets = vec![0];
    let (mut view_z, mut alpha) = (Vec::new(), Vec::new());
    'enough: loop {
        let chunk = synth.pixels(purpose, offsets.len() as u64 - 1, CHUNK);
        for p in 0..chunk.pixels() {
            let pixel = chunk.pixel(p);
            view_z.extend_from_slice(pixel.view_z);
            alpha.extend_from_slice(pixel.alpha);
            offsets.push(view_z.len() as u64);
            if view_z.len() as u64 >= pairs {
                break 'enough;
            }
        }
        progress(view_z.len() as u64);
    }
    FragmentList::new(offsets, view_z, alpha, None).expect("made of valid pixels").with_planes(synth.config().camera)
}

/// Builds a dataset and returns it with the pixels that it was made of: training pixels, validation pixels.
///
/// # Errors
/// [`DatasetError`] names the field that is wrong.
pub fn build(
    name: &str,
    seed: u64,
    synth: &SynthConfig,
    config: &DatasetConfig,
    progress: &dyn Fn(u64),
) -> Result<(Dataset, [FragmentList; 2]), DatasetError> {
    config.validate()?;
    let source = Synth::new(synth.clone(), seed)?;
    let extractor = Extractor::new(config.features, Some(synth.camera))?;
    let training_pixels = pixels_holding(&source, Purpose::Training, config.training_pairs, progress);
    let made = training_pixels.len() as u64;
    let validation_pixels = pixels_holding(&source, Purpose::Validation, config.validation_pairs, &|n| progress(made + n));
    let training = rows(&training_pixels, &extractor)?;
    let validation = rows(&validation_pixels, &extractor)?;
    let parts = [("training", &training, &training_pixels), ("validation", &validation, &validation_pixels)]
        .map(|(part, rows, pixels)| Part::of(part, rows, pixels.pixels()));
    let [training_part, validation_part] = parts;
    let manifest = Manifest {
        format: "nmt-dataset".to_owned(),
        version: MANIFEST_VERSION,
        name: name.to_owned(),
        seed,
        features: config.features,
        columns: config.features.columns().iter().map(|&c| c.to_owned()).collect(),
        target: "transmittance".to_owned(),
        synth: synth.clone(),
        dataset: config.clone(),
        hash: Manifest::hash_of(&training_part, &validation_part),
        training: training_part,
        validation: validation_part,
    };
    Ok((Dataset { training, validation, manifest }, [training_pixels, validation_pixels]))
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    pub(crate) fn small() -> (Dataset, [FragmentList; 2]) {
        let config = DatasetConfig { features: FeatureSet::Paper, training_pairs: 3000, validation_pairs: 500 };
        build("small", 3, &SynthConfig::paper(), &config, &|_| {}).unwrap()
    }

    #[test]
    fn whole_pixels_as_many_as_it_takes() {
        let (dataset, [training, validation]) = small();
        assert!(training.len() >= 3000 && training.len() < 3000 + 32);
        assert_eq!(dataset.training.len(), training.len());
        assert_eq!(dataset.training.features.len(), 7 * training.len());
        // The last pixel is the one that reached the number.
        assert!(training.len() - training.pixel(training.pixels() - 1).len() < 3000);
        // Every pixel is in whole: its rows are as many as its own feature n says.
        for rows in [&dataset.training, &dataset.validation] {
            let mut counts = vec![0; rows.pixels[rows.len() - 1] as usize + 1];
            rows.pixels.iter().for_each(|&p| counts[p as usize] += 1);
            for (row, &p) in rows.features.chunks_exact(7).zip(&rows.pixels) {
                assert_eq!(row[1], counts[p as usize] as f32);
            }
        }
        assert!(dataset.validation.len() >= 500);
        // No validation pixel is a training pixel.
        let starts: std::collections::HashSet<u32> = (0..training.pixels()).map(|p| training.pixel(p).view_z[0].to_bits()).collect();
        assert!((0..validation.pixels()).all(|p| !starts.contains(&validation.pixel(p).view_z[0].to_bits())));
    }

    #[test]
    fn targets_are_the_a_buffer() {
        let (dataset, [training, _]) = small();
        let mut exact = vec![0.0; training.pixel(5).len()];
        abuffer::transmittance(training.pixel(5), &mut exact);
        let stored = &dataset.training.targets[training.range(5)];
        assert!(exact.iter().zip(stored).all(|(e, &s)| *e as f32 == s));
    }

    #[test]
    fn sizes_are_validated() {
        let mut config = DatasetConfig { features: FeatureSet::Paper, training_pairs: 0, validation_pairs: 1 };
        let error = build("x", 1, &SynthConfig::paper(), &config, &|_| {}).unwrap_err();
        assert_eq!(error.to_string(), "dataset.training_pairs = 0: must be from 1 to 1073741824");
        config.training_pairs = u64::MAX;
        assert!(config.validate().is_err());
    }
}
