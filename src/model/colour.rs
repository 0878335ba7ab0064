//! A network that answers with the colour of a pixel, and its file.

use super::file::{Layer, dense};
use super::mlp::check_name;
use super::{Dense, ModelError, Provenance};
use crate::features::colour::ColourSet;
use crate::numeric::file::{FileError, Replace, read, without_mark, write_atomically};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// What the file says of itself.
pub const FORMAT: &str = "nmt-colour-model";

/// Version of the file that this program writes and reads.
const VERSION: u32 = 1;

/// Fully connected layers with ReLU between them and three sigmoids at the end: linear red, green, blue.
#[derive(Debug, Clone, PartialEq)]
pub struct ColourNetwork {
    /// Its name.
    pub name: String,
    set: ColourSet,
    layers: Vec<Dense>,
    /// Where it comes from.
    pub provenance: Provenance,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    format: String,
    version: u32,
    name: String,
    feature_set: ColourSet,
    features: Vec<String>,
    layers: Vec<Layer>,
    provenance: Provenance,
}

impl ColourNetwork {
    /// A network from its layers.
    ///
    /// # Errors
    /// A sentence where the name cannot be a file's, or the layers do not chain from the columns of the set to three
    /// outputs.
    pub fn new(name: &str, set: ColourSet, layers: Vec<Dense>, provenance: Provenance) -> Result<Self, String> {
        check_name(name).map_err(|e| e.to_string())?;
        let mut width = set.columns().len();
        for (index, layer) in layers.iter().enumerate() {
            if layer.inputs() != width {
                return Err(format!(
                    "layer {} takes {} inputs, but {width} come in",
                    index + 1,
                    layer.inputs()
                ));
            }
            width = layer.outputs();
        }
        if layers.is_empty() || width != 3 {
            return Err(format!(
                "{} layers with {width} outputs; at least one layer and three outputs are needed: red, green, blue",
                layers.len()
            ));
        }
        Ok(Self {
            name: name.to_owned(),
            set,
            layers,
            provenance,
        })
    }

    /// What it must be fed, and what its colour stands for.
    pub fn set(&self) -> ColourSet {
        self.set
    }

    /// Its sizes as text: "10-32-16-3".
    pub fn shape(&self) -> String {
        let outputs = self.layers.iter().map(Dense::outputs);
        let sizes = std::iter::once(self.layers[0].inputs()).chain(outputs);
        sizes.map(|size| size.to_string()).collect::<Vec<_>>().join("-")
    }

    /// The colour that it answers one row with, in f64.
    ///
    /// # Panics
    /// If the row is not as wide as the set.
    pub fn forward(&self, row: &[f32]) -> [f64; 3] {
        assert_eq!(row.len(), self.layers[0].inputs(), "one feature an input");
        let mut x: Vec<f64> = row.iter().map(|&f| f.into()).collect();
        for (index, layer) in self.layers.iter().enumerate() {
            let mut y: Vec<f64> = layer.biases.iter().map(|&b| b.into()).collect();
            for (x, weights) in x.iter().zip(layer.weights.chunks_exact(layer.outputs())) {
                for (y, &w) in y.iter_mut().zip(weights) {
                    *y += f64::from(w) * x;
                }
            }
            if index + 1 < self.layers.len() {
                y.iter_mut().for_each(|y| *y = y.max(0.0));
            }
            x = y;
        }
        std::array::from_fn(|c| 1.0 / (1.0 + libm::exp(-x[c])))
    }

    /// The text of its file.
    pub fn to_json(&self) -> String {
        let document = Document {
            format: FORMAT.to_owned(),
            version: VERSION,
            name: self.name.clone(),
            feature_set: self.set,
            features: self.set.columns().iter().map(|&c| c.to_owned()).collect(),
            layers: self.layers.iter().map(Layer::of).collect(),
            provenance: self.provenance.clone(),
        };
        serde_json::to_string_pretty(&document).expect("a finite network is plain data") + "\n"
    }

    /// Reads the text of such a file; `path` is what errors name.
    ///
    /// # Errors
    /// [`ModelError::NotAModel`], [`ModelError::Content`].
    pub fn from_json(text: &[u8], path: &Path) -> Result<Self, ModelError> {
        let not = |reason: String| ModelError::NotAModel {
            path: path.to_owned(),
            reason,
        };
        let wrong = |reason: String| ModelError::Content {
            path: path.to_owned(),
            reason,
        };
        let document: Document = serde_json::from_slice(without_mark(text)).map_err(|e| not(e.to_string()))?;
        if (document.format.as_str(), document.version) != (FORMAT, VERSION) {
            return Err(not(format!(
                "format '{}', version {}; expected '{FORMAT}', version {VERSION}",
                document.format, document.version
            )));
        }
        if document.features != document.feature_set.columns() {
            return Err(wrong(format!(
                "features {:?} are not those of the set '{}'",
                document.features,
                document.feature_set.name()
            )));
        }
        let mut layers = Vec::new();
        for (index, layer) in document.layers.into_iter().enumerate() {
            layers.push(dense(index + 1, &layer.weights, layer.biases).map_err(wrong)?);
        }
        Self::new(&document.name, document.feature_set, layers, document.provenance).map_err(wrong)
    }

    /// Reads a file.
    ///
    /// # Errors
    /// [`ModelError`] names the file and what is wrong.
    pub fn load(path: &Path) -> Result<Self, ModelError> {
        Self::from_json(&read(path)?, path)
    }

    /// Writes its file.
    ///
    /// # Errors
    /// [`FileError`]; nothing half-written is left.
    pub fn save(&self, path: &Path, replace: Replace) -> Result<(), FileError> {
        let text = self.to_json();
        write_atomically(path, replace, |w| w.write_all(text.as_bytes()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file comes back as it was; one that is cut, of another kind, or of the wrong shape is refused in words.
    #[test]
    fn files_come_back_or_are_refused() {
        let layers = vec![
            Dense::new(5, 2, vec![0.1; 10], vec![-0.5, 0.25]).unwrap(),
            Dense::new(2, 3, vec![0.3; 6], vec![0.0, 1.0, -1e-30]).unwrap(),
        ];
        let network = ColourNetwork::new("n", ColourSet::StarNt, layers, Provenance::default()).unwrap();
        let text = network.to_json();
        let read = |text: &str| ColourNetwork::from_json(text.as_bytes(), Path::new("n.json"));
        assert_eq!(read(&text).unwrap(), network);
        assert_eq!(network.shape(), "5-2-3");
        let refused = |text: &str| read(text).unwrap_err().to_string();
        for (text, part) in [
            (text[..text.len() / 2].to_owned(), "not a model file"),
            (text.replace("star-nt", "dfa"), "are not those of the set 'dfa'"),
            (text.replace(FORMAT, "nmt-model"), "expected 'nmt-colour-model'"),
            (text.replace("\"biases\": [\n        0.0,", "\"biases\": ["), "biases"),
        ] {
            let message = refused(&text);
            assert!(message.contains(part), "{message}");
        }
        // The usual reader says whose it is.
        let message = super::super::file::from_json(text.as_bytes(), Path::new("n.json"))
            .unwrap_err()
            .to_string();
        assert!(message.contains("dfa:MODEL.json"), "{message}");
        let one = vec![Dense::new(5, 1, vec![0.1; 5], vec![0.0]).unwrap()];
        assert!(ColourNetwork::new("n", ColourSet::StarNt, one, Provenance::default()).is_err());
    }

    #[test]
    fn a_pass_by_hand() {
        let layers = vec![
            Dense::new(5, 1, vec![1.0, -1.0, 0.0, 0.0, 2.0], vec![0.5]).unwrap(),
            Dense::new(1, 3, vec![1.0, -1.0, 0.0], vec![0.0, 0.0, 3f32.ln()]).unwrap(),
        ];
        let network = ColourNetwork::new("n", ColourSet::StarNt, layers, Provenance::default()).unwrap();
        let sigmoid = |x: f64| 1.0 / (1.0 + (-x).exp());
        let found = network.forward(&[0.25, 0.5, 9.0, 9.0, 0.5]);
        let expected = [sigmoid(1.25), sigmoid(-1.25), 0.75];
        assert!(
            found.iter().zip(expected).all(|(f, e)| (f - e).abs() < 1e-7),
            "{found:?}"
        );
        assert_eq!(network.forward(&[0.0, 1.0, 0.0, 0.0, 0.0])[..2], [0.5, 0.5]);
    }
}
