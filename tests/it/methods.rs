//! Methods against an independent program, and the table of them against the registry.

use ndarray::ArrayView1;
use nmt::numeric::file::Replace;
use nmt::numeric::npy::write_npy;
use nmt::oit::{self, Context};
use nmt::scene::npz;
use std::path::Path;
use std::process::Command;

/// Wavelet and hybrid transparency agree with `scripts/oit_reference.py` to 1e-6 in T over the sample of pixels in
/// `data/`. Control: one weight that is off by 1e-4 is found; the script's own control is the weights in another order.
#[test]
fn wavelet_and_hybrid_agree_with_numpy() {
    let Some(python) = crate::python::python() else { return };
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let fragments = root.join("data/sample.npz");
    let list = npz::read(&fragments).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("weights.npy");
    let agrees = |name: &str, weights: &[f32]| {
        write_npy(&path, Replace::Yes, ArrayView1::from(weights)).unwrap();
        let output = Command::new(&python)
            .arg(root.join("scripts/oit_reference.py"))
            .args([fragments.as_os_str(), name.as_ref(), path.as_os_str()])
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
        println!("{text}");
        assert!(
            output.status.code().is_some_and(|c| c < 2) && text.contains(name),
            "{text}"
        );
        output.status.success()
    };
    for name in [
        "wavelet:1",
        "wavelet:3",
        "wavelet:3+own",
        "wavelet:5+own",
        "hybrid:1",
        "hybrid:6",
    ] {
        let method = oit::parse(name).unwrap();
        let weights = oit::weights(&list, &*method.accumulate(&list, Context::default()).unwrap());
        let mut weights: Vec<f32> = weights.into_iter().map(|w| w as f32).collect();
        assert!(agrees(name, &weights), "{name}");
        let middle = weights.len() / 2;
        weights[middle] += 1e-4;
        assert!(!agrees(name, &weights), "the control of {name}");
    }
}

/// The table in docs/methods.md is what `nmt methods --markdown` prints. Control: it does not hold a line that is not.
#[test]
fn the_table_of_methods_is_the_registrys() {
    let output = Command::new(env!("CARGO_BIN_EXE_nmt"))
        .args(["methods", "--markdown"])
        .output()
        .unwrap();
    let table = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success() && table.lines().count() > 60, "{table}");
    let page = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/methods.md")).unwrap();
    assert!(
        page.ends_with(&table),
        "docs/methods.md must end with what 'nmt methods --markdown' prints"
    );
    assert!(!page.contains("| `no-such-method` |"));
}

/// Shadows, tinted glass and random orders from the command line; what cannot be is refused in words.
#[test]
fn evaluate_knows_shadows_tints_and_orders() {
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str], out: &str| {
        let output = Command::new(env!("CARGO_BIN_EXE_nmt"))
            .args(["evaluate", "--quiet", "--size", "40x40", "--out"])
            .arg(folder.path().join(out))
            .args(arguments)
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
        (output.status.code(), text)
    };
    let methods = ["--methods", "moment-power-4,multi-layer-alpha:2"];
    let (code, text) = run(
        &[
            &["--fragments", "glass-stacks", "spheres", "--tint", "0.5"],
            &methods[..],
        ]
        .concat(),
        "a",
    );
    assert_eq!(code, Some(0), "{text}");
    for part in [
        "multi-layer-alpha:2†",
        "mean of 3 random orders of fragments and 3 of whole objects",
        "glass tinted by 0.5",
        "| method | bits/pixel |",
    ] {
        assert!(text.contains(part), "{part} is missing in\n{text}");
    }
    assert!(
        folder.path().join("a/comparison.md").exists() && !text.contains("seconds"),
        "{text}"
    );
    let shadows = [
        "--fragments",
        "spheres",
        "--shadows",
        "--methods",
        "moment-power-4,abuffer",
    ];
    let (code, text) = run(&shadows, "b");
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("surfaces T-MSE") && text.contains("9x9"), "{text}");
    assert!(folder.path().join("b/spheres/shadow.truth.png").exists());
    let (code, text) = run(&["--fragments", "spheres", "--tint", "2"], "c");
    assert!(code == Some(2) && text.contains("--tint 2"), "{text}");
}

/// A network of colours is trained by `nmt train` and used by its method's name; commands that cannot take it say so.
#[test]
fn networks_of_colours_are_trained_and_used() {
    let folder = tempfile::tempdir().unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let run = |arguments: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_nmt"))
            .args(arguments)
            .current_dir(folder.path())
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
        (output.status.code(), text)
    };
    let law = std::fs::read_to_string(root.join("configs/paper.toml")).unwrap();
    std::fs::write(folder.path().join("paper.toml"), law).unwrap();
    let config = "extends = \"paper.toml\"\nname = \"s\"\n[dataset]\nfeatures = \"star-nt\"\ntraining_pairs = 900\n\
        validation_pairs = 300\n[colours]\npalette = 3\nshading = 0.2\n[train]\nepochs = 2\nbatch = 64\n";
    std::fs::write(folder.path().join("s.toml"), config).unwrap();
    let (code, text) = run(&["train", "s.toml", "--out", "s.json", "--quiet"]);
    assert!(code == Some(0) && text.contains("5-32-16-3"), "{text}");
    let evaluate = |method: &str, out: &str| {
        let fragments = ["evaluate", "--quiet", "--fragments", "spheres", "--size", "24x24"];
        run(&[&fragments[..], &["--methods", method, "--out", out]].concat())
    };
    let (code, text) = evaluate("star-nt:s.json", "a");
    assert!(code == Some(0) && text.contains("star-nt:s.json"), "{text}");
    let (code, text) = evaluate("dfa:s.json", "b");
    assert!(
        code == Some(2) && text.contains("a network of star-nt, not of dfa"),
        "{text}"
    );
    for (arguments, part) in [
        (&["run", "s.toml"][..], "'nmt train' trains it"),
        (
            &["train", "s.toml", "--out", "t.json", "--resume"],
            "there is no checkpoint to resume from",
        ),
        (
            &["train", "s.toml", "--out", "t.json", "--dataset", "d"],
            "leave out --dataset",
        ),
        (&["export", "s.json", "--out", "e"], "dfa:MODEL.json"),
    ] {
        let (code, text) = run(arguments);
        assert!(code == Some(2) && text.contains(part), "{text}");
    }
    std::fs::write(
        folder.path().join("w.toml"),
        config.replace("palette = 3", "palette = 0"),
    )
    .unwrap();
    let (code, text) = run(&["train", "w.toml", "--out", "w.json"]);
    assert!(code == Some(2) && text.contains("colours.palette = 0"), "{text}");
}
