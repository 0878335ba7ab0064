//! `nmt train`: backends, interruption, and training on a GPU.

#[cfg(any(feature = "wgpu", feature = "cuda"))]
use crate::common::command;
#[cfg(feature = "wgpu")]
use crate::common::json;
use crate::common::{TINY, Workplace, nmt};
#[cfg(feature = "wgpu")]
use nmt::numeric::require::or_skip;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use std::path::Path;

/// Ctrl-C in training, of a network of transmittances or of colours: exit code 130, a checkpoint, and `--resume` ends
/// with the very model of an undisturbed training.
#[cfg(unix)]
#[test]
fn ctrl_c_leaves_a_resumable_checkpoint() {
    let of_colours = TINY
        .replacen("features = \"paper\"", "features = \"star-nt\"", 1)
        .replacen("[train]", "[colours]\npalette = 3\nshading = 0.2\n\n[train]", 1);
    assert!(of_colours.contains("star-nt") && of_colours.contains("palette"));
    for config in [TINY, &of_colours] {
        interrupted_and_resumed(config);
    }
}

#[cfg(unix)]
fn interrupted_and_resumed(config: &str) {
    use std::process::{Command as Process, Stdio};
    let at = Workplace::new();
    let config = at.write(
        "long.toml",
        &config.replacen("epochs = 4", "epochs = 2000\ncheckpoint_every = 1", 1),
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

/// burn on a GPU: the losses of every epoch are our own kernel's to 1e-3, and results name the adapter. Control:
/// another step size is further off.
#[test]
#[cfg(feature = "wgpu")]
fn training_on_a_gpu() {
    let found = nmt::train::Backend::named("wgpu").unwrap().adapter();
    let Some(adapter) = or_skip("gpu", found) else { return };
    let adapter = adapter.unwrap();
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

/// A dataset of another configuration is refused by its manifest: its arrays are not read. Control: of its own
/// configuration they are.
#[test]
fn other_datasets_are_refused_before_they_are_read() {
    let at = Workplace::new();
    nmt(&["generate", &at.config(), "--out", &at.path("d")]).success();
    std::fs::remove_file(at.path("d/training_features.npy")).unwrap();
    let other = at.write("other.toml", &TINY.replacen("seed = 5", "seed = 6", 1));
    let train = |config: &str| nmt(&["train", config, "--dataset", &at.path("d"), "--out", &at.path("m.json")]).code(2);
    train(&other).stderr(contains("another configuration"));
    train(&at.config()).stderr(contains("training_features.npy"));
}
