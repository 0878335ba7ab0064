//! `nmt generate`.

use crate::common::{TINY, Workplace, command, json, nmt};
use predicates::str::contains;
use std::path::Path;

#[test]
fn generate_is_repeatable_and_overwrites_nothing() {
    let at = Workplace::new();
    let generate =
        |out: &str, more: &[&str]| nmt(&[&["generate", &at.config(), "--json", "--out", &at.path(out)], more].concat());
    let first = json(generate("a", &["--fragments", &at.path("a.npz")]));
    let second = json(generate("b", &["--fragments", &at.path("b.npz")]));
    assert_eq!(first["results"][0]["hash"], second["results"][0]["hash"]);
    assert_eq!(
        std::fs::read(at.path("a.npz")).unwrap(),
        std::fs::read(at.path("b.npz")).unwrap()
    );
    for file in ["training_features.npy", "validation_targets.npy", "manifest.json"] {
        assert_eq!(
            std::fs::read(at.path("a").to_owned() + "/" + file).unwrap(),
            std::fs::read(at.path("b").to_owned() + "/" + file).unwrap()
        );
    }
    generate("a", &[]).code(2).stderr(contains("--force"));
    generate("c", &["--fragments", &at.path("a.npz")])
        .code(2)
        .stderr(contains("a.npz: already exists"));
    generate("a", &["--force"]).success();
}

/// The sample in `data/` is what its command makes, on this machine too.
#[test]
fn the_sample_is_what_its_command_makes() {
    let at = Workplace::new();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = root.join("configs/sample.toml");
    nmt(&[
        "generate",
        config.to_str().unwrap(),
        "--out",
        &at.path("sample"),
        "--fragments",
        &at.path("sample.npz"),
    ])
    .success();
    let mut files: Vec<String> = std::fs::read_dir(root.join("data/sample"))
        .unwrap()
        .map(|e| format!("sample/{}", e.unwrap().file_name().to_str().unwrap()))
        .collect();
    files.push("sample.npz".to_owned());
    assert_eq!(files.len(), 8);
    for file in files {
        assert!(
            std::fs::read(root.join("data").join(&file)).unwrap() == std::fs::read(at.path(&file)).unwrap(),
            "{file}"
        );
    }
}

#[test]
fn threads_change_no_byte() {
    let at = Workplace::new();
    for threads in ["1", "3"] {
        command(&["generate", &at.config(), "--out", &at.path(threads)])
            .env("RAYON_NUM_THREADS", threads)
            .assert()
            .success();
    }
    let read = |threads: &str| std::fs::read(at.path(threads) + "/manifest.json").unwrap();
    assert_eq!(read("1"), read("3"));
}

/// A dataset of scenes, and a network trained on it.
#[test]
fn datasets_come_from_scenes_too() {
    let at = Workplace::new();
    nmt(&[
        "generate",
        &at.config(),
        "--out",
        &at.path("d"),
        "--from",
        "spheres",
        "teapots",
        "--size",
        "64x48",
    ])
    .success();
    nmt(&[
        "train",
        &at.config(),
        "--dataset",
        &at.path("d"),
        "--out",
        &at.path("m.json"),
    ])
    .success();
    let manifest = std::fs::read_to_string(at.path("d/manifest.json")).unwrap();
    assert!(manifest.contains("teapots"));
    let huge = at.write(
        "huge.toml",
        &TINY.replacen("training_pairs = 2000", "training_pairs = 200000000", 1),
    );
    nmt(&[
        "generate",
        &huge,
        "--out",
        &at.path("h"),
        "--from",
        "spheres",
        "--size",
        "8x8",
    ])
    .code(2);
}
