//! The code in docs/integration.md: every block compiles behind the export that the page names. Its Rust is run as documentation tests.

use nmt::export::{Format, encode};
use nmt::model::file;
use nmt::numeric::require::or_skip;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

fn page() -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/integration.md")).unwrap()
}

/// Fenced blocks of a language.
fn blocks(text: &str, language: &str) -> Vec<String> {
    let fence = format!("```{language}\n");
    text.split(&fence)
        .skip(1)
        .map(|rest| rest.split("```").next().unwrap().to_owned())
        .collect()
}

fn export(format: Format) -> String {
    let mlp = file::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("models/recommended.json")).unwrap();
    String::from_utf8(encode(&mlp, format).unwrap()).unwrap()
}

fn wgsl(source: &str) -> Result<(), String> {
    let module = naga::front::wgsl::parse_str(source).map_err(|e| e.emit_to_string(source))?;
    let mut validator =
        naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::empty());
    validator
        .validate(&module)
        .map(drop)
        .map_err(|e| e.emit_to_string(source))
}

/// Control: with a function of the export misspelt, no block that calls it compiles.
#[test]
fn wgsl_compiles() {
    let (export, blocks) = (export(Format::Wgsl), blocks(&page(), "wgsl"));
    assert_eq!(blocks.len(), 3, "pass 1, pass 2, resolve");
    for block in &blocks {
        wgsl(&format!("{export}\n{block}")).unwrap();
        assert!(
            wgsl(&format!("{export}\n{}", block.replace("nmt_moment_depth", "nmt_depth"))).is_err()
                || !block.contains("nmt_moment_depth")
        );
    }
    assert!(blocks[..2].iter().all(|b| b.contains("nmt_moment_depth")));
}

fn glslang(source: &str) -> std::io::Result<Result<(), String>> {
    let stdio = || Stdio::piped();
    let mut child = Command::new("glslangValidator")
        .args(["--stdin", "-S", "frag"])
        .stdin(stdio())
        .stdout(stdio())
        .stderr(stdio())
        .spawn()?;
    child.stdin.take().unwrap().write_all(source.as_bytes())?;
    let output = child.wait_with_output()?;
    Ok(if output.status.success() {
        Ok(())
    } else {
        Err(String::from_utf8_lossy(&output.stdout).into_owned())
    })
}

/// Control: as for WGSL.
#[test]
fn glsl_compiles() {
    let (export, blocks) = (export(Format::Glsl), blocks(&page(), "glsl"));
    assert_eq!(blocks.len(), 3, "pass 1, pass 2, resolve");
    let whole = |block: &str| format!("#version 450\n{export}\n{block}");
    if or_skip("glslangValidator", glslang(&whole(&blocks[0]))).is_none() {
        return;
    }
    for block in &blocks {
        glslang(&whole(block)).unwrap().unwrap();
    }
    for block in &blocks[..2] {
        assert!(
            glslang(&whole(&block.replace("nmt_moment_depth", "nmt_depth")))
                .unwrap()
                .is_err()
        );
    }
}

/// Files that the page links to are there; control: one that is not.
#[test]
fn links_lead_somewhere() {
    let page = page();
    let missing = |page: &str| -> Vec<String> {
        let targets = page
            .split("](")
            .skip(1)
            .map(|rest| rest.split(')').next().unwrap().to_owned());
        let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
        targets
            .filter(|t| t.starts_with("../") && !docs.join(t).exists())
            .collect()
    };
    assert!(page.matches("](../src/gpu").count() >= 3);
    assert_eq!(missing(&page), Vec::<String>::new());
    assert_eq!(missing("[a](../src/gone.rs)"), ["../src/gone.rs"]);
}
