//! No line of Rust, comments included, and no line of a document is beyond 120 columns; rows of tables may be.

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

fn walk(folder: &Path, out: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap();
        if path.is_dir() && !["target", "node_modules", "snapshots"].contains(&name) && !name.starts_with('.') {
            walk(&path, out);
        } else if path.extension().is_some_and(|e| e == "rs" || e == "md") {
            out.push(path);
        }
    }
}

#[test]
fn every_line_fits() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = Vec::new();
    walk(root, &mut files);
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
