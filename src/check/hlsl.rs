//! HLSL exports: read back from their text, compiled by two front ends, and executed as the WGSL that slangc makes of them.

use super::shader::Constants;
use crate::export::shader::ENTRY;
use std::path::PathBuf;
use std::process::Command;

/// Environment variable that names slangc.
pub const SLANGC_VARIABLE: &str = "NMT_SLANGC";

/// Entry point of [`with_rows`].
pub const ROWS: &str = "nmt_rows";

/// Constants that hold weights, from the text: the numbers between the braces of every `static const` whose name begins with `NMT_`.
///
/// # Errors
/// Names the constant that is not made of literals.
pub fn constants(text: &str) -> Result<Constants, String> {
    let mut out = Constants::new();
    for declaration in text.split("static const ").skip(1) {
        let declaration = declaration.split(';').next().unwrap_or_default();
        let (head, value) = declaration.split_once('=').ok_or("a constant without a value")?;
        let name = head.split_whitespace().nth(1).and_then(|n| n.split('[').next()).unwrap_or_default();
        let is_word = |c: char| c.is_ascii_alphanumeric() || "_.+-".contains(c);
        let words = value.split(|c: char| !is_word(c)).filter(|word| !word.is_empty());
        // Names of types stand before parentheses: words that begin with a letter.
        let numbers = words.filter(|word| !word.starts_with(|c: char| c.is_ascii_alphabetic()));
        let read = |word: &str| word.trim_end_matches(['f', 'h']).parse().map_err(|_| format!("{name}: '{word}' is not a number"));
        out.push((name.to_owned(), numbers.map(read).collect::<Result<_, _>>()?));
    }
    Ok(out)
}

/// Checks that every index in the text is a literal.
///
/// # Errors
/// Names the line that has one that is not.
pub fn literal_indices(text: &str) -> Result<(), String> {
    let code = |line: &str| line.split("//").next().unwrap_or_default().to_owned();
    let literal = |line: &str| line.split('[').skip(1).all(|rest| rest.split(']').next().is_some_and(|i| i.chars().all(|c| c.is_ascii_digit())));
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
    float f[{width}] = {{ {} }};
    nmt_out[id.x] = {ENTRY}(f);
}}
",
        loads.join(", ")
    )
}

/// Where slangc is: what `NMT_SLANGC` names, or the one on the path.
///
/// # Errors
/// In words, what to do about it.
pub fn slangc() -> Result<PathBuf, String> {
    match std::env::var_os(SLANGC_VARIABLE).filter(|v| !v.is_empty()).map(PathBuf::from) {
        Some(path) if path.is_file() => Ok(path),
        Some(path) => Err(format!("{SLANGC_VARIABLE} names {}, which is not a file", path.display())),
        None => match Command::new("slangc").arg("-v").output() {
            Ok(_) => Ok(PathBuf::from("slangc")),
            Err(_) => Err(format!("not found: set {SLANGC_VARIABLE} to slangc, for example the one inside PyPI's slangtorch wheel")),
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
    let run =
        Command::new(slangc).args(["-lang", "hlsl", "-target", "wgsl", "-entry", entry, "-stage", "compute", "-o"]).arg(&to).arg(&from).output();
    super::shader::verdict("slangc", run)?;
    std::fs::read_to_string(&to).map_err(|e| format!("slangc wrote no WGSL: {e}"))
}
