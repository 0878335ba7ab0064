//! `nmt stress`.

use crate::common::{Workplace, json, nmt};
use predicates::str::contains;
use std::path::Path;

/// Table, JSON, charts and results; exit code 1 where a promise is broken would need a broken network, which no file
/// can hold.
#[test]
fn stress_finds_where_methods_break() {
    let at = Workplace::new();
    let model = format!("{}/models/small.json", env!("CARGO_MANIFEST_DIR"));
    let few = [
        "stress",
        "--model",
        &model,
        "--methods",
        "moment-power-4:f32",
        "--cases",
        "single,coincident,not-numbers",
        "--quiet",
    ];
    let table = nmt(&few).success().stderr("");
    let text = String::from_utf8_lossy(&table.get_output().stdout).into_owned();
    assert!(
        ["NaN", "refused", "neural:small @ prepass", "no promise is broken"]
            .iter()
            .all(|t| text.contains(t)),
        "{text}"
    );

    let out = at.path("stress");
    let all = [
        &few[..],
        &["--out", &out, "--pixels", "20", "--random", "20000", "--json"],
    ]
    .concat();
    let report = json(nmt(&all));
    let of = |kind: &str| {
        report["results"]
            .as_array()
            .unwrap()
            .iter()
            .filter(|r| r["kind"] == kind)
            .cloned()
            .collect::<Vec<_>>()
    };
    let alone = of("case")
        .into_iter()
        .find(|r| r["method"] == "neural:small" && r["case"] == "single")
        .unwrap();
    assert_eq!(
        (&alone["worst_error"], &alone["nonfinite"], &alone["promise"]),
        (&0.0.into(), &0.into(), &"ends".into())
    );
    // Control: the classic method breaks where the network does not.
    assert!(
        of("case")
            .iter()
            .any(|r| r["method"] == "moment-power-4:f32" && r["nonfinite"].as_u64().unwrap() > 0)
    );
    assert!(of("sweep").len() > 100 && of("features").len() == 16);
    let random = of("random");
    assert!(
        random.len() == 2
            && random
                .iter()
                .all(|r| r["fragments"].as_u64().unwrap() >= 20_000 && r["out_of_range"] == 0)
    );
    for name in ["range.svg", "count.svg", "digits.svg", "results.json"] {
        assert!(
            std::fs::metadata(Path::new(&out).join(name)).unwrap().len() > 1000,
            "{name}"
        );
    }
    nmt(&all).code(2).stderr(contains("already exists"));
    nmt(&["stress", "--cases", "rain"])
        .code(2)
        .stderr(contains("there is no such case; there are single,"));
    nmt(&["stress", "--pixels", "0"])
        .code(2)
        .stderr(contains("--pixels 0: must be from"));
    nmt(&["stress", "--methods", "guess"])
        .code(2)
        .stderr(contains("there is no method 'guess'"));
}
