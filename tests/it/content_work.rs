//! Finished work is never replaced without a word, two processes never work at one place, and what was interrupted goes
//! on.

use assert_cmd::Command;
use serde_json::Value;
use std::path::Path;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

fn config(seed: u64, epochs: u64, pairs: u64) -> String {
    format!(
        "name = \"tiny\"\nseed = {seed}\n[synth]\ncamera = {{ near = 0.1, far = 100.0 }}\n[[synth.pixels]]\nfragments \
            = {{ min = 2, max = 8 }}\n\
         depth = {{ law = \"window\", min = 0.3, max = 1.0 }}\nalpha = {{ law = \"uniform\", min = 0.1, max = 0.5 \
         }}\n[dataset]\nfeatures = \"paper\"\n\
         training_pairs = {pairs}\nvalidation_pairs = 500\n[train]\nhidden = [8, 4]\nepochs = {epochs}\nbatch = \
         256\nlearning_rate = 1e-2\n[evaluate]\npairs = 1000\n"
    )
}

fn nmt(args: &[&str]) -> Command {
    let mut command = Command::cargo_bin("nmt").unwrap();
    command.args(args).arg("--quiet");
    command
}

fn spawn(args: &[&str]) -> Child {
    std::process::Command::new(assert_cmd::cargo::cargo_bin("nmt"))
        .args(args)
        .arg("--quiet")
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

fn message(command: &mut Command) -> String {
    let output = command.output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn wait_for(path: &Path) {
    let start = Instant::now();
    while !path.exists() {
        assert!(
            start.elapsed() < Duration::from_secs(60),
            "{} does not come",
            path.display()
        );
        std::thread::sleep(Duration::from_millis(5));
    }
}

struct Place(tempfile::TempDir);

impl Place {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn write(&self, name: &str, text: &str) -> String {
        std::fs::write(self.0.path().join(name), text).unwrap();
        self.path(name)
    }

    fn path(&self, name: &str) -> String {
        self.0.path().join(name).to_str().unwrap().to_owned()
    }

    fn bytes(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.0.path().join(name)).unwrap()
    }
}

#[test]
fn a_finished_run_is_replaced_by_its_own_configuration_alone() {
    let at = Place::new();
    let (first, out) = (at.write("a.toml", &config(1, 3, 2000)), at.path("o"));
    nmt(&["run", &first, "--out", &out]).assert().success();
    let model = at.bytes("o/model.json");
    for (name, text, part) in [
        ("b.toml", config(2, 3, 2000), "seed was 1 and is 2"),
        ("c.toml", config(1, 4, 2000), "train.epochs was 3 and is 4"),
        (
            "d.toml",
            config(1, 3, 2000).replace("1e-2", "2e-2"),
            "train.learning_rate",
        ),
    ] {
        let said = message(&mut nmt(&["run", &at.write(name, &text), "--out", &out]));
        assert!(said.contains(part) && said.contains("--force"), "{said}");
    }
    assert_eq!(at.bytes("o/model.json"), model);
    // The same again is the same to the byte, but for how long it took.
    nmt(&["run", &first, "--out", &out]).assert().success();
    assert!(Path::new(&at.path("o/model.json")).exists());
    nmt(&["run", &at.path("b.toml"), "--out", &out, "--force"])
        .assert()
        .success();
    assert_ne!(at.bytes("o/model.json"), model);
    let marker: Value = serde_json::from_slice(&at.bytes("o/run.json")).unwrap();
    assert_eq!(marker["results"][0]["config"]["seed"], 2);
    assert!(!Path::new(&at.path("o/run.lock")).exists());
}

#[test]
fn the_second_at_one_place_is_refused_at_once() {
    let at = Place::new();
    let (long, other) = (
        at.write("a.toml", &config(1, 1_000_000, 2000)),
        at.write("b.toml", &config(2, 3, 2000)),
    );
    for (command, lock) in [("run", "o/run.lock"), ("train", "m.checkpoint.lock")] {
        let out = at.path(if command == "run" { "o" } else { "m.json" });
        let mut child = spawn(&[command, &long, "--out", &out]);
        wait_for(Path::new(&at.path(lock)));
        let start = Instant::now();
        for config in [&long, &other] {
            let said = message(&mut nmt(&[command, config, "--out", &out]));
            assert!(
                said.contains("another nmt") && said.contains(&child.id().to_string()),
                "{said}"
            );
        }
        assert!(start.elapsed() < Duration::from_secs(30));
        child.kill().unwrap();
        child.wait().unwrap();
        // What was killed holds nothing any more.
        let mut child = spawn(&[command, &long, "--out", &out, "--force"]);
        std::thread::sleep(Duration::from_millis(500));
        assert!(child.try_wait().unwrap().is_none());
        child.kill().unwrap();
        child.wait().unwrap();
    }
}

#[cfg(unix)]
#[test]
fn nothing_temporary_outlives_an_interrupt() {
    let at = Place::new();
    let large = at.write("a.toml", &config(1, 3, 400_000));
    // Whenever it comes, in the middle of a file as well.
    for milliseconds in [50, 150, 300, 600] {
        let mut child = spawn(&["run", &large, "--out", &at.path("o")]);
        std::thread::sleep(Duration::from_millis(milliseconds));
        let killed = std::process::Command::new("kill")
            .args(["-INT", &child.id().to_string()])
            .status();
        assert!(killed.unwrap().success());
        child.wait().unwrap();
        let left = walk(Path::new(&at.path("o")));
        assert!(
            left.iter().all(|p| !p.contains(".nmt-") && !p.ends_with(".lock")),
            "after {milliseconds} ms: {left:?}"
        );
    }
}

#[cfg(unix)]
fn walk(folder: &Path) -> Vec<String> {
    let mut out = Vec::new();
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        if entry.path().is_dir() {
            out.extend(walk(&entry.path()));
        } else {
            out.push(entry.path().display().to_string());
        }
    }
    out
}

/// Window systems' libraries find no display, and say nothing about it.
#[test]
fn no_error_is_printed_that_is_none() {
    let at = Place::new();
    let (out, model) = (at.path("e"), concat!(env!("CARGO_MANIFEST_DIR"), "/models/small.json"));
    nmt(&["export", model, "--out", &out]).assert().success();
    let output = Command::cargo_bin("nmt")
        .unwrap()
        .args(["check", model, "--exports", &out])
        .env_remove("XDG_RUNTIME_DIR")
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!said.contains("XDG_RUNTIME_DIR"), "{said}");
}
