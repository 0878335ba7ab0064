//! ONNX: the network as a graph of Gemm, Relu and Sigmoid.
//!
//! Input `features` f32 `[N, W]`, output `transmittance` f32 `[N, 1]`. The messages are the few of onnx.proto3 that
//! such a graph needs, declared by hand.

use crate::features::{Answer, MAX_LOG_ABSORBANCE};
use crate::model::Mlp;
use prost::Message;

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

/// `onnx.ModelProto`.
#[derive(Clone, PartialEq, Message)]
pub struct ModelProto {
    /// File format.
    #[prost(int64, tag = "1")]
    pub ir_version: i64,
    /// The program that wrote it.
    #[prost(string, tag = "2")]
    pub producer_name: String,
    /// Its version.
    #[prost(string, tag = "3")]
    pub producer_version: String,
    /// What it is, in words.
    #[prost(string, tag = "6")]
    pub doc_string: String,
    /// The graph.
    #[prost(message, optional, tag = "7")]
    pub graph: Option<GraphProto>,
    /// Operator sets that it uses.
    #[prost(message, repeated, tag = "8")]
    pub opset_import: Vec<OperatorSetIdProto>,
    /// Key and value pairs.
    #[prost(message, repeated, tag = "14")]
    pub metadata_props: Vec<StringStringEntryProto>,
}

/// `onnx.OperatorSetIdProto`.
#[derive(Clone, PartialEq, Message)]
pub struct OperatorSetIdProto {
    /// Empty for ONNX's own operators.
    #[prost(string, tag = "1")]
    pub domain: String,
    /// Version of the set.
    #[prost(int64, tag = "2")]
    pub version: i64,
}

/// `onnx.StringStringEntryProto`.
#[derive(Clone, PartialEq, Message)]
pub struct StringStringEntryProto {
    /// Key.
    #[prost(string, tag = "1")]
    pub key: String,
    /// Value.
    #[prost(string, tag = "2")]
    pub value: String,
}

/// `onnx.GraphProto`.
#[derive(Clone, PartialEq, Message)]
pub struct GraphProto {
    /// Operations, in order.
    #[prost(message, repeated, tag = "1")]
    pub node: Vec<NodeProto>,
    /// Name.
    #[prost(string, tag = "2")]
    pub name: String,
    /// Weights and biases.
    #[prost(message, repeated, tag = "5")]
    pub initializer: Vec<TensorProto>,
    /// Inputs.
    #[prost(message, repeated, tag = "11")]
    pub input: Vec<ValueInfoProto>,
    /// Outputs.
    #[prost(message, repeated, tag = "12")]
    pub output: Vec<ValueInfoProto>,
}

/// `onnx.NodeProto`, without attributes: Gemm's defaults (alpha = beta = 1, nothing transposed) are what is needed.
#[derive(Clone, PartialEq, Message)]
pub struct NodeProto {
    /// Names of its inputs.
    #[prost(string, repeated, tag = "1")]
    pub input: Vec<String>,
    /// Names of its outputs.
    #[prost(string, repeated, tag = "2")]
    pub output: Vec<String>,
    /// Name.
    #[prost(string, tag = "3")]
    pub name: String,
    /// Operator.
    #[prost(string, tag = "4")]
    pub op_type: String,
}

/// `onnx.TensorProto`.
#[derive(Clone, PartialEq, Message)]
pub struct TensorProto {
    /// Shape. Not packed: strict readers of this proto2-style field insist.
    #[prost(int64, repeated, packed = "false", tag = "1")]
    pub dims: Vec<i64>,
    /// Element type; 1 is f32.
    #[prost(int32, tag = "2")]
    pub data_type: i32,
    /// Name.
    #[prost(string, tag = "8")]
    pub name: String,
    /// Values, little-endian.
    #[prost(bytes = "vec", tag = "9")]
    pub raw_data: Vec<u8>,
}

/// `onnx.ValueInfoProto`.
#[derive(Clone, PartialEq, Message)]
pub struct ValueInfoProto {
    /// Name.
    #[prost(string, tag = "1")]
    pub name: String,
    /// Type.
    #[prost(message, optional, tag = "2")]
    pub r#type: Option<TypeProto>,
}

/// `onnx.TypeProto`, tensors only.
#[derive(Clone, PartialEq, Message)]
pub struct TypeProto {
    /// Element type and shape.
    #[prost(message, optional, tag = "1")]
    pub tensor_type: Option<TensorType>,
}

/// `onnx.TypeProto.Tensor`.
#[derive(Clone, PartialEq, Message)]
pub struct TensorType {
    /// 1 is f32.
    #[prost(int32, tag = "1")]
    pub elem_type: i32,
    /// Shape.
    #[prost(message, optional, tag = "2")]
    pub shape: Option<TensorShapeProto>,
}

/// `onnx.TensorShapeProto`.
#[derive(Clone, PartialEq, Message)]
pub struct TensorShapeProto {
    /// Dimensions.
    #[prost(message, repeated, tag = "1")]
    pub dim: Vec<Dimension>,
}

/// `onnx.TensorShapeProto.Dimension`: a number or a name.
#[derive(Clone, PartialEq, Message)]
pub struct Dimension {
    /// Which of the two.
    #[prost(oneof = "DimensionValue", tags = "1, 2")]
    pub value: Option<DimensionValue>,
}

/// Value of a [`Dimension`].
#[derive(Clone, PartialEq, prost::Oneof)]
pub enum DimensionValue {
    /// Fixed size.
    #[prost(int64, tag = "1")]
    Size(i64),
    /// Name of a free size.
    #[prost(string, tag = "2")]
    Name(String),
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

/// The graph of a network.
pub fn model(mlp: &Mlp) -> ModelProto {
    let mut node = Vec::new();
    let mut initializer = Vec::new();
    let mut from = INPUT.to_owned();
    let last = mlp.layers().len() - 1;
    for (index, dense) in mlp.layers().iter().enumerate() {
        let (weights, biases) = (weights_name(index), biases_name(index));
        initializer.push(tensor(
            weights.clone(),
            vec![dense.inputs() as i64, dense.outputs() as i64],
            &dense.weights,
        ));
        initializer.push(tensor(biases.clone(), vec![dense.outputs() as i64], &dense.biases));
        let sum = format!("sum{}", index + 1);
        node.push(NodeProto {
            input: vec![from, weights, biases],
            output: vec![sum.clone()],
            name: format!("gemm{}", index + 1),
            op_type: "Gemm".to_owned(),
        });
        let (op, to) = match (index == last, mlp.feature_set().answer()) {
            (false, _) => ("Relu", format!("h{}", index + 1)),
            (true, Answer::Sigmoid) => ("Sigmoid", OUTPUT.to_owned()),
            (true, Answer::AbsorbanceShare { .. }) => ("Neg", "minus_logit".to_owned()),
        };
        node.push(NodeProto {
            input: vec![sum],
            output: vec![to.clone()],
            name: format!("{}{}", op.to_lowercase(), index + 1),
            op_type: op.to_owned(),
        });
        from = to;
    }
    let set = mlp.feature_set();
    if let Answer::AbsorbanceShare { column, offset } = set.answer() {
        // The sigmoid is written out: runtimes approximate theirs by a clamped fraction, whose smallest value is too
        // large beside a great absorbance. exp(−relu(exp(min(features[:, column], most)) − offset) · share); the column
        // is picked by a product with a column of the unit matrix.
        for (name, dims, values) in answer_tensors(set.width(), column, offset) {
            initializer.push(tensor(name.to_owned(), dims, &values));
        }
        for (op, input, output) in [
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
        ] {
            node.push(NodeProto {
                input: input.into_iter().map(str::to_owned).collect(),
                output: vec![output.to_owned()],
                name: output.to_owned(),
                op_type: op.to_owned(),
            });
        }
    }
    let p = &mlp.provenance;
    let metadata = [
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
    ModelProto {
        ir_version: IR_VERSION,
        producer_name: "nmt".to_owned(),
        producer_version: env!("CARGO_PKG_VERSION").to_owned(),
        doc_string: format!("Neural moment transparency: network '{}', {}", mlp.name(), mlp.shape()),
        graph: Some(GraphProto {
            node,
            name: mlp.name().to_owned(),
            initializer,
            input: vec![matrix(INPUT, set.width() as i64)],
            output: vec![matrix(OUTPUT, 1)],
        }),
        opset_import: vec![OperatorSetIdProto {
            domain: String::new(),
            version: OPSET,
        }],
        metadata_props: metadata
            .into_iter()
            .filter_map(|(key, value)| {
                value.map(|value| StringStringEntryProto {
                    key: key.to_owned(),
                    value,
                })
            })
            .collect(),
    }
}

/// The bytes of the `.onnx` file of a network.
pub fn encode(mlp: &Mlp) -> Vec<u8> {
    model(mlp).encode_to_vec()
}

/// The messages of an `.onnx` file.
///
/// # Errors
/// Where the bytes are not such messages.
pub fn decode(bytes: &[u8]) -> Result<ModelProto, prost::DecodeError> {
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
