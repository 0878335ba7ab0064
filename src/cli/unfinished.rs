//! Evaluations that were interrupted: what was done is not done again.

use crate::numeric::file::{FileError, Lock, Replace, read, write_atomically};
use anyhow::bail;
use serde_json::{Map, Value, json};
use std::path::{Path, PathBuf};

/// The scenes of an evaluation that are done, kept in its folder until all are.
pub struct Unfinished {
    path: PathBuf,
    request: Value,
    scenes: Map<String, Value>,
    resumed: bool,
    _lock: Lock,
}

/// The file in the folder of results.
const NAME: &str = "unfinished.json";

impl Unfinished {
    /// Begins an evaluation in a folder, or goes on with one that was interrupted there and that was asked for the same.
    ///
    /// # Errors
    /// Where another process is at work there, or where the one that was interrupted was asked for something else, unless `force` drops it.
    pub fn open(folder: &Path, request: Value, force: bool) -> anyhow::Result<Self> {
        let lock = Lock::acquire(&folder.join("evaluate.lock"))?;
        let path = folder.join(NAME);
        let mut unfinished = Self {
            request,
            scenes: Map::new(),
            resumed: false,
            _lock: lock,
            path,
        };
        if unfinished.path.exists() {
            let earlier: Option<Value> = serde_json::from_slice(&read(&unfinished.path)?).ok();
            match earlier {
                Some(mut earlier) if earlier["request"] == unfinished.request => {
                    unfinished.resumed = true;
                    if let Value::Object(scenes) = earlier["scenes"].take() {
                        unfinished.scenes = scenes;
                    }
                }
                _ if force => {}
                _ => bail!(
                    "{}: another evaluation was interrupted here; repeat its command to go on with it, choose another --out, or pass --force to drop it",
                    unfinished.path.display()
                ),
            }
        }
        unfinished.save()?;
        Ok(unfinished)
    }

    /// Whether files may be replaced that an interrupted evaluation of the same kind left.
    pub fn replace(&self, replace: Replace) -> Replace {
        if self.resumed { Replace::Yes } else { replace }
    }

    /// What was kept of a scene.
    pub fn scene(&self, name: &str) -> Option<&Value> {
        self.scenes.get(name)
    }

    /// Keeps a scene that is done.
    pub fn keep(&mut self, name: &str, scene: Value) -> Result<(), FileError> {
        self.scenes.insert(name.to_owned(), scene);
        self.save()
    }

    fn save(&self) -> Result<(), FileError> {
        let text = json!({ "request": self.request, "scenes": self.scenes }).to_string();
        write_atomically(&self.path, Replace::Yes, |w| w.write_all(text.as_bytes()))
    }

    /// Ends it: the results are elsewhere.
    pub fn finish(self) -> Result<(), FileError> {
        std::fs::remove_file(&self.path).map_err(FileError::io(&self.path, "cannot be removed"))
    }
}
