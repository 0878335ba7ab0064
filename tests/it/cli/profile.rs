//! `nmt profile`.

use crate::common::{Workplace, nmt, shipped};
use predicates::str::contains;
use std::path::Path;

#[test]
fn a_scene_is_profiled() {
    let w = Workplace::new();
    let out = w.path("profile");
    let run = nmt(&[
        "profile",
        "--fragments",
        "foliage",
        "--size",
        "48x48",
        "--repeat",
        "1",
        "--out",
        &out,
    ])
    .success();
    let text = String::from_utf8(run.get_output().stdout.clone()).unwrap();
    for part in [
        "one of four",
        "hidden",
        "tiles of 8 x 8",
        "recommended",
        "moments-6",
        "exact + faint",
        "1/512",
        "image MSE",
    ] {
        assert!(text.contains(part), "{part} is missing in {text}");
    }
    let json: serde_json::Value =
        serde_json::from_slice(&std::fs::read(Path::new(&out).join("profile.json")).unwrap()).unwrap();
    let result = &json["results"][0];
    let shares: f64 = result["facts"]["classes"]
        .as_array()
        .unwrap()
        .iter()
        .map(|c| c["share"].as_f64().unwrap())
        .sum();
    assert!((shares - 1.0).abs() < 1e-9);
    assert_eq!(result["skipping"][1]["image"]["greatest_change"], 0.0);
    assert!(
        std::fs::read_to_string(Path::new(&out).join("profile.svg"))
            .unwrap()
            .starts_with("<svg")
    );
    nmt(&["profile", "--fragments", "foliage", "--size", "48x48", "--out", &out])
        .code(2)
        .stderr(contains("--force"));
    nmt(&["profile", "--fragments", "foliage", "--target-error", "0"])
        .code(2)
        .stderr(contains("greater than 0"));
    nmt(&[
        "profile",
        "--fragments",
        "foliage",
        "--specialise",
        &shipped("small.json"),
    ])
    .code(2)
    .stderr(contains("--out"));
}

#[test]
fn networks_are_made_for_a_scene() {
    let w = Workplace::new();
    let (model, simple) = (shipped("paper.json"), w.path("simple.json"));
    nmt(&[
        "profile",
        "--fragments",
        "spheres",
        "--size",
        "48x48",
        "--simplify",
        &model,
        "--out",
        &simple,
    ])
    .success()
    .stdout(contains("identical bits"));
    let text = std::fs::read_to_string(&simple).unwrap();
    assert!(text.contains("\"derived\"") && text.contains("on every row on which none of the removed units fires"));
    nmt(&["export", &simple, "--out", &w.path("shaders")]).success();
    let own = w.path("own.json");
    nmt(&[
        "profile",
        "--fragments",
        "teapots",
        "--size",
        "48x48",
        "--specialise",
        &shipped("small.json"),
        "--out",
        &own,
    ])
    .code(2)
    .stderr(contains("at least 1000"));
    assert!(!Path::new(&own).exists());
}
