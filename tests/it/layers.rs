//! The layers of the library: a module imports only from those above it.

use crate::sources::{files, without_tests};
use std::path::Path;

/// Top to bottom; modules on one line do not import one another.
const ORDER: [&[&str]; 17] = [
    &["numeric"],
    &["pixel", "chart"],
    &["synth", "scene"],
    &["moments"],
    &["features"],
    &["dataset"],
    &["model"],
    &["infer"],
    &["train"],
    &["oit"],
    &["export"],
    &["shader"],
    &["gpu"],
    &["check"],
    &["evaluate"],
    &["bench", "stress", "profile", "report"],
    &["cli"],
];

fn level(module: &str) -> Option<usize> {
    ORDER.iter().position(|line| line.contains(&module))
}

/// Modules that the text of a module names: `crate::name` anywhere, and the heads of a `use crate::{...}` group.
fn imports(text: &str) -> Vec<String> {
    let word = |rest: &str| -> String { rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect() };
    let mut names = Vec::new();
    for (at, _) in text.match_indices("crate::") {
        let rest = &text[at + "crate::".len()..];
        let Some(group) = rest.strip_prefix('{') else {
            names.push(word(rest));
            continue;
        };
        let (mut depth, mut fresh) = (0, true);
        for (i, c) in group.char_indices() {
            match c {
                '{' => depth += 1,
                '}' if depth == 0 => break,
                '}' => depth -= 1,
                ',' if depth == 0 => fresh = true,
                c if fresh && c.is_alphabetic() => {
                    names.push(word(&group[i..]));
                    fresh = false;
                }
                _ => {}
            }
        }
    }
    names
}

/// What a module may not import: anything on its own line but itself, or further down.
fn violations(module: &str, text: &str) -> Vec<String> {
    let own = level(module).unwrap_or_else(|| panic!("module '{module}' has no place in the order of layers"));
    imports(text)
        .into_iter()
        .filter(|name| name != module && level(name).is_some_and(|l| l >= own))
        .collect()
}

#[test]
fn data_flows_down() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let files = files(&src, &["rs"]);
    assert!(files.len() > 20, "the sources were not found");
    for file in files {
        let relative = file.strip_prefix(&src).unwrap();
        let Some(module) = relative
            .components()
            .next()
            .filter(|_| relative.components().count() > 1)
        else {
            continue;
        };
        let module = module.as_os_str().to_str().unwrap();
        let text = std::fs::read_to_string(&file).unwrap();
        let wrong = violations(module, &without_tests(&text).join("\n"));
        assert!(
            wrong.is_empty(),
            "{} imports from below it: {wrong:?}",
            relative.display()
        );
    }
}

/// burn and clap each have one home.
#[test]
fn burn_and_clap_stay_at_home() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let files = files(&src, &["rs"]);
    for file in files {
        let text = std::fs::read_to_string(&file).unwrap();
        for (word, home) in [("use burn::", "train"), ("use clap::", "cli"), ("indicatif::", "cli")] {
            assert!(
                !text.contains(word) || file.starts_with(src.join(home)),
                "{} uses {word}",
                file.display()
            );
        }
    }
}

/// The control: only the body of `mod tests` is left out; what stands behind a `cfg(test)` in mid-file, or behind the
/// tests, is checked.
#[test]
fn only_tests_are_left_out() {
    let wrong = |text: &str| violations("pixel", &without_tests(text).join("\n"));
    let head = "use crate::numeric::rng;\n\n#[cfg(test)]\nmod testing;\n";
    assert_eq!(wrong(&format!("{head}use crate::oit::Method;\n")), ["oit"]);
    let tests = "#[cfg(test)]\npub(crate) mod tests {\n    use crate::gpu::Gpu;\n    mod deeper {\n    }\n}\n";
    assert_eq!(wrong(&format!("{head}{tests}")), Vec::<String>::new());
    assert_eq!(
        wrong(&format!("{head}{tests}fn f() {{ crate::check::check(); }}\n")),
        ["check"]
    );
}

/// The control: imports from below are seen in every spelling.
#[test]
fn violations_are_seen() {
    assert_eq!(violations("pixel", "use crate::moments::power;"), ["moments"]);
    assert_eq!(
        violations("numeric", "fn f() { crate::pixel::absorbance(0.5); }"),
        ["pixel"]
    );
    assert_eq!(
        violations("synth", "use crate::{numeric::rng, scene::{npz, obj}, train};"),
        ["scene", "train"]
    );
    assert_eq!(
        violations("cli", "use crate::{train, check::check};"),
        Vec::<String>::new()
    );
}
