//! NumPy's `.npy` and `.npz` files, read defensively: whatever the bytes say, memory stays bounded by what is really
//! there.

use super::file::{FileError, Replace, write_atomically};
use ndarray::{ArrayD, ArrayView, ArrayViewD, Dimension};
use ndarray_npy::{ViewElement, ViewNpyError, ViewNpyExt, WritableElement, WriteNpyExt};
use std::collections::BTreeMap;
use std::io::{Cursor, Read};
use std::path::{Path, PathBuf};

/// Greatest size of one array that is read \[bytes\].
const LARGEST_ARRAY: u64 = 16 << 30;

/// Why an array could not be read.
#[derive(Debug, thiserror::Error)]
pub enum NpyError {
    /// Reading the bytes failed.
    #[error(transparent)]
    File(#[from] FileError),
    /// Not a zip archive, or a damaged one.
    #[error("{}: not a readable .npz archive ({reason}); is the file truncated, or of another kind?", path.display())]
    NotAnArchive {
        /// The file.
        path: PathBuf,
        /// What the archive reader said.
        reason: String,
    },
    /// An array that must be there is not.
    #[error("{}: there is no array '{name}'; found: {found}", path.display())]
    Missing {
        /// The file.
        path: PathBuf,
        /// The array.
        name: &'static str,
        /// What the archive holds.
        found: String,
    },
    /// The bytes are not a NumPy array, or not of the element type or shape that is needed.
    #[error("{}: {name}: {reason}; expected {expected}", path.display())]
    Array {
        /// The file.
        path: PathBuf,
        /// The array.
        name: String,
        /// What is wrong.
        reason: String,
        /// What would be right.
        expected: String,
    },
}

/// An element type that can be read from and written to a NumPy file.
pub trait Element: ViewElement + WritableElement + Copy + Default + 'static {
    /// NumPy's name of the type.
    const NAME: &'static str;
}
impl Element for f32 {
    const NAME: &'static str = "float32";
}
impl Element for f64 {
    const NAME: &'static str = "float64";
}
impl Element for u32 {
    const NAME: &'static str = "uint32";
}
impl Element for u64 {
    const NAME: &'static str = "uint64";
}
impl Element for i32 {
    const NAME: &'static str = "int32";
}
impl Element for i64 {
    const NAME: &'static str = "int64";
}

/// Whether a header is as long as it says. The reader would take memory for it first and find out afterwards.
fn header_is_whole(bytes: &[u8]) -> bool {
    match bytes {
        // A 16-bit length in version 1 of the format, 32 bits later.
        [_, _, _, _, _, _, 1, _, a, b, rest @ ..] => usize::from(u16::from_le_bytes([*a, *b])) <= rest.len(),
        [_, _, _, _, _, _, _, _, a, b, c, d, rest @ ..] => {
            u64::from(u32::from_le_bytes([*a, *b, *c, *d])) <= rest.len() as u64
        }
        _ => false,
    }
}

/// Decodes the bytes of a `.npy` file, in any memory order; what is wrong otherwise.
fn decode<T: Element>(bytes: &[u8]) -> Result<ArrayD<T>, String> {
    if !header_is_whole(bytes) {
        return Err("the file ends within its header; it is truncated, damaged or of another kind".to_owned());
    }
    match ArrayViewD::<T>::view_npy(bytes) {
        Ok(view) => Ok(view.to_owned()),
        Err(ViewNpyError::MisalignedData) => {
            // Copy to where the element data is aligned; the header's length is the same, so some shift below the
            // alignment fits.
            let mut shifted = vec![0u8; bytes.len() + align_of::<T>()];
            let mut last = ViewNpyError::MisalignedData;
            for shift in 0..align_of::<T>() {
                shifted[shift..shift + bytes.len()].copy_from_slice(bytes);
                match ArrayViewD::<T>::view_npy(&shifted[shift..shift + bytes.len()]) {
                    Ok(view) => return Ok(view.to_owned()),
                    Err(error) => last = error,
                }
            }
            Err(last.to_string())
        }
        Err(error) => Err(error.to_string()),
    }
}

fn array_error<T: Element>(path: &Path, name: &str, reason: String) -> NpyError {
    NpyError::Array {
        path: path.to_owned(),
        name: name.to_owned(),
        reason,
        expected: format!("a whole NumPy array of {}", T::NAME),
    }
}

/// Reads one `.npy` file.
///
/// # Errors
/// [`NpyError`] names the file and what is wrong with it.
pub fn read_npy<T: Element>(path: &Path) -> Result<ArrayD<T>, NpyError> {
    let bytes = super::file::read(path)?;
    decode(&bytes).map_err(|e| array_error::<T>(path, "array", e))
}

/// Writes one `.npy` file.
///
/// # Errors
/// [`FileError`]; nothing half-written is left.
pub fn write_npy<T: Element, D: Dimension>(
    path: &Path,
    replace: Replace,
    array: ArrayView<'_, T, D>,
) -> Result<(), FileError> {
    write_atomically(path, replace, |w| array.write_npy(w).map_err(std::io::Error::other))
}

/// The bytes of a `.npy` file of an array.
pub fn encode<T: Element, D: Dimension>(array: ArrayView<'_, T, D>) -> Vec<u8> {
    let mut bytes = Vec::new();
    array.write_npy(&mut bytes).expect("writing to memory cannot fail");
    bytes
}

/// An open `.npz` archive: its arrays, still encoded.
#[derive(Debug)]
pub struct Npz {
    path: PathBuf,
    entries: BTreeMap<String, Vec<u8>>,
}

impl Npz {
    /// Reads the arrays `names` of an archive, as many of them as it holds.
    ///
    /// # Errors
    /// [`NpyError::NotAnArchive`] for anything but a whole zip archive, [`FileError`] where it cannot be read.
    pub fn read(path: &Path, names: &[&str]) -> Result<Self, NpyError> {
        let bytes = super::file::read(path)?;
        let not = |reason: String| NpyError::NotAnArchive {
            path: path.to_owned(),
            reason,
        };
        let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).map_err(|e| not(e.to_string()))?;
        let mut entries = BTreeMap::new();
        for index in 0..archive.len() {
            let entry = archive.by_index(index).map_err(|e| not(e.to_string()))?;
            let name = entry.name().strip_suffix(".npy").unwrap_or(entry.name()).to_owned();
            if !names.contains(&name.as_str()) {
                // Known by name for the error message; its bytes are of no use.
                entries.entry(name).or_default();
                continue;
            }
            let mut content = Vec::new();
            entry
                .take(LARGEST_ARRAY + 1)
                .read_to_end(&mut content)
                .map_err(|e| not(format!("{name}: {e}")))?;
            if content.len() as u64 > LARGEST_ARRAY {
                return Err(not(format!("{name} is larger than {LARGEST_ARRAY} bytes")));
            }
            entries.insert(name, content);
        }
        Ok(Self {
            path: path.to_owned(),
            entries,
        })
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// An array, or none where the archive does not hold it.
    ///
    /// # Errors
    /// [`NpyError::Array`] where it is there and not of element type `T`.
    pub fn optional<T: Element>(&self, name: &str) -> Result<Option<ArrayD<T>>, NpyError> {
        let Some(bytes) = self.entries.get(name) else {
            return Ok(None);
        };
        decode(bytes)
            .map(Some)
            .map_err(|e| array_error::<T>(&self.path, name, e))
    }

    /// An array that must be there.
    ///
    /// # Errors
    /// [`NpyError::Missing`], or as [`Self::optional`].
    pub fn required<T: Element>(&self, name: &'static str) -> Result<ArrayD<T>, NpyError> {
        self.optional(name)?.ok_or_else(|| NpyError::Missing {
            path: self.path.clone(),
            name,
            found: match self.entries.len() {
                0 => "no array at all".to_owned(),
                _ => self.entries.keys().map(String::as_str).collect::<Vec<_>>().join(", "),
            },
        })
    }

    /// A wrong-shape or wrong-content error about one of its arrays.
    pub fn wrong(&self, name: &str, reason: impl Into<String>, expected: impl Into<String>) -> NpyError {
        NpyError::Array {
            path: self.path.clone(),
            name: name.to_owned(),
            reason: reason.into(),
            expected: expected.into(),
        }
    }
}

/// Writes an `.npz` archive of already encoded arrays ([`encode`]), stored without compression and without time stamps:
/// the same arrays give the same bytes.
///
/// # Errors
/// [`FileError`]; nothing half-written is left.
pub fn write_npz(path: &Path, replace: Replace, arrays: &[(&str, Vec<u8>)]) -> Result<(), FileError> {
    use std::io::Write;
    use zip::write::SimpleFileOptions;
    write_atomically(path, replace, |w| {
        let mut archive = zip::ZipWriter::new(w);
        for (name, bytes) in arrays {
            let options = SimpleFileOptions::default()
                .compression_method(zip::CompressionMethod::Stored)
                .last_modified_time(zip::DateTime::default())
                .large_file(bytes.len() as u64 > u64::from(u32::MAX) / 2);
            archive.start_file(format!("{name}.npy"), options)?;
            archive.write_all(bytes)?;
        }
        archive.finish()?;
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::{arr0, arr1, arr2};

    #[test]
    fn archives_round_trip_and_repeat_to_the_byte() {
        let folder = tempfile::tempdir().unwrap();
        let (a, b) = (folder.path().join("a.npz"), folder.path().join("b.npz"));
        let arrays = [
            ("x", encode(arr1(&[1.5f32, -0.0, f32::MIN_POSITIVE / 2.0]).view())),
            ("s", encode(arr0(7u32).view())),
            ("m", encode(arr2(&[[1u64, 2], [3, 4]]).view())),
        ];
        write_npz(&a, Replace::No, &arrays).unwrap();
        write_npz(&b, Replace::No, &arrays).unwrap();
        assert_eq!(std::fs::read(&a).unwrap(), std::fs::read(&b).unwrap());
        let npz = Npz::read(&a, &["x", "s", "m"]).unwrap();
        let x = npz.required::<f32>("x").unwrap();
        assert_eq!(
            x.iter().map(|v| v.to_bits()).collect::<Vec<_>>(),
            [1.5f32, -0.0, f32::MIN_POSITIVE / 2.0].map(f32::to_bits)
        );
        assert_eq!(npz.required::<u32>("s").unwrap().ndim(), 0);
        assert_eq!(npz.required::<u64>("m").unwrap().shape(), [2, 2]);
        assert!(npz.optional::<f32>("absent").unwrap().is_none());
        assert!(
            npz.required::<f32>("absent")
                .unwrap_err()
                .to_string()
                .contains("found: m, s, x")
        );
        assert!(
            npz.required::<f64>("x")
                .unwrap_err()
                .to_string()
                .contains("expected a whole NumPy array of float64")
        );
    }

    #[test]
    fn every_truncation_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.npz");
        write_npz(&path, Replace::No, &[("x", encode(arr1(&[1.0f32; 50]).view()))]).unwrap();
        let whole = std::fs::read(&path).unwrap();
        for length in 0..whole.len() {
            std::fs::write(&path, &whole[..length]).unwrap();
            let read = Npz::read(&path, &["x"]).and_then(|npz| npz.required::<f32>("x"));
            assert!(read.is_err(), "{length} of {} bytes were read as whole", whole.len());
        }
    }

    /// A header that promises 2^60 elements over 4 bytes of data.
    #[test]
    fn absurd_shapes_allocate_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.npy");
        for shape in [
            "1152921504606846976",
            "18446744073709551615, 18446744073709551615",
            "-1",
        ] {
            let header = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({shape},), }}");
            let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
            bytes.extend(((header.len() + 1) as u16).to_le_bytes());
            bytes.extend(header.as_bytes());
            bytes.extend(b"\n\0\0\0\0");
            std::fs::write(&path, &bytes).unwrap();
            assert!(read_npy::<f32>(&path).is_err(), "{shape}");
        }
    }

    /// A header that promises 4 GiB of itself, in every version of the format. Control: the same with its true length
    /// is read.
    #[test]
    fn absurd_headers_allocate_nothing() {
        let good = encode(arr1(&[1.0f32, 2.0]).view());
        assert!(header_is_whole(&good) && decode::<f32>(&good).is_ok());
        let mut long = good.clone();
        long[8..10].fill(0xff);
        let mut newer = good.clone();
        newer[6] = 3;
        for bytes in [&long[..], &newer[..], &good[..9], &good[..8], &good[..0], &good[..40]] {
            assert!(!header_is_whole(bytes) && decode::<f32>(bytes).unwrap_err().contains("within its header"));
        }
    }
}
