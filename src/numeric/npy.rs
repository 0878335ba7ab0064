//! NumPy's `.npy` and `.npz` files, read defensively: whatever the bytes say, memory stays bounded by what is really
//! there.

use super::file::{FileError, Replace, write_atomically};
use ndarray::{ArrayD, ArrayView, Dimension, ShapeBuilder};
use std::collections::BTreeMap;
use std::io::{Cursor, Read, Write};
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
pub trait Element: bytemuck::Pod + Default {
    /// NumPy's name of the type.
    const NAME: &'static str;
    /// What headers write of it behind the sign of the byte order: `f4` for example.
    const KIND: &'static str;

    /// The elements of little-endian bytes, as many as there are whole ones.
    fn read(bytes: &[u8]) -> Vec<Self>;

    /// One element's bytes, the lowest first.
    fn write(self, w: &mut dyn Write) -> std::io::Result<()>;
}

macro_rules! elements {
    ($($kind:ident is $name:literal, $code:literal;)*) => {$(
        impl Element for $kind {
            const NAME: &'static str = $name;
            const KIND: &'static str = $code;

            fn read(bytes: &[u8]) -> Vec<Self> {
                bytes.as_chunks().0.iter().map(|b| Self::from_le_bytes(*b)).collect()
            }

            fn write(self, w: &mut dyn Write) -> std::io::Result<()> {
                w.write_all(&self.to_le_bytes())
            }
        }
    )*};
}
elements! {
    f32 is "float32", "f4";
    f64 is "float64", "f8";
    u8 is "uint8", "u1";
    u16 is "uint16", "u2";
    u32 is "uint32", "u4";
    u64 is "uint64", "u8";
    i8 is "int8", "i1";
    i16 is "int16", "i2";
    i32 is "int32", "i4";
    i64 is "int64", "i8";
}

/// What every file begins with.
const MAGIC: &[u8] = b"\x93NUMPY";

/// The elements begin at a multiple of this \[bytes\].
///
/// # Source
/// NumPy's description of the format (`numpy.lib.format`), which asks for it so that a file can be mapped into memory.
const ALIGNMENT: usize = 64;

/// What a `.npy` file says before its elements.
#[derive(Debug, Clone, PartialEq)]
struct Header {
    /// The type of the elements, `<f4` for example.
    kind: String,
    /// Whether the first index runs fastest.
    fortran_order: bool,
    /// The array's shape.
    shape: Vec<usize>,
    /// Bytes in front of the elements.
    length: usize,
}

/// The literals of Python that stand in a header, taken off the front of a text.
struct Literals<'a>(&'a str);

impl<'a> Literals<'a> {
    /// Whether the next is this sign or word, which is then taken.
    fn take(&mut self, word: &str) -> bool {
        self.0 = self.0.trim_start();
        match self.0.strip_prefix(word) {
            Some(rest) => self.0 = rest,
            None => return false,
        }
        true
    }

    /// A string without escapes.
    fn text(&mut self) -> Option<&'a str> {
        let quote = ["'", "\""].into_iter().find(|quote| self.take(quote))?;
        let (text, rest) = self.0.split_once(quote)?;
        self.0 = rest;
        Some(text)
    }

    fn truth(&mut self) -> Option<bool> {
        match self.take("True") {
            true => Some(true),
            false => self.take("False").then_some(false),
        }
    }

    /// A tuple of sizes; Python 2 wrote `3L`.
    fn sizes(&mut self) -> Option<Vec<usize>> {
        let mut sizes = Vec::new();
        if !self.take("(") {
            return None;
        }
        while !self.take(")") {
            let digits = self.0.bytes().take_while(u8::is_ascii_digit).count();
            sizes.push(self.0[..digits].parse().ok()?);
            self.0 = &self.0[digits..];
            self.take("L");
            if !self.take(",") {
                return self.take(")").then_some(sizes);
            }
        }
        Some(sizes)
    }
}

impl Header {
    /// Reads the header of a file; what is wrong with it otherwise.
    fn read(bytes: &[u8]) -> Result<Self, String> {
        if bytes.len() >= MAGIC.len() && !bytes.starts_with(MAGIC) {
            return Err("it does not begin as a NumPy array does".to_owned());
        }
        if !header_is_whole(bytes) {
            return Err("the file ends within its header; it is truncated, damaged or of another kind".to_owned());
        }
        // A 16-bit length in version 1 of the format, 32 bits in 2 and 3.
        let (start, said) = match (bytes[6], bytes[7]) {
            (1, 0) => (10, u32::from(u16::from_le_bytes([bytes[8], bytes[9]]))),
            (2 | 3, 0) => (12, u32::from_le_bytes([bytes[8], bytes[9], bytes[10], bytes[11]])),
            (major, minor) => return Err(format!("version {major}.{minor} of the format is not known")),
        };
        let length = start + said as usize;
        let text = std::str::from_utf8(&bytes[start..length]).map_err(|_| "its header is not text".to_owned())?;
        let (kind, fortran_order, shape) = Self::dictionary(text)?;
        Ok(Self {
            kind,
            fortran_order,
            shape,
            length,
        })
    }

    /// The three entries of a header's dictionary, in any order.
    fn dictionary(text: &str) -> Result<(String, bool, Vec<usize>), String> {
        let damaged = || format!("its header is not what NumPy writes: {:.100}", text.trim());
        let (mut kind, mut order, mut shape) = (None, None, None);
        let mut rest = Literals(text);
        if !rest.take("{") {
            return Err(damaged());
        }
        while !rest.take("}") {
            let key = rest.text().ok_or_else(damaged)?;
            if !rest.take(":") {
                return Err(damaged());
            }
            match key {
                "descr" if rest.take("[") || rest.take("(") => {
                    return Err("its elements consist of several fields".to_owned());
                }
                "descr" => kind = Some(rest.text().ok_or_else(damaged)?.replace('=', "<")),
                "fortran_order" => order = Some(rest.truth().ok_or_else(damaged)?),
                "shape" => shape = Some(rest.sizes().ok_or_else(damaged)?),
                _ => return Err(damaged()),
            }
            if !rest.take(",") && !rest.0.trim_start().starts_with('}') {
                return Err(damaged());
            }
        }
        match (kind, order, shape, rest.0.trim()) {
            (Some(kind), Some(order), Some(shape), "") => Ok((kind, order, shape)),
            _ => Err(damaged()),
        }
    }

    /// Whether the elements are of this type, with the lowest byte first.
    fn holds<T: Element>(&self) -> bool {
        self.kind == format!("<{}", T::KIND) || size_of::<T>() == 1 && self.kind == format!("|{}", T::KIND)
    }

    /// The bytes of a header of this type and shape.
    fn bytes<T: Element>(fortran_order: bool, shape: &[usize]) -> Vec<u8> {
        let byte_order = if size_of::<T>() == 1 { '|' } else { '<' };
        let order = if fortran_order { "True" } else { "False" };
        let sizes = match shape {
            [size] => format!("{size},"),
            sizes => sizes.iter().map(usize::to_string).collect::<Vec<_>>().join(", "),
        };
        let text = format!(
            "{{'descr': '{byte_order}{}', 'fortran_order': {order}, 'shape': ({sizes})}}",
            T::KIND
        );
        // At least one space, and a new line at the end. ndarray's arrays have few enough dimensions for version 1.
        let used = MAGIC.len() + 4 + text.len() + 1;
        let spaces = ALIGNMENT - used % ALIGNMENT;
        let mut bytes = MAGIC.to_vec();
        bytes.extend([1, 0]);
        bytes.extend(((text.len() + spaces + 1) as u16).to_le_bytes());
        bytes.extend(text.bytes());
        bytes.resize(bytes.len() + spaces, b' ');
        bytes.push(b'\n');
        bytes
    }
}

/// The type of a file's elements as its header writes it, `<f4` for example; none where no header can be read.
fn kind(bytes: &[u8]) -> Option<String> {
    Some(Header::read(bytes).ok()?.kind)
}

/// NumPy's name of a type that a header writes as `<f4`; what it writes where that is not known.
fn name_of(kind: &str) -> String {
    let name = match kind.trim_start_matches(['<', '>', '|']) {
        "f2" => "float16",
        "f4" => "float32",
        "f8" => "float64",
        "u1" => "uint8",
        "u2" => "uint16",
        "u4" => "uint32",
        "u8" => "uint64",
        "i1" => "int8",
        "i2" => "int16",
        "i4" => "int32",
        "i8" => "int64",
        "b1" => "bool",
        _ => return format!("of type {kind}"),
    };
    if kind.starts_with('>') {
        format!("big-endian {name}")
    } else {
        name.to_owned()
    }
}

/// What is wrong with an array's type, and how to write it in another.
fn other_type<T: Element>(array: &str, bytes: &[u8]) -> Option<String> {
    let kind = kind(bytes)?;
    let name = name_of(&kind);
    if name == T::NAME {
        return None;
    }
    let bytes_of_color = array == "color" && matches!(kind.as_str(), "|u1" | "<u2" | ">u2");
    let convert = match T::NAME {
        "float32" if kind.starts_with('>') => ".astype('<f4')".to_owned(),
        name => format!(".astype(np.{name})"),
    };
    Some(match bytes_of_color {
        true => format!(
            "it is {name}; divide it by {}, make it linear and write {convert}",
            if kind == "|u1" { 255 } else { 65535 }
        ),
        false => format!("it is {name}; write {convert}"),
    })
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
    let header = Header::read(bytes)?;
    if !header.holds::<T>() {
        return Err(format!("its elements are {}", name_of(&header.kind)));
    }
    let data = &bytes[header.length..];
    // ndarray counts in isize, and leaves sizes of zero out.
    let sizes = header.shape.iter().filter(|&&size| size > 0);
    let whole = sizes
        .map(|&size| size as u64)
        .try_fold(size_of::<T>() as u64, u64::checked_mul);
    if whole.is_none_or(|bytes| isize::try_from(bytes).is_err()) {
        return Err(format!(
            "its header promises an array of {:?}, which no memory holds",
            header.shape
        ));
    }
    let expected = header.shape.iter().product::<usize>() * size_of::<T>();
    if data.len() != expected {
        return Err(format!(
            "its header promises {expected} bytes of elements, and there are {}; it is truncated or damaged",
            data.len()
        ));
    }
    ArrayD::from_shape_vec(header.shape.set_f(header.fortran_order), T::read(data)).map_err(|e| e.to_string())
}

/// Writes an array as the bytes of a `.npy` file.
fn write_array<T: Element, D: Dimension>(array: &ArrayView<'_, T, D>, w: &mut dyn Write) -> std::io::Result<()> {
    let standard = array.is_standard_layout();
    let fortran_order = !standard && array.view().reversed_axes().is_standard_layout();
    w.write_all(&Header::bytes::<T>(fortran_order, array.shape()))?;
    match array.as_slice_memory_order() {
        Some(values) if (standard || fortran_order) && cfg!(target_endian = "little") => {
            w.write_all(bytemuck::cast_slice(values))
        }
        _ if fortran_order => array.view().reversed_axes().iter().try_for_each(|v| v.write(w)),
        _ => array.iter().try_for_each(|v| v.write(w)),
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
    decode(&bytes).map_err(|e| array_error::<T>(path, "array", other_type::<T>("array", &bytes).unwrap_or(e)))
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
    write_atomically(path, replace, |w| write_array(&array, w))
}

/// The bytes of a `.npy` file of an array.
pub fn encode<T: Element, D: Dimension>(array: ArrayView<'_, T, D>) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_array(&array, &mut bytes).expect("writing to memory cannot fail");
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
            .map_err(|e| array_error::<T>(&self.path, name, other_type::<T>(name, bytes).unwrap_or(e)))
    }

    /// The type of an array's elements as its header writes it, `<f4` for example; none where the array is not there.
    pub fn kind(&self, name: &str) -> Option<String> {
        Some(kind(self.entries.get(name)?).unwrap_or_default())
    }

    /// Names of all arrays.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.entries.keys().map(String::as_str)
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

/// An array on its way into an archive.
pub enum Entry<'a> {
    /// The bytes of a `.npy` file, see [`encode`].
    Encoded(Vec<u8>),
    /// What writes them, so that they need not be in memory.
    Streamed {
        /// About how many they are; archives are told beforehand of files beyond 2 GiB.
        bytes: u64,
        /// Writes them.
        #[expect(clippy::type_complexity)]
        write: Box<dyn Fn(&mut dyn Write) -> std::io::Result<()> + 'a>,
    },
}

impl<'a> Entry<'a> {
    /// An array that is encoded as it is written.
    pub fn streamed<T: Element, D: Dimension + 'a>(array: ArrayView<'a, T, D>) -> Self {
        Self::Streamed {
            bytes: (array.len() * size_of::<T>()) as u64 + 128,
            write: Box::new(move |w| write_array(&array, w)),
        }
    }

    fn bytes(&self) -> u64 {
        match self {
            Self::Encoded(bytes) => bytes.len() as u64,
            Self::Streamed { bytes, .. } => *bytes,
        }
    }

    fn write(&self, w: &mut dyn Write) -> std::io::Result<()> {
        match self {
            Self::Encoded(bytes) => w.write_all(bytes),
            Self::Streamed { write, .. } => write(w),
        }
    }
}

/// Writes an `.npz` archive of already encoded arrays ([`encode`]), stored without compression and without time stamps:
/// the same arrays give the same bytes.
///
/// # Errors
/// [`FileError`]; nothing half-written is left.
pub fn write_npz(path: &Path, replace: Replace, arrays: &[(&str, Vec<u8>)]) -> Result<(), FileError> {
    let entries = arrays
        .iter()
        .map(|(name, bytes)| (*name, Entry::Encoded(bytes.clone())));
    write_npz_of(path, replace, &entries.collect::<Vec<_>>())
}

/// As [`write_npz`], of arrays that need not be encoded before.
///
/// # Errors
/// [`FileError`]; nothing half-written is left.
pub fn write_npz_of(path: &Path, replace: Replace, arrays: &[(&str, Entry<'_>)]) -> Result<(), FileError> {
    use zip::write::SimpleFileOptions;
    write_atomically(path, replace, |w| {
        let mut archive = zip::ZipWriter::new(w);
        for (name, entry) in arrays {
            let options = SimpleFileOptions::default()
                .compression_method(zip::CompressionMethod::Stored)
                .last_modified_time(zip::DateTime::default())
                .large_file(entry.bytes() > u64::from(u32::MAX) / 2);
            let started = archive
                .start_file(format!("{name}.npy"), options)
                .map_err(std::io::Error::from);
            if let Err(error) = started.and_then(|()| entry.write(&mut archive)) {
                // Dropped, an archive would try to finish itself and report that this fails too.
                std::mem::forget(archive);
                return Err(error);
            }
        }
        archive.finish().map(drop).map_err(std::io::Error::from)
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

    #[test]
    fn other_types_are_named_with_their_remedy() {
        let doubles = encode(arr1(&[1.0f64]).view());
        let big = doubles
            .iter()
            .map(|&b| if b == b'<' { b'>' } else { b })
            .collect::<Vec<_>>();
        assert_eq!(
            other_type::<f32>("alpha", &doubles).unwrap(),
            "it is float64; write .astype(np.float32)"
        );
        assert_eq!(
            other_type::<f32>("alpha", &big).unwrap(),
            "it is big-endian float64; write .astype('<f4')"
        );
        assert_eq!(other_type::<f64>("alpha", &doubles), None);
        let bytes = encode(arr1(&[1u8]).view());
        assert!(other_type::<f32>("color", &bytes).unwrap().contains("divide it by 255"));
        assert!(kind(&doubles[..12]).is_none() && kind(b"").is_none());
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
        // The type of the elements is not looked for in a header that is not whole.
        assert!(kind(&good).is_some() && kind(&long).is_none());
        for bytes in [&long[..], &newer[..], &good[..9], &good[..8], &good[..0], &good[..40]] {
            assert!(!header_is_whole(bytes) && decode::<f32>(bytes).unwrap_err().contains("within its header"));
        }
    }
    /// The bytes that NumPy 2.2's `numpy.save` and the reference describe, but for a comma that NumPy writes after the
    /// last entry.
    #[test]
    fn headers_as_they_are_written() {
        let bytes = encode(arr1(&[1.0f32, 2.0]).view());
        let mut expected = b"\x93NUMPY\x01\x00\x76\x00{'descr': '<f4', 'fortran_order': False, 'shape': (2,)}".to_vec();
        expected.resize(127, b' ');
        expected.push(b'\n');
        expected.extend([0, 0, 0x80, 0x3f, 0, 0, 0, 0x40]);
        assert_eq!(bytes, expected);
        for (bytes, text) in [
            (
                encode(arr0(7u8).view()),
                "{'descr': '|u1', 'fortran_order': False, 'shape': ()}",
            ),
            (
                encode(arr2(&[[1i64, 2, 3]]).view()),
                "{'descr': '<i8', 'fortran_order': False, 'shape': (1, 3)}",
            ),
            (
                encode(arr2(&[[1u16, 2, 3], [4, 5, 6]]).t()),
                "{'descr': '<u2', 'fortran_order': True, 'shape': (3, 2)}",
            ),
        ] {
            assert!(bytes[10..].starts_with(text.as_bytes()), "{text}");
            assert_eq!(bytes[8], 0x76, "{text}");
        }
    }

    /// Every memory order comes back with the same elements at the same places.
    #[test]
    fn memory_orders_come_back() {
        let a = arr2(&[[1.0f64, 2.0, 3.0], [4.0, 5.0, 6.0]]);
        assert_eq!(decode::<f64>(&encode(a.view())).unwrap(), a.clone().into_dyn());
        assert_eq!(decode::<f64>(&encode(a.t())).unwrap(), a.t().to_owned().into_dyn());
        let every_second = a.slice(ndarray::s![.., ..;2]);
        assert_eq!(
            decode::<f64>(&encode(every_second)).unwrap(),
            arr2(&[[1.0f64, 3.0], [4.0, 6.0]]).into_dyn()
        );
        let none = ndarray::Array2::<f64>::zeros((0, 3));
        assert_eq!(decode::<f64>(&encode(none.view())).unwrap().shape(), [0, 3]);
    }

    /// Headers by other hands: of NumPy, Python 2, other orders and versions; and what they may not say.
    #[test]
    fn headers_of_other_programs() {
        let file = |version: u8, text: &str| {
            let mut bytes = MAGIC.to_vec();
            bytes.extend([version, 0]);
            match version {
                1 => bytes.extend((text.len() as u16).to_le_bytes()),
                _ => bytes.extend((text.len() as u32).to_le_bytes()),
            }
            bytes.extend(text.bytes());
            bytes.extend([1u16, 2, 3, 4].iter().flat_map(|v| v.to_le_bytes()));
            bytes
        };
        for (version, text) in [
            (1, "{'descr': '<u2', 'fortran_order': False, 'shape': (2, 2), }   \n"),
            (2, "{'shape': (2L, 2L), 'fortran_order': False, 'descr': '=u2'}\n"),
            (3, "{\"descr\":\"<u2\",\"fortran_order\":False,\"shape\":(2,2,)}"),
        ] {
            let read = decode::<u16>(&file(version, text)).unwrap();
            assert_eq!(read, arr2(&[[1u16, 2], [3, 4]]).into_dyn(), "{text}");
        }
        for (version, text, reason) in [
            (
                4,
                "{'descr': '<u2', 'fortran_order': False, 'shape': (4,)}",
                "version 4.0",
            ),
            (
                1,
                "{'descr': '<u2', 'fortran_order': False, 'shape': (5,)}",
                "promises 10 bytes",
            ),
            (
                1,
                "{'descr': '<u2', 'fortran_order': False, 'shape': (3,)}",
                "there are 8",
            ),
            (1, "{'descr': '<u2', 'fortran_order': False}", "not what NumPy writes"),
            (
                1,
                "{'descr': '<u2', 'fortran_order': 0, 'shape': (4,)}",
                "not what NumPy writes",
            ),
            (
                1,
                "{'descr': '<u2', 'fortran_order': False, 'shape': 4}",
                "not what NumPy writes",
            ),
            (
                1,
                "{'descr': '<u2' 'fortran_order': False, 'shape': (4,)}",
                "not what NumPy writes",
            ),
            (
                1,
                "{'descr': '<u2', 'fortran_order': False, 'shape': (4,)} 1",
                "not what NumPy writes",
            ),
            (1, "['descr', '<u2']", "not what NumPy writes"),
            (
                1,
                "{'descr': [('x', '<u2')], 'fortran_order': False, 'shape': (4,)}",
                "several fields",
            ),
            (1, "{'descr': '<i2', 'fortran_order': False, 'shape': (4,)}", "int16"),
        ] {
            let error = decode::<u16>(&file(version, text)).unwrap_err();
            assert!(error.contains(reason), "{text}: {error}");
        }
        assert!(
            decode::<u16>(b"PK\x03\x04 and so on, which is an archive")
                .unwrap_err()
                .contains("begin")
        );
    }
}
