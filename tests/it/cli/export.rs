//! `nmt export`, and what is done with its files.

use crate::common::{Workplace, json, nmt};
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use std::path::Path;

#[test]
fn train_export_check_predict() {
    let at = Workplace::new();
    let model = at.model();
    nmt(&["train", &at.config(), "--out", &model])
        .code(2)
        .stderr(contains("already exists"));
    nmt(&[
        "train",
        &at.config(),
        "--out",
        &at.path("n.json"),
        "--backend",
        if cfg!(feature = "burn") { "ndarray" } else { "fused" },
        "--epochs",
        "2",
    ])
    .success();
    nmt(&["export", &model, "--out", &at.path("e"), "--format", "wgsl,onnx"])
        .success()
        .stdout(contains("tiny.wgsl"));
    nmt(&["export", &model, "--out", &at.path("e"), "--format", "onnx"])
        .code(2)
        .stderr(contains("--force"));
    nmt(&["check", &model, "--exports", &at.path("e"), "--format", "wgsl,onnx"])
        .success()
        .stdout(contains("weights bit for bit"));
    nmt(&["check", &model, "--exports", &at.path("e")])
        .code(1)
        .stdout(contains("tiny.glsl").and(contains("nmt export")));
    let report = json(nmt(&[
        "check",
        &model,
        "--exports",
        &at.path("e"),
        "--format",
        "onnx",
        "--json",
    ]));
    let numbers = report["results"]
        .as_array()
        .unwrap()
        .iter()
        .find(|r| r["tool"] == "interpreter")
        .unwrap();
    assert_eq!(
        (numbers["status"].as_str(), numbers["numbers"][0]["count"].as_u64()),
        (Some("passed"), Some(100_000))
    );

    nmt(&[
        "generate",
        &at.config(),
        "--out",
        &at.path("d"),
        "--fragments",
        &at.path("f.npz"),
    ])
    .success();
    let predict = |more: &[&str]| {
        nmt(&[
            &[
                "predict",
                &model,
                "--fragments",
                &at.path("f.npz"),
                "--out",
                &at.path("t.npy"),
            ],
            more,
        ]
        .concat())
    };
    predict(&[]).success().stdout(contains("T-MSE"));
    predict(&[]).code(2).stderr(contains("already exists"));
    let report = json(predict(&["--force", "--json"]));
    assert!(report["results"][0]["transmittance_mse"].as_f64().unwrap() < 0.2);
    predict(&["--force", "--near", "5", "--far", "100"])
        .code(2)
        .stderr(contains("outside the camera planes"));
    predict(&["--force", "--near", "5"]).code(2);
}

/// Exports in half precision have names of their own, and pass; what has no such form is named, and nothing is written.
#[test]
fn half_precision_is_offered_where_it_is() {
    let at = Workplace::new();
    let model = at.model();
    let half = |command: &str, folder: &str, more: &[&str]| {
        let flag = if command == "export" { "--out" } else { "--exports" };
        nmt(&[&[command, &model, flag, &at.path(folder), "--precision", "f16"], more].concat())
    };
    half("export", "e", &["--format", "wgsl,wgsl-plain,glsl"])
        .code(2)
        .stderr(contains("glsl has no f16 form"));
    assert!(!Path::new(&at.path("e")).exists());
    half("export", "e", &[]).success();
    let mut names: Vec<String> = std::fs::read_dir(at.path("e"))
        .unwrap()
        .map(|f| f.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(
        names,
        ["tiny.f16.hlsl", "tiny.f16.metal", "tiny.f16.spv", "tiny.f16.wgsl"]
    );
    half("check", "e", &[])
        .success()
        .stdout(contains("wgsl-f16").and(contains("interpreter")));
    half("check", "e", &["--format", "wgsl-plain"])
        .code(1)
        .stdout(contains("tiny.plain.f16.wgsl"));
}

/// A pruned export says so, and is held to the whole network by a check that is given that.
#[test]
fn pruned_exports_say_so() {
    let at = Workplace::new();
    let model = at.model();
    nmt(&[
        "export",
        &model,
        "--out",
        &at.path("e"),
        "--format",
        "wgsl,json",
        "--prune=0",
    ])
    .code(2)
    .stderr(contains("no row"));
    nmt(&[
        "export",
        &model,
        "--out",
        &at.path("e"),
        "--format",
        "wgsl,json,spirv",
        "--prune=1000000",
    ])
    .success()
    .stderr(contains("multiply-adds are left"));
    let text = std::fs::read_to_string(at.path("e/tiny.wgsl")).unwrap();
    assert!(
        text.contains("// Pruned: ") && text.contains("; 92 multiply-adds before"),
        "{text}"
    );
    // A GPU is given so many more rows that it may well meet a unit that fires once in a million.
    nmt(&["check", &model, "--exports", &at.path("e"), "--format", "json,spirv"])
        .success()
        .stdout(contains("would fire on"));
}

/// What may not be replaced is said before anything is sampled: here of a network that nothing can be sampled for, as
/// `--prune=0` shows. Control: elsewhere, and with `--force`, that is what is said.
#[test]
fn export_refuses_before_it_samples() {
    let at = Workplace::new();
    nmt(&["export", "small", "--out", &at.path("e"), "--format", "wgsl"]).success();
    for what in [["--format", "wgsl"].as_slice(), &["--passes"]] {
        let export = |folder: &str, more: &[&str]| {
            let out = at.path(folder);
            nmt(&[&["export", "small", "--prune=0", "--out", &out], what, more].concat()).code(2)
        };
        export("e", &[]).stderr(contains("already exists"));
        export("elsewhere", &[]).stderr(contains("--prune=0:"));
        export("e", &["--force"]).stderr(contains("--prune=0:"));
    }
}
