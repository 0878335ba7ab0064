//! ONNX: the network as a graph of Gemm, Relu and Sigmoid.
//!
//! Input `features` f32 `[N, W]`, output `transmittance` f32 `[N, 1]`. The messages are the few of onnx.proto3 that
//! such a graph needs, declared by hand.

use super::protobuf::{DecodeError, Field, Message, Value, message};
use super::target::{Description, Reader, names, suffixes};
use crate::features::{Answer, MAX_LOG_ABSORBANCE};
use crate::model::Mlp;

/// Version of the operator set.
pub const OPSET: i64 = 13;
/// Version of the file format; 8 is the first that names opset 13 to 15.
const IR_VERSION: i64 = 8;
/// Key of the metadata that say which units were taken out.
pub const PRUNED: &str = "nmt.pruned";
/// Name of the graph's input.
pub const INPUT: &str = "features";
/// Name of the graph's output.
pub const OUTPUT: &str = "transmittance";

message! {
    /// `onnx.ModelProto`.
    ModelProto {
        /// File format.
        ir_version: i64 = 1,
        /// The program that wrote it.
        producer_name: String = 2,
        /// Its version.
        producer_version: String = 3,
        /// What it is, in words.
        doc_string: String = 6,
        /// The graph.
        graph: Option<GraphProto> = 7,
        /// Operator sets that it uses.
        opset_import: Vec<OperatorSetIdProto> = 8,
        /// Key and value pairs.
        metadata_props: Vec<StringStringEntryProto> = 14,
    }
}

message! {
    /// `onnx.OperatorSetIdProto`.
    OperatorSetIdProto {
        /// Empty for ONNX's own operators.
        domain: String = 1,
        /// Version of the set.
        version: i64 = 2,
    }
}

message! {
    /// `onnx.StringStringEntryProto`.
    StringStringEntryProto {
        /// Key.
        key: String = 1,
        /// Value.
        value: String = 2,
    }
}

message! {
    /// `onnx.GraphProto`.
    GraphProto {
        /// Operations, in order.
        node: Vec<NodeProto> = 1,
        /// Name.
        name: String = 2,
        /// Weights and biases.
        initializer: Vec<TensorProto> = 5,
        /// Inputs.
        input: Vec<ValueInfoProto> = 11,
        /// Outputs.
        output: Vec<ValueInfoProto> = 12,
    }
}

message! {
    /// `onnx.NodeProto`, without attributes: Gemm's defaults (alpha = beta = 1, nothing transposed) are what is needed.
    NodeProto {
        /// Names of its inputs.
        input: Vec<String> = 1,
        /// Names of its outputs.
        output: Vec<String> = 2,
        /// Name.
        name: String = 3,
        /// Operator.
        op_type: String = 4,
    }
}

message! {
    /// `onnx.TensorProto`.
    TensorProto {
        /// Shape. Not packed: strict readers of this proto2-style field insist.
        dims: Vec<i64> = 1,
        /// Element type; 1 is f32.
        data_type: i32 = 2,
        /// Name.
        name: String = 8,
        /// Values, little-endian.
        raw_data: Vec<u8> = 9,
    }
}

message! {
    /// `onnx.ValueInfoProto`.
    ValueInfoProto {
        /// Name.
        name: String = 1,
        /// Type.
        r#type: Option<TypeProto> = 2,
    }
}

message! {
    /// `onnx.TypeProto`, tensors only.
    TypeProto {
        /// Element type and shape.
        tensor_type: Option<TensorType> = 1,
    }
}

message! {
    /// `onnx.TypeProto.Tensor`.
    TensorType {
        /// 1 is f32.
        elem_type: i32 = 1,
        /// Shape.
        shape: Option<TensorShapeProto> = 2,
    }
}

message! {
    /// `onnx.TensorShapeProto`.
    TensorShapeProto {
        /// Dimensions.
        dim: Vec<Dimension> = 1,
    }
}

/// `onnx.TensorShapeProto.Dimension`: a number or a name.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Dimension {
    /// Which of the two.
    pub value: Option<DimensionValue>,
}

/// Value of a [`Dimension`].
#[derive(Debug, Clone, PartialEq)]
pub enum DimensionValue {
    /// Fixed size, field 1.
    Size(i64),
    /// Name of a free size, field 2.
    Name(String),
}

impl Message for Dimension {
    fn write(&self, out: &mut Vec<u8>) {
        // As members of a list, either is written whatever its value.
        match &self.value {
            Some(DimensionValue::Size(size)) => vec![*size].write(1, out),
            Some(DimensionValue::Name(name)) => vec![name.clone()].write(2, out),
            None => {}
        }
    }

    fn field(&mut self, number: u64, value: Value<'_>) -> Result<(), DecodeError> {
        match number {
            1 => {
                let mut size = 0;
                i64::read(&mut size, value)?;
                self.value = Some(DimensionValue::Size(size));
            }
            2 => {
                let mut name = String::new();
                Field::read(&mut name, value)?;
                self.value = Some(DimensionValue::Name(name));
            }
            _ => {}
        }
        Ok(())
    }
}

const FLOAT: i32 = 1;

fn matrix(name: &str, columns: i64) -> ValueInfoProto {
    let dim = [DimensionValue::Name("N".to_owned()), DimensionValue::Size(columns)]
        .map(|value| Dimension { value: Some(value) });
    let tensor_type = TensorType {
        elem_type: FLOAT,
        shape: Some(TensorShapeProto { dim: dim.to_vec() }),
    };
    ValueInfoProto {
        name: name.to_owned(),
        r#type: Some(TypeProto {
            tensor_type: Some(tensor_type),
        }),
    }
}

fn tensor(name: String, dims: Vec<i64>, values: &[f32]) -> TensorProto {
    TensorProto {
        dims,
        data_type: FLOAT,
        name,
        raw_data: values.iter().flat_map(|v| v.to_le_bytes()).collect(),
    }
}

/// Name of layer `index`'s weights and of its biases.
pub fn weights_name(index: usize) -> String {
    format!("W{}", index + 1)
}
/// See [`weights_name`].
pub fn biases_name(index: usize) -> String {
    format!("B{}", index + 1)
}

/// Constants of the part that makes a transmittance of a share of absorbance: name, shape, values.
pub fn answer_tensors(width: usize, column: usize, offset: f32) -> [(&'static str, Vec<i64>, Vec<f32>); 5] {
    let unit = (0..width).map(|i| if i == column { 1.0 } else { 0.0 }).collect();
    let one = |name, value| (name, vec![1], vec![value]);
    // e^80 is finite in f32.
    [
        ("column", vec![width as i64, 1], unit),
        one("offset", offset),
        one("most", MAX_LOG_ABSORBANCE),
        one("greatest", 80.0),
        one("one", 1.0),
    ]
}

fn node(op: &str, name: String, input: Vec<String>, output: &str) -> NodeProto {
    NodeProto {
        input,
        output: vec![output.to_owned()],
        name,
        op_type: op.to_owned(),
    }
}

/// The graph of a network.
pub fn model(mlp: &Mlp) -> ModelProto {
    let set = mlp.feature_set();
    let (mut nodes, mut initializer) = layers(mlp);
    if let Answer::AbsorbanceShare { column, offset } = set.answer() {
        let (more, tensors) = answer_of_a_share(set.width(), column, offset);
        nodes.extend(more);
        initializer.extend(tensors);
    }
    ModelProto {
        ir_version: IR_VERSION,
        producer_name: "nmt".to_owned(),
        producer_version: env!("CARGO_PKG_VERSION").to_owned(),
        doc_string: format!("Neural moment transparency: network '{}', {}", mlp.name(), mlp.shape()),
        graph: Some(GraphProto {
            node: nodes,
            name: mlp.name().to_owned(),
            initializer,
            input: vec![matrix(INPUT, set.width() as i64)],
            output: vec![matrix(OUTPUT, 1)],
        }),
        opset_import: vec![OperatorSetIdProto {
            domain: String::new(),
            version: OPSET,
        }],
        metadata_props: metadata(mlp),
    }
}

/// Nodes and tensors of the layers, up to the sigmoid or the logit's negative.
fn layers(mlp: &Mlp) -> (Vec<NodeProto>, Vec<TensorProto>) {
    let (mut nodes, mut tensors) = (Vec::new(), Vec::new());
    let mut from = INPUT.to_owned();
    let last = mlp.layers().len() - 1;
    for (index, dense) in mlp.layers().iter().enumerate() {
        let (weights, biases) = (weights_name(index), biases_name(index));
        let shape = vec![dense.inputs() as i64, dense.outputs() as i64];
        tensors.push(tensor(weights.clone(), shape, &dense.weights));
        tensors.push(tensor(biases.clone(), vec![dense.outputs() as i64], &dense.biases));
        let (number, sum) = (index + 1, format!("sum{}", index + 1));
        nodes.push(node("Gemm", format!("gemm{number}"), vec![from, weights, biases], &sum));
        let (op, to) = match (index == last, mlp.feature_set().answer()) {
            (false, _) => ("Relu", format!("h{number}")),
            (true, Answer::Sigmoid) => ("Sigmoid", OUTPUT.to_owned()),
            (true, Answer::AbsorbanceShare { .. }) => ("Neg", "minus_logit".to_owned()),
        };
        nodes.push(node(op, format!("{}{number}", op.to_lowercase()), vec![sum], &to));
        from = to;
    }
    (nodes, tensors)
}

/// Nodes and tensors that make a transmittance of a share's logit:
/// exp(−relu(exp(min(features\[:, column\], most)) − offset) · share).
///
/// The sigmoid is written out: runtimes approximate theirs by a clamped fraction, whose smallest value is too large
/// beside a great absorbance. The column is picked by a product with a column of the unit matrix.
fn answer_of_a_share(width: usize, column: usize, offset: f32) -> (Vec<NodeProto>, Vec<TensorProto>) {
    let steps = [
        ("Min", vec!["minus_logit", "greatest"], "bounded_logit"),
        ("Exp", vec!["bounded_logit"], "odds"),
        ("Add", vec!["odds", "one"], "inverse_share"),
        ("Reciprocal", vec!["inverse_share"], "share"),
        ("MatMul", vec![INPUT, "column"], "log_absorbance"),
        ("Min", vec!["log_absorbance", "most"], "bounded_absorbance"),
        ("Exp", vec!["bounded_absorbance"], "shifted_absorbance"),
        ("Sub", vec!["shifted_absorbance", "offset"], "signed_absorbance"),
        ("Relu", vec!["signed_absorbance"], "absorbance"),
        ("Mul", vec!["absorbance", "share"], "in_front"),
        ("Neg", vec!["in_front"], "exponent"),
        ("Exp", vec!["exponent"], OUTPUT),
    ];
    let owned = |inputs: Vec<&str>| inputs.into_iter().map(str::to_owned).collect();
    let nodes = steps.map(|(op, input, output)| node(op, output.to_owned(), owned(input), output));
    let tensors = answer_tensors(width, column, offset);
    let tensors = tensors.map(|(name, dims, values)| tensor(name.to_owned(), dims, &values));
    (nodes.into(), tensors.into())
}

/// What the file says of the network besides its graph.
fn metadata(mlp: &Mlp) -> Vec<StringStringEntryProto> {
    let (p, set) = (&mlp.provenance, mlp.feature_set());
    let entries = [
        ("nmt.name", Some(mlp.name().to_owned())),
        ("nmt.feature_set", Some(set.name().to_owned())),
        ("nmt.features", Some(set.columns().join(","))),
        ("nmt.description", Some(set.description().join(" "))),
        ("nmt.source", (!p.source.is_empty()).then(|| p.source.clone())),
        ("nmt.seed", p.seed.map(|s| s.to_string())),
        ("nmt.dataset_hash", p.dataset_hash.clone()),
        ("nmt.transmittance_mse", p.transmittance_mse.map(|e| e.to_string())),
        (PRUNED, p.pruned.as_ref().map(|pruned| pruned.to_text())),
    ];
    let known = entries
        .into_iter()
        .filter_map(|(key, value)| Some((key.to_owned(), value?)));
    known
        .map(|(key, value)| StringStringEntryProto { key, value })
        .collect()
}

/// ONNX as a target.
pub(super) const TARGET: Description = Description {
    title: "ONNX",
    names: names!("onnx"),
    suffixes: suffixes!("onnx"),
    language: None,
    text: false,
    plain: false,
    half: false,
    write: |mlp, _, _| Ok(encode(mlp)),
    reader: Reader::Onnx,
};

/// The bytes of the `.onnx` file of a network.
pub fn encode(mlp: &Mlp) -> Vec<u8> {
    model(mlp).encode_to_vec()
}

/// The messages of an `.onnx` file.
///
/// # Errors
/// Where the bytes are not such messages.
pub fn decode(bytes: &[u8]) -> Result<ModelProto, DecodeError> {
    ModelProto::decode(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::mlp::tests::random_mlp;

    #[test]
    fn graph_of_a_network() {
        let mlp = random_mlp(&[32, 16], 1);
        let model = decode(&encode(&mlp)).unwrap();
        let graph = model.graph.unwrap();
        let operators: Vec<&str> = graph.node.iter().map(|n| n.op_type.as_str()).collect();
        assert_eq!(operators, ["Gemm", "Relu", "Gemm", "Relu", "Gemm", "Sigmoid"]);
        assert_eq!(graph.initializer.len(), 6);
        assert_eq!(graph.initializer[0].dims, [7, 32]);
        assert!(
            model
                .metadata_props
                .iter()
                .any(|p| p.key == "nmt.features" && p.value == "d,n,b0,b1,b2,b3,b4")
        );
        assert_eq!(model.opset_import[0].version, OPSET);
    }
}
