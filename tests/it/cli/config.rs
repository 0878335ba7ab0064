//! Configuration files.

use crate::common::{TINY, Workplace, nmt};
use predicates::str::contains;
use std::path::Path;

/// Every configuration that is shipped is valid; a dataset of a few pixels is made of each.
#[test]
fn shipped_configurations_are_valid() {
    let at = Workplace::new();
    let mut files = Vec::new();
    for entry in std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("configs")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "toml") {
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        let small: String = text
            .lines()
            .map(|l| {
                if l.contains("_pairs = ") {
                    format!("{} = 50\n", l.split(" = ").next().unwrap())
                } else {
                    format!("{l}\n")
                }
            })
            .collect();
        // Under their own names, since some extend others.
        files.push(at.write(path.file_name().unwrap().to_str().unwrap(), &small));
    }
    assert!(files.len() >= 6);
    for (index, file) in files.iter().enumerate() {
        nmt(&["generate", file, "--out", &at.path(&format!("d{index}"))]).success();
    }
}

/// A file that extends another changes what it names and nothing else; a base that is missing, or extends another
/// itself, is named.
#[test]
fn configurations_extend_one_another() {
    let at = Workplace::new();
    let base = at.config();
    let name = Path::new(&base).file_name().unwrap().to_str().unwrap().to_owned();
    let child = at.write(
        "child.toml",
        &format!("extends = \"{name}\"\nname = \"child\"\n[train]\nhidden = [3]\n"),
    );
    nmt(&["train", &child, "--epochs", "1", "--out", &at.path("child.json")]).success();
    let model: serde_json::Value = serde_json::from_slice(&std::fs::read(at.path("child.json")).unwrap()).unwrap();
    assert_eq!(
        (model["name"].as_str(), model["layer_sizes"].as_array().unwrap().len()),
        (Some("child"), 3)
    );
    let lost = at.write("lost.toml", "extends = \"nowhere.toml\"");
    nmt(&["generate", &lost, "--out", &at.path("x")])
        .code(2)
        .stderr(contains("nowhere.toml"));
    let twice = at.write("twice.toml", "extends = \"child.toml\"");
    nmt(&["generate", &twice, "--out", &at.path("x")])
        .code(2)
        .stderr(contains("extends another file itself"));
    let wrong = at.write("wrong.toml", &format!("extends = \"{name}\"\n[train]\nhiden = [3]\n"));
    nmt(&["generate", &wrong, "--out", &at.path("x")])
        .code(2)
        .stderr(contains("unknown field `hiden`"));
}

/// Every error of a configuration names the file and the field; nothing is written.
#[test]
fn bad_configurations() {
    let at = Workplace::new();
    let mut messages = Vec::new();
    for (from, to) in [
        ("seed = 5", "seed = 5\nsurprise = 1"),
        ("min = 2, max = 8", "min = 0, max = 8"),
        ("min = 2, max = 8", "min = 9, max = 8"),
        ("min = 0.1, max = 0.5", "min = 0.5, max = 0.1"),
        ("min = 0.1, max = 0.5", "min = nan, max = 0.5"),
        ("near = 0.1", "near = 200.0"),
        ("features = \"paper\"", "features = \"mine\""),
        ("training_pairs = 2000", "training_pairs = 0"),
        ("hidden = [8, 4]", "hidden = [0]"),
        ("epochs = 4", "epochs = 0"),
        ("learning_rate = 1e-2", "learning_rate = inf"),
        ("name = \"tiny\"", "name = \"../tiny\""),
        ("pairs = 1000\n", "pairs = 0\n"),
        ("[train]", "[trian]"),
        ("[synth]", "[synth"),
    ] {
        assert!(TINY.contains(from), "{from}");
        let path = at.write("bad.toml", &TINY.replacen(from, to, 1));
        let assert = nmt(&["run", &path, "--out", &at.path("out")]).code(2);
        let message = String::from_utf8(assert.get_output().stderr.clone()).unwrap();
        messages.push(message.replace(&path, "bad.toml"));
    }
    assert!(!Path::new(&at.path("out")).exists());
    insta::assert_snapshot!(messages.join("\n"));
}
