//! `scripts/bench-gpu` on the adapter that is here: a short run gives a table, and raw samples that hold what it says.

use nmt::numeric::require::or_skip;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

fn results(path: &Path) -> Vec<Value> {
    let text = std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let json: Value = serde_json::from_str(&text).unwrap();
    json["results"].as_array().unwrap().clone()
}

/// Every shipped network and every method that has a shader has a row with its median. Control: a scene that is none
/// leaves no folder.
#[test]
#[cfg(unix)]
fn a_short_run_makes_a_table() {
    let Some(gpu) = or_skip("gpu", nmt::gpu::Gpu::shared()) else {
        return;
    };
    if or_skip("python", Command::new("python3").arg("--version").output()).is_none() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let run = |scene: &str| {
        Command::new(Path::new(env!("CARGO_MANIFEST_DIR")).join("scripts/bench-gpu"))
            .args(["--sizes", "24x24", "--repeat", "1", "--scenes", scene])
            .env("NMT_BIN", env!("CARGO_BIN_EXE_nmt"))
            .env("NMT_BENCH_OUT", folder.path())
            .output()
            .unwrap()
    };
    assert!(!run("no-such-scene").status.success());
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);

    let output = run("teapots");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let made: Vec<PathBuf> = std::fs::read_dir(folder.path())
        .unwrap()
        .map(|e| e.unwrap().path())
        .collect();
    assert_eq!(made.len(), 1, "{made:?}");
    let table = std::fs::read_to_string(made[0].join("table.md")).unwrap();
    let methods = results(&made[0].join("methods-teapots-24x24.json"));
    assert!(methods.len() > 15, "{}", methods.len());
    for result in &methods {
        let (name, seconds) = (
            result["method"].as_str().unwrap(),
            result["seconds_weights"].as_f64().unwrap(),
        );
        let row = table
            .lines()
            .find(|line| line.starts_with(&format!("| `{name}` |")))
            .unwrap();
        let shown: f64 = row.rsplit('|').nth(1).unwrap().trim().parse().unwrap();
        // Three digits are shown.
        assert!(
            (shown - 1e3 * seconds).abs() <= 6e-3 * 1e3 * seconds,
            "{row}: {seconds}"
        );
    }
    for network in [
        "recommended",
        "small",
        "moments-6",
        "paper",
        "ends",
        "core-small",
        "core",
        "core-large",
    ] {
        assert!(
            table.contains(&format!("| `neural:{network}` | compute | exact |")),
            "{network}: {table}"
        );
    }
    assert_eq!(table.contains("A software adapter"), gpu.is_software());
}
