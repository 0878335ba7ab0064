//! `nmt bench`.

use crate::common::{TINY, Workplace, command, json, nmt};
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;

/// What a benchmark of tiny sizes prints as JSON; every result has these numbers, all greater than 0, and one raw
/// sample a repetition.
fn bench(arguments: &[&str], numbers: &[&str]) -> Vec<serde_json::Value> {
    let tiny = ["--repeat", "2", "--sample-seconds", "0.001", "--threads", "2", "--json"];
    let report = json(nmt(&[&["bench"], arguments, &tiny].concat()));
    assert_eq!(report["command"], "bench");
    let results = report["results"].as_array().unwrap().clone();
    for result in &results {
        assert_eq!(
            (&result["benchmark"], &result["threads"]),
            (&serde_json::Value::from(arguments[0]), &2.into())
        );
        for key in ["seconds", "min_seconds", "max_seconds", "calls_per_repetition"]
            .iter()
            .chain(numbers)
        {
            let number = result[key]
                .as_f64()
                .unwrap_or_else(|| panic!("{key} is missing in {result}"));
            assert!(number.is_finite() && number > 0.0, "{key} = {number}");
        }
        assert_eq!(result["raw_seconds"].as_array().unwrap().len(), 2);
    }
    results
}

#[test]
fn bench_train_measures_every_backend() {
    let numbers = [
        "samples_per_second",
        "gflops",
        "share_of_peak",
        "multiply_add_peak_gflops",
        "batch",
    ];
    let results = bench(
        &["train", "--network", "7-8-4-1,9-8-1", "--batch", "64", "--rows", "300"],
        &numbers,
    );
    let names: Vec<_> = results
        .iter()
        .map(|r| {
            (
                r["network"].as_str().unwrap(),
                r["backend"].as_str().unwrap(),
                r["simd"].is_null(),
            )
        })
        .collect();
    let of = |network| {
        [
            Some((network, "fused", false)),
            cfg!(feature = "flex").then_some((network, "flex", true)),
            cfg!(feature = "burn").then_some((network, "ndarray", true)),
        ]
        .into_iter()
        .flatten()
        .collect::<Vec<_>>()
    };
    assert_eq!(names, [of("7-8-4-1"), of("9-8-1")].concat());

    // On the rows of a dataset, which the network must fit.
    let at = Workplace::new();
    nmt(&["generate", &at.config(), "--out", &at.path("d")]).success();
    let on = [
        "train",
        "--dataset",
        &at.path("d"),
        "--backend",
        "fused",
        "--batch",
        "256",
    ];
    assert_eq!(bench(&on, &numbers).len(), 1);
    nmt(&[&["bench"], &on[..], &["--network", "9-8-1"]].concat())
        .code(2)
        .stderr(contains("9-8-1 takes 9 features, but the rows have 7"));
    nmt(&["bench", "train", "--dataset", &at.path("d"), "--batch", "4096"])
        .code(2)
        .stderr(contains("fewer than the 4096"));
    let table = [
        "bench",
        "train",
        "--backend",
        "fused",
        "--batch",
        "64",
        "--rows",
        "64",
        "--repeat",
        "2",
        "--sample-seconds",
        "0.001",
        "--quiet",
    ];
    nmt(&table)
        .success()
        .stderr("")
        .stdout(contains("samples/s").and(contains("Multiply-add peak")));
}

/// Whole epochs with fresh pixels, against rows in memory and against what both halves allow.
#[test]
fn bench_train_measures_streams() {
    let at = Workplace::new();
    let streamed = at.write(
        "streamed.toml",
        &TINY.replacen("training_pairs", "refresh = 0.25\ntraining_pairs", 1),
    );
    let numbers = [
        "samples_per_second",
        "in_memory_samples_per_second",
        "pairs_per_second",
        "bound_samples_per_second",
        "batch",
        "rows",
        "refresh",
    ];
    let results = bench(&["train", "--stream", &streamed], &numbers);
    assert_eq!(
        results
            .iter()
            .map(|r| (&r["stream"], &r["backend"], &r["network"]))
            .collect::<Vec<_>>(),
        [(&"tiny".into(), &"fused".into(), &"7-8-4-1".into())]
    );
    let rate = |key: &str| results[0][key].as_f64().unwrap();
    let bound = 1.0 / (1.0 / rate("in_memory_samples_per_second") + 0.25 / rate("pairs_per_second"));
    assert!((rate("bound_samples_per_second") / bound - 1.0).abs() < 1e-9);
    let tiny = [
        "--backend",
        "fused",
        "--repeat",
        "1",
        "--sample-seconds",
        "0.001",
        "--quiet",
    ];
    nmt(&[&["bench", "train", "--stream", &streamed], &tiny[..]].concat())
        .success()
        .stdout(contains("of bound").and(contains("fused")));
    nmt(&["bench", "train", "--stream", &at.config()])
        .code(2)
        .stderr(contains("dataset.refresh of 'tiny' is 0"));
    nmt(&["bench", "train", "--stream", &streamed, "--batch", "64"])
        .code(2)
        .stderr(contains("--batch"));
}

#[test]
fn bench_generate_measures_configurations() {
    let at = Workplace::new();
    let other = at.write(
        "other.toml",
        &TINY
            .replacen("\"tiny\"", "\"other\"", 1)
            .replacen("\"paper\"", "\"recentred\"", 1),
    );
    let results = bench(
        &["generate", "--config", &at.config(), &other, "--pairs", "200"],
        &["pairs_per_second"],
    );
    assert_eq!(
        results
            .iter()
            .map(|r| r["features"].as_str().unwrap())
            .collect::<Vec<_>>(),
        ["paper", "recentred"]
    );
    assert_eq!(
        bench(&["generate", "--pairs", "10"], &["pairs_per_second"])[0]["config"],
        "paper"
    );
}

/// Against the reference always, against onnxruntime where it is; where it is not, stderr says so.
#[test]
fn bench_infer_measures_networks() {
    let at = Workplace::new();
    let numbers = [
        "fragments_per_second",
        "rows_per_second",
        "gflops",
        "share_of_peak",
        "batch",
    ];
    let results = bench(&["infer", "--model", &at.model(), "--batch", "100,16"], &numbers);
    let mut backends: Vec<_> = results
        .iter()
        .map(|r| (r["batch"].as_u64().unwrap(), r["backend"].as_str().unwrap()))
        .collect();
    if std::env::var_os("ORT_DYLIB_PATH").is_some() {
        assert_eq!(backends.iter().filter(|b| b.1 == "onnxruntime").count(), 2);
    }
    backends.retain(|b| b.1 != "onnxruntime");
    assert_eq!(
        backends,
        [(100, "simd"), (100, "reference"), (16, "simd"), (16, "reference")]
    );
    assert!(
        results
            .iter()
            .all(|r| r["worst_difference"].as_f64().unwrap() < 1e-3 && r["network"] == "7-8-4-1")
    );
    let tiny = [
        "bench",
        "infer",
        "--network",
        "7-4-1",
        "--features",
        "recentred",
        "--batch",
        "10",
        "--repeat",
        "2",
        "--sample-seconds",
        "0.001",
    ];
    let without = || {
        let mut command = command(&tiny);
        command.env_remove("ORT_DYLIB_PATH");
        command
    };
    without()
        .assert()
        .success()
        .stderr(contains("not compared with onnxruntime").and(contains("ORT_DYLIB_PATH")))
        .stdout(contains("rows/s"));
    without().arg("--quiet").assert().success().stderr("");
}

#[test]
fn bad_benchmarks() {
    for (arguments, message) in [
        (&["train", "--network", "7"][..], "network '7': it has no layer"),
        (&["train", "--network", "4-4-1"], "no feature set is 4 wide"),
        (&["train", "--batch", "0"], "--batch 0: must be"),
        (&["train", "--batch", "24"], "multiple of 16"),
        (&["train", "--backend", "abacus"], "abacus"),
        (&["train", "--features", "mine"], "unknown feature set 'mine'"),
        (
            &["train", "--features", "recentred-8"],
            "takes 7 features, but the rows have 11",
        ),
        (&["train", "--repeat", "0"], "repetitions 0: must be"),
        (&["train", "--sample-seconds", "nan"], "must be greater than 0"),
        (&["train", "--threads", "0"], "--threads 0: must be"),
        (&["train", "--dataset", "/nonexistent/dataset"], "cannot read"),
        (&["generate", "--pairs", "0"], "pairs 0: must be"),
        (&["generate", "--config", "/nonexistent/c.toml"], "cannot read"),
        (&["infer", "--batch", "0"], "--batch 0: must be"),
        (&["infer", "--network", "7-1-2"], "ends in 2 numbers"),
        (&["infer", "--model", "/nonexistent/m.json"], "cannot read"),
        (&["guess"], "guess"),
    ] {
        nmt(&[&["bench"], arguments].concat())
            .code(2)
            .stdout("")
            .stderr(contains(message));
    }
}
