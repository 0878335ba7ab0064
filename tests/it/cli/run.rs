//! `nmt run`.

use crate::common::{TINY, Workplace, command, nmt};
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use std::path::Path;

/// The main job: everything in one go, a table in the end, files where it says, and again over its own folder.
#[test]
fn run_makes_and_checks_everything() {
    let at = Workplace::new();
    let out = at.path("out");
    let run = || nmt(&["run", &at.config(), "--out", &out]);
    run().success().stdout(
        contains("validation T-MSE")
            .and(contains("hlsl"))
            .and(contains("worst export error")),
    );
    for file in [
        "run.json",
        "model.json",
        "model.losses.csv",
        "dataset/manifest.json",
        "dataset/training_features.npy",
        "exports/tiny.wgsl",
        "exports/tiny.glsl",
        "exports/tiny.hlsl",
        "exports/tiny.metal",
        "exports/tiny.spv",
        "exports/tiny.json",
        "exports/tiny.onnx",
    ] {
        assert!(Path::new(&out).join(file).is_file(), "{file}");
    }
    assert!(!Path::new(&out).join("model.checkpoint.json").exists());
    let model = std::fs::read(at.path("out/model.json")).unwrap();
    let exported = std::fs::read(at.path("out/exports/tiny.json")).unwrap();
    assert_eq!(model, exported, "the JSON export is the model file");
    run().success();
    let results: serde_json::Value = serde_json::from_slice(&std::fs::read(at.path("out/run.json")).unwrap()).unwrap();
    let result = &results["results"][0];
    assert_eq!(
        (
            results["command"].as_str(),
            result["network"].as_str(),
            result["backend"].as_str()
        ),
        (Some("run"), Some("7-8-4-1"), Some("fused"))
    );
    for key in [
        "transmittance_mse",
        "validation_loss",
        "samples_per_second",
        "total_seconds",
    ] {
        assert!(result[key].as_f64().unwrap() > 0.0, "{key}");
    }
    assert_eq!(result["nonfinite"], 0);
    // The shader's header states what was measured.
    let header = std::fs::read_to_string(at.path("out/exports/tiny.wgsl")).unwrap();
    assert!(header.contains("mean squared error of T") && header.contains("seed 5"));
}

#[test]
fn run_leaves_folders_of_others_alone() {
    let at = Workplace::new();
    std::fs::create_dir(at.path("out")).unwrap();
    at.write("out/thesis.txt", "mine");
    nmt(&["run", &at.config(), "--out", &at.path("out")])
        .code(2)
        .stderr(contains("did not make"));
    assert_eq!(std::fs::read_dir(at.path("out")).unwrap().count(), 1);

    // In a folder of its own it replaces its own files only, and no other configuration's run.
    nmt(&["run", &at.config(), "--out", &at.path("mine"), "--epochs", "1"]).success();
    at.write("mine/exports/note.txt", "keep");
    nmt(&["run", &at.config(), "--out", &at.path("mine"), "--epochs", "1"]).success();
    assert!(Path::new(&at.path("mine/exports/note.txt")).exists());
    let other = at.write("other.toml", &TINY.replacen("\"tiny\"", "\"other\"", 1));
    nmt(&["run", &other, "--out", &at.path("mine")])
        .code(2)
        .stderr(contains("configuration 'tiny'"));
}

/// A name where a configuration's path belongs is answered with the path. Control: another name with what is expected.
#[test]
fn names_of_configurations_are_understood() {
    let at = Workplace::new();
    std::fs::create_dir(at.path("configs")).unwrap();
    at.write("configs/paper.toml", TINY);
    for (name, answer) in [
        ("paper", "did you mean 'configs/paper.toml'?"),
        ("paper.toml", "did you mean 'configs/paper.toml'?"),
        ("tiny", "did you mean 'tiny.toml'?"),
        ("teapot", "ends in .toml, such as configs/paper.toml"),
    ] {
        let mut run = command(&["run", name]);
        run.current_dir(at.path("")).assert().code(2).stderr(contains(answer));
    }
}
