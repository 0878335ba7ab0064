//! `nmt check` and the tools that it may find.

use crate::common::{Workplace, command, json, nmt};
use nmt::numeric::require::or_skip;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;

/// An export in which one digit was changed by hand does not pass.
#[test]
fn check_finds_an_edited_export() {
    let at = Workplace::new();
    let model = at.model();
    nmt(&["export", &model, "--out", &at.path("e"), "--format", "glsl"]).success();
    let path = at.path("e/tiny.glsl");
    let text = std::fs::read_to_string(&path).unwrap();
    let (head, weights) = text.split_once("NMT_W2").unwrap();
    let changed = weights.replacen("0.", "1.", 1);
    std::fs::write(&path, format!("{head}NMT_W2{changed}")).unwrap();
    nmt(&["check", &model, "--exports", &at.path("e"), "--format", "glsl"])
        .code(1)
        .stdout(contains("NMT_W2: number").and(contains("worst error")));
}

#[test]
fn required_tools_are_conditions() {
    let at = Workplace::new();
    let model = at.model();
    nmt(&["export", &model, "--out", &at.path("e"), "--format", "onnx"]).success();
    let check = || command(&["check", &model, "--exports", &at.path("e"), "--format", "onnx"]);
    let without = || {
        let mut command = check();
        command.env_remove("ORT_DYLIB_PATH").env_remove("NMT_REQUIRE");
        command
    };
    without()
        .assert()
        .success()
        .stdout(contains("skipped onnx, onnxruntime"));
    without()
        .env("NMT_REQUIRE", "onnxruntime")
        .assert()
        .code(1)
        .stdout(contains("required, but"));
    without()
        .env("ORT_DYLIB_PATH", at.path("none.so"))
        .assert()
        .success()
        .stdout(contains("is not a file"));
    without()
        .env("ORT_DYLIB_PATH", at.write("no.so", "not a library"))
        .assert()
        .code(1)
        .stdout(contains("FAILED onnx, onnxruntime"));
    without()
        .args(["--require", "tea"])
        .assert()
        .code(2)
        .stderr(contains("'tea'"));
}

/// Where onnxruntime is, it runs; `scripts/test` brings it.
#[test]
fn onnxruntime_computes_the_reference() {
    let library = std::env::var("ORT_DYLIB_PATH").map_err(|_| "ORT_DYLIB_PATH is not set; scripts/test sets it");
    if or_skip("onnxruntime", library).is_none() {
        return;
    }
    let at = Workplace::new();
    let model = at.model();
    nmt(&["export", &model, "--out", &at.path("e"), "--format", "onnx"]).success();
    let report = json(nmt(&[
        "check",
        &model,
        "--exports",
        &at.path("e"),
        "--format",
        "onnx",
        "--json",
        "--require",
        "onnxruntime",
    ]));
    let found = report["results"]
        .as_array()
        .unwrap()
        .iter()
        .find(|r| r["tool"] == "onnxruntime")
        .unwrap();
    assert_eq!(
        (found["status"].as_str(), found["numbers"][0]["count"].as_u64()),
        (Some("passed"), Some(100_000)),
        "{found}"
    );
}

/// A folder that `--passes` wrote holds some formats: what is missing says how to write it and how to check the rest,
/// and that check passes. Control: of another network's folder nothing can be checked.
#[test]
fn missing_exports_say_what_to_do() {
    let at = Workplace::new();
    let folder = at.path("shaders");
    nmt(&["export", "small", "--passes", "--out", &folder]).success();
    let advice = "'nmt export --format onnx' writes it, and 'nmt check --format wgsl,glsl,hlsl,metal' checks";
    nmt(&["check", "small", "--exports", &folder, "--format", "wgsl,onnx"])
        .code(1)
        .stdout(contains("FAILED onnx").and(contains(advice)));
    nmt(&[
        "check",
        "small",
        "--exports",
        &folder,
        "--format",
        "wgsl,glsl,hlsl,metal",
    ])
    .success();
    nmt(&["check", "recommended", "--exports", &folder, "--format", "onnx"])
        .code(1)
        .stdout(contains("holds no export of 'recommended'").and(contains("checks what is there").not()));
}

/// Piped, each row stands on one line, from its format and its question to its result.
#[test]
fn rows_in_a_pipe_are_whole() {
    let at = Workplace::new();
    let model = at.model();
    nmt(&["export", &model, "--out", &at.path("e"), "--format", "json"]).success();
    let assert = nmt(&["check", &model, "--exports", &at.path("e"), "--format", "json"]).success();
    let text = String::from_utf8(assert.get_output().stdout.clone()).unwrap();
    let rows: Vec<&str> = text.lines().filter(|line| line.starts_with("json ")).collect();
    assert!(rows.len() == 3 && rows.iter().all(|row| row.ends_with(" ok")), "{text}");
    for (row, parts) in rows.iter().zip([
        ["weights bit for bit", ""],
        ["computes the reference", "100000 in distribution"],
        ["computes the reference", "20000 extreme"],
    ]) {
        assert!(parts.iter().all(|part| row.contains(part)), "{row}");
    }
    assert_eq!(text.matches("checked by").count(), 1);
}
