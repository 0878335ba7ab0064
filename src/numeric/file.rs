//! Writing files so that a failure never leaves half of one, nor harms what stood there.

use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Why a file could not be read or written.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// The file is there and the caller did not allow replacing it.
    #[error("{}: already exists; choose another path, or pass --force to replace it", path.display())]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// What stands there is a folder, a device or the like.
    #[error("{}: is not a regular file; choose another path", path.display())]
    NotRegular {
        /// What stands there.
        path: PathBuf,
    },
    /// The operating system refused.
    #[error("{}: {action}: {source}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What was being done, with the remedy where there is a usual one.
        action: &'static str,
        /// The operating system's reason.
        source: io::Error,
    },
}

impl FileError {
    /// Names the file and the action beside the operating system's reason.
    pub fn io(path: &Path, action: &'static str) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Io { path, action, source }
    }
}

/// Whether an existing file may be replaced.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Replace {
    /// Refuse.
    No,
    /// Replace it, in one step.
    Yes,
}

/// Refuses early, before any work is done, when `path` exists and may not be replaced.
///
/// # Errors
/// [`FileError::Exists`].
pub fn may_write(path: &Path, replace: Replace) -> Result<(), FileError> {
    if replace == Replace::No && path.exists() {
        return Err(FileError::Exists { path: path.to_owned() });
    }
    Ok(())
}

/// Creates the folder and its parents.
///
/// # Errors
/// [`FileError::Io`].
pub fn create_folder(path: &Path) -> Result<(), FileError> {
    std::fs::create_dir_all(path).map_err(FileError::io(
        path,
        "cannot create the folder; is a parent read-only or a file?",
    ))
}

/// Writes a file through a temporary one in the same folder that is renamed into place once it is whole and on disk.
///
/// # Errors
/// [`FileError::Exists`] under [`Replace::No`]; [`FileError::Io`] for whatever the system or `write` reports. In both
/// cases what stood at `path` is untouched and the temporary file is gone.
pub fn write_atomically(
    path: &Path,
    replace: Replace,
    write: impl FnOnce(&mut dyn WriteSeek) -> io::Result<()>,
) -> Result<(), FileError> {
    may_write(path, replace)?;
    // A link stays a link: what it names is replaced.
    let target = if path.is_symlink() {
        path.canonicalize()
            .map_err(FileError::io(path, "cannot follow the link"))?
    } else {
        path.to_owned()
    };
    let path = target.as_path();
    if path.exists() && !path.is_file() {
        return Err(FileError::NotRegular { path: path.to_owned() });
    }
    let folder = match path.parent() {
        Some(p) if !p.as_os_str().is_empty() => p,
        _ => Path::new("."),
    };
    create_folder(folder)?;
    let cannot = "cannot write; is the folder read-only or the disk full?";
    let mut temporary = tempfile::Builder::new()
        .prefix(".nmt-")
        .tempfile_in(folder)
        .map_err(FileError::io(path, cannot))?;
    let whole = (|| {
        let mut buffered = BufWriter::new(temporary.as_file_mut());
        write(&mut buffered)?;
        buffered.flush()?;
        drop(buffered);
        #[cfg(unix)]
        {
            // Temporary files are made private; give the result the mode that a plain create would have.
            use std::os::unix::fs::PermissionsExt;
            temporary
                .as_file()
                .set_permissions(std::fs::Permissions::from_mode(default_mode()))?;
        }
        temporary.as_file().sync_all()
    })();
    whole.map_err(FileError::io(path, cannot))?;
    match replace {
        Replace::Yes => temporary.persist(path).map_err(|e| e.error),
        Replace::No => temporary.persist_noclobber(path).map_err(|e| e.error),
    }
    .map(drop)
    .map_err(|source| match source.kind() {
        io::ErrorKind::AlreadyExists => FileError::Exists { path: path.to_owned() },
        _ => FileError::Io {
            path: path.to_owned(),
            action: cannot,
            source,
        },
    })
}

/// What archive writers need: [`io::Write`] and [`io::Seek`].
pub trait WriteSeek: io::Write + io::Seek {}
impl<T: io::Write + io::Seek> WriteSeek for T {}

/// 0o666 less the process's umask.
#[cfg(unix)]
fn default_mode() -> u32 {
    use std::sync::OnceLock;
    static MODE: OnceLock<u32> = OnceLock::new();
    *MODE.get_or_init(|| {
        // The umask can be read without changing it from procfs; elsewhere the common one is assumed.
        let umask = std::fs::read_to_string("/proc/self/status")
            .ok()
            .and_then(|s| {
                s.lines()
                    .find_map(|l| l.strip_prefix("Umask:").map(str::trim).map(str::to_owned))
            })
            .and_then(|s| u32::from_str_radix(&s, 8).ok())
            .unwrap_or(0o022);
        0o666 & !umask
    })
}

/// Reads a whole file.
///
/// # Errors
/// [`FileError::Io`].
pub fn read(path: &Path) -> Result<Vec<u8>, FileError> {
    std::fs::read(path).map_err(FileError::io(path, "cannot read"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_leaves_the_old_file_and_no_other() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        write_atomically(&path, Replace::No, |w| w.write_all(b"old")).unwrap();
        let failed = write_atomically(&path, Replace::Yes, |w| {
            w.write_all(b"half of the ne")?;
            Err(io::Error::other("the disk is full"))
        });
        assert!(failed.unwrap_err().to_string().contains("the disk is full"));
        assert_eq!(std::fs::read(&path).unwrap(), b"old");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
        assert!(matches!(
            write_atomically(&path, Replace::No, |_| Ok(())),
            Err(FileError::Exists { .. })
        ));
        write_atomically(&path, Replace::Yes, |w| w.write_all(b"new")).unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"new");
        assert!(matches!(
            write_atomically(folder.path(), Replace::Yes, |_| Ok(())),
            Err(FileError::NotRegular { .. })
        ));
        #[cfg(unix)]
        {
            let link = folder.path().join("link");
            std::os::unix::fs::symlink(&path, &link).unwrap();
            write_atomically(&link, Replace::Yes, |w| w.write_all(b"through")).unwrap();
            assert!(link.is_symlink() && std::fs::read(&path).unwrap() == b"through");
        }
    }
}
