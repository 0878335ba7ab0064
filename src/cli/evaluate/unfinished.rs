//! An evaluation that was interrupted goes on: what each finished scene gave stands beside its pictures until all is
//! done.

use super::{Row, SceneResults};
use crate::numeric::digest::sha256_hex;
use crate::numeric::file::{FileError, Lock, Replace, create_folder, may_write, write_atomically};
use crate::pixel::FragmentList;
use anyhow::bail;
use serde::{Deserialize, Serialize};
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

/// In the folder of the evaluation: which command is at work there, or was when it was interrupted.
const UNFINISHED: &str = "unfinished.json";

/// In a scene's folder: what the scene gave.
const SCENE: &str = "scene.json";

/// In a scene's folder: what every evaluation with images writes.
const PICTURES: [&str; 2] = ["truth.png", "sheet.png"];

/// Arguments that change nothing of what is computed.
const WITHOUT_EFFECT: [&str; 4] = ["--force", "--quiet", "-q", "--json"];

#[derive(Serialize, Deserialize)]
struct Mark {
    /// Digest of the command, its networks and the program's version.
    command: String,
}

#[derive(Serialize, Deserialize)]
struct Finished {
    /// Digest of the command and the scene's fragments.
    of: String,
    rows: Vec<Row>,
    refused: Vec<(String, String, bool)>,
    remarks: String,
}

/// The folder of an evaluation that is at work: nobody else writes there.
pub struct Unfinished {
    out: PathBuf,
    command: String,
    _lock: Lock,
}

impl Unfinished {
    /// Takes the folder, and says whether files that stand there may be replaced: with `--force`, and where the same
    /// command was interrupted.
    ///
    /// # Errors
    /// Another process works there, or another command was interrupted there.
    pub fn begin(out: &Path, models: &[Vec<u8>], replace: Replace) -> anyhow::Result<(Self, Replace)> {
        create_folder(out)?;
        let lock = Lock::acquire(&out.join("evaluate.lock"))?;
        let command = command(models);
        let path = out.join(UNFINISHED);
        let replace = may_replace(out, &command, replace)?;
        let mark = serde_json::to_string(&Mark {
            command: command.clone(),
        })?;
        write_atomically(&path, Replace::Yes, |w| w.write_all(mark.as_bytes()))?;
        let unfinished = Self {
            out: out.to_owned(),
            command,
            _lock: lock,
        };
        Ok((unfinished, replace))
    }

    /// Refuses what [`Self::begin`] would, and pictures of a scene that may not be replaced; nothing is written, so
    /// that it can be asked before scenes are read.
    pub fn may_begin(out: &Path, models: &[Vec<u8>], replace: Replace, scenes: &[String]) -> anyhow::Result<()> {
        let replace = may_replace(out, &command(models), replace)?;
        let pictures = scenes
            .iter()
            .flat_map(|scene| PICTURES.map(|name| out.join(scene).join(name)));
        pictures.into_iter().try_for_each(|path| Ok(may_write(&path, replace)?))
    }

    /// What a scene of this name gave before the command was interrupted; none where it did not come that far, or where
    /// its fragments are others now.
    pub fn restore(&self, name: &str, list: &FragmentList) -> Option<SceneResults> {
        let text = fs::read(self.path(name)).ok()?;
        let finished: Finished = serde_json::from_slice(&text).ok()?;
        (finished.of == self.of(list)).then(|| SceneResults {
            rows: with_infinities(finished.rows),
            refused: finished.refused,
            remarks: finished.remarks,
            ..SceneResults::new(name, list)
        })
    }

    /// Keeps what a scene gave until all are done. Numbers that JSON cannot hold are not kept: such a scene is computed
    /// again.
    pub fn keep(&self, scene: &SceneResults, list: &FragmentList) -> anyhow::Result<()> {
        let finished = Finished {
            of: self.of(list),
            rows: scene.rows.clone(),
            refused: scene.refused.clone(),
            remarks: scene.remarks.clone(),
        };
        let text = serde_json::to_string(&finished)?;
        let read: Finished = serde_json::from_str(&text)?;
        if with_infinities(read.rows) == scene.rows {
            write_atomically(&self.path(&scene.name), Replace::Yes, |w| w.write_all(text.as_bytes()))?;
        }
        Ok(())
    }

    /// Removes what was kept: all is done.
    pub fn end(self, scenes: &[SceneResults]) -> Result<(), FileError> {
        let files = scenes.iter().map(|scene| self.path(&scene.name));
        for path in files.chain([self.out.join(UNFINISHED)]) {
            match fs::remove_file(&path) {
                Err(e) if e.kind() != std::io::ErrorKind::NotFound => {
                    return Err(FileError::io(&path, "cannot remove what was kept")(e));
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn path(&self, scene: &str) -> PathBuf {
        self.out.join(scene).join(SCENE)
    }

    fn of(&self, list: &FragmentList) -> String {
        let colors = list.color().unwrap_or(&[]);
        sha256_hex([
            self.command.as_bytes(),
            bytemuck::cast_slice(list.offsets()),
            bytemuck::cast_slice(list.view_z()),
            bytemuck::cast_slice(list.alpha()),
            bytemuck::cast_slice(colors.as_flattened()),
            format!("{:?} {:?}", list.size(), list.planes()).as_bytes(),
        ])
    }
}

/// Whether a command may replace the files of a folder: with `--force`, or where it was interrupted there itself.
fn may_replace(out: &Path, command: &str, replace: Replace) -> anyhow::Result<Replace> {
    let before = match fs::read(out.join(UNFINISHED)) {
        Ok(text) => serde_json::from_slice::<Mark>(&text).ok(),
        Err(_) => None,
    };
    match before {
        Some(mark) if mark.command == command => Ok(Replace::Yes),
        Some(_) if replace == Replace::No => bail!(
            "{}: another evaluation was interrupted here; finish it by its own command, choose another folder, or \
             pass --force to begin anew",
            out.display()
        ),
        _ => Ok(replace),
    }
}

/// A peak signal-to-noise ratio is infinite where the error is 0, and null in JSON.
fn with_infinities(mut rows: Vec<Row>) -> Vec<Row> {
    for row in &mut rows {
        if row.cpu.image_mse == Some(0.0) {
            row.cpu.image_psnr_db = Some(f64::INFINITY);
        }
    }
    rows
}

/// Digest of the command as it was typed, of the model files that it names, and of the program's version.
fn command(models: &[Vec<u8>]) -> String {
    let effective = |argument: &OsString| !WITHOUT_EFFECT.iter().any(|none| argument == none);
    let arguments: Vec<OsString> = std::env::args_os().skip(1).filter(effective).collect();
    let commit = option_env!("NMT_COMMIT").unwrap_or("");
    let text = format!("{} {commit} {arguments:?}", env!("CARGO_PKG_VERSION"));
    sha256_hex(std::iter::once(text.as_bytes()).chain(models.iter().map(Vec::as_slice)))
}
