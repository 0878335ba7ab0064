//! Building datasets from random pixels, or from the pixels of given lists.

use super::file::{ListSource, MANIFEST_VERSION, Manifest, Part};
use super::{Dataset, RowStream, Rows};
use crate::features::{Extracted, Extractor, FeatureSet, Known, Sampled, SumPrecision};
use crate::numeric::rng::stream;
use crate::pixel::{DepthError, FragmentList};
use crate::synth::{Purpose, Synth, SynthConfig, SynthError};
use rand::seq::SliceRandom;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Keeps the random numbers of the split into training and validation pixels apart from all others.
const SPLIT_PURPOSE: u64 = 0x1004;

/// Keeps those that choose fragments behind a core apart from all others.
const CORE_PURPOSE: u64 = 0x1012;

/// Most rows that a dataset may be configured to have.
pub const MAX_PAIRS: u64 = 1 << 30;

/// How large a dataset is and what its columns are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct DatasetConfig {
    /// The feature set of its columns.
    pub features: FeatureSet,
    /// Least number of training rows; the pixel that reaches it is kept whole.
    pub training_pairs: u64,
    /// Least number of validation rows, of pixels of their own.
    pub validation_pairs: u64,
    /// Most rows of one pixel, chosen at random among those that a network is asked about; all of them where 0.
    #[serde(default, skip_serializing_if = "is_default")]
    pub rows_per_pixel: u32,
    /// Precision in which moments are added up, where the feature set leaves that open.
    #[serde(default, skip_serializing_if = "is_default")]
    pub storage: SumPrecision,
    /// Share of the training rows that fresh pixels replace after every epoch; a fixed dataset where 0.
    #[serde(default, skip_serializing_if = "is_default")]
    pub refresh: f64,
}

/// Whether a value need not be written to a file.
pub(crate) fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// Why a dataset could not be built.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DatasetError {
    /// The number of rows is 0 or absurd.
    #[error("dataset.{field} = {value}: must be from 1 to {MAX_PAIRS}")]
    Size {
        /// The field.
        field: &'static str,
        /// Its value.
        value: u64,
    },
    /// The share of rows that are replaced is none.
    #[error("dataset.refresh = {0}: must be from 0 to 1")]
    Refresh(f64),
    /// The feature set is not one that can be streamed.
    #[error("dataset.features = '{0}': its pixels cannot be streamed; set dataset.refresh to 0")]
    NoStream(&'static str),
    /// Random pixels hold nothing that a network is needed for.
    #[error("of a million random pixels none needs the network; let synth.pixels draw more than three fragments")]
    NothingToLearn,
    /// The distribution is invalid.
    #[error(transparent)]
    Synth(#[from] SynthError),
    /// A fragment's depth does not fit the feature set.
    #[error(transparent)]
    Depth(#[from] DepthError),
    /// A depth of a given list does not fit the feature set.
    #[error("fragment list '{name}': {source}")]
    ListDepth {
        /// The list.
        name: String,
        /// What is wrong.
        source: DepthError,
    },
    /// The given lists hold too little.
    #[error(
        "the fragment lists hold {found} fragments, too few for dataset.training_pairs + dataset.validation_pairs = \
            {needed} of whole pixels; \
         lower them, or add lists"
    )]
    TooFew {
        /// Fragments of all lists.
        found: u64,
        /// Rows asked for.
        needed: u64,
    },
}

impl DatasetConfig {
    /// A fixed dataset of these sizes: every row of a pixel, moments in f32.
    pub fn of(features: FeatureSet, training_pairs: u64, validation_pairs: u64) -> Self {
        Self {
            features,
            training_pairs,
            validation_pairs,
            rows_per_pixel: 0,
            storage: SumPrecision::default(),
            refresh: 0.0,
        }
    }

    /// Checks the sizes.
    ///
    /// # Errors
    /// [`DatasetError::Size`].
    pub fn validate(&self) -> Result<(), DatasetError> {
        for (field, value) in [
            ("training_pairs", self.training_pairs),
            ("validation_pairs", self.validation_pairs),
        ] {
            if !(1..=MAX_PAIRS).contains(&value) {
                return Err(DatasetError::Size { field, value });
            }
        }
        if !(0.0..=1.0).contains(&self.refresh) {
            return Err(DatasetError::Refresh(self.refresh));
        }
        Ok(())
    }
}

/// Features of a list's fragments and the exact answers that the feature set is trained on; fragments that need no
/// network have no row.
///
/// Of a set with a core the answers are those of the tail alone, and behind much core few fragments have a row, as in a
/// stream of random pixels.
///
/// # Errors
/// [`DepthError`] where a fragment's depth does not fit the feature set.
pub fn rows(list: &FragmentList, extractor: &Extractor) -> Result<Rows, DepthError> {
    if extractor.set().spec().core.is_some() {
        return Ok(rows_with_core(list, extractor));
    }
    let Extracted { known, features } = extractor.list(list, 0..list.pixels())?;
    let targets = extractor.set().target().of_list(list);
    let pixels = (0..list.pixels()).flat_map(|p| std::iter::repeat_n(p as u32, list.pixel(p).len()));
    let unknown = known
        .iter()
        .zip(targets)
        .zip(pixels)
        .filter(|((known, _), _)| matches!(known, Known::Front(_)));
    let (targets, pixels) = unknown.map(|((_, target), pixel)| (target as f32, pixel)).unzip();
    Ok(Rows {
        feature_set: extractor.set(),
        features,
        targets,
        weights: Vec::new(),
        pixels,
    })
}

/// [`rows`] of a set with a core.
fn rows_with_core(list: &FragmentList, extractor: &Extractor) -> Rows {
    let of_pixel = |p: usize| {
        let mut sampled = Sampled::default();
        let mut rng = stream(0, CORE_PURPOSE, p as u64);
        extractor.sample(list.pixel(p), usize::MAX, &mut rng, &mut sampled);
        sampled
    };
    let all: Vec<Sampled> = (0..list.pixels()).into_par_iter().map(of_pixel).collect();
    let mut rows = Rows::none(extractor.set());
    for (p, sampled) in all.into_iter().enumerate() {
        rows.features.extend(sampled.features);
        rows.targets.extend(sampled.targets);
        rows.pixels.extend(std::iter::repeat_n(p as u32, sampled.of_pixel));
    }
    rows
}

/// Whole pixels of a purpose, from pixel 0 on, as many as it takes to hold `pairs` fragments. `progress` is told how
/// many there are so far.
pub fn pixels_holding(synth: &Synth, purpose: Purpose, pairs: u64, progress: &dyn Fn(u64)) -> FragmentList {
    const CHUNK: usize = 4096;
    let mut offsets = vec![0];
    let (mut view_z, mut alpha) = (Vec::new(), Vec::new());
    while (view_z.len() as u64) < pairs {
        let chunk = synth.pixels(purpose, offsets.len() as u64 - 1, CHUNK);
        let before = view_z.len() as u64;
        // Of the last chunk only the pixels up to the one that reaches the number.
        let taken = chunk
            .offsets()
            .partition_point(|&end| before + end < pairs)
            .min(chunk.pixels());
        let fragments = chunk.offsets()[taken] as usize;
        offsets.extend(chunk.offsets()[1..=taken].iter().map(|end| before + end));
        view_z.extend_from_slice(&chunk.view_z()[..fragments]);
        alpha.extend_from_slice(&chunk.alpha()[..fragments]);
        progress(pairs.min(view_z.len() as u64));
    }
    FragmentList::new(offsets, view_z, alpha, None)
        .expect("made of valid pixels")
        .with_planes(synth.config().camera)
}

/// Builds a dataset of random pixels.
///
/// # Errors
/// [`DatasetError`] names the field that is wrong.
pub fn build(
    name: &str,
    seed: u64,
    synth: &SynthConfig,
    config: &DatasetConfig,
    progress: &dyn Fn(u64),
) -> Result<Dataset, DatasetError> {
    config.validate()?;
    if config.features.spec().is_sampled {
        let part = |purpose, pairs: u64, before: u64| -> Result<(Rows, usize), DatasetError> {
            let mut stream = RowStream::new(seed, synth, config, purpose)?;
            let rows = stream.take(pairs as usize, &|n| progress(before + n))?;
            Ok((rows, stream.position() as usize))
        };
        let (training, training_pixels) = part(Purpose::Training, config.training_pairs, 0)?;
        let (validation, validation_pixels) =
            part(Purpose::Validation, config.validation_pairs, training.len() as u64)?;
        let pixels = [training_pixels, validation_pixels];
        return Ok(dataset(
            name,
            seed,
            config,
            Some(synth.clone()),
            Vec::new(),
            [training, validation],
            pixels,
        ));
    }
    let source = Synth::new(synth.clone(), seed)?;
    let training_pixels = pixels_holding(&source, Purpose::Training, config.training_pairs, progress);
    let made = training_pixels.len() as u64;
    let validation_pixels = pixels_holding(&source, Purpose::Validation, config.validation_pairs, &|n| {
        progress(made + n)
    });
    // One scene has one depth range: validation pixels are seen with that of the training pixels.
    let extractor = Extractor::for_list(config.features, &training_pixels, None, None)?;
    let training = rows(&training_pixels, &extractor)?;
    let validation = rows(&validation_pixels, &extractor)?;
    let pixels = [training_pixels.pixels(), validation_pixels.pixels()];
    Ok(dataset(
        name,
        seed,
        config,
        Some(synth.clone()),
        Vec::new(),
        [training, validation],
        pixels,
    ))
}

/// The random pixels that a dataset was made of, drawn again: training pixels, validation pixels; none where they are
/// not random.
///
/// # Errors
/// [`DatasetError::Synth`] where the manifest's distribution is invalid.
pub fn pixels_of(manifest: &Manifest) -> Result<Option<[FragmentList; 2]>, DatasetError> {
    let Some(synth) = &manifest.synth else { return Ok(None) };
    let source = Synth::new(synth.clone(), manifest.seed)?;
    let part = |purpose, part: &Part| source.pixels(purpose, 0, part.pixels);
    Ok(Some([
        part(Purpose::Training, &manifest.training),
        part(Purpose::Validation, &manifest.validation),
    ]))
}

/// Builds a dataset of pixels drawn at random, without repetition, from given lists; `lists` are their names, which the
/// manifest keeps, and they.
///
/// The pixels are split, not the rows: none serves both training and validation. Depths are taken relative to the whole
/// list that a pixel is of.
///
/// # Errors
/// [`DatasetError::TooFew`] where the lists do not hold as many fragments as asked for; [`DatasetError::ListDepth`]
/// names the list whose depths do not fit the feature set.
pub fn build_from_lists(
    name: &str,
    seed: u64,
    lists: &[(&str, &FragmentList)],
    config: &DatasetConfig,
) -> Result<Dataset, DatasetError> {
    config.validate()?;
    let [validation, training] = split(seed, lists, config)?;
    let mut extractors = Vec::with_capacity(lists.len());
    for &(name, list) in lists {
        let in_list = |source| DatasetError::ListDepth {
            name: name.to_owned(),
            source,
        };
        extractors.push(
            Extractor::for_list(config.features, list, None, None)
                .map_err(in_list)?
                .with_precision(config.storage),
        );
    }
    let rows_of = |chosen: &[(u32, u32)]| {
        let mut all = Rows::none(config.features);
        let mut before = 0;
        for of_one in chosen.chunk_by(|a, b| a.0 == b.0) {
            let index = of_one[0].0 as usize;
            let part = selected(lists[index].1, of_one);
            let in_list = |source| DatasetError::ListDepth {
                name: lists[index].0.to_owned(),
                source,
            };
            let Rows {
                features,
                targets,
                pixels,
                ..
            } = rows(&part, &extractors[index]).map_err(in_list)?;
            all.features.extend(features);
            all.targets.extend(targets);
            all.pixels.extend(pixels.into_iter().map(|p| p + before));
            before += of_one.len() as u32;
        }
        Ok::<_, DatasetError>(all)
    };
    let rows = [rows_of(&training)?, rows_of(&validation)?];
    let sources = lists.iter().map(|(name, list)| ListSource::of(name, list)).collect();
    Ok(dataset(
        name,
        seed,
        config,
        None,
        sources,
        rows,
        [training.len(), validation.len()],
    ))
}

/// Pixels drawn at random for validation and for training, by list and place, each set in order.
fn split(
    seed: u64,
    lists: &[(&str, &FragmentList)],
    config: &DatasetConfig,
) -> Result<[Vec<(u32, u32)>; 2], DatasetError> {
    let mut pixels: Vec<(u32, u32)> = Vec::new();
    for (index, (_, list)) in lists.iter().enumerate() {
        pixels.extend(
            (0..list.pixels())
                .filter(|&p| !list.range(p).is_empty())
                .map(|p| (index as u32, p as u32)),
        );
    }
    pixels.shuffle(&mut stream(seed, SPLIT_PURPOSE, 0));
    let mut rest = pixels.as_slice();
    let mut take = |pairs: u64| {
        let mut taken = 0;
        let mut end = 0;
        while taken < pairs {
            let &(list, p) = rest.get(end)?;
            taken += lists[list as usize].1.range(p as usize).len() as u64;
            end += 1;
        }
        let (head, tail) = rest.split_at(end);
        rest = tail;
        let mut chosen = head.to_vec();
        chosen.sort_unstable();
        Some(chosen)
    };
    let (Some(validation), Some(training)) = (take(config.validation_pairs), take(config.training_pairs)) else {
        let found = lists.iter().map(|(_, list)| list.len() as u64).sum();
        return Err(DatasetError::TooFew {
            found,
            needed: config.training_pairs + config.validation_pairs,
        });
    };
    Ok([validation, training])
}

/// Some pixels of a list, in order, without colours.
fn selected(list: &FragmentList, pixels: &[(u32, u32)]) -> FragmentList {
    let mut offsets = vec![0];
    let (mut view_z, mut alpha) = (Vec::new(), Vec::new());
    for &(_, p) in pixels {
        let pixel = list.pixel(p as usize);
        view_z.extend_from_slice(pixel.view_z);
        alpha.extend_from_slice(pixel.alpha);
        offsets.push(view_z.len() as u64);
    }
    FragmentList::new(offsets, view_z, alpha, None).expect("made of valid pixels")
}

/// Rows and their manifest; `pixels` counts those of either part.
fn dataset(
    name: &str,
    seed: u64,
    config: &DatasetConfig,
    synth: Option<SynthConfig>,
    lists: Vec<ListSource>,
    [training, validation]: [Rows; 2],
    pixels: [usize; 2],
) -> Dataset {
    let training_part = Part::of("training", &training, pixels[0]);
    let validation_part = Part::of("validation", &validation, pixels[1]);
    let manifest = Manifest {
        format: "nmt-dataset".to_owned(),
        version: MANIFEST_VERSION,
        name: name.to_owned(),
        seed,
        features: config.features,
        columns: config.features.columns().iter().map(|&c| c.to_owned()).collect(),
        target: config.features.target().name().to_owned(),
        synth,
        lists,
        dataset: config.clone(),
        hash: Manifest::hash_of(&training_part, &validation_part),
        training: training_part,
        validation: validation_part,
    };
    Dataset {
        training,
        validation,
        manifest,
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::pixel::abuffer;

    pub(crate) fn sizes() -> DatasetConfig {
        DatasetConfig::of(FeatureSet::Paper, 1, 1)
    }

    fn with_pixels(dataset: Dataset) -> (Dataset, [FragmentList; 2]) {
        let pixels = pixels_of(&dataset.manifest).unwrap().unwrap();
        (dataset, pixels)
    }

    pub(crate) fn small() -> (Dataset, [FragmentList; 2]) {
        let config = DatasetConfig {
            features: FeatureSet::Paper,
            training_pairs: 3000,
            validation_pairs: 500,
            ..sizes()
        };
        with_pixels(build("small", 3, &SynthConfig::paper(), &config, &|_| {}).unwrap())
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
        let starts: std::collections::HashSet<u32> = (0..training.pixels())
            .map(|p| training.pixel(p).view_z[0].to_bits())
            .collect();
        assert!((0..validation.pixels()).all(|p| !starts.contains(&validation.pixel(p).view_z[0].to_bits())));
    }

    /// Rows of given lists with a core: features are those of the fragments that need the network, and targets the
    /// transmittance of the tail, T over that of the core in front, within 0.02 for 98 % of them: the rest share a step
    /// of depth with a fragment of the core. Control: T itself is none.
    #[test]
    fn behind_a_core_the_tail_is_the_target() {
        let list = Synth::new(SynthConfig::wide(), 3)
            .unwrap()
            .pixels(Purpose::Training, 0, 1500);
        let extractor = Extractor::for_list(
            FeatureSet::Core(crate::features::core::Shape::new(4, 4)),
            &list,
            None,
            None,
        )
        .unwrap();
        let made = rows(&list, &extractor).unwrap();
        assert!(made.len() > 1000 && made.weights.is_empty());
        let width = FeatureSet::Core(crate::features::core::Shape::new(4, 4)).width();
        let (mut compared, mut far, mut controls) = (0, 0, 0);
        // In thin pixels fragments share steps of depth, and rows are not told apart.
        let is_thick = |p: &usize| {
            let view_z = list.pixel(*p).view_z;
            let (near, far) = view_z
                .iter()
                .fold((f32::INFINITY, 0.0f32), |(a, b), &v| (a.min(v), b.max(v)));
            far > 1.5 * near
        };
        for p in (0..list.pixels()).filter(is_thick) {
            let Extracted { known, features } = extractor.list(&list, p..p + 1).unwrap();
            let mut exact = vec![0.0; known.len()];
            abuffer::transmittance(list.pixel(p), &mut exact);
            let fronts = known.iter().zip(&exact).filter_map(|(known, &t)| match known {
                Known::Front(front) => Some((f64::from(*front), t)),
                Known::Transmittance(_) => None,
            });
            let all: Vec<_> = features.chunks_exact(width).zip(fronts).collect();
            for i in (0..made.len()).filter(|&i| made.pixels[i] == p as u32) {
                let row = &made.features[i * width..][..width];
                let of_row = all.iter().find(|(features, _)| *features == row);
                let (_, (front, t)) = of_row.expect("a row of the pixel's fragments");
                if *front > 0.01 {
                    let target = f64::from(made.targets[i]);
                    far += usize::from((target - t / front).abs() > 0.02);
                    controls += usize::from((target - t).abs() > 0.02);
                    compared += 1;
                }
            }
        }
        // Fragments that share a step of depth with one of the core are few.
        let counts = [compared, far, controls];
        assert!(
            compared > 300 && far * 50 < compared && controls * 4 > compared,
            "{counts:?}"
        );
    }

    /// Of several chunks, and of a number that a pixel reaches exactly.
    #[test]
    fn pixels_that_hold_a_number_are_the_first_ones() {
        let synth = Synth::new(SynthConfig::paper(), 3).unwrap();
        let all = synth.pixels(Purpose::Training, 0, 12_000);
        for pairs in [
            1,
            all.offsets()[100],
            all.offsets()[100] + 1,
            all.offsets()[4096],
            all.offsets()[4096] + 1,
            150_000,
        ] {
            let list = pixels_holding(&synth, Purpose::Training, pairs, &|n| assert!(n <= pairs));
            assert_eq!(list, synth.pixels(Purpose::Training, 0, list.pixels()));
            assert!(list.len() as u64 >= pairs && list.offsets()[list.pixels() - 1] < pairs);
        }
    }

    #[test]
    fn targets_are_the_a_buffer() {
        let (dataset, [training, _]) = small();
        let mut exact = vec![0.0; training.pixel(5).len()];
        abuffer::transmittance(training.pixel(5), &mut exact);
        let stored = &dataset.training.targets[training.range(5)];
        assert!(exact.iter().zip(stored).all(|(e, &s)| *e as f32 == s));
    }

    fn deep() -> DatasetConfig {
        DatasetConfig {
            features: FeatureSet::DeepWeightedBlended,
            training_pairs: 1500,
            validation_pairs: 500,
            ..sizes()
        }
    }

    #[test]
    fn the_target_depends_on_the_feature_set() {
        let (dataset, [training, _]) = with_pixels(build("deep", 3, &SynthConfig::paper(), &deep(), &|_| {}).unwrap());
        let exact = abuffer::list_front_to_back_factor(&training);
        assert!(
            exact
                .iter()
                .zip(&dataset.training.targets)
                .all(|(&e, &t)| e as f32 == t)
        );
        assert_eq!(dataset.manifest.target, "front-to-back-factor");
        assert_eq!(small().0.manifest.target, "transmittance");
    }

    /// Pixels of two lists of different depth: none in both parts, each with the depth range and the answers of its own
    /// list.
    #[test]
    fn given_lists_are_split_by_pixel() {
        let (_, [near, _]) = small();
        let far: Vec<f32> = near.view_z().iter().map(|v| v + 1000.0).collect();
        let far = FragmentList::new(near.offsets().to_vec(), far, near.alpha().to_vec(), None).unwrap();
        let lists = [("near", &near), ("far", &far)];
        let dataset = build_from_lists("two", 7, &lists, &deep()).unwrap();
        assert!(dataset.training.len() >= 1500 && dataset.validation.len() >= 500);
        assert_eq!(
            dataset
                .manifest
                .lists
                .iter()
                .map(|l| (l.name.as_str(), l.fragments))
                .collect::<Vec<_>>(),
            [("near", near.len() as u64), ("far", far.len() as u64)]
        );
        let mut known = std::collections::HashMap::new();
        for (index, (_, list)) in lists.into_iter().enumerate() {
            let rows = rows(
                list,
                &Extractor::for_list(FeatureSet::DeepWeightedBlended, list, None, None).unwrap(),
            )
            .unwrap();
            for p in 0..list.pixels() {
                let features: Vec<u32> = rows.features[3 * list.range(p).start..3 * list.range(p).end]
                    .iter()
                    .map(|f| f.to_bits())
                    .collect();
                assert!(
                    known
                        .insert(features, (index, rows.targets[list.range(p)].to_vec()))
                        .is_none()
                );
            }
        }
        let mut seen = [false; 2];
        for rows in [&dataset.training, &dataset.validation] {
            let mut start = 0;
            for same in rows.pixels.chunk_by(|a, b| a == b) {
                let range = start..start + same.len();
                start = range.end;
                let features: Vec<u32> = rows.features[3 * range.start..3 * range.end]
                    .iter()
                    .map(|f| f.to_bits())
                    .collect();
                let (index, targets) = known.remove(&features).expect("a whole pixel of a list, used once");
                seen[index] = true;
                assert_eq!(rows.targets[range], targets);
            }
        }
        assert_eq!(seen, [true; 2]);
        assert_eq!(build_from_lists("two", 7, &lists, &deep()).unwrap(), dataset);
        assert_ne!(
            build_from_lists("two", 8, &lists, &deep()).unwrap().manifest.hash,
            dataset.manifest.hash
        );
    }

    #[test]
    fn lists_that_do_not_suffice() {
        let (_, [list, _]) = small();
        let config = DatasetConfig {
            training_pairs: list.len() as u64,
            ..deep()
        };
        let error = build_from_lists("x", 1, &[("a", &list)], &config).unwrap_err();
        assert!(
            matches!(error, DatasetError::TooFew { found, .. } if found == list.len() as u64),
            "{error}"
        );
        let without_planes = FragmentList::new(
            list.offsets().to_vec(),
            list.view_z().to_vec(),
            list.alpha().to_vec(),
            None,
        )
        .unwrap();
        let paper = DatasetConfig {
            features: FeatureSet::Paper,
            ..deep()
        };
        let error = build_from_lists("x", 1, &[("a", &without_planes)], &paper).unwrap_err();
        assert!(
            error
                .to_string()
                .starts_with("fragment list 'a': window depth needs the camera planes"),
            "{error}"
        );
    }

    #[test]
    fn sizes_are_validated() {
        let mut config = DatasetConfig {
            features: FeatureSet::Paper,
            training_pairs: 0,
            validation_pairs: 1,
            ..sizes()
        };
        let error = build("x", 1, &SynthConfig::paper(), &config, &|_| {}).unwrap_err();
        assert_eq!(
            error.to_string(),
            "dataset.training_pairs = 0: must be from 1 to 1073741824"
        );
        config.training_pairs = u64::MAX;
        assert!(config.validate().is_err());
    }
}
