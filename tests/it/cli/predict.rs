//! `nmt predict`.

use crate::common::{Workplace, nmt, shipped};
use predicates::str::contains;

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
