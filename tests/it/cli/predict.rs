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

/// A scene is answered as the list that it is rendered to; what is no scene is told which there are.
#[test]
fn scenes_are_taken_by_name() {
    let w = Workplace::new();
    let list = w.path("foliage.npz");
    nmt(&["scene", "foliage", "--size", "40x30", "--out", &list]).success();
    let answer = |fragments: &[&str], out: &str| {
        let out = w.path(out);
        nmt(&[&["predict", "small", "--out", &out, "--fragments"], fragments].concat()).success();
        std::fs::read(out).unwrap()
    };
    let of_list = answer(&[&list], "a.npy");
    assert_eq!(answer(&["foliage", "--size", "40x30"], "b.npy"), of_list);
    // Control: another seed is another scene.
    assert_ne!(answer(&["foliage", "--size", "40x30", "--seed", "9"], "c.npy"), of_list);
    nmt(&["predict", "small", "--fragments", "foliag", "--out", &w.path("d.npy")])
        .code(2)
        .stderr(contains("did you mean 'foliage'?"));
}

/// A file that may not be replaced is said before fragments are read; inputs that are not there come first.
#[test]
fn predict_refuses_before_it_reads() {
    let w = Workplace::new();
    let (bad, out) = (w.write("bad.npz", "no archive"), w.write("t.npy", ""));
    let predict =
        |model: &str, fragments: &str| nmt(&["predict", model, "--fragments", fragments, "--out", &out]).code(2);
    predict("small", &bad).stderr(contains("t.npy: already exists"));
    predict("smal", &bad).stderr(contains("did you mean 'small'?"));
    predict("small", "none.npz").stderr(contains("none.npz: cannot read"));
    assert_eq!(std::fs::read(&out).unwrap(), b"");
}
