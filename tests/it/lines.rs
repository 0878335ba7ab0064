//! No line of Rust, comments included, and no line of a document is beyond 120 columns; rows of tables may be. No
//! function outside tests has more than 80 lines.

use crate::sources::{files, without_tests};
use std::path::{Path, PathBuf};

/// Columns that a line may have.
const MAX_COLUMNS: usize = 120;

/// Numbers of lines that are too long. In documents, rows of tables may be.
fn too_long(name: &str, text: &str) -> Vec<usize> {
    let may = |line: &str| name.ends_with(".md") && (line.trim_start().starts_with('|') || line.starts_with("!["));
    let lines = text.lines().enumerate();
    lines
        .filter(|(_, line)| line.chars().count() > MAX_COLUMNS && !may(line))
        .map(|(index, _)| index + 1)
        .collect()
}

/// Lines that a function outside tests may have.
const MAX_LINES: usize = 80;

/// Names and lengths of functions that are too long; `mod tests` is left out. rustfmt puts the closing brace of a
/// function under its first line. Lines within strings are not counted.
fn long_functions(text: &str) -> Vec<(String, usize)> {
    let lines = without_tests(text);
    let mut found = Vec::new();
    for (first, line) in lines.iter().enumerate() {
        let head = line.trim_start();
        let is_head = |word: &str| head.starts_with(word) && !head.starts_with("fn(");
        let words = ["fn ", "pub ", "pub(", "const fn ", "unsafe fn ", "async fn "];
        let Some((_, name)) = head.split_once("fn ").filter(|_| words.into_iter().any(is_head)) else {
            continue;
        };
        let indent = &line[..line.len() - head.len()];
        let ends = |line: &&str| line.strip_prefix(indent) == Some("}");
        // A declaration without a body ends where its semicolon stands.
        let declared = lines[first..].iter().take_while(|line| !line.ends_with('{'));
        if declared.clone().any(|line| line.ends_with(';')) {
            continue;
        }
        let length = 1 + lines[first..].iter().position(ends).unwrap_or(0);
        if length > MAX_LINES {
            let name = name.split(|c: char| !c.is_alphanumeric() && c != '_').next();
            found.push((name.unwrap_or_default().to_owned(), length));
        }
    }
    found
}

#[test]
fn every_line_fits() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let files = files(root, &["rs", "md"]);
    assert!(files.len() > 200, "{}", files.len());
    let wrong: Vec<String> = files
        .iter()
        .filter_map(|file| {
            let name = file.strip_prefix(root).unwrap().to_str().unwrap().to_owned();
            let lines = too_long(&name, &std::fs::read_to_string(file).unwrap());
            (!lines.is_empty()).then(|| format!("{name}: {lines:?}"))
        })
        .collect();
    assert!(
        wrong.is_empty(),
        "lines beyond {MAX_COLUMNS} columns:\n{}",
        wrong.join("\n")
    );
}

/// Control: 120 columns fit and 121 do not, in code, in comments and in prose; rows of tables may be longer.
#[test]
fn long_lines_are_found() {
    let line = |start: &str, columns: usize| format!("{start}{}", "é".repeat(columns - start.chars().count()));
    for (name, start) in [("a.rs", "let x = "), ("a.rs", "// "), ("a.md", "")] {
        assert!(too_long(name, &line(start, 120)).is_empty());
        assert_eq!(too_long(name, &format!("short\n{}", line(start, 121))), [2]);
    }
    assert!(too_long("a.md", &line("| ", 200)).is_empty());
    assert_eq!(too_long("a.rs", &line("| ", 200)), [1]);
}

#[test]
fn every_function_is_short() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let files = files(&root.join("src"), &["rs"]);
    assert!(files.len() > 200, "{}", files.len());
    let of_file = |file: &PathBuf| {
        let found = long_functions(&std::fs::read_to_string(file).unwrap());
        let name = file.strip_prefix(root).unwrap().display().to_string();
        found
            .into_iter()
            .map(move |(function, length)| format!("{name}: {function} has {length}"))
    };
    let wrong: Vec<String> = files.iter().flat_map(of_file).collect();
    assert!(
        wrong.is_empty(),
        "functions beyond {MAX_LINES} lines:\n{}",
        wrong.join("\n")
    );
}

/// Control: 80 lines fit and 81 do not, of a function and of a method; what stands in `mod tests` may be longer, what
/// stands behind it may not.
#[test]
fn long_functions_are_found() {
    let function = |head: &str, indent: &str, lines: usize| {
        let body = format!("{indent}    let x = 1;\n").repeat(lines - 2);
        format!("{indent}{head}() {{\n{body}{indent}}}\n")
    };
    for head in ["fn one", "pub fn one", "pub(crate) const fn one", "unsafe fn one"] {
        for indent in ["", "    "] {
            assert!(long_functions(&function(head, indent, 80)).is_empty());
            assert_eq!(long_functions(&function(head, indent, 81)), [("one".to_owned(), 81)]);
        }
    }
    let tests = format!("mod tests {{\n{}}}\n", function("fn test", "    ", 200));
    assert!(long_functions(&tests).is_empty());
    assert_eq!(
        long_functions(&(tests + &function("fn two", "", 90))),
        [("two".to_owned(), 90)]
    );
    // A brace in a string closes nothing.
    for text in [
        "let a = \"\n}\n\";",
        "let a = r#\"\n\"}\n}\n\"#;",
        "let a = ('\"', \"\\\"\n}\n\"); // \"",
    ] {
        let tests = format!("mod tests {{\n    {text}\n{}}}\n", function("fn test", "    ", 200));
        assert!(long_functions(&tests).is_empty(), "{text}");
    }
    let declared = format!(
        "trait T {{\n    fn one(\n        a: u8,\n    );\n{}}}\n",
        "    // …\n".repeat(100)
    );
    assert!(long_functions(&declared).is_empty());
}
