//! Shader exports: parsed and validated by naga, weights read back bit for bit, executed on the CPU.

use super::interpret::Interpreter;
use crate::export::recentred::{FAINT_SWITCH, HIDDEN_SWITCH, ROUNDING};
use crate::export::target::Reader;
use crate::export::{Form, Format, Precision};
use crate::model::Mlp;
use crate::numeric::quantise::round_f16_of_f32;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{Expression, Module};
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// Parses and validates a shader export that naga reads. Nothing but f16, where the format says so, may be asked of a
/// device.
///
/// # Errors
/// The compiler's own words, with the place.
pub fn parse(format: Format, source: &str) -> Result<Module, String> {
    let module = match format.target().reader() {
        Reader::Wgsl => naga::front::wgsl::parse_str(source).map_err(|e| e.emit_to_string(source))?,
        Reader::Glsl => {
            let whole = complete_glsl(source);
            naga::front::glsl::Frontend::default()
                .parse(&naga::front::glsl::Options::from(naga::ShaderStage::Fragment), &whole)
                .map_err(|e| e.emit_to_string(&whole))?
        }
        _ => return Err(format!("naga does not read {}", format.name())),
    };
    let capabilities = if format.precision() == Precision::F16 {
        Capabilities::SHADER_FLOAT16
    } else {
        Capabilities::empty()
    };
    Validator::new(ValidationFlags::all(), capabilities)
        .validate(&module)
        .map_err(|e| format!("naga does not validate it: {}", e.into_inner()))?;
    Ok(module)
}

/// An include file as a whole shader.
fn complete_glsl(include: &str) -> String {
    format!("#version 450\n{include}\nvoid main() {{}}\n")
}

/// Names of the constants of a source and their numbers, in order.
pub type Constants = Vec<(String, Vec<f32>)>;

/// What the names of all constants that hold weights begin with.
const PREFIX: &str = "NMT_";

/// Constants that are none of the network's.
const OTHERS: [&str; 3] = [ROUNDING, FAINT_SWITCH, HIDDEN_SWITCH];

/// Constants that hold weights.
///
/// # Errors
/// In words, where one is not made of literals.
pub fn constants(module: &Module) -> Result<Constants, String> {
    let interpreter = Interpreter::new(module);
    let names = interpreter.constant_names().filter(|name| name.starts_with(PREFIX));
    names
        .map(|name| Ok((name.to_owned(), interpreter.constant(name).map_err(|e| e.to_string())?)))
        .collect()
}

/// The numbers in a piece of source, in order; words are names of types or functions.
///
/// # Errors
/// In words, where something begins like a number and is none.
pub(super) fn literals(text: &str) -> Result<Vec<f32>, String> {
    let is_word = |c: char| c.is_ascii_alphanumeric() || "_.+-".contains(c);
    // A sign that stands alone, or before a name, is none of a number.
    let words = text.split(|c: char| !is_word(c)).filter(|w| {
        w.trim_start_matches(['+', '-'])
            .starts_with(|c: char| c.is_ascii_digit())
    });
    let read = |w: &str| {
        let value: f32 = w
            .trim_end_matches(['f', 'h'])
            .parse()
            .map_err(|_| format!("'{w}' is not a number"))?;
        Ok(if w.ends_with('h') {
            round_f16_of_f32(value)
        } else {
            value
        })
    };
    words.map(read).collect()
}

/// Compares the bits of every weight and bias with the network's, and that nothing else than 0 stands beside them.
///
/// # Errors
/// Names the constant and the place of the first difference.
pub fn weights(format: Format, constants: &Constants, mlp: &Mlp) -> Result<(), String> {
    let mut expected_names = Vec::new();
    for index in 0..mlp.layers().len() {
        expected_names.extend(layer(format, constants, mlp, index)?);
    }
    if let Some((name, _)) = constants.iter().find(|(name, _)| {
        name.starts_with(PREFIX) && !OTHERS.contains(&name.as_str()) && !expected_names.contains(name)
    }) {
        return Err(format!("constant '{name}' belongs to no layer of the network"));
    }
    Ok(())
}

/// Compares a layer, and names its constants.
fn layer(format: Format, constants: &Constants, mlp: &Mlp, index: usize) -> Result<Vec<String>, String> {
    let packed = format.form() == Form::Packed;
    let numbers = |name: &str| {
        let found = constants.iter().find(|(n, _)| n == name);
        found
            .map(|(_, numbers)| numbers.as_slice())
            .ok_or_else(|| format!("there is no constant '{name}'"))
    };
    let (dense, last) = (&mlp.layers()[index], mlp.layers().len() - 1);
    let (weights_name, biases_name) = (format!("NMT_W{}", index + 1), format!("NMT_B{}", index + 1));
    let kept = |x: f32| {
        if format.precision() == Precision::F16 && index < last {
            round_f16_of_f32(x)
        } else {
            x
        }
    };
    let weights = numbers(&weights_name)?;
    let folded = packed && dense.inputs() % 4 != 0;
    let biases = if folded { &[] } else { numbers(&biases_name)? };
    // Where input i's weight to output o stands, and bias o.
    let groups = dense.inputs().div_ceil(4);
    let weight_at = |i: usize, o: usize| match packed {
        false => i * dense.outputs() + o,
        true if index == last => i,
        true => ((o / 4) * groups + i / 4) * 16 + (i % 4) * 4 + o % 4,
    };
    let mut met = vec![false; weights.len()];
    let mut compare = |name: &str, values: &[f32], at: usize, mark: bool, expected: f32| match values.get(at) {
        Some(found) if found.to_bits() == kept(expected).to_bits() => {
            if mark {
                met[at] = true;
            }
            Ok(())
        }
        Some(found) => Err(format!(
            "{name}: number {at} is {found:?}, the network has {:?}",
            kept(expected)
        )),
        None => Err(format!("{name} holds {} numbers, number {at} is needed", values.len())),
    };
    for o in 0..dense.outputs() {
        for i in 0..dense.inputs() {
            compare(&weights_name, weights, weight_at(i, o), true, dense.weight(i, o))?;
        }
        match folded {
            true => compare(
                &weights_name,
                weights,
                weight_at(dense.inputs(), o),
                true,
                dense.biases[o],
            )?,
            false => compare(&biases_name, biases, o, false, dense.biases[o])?,
        }
    }
    if let Some(at) = (0..weights.len()).find(|&at| !met[at] && weights[at] != 0.0) {
        return Err(format!(
            "{weights_name}: number {at} is {:?}, which is no weight of the network",
            weights[at]
        ));
    }
    if let Some(at) = (dense.outputs()..biases.len()).find(|&at| biases[at] != 0.0) {
        return Err(format!(
            "{biases_name}: number {at} is {:?}, which is no bias of the network",
            biases[at]
        ));
    }
    Ok(std::iter::once(weights_name)
        .chain((!folded).then_some(biases_name))
        .collect())
}

/// Checks that every index is a literal: shader compilers copy a constant array at each access with a run-time index.
///
/// # Errors
/// Names the function that has one.
pub fn literal_indices(module: &Module) -> Result<(), String> {
    for (_, function) in module.functions.iter() {
        let literal = |e: &Expression| match e {
            Expression::Access { index, .. } => matches!(
                function.expressions[*index],
                Expression::Literal(_) | Expression::Constant(_)
            ),
            _ => true,
        };
        if function.expressions.iter().any(|(_, e)| !literal(e)) {
            return Err(format!(
                "function '{}' has a run-time index",
                function.name.as_deref().unwrap_or("?")
            ));
        }
    }
    Ok(())
}

/// Runs a compiler with a source on its standard input; none where it is not installed.
pub(super) fn run_on(
    program: impl AsRef<std::ffi::OsStr>,
    arguments: &[&std::ffi::OsStr],
    input: &[u8],
) -> Option<std::io::Result<Output>> {
    let mut child = Command::new(program)
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .ok()?;
    let feed = child.stdin.take().map_or(Ok(()), |mut stdin| stdin.write_all(input));
    Some(match (feed, child.wait_with_output()) {
        // A compiler that stops reading has said why.
        (Err(error), Ok(output)) if output.status.success() => Err(error),
        (_, output) => output,
    })
}

/// Whether a compiler was content; else its own words.
pub(super) fn verdict(program: &str, output: std::io::Result<Output>) -> Result<(), String> {
    match output {
        Err(error) => Err(format!("{program}: {error}")),
        Ok(output) if output.status.success() => Ok(()),
        Ok(output) => {
            let said = [output.stdout, output.stderr]
                .map(|t| String::from_utf8_lossy(&t).trim().to_owned())
                .join("\n");
            Err(if said.trim().is_empty() {
                format!("{program} ends with {}", output.status)
            } else {
                said.trim().to_owned()
            })
        }
    }
}

/// Runs glslangValidator on a GLSL export; none where the program is not installed.
///
/// # Errors
/// Its own words.
pub fn glslang(source: &str) -> Option<Result<(), String>> {
    let arguments = ["--stdin", "-S", "frag"].map(std::ffi::OsStr::new);
    run_on(GLSLANG, &arguments, complete_glsl(source).as_bytes()).map(|output| verdict(GLSLANG, output))
}

/// The compiler of GLSL and HLSL.
const GLSLANG: &str = "glslangValidator";

/// Runs glslangValidator on a whole HLSL compute shader, which it makes SPIR-V of; none where the program is not
/// installed.
///
/// # Errors
/// Its own words.
pub fn glslang_hlsl(shader: &str, entry: &str, spirv: &Path) -> Option<Result<(), String>> {
    let head = ["-D", "--stdin", "-S", "comp", "-V", "-e", entry, "-o"].map(std::ffi::OsStr::new);
    let arguments: Vec<_> = head.into_iter().chain([spirv.as_os_str()]).collect();
    run_on(GLSLANG, &arguments, shader.as_bytes()).map(|output| verdict(GLSLANG, output))
}

#[cfg(test)]
mod tests {
    use super::super::interpret::Value;
    use super::*;
    use crate::export::{encode, shader::ENTRY, shader::half_limit};
    use crate::features::recentred::{FragmentTerms, Pass2Input, PixelSums};
    use crate::features::{FeatureSet, paper};
    use crate::model::mlp::tests::random_mlp;
    use crate::model::{Dense, Provenance};
    use crate::numeric::rng::stream;
    use crate::pixel::{LogWarp, ViewZ};
    use rand::RngExt;

    const SHADERS: [Format; 4] = [Format::WGSL, Format::WGSL_PLAIN, Format::GLSL, Format::GLSL_PLAIN];
    const HALVES: [Format; 2] = [Format::WGSL_F16, Format::WGSL_PLAIN_F16];

    fn source(mlp: &Mlp, format: Format) -> String {
        String::from_utf8(encode(mlp, format).unwrap()).unwrap()
    }

    /// Sizes that are and are not multiples of four, one to three layers: every form validates, reads back and computes
    /// the reference's numbers.
    #[test]
    fn every_form_of_every_size_computes_the_reference() {
        let mut rng = crate::numeric::rng::stream(3, 0, 0);
        let rows: Vec<f32> = (0..7 * 200)
            .map(|_| rand::RngExt::random_range(&mut rng, -2.0..2.0))
            .collect();
        for hidden in [&[][..], &[1], &[8], &[5], &[32, 16], &[6, 3], &[4, 7, 2]] {
            let mlp = random_mlp(hidden, 9);
            let reference = mlp.forward_batch::<f32>(&rows);
            for format in SHADERS {
                let text = source(&mlp, format);
                let module = parse(format, &text).unwrap_or_else(|e| panic!("{format:?} {hidden:?}: {e}"));
                weights(format, &constants(&module).unwrap(), &mlp).unwrap();
                literal_indices(&module).unwrap();
                let out = Interpreter::new(&module).call_rows(ENTRY, &rows, 7).unwrap();
                for (o, r) in out.iter().zip(&reference) {
                    match format {
                        // The plain form adds in the reference's order: the same bits.
                        Format::WGSL_PLAIN | Format::GLSL_PLAIN => {
                            assert_eq!(o.to_bits(), r.to_bits(), "{format:?} {hidden:?}")
                        }
                        _ => assert!((o - r).abs() < 2e-6, "{format:?} {hidden:?}: {o} {r}"),
                    }
                }
                if let Some(result) = text.contains("float nmt").then(|| glslang(&text)).flatten() {
                    result.unwrap();
                }
            }
        }
    }

    /// With hidden layers in f16 the plain form computes our own pass to the bit; the packed one sums in another order.
    /// Control: f32.
    #[test]
    fn halves_of_every_size_compute_our_own_pass() {
        let mut rng = stream(3, 1, 0);
        let rows: Vec<f32> = (0..7 * 300)
            .map(|_| rng.random_range(-2.0..2.0))
            .chain([1e4, -1e4, 70.0, 0.0, 1e-39, -3e-6, 0.1])
            .collect();
        for hidden in [&[][..], &[1], &[8], &[5], &[32, 16], &[6, 3], &[4, 7, 2]] {
            let mlp = random_mlp(hidden, 9);
            let ours = super::super::half::forward_batch(&mlp, half_limit(&mlp).unwrap(), &rows);
            for format in HALVES {
                let module =
                    parse(format, &source(&mlp, format)).unwrap_or_else(|e| panic!("{format:?} {hidden:?}: {e}"));
                weights(format, &constants(&module).unwrap(), &mlp).unwrap();
                literal_indices(&module).unwrap();
                let out = Interpreter::new(&module).call_rows(ENTRY, &rows, 7).unwrap();
                let worst = out
                    .iter()
                    .zip(&ours)
                    .map(|(a, b)| if near(*a, *b, 9.0) { (a - b).abs() } else { 9.0 })
                    .fold(0.0, f32::max);
                assert!(
                    worst <= if format == Format::WGSL_PLAIN_F16 { 0.0 } else { 2e-2 },
                    "{format:?} {hidden:?}: {worst}"
                );
                // What asks for f16 is not taken for f32, and does not compute it.
                assert!(parse(Format::WGSL, &source(&mlp, format)).is_err() != hidden.is_empty());
                let single = mlp.forward_batch::<f32>(&rows);
                assert!(out.iter().zip(&single).any(|(a, b)| (a - b).abs() > 1e-4) != hidden.is_empty());
            }
        }
    }

    #[test]
    fn one_changed_bit_is_found() {
        let mlp = random_mlp(&[6, 3], 2);
        let text = mlp.layers().iter().map(|l| (l.weights[1], l.biases[0]));
        for (weight, bias) in text {
            for value in [weight, bias] {
                for format in SHADERS {
                    let changed = source(&mlp, format).replacen(
                        &format!("{value:?}"),
                        &format!("{:?}", f32::from_bits(value.to_bits() ^ 1)),
                        1,
                    );
                    let module = parse(format, &changed).unwrap();
                    let message = weights(format, &constants(&module).unwrap(), &mlp).unwrap_err();
                    assert!(message.contains("the network has"), "{message}");
                }
            }
        }
    }

    #[test]
    fn broken_text_and_run_time_indices_are_found() {
        let text = source(&random_mlp(&[4], 1), Format::WGSL);
        assert!(parse(Format::WGSL, &text[..text.len() / 2]).is_err());
        assert!(parse(Format::GLSL, &text).is_err());
        let indexed = parse(
            Format::WGSL,
            "const W = array<f32, 2>(1.0, 2.0); fn f(i: u32) -> f32 { return W[i]; }",
        )
        .unwrap();
        assert_eq!(
            literal_indices(&indexed),
            Err("function 'f' has a run-time index".to_owned())
        );
    }

    /// DWB22's features: depths in the range, at its ends, outside, and where it is empty; and the network behind them.
    #[test]
    fn the_features_of_deep_weighted_blended_and_their_network() {
        use crate::features::{FeatureSet, deep_weighted_blended::LinearRange};
        use crate::model::{Dense, Provenance};
        use crate::pixel::ViewZ;
        let layer = Dense::new(3, 1, vec![-2.0, 0.25, 0.125], vec![0.5]).unwrap();
        let mlp = Mlp::new(
            "deep",
            FeatureSet::DeepWeightedBlended,
            vec![layer],
            Provenance::default(),
        )
        .unwrap();
        for format in SHADERS {
            let text = source(&mlp, format);
            let module = parse(format, &text).unwrap();
            weights(format, &constants(&module).unwrap(), &mlp).unwrap();
            let interpreter = Interpreter::new(&module);
            for (v, v0, v1) in [
                (3.0, 2.0, 6.0),
                (2.0, 2.0, 6.0),
                (6.0, 2.0, 6.0),
                (1.0, 2.0, 6.0),
                (9.0, 2.0, 6.0),
                (2.0, 2.0, 2.0),
            ] {
                let arguments = [v, v0, v1, 1.5, 4.0].map(|x| Value::<1>::Uniform(x as f32)).to_vec();
                let found = interpreter.call("nmt_features", arguments).unwrap().flatten().unwrap();
                let depth = LinearRange::new(ViewZ(v0), ViewZ(v1)).unwrap().relative(ViewZ(v)) as f32;
                assert_eq!(found, [depth, 1.5, 4.0], "{format:?} at {v}");
                let out = interpreter.call_rows(ENTRY, &found, 3).unwrap()[0];
                assert!((out - mlp.forward::<f32>(&found)).abs() < 1e-6);
            }
            if let Some(result) = text.contains("float nmt").then(|| glslang(&text)).flatten() {
                result.unwrap();
            }
        }
    }

    /// The shaders' feature functions against the f64 features of random pixels. Tolerance 3e-7 + 1e-6 relative: f32
    /// depths in, a few operations. Control: without the least depth (w_min = 0) they are off.
    #[test]
    fn feature_functions_compute_the_features() {
        use crate::pixel::{Pixel, ViewZ, absorbance};
        let mlp = random_mlp(&[4], 1);
        let synth = crate::synth::Synth::new(crate::synth::SynthConfig::paper(), 4).unwrap();
        let list = synth.pixels(crate::synth::Purpose::Evaluation, 0, 40);
        let planes = list.planes().unwrap();
        for format in [Format::WGSL, Format::GLSL] {
            let module = parse(format, &source(&mlp, format)).unwrap();
            let interpreter = Interpreter::new(&module);
            let number = |v: f64| Value::<1>::Uniform(v as f32);
            let one =
                |name: &str, arguments: Vec<Value<1>>| interpreter.call(name, arguments).unwrap().flatten().unwrap();
            for p in 0..list.pixels() {
                let pixel: Pixel<'_> = list.pixel(p);
                let mut expected = vec![0.0; 7 * pixel.len()];
                paper::extract(pixel, planes, &mut expected).unwrap();
                let w: Vec<f64> = pixel
                    .view_z
                    .iter()
                    .map(|&v| planes.window(ViewZ(v.into())).unwrap().0)
                    .collect();
                let (lo, hi) = w
                    .iter()
                    .fold((f64::INFINITY, 0.0f64), |(lo, hi), &w| (lo.min(w), hi.max(w)));
                // Pass 1 in the shader's own functions.
                let mut b = [0.0f32; 5];
                for (&w, &alpha) in w.iter().zip(pixel.alpha) {
                    let a = one("nmt_absorbance", vec![number(alpha.into())])[0];
                    assert!((f64::from(a) - absorbance(alpha)).abs() <= 1e-7 + 3e-7 * absorbance(alpha));
                    b[0] += a;
                    let moments = one("nmt_moments", vec![number(w), Value::Uniform(a)]);
                    b[1..].iter_mut().zip(moments).for_each(|(b, m)| *b += m);
                }
                for (row, &w) in expected.chunks_exact(7).zip(&w) {
                    let call = |lo: f64| {
                        let head = [w, lo, hi, pixel.len() as f64].map(number);
                        one(
                            "nmt_features",
                            head.into_iter()
                                .chain([Value::Uniform(b[0]), Value::numbers(&b[1..])])
                                .collect(),
                        )
                    };
                    let off = |found: Vec<f32>| {
                        let scale = |k: usize, e: f32| if k < 2 { 3e-7 + 1e-6 * e.abs() } else { 1e-6 * row[2] };
                        found
                            .iter()
                            .zip(row)
                            .enumerate()
                            .any(|(k, (f, &e))| (f - e).is_nan() || (f - e).abs() > scale(k, e))
                    };
                    assert!(!off(call(lo)), "{format:?}: {:?} against {row:?}", call(lo));
                    assert!(row[0] >= 1.0 || off(call(0.0)));
                }
            }
            // One fragment, or all tied: d = 0.
            let tied = one(
                "nmt_features",
                [0.5, 0.5, 0.5, 1.0, 1.0]
                    .map(number)
                    .into_iter()
                    .chain([Value::numbers(&[0.0; 4])])
                    .collect(),
            );
            assert_eq!(tied[0], 0.0);
        }
    }

    /// The functions of the recentred features in both languages against their Rust twin in f32, for 4, 6 and 8
    /// moments: what is known, to 2e-6, and the features, to what one ulp of the moments makes of them. Control:
    /// swapped ends of the pixel.
    #[test]
    fn recentred_shaders_follow_their_twin() {
        fn compare<const K: usize>(set: FeatureSet) {
            let mlp = Mlp::new("r", set, random_layers(set.width()), Provenance::default()).unwrap();
            for format in [Format::WGSL, Format::GLSL] {
                let module = parse(format, &source(&mlp, format)).unwrap_or_else(|e| panic!("{e}"));
                let interpreter = Interpreter::new(&module);
                let one = |name: &str, arguments: Vec<Value<1>>| {
                    interpreter.call(name, arguments).unwrap().flatten().unwrap()
                };
                let mut rng = stream(5, 91, K as u64);
                let (mut known, mut evaluated, mut controls) = (0, 0, 0);
                for round in 0..300 {
                    let n = 1 + round % 12;
                    let v: Vec<f32> = (0..n).map(|_| rng.random_range(2.0..8.0)).collect();
                    let alpha: Vec<f32> = (0..n).map(|_| rng.random_range(0.02..0.95)).collect();
                    let mut sums = PixelSums::<f32, K>::default();
                    let terms: Vec<FragmentTerms<f32>> = (0..n)
                        .map(|i| {
                            let z = one(
                                "nmt_moment_depth",
                                vec![Value::Uniform(v[i]), Value::Uniform(1.0), Value::Uniform(10.0)],
                            )[0];
                            let exact = LogWarp::new(ViewZ(1.0), ViewZ(10.0))
                                .unwrap()
                                .moment(ViewZ(v[i].into()))
                                .0;
                            assert!((f64::from(z) - exact).abs() < 1e-6);
                            let absorbance = one("nmt_absorbance", vec![Value::Uniform(alpha[i])])[0];
                            FragmentTerms {
                                view_z: v[i],
                                z,
                                absorbance,
                            }
                        })
                        .collect();
                    for s in &terms {
                        sums.add(*s);
                        let moments = one("nmt_moments", vec![Value::Uniform(s.z), Value::Uniform(s.absorbance)]);
                        // Vectors of four, the last filled up with 0.
                        assert!(moments.len() == K.next_multiple_of(4) && moments[K..].iter().all(|&m| m == 0.0));
                        assert!(
                            moments[..K]
                                .iter()
                                .enumerate()
                                .all(|(k, m)| (m - s.absorbance * s.z.powi(k as i32 + 1)).abs() <= 1e-6 * s.absorbance)
                        );
                    }
                    let end = |at: f32| terms.iter().find(|s| s.view_z == at).unwrap().z;
                    let ends = [end(sums.nearest), end(sums.farthest)];
                    for s in &terms {
                        let arguments = |ends: [f32; 2]| -> Vec<Value<1>> {
                            let head = [
                                s.view_z,
                                s.z,
                                s.absorbance,
                                sums.nearest,
                                sums.farthest,
                                ends[0],
                                ends[1],
                                n as f32,
                                sums.b0,
                            ];
                            head.into_iter()
                                .map(Value::Uniform)
                                .chain([Value::numbers(&sums.b)])
                                .collect()
                        };
                        let found = one("nmt_recentred", arguments(ends));
                        let answer = one("nmt_fragment_transmittance", arguments(ends))[0];
                        let off = |found: &[f32]| match sums.classify(*s, ends) {
                            Pass2Input::Solved(t) => !near(found[set.width()], t, 2e-6),
                            Pass2Input::Query(first, measure) => {
                                let expected = first.iter().chain(&measure);
                                found[set.width()] >= 0.0
                                    || expected
                                        .enumerate()
                                        .any(|(k, &e)| !near(found[k], e, if k < 5 { 1e-5 } else { 1e-2 }))
                            }
                        };
                        assert!(
                            !off(&found),
                            "{format:?} K = {K} n = {n}: {found:?} for {:?}",
                            sums.classify(*s, ends)
                        );
                        match sums.classify(*s, ends) {
                            Pass2Input::Solved(t) => {
                                known += 1;
                                assert!((answer - t).abs() <= 2e-6);
                            }
                            Pass2Input::Query(first, measure) => {
                                evaluated += 1;
                                let row: Vec<f32> = first.into_iter().chain(measure).collect();
                                assert!((answer - mlp.forward::<f32>(&row)).abs() <= 0.05, "{answer}");
                                controls += usize::from(off(&one("nmt_recentred", arguments([ends[1], ends[0]]))));
                            }
                        }
                    }
                }
                assert!(
                    known > 300 && evaluated > 300 && controls > evaluated / 2,
                    "{known} known, {evaluated} evaluated, {controls} controls failed"
                );
            }
        }
        compare::<4>(FeatureSet::Recentred);
        compare::<6>(FeatureSet::Recentred6);
        compare::<8>(FeatureSet::Recentred8);
    }

    /// `nmt_fragment_transmittance`, which branches, against `nmt_recentred`, which computes everything, with
    /// `nmt_transmittance` behind it: known answers to the bit, the network's to 1e-6, for pixels of every kind of
    /// answer, ties, thin and nearly opaque ones. Control: what is known taken for unknown.
    #[test]
    fn early_answers_are_those_of_the_whole_computation() {
        fn compare<const K: usize>(set: FeatureSet) {
            let mlp = Mlp::new("r", set, random_layers(set.width()), Provenance::default()).unwrap();
            for format in [Format::WGSL, Format::GLSL_PLAIN] {
                let module = parse(format, &source(&mlp, format)).unwrap_or_else(|e| panic!("{e}"));
                let interpreter = Interpreter::new(&module);
                let one = |name: &str, arguments: Vec<Value<1>>| {
                    interpreter.call(name, arguments).unwrap().flatten().unwrap()
                };
                let mut rng = stream(5, 93, K as u64);
                // Answers by kind: nearest or hardly any others, farthest, three, four, the network.
                let (mut kinds, mut controls) = ([0; 5], 0);
                for round in 0..400 {
                    let n = 1 + round % 8;
                    let half = 10f32.powf(rng.random_range(-4.0..-0.3));
                    let least = if round % 9 == 0 { 0.999 } else { 0.001 };
                    let mut pixel: Vec<FragmentTerms<f32>> = (0..n)
                        .map(|_| {
                            let z = rng.random_range(-half..half) + 0.3;
                            FragmentTerms {
                                view_z: z.exp(),
                                z,
                                absorbance: -(1.0f32 - rng.random_range(least..0.9999)).ln(),
                            }
                        })
                        .collect();
                    if round % 5 == 0 {
                        pixel[n / 2] = pixel[0];
                    }
                    let mut sums = PixelSums::<f32, K>::default();
                    pixel.iter().for_each(|&s| sums.add(s));
                    let end = |at: f32| pixel.iter().find(|s| s.view_z == at).unwrap().z;
                    let ends = [end(sums.nearest), end(sums.farthest)];
                    for s in &pixel {
                        let head = [
                            s.view_z,
                            s.z,
                            s.absorbance,
                            sums.nearest,
                            sums.farthest,
                            ends[0],
                            ends[1],
                            n as f32,
                            sums.b0,
                        ];
                        let arguments: Vec<Value<1>> = head
                            .into_iter()
                            .map(Value::Uniform)
                            .chain([Value::numbers(&sums.b)])
                            .collect();
                        let whole = one("nmt_recentred", arguments.clone());
                        let (features, known) = (&whole[..set.width()], whole[set.width()]);
                        let network = one(ENTRY, vec![Value::numbers(features)])[0];
                        let answer = one("nmt_fragment_transmittance", arguments)[0];
                        // The one takes the other absorbance from its logarithm, the other as it is.
                        let expected = if known >= 0.0 { known } else { network };
                        let bar = if known >= 0.0 { 0.0 } else { 1e-6 };
                        assert!(
                            near(answer, expected, bar),
                            "{format:?} K = {K} n = {n}: {answer} for {expected}"
                        );
                        controls += usize::from(known >= 0.0 && answer != network);
                        kinds[match () {
                            () if known < 0.0 => 4,
                            () if known == 1.0 => 0,
                            () if s.view_z == sums.farthest => 1,
                            () => n - 1,
                        }
                        .min(4)] += 1;
                    }
                }
                assert!(
                    kinds.iter().all(|&k| k > 20) && controls > 300,
                    "{kinds:?}, {controls} controls"
                );
            }
        }
        compare::<4>(FeatureSet::Recentred);
        compare::<6>(FeatureSet::Recentred6);
        compare::<8>(FeatureSet::Recentred8);
    }

    /// `nmt_hidden_weight` and `nmt_first_hidden_depth` against their scalar twins and the truth, for adversarial
    /// pixels, 4, 6 and 8 moments. No fragment and all behind it weigh more in f64 than the shader says, asked about it
    /// or about its depth; what the f64 twin hides with twice the noise and a weight of a tenth less, the shader hides;
    /// the depth is the f32 twin's to 1e-5. `nmt_visible_transmittance` is made of these to the bit, and each switch
    /// turns off its own rule alone. Control: with a quarter of the share behind, weights are too small.
    #[test]
    fn shaders_hide_what_their_twin_hides() {
        use crate::export::recentred::{FAINT_SWITCH, HIDDEN_SWITCH};
        use crate::features::recentred;
        use crate::features::visible::{FAINT, HIDDEN, Noise, first_hidden_depth, hidden_weight, most_behind};
        use crate::numeric::real::Divisor;
        fn compare<const K: usize>(set: FeatureSet, pixels: usize) {
            let mlp = Mlp::new("r", set, random_layers(set.width()), Provenance::default()).unwrap();
            let list = crate::infer::passes::tests::pixels(&mut stream(7, 95, K as u64), pixels);
            let range = list.depth_range().map(|(v0, v1)| [v0, v1]).unwrap();
            for format in [Format::WGSL, Format::GLSL] {
                let text = source(&mlp, format);
                let off = |name: &str, value: f32| {
                    let number = format!("{value:?}");
                    let at = text
                        .find(&format!("{name} = {number}"))
                        .or_else(|| text.find(&format!("{name}: f32 = {number}")))
                        .unwrap();
                    let end = at + text[at..].find(';').unwrap();
                    format!(
                        "{}{}{}",
                        &text[..at],
                        text[at..end].replace(&number, "0.0"),
                        &text[end..]
                    )
                };
                let halved = text.replace("min(share1, share2) * 1.00001", "min(share1, share2) * 0.25");
                assert_ne!(halved, text);
                let modules = [
                    text.clone(),
                    off(FAINT_SWITCH, FAINT),
                    off(HIDDEN_SWITCH, HIDDEN),
                    halved,
                ]
                .map(|text| parse(format, &text).unwrap());
                let one = |module: usize, name: &str, arguments: Vec<Value<1>>| {
                    Interpreter::new(&modules[module])
                        .call(name, arguments)
                        .unwrap()
                        .flatten()
                        .unwrap()[0]
                };
                let (mut weighed, mut hidden, mut faint, mut plain, mut controls) = (0, 0, 0, 0, 0);
                for p in 0..list.pixels() {
                    let pixel = list.pixel(p);
                    let n = pixel.len();
                    let terms: Vec<FragmentTerms<f32>> = pixel
                        .view_z
                        .iter()
                        .zip(pixel.alpha)
                        .map(|(&view_z, &alpha)| FragmentTerms {
                            view_z,
                            z: recentred::moment_depth(view_z, range),
                            absorbance: recentred::absorbance(alpha),
                        })
                        .collect();
                    let mut sums = PixelSums::<f32, K>::default();
                    terms.iter().for_each(|&s| sums.add(s));
                    if n < 5 || sums.nearest == sums.farthest {
                        continue;
                    }
                    let ends = [sums.nearest, sums.farthest].map(|v| recentred::moment_depth(v, range));
                    let from = one(
                        0,
                        "nmt_first_hidden_depth",
                        [sums.b0, sums.b[0], sums.b[1]].map(Value::Uniform).to_vec(),
                    );
                    let twin = first_hidden_depth(sums.b0, sums.b[0], sums.b[1]);
                    assert!(
                        near(from, twin, 1e-5) || (from > 1e38 && twin > 1e38),
                        "{from} for {twin}"
                    );
                    let exact: Vec<[f64; 2]> = terms
                        .iter()
                        .map(|s| {
                            let z: f64 = recentred::moment_depth(s.view_z.into(), range.map(f64::from));
                            [z, s.absorbance.into()]
                        })
                        .collect();
                    let [z0, z1] = [sums.nearest, sums.farthest]
                        .map(|v| recentred::moment_depth(f64::from(v), range.map(f64::from)));
                    let (c, h) = (0.5 * (z0 + z1), (0.5 * (z1 - z0)).max(1e-8));
                    // Long pixels are looked at here and there, to keep the test short.
                    for (i, s) in terms.iter().enumerate().step_by(1 + n / 12) {
                        let others32 = sums.b0 - s.absorbance;
                        let end = s.view_z == sums.nearest || s.view_z == sums.farthest || others32 <= 1e-6 * sums.b0;
                        let head = [s.z, s.absorbance, ends[0], ends[1], n as f32, sums.b0];
                        let weighing: Vec<Value<1>> = head
                            .into_iter()
                            .map(Value::Uniform)
                            .chain([Value::numbers(&sums.b)])
                            .collect();
                        let head = [
                            s.view_z,
                            s.z,
                            s.absorbance,
                            sums.nearest,
                            sums.farthest,
                            ends[0],
                            ends[1],
                            n as f32,
                            sums.b0,
                        ];
                        let looking: Vec<Value<1>> = head
                            .into_iter()
                            .map(Value::Uniform)
                            .chain([Value::numbers(&sums.b)])
                            .collect();
                        let answers =
                            [0, 1, 2].map(|module| one(module, "nmt_visible_transmittance", looking.clone()).to_bits());
                        let whole = one(0, "nmt_fragment_transmittance", looking).to_bits();
                        let is_faint = !end && sums.b0 <= FAINT;
                        let mut is_hidden = false;
                        if !end && s.z >= from {
                            let weight = one(0, "nmt_hidden_weight", weighing.clone());
                            is_hidden = weight <= HIDDEN;
                            // By view depth, which says what is in front: moment depths may tie.
                            let behind = |j: usize| pixel.view_z[j] >= s.view_z;
                            let front: f64 = (0..n).filter(|&j| !behind(j)).map(|j| exact[j][1]).sum();
                            let absorbed: f64 = (0..n).filter(|&j| behind(j)).map(|j| exact[j][1]).sum();
                            let least = (-front).exp() * absorbed.min(n as f64 - 2.0);
                            assert!(
                                f64::from(weight) >= least * (1.0 - 1e-6) - 1e-37,
                                "{weight} for {least}"
                            );
                            // A depth with nothing of its own, for all that lies from there on.
                            let mut depth = weighing.clone();
                            depth[1] = Value::Uniform(0.0);
                            let depth = one(0, "nmt_hidden_weight", depth);
                            assert!(
                                f64::from(depth) >= least * (1.0 - 1e-6) - 1e-37,
                                "{depth} for {least} from a depth on"
                            );
                            weighed += 1;
                            controls += usize::from(f64::from(one(3, "nmt_hidden_weight", weighing)) < least);
                            let others: f64 = (0..n).filter(|&j| j != i).map(|j| exact[j][1]).sum();
                            let place = |z: f64| ((z - c) / h).clamp(-1.0, 1.0);
                            let m: [f64; 4] = std::array::from_fn(|k| {
                                (0..n)
                                    .filter(|&j| j != i)
                                    .map(|j| exact[j][1] * place(exact[j][0]).powi(k as i32 + 1))
                                    .sum::<f64>()
                                    / others
                            });
                            let growth = 1.0 + 2.0 * c.abs() / h;
                            let unit = f64::from(f32::EPSILON);
                            let noise =
                                Noise::of(n as f64, sums.b0.into(), others32.into(), Divisor::new(h), growth, unit);
                            let noise = Noise {
                                moments: 2.0 * noise.moments,
                                growth,
                                position: 2.0 * noise.position,
                                depth: 2.0 * noise.depth,
                            };
                            let twin = hidden_weight(
                                others,
                                exact[i][1],
                                n as f64,
                                most_behind(place(exact[i][0]), m, &noise),
                                &noise,
                            );
                            assert!(is_hidden || twin > 0.9 * f64::from(HIDDEN), "{weight} for {twin}");
                        }
                        // Exponentials are a few ulp apart; what the network answers is the same call.
                        let is = |found: u32, depth: Option<f32>| match depth {
                            Some(depth) => near(f32::from_bits(found), (-depth).exp().min(1.0), 1e-6 * (-depth).exp()),
                            None => found == whole,
                        };
                        let expected = match () {
                            () if is_faint => [Some(0.5 * others32), None, Some(0.5 * others32)],
                            () if is_hidden => [Some(others32), Some(others32), None],
                            () => [None; 3],
                        };
                        let right = answers.into_iter().zip(expected).all(|(found, depth)| is(found, depth));
                        assert!(
                            right,
                            "{format:?}: {:?} for {expected:?}, faint {is_faint}, hidden {is_hidden}",
                            answers.map(f32::from_bits)
                        );
                        hidden += usize::from(is_hidden);
                        faint += usize::from(is_faint);
                        plain += usize::from(!is_faint && !is_hidden);
                    }
                }
                println!(
                    "{format:?} K = {K}: {weighed} weighed, {hidden} hidden, {faint} faint, {plain} plain, {controls} \
                        controls"
                );
                assert!(
                    weighed > 50 && hidden > 20 && faint > 20 && plain > 100 && controls > 2,
                    "{weighed} {hidden} {faint} {plain} {controls}"
                );
            }
        }
        compare::<4>(FeatureSet::Recentred, 700);
        compare::<6>(FeatureSet::Recentred6, 300);
        compare::<8>(FeatureSet::Recentred8, 300);
    }

    /// Whether two numbers are no further apart than that; false for NaN.
    fn near(a: f32, b: f32, bar: f32) -> bool {
        (a - b).abs() <= bar
    }

    fn random_layers(width: usize) -> Vec<Dense> {
        let mut rng = stream(6, 91, 0);
        let mut numbers = |n: usize| (0..n).map(|_| rng.random_range(-0.7f32..0.7)).collect::<Vec<_>>();
        vec![
            Dense::new(width, 6, numbers(6 * width), numbers(6)).unwrap(),
            Dense::new(6, 1, numbers(6), numbers(1)).unwrap(),
        ]
    }
}
