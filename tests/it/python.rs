//! The independent reader, on files that the program wrote.

use crate::common::{Workplace, nmt};
use nmt::numeric::require::or_skip;
use std::process::Command;

/// The interpreter that has NumPy and onnxruntime; none, reported as skipped, where it is missing.
pub fn python() -> Option<String> {
    or_skip(
        "python",
        std::env::var("NMT_PYTHON").map_err(|_| "NMT_PYTHON is not set; scripts/test sets it"),
    )
}

/// Features and T from the exported JSON alone agree with `nmt predict`, with onnxruntime on the exported ONNX, and
/// with the dataset; and a T file with one wrong number does not.
#[test]
fn reproduces_features_and_transmittance_from_the_json_alone() {
    let Some(python) = python() else { return };
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
        "train",
        &at.config(),
        "--out",
        &at.path("m.json"),
        "--dataset",
        &at.path("d"),
    ])
    .success();
    nmt(&["export", &at.path("m.json"), "--out", &at.path("e")]).success();
    nmt(&[
        "predict",
        &at.path("m.json"),
        "--fragments",
        &at.path("f.npz"),
        "--out",
        &at.path("t.npy"),
    ])
    .success();
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/scripts/nmt.py");
    let read = |predicted: &str| {
        let output = Command::new(&python)
            .args([
                script,
                "check",
                &at.path("e/tiny.json"),
                &at.path("f.npz"),
                "--predicted",
                predicted,
            ])
            .args(["--onnx", &at.path("e/tiny.onnx"), "--dataset", &at.path("d")])
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
        (output.status.code(), text)
    };
    let (code, text) = read(&at.path("t.npy"));
    assert_eq!(code, Some(0), "{text}");
    for part in [
        "ok nmt predict",
        "ok onnxruntime",
        "ok dataset features",
        "ok dataset targets",
        "ok control",
    ] {
        assert!(text.contains(part), "{part} is missing in\n{text}");
    }
    let mut bytes = std::fs::read(at.path("t.npy")).unwrap();
    let end = bytes.len();
    bytes[end - 4..].copy_from_slice(&2.0f32.to_le_bytes());
    std::fs::write(at.path("wrong.npy"), bytes).unwrap();
    assert_eq!(read(&at.path("wrong.npy")).0, Some(1));
}

/// The same for networks that are shipped, on the sample of pixels that stands in `data/`: features by their
/// definition, exact answers by sorting, and the core of every pixel by taking its greatest codes one after the other.
#[test]
fn reproduces_shipped_networks() {
    let Some(python) = python() else { return };
    let at = Workplace::new();
    let root = env!("CARGO_MANIFEST_DIR");
    for name in ["recommended", "moments-6", "ends", "core-small", "core", "core-large"] {
        let model = format!("{root}/models/{name}.json");
        let fragments = format!("{root}/data/sample.npz");
        nmt(&["export", &model, "--out", &at.path(name)]).success();
        nmt(&[
            "predict",
            &model,
            "--fragments",
            &fragments,
            "--out",
            &at.path("t.npy"),
            "--force",
        ])
        .success();
        let read = |predicted: &str| {
            Command::new(&python)
                .args([
                    &format!("{root}/scripts/nmt.py"),
                    "check",
                    &model,
                    &fragments,
                    "--predicted",
                    predicted,
                ])
                .args(["--onnx", &at.path(&format!("{name}/{name}.onnx"))])
                .output()
                .unwrap()
        };
        let output = read(&at.path("t.npy"));
        let text = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{text}");
        assert!(
            text.contains("ok nmt predict") && text.contains("ok onnxruntime") && text.contains("ok control"),
            "{text}"
        );
        // Control: the answers in another order.
        let mut bytes = std::fs::read(at.path("t.npy")).unwrap();
        bytes[128..].rotate_left(4);
        std::fs::write(at.path("wrong.npy"), bytes).unwrap();
        assert_eq!(read(&at.path("wrong.npy")).status.code(), Some(1));
    }
}

/// A fragment list that `nmt.py` writes is one that `nmt` reads, with empty pixels, ties and opacities 0 and 1 in it;
/// both answer it alike: fewer than 1 in 200 differ by more than 2e-3. Control: of another network's answers more than
/// 1 in 50 do.
#[test]
fn lists_written_in_numpy_are_answered_alike() {
    let Some(python) = python() else { return };
    let at = Workplace::new();
    let root = env!("CARGO_MANIFEST_DIR");
    let script = format!(
        "import sys; sys.path.insert(0, r'{root}/scripts')\n\
         import numpy as np, nmt\n\
         rng = np.random.default_rng(3)\n\
         counts = rng.integers(0, 40, 500)\n\
         offsets = np.concatenate([[0], np.cumsum(counts)])\n\
         v = np.float32(rng.uniform(1, 40, offsets[-1])); v[1::7] = v[::7][: len(v[1::7])]\n\
         alpha = np.float32(rng.uniform(0, 0.7, offsets[-1])); alpha[::11] = 0; alpha[::101] = 1\n\
         nmt.write_fragments(sys.argv[1], nmt.Fragments(offsets, v, alpha))\n"
    );
    let list = at.path("list.npz");
    let made = Command::new(&python).args(["-c", &script, &list]).output().unwrap();
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    for network in ["recommended", "core", "small"] {
        let out = at.path(&format!("{network}.npy"));
        nmt(&["predict", network, "--fragments", &list, "--out", &out]).success();
    }
    for network in ["recommended", "core"] {
        let theirs = Command::new(&python)
            .args([
                &format!("{root}/scripts/nmt.py"),
                "predict",
                &format!("{root}/models/{network}.json"),
                &list,
                "--out",
                &at.path(&format!("{network}-theirs.npy")),
            ])
            .output()
            .unwrap();
        assert!(theirs.status.success(), "{}", String::from_utf8_lossy(&theirs.stderr));
    }
    let read = |name: &str| -> Vec<f32> {
        let bytes = std::fs::read(at.path(name)).unwrap();
        let values = bytes[128..].as_chunks::<4>().0;
        values.iter().map(|b| f32::from_le_bytes(*b)).collect()
    };
    // Sums in f32 against features in f64: thin pixels and tied depths lose digits, all others agree.
    let far_off = |network: &str, other: &str| {
        let (ours, theirs) = (read(&format!("{network}.npy")), read(&format!("{other}-theirs.npy")));
        assert!(
            ours.len() == theirs.len() && ours.len() > 5000,
            "{} {}",
            ours.len(),
            theirs.len()
        );
        let off = ours.iter().zip(&theirs).map(|(a, b)| (a - b).abs());
        let off = off.filter(|e| e.is_nan() || *e > 2e-3);
        off.count() as f64 / ours.len() as f64
    };
    for network in ["recommended", "core"] {
        assert!(far_off(network, network) < 5e-3, "{}", far_off(network, network));
        // Control: another network's answers.
        assert!(far_off("small", network) > 2e-2, "{}", far_off("small", network));
    }
}
