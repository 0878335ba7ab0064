//! The command line as a user types it.

use assert_cmd::Command;
use assert_cmd::assert::Assert;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use std::path::Path;

/// A folder of a test's own, with a configuration that takes well under a second.
pub struct Workplace(tempfile::TempDir);

const TINY: &str = r#"
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
    pub fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("tiny.toml"), TINY).unwrap();
        Self(folder)
    }

    pub fn path(&self, name: &str) -> String {
        self.0.path().join(name).to_str().unwrap().to_owned()
    }

    pub fn config(&self) -> String {
        self.path("tiny.toml")
    }

    fn write(&self, name: &str, text: &str) -> String {
        std::fs::write(self.0.path().join(name), text).unwrap();
        self.path(name)
    }

    /// A trained model.
    fn model(&self) -> String {
        nmt(&["train", &self.config(), "--out", &self.path("m.json")]).success();
        self.path("m.json")
    }
}

fn command(arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("nmt").unwrap();
    command.args(arguments);
    command
}

pub fn nmt(arguments: &[&str]) -> Assert {
    command(arguments).assert()
}

fn json(assert: Assert) -> serde_json::Value {
    serde_json::from_slice(&assert.success().get_output().stdout).unwrap()
}

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

/// A file that extends another changes what it names and nothing else; a base that is missing, or extends another itself, is named.
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
        .find(|r| r["tool"] == "rten")
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
    let required = std::env::var("NMT_REQUIRE").unwrap_or_default();
    if std::env::var_os("ORT_DYLIB_PATH").is_none() && !required.split(',').any(|t| t == "onnxruntime") {
        eprintln!("SKIPPED: ORT_DYLIB_PATH is not set; scripts/test sets it");
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

#[test]
fn import_takes_foreign_weights() {
    let at = Workplace::new();
    let row = "[0.5, -0.25],".repeat(6) + "[1, 2]";
    let foreign = at.write(
        "w.json",
        &format!(r#"{{"source": "elsewhere", "layers": [{{"weights": [{row}], "bias": [0, 1]}}, {{"weights": [[1], [1]], "biases": [0]}}]}}"#),
    );
    nmt(&["import", &foreign, "--out", &at.path("i.json")])
        .success()
        .stdout(contains("7-2-1"));
    nmt(&["export", &at.path("i.json"), "--out", &at.path("e")]).success();
    nmt(&["check", &at.path("i.json"), "--exports", &at.path("e")]).success();
    nmt(&["import", &foreign, "--out", &at.path("j.json"), "--features", "none"])
        .code(2)
        .stderr(contains("known are paper"));
    nmt(&["import", &at.config(), "--out", &at.path("j.json")])
        .code(2)
        .stderr(contains("not a model file"));
    assert!(!Path::new(&at.path("j.json")).exists());
}

/// A scene to a fragment list, to a deep image and back: the same fragments.
#[test]
fn scenes_become_fragment_lists() {
    let at = Workplace::new();
    let report = json(nmt(&[
        "scene",
        "spheres",
        "--size",
        "48x32",
        "--out",
        &at.path("s.npz"),
        "--json",
    ]));
    let result = &report["results"][0];
    assert_eq!(
        (
            result["width"].as_u64(),
            result["height"].as_u64(),
            result["pixels"].as_u64()
        ),
        (Some(48), Some(32), Some(48 * 32))
    );
    assert!(result["fragments"].as_u64().unwrap() > 1000);
    nmt(&["scene", "spheres", "--size", "48x32", "--out", &at.path("s.npz")])
        .code(2)
        .stderr(contains("--force"));
    nmt(&["scene", &at.path("s.npz"), "--out", &at.path("s.exr")]).success();
    let back = json(nmt(&["scene", &at.path("s.exr"), "--out", &at.path("b.npz"), "--json"]));
    assert_eq!(back["results"][0]["fragments"], result["fragments"]);
    for scene in ["configs/scenes/house.toml", "configs/scenes/smoke.toml"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(scene);
        nmt(&[
            "scene",
            path.to_str().unwrap(),
            "--size",
            "32x32",
            "--out",
            &at.path("t.npz"),
            "--force",
        ])
        .success();
    }
    nmt(&["scene", "castle", "--out", &at.path("c.npz")])
        .code(2)
        .stderr(contains("glass-stacks"));
    nmt(&["scene", "smoke", "--size", "0x9", "--out", &at.path("c.npz")]).code(2);
    nmt(&["scene", "smoke", "--size", "99999x99999", "--out", &at.path("c.npz")]).code(2);
    nmt(&["scene", "smoke", "--out", &at.path("c.png")])
        .code(2)
        .stderr(contains("c.png"));
    nmt(&["scene", &at.path("s.npz"), "--size", "8x8", "--out", &at.path("c.npz")])
        .code(2)
        .stderr(contains("--size"));
    nmt(&[
        "scene",
        &at.write("bad.exr", "not an image"),
        "--out",
        &at.path("c.npz"),
    ])
    .code(2)
    .stderr(contains("bad.exr"));
    nmt(&[
        "scene",
        &at.write("bad.toml", "built_in = 'smoke'\nsurprise = 1"),
        "--out",
        &at.path("c.npz"),
    ])
    .code(2)
    .stderr(contains("surprise"));
    assert!(!Path::new(&at.path("c.npz")).exists());
}

/// Methods beside a network on a rendered scene: a table, pictures, a contact sheet, numbers; and the exact method is exact.
#[test]
fn evaluate_compares_methods() {
    let at = Workplace::new();
    let model = at.model();
    nmt(&["scene", "glass-stacks", "--size", "40x30", "--out", &at.path("g.npz")]).success();
    let methods = "abuffer,moment-power-4,moment-power-8+own,weighted-average";
    let evaluate = |out: &str, more: &[&str]| {
        nmt(&[
            &[
                "evaluate",
                "--fragments",
                &at.path("g.npz"),
                "--methods",
                methods,
                "--out",
                &at.path(out),
            ],
            more,
        ]
        .concat())
    };
    evaluate("e", &["--model", &model]).success().stdout(
        contains("moment-power-4")
            .and(contains("neural:tiny"))
            .and(contains("unbounded")),
    );
    for file in [
        "results.json",
        "g/truth.png",
        "g/sheet.png",
        "g/moment-power-4.png",
        "g/moment-power-4.flip.png",
        "g/neural-tiny.png",
    ] {
        assert!(Path::new(&at.path("e")).join(file).is_file(), "{file}");
    }
    evaluate("e", &[]).code(2).stderr(contains("--force"));
    let report = json(evaluate("e", &["--force", "--json"]));
    let of = |method: &str| {
        report["results"]
            .as_array()
            .unwrap()
            .iter()
            .find(|r| r["method"] == method)
            .unwrap()
            .clone()
    };
    assert!(
        of("abuffer")["image_mse"].as_f64().unwrap() < 1e-20
            && of("abuffer")["transmittance_mse"].as_f64().unwrap() < 1e-20
    );
    let (four, average) = (of("moment-power-4"), of("weighted-average"));
    assert!(four["image_mse"].as_f64().unwrap() < average["image_mse"].as_f64().unwrap());
    assert!(average["transmittance_mse"].is_null() && four["scene"] == "g");

    evaluate("x", &["--background", "2", "0", "0"])
        .code(2)
        .stderr(contains("background"));
    nmt(&[
        "evaluate",
        "--fragments",
        &at.path("g.npz"),
        "--methods",
        "moment-power-5",
        "--out",
        &at.path("x"),
    ])
    .code(2)
    .stderr(contains("moment-power-4"));
    assert!(!Path::new(&at.path("x")).exists());
}

/// The GPU draws what has a shader, and what has none is named; without a GPU there is an error, and no result.
#[test]
fn evaluate_draws_on_the_gpu() {
    let at = Workplace::new();
    let small = concat!(env!("CARGO_MANIFEST_DIR"), "/models/small.json");
    let evaluate = |out: &str, more: &[&str]| {
        let plain = [
            "evaluate",
            "--fragments",
            "spheres",
            "--size",
            "40x30",
            "--methods",
            "abuffer,weighted-average",
            "--model",
            small,
            "--out",
        ];
        nmt(&[&plain[..], &[&at.path(out), "--gpu"], more].concat())
    };
    if let Err(why) = nmt::gpu::Gpu::shared() {
        let required = std::env::var("NMT_REQUIRE").unwrap_or_default();
        assert!(
            !required.split(',').any(|tool| tool.trim() == "gpu"),
            "a GPU is required: {why}"
        );
        println!("skipped: {why}");
        evaluate("e", &[]).code(2).stderr(contains("no GPU adapter"));
        assert!(!Path::new(&at.path("e")).exists());
        return;
    }
    evaluate("e", &[])
        .success()
        .stdout(contains("against the images above").and(contains("abuffer has no shader")));
    for file in [
        "neural-small.gpu.png",
        "neural-small.gpu.flip.png",
        "weighted-average.gpu.png",
    ] {
        assert!(Path::new(&at.path("e/spheres")).join(file).is_file(), "{file}");
    }
    assert!(!Path::new(&at.path("e/spheres/abuffer.gpu.png")).exists());
    for storage in ["full", "half-color", "half"] {
        let report = json(evaluate("e", &["--force", "--json", "--gpu-storage", storage]));
        let result = report["results"]
            .as_array()
            .unwrap()
            .iter()
            .find(|r| r["method"] == "neural:small")
            .unwrap();
        let gpu = &result["gpu"];
        let within = gpu["channel_difference_999"].as_f64().unwrap();
        assert!(
            within <= if storage == "full" { 1e-3 } else { 0.05 },
            "{storage}: {within}"
        );
        assert!(
            gpu["seconds_weights"].as_f64().unwrap() > 0.0
                && !gpu["adapter"].as_str().unwrap().is_empty()
                && gpu["image_nonfinite"] == 0
        );
    }
    nmt(&[
        "evaluate",
        "--fragments",
        "spheres",
        "--out",
        &at.path("x"),
        "--gpu-storage",
        "half",
    ])
    .code(2)
    .stderr(contains("--gpu"));
}

/// Without colours and size there are errors of T, and a word about the missing pictures.
#[test]
fn evaluate_does_without_pictures() {
    let at = Workplace::new();
    nmt(&[
        "generate",
        &at.config(),
        "--out",
        &at.path("d"),
        "--fragments",
        &at.path("f.npz"),
    ])
    .success();
    nmt(&[
        "evaluate",
        "--fragments",
        &at.path("f.npz"),
        "--methods",
        "moment-power-6",
        "--out",
        &at.path("e"),
    ])
    .success()
    .stdout(contains("no pictures").and(contains("moment-power-6")));
    nmt(&[
        "evaluate",
        "--fragments",
        &at.path("f.npz"),
        "--methods",
        "low-resolution-moments:2",
        "--out",
        &at.path("e"),
        "--force",
    ])
    .code(2)
    .stdout(contains("not applied"));
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
    predict(&at.config()).stderr(contains("ends in .npz or .exr"));
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
    // A limit on the size of files fails a write as a full disk does. SIGXFSZ is ignored, so that the write itself reports it.
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

/// Ctrl-C in training: exit code 130, a checkpoint, and `--resume` ends with the very model of an undisturbed training.
#[cfg(unix)]
#[test]
fn ctrl_c_leaves_a_resumable_checkpoint() {
    use std::process::{Command as Process, Stdio};
    let at = Workplace::new();
    let config = at.write(
        "long.toml",
        &TINY.replacen("epochs = 4", "epochs = 2000\ncheckpoint_every = 1", 1),
    );
    let out = at.path("long.json");
    let checkpoint = at.path("long.checkpoint.json");
    let mut child = Process::new(env!("CARGO_BIN_EXE_nmt"))
        .args(["train", &config, "--out", &out])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let epochs = || -> usize {
        let text = std::fs::read(&checkpoint).unwrap_or_default();
        serde_json::from_slice::<serde_json::Value>(&text)
            .ok()
            .and_then(|v| v["history"].as_array().map(Vec::len))
            .unwrap_or(0)
    };
    while epochs() < 3 {
        assert!(
            child.try_wait().unwrap().is_none(),
            "training ended before it was interrupted"
        );
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    assert!(
        Process::new("kill")
            .args(["-INT", &child.id().to_string()])
            .status()
            .unwrap()
            .success()
    );
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let done = epochs();
    assert!((3..2000).contains(&done) && !Path::new(&out).exists());

    // Without a word about the checkpoint nothing is thrown away.
    nmt(&["train", &config, "--out", &out])
        .code(2)
        .stderr(contains("--resume"));
    let target = (done + 5).to_string();
    nmt(&["train", &config, "--out", &out, "--resume", "--epochs", &target]).success();
    assert!(!Path::new(&checkpoint).exists());
    nmt(&["train", &config, "--out", &out, "--resume"])
        .code(2)
        .stderr(contains("already exists"));
    nmt(&[
        "train",
        &config,
        "--out",
        &at.path("straight.json"),
        "--epochs",
        &target,
    ])
    .success();
    let layers = |path: &str| {
        serde_json::from_slice::<serde_json::Value>(&std::fs::read(path).unwrap()).unwrap()["layers"].clone()
    };
    assert_eq!(layers(&out), layers(&at.path("straight.json")));
}

/// What a benchmark of tiny sizes prints as JSON; every result has these numbers, all greater than 0, and one raw sample a repetition.
fn bench(arguments: &[&str], numbers: &[&str]) -> Vec<serde_json::Value> {
    let tiny = ["--repeat", "2", "--sample-seconds", "0.001", "--threads", "2", "--json"];
    let report = json(nmt(&[&["bench"], arguments, &tiny].concat()));
    assert_eq!(report["command"], "bench");
    let results = report["results"].as_array().unwrap().clone();
    for result in &results {
        assert_eq!(
            (&result["benchmark"], &result["threads"]),
            (&serde_json::Value::from(arguments[0]), &2.into())
        );
        for key in ["seconds", "min_seconds", "max_seconds", "calls_per_repetition"]
            .iter()
            .chain(numbers)
        {
            let number = result[key]
                .as_f64()
                .unwrap_or_else(|| panic!("{key} is missing in {result}"));
            assert!(number.is_finite() && number > 0.0, "{key} = {number}");
        }
        assert_eq!(result["raw_seconds"].as_array().unwrap().len(), 2);
    }
    results
}

#[test]
fn bench_train_measures_every_backend() {
    let numbers = [
        "samples_per_second",
        "gflops",
        "share_of_peak",
        "multiply_add_peak_gflops",
        "batch",
    ];
    let results = bench(
        &["train", "--network", "7-8-4-1,9-8-1", "--batch", "64", "--rows", "300"],
        &numbers,
    );
    let names: Vec<_> = results
        .iter()
        .map(|r| {
            (
                r["network"].as_str().unwrap(),
                r["backend"].as_str().unwrap(),
                r["simd"].is_null(),
            )
        })
        .collect();
    let of = |network| {
        [
            Some((network, "fused", false)),
            cfg!(feature = "flex").then_some((network, "flex", true)),
            cfg!(feature = "burn").then_some((network, "ndarray", true)),
        ]
        .into_iter()
        .flatten()
        .collect::<Vec<_>>()
    };
    assert_eq!(names, [of("7-8-4-1"), of("9-8-1")].concat());

    // On the rows of a dataset, which the network must fit.
    let at = Workplace::new();
    nmt(&["generate", &at.config(), "--out", &at.path("d")]).success();
    let on = [
        "train",
        "--dataset",
        &at.path("d"),
        "--backend",
        "fused",
        "--batch",
        "256",
    ];
    assert_eq!(bench(&on, &numbers).len(), 1);
    nmt(&[&["bench"], &on[..], &["--network", "9-8-1"]].concat())
        .code(2)
        .stderr(contains("9-8-1 takes 9 features, but the rows have 7"));
    nmt(&["bench", "train", "--dataset", &at.path("d"), "--batch", "4096"])
        .code(2)
        .stderr(contains("fewer than the 4096"));
    let table = [
        "bench",
        "train",
        "--backend",
        "fused",
        "--batch",
        "64",
        "--rows",
        "64",
        "--repeat",
        "2",
        "--sample-seconds",
        "0.001",
        "--quiet",
    ];
    nmt(&table)
        .success()
        .stderr("")
        .stdout(contains("samples/s").and(contains("multiply-add peak")));
}

/// Whole epochs with fresh pixels, against rows in memory and against what both halves allow.
#[test]
fn bench_train_measures_streams() {
    let at = Workplace::new();
    let streamed = at.write(
        "streamed.toml",
        &TINY.replacen("training_pairs", "refresh = 0.25\ntraining_pairs", 1),
    );
    let numbers = [
        "samples_per_second",
        "in_memory_samples_per_second",
        "pairs_per_second",
        "bound_samples_per_second",
        "batch",
        "rows",
        "refresh",
    ];
    let results = bench(&["train", "--stream", &streamed], &numbers);
    assert_eq!(
        results
            .iter()
            .map(|r| (&r["stream"], &r["backend"], &r["network"]))
            .collect::<Vec<_>>(),
        [(&"tiny".into(), &"fused".into(), &"7-8-4-1".into())]
    );
    let rate = |key: &str| results[0][key].as_f64().unwrap();
    let bound = 1.0 / (1.0 / rate("in_memory_samples_per_second") + 0.25 / rate("pairs_per_second"));
    assert!((rate("bound_samples_per_second") / bound - 1.0).abs() < 1e-9);
    let tiny = [
        "--backend",
        "fused",
        "--repeat",
        "1",
        "--sample-seconds",
        "0.001",
        "--quiet",
    ];
    nmt(&[&["bench", "train", "--stream", &streamed], &tiny[..]].concat())
        .success()
        .stdout(contains("of bound").and(contains("fused")));
    nmt(&["bench", "train", "--stream", &at.config()])
        .code(2)
        .stderr(contains("dataset.refresh of 'tiny' is 0"));
    nmt(&["bench", "train", "--stream", &streamed, "--batch", "64"])
        .code(2)
        .stderr(contains("--batch"));
}

/// Backends that this program was built without say how to build it, before anything is made.
#[test]
fn backends_that_are_not_built_in() {
    let at = Workplace::new();
    for (name, built) in [("wgpu", cfg!(feature = "wgpu")), ("cuda", cfg!(feature = "cuda"))] {
        if built {
            continue;
        }
        let message = format!("--features {name}");
        nmt(&["train", &at.config(), "--out", &at.path("b.json"), "--backend", name])
            .code(2)
            .stderr(contains(message.as_str()));
        nmt(&["run", &at.config(), "--out", &at.path("run"), "--backend", name])
            .code(2)
            .stderr(contains(message.as_str()));
        nmt(&["bench", "train", "--backend", name])
            .code(2)
            .stderr(contains(message.as_str()));
    }
    assert!(!Path::new(&at.path("b.json")).exists() && !Path::new(&at.path("run")).exists());
    nmt(&["train", "--help"])
        .success()
        .stdout(contains("wgpu").and(contains("cuda")));
}

/// burn on a GPU that is not there: an error before anything is made, and no panic.
#[test]
#[cfg(any(feature = "wgpu", feature = "cuda"))]
fn gpus_that_are_not_there() {
    let at = Workplace::new();
    for name in [
        cfg!(feature = "wgpu").then_some("wgpu"),
        cfg!(feature = "cuda").then_some("cuda"),
    ]
    .into_iter()
    .flatten()
    {
        let without = |arguments: &[&str]| {
            let mut command = command(&[arguments, &["--backend", name]].concat());
            command
                .env("CUBECL_WGPU_DEFAULT_DEVICE", "DiscreteGpu(99)")
                .env("CUDA_VISIBLE_DEVICES", "");
            let says = contains(format!("backend '{name}'"))
                .and(contains("choose fused"))
                .and(contains("panicked").not());
            command.assert().code(2).stdout("").stderr(says);
        };
        without(&["train", &at.config(), "--out", &at.path("b.json")]);
        without(&["run", &at.config(), "--out", &at.path("run")]);
        without(&["bench", "train"]);
    }
    assert!(!Path::new(&at.path("b.json")).exists() && !Path::new(&at.path("run")).exists());
}

/// burn on a GPU: the losses of every epoch are our own kernel's to 1e-3, and results name the adapter. Control: another step size is
/// further off.
#[test]
#[cfg(feature = "wgpu")]
fn training_on_a_gpu() {
    let adapter = match nmt::train::Backend::named("wgpu").unwrap().adapter() {
        Ok(adapter) => adapter.unwrap(),
        Err(why) => {
            let required = std::env::var("NMT_REQUIRE").unwrap_or_default();
            assert!(
                !required.split(',').any(|tool| tool.trim() == "gpu"),
                "a GPU is required: {why}"
            );
            println!("skipped: {why}");
            return;
        }
    };
    let at = Workplace::new();
    let losses = |config: &str, backend: &str| -> Vec<f64> {
        let report = json(nmt(&[
            "train",
            config,
            "--out",
            &at.path("m.json"),
            "--backend",
            backend,
            "--force",
            "--json",
        ]));
        let result = &report["results"][0];
        assert_eq!(
            (result["backend"].as_str(), result["adapter"].as_str()),
            (Some(backend), (backend == "wgpu").then_some(adapter.as_str()))
        );
        let csv = std::fs::read_to_string(at.path("m.losses.csv")).unwrap();
        csv.lines()
            .skip(1)
            .flat_map(|line| line.split(',').skip(1).map(|number| number.parse().unwrap()))
            .collect()
    };
    let far = |a: &[f64], b: &[f64]| -> f64 {
        assert_eq!((a.len(), b.len()), (8, 8), "two losses of four epochs");
        a.iter()
            .zip(b)
            .map(|(a, b)| (a / b - 1.0).abs())
            .fold(0.0, |m: f64, e| if e.is_nan() { f64::INFINITY } else { m.max(e) })
    };
    let other = at.write(
        "other.toml",
        &TINY.replacen("learning_rate = 1e-2", "learning_rate = 2e-2", 1),
    );
    let (ours, theirs) = (losses(&at.config(), "fused"), losses(&at.config(), "wgpu"));
    assert!(far(&ours, &theirs) < 1e-3, "{}", far(&ours, &theirs));
    assert!(far(&ours, &losses(&other, "wgpu")) > 1e-3, "the control passed");

    let results = bench(
        &[
            "train",
            "--network",
            "7-8-4-1",
            "--batch",
            "64",
            "--rows",
            "300",
            "--backend",
            "fused,wgpu",
        ],
        &["samples_per_second"],
    );
    assert_eq!(
        results.iter().map(|r| r["adapter"].as_str()).collect::<Vec<_>>(),
        [None, Some(adapter.as_str())]
    );
    // burn does not know the variable that chooses adapters elsewhere, and must not be silent about it.
    let mut elsewhere = command(&["train", &at.config(), "--out", &at.path("e.json"), "--backend", "wgpu"]);
    elsewhere
        .env("WGPU_ADAPTER_NAME", "no adapter is called so")
        .assert()
        .code(2)
        .stderr(contains("CUBECL_WGPU_DEFAULT_DEVICE"));
    assert!(!Path::new(&at.path("e.json")).exists());
}

#[test]
fn bench_generate_measures_configurations() {
    let at = Workplace::new();
    let other = at.write(
        "other.toml",
        &TINY
            .replacen("\"tiny\"", "\"other\"", 1)
            .replacen("\"paper\"", "\"recentred\"", 1),
    );
    let results = bench(
        &["generate", "--config", &at.config(), &other, "--pairs", "200"],
        &["pairs_per_second"],
    );
    assert_eq!(
        results
            .iter()
            .map(|r| r["features"].as_str().unwrap())
            .collect::<Vec<_>>(),
        ["paper", "recentred"]
    );
    assert_eq!(
        bench(&["generate", "--pairs", "10"], &["pairs_per_second"])[0]["config"],
        "paper"
    );
}

/// Against the reference always, against onnxruntime where it is; where it is not, stderr says so.
#[test]
fn bench_infer_measures_networks() {
    let at = Workplace::new();
    let numbers = [
        "fragments_per_second",
        "rows_per_second",
        "gflops",
        "share_of_peak",
        "batch",
    ];
    let results = bench(&["infer", "--model", &at.model(), "--batch", "100,16"], &numbers);
    let mut backends: Vec<_> = results
        .iter()
        .map(|r| (r["batch"].as_u64().unwrap(), r["backend"].as_str().unwrap()))
        .collect();
    if std::env::var_os("ORT_DYLIB_PATH").is_some() {
        assert_eq!(backends.iter().filter(|b| b.1 == "onnxruntime").count(), 2);
    }
    backends.retain(|b| b.1 != "onnxruntime");
    assert_eq!(
        backends,
        [(100, "simd"), (100, "reference"), (16, "simd"), (16, "reference")]
    );
    assert!(
        results
            .iter()
            .all(|r| r["worst_difference"].as_f64().unwrap() < 1e-3 && r["network"] == "7-8-4-1")
    );
    let tiny = [
        "bench",
        "infer",
        "--network",
        "7-4-1",
        "--features",
        "recentred",
        "--batch",
        "10",
        "--repeat",
        "2",
        "--sample-seconds",
        "0.001",
    ];
    let without = || {
        let mut command = command(&tiny);
        command.env_remove("ORT_DYLIB_PATH");
        command
    };
    without()
        .assert()
        .success()
        .stderr(contains("not compared with onnxruntime").and(contains("ORT_DYLIB_PATH")))
        .stdout(contains("rows/s"));
    without().arg("--quiet").assert().success().stderr("");
}

#[test]
fn bad_benchmarks() {
    for (arguments, message) in [
        (&["train", "--network", "7"][..], "network '7': it has no layer"),
        (&["train", "--network", "8-4-1"], "no feature set is 8 wide"),
        (&["train", "--batch", "0"], "--batch 0: must be"),
        (&["train", "--batch", "24"], "multiple of 16"),
        (&["train", "--backend", "abacus"], "abacus"),
        (&["train", "--features", "mine"], "no such feature set"),
        (
            &["train", "--features", "recentred-8"],
            "takes 7 features, but the rows have 11",
        ),
        (&["train", "--repeat", "0"], "repetitions 0: must be"),
        (&["train", "--sample-seconds", "nan"], "must be greater than 0"),
        (&["train", "--threads", "0"], "--threads 0: must be"),
        (&["train", "--dataset", "/nonexistent/dataset"], "cannot read"),
        (&["generate", "--pairs", "0"], "pairs 0: must be"),
        (&["generate", "--config", "/nonexistent/c.toml"], "cannot read"),
        (&["infer", "--batch", "0"], "--batch 0: must be"),
        (&["infer", "--network", "7-1-2"], "ends in 2 numbers"),
        (&["infer", "--model", "/nonexistent/m.json"], "cannot read"),
        (&["guess"], "guess"),
    ] {
        nmt(&[&["bench"], arguments].concat())
            .code(2)
            .stdout("")
            .stderr(contains(message));
    }
}

/// Table, JSON, charts and results; exit code 1 where a promise is broken would need a broken network, which no file can hold.
#[test]
fn stress_finds_where_methods_break() {
    let at = Workplace::new();
    let model = format!("{}/models/small.json", env!("CARGO_MANIFEST_DIR"));
    let few = [
        "stress",
        "--model",
        &model,
        "--methods",
        "moment-power-4:f32",
        "--cases",
        "single,coincident,not-numbers",
        "--quiet",
    ];
    let table = nmt(&few).success().stderr("");
    let text = String::from_utf8_lossy(&table.get_output().stdout).into_owned();
    assert!(
        ["NaN", "refused", "neural:small @ prepass", "no promise is broken"]
            .iter()
            .all(|t| text.contains(t)),
        "{text}"
    );

    let out = at.path("stress");
    let all = [
        &few[..],
        &["--out", &out, "--pixels", "20", "--random", "20000", "--json"],
    ]
    .concat();
    let report = json(nmt(&all));
    let of = |kind: &str| {
        report["results"]
            .as_array()
            .unwrap()
            .iter()
            .filter(|r| r["kind"] == kind)
            .cloned()
            .collect::<Vec<_>>()
    };
    let alone = of("case")
        .into_iter()
        .find(|r| r["method"] == "neural:small" && r["case"] == "single")
        .unwrap();
    assert_eq!(
        (&alone["worst_error"], &alone["nonfinite"], &alone["promise"]),
        (&0.0.into(), &0.into(), &"ends".into())
    );
    // Control: the classic method breaks where the network does not.
    assert!(
        of("case")
            .iter()
            .any(|r| r["method"] == "moment-power-4:f32" && r["nonfinite"].as_u64().unwrap() > 0)
    );
    assert!(of("sweep").len() > 100 && of("features").len() == 16);
    let random = of("random");
    assert!(
        random.len() == 2
            && random
                .iter()
                .all(|r| r["fragments"].as_u64().unwrap() >= 20_000 && r["out_of_range"] == 0)
    );
    for name in ["range.svg", "count.svg", "digits.svg", "results.json"] {
        assert!(
            std::fs::metadata(Path::new(&out).join(name)).unwrap().len() > 1000,
            "{name}"
        );
    }
    nmt(&all).code(2).stderr(contains("already exists"));
    nmt(&["stress", "--cases", "rain"])
        .code(2)
        .stderr(contains("there is no such case; there are single,"));
    nmt(&["stress", "--pixels", "0"])
        .code(2)
        .stderr(contains("--pixels 0: must be from"));
    nmt(&["stress", "--methods", "guess"])
        .code(2)
        .stderr(contains("there is no method 'guess'"));
}

/// After a prepass the answers are others, and not worse in a scene of thin pixels.
#[test]
fn a_prepass_helps_thin_pixels() {
    let at = Workplace::new();
    let model = format!("{}/models/recommended.json", env!("CARGO_MANIFEST_DIR"));
    let evaluate = [
        "evaluate",
        "--fragments",
        "smoke",
        "--size",
        "64x64",
        "--model",
        &model,
        "--methods",
        "abuffer",
        "--depth-range",
        "0.001",
        "10000",
    ];
    let report = json(nmt(
        &[&evaluate[..], &["--prepass", "--out", &at.path("e"), "--json"]].concat()
    ));
    let mse = |name: &str| {
        let results = report["results"].as_array().unwrap();
        results
            .iter()
            .find(|r| r["method"] == name)
            .and_then(|r| r["transmittance_mse"].as_f64())
            .unwrap_or_else(|| panic!("{name}"))
    };
    assert!(mse("neural:recommended @ prepass") < mse("neural:recommended"));
    let sample = format!("{}/data/sample.npz", env!("CARGO_MANIFEST_DIR"));
    let predict = |prepass: &[&str], out: &str| {
        json(nmt(&[
            &[
                "predict",
                &model,
                "--fragments",
                &sample,
                "--out",
                &at.path(out),
                "--json",
            ],
            prepass,
        ]
        .concat()))["results"][0]["frame"]
            .clone()
    };
    assert_eq!(
        (predict(&[], "a.npy"), predict(&["--prepass"], "b.npy")),
        ("scene".into(), "pixel".into())
    );
    assert_ne!(
        std::fs::read(at.path("a.npy")).unwrap(),
        std::fs::read(at.path("b.npy")).unwrap()
    );
    nmt(&[
        &evaluate[..5],
        &["--methods", "abuffer", "--prepass", "--out", &at.path("x")],
    ]
    .concat())
    .code(2)
    .stderr(contains("--model"));
}

#[test]
fn help_and_usage() {
    nmt(&["--help"])
        .success()
        .stdout(contains("predict").and(contains("Ctrl").not()));
    nmt(&["--version"])
        .success()
        .stdout(contains(env!("CARGO_PKG_VERSION")));
    nmt(&[]).code(2);
    nmt(&["bake"]).code(2);
    let at = Workplace::new();
    // Results on stdout, and nothing on stderr under --quiet.
    nmt(&["train", &at.config(), "--out", &at.path("q.json"), "--quiet"])
        .success()
        .stderr("")
        .stdout(contains("q.json"));
}

/// Where a shipped network lies.
fn shipped(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("models")
        .join(name)
        .to_str()
        .unwrap()
        .to_owned()
}

/// Without skipping and with it the same bytes; what cannot be seen may differ, and says so.
#[test]
fn skipping_changes_no_byte_unless_asked_to() {
    let w = Workplace::new();
    let fragments = w.path("foliage.npz");
    nmt(&["scene", "foliage", "--size", "64x64", "--out", &fragments]).success();
    let model = shipped("recommended.json");
    let answer = |skip: &str| {
        let out = w.path(&format!("{skip}.npy"));
        let run = nmt(&[
            "predict",
            &model,
            "--fragments",
            &fragments,
            "--out",
            &out,
            "--skip",
            skip,
            "--json",
        ])
        .success();
        let text = String::from_utf8(run.get_output().stdout.clone()).unwrap();
        let json: serde_json::Value = serde_json::from_str(&text).unwrap();
        let result = json["results"][0].clone();
        assert_eq!(result["skip"], skip);
        (
            std::fs::read(out).unwrap(),
            result["network_rows"].as_u64().unwrap(),
            result["fragments"].as_u64().unwrap(),
        )
    };
    let (none, exact, visible) = (answer("none"), answer("exact"), answer("visible"));
    assert_eq!(none.0, exact.0);
    assert_ne!(none.0, visible.0);
    assert!(none.1 == none.2 && exact.1 < none.1 && visible.1 < exact.1);
    nmt(&[
        "predict",
        &model,
        "--fragments",
        &fragments,
        "--out",
        &w.path("x.npy"),
        "--skip",
        "some",
    ])
    .code(2)
    .stderr(contains("visible"));
}

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
