//! HLSL exports: read back from their text, compiled by two front ends, and executed as the WGSL that slangc makes of
//! them.

use super::shader::{Constants, glslang_hlsl, literals};
use crate::export::dialect::Hlsl;
use crate::export::shader::ENTRY;
use crate::numeric::source::Dialect;
use std::path::PathBuf;
use std::process::Command;

/// Environment variable that names slangc.
pub const SLANGC_VARIABLE: &str = "NMT_SLANGC";

/// Entry point of [`with_rows`].
pub const ROWS: &str = "nmt_hlsl_rows";

/// Constants that hold weights, from the text: the numbers between the braces of every `static const` whose name begins
/// with `NMT_`.
///
/// # Errors
/// Names the constant that is not made of literals.
pub fn constants(text: &str) -> Result<Constants, String> {
    let mut out = Constants::new();
    for declaration in text.split("static const ").skip(1) {
        let declaration = declaration.split(';').next().unwrap_or_default();
        let (head, value) = declaration.split_once('=').ok_or("a constant without a value")?;
        let name = head
            .split_whitespace()
            .nth(1)
            .and_then(|n| n.split('[').next())
            .unwrap_or_default();
        out.push((name.to_owned(), literals(value).map_err(|e| format!("{name}: {e}"))?));
    }
    Ok(out)
}

/// Checks that every index in the text is a literal.
///
/// # Errors
/// Names the line that has one that is not.
pub fn literal_indices(text: &str) -> Result<(), String> {
    let code = |line: &str| line.split("//").next().unwrap_or_default().to_owned();
    let literal = |line: &str| {
        line.split('[').skip(1).all(|rest| {
            rest.split(']')
                .next()
                .is_some_and(|i| i.chars().all(|c| c.is_ascii_digit()))
        })
    };
    match text.lines().map(code).position(|line| !literal(&line)) {
        None => Ok(()),
        Some(at) => Err(format!("line {} has a run-time index", at + 1)),
    }
}

/// The include file with a compute shader behind it that answers rows of features.
pub fn with_rows(text: &str, width: usize) -> String {
    let loads: Vec<String> = (0..width).map(|i| format!("nmt_in[{width} * id.x + {i}]")).collect();
    format!(
        "{text}
StructuredBuffer<float> nmt_in;
RWStructuredBuffer<float> nmt_out;

[numthreads(64, 1, 1)]
void {ROWS}(uint3 id : SV_DispatchThreadID) {{
    nmt_out[id.x] = {ENTRY}({});
}}
",
        Hlsl.numbers(&loads)
    )
}

/// Runs glslangValidator on a whole compute shader; none where the program is not installed.
///
/// # Errors
/// Its own words.
pub fn glslang(shader: &str) -> Option<Result<(), String>> {
    let folder = match tempfile::tempdir() {
        Ok(folder) => folder,
        Err(error) => return Some(Err(error.to_string())),
    };
    glslang_hlsl(shader, ROWS, &folder.path().join("export.spv"))
}

/// Where slangc is: what `NMT_SLANGC` names, or the one on the path.
///
/// # Errors
/// In words, what to do about it.
pub fn slangc() -> Result<PathBuf, String> {
    match std::env::var_os(SLANGC_VARIABLE)
        .filter(|v| !v.is_empty())
        .map(PathBuf::from)
    {
        Some(path) if path.is_file() => Ok(path),
        Some(path) => Err(format!(
            "{SLANGC_VARIABLE} names {}, which is not a file",
            path.display()
        )),
        None => match Command::new("slangc").arg("-v").output() {
            Ok(_) => Ok(PathBuf::from("slangc")),
            Err(_) => Err(format!(
                "not found: set {SLANGC_VARIABLE} to slangc, for example the one inside PyPI's slangtorch wheel"
            )),
        },
    }
}

/// Compiles a whole HLSL compute shader to WGSL; functions keep their names, with a number behind them.
///
/// # Errors
/// slangc's own words.
pub fn to_wgsl(slangc: &std::path::Path, shader: &str, entry: &str) -> Result<String, String> {
    let folder = tempfile::tempdir().map_err(|e| e.to_string())?;
    let (from, to) = (folder.path().join("export.hlsl"), folder.path().join("export.wgsl"));
    std::fs::write(&from, shader).map_err(|e| e.to_string())?;
    let run = Command::new(slangc)
        .args([
            "-lang", "hlsl", "-target", "wgsl", "-entry", entry, "-stage", "compute", "-o",
        ])
        .arg(&to)
        .arg(&from)
        .output();
    super::shader::verdict("slangc", run)?;
    std::fs::read_to_string(&to).map_err(|e| format!("slangc wrote no WGSL: {e}"))
}

#[cfg(test)]
mod tests {
    use super::super::interpret::{Interpreter, Value};
    use super::super::shader::{parse, weights};
    use super::super::{half, shader};
    use super::*;
    use crate::export::shader::half_limit;
    use crate::export::{Format, encode, translate};
    use crate::features::FeatureSet;
    use crate::model::mlp::tests::random_mlp;
    use crate::model::{Dense, Mlp, Provenance};
    use crate::numeric::require::or_skip;
    use crate::numeric::rng::stream;
    use crate::numeric::source::{Type, component};
    use rand::RngExt;

    const FORMATS: [Format; 4] = [
        Format::HLSL,
        Format::HLSL_PLAIN,
        Format::HLSL_F16,
        Format::HLSL_PLAIN_F16,
    ];

    fn source(mlp: &Mlp, format: Format) -> String {
        String::from_utf8(encode(mlp, format).unwrap()).unwrap()
    }

    /// slangc; none, reported as skipped, where it is missing.
    fn slang() -> Option<PathBuf> {
        or_skip("slangc", slangc())
    }

    #[test]
    fn weights_are_read_back_and_one_changed_bit_is_found() {
        for hidden in [&[][..], &[5], &[8, 4], &[6, 3]] {
            let mlp = random_mlp(hidden, 2);
            for format in FORMATS {
                let text = source(&mlp, format);
                weights(format, &constants(&text).unwrap(), &mlp)
                    .unwrap_or_else(|e| panic!("{format:?} {hidden:?}: {e}"));
                literal_indices(&text).unwrap();
                let last = mlp.layers().last().unwrap().weights[0];
                let changed = text.replacen(
                    &format!("{last:?}f"),
                    &format!("{:?}f", f32::from_bits(last.to_bits() ^ 1)),
                    1,
                );
                assert!(
                    weights(format, &constants(&changed).unwrap(), &mlp)
                        .unwrap_err()
                        .contains("the network has")
                );
            }
        }
        assert_eq!(
            literal_indices("float a[7];\nx = a[3]; // a[i]\ny = a[i];").unwrap_err(),
            "line 3 has a run-time index"
        );
        assert!(constants("static const float NMT_W1[1] = { 1.0.0 };").is_err());
    }

    /// glslangValidator takes every form, and no undeclared name.
    #[test]
    fn every_form_compiles() {
        for hidden in [&[][..], &[6, 3]] {
            let mlp = random_mlp(hidden, 2);
            for format in FORMATS {
                let whole = with_rows(&source(&mlp, format), 7);
                let Some(result) = glslang(&whole) else {
                    return println!("skipped: glslangValidator is not here");
                };
                result.unwrap();
                assert!(
                    glslang(&whole.replace("= nmt_transmittance(", "= nmt_transmittances("))
                        .unwrap()
                        .is_err()
                );
            }
        }
    }

    /// As slangc reads them, the plain forms compute the reference, and our own pass in f16, to the bit, and the packed
    /// ones sum in another order.
    #[test]
    fn every_form_computes_the_reference() {
        let Some(slangc) = slang() else { return };
        let mut rng = stream(3, 2, 0);
        let rows: Vec<f32> = (0..7 * 200).map(|_| rng.random_range(-2.0..2.0)).collect();
        for hidden in [&[][..], &[12, 5]] {
            let mlp = random_mlp(hidden, 9);
            let single = mlp.forward_batch::<f32>(&rows);
            let halves = half::forward_batch(&mlp, half_limit(&mlp).unwrap(), &rows);
            for format in FORMATS {
                let wgsl = to_wgsl(&slangc, &with_rows(&source(&mlp, format), 7), ROWS).unwrap();
                let (module, _) = translate::parse_wgsl(&wgsl).unwrap();
                let interpreter = Interpreter::new(&module);
                let out = interpreter
                    .call_rows(interpreter.function_like(ENTRY).unwrap(), &rows, 7)
                    .unwrap();
                let (reference, bar) = match format {
                    Format::HLSL_PLAIN => (&single, 0.0),
                    Format::HLSL => (&single, 2e-6),
                    Format::HLSL_PLAIN_F16 => (&halves, 0.0),
                    _ => (&halves, 2e-2),
                };
                assert!(
                    out.iter().zip(reference).all(|(a, b)| (a - b).abs() <= bar),
                    "{format:?} {hidden:?}"
                );
            }
        }
        assert!(to_wgsl(&slangc, "void main() { nonsense }", "main").is_err());
    }

    /// Every function of the HLSL against that of the WGSL, on random arguments: the same bits.
    #[test]
    fn functions_are_those_of_the_wgsl() {
        let Some(slangc) = slang() else { return };
        // What goes before the network of a core is checked where it is written.
        let without_core = FeatureSet::ALL.into_iter().filter(|set| set.spec().core.is_none());
        for set in without_core {
            let (k, width) = (set.moments(), set.width());
            let mut rng = stream(4, 2, k as u64);
            let mut numbers = |n: usize| (0..n).map(|_| rng.random_range(-0.7f32..0.7)).collect::<Vec<_>>();
            let layers = vec![
                Dense::new(width, 6, numbers(6 * width), numbers(6)).unwrap(),
                Dense::new(6, 1, numbers(6), numbers(1)).unwrap(),
            ];
            let mlp = Mlp::new("m", set, layers, Provenance::default()).unwrap();
            // Name, scalar arguments, whether moments follow, and numbers that are given.
            let functions: Vec<(&str, usize, bool, usize)> = match set {
                FeatureSet::Paper => vec![
                    ("nmt_absorbance", 1, false, 1),
                    ("nmt_moments", 2, false, k),
                    ("nmt_features", 5, true, 7),
                ],
                FeatureSet::DeepWeightedBlended => vec![("nmt_features", 5, false, 3)],
                _ => vec![
                    ("nmt_absorbance", 1, false, 1),
                    ("nmt_moment_depth", 3, false, 1),
                    ("nmt_moments", 2, false, k),
                    ("nmt_recentred", 9, true, width + 1),
                    ("nmt_fragment_transmittance", 9, true, 1),
                ],
            };
            let inputs: Vec<String> = (0..k).map(|i| format!("nmt_in[{}]", 9 + i)).collect();
            // A shader that calls them all, so that slangc keeps them.
            let mut body = String::new();
            for (i, &(name, scalars, moments, out)) in functions.iter().enumerate() {
                let mut call: Vec<String> = (0..scalars).map(|s| format!("nmt_in[{s}]")).collect();
                call.extend(moments.then(|| Hlsl.numbers(&inputs)));
                let result = format!("r{i}");
                let sum: Vec<String> = (0..out).map(|o| component(&result, out, o)).collect();
                let statement = Hlsl.let_(Type::Reals(out), &result, &format!("{name}({})", call.join(", ")));
                body += &format!("    {statement}\n    nmt_out[{i}] = {};\n", sum.join(" + "));
            }
            let head = "StructuredBuffer<float> nmt_in;\nRWStructuredBuffer<float> nmt_out;\n[numthreads(1, 1, \
                1)]\nvoid probe() {\n";
            let whole = format!("{}{head}{body}}}\n", source(&mlp, Format::HLSL));
            if let Some(result) =
                shader::glslang_hlsl(&whole, "probe", &tempfile::tempdir().unwrap().path().join("x.spv"))
            {
                result.unwrap();
            }
            let wgsl = to_wgsl(&slangc, &whole, "probe").unwrap_or_else(|e| panic!("{e}\n{whole}"));
            let (hlsl, _) = translate::parse_wgsl(&wgsl).unwrap_or_else(|e| panic!("{e}"));
            let hlsl = Interpreter::new(&hlsl);
            let module = parse(Format::WGSL, &source(&mlp, Format::WGSL)).unwrap();
            let twin = Interpreter::new(&module);
            let mut kinds = [0; 2];
            for round in 0..300 {
                let mut next = |low: f32, high: f32| rng.random_range(low..high);
                let n = (round % 6 + 1) as f32;
                let (near, far) = (next(-0.9, 0.0), next(0.0, 0.9));
                let z = [near, far, next(near, far)][round % 3];
                // Those of nmt_recentred; as good as any for the others.
                let mut scalars = [
                    z.exp(),
                    z,
                    next(0.0, 2.0),
                    near.exp(),
                    far.exp(),
                    near,
                    far,
                    n,
                    next(2.0, 6.0),
                ];
                if !set.spec().exact.ends {
                    scalars = std::array::from_fn(|_| next(0.0, 1.0));
                }
                let b: Vec<f32> = (0..k).map(|_| next(-1.0, 1.0)).collect();
                for &(name, count, moments, _) in &functions {
                    let mut arguments: Vec<Value<1>> = scalars[..count].iter().map(|&x| Value::Uniform(x)).collect();
                    arguments.extend(moments.then(|| Value::numbers(&b)));
                    let expected = twin.call(name, arguments.clone()).unwrap().flatten().unwrap();
                    let function = hlsl.function_like(name).unwrap();
                    let found = hlsl
                        .call(function, arguments)
                        .unwrap_or_else(|e| panic!("{set:?} {name}: {e}\n{wgsl}"))
                        .flatten()
                        .unwrap();
                    let bits = |x: &[f32]| x.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
                    assert_eq!(
                        bits(&found),
                        bits(&expected),
                        "{set:?} {name} of {scalars:?}, {b:?}: {found:?} for {expected:?}"
                    );
                    if name == "nmt_recentred" {
                        kinds[usize::from(expected[width] < 0.0)] += 1;
                    }
                }
            }
            assert!(functions.len() < 5 || kinds.iter().all(|&k| k > 30), "{kinds:?}");
        }
    }
}
