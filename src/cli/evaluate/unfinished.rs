//! An evaluation that was interrupted goes on: what each finished scene gave stands beside its pictures until all is
//! done.

use super::{Row, SceneResults};
use crate::model::shipped;
use crate::numeric::digest::sha256_hex;
use crate::numeric::file::{FileError, Lock, Replace, create_folder, may_write, write_atomically};
use crate::oit::colour_network;
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
    /// Digest of the command, the files that it reads, and the program with its networks.
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
    /// command was interrupted. With `--force` nothing goes on: what was kept of these scenes is removed.
    ///
    /// # Errors
    /// Another process works there, or another command was interrupted there.
    pub fn begin(
        out: &Path,
        scenes: &[String],
        inputs: &[Vec<u8>],
        replace: Replace,
    ) -> anyhow::Result<(Self, Replace)> {
        create_folder(out)?;
        let lock = Lock::acquire(&out.join("evaluate.lock"))?;
        let command = command(inputs);
        let goes_on = goes_on(out, &command, replace)?;
        let unfinished = Self {
            out: out.to_owned(),
            command,
            _lock: lock,
        };
        if !goes_on {
            unfinished.remove_kept(scenes.iter().map(String::as_str))?;
        }
        let mark = serde_json::to_string(&Mark {
            command: unfinished.command.clone(),
        })?;
        write_atomically(&out.join(UNFINISHED), Replace::Yes, |w| w.write_all(mark.as_bytes()))?;
        Ok((unfinished, if goes_on { Replace::Yes } else { replace }))
    }

    /// Refuses what [`Self::begin`] would, and pictures of a scene that may not be replaced; nothing is written, so
    /// that it can be asked before scenes are read.
    pub fn may_begin(out: &Path, inputs: &[Vec<u8>], replace: Replace, scenes: &[String]) -> anyhow::Result<()> {
        if goes_on(out, &command(inputs), replace)? {
            return Ok(());
        }
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
        self.remove_kept(scenes.iter().map(|scene| scene.name.as_str()))?;
        remove(&self.out.join(UNFINISHED))
    }

    fn remove_kept<'a>(&self, mut scenes: impl Iterator<Item = &'a str>) -> Result<(), FileError> {
        scenes.try_for_each(|scene| remove(&self.path(scene)))
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

/// Whether a command goes on where it was interrupted itself; with `--force` it begins anew.
///
/// # Errors
/// Another command was interrupted in the folder.
fn goes_on(out: &Path, command: &str, replace: Replace) -> anyhow::Result<bool> {
    match mark(out) {
        Some(mark) if replace == Replace::No && mark.command != command => bail!(
            "{}: another evaluation was interrupted here; finish it by its own command, choose another folder, or \
             pass --force to begin anew",
            out.display()
        ),
        left => Ok(left.is_some() && replace == Replace::No),
    }
}

/// Which command was interrupted in a folder, if any.
fn mark(out: &Path) -> Option<Mark> {
    serde_json::from_slice(&fs::read(out.join(UNFINISHED)).ok()?).ok()
}

/// Whether this command, with these inputs, was interrupted in a folder: whatever stands there was its to replace.
pub fn is_left(out: &Path, inputs: &[Vec<u8>]) -> bool {
    mark(out).is_some_and(|mark| mark.command == command(inputs))
}

/// Removes a file, if it is there.
fn remove(path: &Path) -> Result<(), FileError> {
    match fs::remove_file(path) {
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => {
            Err(FileError::io(path, "cannot remove what was kept")(e))
        }
        _ => Ok(()),
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

/// Digest of the command as it was typed, of the files that it reads, of the program's version, and of the networks
/// that come with the program: one that is built from changed files has the revision of the one before.
fn command(inputs: &[Vec<u8>]) -> String {
    let effective = |argument: &OsString| !WITHOUT_EFFECT.iter().any(|none| argument == none);
    let arguments: Vec<OsString> = std::env::args_os().skip(1).filter(effective).collect();
    let commit = option_env!("NMT_COMMIT").unwrap_or("");
    let text = format!("{} {commit} {arguments:?}", env!("CARGO_PKG_VERSION"));
    digest(&text, inputs, shipped::files().chain(colour_network::SHIPPED))
}

/// Digest of a command, of the files that it reads and of the networks of the program.
fn digest(command: &str, inputs: &[Vec<u8>], networks: impl Iterator<Item = &'static [u8]>) -> String {
    // One digest each, so that no part of one can pass for a part of its neighbour.
    let of = |part: &[u8]| sha256_hex([part]);
    let mut digests = vec![of(command.as_bytes())];
    digests.extend(inputs.iter().map(|input| of(input)));
    digests.extend(networks.map(of));
    sha256_hex(digests.iter().map(String::as_bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Controls: another command, another input, and other weights of a network that comes with the program are not
    /// the same work.
    #[test]
    fn what_is_the_same_work() {
        let networks = || shipped::files().chain(colour_network::SHIPPED);
        let inputs = [b"model".to_vec(), b"scene".to_vec()];
        let same = digest("evaluate", &inputs, networks());
        assert_eq!(same, digest("evaluate", &inputs, networks()));
        for other in [
            digest("evaluate --orders 2", &inputs, networks()),
            digest("evaluate", &[b"models".to_vec(), b"cene".to_vec()], networks()),
            digest(
                "evaluate",
                &inputs,
                networks().skip(1).chain([b"other weights".as_slice()]),
            ),
        ] {
            assert_ne!(other, same);
        }
    }
}
