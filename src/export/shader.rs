//! Shader source: WGSL and GLSL, unrolled scalars or packed vectors, through one emitter.

use super::recentred;
use crate::features::{Answer, FeatureSet, MOST_LOG_ABSORBANCE, MomentDepthKind};
use crate::model::{Dense, Mlp};
use std::fmt::Write;

/// A shading language.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Language {
    /// WebGPU's.
    Wgsl,
    /// OpenGL's and Vulkan's: GLSL 4.50 and GLSL ES 3.00 read it.
    Glsl,
}

/// How weights are laid out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// One scalar a weight, `[in][out]` flat; sums in the order of the reference forward pass.
    Plain,
    /// Blocks of 4 × 4 weights as matrices; shorter, and faster on most devices.
    Packed,
}

/// The function that answers; it takes the array that `nmt_features` returns.
pub const ENTRY: &str = "nmt_transmittance";

impl Language {
    fn feature_source(self, set: FeatureSet) -> String {
        let text = match (self, set) {
            (Self::Wgsl, FeatureSet::Paper) => include_str!("../features/paper.wgsl"),
            (Self::Glsl, FeatureSet::Paper) => include_str!("../features/paper.glsl"),
            (Self::Wgsl, FeatureSet::DeepWeightedBlended) => include_str!("../features/deep_weighted_blended.wgsl"),
            (Self::Glsl, FeatureSet::DeepWeightedBlended) => include_str!("../features/deep_weighted_blended.glsl"),
            (_, set @ (FeatureSet::Recentred | FeatureSet::Recentred6 | FeatureSet::Recentred8)) => return recentred::source(self, set),
        };
        text.to_owned()
    }

    /// A literal that parses back to the same bits: the shortest decimal that names the f32.
    pub(super) fn literal(self, x: f32) -> String {
        match self {
            Self::Wgsl => format!("{x:?}f"),
            Self::Glsl => format!("{x:?}"),
        }
    }

    fn vec4(self) -> &'static str {
        match self {
            Self::Wgsl => "vec4<f32>",
            Self::Glsl => "vec4",
        }
    }

    fn mat4(self) -> &'static str {
        match self {
            Self::Wgsl => "mat4x4<f32>",
            Self::Glsl => "mat4",
        }
    }

    /// `const NAME: TYPE = value;` of a scalar.
    fn scalar_constant(self, name: &str, value: f32) -> String {
        match self {
            Self::Wgsl => format!("const {name}: f32 = {};\n", self.literal(value)),
            Self::Glsl => format!("const float {name} = {};\n", self.literal(value)),
        }
    }

    /// A constant array; items are written several to a line.
    fn array_constant(self, name: &str, element: &str, items: &[String], per_line: usize) -> String {
        let n = items.len();
        let mut text = match self {
            Self::Wgsl => format!("const {name} = array<{element}, {n}>(\n"),
            Self::Glsl => format!("const {element} {name}[{n}] = {element}[{n}](\n"),
        };
        let lines: Vec<String> = items.chunks(per_line).map(|line| format!("    {}", line.join(", "))).collect();
        text += &lines.join(",\n");
        text + "\n);\n"
    }

    fn element(self) -> &'static str {
        match self {
            Self::Wgsl => "f32",
            Self::Glsl => "float",
        }
    }

    /// `let name = value;`
    fn bind(self, kind: &str, name: &str, value: &str) -> String {
        match self {
            Self::Wgsl => format!("    let {name} = {value};\n"),
            Self::Glsl => format!("    {kind} {name} = {value};\n"),
        }
    }

    fn function(self, width: usize) -> String {
        match self {
            Self::Wgsl => format!("fn {ENTRY}(f: array<f32, {width}>) -> f32 {{\n"),
            Self::Glsl => format!("float {ENTRY}(float f[{width}]) {{\n"),
        }
    }

    fn splat(self, x: f32) -> String {
        format!("{}({})", self.vec4(), self.literal(x))
    }
}

/// A whole include file.
pub fn source(mlp: &Mlp, language: Language, form: Form) -> String {
    let mut text = header(mlp, form);
    text += &language.feature_source(mlp.feature_set());
    text.push('\n');
    match form {
        Form::Plain => plain(mlp, language, &mut text),
        Form::Packed => packed(mlp, language, &mut text),
    }
    if mlp.feature_set().moment_depth() == MomentDepthKind::Log {
        text += &recentred::answer(language, mlp.feature_set());
    }
    text
}

/// The comment that says what the file is, what to feed it and what to expect.
fn header(mlp: &Mlp, form: Form) -> String {
    let set = mlp.feature_set();
    let mut lines = vec![
        format!("Neural moment transparency: network '{}', {}, {} multiply-adds.", mlp.name(), mlp.shape(), mlp.multiply_adds()),
        match form {
            Form::Plain => "Form: unrolled scalars. Weights are [in][out]; every index is a literal.".to_owned(),
            Form::Packed => "Form: packed. Blocks of 4 x 4 weights as matrices; every index is a literal.".to_owned(),
        },
        String::new(),
        format!("Features, set '{}', in this order: {}.", set.name(), set.columns().join(", ")),
    ];
    lines.extend(set.description().iter().map(|&l| l.to_owned()));
    lines.push(String::new());
    let p = &mlp.provenance;
    let known = |name: &str, value: Option<String>| value.map(|v| format!("{name} {v}"));
    let origin: Vec<String> = [
        (!p.source.is_empty()).then(|| p.source.clone()),
        known("commit", p.commit.clone()),
        known("backend", p.backend.clone()),
        known("seed", p.seed.map(|s| s.to_string())),
        known("epochs", p.epochs.map(|e| e.to_string())),
        known("dataset", p.dataset_hash.clone()),
    ]
    .into_iter()
    .flatten()
    .collect();
    lines.push(format!("Provenance: {}.", if origin.is_empty() { "unknown".to_owned() } else { origin.join(", ") }));
    lines.push(match (p.transmittance_mse, p.transmittance_worst_error) {
        (Some(mse), Some(worst)) => {
            format!("Measured on fresh pixels of the training distribution: mean squared error of T {mse:.3e}, worst {worst:.3}.")
        }
        _ => "Measured error: none recorded; 'nmt predict' measures it on fragment lists.".to_owned(),
    });
    lines.iter().map(|line| format!("//{}{}\n", if line.is_empty() { "" } else { " " }, one_line(line))).collect::<String>() + "\n"
}

/// Text from a file, made safe inside a line comment.
fn one_line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() || c == '\\' { ' ' } else { c }).collect()
}

/// Name of layer `index`'s weights, biases, and blocks of weights.
pub(crate) fn weights_name(index: usize) -> String {
    format!("NMT_W{}", index + 1)
}
pub(crate) fn biases_name(index: usize) -> String {
    format!("NMT_B{}", index + 1)
}

fn plain(mlp: &Mlp, language: Language, text: &mut String) {
    let literals = |values: &[f32]| -> Vec<String> { values.iter().map(|&v| language.literal(v)).collect() };
    for (index, dense) in mlp.layers().iter().enumerate() {
        *text += &language.array_constant(&weights_name(index), language.element(), &literals(&dense.weights), 8);
        *text += &language.array_constant(&biases_name(index), language.element(), &literals(&dense.biases), 8);
    }
    let _ = write!(text, "\n// Transmittance in front of the fragment with features f, in [0, 1].\n{}", language.function(mlp.feature_set().width()));
    let last = mlp.layers().len() - 1;
    for (index, dense) in mlp.layers().iter().enumerate() {
        let input = |i: usize| if index == 0 { format!("f[{i}]") } else { format!("h{index}_{i}") };
        for o in 0..dense.outputs() {
            let mut sum = format!("{}[{o}]", biases_name(index));
            for i in 0..dense.inputs() {
                let _ = write!(sum, " + {}[{}] * {}", weights_name(index), i * dense.outputs() + o, input(i));
            }
            *text += &match index == last {
                true => language.bind("float", "logit", &sum),
                false => language.bind("float", &format!("h{}_{o}", index + 1), &format!("max({sum}, 0.0)")),
            };
        }
    }
    *text += &ending(mlp, language);
}

/// From the logit to the answer, without overflow; what [`Mlp::forward`] does.
fn ending(mlp: &Mlp, language: Language) -> String {
    // 1/(1 + e^−x)
    let sigmoid = "1.0 / (1.0 + exp(min(-logit, 80.0)))";
    match mlp.feature_set().answer() {
        Answer::Sigmoid => format!("    return {sigmoid};\n}}\n"),
        Answer::Fraction { column, offset } => {
            let absorbance = language.bind(
                "float",
                "absorbance",
                &format!("max(exp(min(f[{column}], {})) - {}, 0.0)", language.literal(MOST_LOG_ABSORBANCE), language.literal(offset)),
            );
            format!("{absorbance}    return exp(-min(absorbance * ({sigmoid}), 80.0));\n}}\n")
        }
    }
}

/// Number of vec4 that hold n values.
fn groups(n: usize) -> usize {
    n.div_ceil(4)
}

/// Whether a layer's biases ride along as a weight from the constant 1 that fills the last vec4 of its inputs.
pub(crate) fn biases_are_folded(dense: &Dense) -> bool {
    !dense.inputs().is_multiple_of(4)
}

/// Block of weights from inputs 4i..4i+4 to outputs 4g..4g+4, column by column; missing ones are 0, and the biases stand in the first missing input's column.
pub(crate) fn block(dense: &Dense, g: usize, i: usize) -> [[f32; 4]; 4] {
    std::array::from_fn(|column| {
        std::array::from_fn(|row| {
            let (input, output) = (4 * i + column, 4 * g + row);
            match output < dense.outputs() {
                true if input < dense.inputs() => dense.weight(input, output),
                true if input == dense.inputs() => dense.biases[output],
                _ => 0.0,
            }
        })
    })
}

fn packed(mlp: &Mlp, language: Language, text: &mut String) {
    let vec4 = |v: [f32; 4]| format!("{}({})", language.vec4(), v.map(|x| language.literal(x)).join(", "));
    let last = mlp.layers().len() - 1;
    for (index, dense) in mlp.layers().iter().enumerate() {
        let (inputs, outputs) = (groups(dense.inputs()), groups(dense.outputs()));
        if index == last {
            // One output: a row of weights, four inputs to a vector.
            let rows: Vec<String> = (0..inputs).map(|i| vec4(block(dense, 0, i).map(|column| column[0]))).collect();
            *text += &language.array_constant(&weights_name(index), language.vec4(), &rows, 1);
        } else {
            let blocks: Vec<String> = (0..outputs)
                .flat_map(|g| (0..inputs).map(move |i| (g, i)))
                .map(|(g, i)| format!("{}({})", language.mat4(), block(dense, g, i).map(vec4).join(", ")))
                .collect();
            *text += &language.array_constant(&weights_name(index), language.mat4(), &blocks, 1);
        }
        if !biases_are_folded(dense) {
            *text += &if index == last {
                language.scalar_constant(&biases_name(index), dense.biases[0])
            } else {
                let biases: Vec<String> =
                    (0..outputs).map(|g| vec4(std::array::from_fn(|row| dense.biases.get(4 * g + row).copied().unwrap_or(0.0)))).collect();
                language.array_constant(&biases_name(index), language.vec4(), &biases, 1)
            };
        }
    }
    let _ = write!(text, "\n// Transmittance in front of the fragment with features f, in [0, 1].\n{}", language.function(mlp.feature_set().width()));
    let width = mlp.feature_set().width();
    for i in 0..groups(width) {
        let lane = |c: usize| match 4 * i + c {
            input if input < width => format!("f[{input}]"),
            // The constant that carries folded biases, then padding.
            input => language.literal(if input == width { 1.0 } else { 0.0 }),
        };
        *text += &language.bind(language.vec4(), &format!("h0_{i}"), &format!("{}({})", language.vec4(), [0, 1, 2, 3].map(lane).join(", ")));
    }
    for (index, dense) in mlp.layers().iter().enumerate() {
        let inputs = groups(dense.inputs());
        let weights = weights_name(index);
        let folded = biases_are_folded(dense);
        if index == last {
            let terms = (0..inputs).map(|i| format!("dot({weights}[{i}], h{index}_{i})"));
            let sum: Vec<String> = (!folded).then(|| biases_name(index)).into_iter().chain(terms).collect();
            *text += &language.bind("float", "logit", &sum.join(" + "));
            continue;
        }
        for g in 0..groups(dense.outputs()) {
            let terms = (0..inputs).map(|i| format!("{weights}[{}] * h{index}_{i}", g * inputs + i));
            let sum: Vec<String> = (!folded).then(|| format!("{}[{g}]", biases_name(index))).into_iter().chain(terms).collect();
            let mut value = format!("max({}, {})", sum.join(" + "), language.splat(0.0));
            let filled = dense.outputs() - 4 * g;
            if filled < 4 {
                // The next layer finds its biases' constant 1 in the first free lane.
                let constant: [f32; 4] = std::array::from_fn(|lane| if lane == filled { 1.0 } else { 0.0 });
                value = format!("{value} + {}", vec4(constant));
            }
            *text += &language.bind(language.vec4(), &format!("h{}_{g}", index + 1), &value);
        }
    }
    *text += &ending(mlp, language);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Provenance;
    use crate::model::mlp::tests::random_mlp;

    /// The text of a tiny network in every language and form, so that a change of it is seen.
    #[test]
    fn text_of_a_tiny_network() {
        let mut mlp = random_mlp(&[3], 1);
        mlp.provenance = Provenance { source: "a test\nwith a line break \\".to_owned(), seed: Some(1), ..Provenance::default() };
        for (language, name) in [(Language::Wgsl, "wgsl"), (Language::Glsl, "glsl")] {
            insta::assert_snapshot!(format!("plain_{name}"), source(&mlp, language, Form::Plain));
            insta::assert_snapshot!(format!("packed_{name}"), source(&mlp, language, Form::Packed));
        }
    }

    #[test]
    fn literals_parse_back_to_the_same_bits() {
        let mut bits = 1u32;
        for _ in 0..100_000 {
            bits = bits.wrapping_mul(1664525).wrapping_add(1013904223);
            let x = f32::from_bits(bits);
            if x.is_finite() {
                let text = Language::Glsl.literal(x);
                assert_eq!(text.parse::<f32>().unwrap().to_bits(), x.to_bits());
                // Readers that go through f64, as JSON and constant evaluators do.
                assert_eq!((text.parse::<f64>().unwrap() as f32).to_bits(), x.to_bits(), "{text}");
                assert!(text.contains(['.', 'e']), "{text} would be an integer");
            }
        }
    }
}
