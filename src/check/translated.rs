//! MSL and SPIR-V exports, which naga made: weights read back from what stands there, SPIR-V validated. Neither is executed here.

use super::shader::{Constants, literals, run_on, verdict};
use crate::export::translate::instructions;
use std::collections::HashMap;
use std::ffi::OsStr;

/// Constants that hold weights, from MSL text; naga puts an underscore behind names that end in a digit.
///
/// # Errors
/// Names the constant that is not made of literals.
pub fn metal_constants(text: &str) -> Result<Constants, String> {
    let declarations = text.lines().filter_map(|line| line.strip_prefix("constant ")?.split_once(" = "));
    declarations
        .map(|(head, value)| {
            let name = head.split_whitespace().last().unwrap_or_default().trim_end_matches('_').to_owned();
            Ok((name.clone(), literals(value).map_err(|e| format!("{name}: {e}"))?))
        })
        .collect()
}

/// Checks that the network's function uses the constants: naga writes their parts out where they are used, in order.
///
/// # Errors
/// Names the constant that is not used as it stands.
pub fn metal_uses(text: &str, constants: &Constants, entry: &str) -> Result<(), String> {
    let body = text.split(&format!("float {entry}(")).nth(1).and_then(|t| t.split("\n}").next()).ok_or_else(|| format!("there is no {entry}"))?;
    let mut found = literals(body)?.into_iter().filter(|x| *x != 0.0);
    for (name, numbers) in constants {
        // Biases that are added between blocks of weights are found by name or not at all: what is in order are weights.
        let named = body.contains(&format!("{name}_"));
        if name.starts_with("NMT_W") && !named && !numbers.iter().filter(|x| **x != 0.0).all(|x| found.any(|f| f.to_bits() == x.to_bits())) {
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
                let text: Vec<u8> = text.iter().flat_map(|w| w.to_le_bytes()).take_while(|&b| b != 0).collect();
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
    weights.map(|(id, name)| numbers.remove(&id).map(|n| (name.clone(), n)).ok_or(format!("'{name}' is not made of numbers"))).collect()
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
    use crate::check::shader::weights;
    use crate::export::translate::string_of;
    use crate::export::{Format, encode, shader::ENTRY};
    use crate::model::mlp::tests::random_mlp;
    use crate::numeric::quantise::round_f16_of_f32;

    #[test]
    fn halves_of_all_bits() {
        for bits in 0..0x7c00u32 {
            let x = half_from_bits(bits);
            assert!(round_f16_of_f32(x) == x && (bits == 0 || x > half_from_bits(bits - 1)) && half_from_bits(bits | 0x8000) == -x);
        }
        assert_eq!((half_from_bits(0x3c00), half_from_bits(0x0001), half_from_bits(0x7bff)), (1.0, 5.9604645e-8, 65504.0));
    }

    /// Weights of both precisions are read back from both languages. Controls: another network's are not.
    #[test]
    fn weights_are_read_back() {
        for hidden in [&[][..], &[5], &[8, 4], &[32, 16]] {
            let (mlp, other) = (random_mlp(hidden, 1), random_mlp(hidden, 2));
            for format in [Format::Metal, Format::MetalF16, Format::Spirv, Format::SpirvF16] {
                let bytes = encode(&mlp, format).unwrap();
                let constants = if matches!(format, Format::Metal | Format::MetalF16) {
                    let text = std::str::from_utf8(&bytes).unwrap();
                    let constants = metal_constants(text).unwrap();
                    metal_uses(text, &constants, ENTRY).unwrap();
                    // Control: one number of the function's own.
                    let (head, body) = text.split_once("float nmt_transmittance(").unwrap();
                    let changed = body.replacen("0.", "3.", 1);
                    assert!(metal_uses(&format!("{head}float nmt_transmittance({changed}"), &constants, ENTRY).is_err());
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
                let kind = format.kind().unwrap();
                weights(kind, &constants, &mlp).unwrap_or_else(|e| panic!("{format:?} {hidden:?}: {e}"));
                assert!(weights(kind, &constants, &other).is_err());
            }
        }
        assert!(spirv_constants(b"not SPIR-V").is_err() && spirv_constants(&[]).is_err());
    }
}
