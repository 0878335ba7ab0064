//! `nmt evaluate`.

use crate::common::{Workplace, json, nmt};
use nmt::numeric::require::or_skip;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use std::path::Path;

/// Methods beside a network on a rendered scene: a table, pictures, a contact sheet, numbers; and the exact method is
/// exact.
#[test]
fn evaluate_compares_methods() {
    let at = Workplace::new();
    let model = at.model();
    nmt(&["scene", "glass-stacks", "--size", "40x30", "--out", &at.path("g.npz")]).success();
    let methods = "abuffer,moment-power-4,moment-power-8+own,weighted-average";
    let evaluate = |out: &str, more: &[&str]| {
        nmt(&[
            &[
                "evaluate",
                "--fragments",
                &at.path("g.npz"),
                "--methods",
                methods,
                "--out",
                &at.path(out),
            ],
            more,
        ]
        .concat())
    };
    // The table, each row whole, then where the files are.
    let (sheet, numbers) = (at.path("e/g/sheet.png"), at.path("e/results.json"));
    let one_line = predicates::function::function(|text: &str| {
        text.lines()
            .any(|line| line.starts_with("neural:tiny ") && line.ends_with(" 2       f32 blending"))
    });
    evaluate("e", &["--model", &model]).success().stdout(
        contains("moment-power-4")
            .and(contains("image MSE"))
            .and(contains("unbounded"))
            .and(contains(sheet.as_str()))
            .and(contains(numbers.as_str()))
            .and(contains("pale yellow, 0.2"))
            .and(one_line),
    );
    for file in [
        "results.json",
        "g/truth.png",
        "g/sheet.png",
        "g/moment-power-4.png",
        "g/moment-power-4.flip.png",
        "g/neural-tiny.png",
    ] {
        assert!(Path::new(&at.path("e")).join(file).is_file(), "{file}");
    }
    evaluate("e", &[]).code(2).stderr(contains("--force"));
    let report = json(evaluate("e", &["--force", "--json"]));
    let of = |method: &str| {
        report["results"]
            .as_array()
            .unwrap()
            .iter()
            .find(|r| r["method"] == method)
            .unwrap()
            .clone()
    };
    assert!(
        of("abuffer")["image_mse"].as_f64().unwrap() < 1e-20
            && of("abuffer")["transmittance_mse"].as_f64().unwrap() < 1e-20
    );
    let (four, average) = (of("moment-power-4"), of("weighted-average"));
    assert!(four["image_mse"].as_f64().unwrap() < average["image_mse"].as_f64().unwrap());
    assert!(average["transmittance_mse"].is_null() && four["scene"] == "g");

    // The images as numbers have the error that is reported, to what f32 rounds; another method's have another.
    evaluate("f", &["--float-images"]).success();
    let image = |name: &str| {
        let path = Path::new(&at.path("f")).join("g").join(name);
        nmt::numeric::npy::read_npy::<f32>(&path).unwrap()
    };
    let (exact, found) = (image("truth.npy"), image("moment-power-4.npy"));
    assert_eq!(exact.shape(), [30, 40, 3]);
    let difference = found.mapv(f64::from) - exact.mapv(f64::from);
    let mse = difference.mapv(|d| d * d).mean().unwrap();
    let off = |of: &serde_json::Value| (mse / of["image_mse"].as_f64().unwrap() - 1.0).abs();
    assert!(off(&four) < 1e-3 && off(&average) > 1e-3, "{mse}");
    assert!(!Path::new(&at.path("e")).join("g/truth.npy").exists());

    evaluate("x", &["--background", "nan", "0", "0"])
        .code(2)
        .stderr(contains("background"));
    nmt(&[
        "evaluate",
        "--fragments",
        &at.path("g.npz"),
        "--methods",
        "moment-power-5",
        "--out",
        &at.path("x"),
    ])
    .code(2)
    .stderr(contains("moment-power-4"));
    assert!(!Path::new(&at.path("x")).exists());
}

/// The GPU draws what has a shader, and what has none is named; without a GPU there is an error, and no result.
#[test]
fn evaluate_draws_on_the_gpu() {
    let at = Workplace::new();
    let small = concat!(env!("CARGO_MANIFEST_DIR"), "/models/small.json");
    let evaluate = |out: &str, more: &[&str]| {
        let plain = [
            "evaluate",
            "--fragments",
            "spheres",
            "--size",
            "40x30",
            "--methods",
            "abuffer,weighted-average",
            "--model",
            small,
            "--out",
        ];
        nmt(&[&plain[..], &[&at.path(out), "--gpu"], more].concat())
    };
    if or_skip("gpu", nmt::gpu::Gpu::shared()).is_none() {
        evaluate("e", &[]).code(2).stderr(contains("no GPU adapter"));
        assert!(!Path::new(&at.path("e")).exists());
        return;
    }
    evaluate("e", &[])
        .success()
        .stdout(contains("against the images above").and(contains("abuffer has no shader")));
    for file in [
        "neural-small.gpu.png",
        "neural-small.gpu.flip.png",
        "weighted-average.gpu.png",
    ] {
        assert!(Path::new(&at.path("e/spheres")).join(file).is_file(), "{file}");
    }
    assert!(!Path::new(&at.path("e/spheres/abuffer.gpu.png")).exists());
    for storage in ["full", "half-color", "half"] {
        let report = json(evaluate("e", &["--force", "--json", "--gpu-storage", storage]));
        let result = report["results"]
            .as_array()
            .unwrap()
            .iter()
            .find(|r| r["method"] == "neural:small")
            .unwrap();
        let gpu = &result["gpu"];
        let within = gpu["channel_difference_999"].as_f64().unwrap();
        assert!(
            within <= if storage == "full" { 1e-3 } else { 0.05 },
            "{storage}: {within}"
        );
        assert!(
            gpu["seconds_weights"].as_f64().unwrap() > 0.0
                && !gpu["adapter"].as_str().unwrap().is_empty()
                && gpu["image_nonfinite"] == 0
        );
    }
    nmt(&[
        "evaluate",
        "--fragments",
        "spheres",
        "--out",
        &at.path("x"),
        "--gpu-storage",
        "half",
    ])
    .code(2)
    .stderr(contains("--gpu"));
}

/// Without colours and size there are errors of T, and a word about the missing pictures.
#[test]
fn evaluate_does_without_pictures() {
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
        "evaluate",
        "--fragments",
        &at.path("f.npz"),
        "--methods",
        "moment-power-6",
        "--out",
        &at.path("e"),
    ])
    .success()
    .stdout(contains("no pictures").and(contains("moment-power-6")));
    nmt(&[
        "evaluate",
        "--fragments",
        &at.path("f.npz"),
        "--methods",
        "low-resolution-moments:2",
        "--out",
        &at.path("e"),
        "--force",
    ])
    .code(2)
    .stdout(contains("not applied"));
}

/// After a prepass the answers are others, and not worse in a scene of thin pixels.
#[test]
fn a_prepass_helps_thin_pixels() {
    let at = Workplace::new();
    let model = format!("{}/models/recommended.json", env!("CARGO_MANIFEST_DIR"));
    let evaluate = [
        "evaluate",
        "--fragments",
        "smoke",
        "--size",
        "64x64",
        "--model",
        &model,
        "--methods",
        "abuffer",
        "--depth-range",
        "0.001",
        "10000",
    ];
    let report = json(nmt(
        &[&evaluate[..], &["--prepass", "--out", &at.path("e"), "--json"]].concat()
    ));
    let mse = |name: &str| {
        let results = report["results"].as_array().unwrap();
        results
            .iter()
            .find(|r| r["method"] == name)
            .and_then(|r| r["transmittance_mse"].as_f64())
            .unwrap_or_else(|| panic!("{name}"))
    };
    assert!(mse("neural:recommended @ prepass") < mse("neural:recommended"));
    let sample = format!("{}/data/sample.npz", env!("CARGO_MANIFEST_DIR"));
    let predict = |prepass: &[&str], out: &str| {
        json(nmt(&[
            &[
                "predict",
                &model,
                "--fragments",
                &sample,
                "--out",
                &at.path(out),
                "--json",
            ],
            prepass,
        ]
        .concat()))["results"][0]["frame"]
            .clone()
    };
    assert_eq!(
        (predict(&[], "a.npy"), predict(&["--prepass"], "b.npy")),
        ("scene".into(), "pixel".into())
    );
    assert_ne!(
        std::fs::read(at.path("a.npy")).unwrap(),
        std::fs::read(at.path("b.npy")).unwrap()
    );
    nmt(&[
        &evaluate[..5],
        &["--methods", "abuffer", "--prepass", "--out", &at.path("x")],
    ]
    .concat())
    .code(2)
    .stderr(contains("--model"));
}

/// What is wrong with the last scene is said before the first is judged, and nothing is written.
#[test]
fn evaluate_reads_all_scenes_first() {
    let at = Workplace::new();
    std::fs::write(at.path("bad.npz"), b"no archive").unwrap();
    nmt(&[
        "evaluate",
        "--fragments",
        "glass-stacks",
        &at.path("bad.npz"),
        "--methods",
        "abuffer",
        "--out",
        &at.path("e"),
    ])
    .code(2)
    .stderr(contains("bad.npz"));
    assert!(!Path::new(&at.path("e")).exists());
}

/// What may not be replaced, and what is no input, is said before the first scene is read: here one that could not be.
/// Control: with `--force`, and with inputs that are there, it is read.
#[test]
fn evaluate_refuses_before_it_reads() {
    let at = Workplace::new();
    let bad = at.write("bad.npz", "no archive");
    let evaluate = |more: &[&str]| {
        let out = at.path("e");
        nmt(&[
            &["evaluate", "--methods", "abuffer", "--out", &out, "--fragments", &bad],
            more,
        ]
        .concat())
        .code(2)
    };
    let says = |reason: &'static str| contains(reason).and(contains("not a readable").not());
    std::fs::create_dir_all(at.path("e/bad")).unwrap();
    at.write("e/bad/truth.png", "");
    evaluate(&[]).stderr(says("already exists"));
    evaluate(&["--force"]).stderr(contains("not a readable"));
    at.write("e/results.json", "{}");
    evaluate(&[]).stderr(says("already exists"));
    evaluate(&["castle"]).stderr(says("no built-in scene 'castle'"));
    evaluate(&["none.npz"]).stderr(says("none.npz: cannot read"));
    evaluate(&["none.obj"]).stderr(says("none.obj: cannot read"));
    at.write("e/unfinished.json", r#"{"command": "another"}"#);
    std::fs::remove_file(at.path("e/results.json")).unwrap();
    evaluate(&[]).stderr(says("interrupted"));
}

/// Scenes of one name are told apart by their folders, and an evaluation that was interrupted goes on: scenes that are
/// done are not judged again, and the numbers are those of one that was not interrupted. Control: another command does
/// not go on.
#[test]
fn evaluate_goes_on() {
    let at = Workplace::new();
    for (folder, scene) in [("a", "glass-stacks"), ("b", "spheres")] {
        std::fs::create_dir(at.path(folder)).unwrap();
        let file = at.path(&format!("{folder}/x.npz"));
        nmt(&["scene", scene, "--size", "40x30", "--out", &file]).success();
    }
    let evaluate = |methods: &str, more: &[&str]| {
        let (a, b, out) = (at.path("a/x.npz"), at.path("b/x.npz"), at.path("e"));
        nmt(&[
            &["evaluate", "--fragments", &a, &b, "--methods", methods, "--out", &out],
            more,
        ]
        .concat())
    };
    let methods = "abuffer,moment-power-4,weighted-average";
    // A folder where the second scene's picture belongs interrupts the first attempt.
    let blocked = at.path("e/b-x/abuffer.png");
    std::fs::create_dir_all(&blocked).unwrap();
    evaluate(methods, &[]).code(2).stderr(contains("abuffer.png"));
    std::fs::remove_dir(&blocked).unwrap();
    let done = std::path::PathBuf::from(at.path("e/a-x/scene.json"));
    assert!(done.is_file() && !Path::new(&at.path("e/results.json")).exists());
    evaluate("abuffer", &[]).code(2).stderr(contains("interrupted"));

    // What --force was interrupted in began anew: nothing that stood there before is taken for finished, neither by
    // itself nor by the same command without it.
    let kept_of = |path: &Path, remark: &str| {
        let kept = std::fs::read_to_string(path).unwrap();
        let marked = kept.replace("\"remarks\":\"\"", &format!("\"remarks\":\"{remark}\""));
        assert_ne!(marked, kept);
        std::fs::write(path, marked).unwrap();
    };
    kept_of(&done, "of an earlier run");
    let block_first = at.path("e/a-x/abuffer.png");
    std::fs::remove_file(&block_first).unwrap();
    std::fs::create_dir(&block_first).unwrap();
    evaluate(methods, &["--force"]).code(2).stderr(contains("abuffer.png"));
    assert!(!done.exists(), "what was kept before --force");
    std::fs::remove_dir(&block_first).unwrap();
    std::fs::create_dir_all(&blocked).unwrap();
    evaluate(methods, &[])
        .code(2)
        .stderr(contains("abuffer.png"))
        .stdout(contains("earlier").not());
    std::fs::remove_dir(&blocked).unwrap();

    // What is kept of a scene is read and not judged again: it shows in the second attempt.
    kept_of(&done, "as it was kept");
    evaluate(methods, &[])
        .success()
        .stdout(contains("as it was kept").and(contains("a-x").and(contains("b-x"))));
    for file in ["unfinished.json", "evaluate.lock", "a-x/scene.json", "b-x/scene.json"] {
        assert!(!Path::new(&at.path("e")).join(file).exists(), "{file}");
    }
    let read = || -> serde_json::Value {
        let text = std::fs::read(at.path("e/results.json")).unwrap();
        serde_json::from_slice(&text).unwrap()
    };
    let errors = |report: &serde_json::Value| -> Vec<(String, String, Option<f64>)> {
        let results = report["results"].as_array().unwrap();
        let text = |value: &serde_json::Value| value.as_str().unwrap().to_owned();
        let of = |r: &serde_json::Value| (text(&r["scene"]), text(&r["method"]), r["image_mse"].as_f64());
        results.iter().map(of).collect()
    };
    let gone_on = errors(&read());
    assert_eq!(gone_on.len(), 6);
    evaluate(methods, &["--force"]).success();
    assert_eq!(errors(&read()), gone_on);

    // Interrupted over finished work that it was told to replace, it goes on without being told again.
    evaluate(methods, &[]).code(2).stderr(contains("already exists"));
    std::fs::remove_file(&blocked).unwrap();
    std::fs::create_dir(&blocked).unwrap();
    evaluate(methods, &["--force"]).code(2);
    std::fs::remove_dir(&blocked).unwrap();
    kept_of(&done, "as it was kept");
    evaluate(methods, &[]).success().stdout(contains("as it was kept"));
    assert_eq!(errors(&read()), gone_on);
}
