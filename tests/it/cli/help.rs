//! Help, version and usage errors.

use crate::common::{Workplace, nmt};
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;

#[test]
fn help_and_usage() {
    nmt(&["--help"])
        .success()
        .stdout(contains("predict").and(contains("Ctrl").not()));
    nmt(&["--version"])
        .success()
        .stdout(contains(env!("CARGO_PKG_VERSION")));
    nmt(&[]).code(2);
    nmt(&["bake"]).code(2);
    let at = Workplace::new();
    // Results on stdout, and nothing on stderr under --quiet.
    nmt(&["train", &at.config(), "--out", &at.path("q.json"), "--quiet"])
        .success()
        .stderr("")
        .stdout(contains("q.json"));
}
