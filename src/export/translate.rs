//! MSL and SPIR-V, which naga makes of the packed WGSL.

use super::ExportError;
use super::shader::{self, ENTRY, Kind, Precision};
use crate::features::FeatureSet;
use crate::features::spec::ShaderCalls;
use crate::model::Mlp;
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{Module, back};

/// Entry point of the SPIR-V module that takes rows of features.
pub const ROWS: &str = "nmt_rows";
/// Entry point of the SPIR-V module that takes what pass 2 knows of fragments.
pub const FRAGMENTS: &str = "nmt_fragments";

/// Parses and validates WGSL, f16 included.
///
/// # Errors
/// naga's words.
pub fn parse_wgsl(source: &str) -> Result<(Module, ModuleInfo), String> {
    let mut options = naga::front::wgsl::Options::new();
    options.capabilities |= Capabilities::SHADER_FLOAT16;
    let module = naga::front::wgsl::Frontend::new_with_options(options)
        .parse(source)
        .map_err(|e| e.emit_to_string(source))?;
    let info = validate(&module)?;
    Ok((module, info))
}

/// Validates a module.
///
/// # Errors
/// naga's words.
pub fn validate(module: &Module) -> Result<ModuleInfo, String> {
    Validator::new(ValidationFlags::all(), Capabilities::SHADER_FLOAT16)
        .validate(module)
        .map_err(|e| format!("naga does not validate it: {}", e.into_inner()))
}

/// The network in Metal's language: the functions of the WGSL, to be included.
///
/// # Errors
/// [`ExportError`].
pub fn metal(mlp: &Mlp, kind: Kind) -> Result<String, ExportError> {
    let refused = |reason| ExportError::Translate {
        language: "MSL",
        reason,
    };
    let (module, info) = parse_wgsl(&shader::source(mlp, kind)?).map_err(refused)?;
    let options = back::msl::Options {
        lang_version: (2, 0),
        ..Default::default()
    };
    let (text, _) =
        back::msl::write_string(&module, &info, &options, &Default::default()).map_err(|e| refused(e.to_string()))?;
    let more = [
        "Metal Shading Language 2.0, translated from the WGSL export by naga. An array is a struct with the one member 'inner'.",
    ];
    Ok(shader::comment(&header(mlp, kind, &more)?) + &text)
}

/// The header of the WGSL that a translation is made of, with more lines after its form.
fn header(mlp: &Mlp, kind: Kind, more: &[&str]) -> Result<Vec<String>, ExportError> {
    let limit = (kind.precision == Precision::F16)
        .then(|| shader::half_limit(mlp))
        .transpose()?;
    let mut lines = shader::header(mlp, kind, limit);
    lines.splice(2..2, more.iter().map(|&l| l.to_owned()));
    Ok(lines)
}

/// The WGSL with two compute shaders behind it, [`ROWS`] and [`FRAGMENTS`]: what the SPIR-V module is made of.
pub fn with_entry_points(source: &str, set: FeatureSet) -> String {
    let ShaderCalls {
        arguments: names,
        answer: call,
        ..
    } = set.spec().shader;
    let (width, arguments) = (set.width(), names.len() + set.moments());
    let loads = |base: usize, n: usize| {
        (base..base + n)
            .map(|i| format!("nmt_in[first + {i}u]"))
            .collect::<Vec<_>>()
            .join(", ")
    };
    let call = call
        .replace("HEAD", &loads(0, names.len()))
        .replace("TAIL", &loads(names.len(), set.moments()));
    let rows = format!("{ENTRY}(array<f32, {width}>({}))", loads(0, width));
    let mut text = format!(
        "{source}
@group(0) @binding(0) var<storage, read> nmt_in: array<f32>;
@group(0) @binding(1) var<storage, read_write> nmt_out: array<f32>;
"
    );
    for (name, numbers, answer) in [(ROWS, width, rows), (FRAGMENTS, arguments, call)] {
        text += &format!(
            "
@compute @workgroup_size(64)
fn {name}(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {{
    let row = id.x + id.y * groups.x * 64u;
    if (row < arrayLength(&nmt_out)) {{
        let first = row * {numbers}u;
        nmt_out[row] = {answer};
    }}
}}
"
        );
    }
    text
}

/// The network as a SPIR-V module with two compute shaders, [`ROWS`] and [`FRAGMENTS`]; its header stands in an OpString.
///
/// # Errors
/// [`ExportError`].
pub fn spirv(mlp: &Mlp, kind: Kind) -> Result<Vec<u8>, ExportError> {
    let refused = |reason| ExportError::Translate {
        language: "SPIR-V",
        reason,
    };
    let set = mlp.feature_set();
    let (module, info) = parse_wgsl(&with_entry_points(&shader::source(mlp, kind)?, set)).map_err(refused)?;
    let options = back::spv::Options {
        flags: back::spv::WriterFlags::DEBUG,
        ..Default::default()
    };
    let words = back::spv::write_vec(&module, &info, &options, None).map_err(|e| refused(e.to_string()))?;
    let mut arguments = set.spec().shader.arguments.to_vec();
    let moments: Vec<String> = (1..=set.moments()).map(|i| format!("b{i}")).collect();
    arguments.extend(moments.iter().map(String::as_str));
    let (rows, fragments) = (
        format!("{ROWS}: row by row the {} features below;", set.width()),
        format!("{FRAGMENTS}: row by row {}.", arguments.join(", ")),
    );
    let more = [
        "SPIR-V, translated from the WGSL export by naga. Compute shaders of 64 invocations: row = x + y * 64 * (workgroups in x).",
        "Set 0: binding 0 is a storage buffer of f32 to read, binding 1 one to write, T of one row a number; their lengths say how many rows.",
        &rows,
        &fragments,
    ];
    let text = header(mlp, kind, &more)?.join("\n");
    let words = with_string(&words, &text);
    Ok(words.iter().flat_map(|w| w.to_le_bytes()).collect())
}

const OP_STRING: u32 = 7;

/// A module with one more OpString, where the SPIR-V specification wants debug information: behind execution modes.
fn with_string(words: &[u32], text: &str) -> Vec<u32> {
    const HEADER: usize = 5;
    const BOUND: usize = 3;
    // OpExtension, OpExtInstImport, OpMemoryModel, OpEntryPoint, OpExecutionMode, OpCapability, OpExecutionModeId.
    const BEFORE: [u32; 7] = [10, 11, 14, 15, 16, 17, 331];
    let mut at = HEADER;
    while at < words.len() && BEFORE.contains(&(words[at] & 0xffff)) {
        at += (words[at] >> 16).max(1) as usize;
    }
    let mut bytes: Vec<u8> = text.bytes().filter(|&b| b != 0).collect();
    // A nul at least, then up to a whole word.
    bytes.resize((bytes.len() + 1).next_multiple_of(4), 0);
    let mut out = words[..at].to_vec();
    out.extend([((bytes.len() as u32 / 4 + 2) << 16) | OP_STRING, words[BOUND]]);
    out.extend(
        bytes
            .chunks_exact(4)
            .map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])),
    );
    out.extend(&words[at..]);
    out[BOUND] += 1;
    out
}

/// Instructions of a SPIR-V module: opcode and operands; none where it is not one.
pub fn instructions(bytes: &[u8]) -> Option<Vec<(u32, Vec<u32>)>> {
    let words: Vec<u32> = bytes
        .chunks_exact(4)
        .map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
        .collect();
    if !bytes.len().is_multiple_of(4) || words.first() != Some(&0x0723_0203) || words.len() < 5 {
        return None;
    }
    let (mut at, mut out) = (5, Vec::new());
    while at < words.len() {
        let length = (words[at] >> 16) as usize;
        out.push((words[at] & 0xffff, words.get(at + 1..at + length)?.to_vec()));
        at += length;
    }
    Some(out)
}

/// The first OpString of a SPIR-V module.
pub fn string_of(bytes: &[u8]) -> Option<String> {
    let found = instructions(bytes)?.into_iter().find(|(op, _)| *op == OP_STRING)?.1;
    let text: Vec<u8> = found
        .get(1..)?
        .iter()
        .flat_map(|w| w.to_le_bytes())
        .take_while(|&b| b != 0)
        .collect();
    String::from_utf8(text).ok()
}
