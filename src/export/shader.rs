//! Shader source: WGSL, GLSL and HLSL, unrolled scalars or packed vectors, in f32 or with the hidden layers in f16,
//! through one emitter.

use super::dialect::ShadingLanguage;
use super::{ExportError, Form, Format, Precision, Prefix, calls};
use crate::features::{Answer, FeatureSet, MAX_LOG_ABSORBANCE};
use crate::model::simplify::Pruned;
use crate::model::{Dense, Mlp};
use crate::numeric::quantise::round_f16;
use crate::numeric::source::{Source, Type, component};
use std::fmt::Write;

/// The function that answers; it takes the features as one value, see [`Type::Reals`].
pub const ENTRY: &str = "nmt_transmittance";

pub use crate::features::SHARE;

/// The function that holds the network.
pub fn network_function(set: FeatureSet) -> &'static str {
    match set.answer() {
        Answer::Sigmoid => ENTRY,
        Answer::AbsorbanceShare { .. } => SHARE,
    }
}

/// Numbers of one precision in one language.
#[derive(Clone, Copy)]
struct Numbers {
    language: &'static dyn ShadingLanguage,
    precision: Precision,
}

impl Numbers {
    fn scalar(self) -> &'static str {
        self.language.scalar(self.precision)
    }

    fn vec4(self) -> String {
        self.language.vec4(self.precision)
    }

    fn mat4(self) -> String {
        self.language.mat4(self.precision)
    }

    /// A literal of the number as this precision keeps it.
    fn literal(self, x: f32) -> String {
        match self.precision {
            Precision::F32 => self.language.literal(x),
            Precision::F16 => format!("{:?}h", shortest_half(x)),
        }
    }

    fn vector(self, v: [f32; 4]) -> String {
        format!("{}({})", self.vec4(), v.map(|x| self.literal(x)).join(", "))
    }

    fn splat(self, x: f32) -> String {
        self.language.splat(self.precision, &self.literal(x))
    }

    fn scalar_constant(self, name: &str, value: f32) -> String {
        self.language
            .scalar_constant(self.precision, name, &self.literal(value))
    }

    /// A constant array; items are written several to a line.
    fn array_constant(self, name: &str, element: &str, items: &[String], per_line: usize) -> String {
        let [head, end] = self.language.array_constant(name, element, items.len());
        let lines: Vec<String> = items
            .chunks(per_line)
            .map(|line| format!("    {}", line.join(", ")))
            .collect();
        head + &lines.join(",\n") + &end
    }
}

/// The f32 with the fewest digits that rounds to the same f16.
fn shortest_half(x: f32) -> f32 {
    let half = round_f16(x.into());
    let candidates = (0..8).filter_map(|digits| format!("{half:.digits$e}").parse::<f32>().ok());
    candidates
        .into_iter()
        .find(|&c| round_f16(c.into()) == half)
        .unwrap_or(half as f32)
}

/// Greatest absolute error and greatest mean error of a network with its hidden layers in f16, against f64, on random
/// rows of the training distribution: f16 keeps 11 bits of a sum, and a logit that is off by 0.02 beside great
/// absorbance is rare, but there.
pub fn half_bounds(set: FeatureSet) -> (f64, f64) {
    let tolerances = set.spec().tolerances;
    (tolerances.half, tolerances.half_mean)
}

/// Greatest finite f16.
const MAX_HALF: f64 = 65504.0;

/// Greatest absolute feature that a network's hidden layers may see in f16: however the sums of its units are ordered
/// and rounded, none overflows.
///
/// # Errors
/// [`ExportError::Half`] where a weight does not fit, or features of the usual size could overflow.
pub fn half_limit(mlp: &Mlp) -> Result<f32, ExportError> {
    let refused = |reason: String| ExportError::Half {
        network: mlp.name().to_owned(),
        reason,
    };
    let hidden = &mlp.layers()[..mlp.layers().len() - 1];
    for (index, dense) in hidden.iter().enumerate() {
        if let Some(w) = dense
            .weights
            .iter()
            .chain(&dense.biases)
            .find(|w| f64::from(w.abs()) > MAX_HALF)
        {
            return Err(refused(format!(
                "layer {} holds the weight {w}, and f16 ends at {MAX_HALF}",
                index + 1
            )));
        }
    }
    // Half of the range is left to rounding.
    let fits = |limit: f64| {
        let mut low = vec![-limit; mlp.layers()[0].inputs()];
        let mut high = vec![limit; low.len()];
        for dense in hidden {
            let (mut next, mut greatest) = (Vec::new(), 0.0f64);
            for o in 0..dense.outputs() {
                let bias = f64::from(dense.biases[o]);
                let (mut least, mut most) = (bias.min(0.0), bias.max(0.0));
                for i in 0..dense.inputs() {
                    let w = f64::from(dense.weight(i, o));
                    let (a, b) = (w * low[i], w * high[i]);
                    least += a.min(b).min(0.0);
                    most += a.max(b).max(0.0);
                }
                greatest = greatest.max(most).max(-least);
                next.push(most);
            }
            if greatest > MAX_HALF / 2.0 {
                return false;
            }
            low = vec![0.0; next.len()];
            high = next;
        }
        true
    };
    let least = mlp.feature_set().spec().tolerances.usual_feature_log2;
    let power = (least..=14).rev().find(|&p| fits(2f64.powi(p)));
    power.map(|p| 2f32.powi(p)).ok_or_else(|| {
        refused(format!(
            "features of {} could overflow its sums, and f16 ends at {MAX_HALF}; export it in f32",
            2f64.powi(least)
        ))
    })
}

/// A whole include file.
///
/// # Errors
/// [`ExportError::Half`] where the network does not fit into f16.
///
/// # Panics
/// If the format is no shader.
pub fn source(mlp: &Mlp, format: Format, prefix: Option<&Prefix>) -> Result<String, ExportError> {
    let language = format.language().expect("the format of a shader");
    let (form, precision) = (format.form(), format.precision());
    let limit = (precision == Precision::F16).then(|| half_limit(mlp)).transpose()?;
    let network = Network {
        mlp,
        language,
        precision,
        limit,
    };
    let functions = Source::new(language.dialect(), "nmt");
    let shader_calls = &mlp.feature_set().spec().shader;
    (shader_calls.write_features)(&functions);
    let mut body = "\n".to_owned();
    match form {
        Form::Plain => network.plain(&mut body),
        Form::Packed => network.packed(&mut body),
    }
    functions.between(&body);
    (shader_calls.write_answers)(&functions);
    calls::write(&functions, mlp.feature_set().spec());
    let guard = include_guard(mlp.name());
    let text = language.file(functions.into_text().trim_start_matches('\n'), precision, &guard);
    let head = comment(format, &header(mlp, format, prefix, limit));
    Ok(match prefix {
        Some(prefix) => head + &prefix.apply(&text),
        None => head + &text,
    })
}

/// The macro that tells whether a network's include file is there already.
pub(super) fn include_guard(network: &str) -> String {
    let word: String = network
        .chars()
        .map(|c| {
            if c.is_ascii_alphanumeric() {
                c.to_ascii_uppercase()
            } else {
                '_'
            }
        })
        .collect();
    // Two underscores are for compilers.
    let parts: Vec<&str> = word.split('_').filter(|part| !part.is_empty()).collect();
    format!("NMT_INCLUDED_{}", parts.join("_"))
}

/// The bytes of a [`source`], as a target that is written here has them.
pub(super) fn encode(mlp: &Mlp, format: Format, prefix: Option<&Prefix>) -> Result<Vec<u8>, ExportError> {
    Ok(source(mlp, format, prefix)?.into_bytes())
}

/// Which network it is, where it comes from and how accurate it is.
pub(super) fn short_header(mlp: &Mlp) -> Vec<String> {
    let kept = ["Neural", PRUNED, "Provenance", "Measured"];
    let lines = header(mlp, Format::WGSL, None, None);
    lines
        .into_iter()
        .filter(|line| kept.iter().any(|head| line.starts_with(head)))
        .collect()
}

/// Lines as a comment in the language of a format, and an empty line behind it.
///
/// # Panics
/// If the format is no shader.
pub(super) fn comment(format: Format, lines: &[String]) -> String {
    let mark = format.language().expect("the format of a shader").comment();
    let line = |line: &String| format!("{mark}{}{}\n", if line.is_empty() { "" } else { " " }, one_line(line));
    lines.iter().map(line).collect::<String>() + "\n"
}

/// What the file is, what to feed it and what to expect.
pub(super) fn header(mlp: &Mlp, format: Format, prefix: Option<&Prefix>, limit: Option<f32>) -> Vec<String> {
    let set = mlp.feature_set();
    let mut lines = vec![
        format!(
            "Neural moment transparency: network '{}', {}, {} multiply-adds.",
            mlp.name(),
            mlp.shape(),
            mlp.multiply_adds()
        ),
        match format.form() {
            Form::Plain => "Form: unrolled scalars. Weights are [in][out]; every index is a literal.".to_owned(),
            Form::Packed => "Form: packed. Blocks of 4 x 4 weights as matrices; every index is a literal.".to_owned(),
        },
    ];
    lines.extend(prefix.map(Prefix::line));
    lines.extend(
        format
            .language()
            .map_or_else(Vec::new, |language| language.notes(format.precision())),
    );
    if let Some(limit) = limit {
        lines.extend(half_lines(limit, half_bounds(set)));
    }
    if let Some(pruned) = &mlp.provenance.pruned {
        lines.extend(pruned_lines(pruned, format.form()));
    }
    lines.extend([
        String::new(),
        format!(
            "Features, set '{}', in this order: {}.",
            set.name(),
            set.columns().join(", ")
        ),
    ]);
    lines.extend(set.description().iter().map(|&l| l.to_owned()));
    lines.push(String::new());
    let p = &mlp.provenance;
    let known = |name: &str, value: Option<String>| value.map(|v| format!("{name} {v}"));
    let origin: Vec<String> = [
        (!p.source.is_empty()).then(|| p.source.clone()),
        known("commit", p.commit.clone()),
        known("backend", p.backend.clone()),
        known("seed", p.seed.map(|s| s.to_string())),
        known("epochs", p.epochs_text()),
        known("dataset", p.dataset_hash.clone()),
    ]
    .into_iter()
    .flatten()
    .collect();
    lines.push(format!(
        "Provenance: {}.",
        if origin.is_empty() {
            "unknown".to_owned()
        } else {
            origin.join(", ")
        }
    ));
    let unknown = "Measured error: none recorded; 'nmt predict' measures it on fragment lists.";
    lines.push(p.measured_text().unwrap_or_else(|| unknown.to_owned()));
    lines
}

/// What is to be known of half precision.
fn half_lines(limit: f32, (worst, mean): (f64, f64)) -> [String; 3] {
    [
        "Precision: weights and activations of the hidden layers are f16; features, the last layer and the answer are \
            f32."
            .to_owned(),
        format!("The hidden layers see features clamped to [-{limit:?}, {limit:?}], within which no sum can overflow."),
        format!(
            "Error of the answer against f64 on random rows of the training distribution: at most {worst}, at most \
                {mean} in the mean."
        ),
    ]
}

/// What the header's line that says which units were taken out begins with.
pub const PRUNED: &str = "Pruned: ";

/// What is to be known of units that were taken out.
fn pruned_lines(pruned: &Pruned, form: Form) -> [String; 2] {
    let bits = if form == Form::Plain {
        ", to the bit"
    } else {
        ", but for the order of sums"
    };
    let region = match (pruned.count(), pruned.rows) {
        (0, _) => "Every hidden unit of the trained network fires somewhere; nothing was taken out.".to_owned(),
        (_, 0) => format!(
            "What was taken out cannot fire, or nothing listens to it: answers are exact for all features{bits}."
        ),
        (_, rows) => format!(
            "What was taken out fired on none of {rows} random rows of the training distribution: on fewer than {:.1e} \
                of them, at 95 % confidence. Where it \
             would not fire, answers are exact{bits}; elsewhere they are off by what it would add.",
            3.0 / rows as f64
        ),
    };
    [format!("{PRUNED}{}.", pruned.to_text()), region]
}

/// Text from a file, made safe inside a line comment.
fn one_line(text: &str) -> String {
    text.chars()
        .map(|c| if c.is_control() || c == '\\' { ' ' } else { c })
        .collect()
}

/// Name of layer `index`'s weights, biases, and blocks of weights.
pub(crate) fn weights_name(index: usize) -> String {
    format!("NMT_W{}", index + 1)
}
pub(crate) fn biases_name(index: usize) -> String {
    format!("NMT_B{}", index + 1)
}

/// Number of vec4 that hold n values.
fn groups(n: usize) -> usize {
    n.div_ceil(4)
}

/// Whether a layer's biases ride along as a weight from the constant 1 that fills the last vec4 of its inputs.
pub(crate) fn biases_are_folded(dense: &Dense) -> bool {
    !dense.inputs().is_multiple_of(4)
}

/// Block of weights from inputs 4i..4i+4 to outputs 4g..4g+4, input by input; missing ones are 0, and the biases stand
/// at the first missing input.
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

/// A network about to become source.
struct Network<'a> {
    mlp: &'a Mlp,
    language: &'static dyn ShadingLanguage,
    precision: Precision,
    /// Greatest absolute feature that hidden layers in f16 see.
    limit: Option<f32>,
}

impl Network<'_> {
    fn numbers(&self, precision: Precision) -> Numbers {
        Numbers {
            language: self.language,
            precision,
        }
    }

    fn last(&self) -> usize {
        self.mlp.layers().len() - 1
    }

    /// Numbers of a layer's weights: the last layer is f32 always.
    fn of_layer(&self, index: usize) -> Numbers {
        self.numbers(if index == self.last() {
            Precision::F32
        } else {
            self.precision
        })
    }

    /// An activation of the layer before as the layer wants it.
    fn converted(&self, index: usize, kind: impl Fn(Numbers) -> String, value: String) -> String {
        let before = if index == 0 {
            self.numbers(Precision::F32)
        } else {
            self.of_layer(index - 1)
        };
        if before.precision == self.of_layer(index).precision {
            value
        } else {
            format!("{}({value})", kind(self.of_layer(index)))
        }
    }

    fn head(&self, text: &mut String) {
        let set = self.mlp.feature_set();
        let what = match set.answer() {
            Answer::Sigmoid => "Transmittance in front of the fragment with features f",
            Answer::AbsorbanceShare { .. } => {
                "Share of the other fragments' absorbance that lies in front of the fragment with features f"
            }
        };
        let _ = write!(
            text,
            "\n// {what}, in [0, 1].\n{}",
            self.function(network_function(set))
        );
    }

    /// The head of a function of the features f.
    fn function(&self, name: &str) -> String {
        let features = Type::Reals(self.mlp.feature_set().width());
        let number = self.language.type_name(Type::Real);
        format!("{} {{\n", self.language.head(name, &[("f", features)], &number))
    }

    /// A feature by its column.
    fn feature(&self, column: usize) -> String {
        component("f", self.mlp.feature_set().width(), column)
    }

    fn plain(&self, text: &mut String) {
        let language = self.language;
        for (index, dense) in self.mlp.layers().iter().enumerate() {
            let numbers = self.of_layer(index);
            for (name, values) in [
                (weights_name(index), &dense.weights),
                (biases_name(index), &dense.biases),
            ] {
                let literals: Vec<String> = values.iter().map(|&v| numbers.literal(v)).collect();
                *text += &numbers.array_constant(&name, numbers.scalar(), &literals, 8);
            }
        }
        self.head(text);
        for (index, dense) in self.mlp.layers().iter().enumerate() {
            let numbers = self.of_layer(index);
            let single = |n: Numbers| n.scalar().to_owned();
            let mut input = |i: usize| {
                let clamped = self.limit.filter(|_| index == 0 && index != self.last());
                let value = match (index, clamped) {
                    (0, Some(limit)) => format!(
                        "clamp({}, {}, {})",
                        self.feature(i),
                        language.literal(-limit),
                        language.literal(limit)
                    ),
                    (0, None) => self.feature(i),
                    _ => format!("h{index}_{i}"),
                };
                let converted = self.converted(index, single, value.clone());
                if converted == value {
                    return value;
                }
                // Once a value, not once a term.
                let name = format!("x{index}_{i}");
                *text += &language.bind(numbers.scalar(), &name, &converted);
                name
            };
            let inputs: Vec<String> = (0..dense.inputs()).map(&mut input).collect();
            for o in 0..dense.outputs() {
                let mut sum = format!("{}[{o}]", biases_name(index));
                for (i, input) in inputs.iter().enumerate() {
                    // What a weight of 0 adds changes no bit.
                    if dense.weight(i, o) != 0.0 {
                        let _ = write!(sum, " + {}[{}] * {input}", weights_name(index), i * dense.outputs() + o);
                    }
                }
                *text += &match index == self.last() {
                    true => language.bind("float", "logit", &sum),
                    false => language.bind(
                        numbers.scalar(),
                        &format!("h{}_{o}", index + 1),
                        &format!("max({sum}, {})", self.zero(numbers)),
                    ),
                };
            }
        }
        *text += &self.ending();
    }

    /// 0 beside a scalar.
    fn zero(&self, numbers: Numbers) -> String {
        // An untyped 0.0 is an f32 in every language.
        if numbers.precision == Precision::F32 {
            "0.0".to_owned()
        } else {
            numbers.literal(0.0)
        }
    }

    /// From the logit to the answer, without overflow; what [`Mlp::forward`] does.
    fn ending(&self) -> String {
        let language = self.language;
        // 1/(1 + e^−x)
        let mut text = "    return 1.0 / (1.0 + exp(min(-logit, 80.0)));\n}\n".to_owned();
        if let Answer::AbsorbanceShare { column, offset } = self.mlp.feature_set().answer() {
            let absorbance = format!(
                "max(exp(min({}, {})) - {}, 0.0)",
                self.feature(column),
                language.literal(MAX_LOG_ABSORBANCE),
                language.literal(offset)
            );
            let _ = write!(
                text,
                "\n// Transmittance in front of the fragment with features f, in [0, 1].\n{}{}    return \
                    exp(-min(absorbance * {SHARE}(f), 80.0));\n}}\n",
                self.function(ENTRY),
                language.bind("float", "absorbance", &absorbance),
            );
        }
        text
    }

    /// Constants of the packed form.
    fn packed_constants(&self, text: &mut String) {
        for (index, dense) in self.mlp.layers().iter().enumerate() {
            let numbers = self.of_layer(index);
            let (inputs, outputs) = (groups(dense.inputs()), groups(dense.outputs()));
            if index == self.last() {
                // One output: a row of weights, four inputs to a vector.
                let rows: Vec<String> = (0..inputs)
                    .map(|i| numbers.vector(block(dense, 0, i).map(|column| column[0])))
                    .collect();
                *text += &numbers.array_constant(&weights_name(index), &numbers.vec4(), &rows, 1);
            } else {
                let blocks: Vec<String> = (0..outputs)
                    .flat_map(|g| (0..inputs).map(move |i| (g, i)))
                    .map(|(g, i)| {
                        format!(
                            "{}({})",
                            numbers.mat4(),
                            block(dense, g, i).map(|v| numbers.vector(v)).join(", ")
                        )
                    })
                    .collect();
                *text += &numbers.array_constant(&weights_name(index), &numbers.mat4(), &blocks, 1);
            }
            if !biases_are_folded(dense) {
                *text += &if index == self.last() {
                    numbers.scalar_constant(&biases_name(index), dense.biases[0])
                } else {
                    let bias = |at: usize| dense.biases.get(at).copied().unwrap_or(0.0);
                    let biases: Vec<String> = (0..outputs)
                        .map(|g| numbers.vector(std::array::from_fn(|row| bias(4 * g + row))))
                        .collect();
                    numbers.array_constant(&biases_name(index), &numbers.vec4(), &biases, 1)
                };
            }
        }
    }

    /// Features 4i to 4i + 3; behind the last of them the constant that carries folded biases, then padding.
    fn four_features(&self, i: usize) -> String {
        let width = self.mlp.feature_set().width();
        let single = self.numbers(Precision::F32);
        let filled = (width - 4 * i).min(4);
        let whole = if width > 4 { format!("f[{i}]") } else { "f".to_owned() };
        if filled == 4 {
            return whole;
        }
        // All of a value that is no matrix, the first lanes of a matrix's last vector.
        let lanes = if width > 4 {
            format!("{whole}.{}", &"xyz"[..filled])
        } else {
            whole
        };
        let rest = (filled..4).map(|lane| single.literal(if lane == filled { 1.0 } else { 0.0 }));
        let rest: Vec<String> = rest.collect();
        format!("{}({lanes}, {})", single.vec4(), rest.join(", "))
    }

    fn packed(&self, text: &mut String) {
        let language = self.language;
        self.packed_constants(text);
        self.head(text);
        let width = self.mlp.feature_set().width();
        let single = self.numbers(Precision::F32);
        for i in 0..groups(width) {
            let mut value = self.four_features(i);
            if let Some(limit) = self.limit.filter(|_| self.last() > 0) {
                value = format!("clamp({value}, {}, {})", single.splat(-limit), single.splat(limit));
            }
            let value = self.converted(0, Numbers::vec4, value);
            *text += &language.bind(&self.of_layer(0).vec4(), &format!("h0_{i}"), &value);
        }
        for (index, dense) in self.mlp.layers().iter().enumerate() {
            let numbers = self.of_layer(index);
            let inputs = groups(dense.inputs());
            let weights = weights_name(index);
            let folded = biases_are_folded(dense);
            if index == self.last() {
                let input = |i: usize| match (index, format!("h{index}_{i}")) {
                    (0, name) => name,
                    (_, name) => self.converted(index, Numbers::vec4, name),
                };
                let terms = (0..inputs).map(|i| format!("dot({weights}[{i}], {})", input(i)));
                let sum: Vec<String> = (!folded).then(|| biases_name(index)).into_iter().chain(terms).collect();
                *text += &language.bind("float", "logit", &sum.join(" + "));
                continue;
            }
            for g in 0..groups(dense.outputs()) {
                // A block of nothing but zeros adds nothing.
                let used = (0..inputs).filter(|&i| block(dense, g, i).iter().flatten().any(|&w| w != 0.0));
                let terms =
                    used.map(|i| language.product(&format!("{weights}[{}]", g * inputs + i), &format!("h{index}_{i}")));
                let sum: Vec<String> = (!folded)
                    .then(|| format!("{}[{g}]", biases_name(index)))
                    .into_iter()
                    .chain(terms)
                    .collect();
                let zero = numbers.splat(0.0);
                let mut value = if sum.is_empty() {
                    zero
                } else {
                    format!("max({}, {zero})", sum.join(" + "))
                };
                let filled = dense.outputs() - 4 * g;
                if filled < 4 {
                    // The next layer finds its biases' constant 1 in the first free lane.
                    let constant: [f32; 4] = std::array::from_fn(|lane| if lane == filled { 1.0 } else { 0.0 });
                    value = format!("{value} + {}", numbers.vector(constant));
                }
                *text += &language.bind(&numbers.vec4(), &format!("h{}_{g}", index + 1), &value);
            }
        }
        *text += &self.ending();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::Target;
    use crate::export::dialect::Glsl;
    use crate::model::Provenance;
    use crate::model::mlp::tests::random_mlp;

    /// The text of a tiny network in every language and form, so that a change of it is seen.
    #[test]
    fn text_of_a_tiny_network() {
        let mut mlp = random_mlp(&[3], 1);
        mlp.provenance = Provenance {
            source: "a test\nwith a line break \\".to_owned(),
            seed: Some(1),
            ..Provenance::default()
        };
        for target in Target::all_of_text().filter(|&target| target != Target::Metal) {
            let language = Format::of(target).name();
            for (form_name, form) in [("plain", Form::Plain), ("packed", Form::Packed)] {
                for (suffix, precision) in [("", Precision::F32), ("_f16", Precision::F16)] {
                    match Format::new(target, form, precision) {
                        Ok(format) => insta::assert_snapshot!(
                            format!("{form_name}_{language}{suffix}"),
                            source(&mlp, format, None).unwrap()
                        ),
                        Err(error) => assert_eq!(error.to_string().split(' ').next(), Some(language)),
                    }
                }
            }
        }
    }

    /// Half precision is refused where it could overflow, and its literals round to the weights' halves.
    #[test]
    fn what_does_not_fit_into_halves_is_refused() {
        let network = |first: f32, second: f32| {
            let layers = vec![
                Dense::new(7, 2, vec![first; 14], vec![0.0; 2]).unwrap(),
                Dense::new(2, 1, vec![second; 2], vec![0.0]).unwrap(),
                Dense::new(1, 1, vec![1e30], vec![0.0]).unwrap(),
            ];
            Mlp::new("n", FeatureSet::Recentred, layers, Provenance::default()).unwrap()
        };
        // 7 · 16 · 100 · 2 < 32752, and twice as much is not.
        assert_eq!(half_limit(&network(1.0, 100.0)).unwrap(), 16.0);
        assert_eq!(half_limit(&network(0.01, 1.0)).unwrap(), 16384.0);
        let message = |mlp: &Mlp| half_limit(mlp).unwrap_err().to_string();
        assert!(message(&network(10.0, 100.0)).contains("could overflow"));
        assert!(message(&network(7e4, 0.0)).contains("70000"));
    }

    #[test]
    fn half_literals_are_short_and_round_to_the_half() {
        let mut rng = crate::numeric::rng::stream(1, 95, 0);
        let mut digits = 0;
        for _ in 0..10_000 {
            let x = libm::exp2f(rand::RngExt::random_range(&mut rng, -20.0..15.9))
                * if rand::RngExt::random(&mut rng) { 1.0 } else { -1.0 };
            let short = shortest_half(x);
            assert_eq!(round_f16(short.into()), round_f16(x.into()));
            digits += format!("{short:?}").len();
        }
        assert!(digits < 90_000, "{digits}");
        assert_eq!(
            (shortest_half(0.1), shortest_half(0.0), shortest_half(-1e-9)),
            (0.1, 0.0, -0.0)
        );
    }

    #[test]
    fn literals_parse_back_to_the_same_bits() {
        let mut bits = 1u32;
        for _ in 0..100_000 {
            bits = bits.wrapping_mul(1664525).wrapping_add(1013904223);
            let x = f32::from_bits(bits);
            if x.is_finite() {
                let text = Glsl.literal(x);
                assert_eq!(text.parse::<f32>().unwrap().to_bits(), x.to_bits());
                // Readers that go through f64, as JSON and constant evaluators do.
                assert_eq!((text.parse::<f64>().unwrap() as f32).to_bits(), x.to_bits(), "{text}");
                assert!(text.contains(['.', 'e']), "{text} would be an integer");
            }
        }
    }
}
