//! The repository's own sources, as tests of their style read them.

use std::path::{Path, PathBuf};

/// All files below a folder with one of these endings; what is built or installed there is none of ours.
pub fn files(folder: &Path, endings: &[&str]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap();
        if path.is_dir() && !["target", "node_modules", "snapshots"].contains(&name) && !name.starts_with('.') {
            found.extend(files(&path, endings));
        } else if path
            .extension()
            .is_some_and(|e| endings.iter().any(|ending| e == *ending))
        {
            found.push(path);
        }
    }
    found
}

/// Lines that begin in code. Those that begin within a string may look like anything.
fn lines_of_code(text: &str) -> Vec<&str> {
    let (mut lines, mut closing) = (Vec::new(), None::<String>);
    for line in text.lines() {
        if closing.is_none() {
            lines.push(line);
        }
        let mut rest = line;
        loop {
            rest = match &closing {
                Some(end) => match rest.find(['\\', '"']) {
                    Some(at) if rest[at..].starts_with('\\') && end == "\"" => rest.get(at + 2..).unwrap_or_default(),
                    Some(at) if rest[at..].starts_with(end.as_str()) => {
                        let after = &rest[at + end.len()..];
                        closing = None;
                        after
                    }
                    Some(at) => &rest[at + 1..],
                    None => break,
                },
                None => match rest.find(['"', '/', '\'']) {
                    Some(at) if rest[at..].starts_with("//") => break,
                    Some(at) if rest[at..].starts_with("'\"'") => &rest[at + 3..],
                    Some(at) if rest[at..].starts_with('"') => {
                        let before = &rest[..at];
                        let hashes = before.len() - before.trim_end_matches('#').len();
                        closing = Some(format!("\"{}", "#".repeat(hashes)));
                        &rest[at + 1..]
                    }
                    Some(at) => &rest[at + 1..],
                    None => break,
                },
            };
        }
    }
    lines
}

/// The code of a file without the bodies of its modules `tests`, which may reach anywhere. What else stands under
/// `cfg(test)` stays. rustfmt puts the closing brace of a module at the start of a line.
pub fn without_tests(text: &str) -> Vec<&str> {
    let mut lines = Vec::new();
    let mut all = lines_of_code(text).into_iter();
    while let Some(line) = all.next() {
        lines.push(line);
        if line.ends_with("mod tests {") {
            all.by_ref().find(|line| *line == "}");
        }
    }
    lines
}
