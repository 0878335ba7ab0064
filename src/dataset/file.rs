//! A dataset on disk: `.npy` files that NumPy opens without our code, and a manifest.
//!
//! `training_features.npy` f32 `[N, W]`, `training_targets.npy` f32 `[N]`, `training_pixels.npy` u32 `[N]`,
//! `training_weights.npy` f32 `[N]` where rows do not count alike, the same for `validation_`, and `manifest.json`,
//! which is written last: a folder with a manifest holds a whole dataset.

use super::build::DatasetConfig;
use super::{Dataset, Rows};
use crate::features::FeatureSet;
use crate::numeric::digest::sha256_hex;
use crate::numeric::file::{FileError, Replace, create_folder, may_write, read, write_atomically};
use crate::numeric::npy::{NpyError, encode, read_npy};
use crate::pixel::FragmentList;
use crate::synth::SynthConfig;
use ndarray::{ArrayView1, ArrayView2};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// The version of the manifest that this program writes and reads.
pub const MANIFEST_VERSION: u32 = 1;

const MANIFEST: &str = "manifest.json";

/// Where a dataset comes from and what its files must hold.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    /// Always "nmt-dataset".
    pub format: String,
    /// [`MANIFEST_VERSION`].
    pub version: u32,
    /// Name of the configuration.
    pub name: String,
    /// Seed of the random pixels.
    pub seed: u64,
    /// Feature set of the columns.
    pub features: FeatureSet,
    /// Names of the columns, in order.
    pub columns: Vec<String>,
    /// What the targets are.
    pub target: String,
    /// Distribution of the pixels where they are random.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub synth: Option<SynthConfig>,
    /// Fragment lists that the pixels were drawn from, where they are not.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub lists: Vec<ListSource>,
    /// Sizes asked for.
    pub dataset: DatasetConfig,
    /// SHA-256 over all arrays.
    pub hash: String,
    /// The training rows.
    pub training: Part,
    /// The validation rows.
    pub validation: Part,
}

/// A fragment list that pixels were drawn from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ListSource {
    /// What it was called.
    pub name: String,
    /// Number of pixels.
    pub pixels: u64,
    /// Number of fragments.
    pub fragments: u64,
    /// SHA-256 of offsets (as u64), view depths and opacities, little-endian.
    pub sha256: String,
}

impl ListSource {
    /// Describes a list.
    pub fn of(name: &str, list: &FragmentList) -> Self {
        let offsets: Vec<u8> = list.offsets().iter().flat_map(|o| o.to_le_bytes()).collect();
        let [view_z, alpha] =
            [list.view_z(), list.alpha()].map(|a| a.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>());
        let sha256 = sha256_hex([offsets.as_slice(), &view_z, &alpha]);
        Self {
            name: name.to_owned(),
            pixels: list.pixels() as u64,
            fragments: list.len() as u64,
            sha256,
        }
    }
}

/// One of a dataset's two parts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// Number of pixels.
    pub pixels: usize,
    /// Number of rows, N.
    pub pairs: usize,
    /// Its arrays: features, targets, pixels, and weights where rows do not count alike.
    pub files: Vec<ArrayFile>,
}

/// An array and its hash.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ArrayFile {
    /// Name of the file, beside the manifest.
    pub file: String,
    /// SHA-256 of the whole file.
    pub sha256: String,
}

/// Why a dataset could not be read.
#[derive(Debug, thiserror::Error)]
pub enum DatasetFileError {
    /// A file could not be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// An array is damaged or of the wrong type.
    #[error(transparent)]
    Array(#[from] NpyError),
    /// The manifest is not one, or is newer than this program.
    #[error("{}: {reason}", path.display())]
    Manifest {
        /// The file.
        path: PathBuf,
        /// What is wrong and what to do.
        reason: String,
    },
    /// An array does not hold what the manifest says.
    #[error("{}: {reason}; generate the dataset again", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
}

impl Part {
    /// Describes rows as [`write()`] writes them.
    pub fn of(part: &str, rows: &Rows, pixels: usize) -> Self {
        let files = encoded(part, rows)
            .into_iter()
            .map(|(file, bytes)| ArrayFile {
                file,
                sha256: sha256_hex([bytes.as_slice()]),
            })
            .collect();
        Self {
            pixels,
            pairs: rows.len(),
            files,
        }
    }
}

impl Manifest {
    /// Hash of a dataset, from the hashes of its arrays.
    pub fn hash_of(training: &Part, validation: &Part) -> String {
        sha256_hex(
            training
                .files
                .iter()
                .chain(&validation.files)
                .map(|f| f.sha256.as_bytes()),
        )
    }
}

fn encoded(part: &str, rows: &Rows) -> Vec<(String, Vec<u8>)> {
    let features =
        ArrayView2::from_shape((rows.len(), rows.feature_set.width()), &rows.features).expect("W features a row");
    let mut files = vec![
        (format!("{part}_features.npy"), encode(features)),
        (format!("{part}_targets.npy"), encode(ArrayView1::from(&rows.targets))),
        (format!("{part}_pixels.npy"), encode(ArrayView1::from(&rows.pixels))),
    ];
    if !rows.weights.is_empty() {
        files.push((format!("{part}_weights.npy"), encode(ArrayView1::from(&rows.weights))));
    }
    files
}

/// Refuses early when `folder` already holds a dataset that may not be replaced.
///
/// # Errors
/// [`FileError::Exists`].
pub fn may_write_to(folder: &Path, replace: Replace) -> Result<(), FileError> {
    may_write(&folder.join(MANIFEST), replace)
}

/// Writes a dataset into a folder, the manifest last.
///
/// # Errors
/// [`FileError`]; no file is left half-written.
pub fn write(folder: &Path, replace: Replace, dataset: &Dataset) -> Result<(), FileError> {
    may_write_to(folder, replace)?;
    create_folder(folder)?;
    if replace == Replace::Yes && folder.join(MANIFEST).exists() {
        // Without its manifest the old dataset is not taken for a whole one while its arrays are being replaced.
        std::fs::remove_file(folder.join(MANIFEST))
            .map_err(FileError::io(folder, "cannot replace the old manifest"))?;
    }
    for (part, rows) in [("training", &dataset.training), ("validation", &dataset.validation)] {
        for (file, bytes) in encoded(part, rows) {
            write_atomically(&folder.join(file), replace, |w| w.write_all(&bytes))?;
        }
    }
    let manifest = serde_json::to_vec_pretty(&dataset.manifest).expect("a manifest is plain data");
    write_atomically(&folder.join(MANIFEST), replace, |w| {
        w.write_all(&manifest)?;
        w.write_all(b"\n")
    })
}

/// What is wrong with a folder's manifest.
fn wrong_manifest(folder: &Path, reason: String) -> DatasetFileError {
    DatasetFileError::Manifest {
        path: folder.join(MANIFEST),
        reason,
    }
}

/// Reads what a dataset says of itself, without its arrays.
///
/// # Errors
/// [`DatasetFileError`] names the file and what is wrong with it.
pub fn manifest_of(folder: &Path) -> Result<Manifest, DatasetFileError> {
    let text = read(&folder.join(MANIFEST))?;
    let wrong = |reason| wrong_manifest(folder, reason);
    #[derive(Deserialize)]
    struct Head {
        format: String,
        version: u32,
    }
    let head: Head = serde_json::from_slice(&text).map_err(|e| wrong(format!("not a dataset manifest ({e})")))?;
    if head.format != "nmt-dataset" {
        return Err(wrong(format!("format '{}' is not 'nmt-dataset'", head.format)));
    }
    if head.version != MANIFEST_VERSION {
        return Err(wrong(format!(
            "version {} is not {MANIFEST_VERSION}; use the nmt that wrote it, or generate it again",
            head.version
        )));
    }
    serde_json::from_slice(&text).map_err(|e| wrong(e.to_string()))
}

/// Reads a dataset and checks every array against the manifest's hash.
///
/// # Errors
/// [`DatasetFileError`] names the file and what is wrong with it.
pub fn read_from(folder: &Path) -> Result<Dataset, DatasetFileError> {
    let manifest = manifest_of(folder)?;
    let training = read_part(folder, &manifest.training, manifest.features)?;
    let validation = read_part(folder, &manifest.validation, manifest.features)?;
    if manifest.hash != Manifest::hash_of(&manifest.training, &manifest.validation) {
        let reason = "the hash of the whole does not follow from those of its files; generate the dataset again";
        return Err(wrong_manifest(folder, reason.to_owned()));
    }
    Ok(Dataset {
        training,
        validation,
        manifest,
    })
}

fn read_part(folder: &Path, part: &Part, feature_set: FeatureSet) -> Result<Rows, DatasetFileError> {
    if !(3..=4).contains(&part.files.len()) {
        let reason = format!(
            "{} arrays of a part; features, targets, pixels and at most weights are expected",
            part.files.len()
        );
        return Err(DatasetFileError::Manifest {
            path: folder.join(MANIFEST),
            reason,
        });
    }
    let paths: Vec<PathBuf> = part
        .files
        .iter()
        .map(|f| folder.join(Path::new(&f.file).file_name().unwrap_or_default()))
        .collect();
    for (path, file) in paths.iter().zip(&part.files) {
        if sha256_hex([read(path)?.as_slice()]) != file.sha256 {
            return Err(DatasetFileError::Content {
                path: path.clone(),
                reason: "the file is not the one that the manifest describes (hash differs)".to_owned(),
            });
        }
    }
    let features = read_npy::<f32>(&paths[0])?;
    let targets = read_npy::<f32>(&paths[1])?;
    let pixels = read_npy::<u32>(&paths[2])?;
    let weights = paths.get(3).map(|path| read_npy::<f32>(path)).transpose()?;
    if let (Some(weights), Some(path)) = (&weights, paths.get(3))
        && (weights.shape() != [part.pairs] || !weights.iter().all(|w| w.is_finite() && *w >= 0.0))
    {
        let reason = format!("expected {} finite weights, none negative", part.pairs);
        return Err(DatasetFileError::Content {
            path: path.clone(),
            reason,
        });
    }
    let shapes = [
        (&paths[0], features.shape(), vec![part.pairs, feature_set.width()]),
        (&paths[1], targets.shape(), vec![part.pairs]),
        (&paths[2], pixels.shape(), vec![part.pairs]),
    ];
    for (path, found, expected) in shapes {
        if found != expected {
            return Err(DatasetFileError::Content {
                path: path.clone(),
                reason: format!("shape {found:?}, expected {expected:?}"),
            });
        }
    }
    for (path, values) in [(&paths[0], &features), (&paths[1], &targets)] {
        if let Some(i) = values.iter().position(|v| !v.is_finite()) {
            return Err(DatasetFileError::Content {
                path: path.clone(),
                reason: format!("entry {i} is not finite"),
            });
        }
    }
    Ok(Rows {
        feature_set,
        features: features.iter().copied().collect(),
        targets: targets.iter().copied().collect(),
        weights: weights.iter().flatten().copied().collect(),
        pixels: pixels.iter().copied().collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::build::tests::small;

    #[test]
    fn round_trip_and_repeatable_bytes() {
        let (dataset, _) = small();
        let folder = tempfile::tempdir().unwrap();
        write(folder.path(), Replace::No, &dataset).unwrap();
        assert_eq!(read_from(folder.path()).unwrap(), dataset);
        assert_eq!(small().0.manifest.hash, dataset.manifest.hash);
        assert!(matches!(
            write(folder.path(), Replace::No, &dataset),
            Err(FileError::Exists { .. })
        ));
        write(folder.path(), Replace::Yes, &dataset).unwrap();
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 7);
    }

    /// The hash of a small dataset as it is on every machine and number of threads.
    #[test]
    fn hash_is_pinned() {
        insta::assert_snapshot!(small().0.manifest.hash);
    }

    #[test]
    fn one_flipped_bit_is_noticed() {
        let (dataset, _) = small();
        let folder = tempfile::tempdir().unwrap();
        write(folder.path(), Replace::No, &dataset).unwrap();
        let path = folder.path().join("training_targets.npy");
        let mut bytes = std::fs::read(&path).unwrap();
        let last = bytes.len() - 1;
        bytes[last] ^= 1;
        std::fs::write(&path, bytes).unwrap();
        assert!(
            read_from(folder.path())
                .unwrap_err()
                .to_string()
                .contains("hash differs")
        );
    }

    #[test]
    fn foreign_and_newer_manifests() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(MANIFEST);
        let message = |text: &str| {
            std::fs::write(&path, text).unwrap();
            read_from(folder.path()).unwrap_err().to_string()
        };
        assert!(message("{").contains("not a dataset manifest"));
        assert!(message(r#"{"format": "x", "version": 1}"#).contains("format 'x'"));
        assert!(message(r#"{"format": "nmt-dataset", "version": 2}"#).contains("version 2 is not 1"));
        std::fs::remove_file(&path).unwrap();
        assert!(read_from(folder.path()).is_err());
    }
}
