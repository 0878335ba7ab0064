//! Core and tail as a user meets it: files that are exported and checked, and the code in docs/core.md.

use assert_cmd::cargo::cargo_bin_cmd;
use nmt::export::Target;
use nmt::export::core::{chain, named, text};
use nmt::model::shipped;
use std::collections::BTreeSet;
use std::path::Path;

fn wgsl(source: &str) -> Result<(), String> {
    let module = naga::front::wgsl::parse_str(source).map_err(|e| e.emit_to_string(source))?;
    let mut validator =
        naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::empty());
    validator
        .validate(&module)
        .map(drop)
        .map_err(|e| e.emit_to_string(source))
}

/// Both passes of the page compile behind the exported files, that of a network among them. Control: with a function
/// misspelt neither does.
#[test]
fn the_page_compiles() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/core.md");
    let page = std::fs::read_to_string(page).unwrap();
    let export = text(named("core:4").unwrap(), Target::Wgsl);
    let network = chain(&shipped::open(Path::new("core")).unwrap(), Target::Wgsl, None).unwrap();
    let blocks: Vec<&str> = page
        .split("```wgsl\n")
        .skip(1)
        .map(|rest| rest.split("```").next().unwrap())
        .collect();
    assert_eq!(blocks.len(), 2, "pass 1 and pass 2");
    for block in blocks {
        wgsl(&format!("{export}\n{block}")).unwrap();
        wgsl(&format!("{network}\n{block}")).unwrap();
        assert!(wgsl(&format!("{export}\n{}", block.replace("nmt_core_steps", "nmt_steps"))).is_err());
    }
}

/// Export and check on the command line; a file that was changed fails the check, and is not replaced without --force.
#[test]
fn files_are_exported_and_checked() {
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| cargo_bin_cmd!("nmt").current_dir(&folder).args(arguments).assert();
    run(&["export", "core:3", "--out", "shaders"]).success();
    run(&["check", "core:3", "--exports", "shaders"]).success();
    run(&["export", "core:3", "--out", "shaders"]).failure();
    run(&["export", "core:9", "--out", "other"]).failure();
    let file = folder.path().join("shaders/core-3.wgsl");
    let text = std::fs::read_to_string(&file).unwrap();
    std::fs::write(&file, text.replace("4095", "4096").replace("4096 - h", "4097 - h")).unwrap();
    run(&["check", "core:3", "--exports", "shaders"]).code(1);
    run(&["export", "core:3", "--out", "shaders", "--force"]).success();
    run(&["check", "core:3", "--exports", "shaders"]).success();
}

/// Both passes of a network on the command line: written beside its formats, listed in `--json`, checked with them.
/// Control: a file with another bias fails.
#[test]
fn networks_are_exported_with_their_core() {
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| cargo_bin_cmd!("nmt").current_dir(&folder).args(arguments).assert();
    let export = run(&[
        "export",
        "core",
        "--format",
        "wgsl,glsl,json",
        "--out",
        "shaders",
        "--json",
    ])
    .success();
    let json: serde_json::Value = serde_json::from_slice(&export.get_output().stdout).unwrap();
    let files: Vec<&str> = json["results"]
        .as_array()
        .unwrap()
        .iter()
        .map(|result| result["file"].as_str().unwrap().rsplit('/').next().unwrap())
        .collect();
    let expected = [
        "core.wgsl",
        "core.glsl",
        "core.json",
        "core.chain.wgsl",
        "core.chain.glsl",
    ];
    assert_eq!(files.iter().collect::<BTreeSet<_>>(), expected.iter().collect());
    let check = || run(&["check", "core", "--exports", "shaders", "--format", "glsl"]);
    check().success();
    let file = folder.path().join("shaders/core.chain.glsl");
    let text = std::fs::read_to_string(&file).unwrap();
    std::fs::write(&file, text.replace("min(-logit, 80.0)", "min(0.1 - logit, 80.0)")).unwrap();
    check().code(1);
    std::fs::remove_file(&file).unwrap();
    check().code(1);
}
