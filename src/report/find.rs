//! What stands in a folder: the files that other commands wrote, read with bounds on all of them.

use super::html::bytes;
use crate::numeric::digest::sha256_hex;
use crate::numeric::file::FileError;
use serde_json::Value;
use std::collections::{BTreeMap, HashMap, VecDeque};
use std::io::Read;
use std::path::{Path, PathBuf};

/// Levels of folders below the one that is asked for.
const MAX_LEVELS: usize = 6;
/// Most files and folders that are looked at.
const MAX_ENTRIES: usize = 50_000;
/// Greatest size of a file of numbers \[bytes\].
const LARGEST_FILE: u64 = 64 << 20;
/// Greatest size of all of them together \[bytes\].
const LARGEST_TOTAL: u64 = 512 << 20;

/// A file of JSON.
#[derive(Debug, Clone)]
pub struct Document {
    /// Its name from the folder on, with slashes.
    pub name: String,
    /// Its content.
    pub value: Value,
}

impl Document {
    /// The command whose results it holds.
    pub fn command(&self) -> Option<&str> {
        self.value
            .get("results")
            .filter(|r| r.is_array())
            .and_then(|_| self.value.get("command")?.as_str())
    }

    /// The results.
    pub fn results(&self) -> &[Value] {
        super::value::list(&self.value, "results")
    }

    /// Whether it is a model.
    pub fn is_model(&self) -> bool {
        self.value.get("format").and_then(Value::as_str) == Some("nmt-model")
    }

    /// The folder that it stands in, with a slash at the end; empty for the folder that was asked for.
    pub fn folder(&self) -> &str {
        &self.name[..self.name.rfind('/').map_or(0, |at| at + 1)]
    }
}

/// Something that could not be used, and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// The file or folder, from the folder on.
    pub name: String,
    /// What is wrong with it, and what to do.
    pub reason: String,
}

impl std::fmt::Display for Problem {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {}", self.name, self.reason)
    }
}

/// What stands in a folder.
#[derive(Debug, Default)]
pub struct Found {
    /// Models and results, by name.
    pub documents: Vec<Document>,
    /// Losses of every epoch as CSV, by name.
    pub losses: BTreeMap<String, String>,
    /// Pictures, by name: where they are, and how large \[bytes\].
    pub pictures: BTreeMap<String, (PathBuf, u64)>,
    /// What could not be used.
    pub problems: Vec<Problem>,
    /// Files with the same content as another one, and its name.
    pub copies: Vec<(String, String)>,
    /// Number of JSON files that are not of this program's commands.
    pub others: usize,
    /// Every file that was read.
    pub read: Vec<PathBuf>,
}

impl Found {
    /// The documents that hold results of a command.
    pub fn of<'a>(&'a self, command: &'a str) -> impl Iterator<Item = &'a Document> {
        self.documents.iter().filter(move |d| d.command() == Some(command))
    }

    /// Looks through a folder and those below it. Links are not followed, hidden names are passed over.
    ///
    /// # Errors
    /// [`FileError`] where the folder itself cannot be read.
    pub fn search(folder: &Path) -> Result<Self, FileError> {
        let mut found = Self::default();
        let mut files = Vec::new();
        let mut entries = 0;
        let mut folders = VecDeque::from([(folder.to_owned(), String::new(), 0)]);
        while let Some((path, prefix, level)) = folders.pop_front() {
            let listed = std::fs::read_dir(&path)
                .and_then(|entries| entries.take(MAX_ENTRIES + 1).collect::<Result<Vec<_>, _>>());
            let mut listed = match listed {
                Ok(listed) => listed,
                Err(source) if level == 0 => {
                    return Err(FileError::Io {
                        path,
                        action: "cannot read the folder",
                        source,
                    });
                }
                Err(error) => {
                    found.problem(&prefix, format!("cannot be read: {error}"));
                    continue;
                }
            };
            listed.sort_by_key(std::fs::DirEntry::file_name);
            for entry in listed {
                entries += 1;
                if entries > MAX_ENTRIES {
                    found.problem(
                        &prefix,
                        format!(
                            "more than {MAX_ENTRIES} files and folders; the rest is left out, so name a smaller folder"
                        ),
                    );
                    folders.clear();
                    break;
                }
                let name = entry.file_name().to_string_lossy().into_owned();
                let Ok(kind) = entry.file_type() else { continue };
                if name.starts_with('.') || kind.is_symlink() {
                    continue;
                }
                let full = format!("{prefix}{name}");
                if kind.is_dir() {
                    if level < MAX_LEVELS {
                        folders.push_back((entry.path(), format!("{full}/"), level + 1));
                    } else {
                        found.problem(
                            &full,
                            format!("is more than {MAX_LEVELS} folders deep and left out; name a folder closer to it"),
                        );
                    }
                } else if kind.is_file() {
                    files.push((full, entry.path()));
                }
            }
        }
        // Upper folders first, so that of files with one content the one nearest the top is kept.
        files.sort_by_key(|(name, _)| (name.matches('/').count(), name.clone()));
        let mut total = 0;
        let mut seen = HashMap::new();
        for (name, path) in files {
            let ending = name.rsplit_once('.').map_or("", |(_, e)| e);
            match ending {
                "png" => match std::fs::metadata(&path) {
                    Ok(data) => drop(found.pictures.insert(name, (path, data.len()))),
                    Err(error) => found.problem(&name, format!("cannot be read: {error}")),
                },
                "json" if !name.ends_with(".checkpoint.json") => found.json(name, path, &mut total, &mut seen),
                "csv" if name.ends_with("losses.csv") => {
                    if let Some(content) = found.content(&name, path, &mut total) {
                        found
                            .losses
                            .insert(name, String::from_utf8_lossy(&content).into_owned());
                    }
                }
                _ => {}
            }
        }
        Ok(found)
    }

    fn json(&mut self, name: String, path: PathBuf, total: &mut u64, seen: &mut HashMap<String, String>) {
        let Some(content) = self.content(&name, path, total) else {
            return;
        };
        match serde_json::from_slice::<Value>(&content) {
            Err(error) => self.problem(
                &name,
                format!("is not whole JSON ({error}); write it again with the command that made it"),
            ),
            Ok(value) => {
                let first = seen
                    .entry(sha256_hex([content.as_slice()]))
                    .or_insert_with(|| name.clone());
                if *first != name {
                    self.copies.push((name, first.clone()));
                    return;
                }
                let document = Document { name, value };
                if document.command().is_some() || document.is_model() {
                    self.documents.push(document);
                } else {
                    self.others += 1;
                }
            }
        }
    }

    /// The bytes of a file within bounds.
    fn content(&mut self, name: &str, path: PathBuf, total: &mut u64) -> Option<Vec<u8>> {
        let most = LARGEST_FILE.min(LARGEST_TOTAL.saturating_sub(*total));
        let mut content = Vec::new();
        let read = std::fs::File::open(&path).and_then(|file| file.take(most + 1).read_to_end(&mut content));
        match read {
            Err(error) => self.problem(name, format!("cannot be read: {error}")),
            Ok(n) if n as u64 > most => {
                self.problem(
                    name,
                    format!(
                        "is left out: a file may have {}, and all together {}",
                        bytes(LARGEST_FILE),
                        bytes(LARGEST_TOTAL)
                    ),
                );
            }
            Ok(n) => {
                *total += n as u64;
                self.read.push(path);
                return Some(content);
            }
        }
        None
    }

    /// Notes what could not be used.
    pub fn problem(&mut self, name: &str, reason: String) {
        let name = if name.is_empty() {
            "the folder"
        } else {
            name.trim_end_matches('/')
        };
        self.problems.push(Problem {
            name: name.to_owned(),
            reason,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_what_is_there_and_names_what_is_broken() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let write = |name: &str, text: &str| {
            std::fs::create_dir_all(at(name).parent().unwrap()).unwrap();
            std::fs::write(at(name), text).unwrap();
        };
        write("e/results.json", r#"{"command": "evaluate", "results": []}"#);
        write("e/s/truth.png", "no picture, but that is asked later");
        write("m/model.json", r#"{"format": "nmt-model"}"#);
        write("m/exports/m.json", r#"{"format": "nmt-model"}"#);
        write("m/model.losses.csv", "epoch");
        write("m/model.checkpoint.json", "{");
        write("m/dataset/manifest.json", r#"{"format": "nmt-dataset"}"#);
        write("broken.json", r#"{"command": "evaluate", "results": [1e99999"#);
        write("huge.json", "[1e999]");
        write("deep.json", &"[".repeat(100_000));
        write("wrong.json", r#"{"command": "evaluate", "results": 5}"#);
        write(".hidden/results.json", "{");
        write("1/2/3/4/5/6/7/results.json", "{");
        #[cfg(unix)]
        std::os::unix::fs::symlink(folder.path(), at("loop")).unwrap();
        let found = Found::search(folder.path()).unwrap();
        let names: Vec<&str> = found.documents.iter().map(|d| d.name.as_str()).collect();
        assert_eq!(names, ["e/results.json", "m/model.json"]);
        assert_eq!((found.documents[0].folder(), found.of("evaluate").count()), ("e/", 1));
        assert_eq!(
            found.copies,
            [("m/exports/m.json".to_owned(), "m/model.json".to_owned())]
        );
        assert_eq!((found.losses.len(), found.pictures.len(), found.others), (1, 1, 2));
        let problems: Vec<&str> = found.problems.iter().map(|p| p.name.as_str()).collect();
        assert_eq!(problems, ["1/2/3/4/5/6/7", "broken.json", "deep.json", "huge.json"]);
        assert!(Found::search(&at("none")).is_err());
    }
}
