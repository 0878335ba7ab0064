//! `nmt scene`.

use crate::common::{Workplace, json, nmt};
use predicates::str::contains;
use std::path::Path;

/// A scene to a fragment list, to a deep image and back: the same fragments.
#[test]
fn scenes_become_fragment_lists() {
    let at = Workplace::new();
    let report = json(nmt(&[
        "scene",
        "spheres",
        "--size",
        "48x32",
        "--out",
        &at.path("s.npz"),
        "--json",
    ]));
    let result = &report["results"][0];
    assert_eq!(
        (
            result["width"].as_u64(),
            result["height"].as_u64(),
            result["pixels"].as_u64()
        ),
        (Some(48), Some(32), Some(48 * 32))
    );
    assert!(result["fragments"].as_u64().unwrap() > 1000);
    nmt(&["scene", "spheres", "--size", "48x32", "--out", &at.path("s.npz")])
        .code(2)
        .stderr(contains("--force"));
    nmt(&["scene", &at.path("s.npz"), "--out", &at.path("s.exr")]).success();
    let back = json(nmt(&["scene", &at.path("s.exr"), "--out", &at.path("b.npz"), "--json"]));
    assert_eq!(back["results"][0]["fragments"], result["fragments"]);
    for scene in ["configs/scenes/house.toml", "configs/scenes/smoke.toml"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(scene);
        nmt(&[
            "scene",
            path.to_str().unwrap(),
            "--size",
            "32x32",
            "--out",
            &at.path("t.npz"),
            "--force",
        ])
        .success();
    }
    nmt(&["scene", "castle", "--out", &at.path("c.npz")])
        .code(2)
        .stderr(contains("glass-stacks"));
    nmt(&["scene", "smoke", "--size", "0x9", "--out", &at.path("c.npz")]).code(2);
    nmt(&["scene", "smoke", "--size", "99999x99999", "--out", &at.path("c.npz")]).code(2);
    nmt(&["scene", "smoke", "--out", &at.path("c.png")])
        .code(2)
        .stderr(contains("c.png"));
    nmt(&["scene", &at.path("s.npz"), "--size", "8x8", "--out", &at.path("c.npz")])
        .code(2)
        .stderr(contains("--size"));
    nmt(&[
        "scene",
        &at.write("bad.exr", "not an image"),
        "--out",
        &at.path("c.npz"),
    ])
    .code(2)
    .stderr(contains("bad.exr"));
    nmt(&[
        "scene",
        &at.write("bad.toml", "built_in = 'smoke'\nsurprise = 1"),
        "--out",
        &at.path("c.npz"),
    ])
    .code(2)
    .stderr(contains("surprise"));
    assert!(!Path::new(&at.path("c.npz")).exists());
}
