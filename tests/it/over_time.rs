//! `nmt evaluate --frames`: change from frame to frame, as a table and as JSON.

use assert_cmd::cargo::cargo_bin_cmd;
use serde_json::Value;
use std::path::Path;

const LIST: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/data/sample.npz");

fn evaluate(folder: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    let out = folder.join("out");
    cargo_bin_cmd!("nmt")
        .args(["evaluate", "--force", "--out"])
        .arg(out)
        .args(arguments)
        .assert()
}

/// The exact method changes as the truth does, to rounding (1e-25); moments do not, and neither is asked of a list,
/// which has no camera.
#[test]
fn frames_are_compared() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = [
        "--fragments",
        "sphere-cluster",
        "--size",
        "32x32",
        "--methods",
        "abuffer,moment-power-4",
        "--frames",
        "3",
    ];
    let found = evaluate(folder.path(), &[&arguments[..], &["--json"]].concat()).success();
    let report: Value = serde_json::from_slice(&found.get_output().stdout).unwrap();
    let of = |method: &str, key: &str| {
        let results = report["results"].as_array().unwrap();
        let result = results.iter().find(|r| r["method"] == method).unwrap();
        assert_eq!(result["frames"], 3);
        result[key].as_f64().unwrap()
    };
    let truth = of("abuffer", "truth_change_mse");
    assert!(of("abuffer", "frame_change_mse") < 1e-25 && truth > 1e-6);
    let moments = of("moment-power-4", "frame_change_mse");
    assert!(moments > 1e-9 && moments < truth, "{moments:e} {truth:e}");

    let table = evaluate(folder.path(), &arguments).success();
    let table = String::from_utf8(table.get_output().stdout.clone()).unwrap();
    assert!(
        table.contains("frame change") && table.contains("3 frames, 0.6 degrees a frame"),
        "{table}"
    );

    let still = evaluate(folder.path(), &arguments[..6]).success();
    let still = String::from_utf8(still.get_output().stdout.clone()).unwrap();
    assert!(!still.contains("frame change"), "{still}");
    for (wrong, word) in [
        (["--fragments", LIST, "--frames", "3"], "a fragment list has none"),
        (["--fragments", "spheres", "--frames", "1"], "--frames"),
    ] {
        let refused = evaluate(folder.path(), &wrong).failure();
        let text = String::from_utf8(refused.get_output().stderr.clone()).unwrap();
        assert!(text.contains(word), "{text}");
    }
}
