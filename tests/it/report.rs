//! `nmt report` on what the other commands really write.

use crate::common::{Workplace, nmt};
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use std::path::Path;

fn read(path: &str) -> String {
    std::fs::read_to_string(path).unwrap()
}

/// A run and an evaluation: the page holds their numbers and pictures, and needs nothing from elsewhere.
#[test]
fn the_page_holds_what_was_measured() {
    let at = Workplace::new();
    nmt(&["run", &at.config(), "--out", &at.path("all/tiny"), "--quiet"]).success();
    let methods = ["--methods", "moment-power-4,weighted-average,multi-layer-alpha:2"];
    let scenes = ["--fragments", "glass-stacks", "spheres", "--size", "24x16", "--model"];
    let model = at.path("all/tiny/model.json");
    nmt(&[
        &["evaluate", "--out", &at.path("all/scenes")],
        &methods[..],
        &scenes,
        &[&model],
    ]
    .concat())
    .success();
    let folder = at.path("all");
    nmt(&["report", &folder])
        .success()
        .stdout(
            contains("found: Images")
                .and(contains("not there: run time against error").not())
                .and(contains("nmt stress"))
                .and(contains("report.html")),
        )
        .stderr("");

    let page = read(&at.path("all/report.html"));
    let results: serde_json::Value = serde_json::from_str(&read(&at.path("all/scenes/results.json"))).unwrap();
    let of = |scene: &str, method: &str| {
        let rows = results["results"].as_array().unwrap();
        rows.iter()
            .find(|r| r["scene"] == scene && r["method"] == method)
            .unwrap()
            .clone()
    };
    for (scene, method) in [
        ("glass-stacks", "moment-power-4"),
        ("spheres", "neural:tiny"),
        ("spheres", "weighted-average"),
    ] {
        let row = of(scene, method);
        let mse = row["image_mse"].as_f64().unwrap();
        assert!(
            mse > 0.0 && page.contains(&format!("data-v=\"{mse:e}\"")),
            "{scene} {method} {mse:e}"
        );
        assert!(
            page.contains(&format!("alt=\"{scene}, {method}\""))
                && page.contains(&format!("alt=\"FLIP map of {scene}, {method}\""))
        );
        // The bins that the charts are drawn from make the whole again, to 1e-12.
        let bins = row["by_fragments_per_pixel"].as_array().unwrap();
        let sum: f64 = bins
            .iter()
            .map(|b| b["pixels"].as_f64().unwrap() * b["image_mse"].as_f64().unwrap())
            .sum();
        assert!((sum / (24.0 * 16.0) / mse - 1.0).abs() < 1e-12, "{sum}");
    }
    let model: serde_json::Value = serde_json::from_str(&read(&model)).unwrap();
    let t_mse = model["provenance"]["transmittance_mse"].as_f64().unwrap();
    assert!(page.contains(&format!("{t_mse:.3}")) || page.contains(&format!("{t_mse:.2e}")));
    for title in [
        "Training",
        "Exports",
        "Errors",
        "Error against depth complexity and alpha",
        "Run time against error",
        "Provenance",
    ] {
        assert!(page.contains(&format!("title\">{title}</h2>")), "{title}");
    }
    // Two scenes of the exact image, three methods and a network, each with a map of its own but the exact image.
    assert_eq!(page.matches("src=\"data:image/png;base64,").count(), 2 * (1 + 2 * 4));
    let lower = page.to_lowercase();
    for part in ["http:", "https:", "src=\"//", "url(", "@import", "<link"] {
        assert!(!lower.contains(part), "{part}");
    }

    // The same again is the same to the byte, and replaces nothing unasked.
    nmt(&["report", &folder]).code(2).stderr(contains("--force"));
    nmt(&["report", &folder, "--force"]).success();
    assert!(read(&at.path("all/report.html")) == page);
    // Control: another input, another page; and a cap on pictures is said aloud.
    nmt(&["report", &folder, "--out", &at.path("small.html"), "--embed-mib", "0"])
        .success()
        .stderr(contains("left out"));
    assert!(!read(&at.path("small.html")).contains("data:image/png"));
}

/// Broken files are named on stderr and in the page; no input is replaced; what holds nothing is an error.
#[test]
fn broken_files_are_named() {
    let at = Workplace::new();
    let folder = at.path("r");
    nmt(&["report", &folder])
        .code(2)
        .stderr(contains("r: cannot read the folder"));
    std::fs::create_dir(&folder).unwrap();
    nmt(&["report", &folder])
        .code(2)
        .stderr(contains("holds nothing that nmt measured"));
    std::fs::write(at.path("r/half.json"), "{\"command\": \"evaluate\"").unwrap();
    nmt(&["report", &folder])
        .code(2)
        .stderr(contains("half.json: is not whole JSON"));
    let row = r#"{"command": "evaluate", "results": [{"scene": "<b>", "method": "<script>m", "image_mse": 0.5}]}"#;
    std::fs::write(at.path("r/results.json"), row).unwrap();
    nmt(&["report", &folder, "--out", &at.path("r/results.json"), "--force"])
        .code(2)
        .stderr(contains("this very command"));
    assert_eq!(read(&at.path("r/results.json")), row);
    nmt(&["report", &folder, "--json"])
        .success()
        .stdout(contains("\"command\": \"report\"").and(contains("half.json")))
        .stderr(contains("half.json"));
    let page = read(&at.path("r/report.html"));
    assert!(page.contains("half.json") && page.contains("&lt;script&gt;m") && !page.contains("<script>m"));
    assert!(!Path::new(&at.path("r/.nmt-")).exists() && std::fs::read_dir(&folder).unwrap().count() == 3);
}
