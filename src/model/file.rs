//! The model file: one JSON, which is also the JSON export. f32 values survive the round trip bit for bit.

use super::{Dense, Mlp, Provenance, ShapeError};
use crate::features::{FeatureSet, MomentDepthKind, OutputMeaning};
use crate::numeric::file::{FileError, Replace, read, without_mark, write_atomically};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// The version of the model file that this program writes and reads.
pub const MODEL_VERSION: u32 = 1;

const FORMAT: &str = "nmt-model";

/// Why a model could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ModelError {
    /// The file could not be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// It is neither a file nor the name of a network that comes with the program.
    #[error("there is no network '{name}': give the path of a model file, or one of {known}{suggestion}")]
    Unknown {
        /// What was given.
        name: String,
        /// The names there are.
        known: String,
        /// The name that was probably meant.
        suggestion: String,
    },
    /// It is not a model file.
    #[error("{}: not a model file: {reason}", path.display())]
    NotAModel {
        /// The file.
        path: PathBuf,
        /// What the reader said, with line and column where it has them.
        reason: String,
    },
    /// Another version wrote it.
    #[error("{}: version {version} of the model file; this program reads version {MODEL_VERSION}: use a newer nmt, or \
        export the model again", path.display())]
    Version {
        /// The file.
        path: PathBuf,
        /// Its version.
        version: u64,
    },
    /// Shapes, weights or descriptions do not fit together.
    #[error("{}: {reason}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// What is wrong, and where.
        reason: String,
    },
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    format: String,
    version: u32,
    name: String,
    feature_set: FeatureSet,
    features: Vec<String>,
    moment_depth: MomentDepthKind,
    output: OutputMeaning,
    layer_sizes: Vec<usize>,
    hidden_activation: String,
    output_activation: String,
    layers: Vec<Layer>,
    provenance: Provenance,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Layer {
    /// `[inputs][outputs]`
    pub(super) weights: Vec<Vec<f32>>,
    pub(super) biases: Vec<f32>,
}

impl Layer {
    pub(super) fn of(dense: &Dense) -> Self {
        Self {
            weights: dense
                .weights
                .chunks_exact(dense.outputs())
                .map(<[f32]>::to_vec)
                .collect(),
            biases: dense.biases.clone(),
        }
    }
}

/// A layer from nested rows.
pub(super) fn dense(number: usize, weights: &[Vec<f32>], biases: Vec<f32>) -> Result<Dense, String> {
    let outputs = biases.len();
    if let Some(row) = weights.iter().position(|row| row.len() != outputs) {
        return Err(format!(
            "layer {number}: weights[{row}] holds {} numbers, but there are {outputs} biases; weights are [in][out]",
            weights[row].len()
        ));
    }
    Dense::new(weights.len(), outputs, weights.concat(), biases)
        .map_err(|e| e.to_string().replacen("layer 1", &format!("layer {number}"), 1))
}

/// The text of a model file.
pub fn to_json(mlp: &Mlp) -> String {
    let set = mlp.feature_set();
    let document = Document {
        format: FORMAT.to_owned(),
        version: MODEL_VERSION,
        name: mlp.name().to_owned(),
        feature_set: set,
        features: set.columns().iter().map(|&c| c.to_owned()).collect(),
        moment_depth: set.moment_depth(),
        output: set.output(),
        layer_sizes: mlp.sizes(),
        hidden_activation: "relu".to_owned(),
        output_activation: "sigmoid".to_owned(),
        layers: mlp.layers().iter().map(Layer::of).collect(),
        provenance: mlp.provenance.clone(),
    };
    serde_json::to_string_pretty(&document).expect("a finite network is plain data") + "\n"
}

/// Reads the text of a model file; `path` is what errors name.
///
/// # Errors
/// [`ModelError`].
pub fn from_json(text: &[u8], path: &Path) -> Result<Mlp, ModelError> {
    let not = |reason: String| ModelError::NotAModel {
        path: path.to_owned(),
        reason,
    };
    let wrong = |reason: String| ModelError::Content {
        path: path.to_owned(),
        reason,
    };
    let text = without_mark(text);
    let head: serde_json::Value = serde_json::from_slice(text).map_err(|e| not(e.to_string()))?;
    if head.get("format").and_then(|f| f.as_str()) == Some(super::colour::FORMAT) {
        return Err(not(
            "a network that answers with a pixel's colour; it goes by its method's name, such as dfa:MODEL.json"
                .to_owned(),
        ));
    }
    if head.get("format").and_then(|f| f.as_str()) != Some(FORMAT) {
        return Err(not(format!(
            "'format' is not '{FORMAT}'; weights of another program come in by 'nmt import'"
        )));
    }
    match head.get("version").and_then(serde_json::Value::as_u64) {
        Some(version) if version == u64::from(MODEL_VERSION) => {}
        Some(version) => {
            return Err(ModelError::Version {
                path: path.to_owned(),
                version,
            });
        }
        None => return Err(not("'version' is missing or not a whole number".to_owned())),
    }
    let document: Document = serde_json::from_slice(text).map_err(|e| not(e.to_string()))?;
    let set = document.feature_set;
    if document.features != set.columns() {
        return Err(wrong(format!(
            "features {:?} are not those of the set '{}', {:?}",
            document.features,
            set.name(),
            set.columns()
        )));
    }
    if document.moment_depth != set.moment_depth() || document.output != set.output() {
        return Err(wrong(format!(
            "moment_depth or output is not that of the feature set '{}'",
            set.name()
        )));
    }
    if document.hidden_activation != "relu" || document.output_activation != "sigmoid" {
        return Err(wrong(format!(
            "activations '{}' and '{}' are not supported; expected 'relu' and 'sigmoid'",
            document.hidden_activation, document.output_activation
        )));
    }
    let mut layers = Vec::new();
    for (index, layer) in document.layers.into_iter().enumerate() {
        layers.push(dense(index + 1, &layer.weights, layer.biases).map_err(wrong)?);
    }
    let mlp =
        Mlp::new(document.name, set, layers, document.provenance).map_err(|e: ShapeError| wrong(e.to_string()))?;
    if mlp.sizes() != document.layer_sizes {
        return Err(wrong(format!(
            "layer_sizes {:?} are not those of the weights, {:?}",
            document.layer_sizes,
            mlp.sizes()
        )));
    }
    Ok(mlp)
}

/// Reads a model file.
///
/// # Errors
/// [`ModelError`] names the file, the place and the remedy.
pub fn load(path: &Path) -> Result<Mlp, ModelError> {
    from_json(&read(path)?, path)
}

/// Writes a model file.
///
/// # Errors
/// [`FileError`]; nothing half-written is left.
pub fn save(path: &Path, replace: Replace, mlp: &Mlp) -> Result<(), FileError> {
    let text = to_json(mlp);
    write_atomically(path, replace, |w| w.write_all(text.as_bytes()))
}

/// Reads the weights of another program: a JSON object with `layers`, each `{"weights": [in][out], "biases": [out]}`
/// ("bias" is taken too), ReLU between them and a sigmoid at the end. Other keys are ignored, `source` is kept as
/// provenance.
///
/// # Errors
/// [`ModelError`].
pub fn import(path: &Path, name: &str, feature_set: FeatureSet) -> Result<Mlp, ModelError> {
    #[derive(Deserialize)]
    struct Foreign {
        #[serde(default)]
        source: String,
        layers: Vec<ForeignLayer>,
    }
    #[derive(Deserialize)]
    struct ForeignLayer {
        weights: Vec<Vec<f32>>,
        #[serde(alias = "bias")]
        biases: Vec<f32>,
    }
    let wrong = |reason: String| ModelError::Content {
        path: path.to_owned(),
        reason,
    };
    let foreign: Foreign = serde_json::from_slice(without_mark(&read(path)?)).map_err(|e| ModelError::NotAModel {
        path: path.to_owned(),
        reason: e.to_string(),
    })?;
    let mut layers = Vec::new();
    for (index, layer) in foreign.layers.into_iter().enumerate() {
        layers.push(dense(index + 1, &layer.weights, layer.biases).map_err(wrong)?);
    }
    let provenance = Provenance {
        source: format!("imported: {}", foreign.source),
        ..Provenance::default()
    };
    Mlp::new(name, feature_set, layers, provenance).map_err(|e| wrong(e.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::mlp::tests::random_mlp;
    use proptest::prelude::*;

    fn message(text: &str) -> String {
        from_json(text.as_bytes(), Path::new("m.json")).unwrap_err().to_string()
    }

    #[test]
    fn round_trip_on_disk() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("m.json");
        let mlp = random_mlp(&[32, 16], 5);
        save(&path, Replace::No, &mlp).unwrap();
        assert_eq!(load(&path).unwrap(), mlp);
        assert!(matches!(save(&path, Replace::No, &mlp), Err(FileError::Exists { .. })));
    }

    proptest! {
        /// Any finite bits, denormals and negative zero included.
        #[test]
        fn bits_survive(bits in prop::collection::vec(any::<u32>(), 7)) {
            let weights: Vec<f32> = {
                let finite = |w: f32| if w.is_finite() { w } else { 1e-45 };
                bits.into_iter().map(f32::from_bits).map(finite).collect()
            };
            let layer = Dense::new(7, 1, weights.clone(), vec![-0.0]).unwrap();
            let mlp = Mlp::new("bits", FeatureSet::Paper, vec![layer], Provenance::default()).unwrap();
            let back = from_json(to_json(&mlp).as_bytes(), Path::new("m.json")).unwrap();
            let to_bits = |v: &[f32]| v.iter().map(|w| w.to_bits()).collect::<Vec<_>>();
            prop_assert_eq!(to_bits(&back.layers()[0].weights), to_bits(&weights));
            prop_assert_eq!(back.layers()[0].biases[0].to_bits(), (-0.0f32).to_bits());
        }
    }

    #[test]
    fn errors_name_file_place_and_remedy() {
        let good = to_json(&random_mlp(&[2], 1));
        let value: serde_json::Value = serde_json::from_str(&good).unwrap();
        let changed = |change: &dyn Fn(&mut serde_json::Value)| {
            let mut value = value.clone();
            change(&mut value);
            message(&value.to_string())
        };
        let messages = [
            message("{"),
            message("[]"),
            message(&good[..good.len() / 2]),
            changed(&|v| v["format"] = "onnx".into()),
            changed(&|v| v["version"] = 2.into()),
            changed(&|v| v["version"] = "1".into()),
            changed(&|v| v["surprise"] = 1.into()),
            changed(&|v| v["feature_set"] = "nonsense".into()),
            changed(&|v| v["features"][0] = "b4".into()),
            changed(&|v| v["layers"][0]["weights"][3] = serde_json::json!([1.0])),
            changed(&|v| v["layers"][1]["biases"] = serde_json::json!([])),
            changed(&|v| v["layers"][0]["biases"][0] = 1e39.into()),
            changed(&|v| v["layers"][0]["biases"][0] = serde_json::Value::Null),
            changed(&|v| v["layers"] = serde_json::json!([])),
            changed(&|v| v["layer_sizes"][1] = 3.into()),
            changed(&|v| v["hidden_activation"] = "tanh".into()),
        ];
        insta::assert_snapshot!(messages.join("\n"));
    }
}
