//! The text of the shaders that the shipped networks become, so that every change of it is seen.
//!
//! After a change that is meant, `INSTA_UPDATE=always cargo nextest run --release -E 'test(shipped_shaders)'` rewrites
//! the snapshots; `git diff` then shows what a renderer will get.

use nmt::export::{Format, encode};
use nmt::model::file;
use nmt::numeric::digest::sha256_hex;
use std::path::Path;

const NETWORKS: [&str; 4] = ["recommended", "small", "moments-6", "paper"];

const FORMATS: [Format; 6] = [
    Format::WGSL,
    Format::WGSL_PLAIN,
    Format::GLSL,
    Format::GLSL_PLAIN,
    Format::HLSL,
    Format::HLSL_PLAIN,
];

/// The source with the items of every constant array of weights replaced by their number of lines and their digest: a
/// snapshot is there to be read.
fn without_weights(source: &str) -> String {
    let mut out = String::new();
    let mut items: Option<String> = None;
    for line in source.lines() {
        match &mut items {
            Some(weights) if line == ");" || line == "};" => {
                let digest = sha256_hex([weights.as_bytes()]);
                out += &format!(
                    "    {} lines, SHA-256 {}\n{line}\n",
                    weights.lines().count(),
                    &digest[..16]
                );
                items = None;
            }
            Some(weights) => {
                weights.push_str(line);
                weights.push('\n');
            }
            None => {
                out += line;
                out.push('\n');
                let opens = line.ends_with('(') || line.ends_with("= {");
                if opens && line.contains("const ") && line.contains("NMT_") {
                    items = Some(String::new());
                }
            }
        }
    }
    assert!(items.is_none(), "a constant array has no end");
    out
}

#[test]
fn shipped_shaders() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    for network in NETWORKS {
        let mlp = file::load(&folder.join(format!("{network}.json"))).unwrap();
        for format in FORMATS {
            let source = String::from_utf8(encode(&mlp, format).unwrap()).unwrap();
            assert_eq!(source.contains("nmt_visible_transmittance"), network != "paper");
            insta::assert_snapshot!(format!("{network}{}", format.suffix()), without_weights(&source));
        }
    }
}

/// The control: weights that differ in one digit, and text that differs in one word, are other snapshots.
#[test]
fn a_changed_weight_is_seen() {
    let source = "const NMT_W1 = array<f32, 2>(\n    1.5f,\n    2.5f\n);\nfn nmt_share() {}\n";
    let shown = without_weights(source);
    assert!(shown.contains("2 lines, SHA-256") && shown.ends_with("fn nmt_share() {}\n") && !shown.contains("2.5f"));
    assert_ne!(shown, without_weights(&source.replace("2.5f", "2.6f")));
    assert_ne!(shown, without_weights(&source.replace("share", "shares")));
}
