//! `nmt import`.

use crate::common::{Workplace, nmt};
use predicates::str::contains;
use std::path::Path;

#[test]
fn import_takes_foreign_weights() {
    let at = Workplace::new();
    let row = "[0.5, -0.25],".repeat(6) + "[1, 2]";
    let foreign = at.write(
        "w.json",
        &format!(
            r#"{{"source": "elsewhere", "layers": [{{"weights": [{row}], "bias": [0, 1]}},
{{"weights": [[1], [1]], "biases": [0]}}]}}"#
        ),
    );
    nmt(&["import", &foreign, "--out", &at.path("i.json")])
        .success()
        .stdout(contains("7-2-1"));
    nmt(&["export", &at.path("i.json"), "--out", &at.path("e")]).success();
    nmt(&["check", &at.path("i.json"), "--exports", &at.path("e")]).success();
    nmt(&["import", &foreign, "--out", &at.path("j.json"), "--features", "none"])
        .code(2)
        .stderr(contains("there are paper"));
    nmt(&["import", &at.config(), "--out", &at.path("j.json")])
        .code(2)
        .stderr(contains("not a model file"));
    assert!(!Path::new(&at.path("j.json")).exists());
}
