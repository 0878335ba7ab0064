//! MSL and SPIR-V exports, which naga made: weights read back from what stands there, SPIR-V validated. Neither is
//! executed here.

use super::shader::{Constants, literals, run_on, verdict};
use crate::export::translate::instructions;
use std::collections::HashMap;
use std::ffi::OsStr;

/// Constants that hold weights, from MSL text; naga puts an underscore behind names that end in a digit.
///
/// # Errors
/// Names the constant that is not made of literals.
pub fn metal_constants(text: &str) -> Result<Constants, String> {
    let declarations = text
        .lines()
        .filter_map(|line| line.strip_prefix("constant ")?.split_once(" = "));
    declarations
        .map(|(head, value)| {
            let name = head
                .split_whitespace()
                .last()
                .unwrap_or_default()
                .trim_end_matches('_')
                .to_owned();
            Ok((name.clone(), literals(value).map_err(|e| format!("{name}: {e}"))?))
        })
        .collect()
}

/// Checks that the network's function uses the constants: naga writes their parts out where they are used, in order.
///
/// # Errors
/// Names the constant that is not used as it stands.
pub fn metal_uses(text: &str, constants: &Constants, entry: &str) -> Result<(), String> {
    let body = text
        .split(&format!("float {entry}("))
        .nth(1)
        .and_then(|t| t.split("\n}").next())
        .ok_or_else(|| format!("there is no {entry}"))?;
    let mut found = literals(body)?.into_iter().filter(|x| *x != 0.0);
    for (name, numbers) in constants {
        // Biases that are added between blocks of weights are found by name or not at all: what is in order are
        // weights.
        let named = body
            .match_indices(name.as_str())
            .any(|(at, _)| !body[at + name.len()..].starts_with(|c: char| c.is_ascii_alphanumeric()));
        if name.starts_with("NMT_W")
            && !named
            && !numbers
                .iter()
                .filter(|x| **x != 0.0)
                .all(|x| found.any(|f| f.to_bits() == x.to_bits()))
        {
            return Err(format!("{entry} does not use {name} as it stands"));
        }
    }
    Ok(())
}

/// The number that a half is.
fn half_from_bits(bits: u32) -> f32 {
    let (exponent, fraction) = ((bits >> 10) & 0x1f, (bits & 0x3ff) as f32);
    let magnitude = match exponent {
        0 => fraction / (1u32 << 24) as f32,
        31 => f32::NAN,
        _ => (1.0 + fraction / 1024.0) * libm::exp2f(exponent as f32 - 15.0),
    };
    if bits & 0x8000 == 0 { magnitude } else { -magnitude }
}

/// Constants that hold weights, from the instructions of a SPIR-V module.
///
/// # Errors
/// In words, where the bytes are no module, or a constant is not made of numbers.
pub fn spirv_constants(bytes: &[u8]) -> Result<Constants, String> {
    const NAME: u32 = 5;
    const TYPE_FLOAT: u32 = 22;
    const CONSTANT: u32 = 43;
    const COMPOSITE: u32 = 44;
    let instructions = instructions(bytes).ok_or("not a SPIR-V module")?;
    let (mut widths, mut numbers, mut names) = (HashMap::new(), HashMap::<u32, Vec<f32>>::new(), Vec::new());
    for (op, operands) in &instructions {
        match (*op, operands.as_slice()) {
            (NAME, [id, text @ ..]) => {
                let text: Vec<u8> = text
                    .iter()
                    .flat_map(|w| w.to_le_bytes())
                    .take_while(|&b| b != 0)
                    .collect();
                names.push((*id, String::from_utf8_lossy(&text).into_owned()));
            }
            (TYPE_FLOAT, [id, width, ..]) => {
                widths.insert(*id, *width);
            }
            (CONSTANT, [ty, id, word]) => match widths.get(ty) {
                Some(32) => drop(numbers.insert(*id, vec![f32::from_bits(*word)])),
                Some(16) => drop(numbers.insert(*id, vec![half_from_bits(*word)])),
                _ => {}
            },
            (COMPOSITE, [_, id, parts @ ..]) => {
                let whole: Option<Vec<Vec<f32>>> = parts.iter().map(|part| numbers.get(part).cloned()).collect();
                if let Some(whole) = whole {
                    numbers.insert(*id, whole.concat());
                }
            }
            _ => {}
        }
    }
    let weights = names.into_iter().filter(|(_, name)| name.starts_with("NMT_"));
    weights
        .map(|(id, name)| {
            numbers
                .remove(&id)
                .map(|n| (name.clone(), n))
                .ok_or(format!("'{name}' is not made of numbers"))
        })
        .collect()
}

/// Runs spirv-val on a module; none where the program is not installed.
///
/// # Errors
/// Its own words.
pub fn spirv_val(bytes: &[u8]) -> Option<Result<(), String>> {
    const TOOL: &str = "spirv-val";
    run_on(TOOL, &["--target-env", "vulkan1.1", "-"].map(OsStr::new), bytes).map(|output| verdict(TOOL, output))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::interpret::{Interpreter, Value};
    use crate::check::shader::{parse, weights};
    use crate::export::shader::{ENTRY, network_function};
    use crate::export::translate::{FRAGMENTS, ROWS, string_of, with_entry_points};
    use crate::export::{Format, Target, encode};
    use crate::features::FeatureSet;
    use crate::gpu::device::{Dispatch, groups};
    use crate::model::mlp::tests::random_mlp;
    use crate::model::{Dense, Mlp, Provenance};
    use crate::numeric::quantise::round_f16_of_f32;
    use crate::numeric::rng::stream;
    use rand::RngExt;

    #[test]
    fn halves_of_all_bits() {
        for bits in 0..0x7c00u32 {
            let x = half_from_bits(bits);
            assert!(
                round_f16_of_f32(x) == x
                    && (bits == 0 || x > half_from_bits(bits - 1))
                    && half_from_bits(bits | 0x8000) == -x
            );
        }
        assert_eq!(
            (half_from_bits(0x3c00), half_from_bits(0x0001), half_from_bits(0x7bff)),
            (1.0, 5.9604645e-8, 65504.0)
        );
    }

    /// Weights of both precisions are read back from both languages. Controls: another network's are not.
    #[test]
    fn weights_are_read_back() {
        let sets = [FeatureSet::Paper, FeatureSet::Recentred];
        for (hidden, set) in [&[][..], &[5], &[8, 4], &[32, 16]]
            .into_iter()
            .flat_map(|hidden| sets.map(|set| (hidden, set)))
        {
            let random = |seed| {
                Mlp::new(
                    "random",
                    set,
                    random_mlp(hidden, seed).layers().to_vec(),
                    Provenance::default(),
                )
                .unwrap()
            };
            let (mlp, other, entry) = (random(1), random(2), network_function(set));
            for format in Format::all().filter(|f| matches!(f.target(), Target::Metal | Target::Spirv)) {
                let bytes = encode(&mlp, format).unwrap();
                let constants = if format.target() == Target::Metal {
                    let text = std::str::from_utf8(&bytes).unwrap();
                    let constants = metal_constants(text).unwrap();
                    metal_uses(text, &constants, entry).unwrap();
                    // Control: one number of the function's own.
                    let (head, body) = text.split_once(&format!("float {entry}(")).unwrap();
                    let changed = body.replacen("0.", "3.", 1);
                    assert!(metal_uses(&format!("{head}float {entry}({changed}"), &constants, entry).is_err());
                    constants
                } else {
                    assert!(string_of(&bytes).unwrap().contains("network 'random'"));
                    if let Some(valid) = spirv_val(&bytes) {
                        valid.unwrap();
                        let mut broken = bytes.clone();
                        let end = broken.len();
                        broken.drain(end - 8..);
                        assert!(spirv_val(&broken).unwrap().is_err());
                    }
                    spirv_constants(&bytes).unwrap()
                };
                weights(format, &constants, &mlp).unwrap_or_else(|e| panic!("{format:?} {hidden:?}: {e}"));
                assert!(weights(format, &constants, &other).is_err());
            }
        }
        assert!(spirv_constants(b"not SPIR-V").is_err() && spirv_constants(&[]).is_err());
    }

    /// The compute shaders of the SPIR-V module, in the WGSL that it is made of, on a GPU: what the functions answer to
    /// the same numbers on the CPU, to 1e-4 (logarithms and exponentials differ by some ulp). Control: the answers of
    /// the row before.
    #[test]
    fn entry_points_answer_rows_and_fragments() {
        let Some(gpu) = crate::gpu::tests::gpu() else { return };
        for set in FeatureSet::ALL {
            let mut rng = stream(9, 97, set.width() as u64);
            let mut numbers = |n: usize| (0..n).map(|_| rng.random_range(-0.7f32..0.7)).collect::<Vec<_>>();
            let width = set.width();
            let layers = vec![
                Dense::new(width, 6, numbers(6 * width), numbers(6)).unwrap(),
                Dense::new(6, 1, numbers(6), numbers(1)).unwrap(),
            ];
            let mlp = Mlp::new("m", set, layers, Provenance::default()).unwrap();
            let text = String::from_utf8(encode(&mlp, Format::WGSL).unwrap()).unwrap();
            let module = parse(Format::WGSL, &text).unwrap();
            let interpreter = Interpreter::new(&module);
            let known = set.spec().exact.ends;
            let scalars = set.spec().shader.arguments.len();
            let (n, k) = (500, set.moments());
            // Fragments between near and far, in pixels of three: what is known is smooth in every argument.
            let fragment = |_| {
                let [near, far] = [rng.random_range(-0.8f32..-0.1), rng.random_range(0.1f32..0.8)];
                let z = rng.random_range(near..far);
                let head = if known {
                    vec![
                        z.exp(),
                        z,
                        rng.random_range(0.1..1.0),
                        near.exp(),
                        far.exp(),
                        near,
                        far,
                        3.0,
                        rng.random_range(2.0..4.0),
                    ]
                } else {
                    (0..scalars).map(|_| rng.random_range(0.1f32..0.9)).collect()
                };
                head.into_iter()
                    .chain((0..k).map(|_| rng.random_range(-0.5f32..0.5)))
                    .collect::<Vec<f32>>()
            };
            let fragments: Vec<Vec<f32>> = (0..n).map(fragment).collect();
            let expected: Vec<f32> = fragments
                .iter()
                .map(|row| {
                    let mut arguments: Vec<Value<1>> = row[..scalars].iter().map(|&x| Value::Uniform(x)).collect();
                    arguments.extend((k > 0).then(|| Value::numbers(&row[scalars..])));
                    let answer = if known {
                        interpreter.call("nmt_fragment_transmittance", arguments)
                    } else {
                        let features = interpreter.call("nmt_features", arguments).unwrap();
                        interpreter.call(ENTRY, vec![features])
                    };
                    answer.unwrap().flatten().unwrap()[0]
                })
                .collect();
            let rows: Vec<f32> = (0..n * width).map(|_| rng.random_range(-1.0f32..1.0)).collect();
            let source = with_entry_points(&text, set);
            for (entry, input, expected) in [
                (ROWS, rows.clone(), mlp.forward_batch::<f32>(&rows)),
                (FRAGMENTS, fragments.concat(), expected),
            ] {
                let pipeline = gpu.compute(entry, &source, entry).unwrap();
                let (input, output) = (
                    gpu.upload("rows", &input).unwrap(),
                    gpu.zeros("answers", 4 * n as u64).unwrap(),
                );
                gpu.run(
                    entry,
                    &[Dispatch {
                        pipeline: &pipeline,
                        buffers: &[&input, &output],
                        groups: groups(n as u64),
                    }],
                )
                .unwrap();
                let found: Vec<f32> = gpu.download(&output, n).unwrap();
                let near = |shift: usize| {
                    (0..n)
                        .filter(|&i| (found[i] - expected[(i + shift) % n]).abs() <= 1e-4)
                        .count()
                };
                // NaN is near to nothing.
                let off = |shift: usize| n - near(shift);
                assert!(
                    off(0) == 0 && off(1) > n / 2,
                    "{set:?} {entry}: {} off, {} of the control",
                    off(0),
                    off(1)
                );
            }
        }
    }
}
