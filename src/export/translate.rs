//! MSL and SPIR-V, which naga makes of the packed WGSL.

use super::dialect::Wgsl;
use super::shader::{self, ENTRY};
use super::{ExportError, Format, Precision, Prefix};
use crate::features::FeatureSet;
use crate::features::spec::ShaderCalls;
use crate::model::Mlp;
use crate::numeric::source::Dialect;
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
pub fn metal(mlp: &Mlp, format: Format, prefix: Option<&Prefix>) -> Result<String, ExportError> {
    let refused = |reason| ExportError::Translate {
        language: "MSL",
        reason,
    };
    let source = shader::source(mlp, format, prefix)?;
    let text = msl(&source, &back::msl::Options::default()).map_err(refused)?;
    let text = prefix.map_or(text.clone(), |prefix| prefix.apply(&text));
    let guard = shader::include_guard(mlp.name());
    let guard = prefix.map_or(guard.clone(), |prefix| prefix.apply(&guard));
    let more = [
        "Metal Shading Language 2.1, translated from the WGSL export by naga. An array is a struct with the one member \
            'inner'.",
    ];
    let head = shader::comment(format, &header(mlp, format, prefix, &more)?);
    Ok(format!("{head}#ifndef {guard}\n#define {guard}\n\n{text}\n#endif\n"))
}

/// A pass in Metal's language, of its WGSL: the comment at its head, then what naga makes of it. Uniforms of group 0
/// are buffer 0; textures and storage buffers have the index of their binding.
///
/// # Errors
/// naga's words.
pub(super) fn metal_pass(wgsl: &str) -> Result<String, String> {
    let (module, _) = parse_wgsl(wgsl)?;
    let mut resources = back::msl::EntryPointResources {
        // Taken out again below.
        sizes_buffer: Some(30),
        ..Default::default()
    };
    for (_, variable) in module.global_variables.iter() {
        let Some(binding) = variable.binding else { continue };
        let slot = Some(binding.binding as u8);
        let target = match variable.space {
            naga::AddressSpace::Uniform => back::msl::BindTarget {
                buffer: slot,
                ..Default::default()
            },
            naga::AddressSpace::Storage { access } => back::msl::BindTarget {
                buffer: slot,
                mutable: access.contains(naga::StorageAccess::STORE),
                ..Default::default()
            },
            _ => back::msl::BindTarget {
                texture: slot,
                ..Default::default()
            },
        };
        resources.resources.insert(binding, target);
    }
    let per_entry_point_map = module
        .entry_points
        .iter()
        .map(|entry| (entry.name.clone(), resources.clone()))
        .collect();
    let options = back::msl::Options {
        per_entry_point_map,
        fake_missing_bindings: false,
        // Those that are here end.
        force_loop_bounding: false,
        ..Default::default()
    };
    let head: Vec<&str> = wgsl.lines().take_while(|line| line.starts_with("//")).collect();
    let head = head.join("\n").replace("// WebGPU, ", "// Metal, by naga from WGSL, ");
    let text = without_sizes(&msl(wgsl, &options)?)?;
    // Atomics write even where a depth test behind the shader fails.
    let text = match text.contains("atomic_fetch_max_explicit") {
        true => text.replace("\nfragment ", "\n[[early_fragment_tests]]\nfragment "),
        false => text,
    };
    Ok(format!("{head}\n\n{text}"))
}

/// Metal's text without the sizes of buffers, which naga hands from function to function and nothing asks for.
fn without_sizes(text: &str) -> Result<String, String> {
    const SIZES: &str = "_mslBufferSizes";
    let Some((before, rest)) = text.split_once(&format!("struct {SIZES} {{")) else {
        return Ok(text.to_owned());
    };
    let (_, rest) = rest
        .split_once("};\n\n")
        .ok_or("the end of a struct is not where it was")?;
    let rest = rest
        .lines()
        .filter(|line| !line.contains(&format!("constant {SIZES}& _buffer_sizes")))
        .collect::<Vec<_>>()
        .join("\n")
        .replace(", _buffer_sizes)", ")")
        .replace(",\n)", "\n)");
    match rest.contains("_buffer_sizes") {
        true => Err("the size of a buffer is asked for".to_owned()),
        false => Ok(format!("{before}{rest}\n")),
    }
}

/// What naga makes of WGSL. It puts an underscore behind names that end in a digit; that goes where it is not needed.
fn msl(wgsl: &str, options: &back::msl::Options) -> Result<String, String> {
    let (module, info) = parse_wgsl(wgsl)?;
    let options = back::msl::Options {
        // The first that knows an invariant position.
        lang_version: (2, 1),
        ..options.clone()
    };
    let (text, translation) =
        back::msl::write_string(&module, &info, &options, &Default::default()).map_err(|e| e.to_string())?;
    // naga leaves out an entry point that it cannot bind.
    for name in translation.entry_point_names {
        name.map_err(|e| e.to_string())?;
    }
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let words: std::collections::HashSet<&str> = text.split(|c: char| !is_word(c)).collect();
    let mut out = String::with_capacity(text.len());
    let mut rest = text.as_str();
    while let Some(at) = rest.find(is_word) {
        let end = rest[at..].find(|c| !is_word(c)).map_or(rest.len(), |n| at + n);
        let word = &rest[at..end];
        let bare = word.strip_suffix('_').filter(|bare| {
            bare.ends_with(|c: char| c.is_ascii_digit())
                && bare.starts_with(|c: char| c.is_alphabetic())
                && !words.contains(bare)
        });
        out += &rest[..at];
        // A type that naga has named gets a name of ours, which takes a prefix.
        match word
            .strip_prefix("type_")
            .filter(|n| n.chars().all(|c| c.is_ascii_digit()))
        {
            Some(number) => out += &format!("NmtType{number}"),
            None => out += bare.unwrap_or(word),
        }
        rest = &rest[end..];
    }
    Ok(out + rest)
}

/// The header of the WGSL that a translation is made of, with more lines after its form.
fn header(mlp: &Mlp, format: Format, prefix: Option<&Prefix>, more: &[&str]) -> Result<Vec<String>, ExportError> {
    let limit = (format.precision() == Precision::F16)
        .then(|| shader::half_limit(mlp))
        .transpose()?;
    let mut lines = shader::header(mlp, format, prefix, limit);
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
    let loads =
        |base: usize, n: usize| -> Vec<String> { (base..base + n).map(|i| format!("nmt_in[first + {i}u]")).collect() };
    let mut call = call.replace("HEAD", &loads(0, names.len()).join(", "));
    if set.moments() > 0 {
        call = call.replace("TAIL", &Wgsl.numbers(&loads(names.len(), set.moments())));
    }
    let rows = format!("{ENTRY}({})", Wgsl.numbers(&loads(0, width)));
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

/// The network as a SPIR-V module with two compute shaders, [`ROWS`] and [`FRAGMENTS`]; its header stands in an
/// OpString.
///
/// # Errors
/// [`ExportError`].
pub fn spirv(mlp: &Mlp, format: Format) -> Result<Vec<u8>, ExportError> {
    let refused = |reason| ExportError::Translate {
        language: "SPIR-V",
        reason,
    };
    let set = mlp.feature_set();
    let (module, info) = parse_wgsl(&with_entry_points(&shader::source(mlp, format, None)?, set)).map_err(refused)?;
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
        "SPIR-V, translated from the WGSL export by naga. Compute shaders of 64 invocations: row = x + y * 64 * \
            (workgroups in x).",
        "Set 0: binding 0 is a storage buffer of f32 to read, binding 1 one to write, T of one row a number; their \
            lengths say how many rows.",
        &rows,
        &fragments,
    ];
    let text = header(mlp, format, None, &more)?.join("\n");
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
