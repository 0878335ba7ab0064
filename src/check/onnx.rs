//! ONNX exports: weights read back bit for bit, the graph run by onnxruntime and, where the program has it, by rten.

use crate::export::onnx::{INPUT, OUTPUT, answer_tensors, biases_name, decode, weights_name};
use crate::features::Answer;
use crate::model::Mlp;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// Environment variable that names onnxruntime's shared library.
pub const LIBRARY_VARIABLE: &str = "ORT_DYLIB_PATH";

/// Reads every weight and bias back and compares its bits with the network's.
///
/// # Errors
/// Names the tensor and the place of the first difference.
pub fn weights(bytes: &[u8], mlp: &Mlp) -> Result<(), String> {
    let model = decode(bytes).map_err(|e| format!("not an ONNX file: {e}"))?;
    let graph = model.graph.ok_or("not an ONNX file: it holds no graph")?;
    let mut expected = Vec::new();
    for (index, dense) in mlp.layers().iter().enumerate() {
        expected.push((
            weights_name(index),
            vec![dense.inputs() as i64, dense.outputs() as i64],
            dense.weights.clone(),
        ));
        expected.push((biases_name(index), vec![dense.outputs() as i64], dense.biases.clone()));
    }
    if let Answer::AbsorbanceShare { column, offset } = mlp.feature_set().answer() {
        let tensors = answer_tensors(mlp.feature_set().width(), column, offset);
        expected.extend(tensors.map(|(name, dims, values)| (name.to_owned(), dims, values)));
    }
    if graph.initializer.len() != expected.len() {
        return Err(format!(
            "{} tensors, the network has {}",
            graph.initializer.len(),
            expected.len()
        ));
    }
    for (name, dims, values) in expected {
        let tensor = graph
            .initializer
            .iter()
            .find(|t| t.name == name)
            .ok_or_else(|| format!("there is no tensor '{name}'"))?;
        if tensor.dims != dims || tensor.raw_data.len() != 4 * values.len() {
            return Err(format!(
                "tensor '{name}' has shape {:?}, the network's is {dims:?}",
                tensor.dims
            ));
        }
        let found = tensor
            .raw_data
            .chunks_exact(4)
            .map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]));
        if let Some((at, (found, value))) = found
            .zip(&values)
            .enumerate()
            .find(|(_, (f, v))| f.to_bits() != v.to_bits())
        {
            return Err(format!(
                "tensor '{name}': number {at} is {found:?}, the network has {value:?}"
            ));
        }
    }
    let columns = mlp.feature_set().columns().join(",");
    if !model
        .metadata_props
        .iter()
        .any(|p| p.key == "nmt.features" && p.value == columns)
    {
        return Err(format!("its metadata do not name the features {columns}"));
    }
    Ok(())
}

/// Where onnxruntime's library is said to be.
///
/// # Errors
/// In words, what to do about it.
pub fn library() -> Result<PathBuf, String> {
    match std::env::var_os(LIBRARY_VARIABLE) {
        Some(path) if !path.is_empty() => match PathBuf::from(path) {
            path if path.is_file() => Ok(path),
            path => Err(format!(
                "{LIBRARY_VARIABLE} names {}, which is not a file",
                path.display()
            )),
        },
        _ => Err(format!(
            "not found: set {LIBRARY_VARIABLE} to libonnxruntime.so, for example the one inside PyPI's onnxruntime \
                wheel"
        )),
    }
}

/// A graph that onnxruntime holds ready to run.
pub struct Session {
    session: ort::session::Session,
}

impl Session {
    /// Loads a graph, to be run on so many threads, or on as many as onnxruntime thinks best.
    ///
    /// # Errors
    /// onnxruntime's own words.
    pub fn new(library: &Path, bytes: &[u8], threads: Option<usize>) -> Result<Self, String> {
        // A process may have one environment only.
        static ENVIRONMENT: OnceLock<Result<ort::environment::Environment, String>> = OnceLock::new();
        let made = || {
            ort::init_from(library)
                .map_err(|e| e.to_string())?
                .with_telemetry(false)
                .build()
                .map_err(|e| e.to_string())
        };
        let environment = ENVIRONMENT.get_or_init(made).as_ref().map_err(Clone::clone)?;
        let mut builder = ort::session::Session::builder(environment).map_err(|e| e.to_string())?;
        if let Some(threads) = threads {
            builder = builder.with_intra_threads(threads).map_err(|e| e.to_string())?;
        }
        Ok(Self {
            session: builder.commit_from_memory(bytes).map_err(|e| e.to_string())?,
        })
    }

    /// Runs the graph and hands its answers over.
    ///
    /// # Shapes
    /// `rows: [N, width]`, row by row; the answers are `[N]`.
    ///
    /// # Errors
    /// onnxruntime's own words.
    pub fn run<T>(&mut self, rows: &[f32], width: usize, read: impl FnOnce(&[f32]) -> T) -> Result<T, String> {
        let n = rows.len() / width;
        let input = ort::value::TensorRef::from_array_view(([n, width], rows)).map_err(|e| e.to_string())?;
        let outputs = self
            .session
            .run(ort::inputs![INPUT => input])
            .map_err(|e| e.to_string())?;
        let (shape, values) = outputs
            .get(OUTPUT)
            .ok_or("there is no output 'transmittance'")?
            .try_extract_tensor::<f32>()
            .map_err(|e| e.to_string())?;
        if shape[..] != [n as i64, 1] {
            return Err(format!("output has shape {shape:?}, expected [{n}, 1]"));
        }
        Ok(read(values))
    }
}

/// Runs the graph by onnxruntime.
///
/// # Shapes
/// `rows: [N, width]`, row by row; the result is `[N]`.
///
/// # Errors
/// onnxruntime's own words.
pub fn onnxruntime(library: &Path, bytes: &[u8], rows: &[f32], width: usize) -> Result<Vec<f32>, String> {
    Session::new(library, bytes, None)?.run(rows, width, <[f32]>::to_vec)
}

/// Runs the graph by rten, where the program was built with that feature.
///
/// # Shapes
/// As [`onnxruntime`].
///
/// # Errors
/// rten's own words.
#[cfg(feature = "rten")]
pub fn rten(bytes: &[u8], rows: &[f32], width: usize) -> Result<Vec<f32>, String> {
    let model = rten::Model::load(bytes.to_vec()).map_err(|e| e.to_string())?;
    let n = rows.len() / width;
    let input = rten::Value::from_shape([n, width], rows.to_vec()).map_err(|e| e.to_string())?;
    let (from, to) = (
        model.node_id(INPUT).map_err(|e| e.to_string())?,
        model.node_id(OUTPUT).map_err(|e| e.to_string())?,
    );
    let [output] = model
        .run_n(vec![(from, input.into())], [to], None)
        .map_err(|e| e.to_string())?;
    let ([rows, columns], values) = output.into_shape_vec::<f32, 2>().map_err(|e| e.to_string())?;
    if [rows, columns] != [n, 1] {
        return Err(format!("output has shape [{rows}, {columns}], expected [{n}, 1]"));
    }
    Ok(values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::onnx::encode;
    use crate::export::protobuf::Message;
    use crate::model::mlp::tests::random_mlp;

    #[test]
    fn changed_bits_shapes_and_foreign_bytes_are_found() {
        let mlp = random_mlp(&[6, 3], 1);
        let bytes = encode(&mlp);
        weights(&bytes, &mlp).unwrap();
        let mut model = decode(&bytes).unwrap();
        model.graph.as_mut().unwrap().initializer[2].raw_data[4] ^= 1;
        assert!(
            weights(&model.encode_to_vec(), &mlp)
                .unwrap_err()
                .contains("tensor 'W2': number 1")
        );
        let mut model = decode(&bytes).unwrap();
        model.graph.as_mut().unwrap().initializer[0].dims.reverse();
        assert!(
            weights(&model.encode_to_vec(), &mlp)
                .unwrap_err()
                .contains("has shape [6, 7]")
        );
        assert!(weights(&bytes[..bytes.len() / 2], &mlp).is_err());
        assert!(weights(b"not onnx", &mlp).is_err());
        assert!(weights(&[], &mlp).is_err());
    }

    #[test]
    #[cfg(feature = "rten")]
    fn rten_computes_the_reference() {
        let mlp = random_mlp(&[32, 16], 2);
        let rows: Vec<f32> = (0..700).map(|i| (i % 23) as f32 / 10.0 - 1.0).collect();
        let out = rten(&encode(&mlp), &rows, 7).unwrap();
        let reference = mlp.forward_batch::<f64>(&rows);
        assert_eq!(out.len(), reference.len());
        assert!(out.iter().zip(reference).all(|(&o, r)| (f64::from(o) - r).abs() < 5e-6));
        assert!(rten(b"not onnx", &rows, 7).is_err());
    }
}
