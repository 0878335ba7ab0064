//! What the test binaries share: a folder of a test's own, the program, and what is shipped beside it.

// Each binary uses its own part.
#![allow(dead_code)]

use assert_cmd::Command;
use assert_cmd::assert::Assert;
use std::path::Path;

/// A folder of a test's own, with a configuration that takes well under a second.
pub struct Workplace(tempfile::TempDir);

/// The configuration of a workplace.
pub const TINY: &str = r#"
name = "tiny"
seed = 5
[synth]
camera = { near = 0.1, far = 100.0 }
[[synth.pixels]]
fragments = { min = 2, max = 8 }
depth = { law = "window", min = 0.3, max = 1.0 }
alpha = { law = "uniform", min = 0.1, max = 0.5 }
[dataset]
features = "paper"
training_pairs = 2000
validation_pairs = 500
[train]
hidden = [8, 4]
epochs = 4
batch = 256
learning_rate = 1e-2
[evaluate]
pairs = 1000
"#;

impl Workplace {
    /// An empty folder but for the configuration.
    pub fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("tiny.toml"), TINY).unwrap();
        Self(folder)
    }

    /// Where a file of that name lies in the folder.
    pub fn path(&self, name: &str) -> String {
        self.0.path().join(name).to_str().unwrap().to_owned()
    }

    /// The configuration [`TINY`].
    pub fn config(&self) -> String {
        self.path("tiny.toml")
    }

    /// Writes a file and says where it lies.
    pub fn write(&self, name: &str, text: &str) -> String {
        std::fs::write(self.0.path().join(name), text).unwrap();
        self.path(name)
    }

    /// A trained model.
    pub fn model(&self) -> String {
        nmt(&["train", &self.config(), "--out", &self.path("m.json")]).success();
        self.path("m.json")
    }
}

/// The program with arguments.
pub fn command(arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("nmt").unwrap();
    command.args(arguments);
    command
}

/// Runs the program.
pub fn nmt(arguments: &[&str]) -> Assert {
    command(arguments).assert()
}

/// The object that a command printed under `--json`.
pub fn json(assert: Assert) -> serde_json::Value {
    serde_json::from_slice(&assert.success().get_output().stdout).unwrap()
}

/// Where a shipped network lies.
pub fn shipped(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("models")
        .join(name)
        .to_str()
        .unwrap()
        .to_owned()
}
