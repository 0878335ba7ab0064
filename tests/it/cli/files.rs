//! Files that are damaged, missing, protected, or read by the command that writes.

use crate::common::{TINY, Workplace, nmt};
use assert_cmd::Command;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use std::path::Path;

/// No command replaces what it reads, even under --force; and an error says its cause once.
#[test]
fn inputs_are_kept() {
    let at = Workplace::new();
    let model = at.model();
    nmt(&["scene", "spheres", "--size", "8x8", "--out", &at.path("s.npz")]).success();
    let same = [
        vec!["predict", &model, "--fragments", "S", "--out", "S"],
        vec!["predict", &model, "--fragments", "S", "--out", &model],
        vec!["scene", "S", "--out", "S"],
        vec!["import", &model, "--out", &model],
    ];
    for arguments in same {
        let list = at.path("s.npz");
        let arguments: Vec<&str> = arguments
            .into_iter()
            .map(|a| if a == "S" { list.as_str() } else { a })
            .chain(["--force"])
            .collect();
        nmt(&arguments).code(2).stderr(contains("this very command"));
    }
    nmt(&["train", &at.config(), "--out", &at.config(), "--force"])
        .code(2)
        .stderr(contains("this very command"));
    let assert = nmt(&[
        "predict",
        &model,
        "--fragments",
        &at.path("none.npz"),
        "--out",
        &at.path("t.npy"),
    ])
    .code(2);
    let message = String::from_utf8(assert.get_output().stderr.clone()).unwrap();
    assert_eq!(message.matches("No such file").count(), 1, "{message}");
}

#[test]
fn bad_files() {
    let at = Workplace::new();
    let model = at.model();
    nmt(&[
        "generate",
        &at.config(),
        "--out",
        &at.path("d"),
        "--fragments",
        &at.path("f.npz"),
    ])
    .success();
    let whole = std::fs::read(at.path("f.npz")).unwrap();
    std::fs::write(at.path("cut.npz"), &whole[..whole.len() / 2]).unwrap();
    let predict =
        |fragments: &str| nmt(&["predict", &model, "--fragments", fragments, "--out", &at.path("t.npy")]).code(2);
    predict(&at.path("cut.npz")).stderr(contains("cut.npz: not a readable .npz archive"));
    predict(&at.config()).stderr(contains("tiny.toml").and(contains("unknown field")));
    predict(&at.write("text.npz", "not an archive")).stderr(contains("text.npz: not a readable .npz archive"));
    predict(&at.path("none.npz")).stderr(contains("none.npz: cannot read"));
    assert!(!Path::new(&at.path("t.npy")).exists());
    nmt(&["export", &at.config(), "--out", &at.path("e")])
        .code(2)
        .stderr(contains("not a model file"));
    nmt(&["export", &at.path("none.json"), "--out", &at.path("e")])
        .code(2)
        .stderr(contains("none.json: cannot read"));
    let newer = std::fs::read_to_string(&model)
        .unwrap()
        .replacen("\"version\": 1", "\"version\": 9", 1);
    nmt(&["export", &at.write("newer.json", &newer), "--out", &at.path("e")])
        .code(2)
        .stderr(contains("version 9"));
    nmt(&[
        "train",
        &at.config(),
        "--out",
        &at.path("x.json"),
        "--dataset",
        &at.path("e"),
    ])
    .code(2)
    .stderr(contains("manifest.json: cannot read"));
    let other = at.write("other.toml", &TINY.replacen("seed = 5", "seed = 6", 1));
    nmt(&["train", &other, "--out", &at.path("x.json"), "--dataset", &at.path("d")])
        .code(2)
        .stderr(contains("another configuration"));
    assert!(!Path::new(&at.path("e")).exists() && !Path::new(&at.path("x.json")).exists());
}

/// A file stands where a folder is needed: as refused by the system as a read-only folder is, also for root.
#[test]
fn unusable_output_folders() {
    let at = Workplace::new();
    let model = at.model();
    let file = at.write("file", "");
    let inside = file.clone() + "/x";
    nmt(&["generate", &at.config(), "--out", &inside])
        .code(2)
        .stderr(contains("cannot create the folder"));
    nmt(&["export", &model, "--out", &inside])
        .code(2)
        .stderr(contains("cannot create the folder"));
    nmt(&["run", &at.config(), "--out", &file])
        .code(2)
        .stderr(contains("output folder"));
    nmt(&["train", &at.config(), "--out", &(inside + "/m.json")])
        .code(2)
        .stderr(contains("cannot create the folder"));
}

/// A full disk: the error says so, and no file is left.
#[cfg(target_os = "linux")]
#[test]
fn full_disk() {
    let at = Workplace::new();
    let model = at.model();
    // A limit on the size of files fails a write as a full disk does. SIGXFSZ is ignored, so that the write itself
    // reports it.
    let script = format!(
        "trap '' XFSZ; ulimit -f 1; exec '{}' export '{model}' --out '{}' --format wgsl",
        env!("CARGO_BIN_EXE_nmt"),
        at.path("e")
    );
    Command::new("bash")
        .args(["-c", &script])
        .assert()
        .code(2)
        .stderr(contains("tiny.wgsl").and(contains("disk full")));
    assert_eq!(
        std::fs::read_dir(at.path("e")).unwrap().count(),
        0,
        "something half-written was left"
    );
}
