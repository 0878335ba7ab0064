//! The independent reader, on files that the program wrote.

use crate::cli::{Workplace, nmt};
use std::process::Command;

/// The interpreter that has NumPy and onnxruntime; a visible skip where there is none, a failure where onnxruntime is required.
pub fn python() -> Option<String> {
    let found = std::env::var("NMT_PYTHON").ok();
    let required = std::env::var("NMT_REQUIRE").unwrap_or_default();
    if found.is_none() {
        assert!(
            !required.split(',').any(|t| t == "onnxruntime"),
            "required, but NMT_PYTHON is not set; scripts/test sets it"
        );
        eprintln!("SKIPPED: NMT_PYTHON is not set; scripts/test sets it");
    }
    found
}

/// Features and T from the exported JSON alone agree with `nmt predict`, with onnxruntime on the exported ONNX, and with the dataset; and
/// a T file with one wrong number does not.
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
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/scripts/read_export.py");
    let read = |predicted: &str| {
        let output = Command::new(&python)
            .args([
                script,
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

/// The same for the recommended network that is shipped, on the sample of pixels that stands in `data/`: features by their definition, exact answers by sorting.
#[test]
fn reproduces_the_recommended_network() {
    let Some(python) = python() else { return };
    let at = Workplace::new();
    let root = env!("CARGO_MANIFEST_DIR");
    for name in ["recommended", "moments-6"] {
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
                    &format!("{root}/scripts/read_export.py"),
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
