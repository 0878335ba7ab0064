//! The code in docs/integration.md: every block compiles behind the export that the page names. Its Rust is run as
//! documentation tests.

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

/// The source with every call of the export's functions misspelt.
fn misspelt(block: &str) -> String {
    block.replace("nmt_", "mnt_")
}

/// Control: with functions of the export misspelt, no block that calls one compiles.
#[test]
fn wgsl_compiles() {
    let (export, blocks) = (export(Format::WGSL), blocks(&page(), "wgsl"));
    assert!(blocks.len() >= 6, "{} blocks", blocks.len());
    for block in &blocks {
        wgsl(&format!("{export}\n{block}")).unwrap_or_else(|e| panic!("{block}\n{e}"));
        assert!(!block.contains("nmt_") || wgsl(&format!("{export}\n{}", misspelt(block))).is_err());
    }
    assert!(blocks.iter().filter(|b| b.contains("nmt_")).count() >= 3);
}

fn glslang(stage: &str, source: &str) -> std::io::Result<Result<(), String>> {
    let stdio = || Stdio::piped();
    let mut child = Command::new("glslangValidator")
        .args(["--stdin", "-S", stage])
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

/// In GLSL 4.50 and ES 3.00: functions in fragment shaders, and the vertex shader. Control: a vertex shader without its
/// first line.
#[test]
fn glsl_compiles() {
    let (export, page) = (export(Format::GLSL), page());
    let (functions, vertex) = (blocks(&page, "glsl"), blocks(&page, "glsl-vertex"));
    assert!(functions.len() >= 2 && vertex.len() == 1);
    for version in ["450", "300 es"] {
        let whole = |block: &str| format!("#version {version}\n{export}\n{block}\nvoid main() {{}}\n");
        if or_skip("glslangValidator", glslang("frag", &whole(&functions[0]))).is_none() {
            return;
        }
        for block in &functions {
            glslang("frag", &whole(block)).unwrap().unwrap();
            assert!(
                glslang("frag", &whole(&block.replace("vec4(", "vec5(")))
                    .unwrap()
                    .is_err()
                    || !block.contains("vec4(")
            );
        }
        glslang("vert", &format!("#version {version}\n{}", vertex[0]))
            .unwrap()
            .unwrap();
        assert!(
            glslang("vert", &vertex[0].replace("in_view", "out_of_view.x"))
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
    assert!(page.matches("](../shaders/").count() >= 7);
    assert_eq!(missing(&page), Vec::<String>::new());
    assert_eq!(missing("[a](../src/gone.rs)"), ["../src/gone.rs"]);
}
