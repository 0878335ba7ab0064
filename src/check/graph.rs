//! ONNX graphs executed as they stand in the file: nodes in their order, by the names of their inputs, in f32.
//!
//! It is an interpreter of the operators that exported networks use, not a runtime: an operator or an attribute that it
//! does not know is an error, never a guess.

use crate::export::onnx::{GraphProto, INPUT, NodeProto, OUTPUT, TensorProto, decode};
use std::collections::HashMap;

/// Rows by columns; vectors are one row.
#[derive(Debug, Clone, PartialEq)]
struct Matrix {
    rows: usize,
    columns: usize,
    values: Vec<f32>,
}

impl Matrix {
    /// A constant of the file.
    fn of(tensor: &TensorProto) -> Result<Self, String> {
        let sizes: Vec<usize> = tensor.dims.iter().map(|&d| usize::try_from(d).unwrap_or(0)).collect();
        let (rows, columns) = match sizes[..] {
            [columns] => (1, columns),
            [rows, columns] => (rows, columns),
            _ => return Err(format!("tensor '{}' has shape {:?}", tensor.name, tensor.dims)),
        };
        let values: Vec<f32> = tensor
            .raw_data
            .as_chunks::<4>()
            .0
            .iter()
            .map(|b| f32::from_le_bytes(*b))
            .collect();
        if tensor.data_type != 1
            || rows.checked_mul(columns) != Some(values.len())
            || !tensor.raw_data.len().is_multiple_of(4)
        {
            return Err(format!(
                "tensor '{}' does not hold {rows} x {columns} numbers of f32",
                tensor.name
            ));
        }
        Ok(Self { rows, columns, values })
    }

    fn map(&self, f: impl Fn(f32) -> f32) -> Self {
        Self {
            values: self.values.iter().map(|&v| f(v)).collect(),
            ..*self
        }
    }

    /// Element by element; a side of one row or column serves for all.
    fn zip(&self, other: &Self, f: impl Fn(f32, f32) -> f32) -> Result<Self, String> {
        let common = |a: usize, b: usize| match (a, b) {
            (a, b) if a == b => Ok(a),
            (1, n) | (n, 1) => Ok(n),
            _ => Err(format!("sizes {a} and {b} do not go together")),
        };
        let (rows, columns) = (common(self.rows, other.rows)?, common(self.columns, other.columns)?);
        let at = |m: &Self, r: usize, c: usize| m.values[(r % m.rows) * m.columns + c % m.columns];
        let values = (0..rows * columns)
            .map(|i| f(at(self, i / columns, i % columns), at(other, i / columns, i % columns)))
            .collect();
        Ok(Self { rows, columns, values })
    }

    /// The matrix product.
    fn times(&self, other: &Self) -> Result<Self, String> {
        if self.columns != other.rows {
            return Err(format!(
                "a product of {} columns with {} rows",
                self.columns, other.rows
            ));
        }
        let mut values = vec![0.0f32; self.rows * other.columns];
        if other.columns > 0 {
            for (row, out) in self
                .values
                .chunks_exact(self.columns.max(1))
                .zip(values.chunks_exact_mut(other.columns))
            {
                for (&x, weights) in row.iter().zip(other.values.chunks_exact(other.columns)) {
                    out.iter_mut().zip(weights).for_each(|(sum, w)| *sum += x * w);
                }
            }
        }
        Ok(Self {
            rows: self.rows,
            columns: other.columns,
            values,
        })
    }
}

/// What a node gives.
fn apply(node: &NodeProto, inputs: &[&Matrix]) -> Result<Matrix, String> {
    match (node.op_type.as_str(), inputs) {
        ("Gemm", [x, weights, biases]) => x.times(weights)?.zip(biases, |a, b| a + b),
        ("MatMul", [x, y]) => x.times(y),
        ("Add", [x, y]) => x.zip(y, |a, b| a + b),
        ("Sub", [x, y]) => x.zip(y, |a, b| a - b),
        ("Mul", [x, y]) => x.zip(y, |a, b| a * b),
        ("Div", [x, y]) => x.zip(y, |a, b| a / b),
        ("Min", [x, y]) => x.zip(y, f32::min),
        ("Max", [x, y]) => x.zip(y, f32::max),
        ("Relu", [x]) => Ok(x.map(|v| v.max(0.0))),
        ("Sigmoid", [x]) => Ok(x.map(|v| 1.0 / (1.0 + (-v).exp()))),
        ("Exp", [x]) => Ok(x.map(f32::exp)),
        ("Neg", [x]) => Ok(x.map(|v| -v)),
        ("Reciprocal", [x]) => Ok(x.map(f32::recip)),
        (operator, inputs) => Err(format!("operator '{operator}' of {} inputs is not known", inputs.len())),
    }
}

fn execute(graph: &GraphProto, rows: Matrix) -> Result<Matrix, String> {
    let mut values: HashMap<&str, Matrix> = HashMap::new();
    for tensor in &graph.initializer {
        values.insert(&tensor.name, Matrix::of(tensor)?);
    }
    values.insert(INPUT, rows);
    for node in &graph.node {
        let found = |name: &String| {
            let value = values.get(name.as_str());
            value.ok_or_else(|| format!("node '{}': nothing is called '{name}' yet", node.name))
        };
        let inputs: Vec<&Matrix> = node.input.iter().map(found).collect::<Result<_, _>>()?;
        let output = apply(node, &inputs).map_err(|e| format!("node '{}': {e}", node.name))?;
        let [name] = &node.output[..] else {
            return Err(format!("node '{}' has {} outputs", node.name, node.output.len()));
        };
        values.insert(name, output);
    }
    values
        .remove(OUTPUT)
        .ok_or_else(|| format!("there is no output '{OUTPUT}'"))
}

/// Runs the graph of an ONNX file.
///
/// # Shapes
/// `rows: [N, width]`, row by row; the result is `[N]`.
///
/// # Errors
/// In words, what of the file it does not understand.
pub fn run(bytes: &[u8], rows: &[f32], width: usize) -> Result<Vec<f32>, String> {
    let model = decode(bytes).map_err(|e| format!("not an ONNX file: {e}"))?;
    let graph = model.graph.ok_or("not an ONNX file: it holds no graph")?;
    let mut answers = Vec::with_capacity(rows.len() / width.max(1));
    // Blocks that stay in the cache.
    for block in rows.chunks(width * 4096) {
        let rows = Matrix {
            rows: block.len() / width,
            columns: width,
            values: block.to_vec(),
        };
        let count = rows.rows;
        let output = execute(&graph, rows)?;
        if (output.rows, output.columns) != (count, 1) {
            return Err(format!(
                "output has shape [{}, {}], expected [{count}, 1]",
                output.rows, output.columns
            ));
        }
        answers.extend(output.values);
    }
    Ok(answers)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::onnx::encode;
    use crate::export::protobuf::Message;
    use crate::model::mlp::tests::random_mlp;
    use crate::model::shipped;

    /// The reference to 5e-6, for both kinds of answers. Controls: a weight of another sign, and an operator in the
    /// place of another.
    #[test]
    fn graphs_compute_the_reference() {
        for mlp in [random_mlp(&[32, 16], 2), shipped::named("recommended").unwrap()] {
            let width = mlp.feature_set().width();
            let rows: Vec<f32> = (0..width * 300).map(|i| (i % 23) as f32 / 10.0 - 1.0).collect();
            let reference = mlp.forward_batch::<f64>(&rows);
            let worst = |bytes: &[u8]| {
                let out = run(bytes, &rows, width).unwrap();
                assert_eq!(out.len(), reference.len());
                let off = out.iter().zip(&reference).map(|(&o, r)| (f64::from(o) - r).abs());
                off.fold(0.0, |m: f64, e| if e.is_nan() { f64::INFINITY } else { m.max(e) })
            };
            let bytes = encode(&mlp);
            assert!(worst(&bytes) < 5e-6, "{}", worst(&bytes));
            let mut changed = decode(&bytes).unwrap();
            changed.graph.as_mut().unwrap().initializer[0].raw_data[3] ^= 0x80;
            assert!(worst(&changed.encode_to_vec()) > 1e-4);
            let mut changed = decode(&bytes).unwrap();
            changed.graph.as_mut().unwrap().node[1].op_type = "Neg".to_owned();
            assert!(worst(&changed.encode_to_vec()) > 1e-4);
        }
    }

    #[test]
    fn what_is_not_understood_is_said() {
        let bytes = encode(&random_mlp(&[4], 1));
        let rows = [0.5; 14];
        let with = |change: &dyn Fn(&mut GraphProto)| {
            let mut model = decode(&bytes).unwrap();
            change(model.graph.as_mut().unwrap());
            run(&model.encode_to_vec(), &rows, 7).unwrap_err()
        };
        assert!(with(&|g| g.node[1].op_type = "Tanh".to_owned()).contains("operator 'Tanh'"));
        assert!(with(&|g| g.node[0].input[1] = "V1".to_owned()).contains("nothing is called 'V1'"));
        assert!(with(&|g| g.initializer[0].dims = vec![7, 5]).contains("does not hold 7 x 5"));
        assert!(with(&|g| g.node.truncate(2)).contains("no output"));
        assert!(run(b"not onnx", &rows, 7).is_err() && run(&[], &rows, 7).is_err());
    }
}
