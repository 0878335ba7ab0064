//! Writing files so that a failure never leaves half of one, nor harms what stood there.

use std::collections::BTreeSet;
use std::fs::{File, TryLockError};
use std::io::{self, BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

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
    /// Another process works at this place.
    #[error("{}: another nmt ({holder}) is writing here; wait for it to end, or choose another place", path.display())]
    Locked {
        /// The lock file.
        path: PathBuf,
        /// What it says of the other process.
        holder: String,
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

/// Files that must not outlive the process: temporary ones, and locks.
static TRANSIENT: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn transient_files() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    TRANSIENT.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A file that is removed at the latest when the process ends in an orderly way, [`remove_transient_files`] included.
#[derive(Debug)]
struct Transient(PathBuf);

impl Transient {
    /// What `make` makes, and that it is known; at no moment is it there and unknown.
    fn new<T, E>(make: impl FnOnce() -> Result<(T, PathBuf), E>) -> Result<(T, Self), E> {
        let mut known = transient_files();
        let (made, path) = make()?;
        known.insert(path.clone());
        Ok((made, Self(path)))
    }
}

impl Drop for Transient {
    fn drop(&mut self) {
        transient_files().remove(&self.0);
    }
}

/// Removes temporary files and locks; for a process that is about to end without returning to those that made them.
/// From here on whoever would make another waits for the end.
pub fn remove_transient_files() {
    let known = transient_files();
    for path in known.iter() {
        // Nothing can be done about one that will not go.
        drop(std::fs::remove_file(path));
    }
    std::mem::forget(known);
}

/// The beginning of a temporary file's name.
const TEMPORARY: &str = ".nmt-";

/// Removes temporary files that processes left which were killed; only where no other process can be writing.
///
/// # Errors
/// [`FileError::Io`] for one that cannot be removed.
pub fn remove_stale_files(folder: &Path) -> Result<(), FileError> {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return Ok(());
    };
    for entry in entries
        .flatten()
        .filter(|e| e.file_name().to_string_lossy().starts_with(TEMPORARY))
    {
        let path = entry.path();
        std::fs::remove_file(&path)
            .map_err(FileError::io(&path, "cannot remove a temporary file of an earlier run"))?;
    }
    Ok(())
}

/// A place that this process alone may write at, for as long as this lives.
///
/// The operating system gives it back when the process ends, however that comes about.
#[derive(Debug)]
pub struct Lock {
    file: File,
    transient: Transient,
}

impl Lock {
    /// Takes the lock file at `path`.
    ///
    /// # Errors
    /// [`FileError::Locked`] where another process has it, [`FileError::Io`] where it cannot be made.
    pub fn acquire(path: &Path) -> Result<Self, FileError> {
        if let Some(folder) = path.parent().filter(|p| !p.as_os_str().is_empty()) {
            create_folder(folder)?;
        }
        let (file, transient) = Transient::new(|| Ok((Self::taken(path)?, path.to_owned())))?;
        Ok(Self { file, transient })
    }

    /// The lock file, made and locked, with the process's number in it.
    fn taken(path: &Path) -> Result<File, FileError> {
        let cannot = "cannot make the lock file; is the folder read-only?";
        loop {
            let mut file = File::options()
                .read(true)
                .write(true)
                .create(true)
                .truncate(false)
                .open(path)
                .map_err(FileError::io(path, cannot))?;
            match file.try_lock() {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => {
                    let mut holder = String::new();
                    drop(file.read_to_string(&mut holder));
                    let holder = if holder.trim().is_empty() {
                        "that has just begun"
                    } else {
                        holder.trim()
                    };
                    return Err(FileError::Locked {
                        path: path.to_owned(),
                        holder: holder.to_owned(),
                    });
                }
                // A file system without locks has none to respect.
                Err(TryLockError::Error(e)) if e.kind() == io::ErrorKind::Unsupported => {}
                Err(TryLockError::Error(e)) => return Err(FileError::io(path, cannot)(e)),
            }
            if !is_at(&file, path) {
                // Its holder removed it meanwhile; the next one is another file.
                continue;
            }
            let written = file
                .set_len(0)
                .and_then(|()| write!(file, "process {}", std::process::id()));
            return written.map_err(FileError::io(path, cannot)).map(|()| file);
        }
    }
}

/// Whether an open file is the one that stands at a path.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    match (file.metadata(), std::fs::metadata(path)) {
        (Ok(a), Ok(b)) => (a.dev(), a.ino()) == (b.dev(), b.ino()),
        _ => false,
    }
}

/// Elsewhere, a file that is open cannot be removed.
#[cfg(not(unix))]
fn is_at(_: &File, _: &Path) -> bool {
    true
}

impl Drop for Lock {
    fn drop(&mut self) {
        // While it is held, so that nobody takes what is about to go.
        drop(std::fs::remove_file(&self.transient.0));
        drop(self.file.unlock());
    }
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
    let (mut temporary, _transient) = Transient::new(|| {
        let made = tempfile::Builder::new().prefix(TEMPORARY).tempfile_in(folder)?;
        let path = made.path().to_owned();
        Ok((made, path))
    })
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

/// Text without the byte order mark that some editors put before UTF-8.
pub fn without_mark(text: &[u8]) -> &[u8] {
    text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text)
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

    /// Within one process locks are of files as opened, so that a second one is refused as another process's would be.
    #[test]
    fn a_place_is_taken_once_and_free_afterwards() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("new/a.lock");
        let lock = Lock::acquire(&path).unwrap();
        let refused = Lock::acquire(&path).unwrap_err().to_string();
        assert!(
            refused.contains(&format!("process {}", std::process::id())),
            "{refused}"
        );
        drop(lock);
        assert!(!path.exists());
        // A process that was killed leaves the file, and nothing holds it.
        std::fs::write(&path, "process 1").unwrap();
        drop(Lock::acquire(&path).unwrap());
        std::fs::write(folder.path().join(".nmt-abc"), "half").unwrap();
        remove_stale_files(folder.path()).unwrap();
        assert!(!folder.path().join(".nmt-abc").exists());
    }

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
