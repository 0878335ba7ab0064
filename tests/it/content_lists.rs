//! Fragment lists as NumPy writes them: every type is taken or named with its remedy, and depths that are none are
//! told.

use assert_cmd::Command;
use ndarray::{ArrayView1, ArrayView2, arr0};
use nmt::numeric::file::Replace;
use nmt::numeric::npy::{encode, write_npz};
use nmt::scene::npz;
use serde_json::Value;
use std::path::Path;

type Arrays<'a> = Vec<(&'a str, Vec<u8>)>;

/// Two pixels of two fragments.
fn arrays() -> Arrays<'static> {
    vec![
        ("offsets", encode(ArrayView1::from(&[0u64, 2, 4]))),
        ("view_z", encode(ArrayView1::from(&[1.5f32, 2.0, 3.0, 2.5]))),
        ("alpha", encode(ArrayView1::from(&[0.5f32, 0.25, 0.5, 1.0]))),
        ("width", encode(arr0(2u32).view())),
        ("height", encode(arr0(1u32).view())),
    ]
}

fn with(name: &'static str, bytes: Vec<u8>) -> Arrays<'static> {
    let mut all = arrays();
    all.retain(|(n, _)| *n != name);
    all.push((name, bytes));
    all
}

fn write(folder: &Path, arrays: &Arrays<'_>) -> std::path::PathBuf {
    let path = folder.join("a.npz");
    write_npz(&path, Replace::Yes, arrays).unwrap();
    path
}

/// A header's type and byte order changed, which is what another program would have written.
fn retyped(bytes: Vec<u8>, from: &str, to: &str) -> Vec<u8> {
    let at = bytes.windows(from.len()).position(|w| w == from.as_bytes()).unwrap();
    [&bytes[..at], to.as_bytes(), &bytes[at + from.len()..]].concat()
}

#[test]
fn types_are_taken_or_named_with_their_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let expected = npz::read(&write(folder.path(), &arrays())).unwrap();
    for bytes in [
        encode(arr0(2u8).view()),
        encode(arr0(2i8).view()),
        encode(arr0(2u16).view()),
        encode(arr0(2i16).view()),
        encode(arr0(2i32).view()),
        encode(arr0(2u64).view()),
        encode(arr0(2i64).view()),
        encode(arr0(2.0f64).view()),
        encode(arr0(2.0f32).view()),
        encode(ArrayView1::from(&[2u8])),
    ] {
        assert_eq!(
            npz::read(&write(folder.path(), &with("width", bytes))).unwrap(),
            expected
        );
    }
    for offsets in [
        encode(ArrayView1::from(&[0u32, 2, 4])),
        encode(ArrayView1::from(&[0i64, 2, 4])),
        encode(ArrayView1::from(&[0i32, 2, 4])),
    ] {
        assert_eq!(
            npz::read(&write(folder.path(), &with("offsets", offsets))).unwrap(),
            expected
        );
    }
    let z = [1.5f32, 2.0, 3.0, 2.5];
    let floats = || encode(ArrayView1::from(&z));
    for (name, bytes, part) in [
        (
            "view_z",
            encode(ArrayView1::from(&z.map(f64::from))),
            "it is float64; write .astype(np.float32)",
        ),
        (
            "alpha",
            retyped(encode(ArrayView1::from(&[0u16; 4])), "<u2", "<f2"),
            "it is float16; write .astype(np.float32)",
        ),
        (
            "view_z",
            retyped(floats(), "<f4", ">f4"),
            "it is big-endian float32; write .astype('<f4')",
        ),
        (
            "alpha",
            encode(ArrayView1::from(&[0i32, 1, 1, 0])),
            "it is int32; write .astype(np.float32)",
        ),
        (
            "color",
            encode(ArrayView2::from(&[[0u8, 128, 255]; 4])),
            "divide it by 255, make it linear",
        ),
        (
            "offsets",
            encode(ArrayView1::from(&[0.0f32, 2.0, 4.0])),
            "it is float32; write .astype(np.uint64)",
        ),
        (
            "color",
            encode(ArrayView2::from(&[[0.0f32, -1.0, 0.0]; 4])),
            "0 or more",
        ),
    ] {
        let message = npz::read(&write(folder.path(), &with(name, bytes)))
            .unwrap_err()
            .to_string();
        assert!(message.contains(part) && message.contains(name), "{message} / {part}");
        assert!(!message.contains("descriptor"), "{message}");
    }
    let bright = with("color", encode(ArrayView2::from(&[[0.0f32, 5.0, 1.0]; 4])));
    assert_eq!(npz::read(&write(folder.path(), &bright)).unwrap().brightest(), 5.0);
    let more = with("normals", encode(arr0(1u8).view()));
    let list = npz::read(&write(folder.path(), &more)).unwrap();
    assert!(
        list.left_out()[0].to_string().contains("arrays normals"),
        "{:?}",
        list.left_out()
    );
}

fn nmt(args: &[&str]) -> Command {
    let mut command = Command::cargo_bin("nmt").unwrap();
    command.args(args);
    command
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn depths_that_are_none_are_told_whatever_the_method() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let evaluate = |z: [f32; 4], more: &[&str]| {
        let path = write(folder.path(), &with("view_z", encode(ArrayView1::from(&z))));
        let mut args = vec![
            "evaluate",
            "--methods",
            "weighted-average",
            "--json",
            "--force",
            "--fragments",
            path.to_str().unwrap(),
        ];
        let out = at("e");
        args.extend(["--out", &out]);
        args.extend(more);
        nmt(&args).output().unwrap()
    };
    for (z, kind, part) in [
        ([1.0, 1.0, 1.0, 1.0], "all-equal", "orthographic"),
        ([2.0, 2.0, 3.0, 3.0], "mostly-tied", "tie for nearest"),
        ([0.99, 0.95, 0.97, 0.999], "window-like", "gl_FragCoord.z"),
    ] {
        let output = evaluate(z, &[]);
        assert!(
            output.status.success() && text(&output.stderr).contains(part),
            "{}",
            text(&output.stderr)
        );
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(report["warnings"][0]["kind"], kind);
    }
    // The control: nothing to say.
    let fine = evaluate([1.5, 2.0, 3.0, 2.5], &["--near", "1", "--far", "4"]);
    let report: Value = serde_json::from_slice(&fine.stdout).unwrap();
    assert!(report["warnings"].as_array().unwrap().is_empty() && report["left_out"].as_array().unwrap().is_empty());
    let outside = evaluate([1.5, 2.0, 3.0, 2.5], &["--near", "1", "--far", "2.75"]);
    let report: Value = serde_json::from_slice(&outside.stdout).unwrap();
    assert_eq!(outside.status.code(), Some(2));
    assert!(
        report["error"].as_str().unwrap().contains("1 of 4 view depths"),
        "{report}"
    );
}

/// What is left out is in the JSON and on standard error; errors are JSON too, of wrong usage as well.
#[test]
fn what_is_said_is_in_the_json() {
    let folder = tempfile::tempdir().unwrap();
    let path = write(folder.path(), &with("normals", encode(arr0(1u8).view())));
    let out = folder.path().join("b.npz");
    let (path, out) = (path.to_str().unwrap(), out.to_str().unwrap());
    let output = nmt(&["scene", path, "--out", out, "--json"]).output().unwrap();
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["left_out"][0]["count"], 1);
    assert!(text(&output.stderr).contains("left out: arrays normals (1)"));
    assert!(
        nmt(&["scene", path, "--out", out, "--force", "--quiet"])
            .output()
            .unwrap()
            .stderr
            .is_empty()
    );
    for (args, part) in [
        (&["scene", "gone.npz", "--out", "x.npz", "--json"][..], "gone.npz"),
        (&["scene", path, "--out", out, "--json", "--frobnicate"], "--frobnicate"),
    ] {
        let output = nmt(args).output().unwrap();
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(output.status.code(), Some(2));
        assert!(
            report["error"].as_str().unwrap().contains(part) && report["command"] == "scene",
            "{report}"
        );
    }
}

#[cfg(unix)]
#[test]
fn names_of_files_need_not_be_utf8() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let folder = tempfile::tempdir().unwrap();
    let path = write(folder.path(), &arrays());
    let (odd, out) = (
        folder.path().join(OsStr::from_bytes(b"gr\xfcn.npz")),
        folder.path().join(OsStr::from_bytes(b"aus\xff.npz")),
    );
    if std::fs::rename(path, &odd).is_err() {
        eprintln!("SKIPPED: the file system takes no such name");
        return;
    }
    let output = Command::cargo_bin("nmt")
        .unwrap()
        .arg("scene")
        .arg(&odd)
        .arg("--out")
        .arg(&out)
        .arg("--json")
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(out.exists() && serde_json::from_slice::<Value>(&output.stdout).is_ok());
}
