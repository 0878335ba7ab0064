//! Exports: the network as shader source, as ONNX and as JSON.
//!
//! Every shader export is one self-contained include file: feature functions, `nmt_transmittance`, and a header comment
//! that says what to feed it, where it comes from and how accurate it is. Weights stand in constant arrays that are
//! read by literal indices only; a run-time index makes shader compilers copy the array at each access. WGSL, GLSL and
//! HLSL are written here; naga makes MSL and SPIR-V of the WGSL.

pub mod calls;
pub mod core;
pub mod dialect;
pub mod files;
pub mod format;
pub mod onnx;
pub mod prefix;
pub mod protobuf;
pub mod recentred;
pub mod shader;
pub mod target;
pub mod translate;

pub use dialect::Target;
pub use format::{Form, Format, FormatError, Precision};
pub use prefix::Prefix;

use crate::model::Mlp;
use crate::numeric::file::{FileError, Replace, create_folder, may_write, write_atomically};
use std::path::{Path, PathBuf};

/// Why an export could not be made.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// A file could not be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// The network does not fit into f16.
    #[error("network '{network}' in f16: {reason}")]
    Half {
        /// The network.
        network: String,
        /// Why not.
        reason: String,
    },
    /// naga does not translate the source; a fault of this program.
    #[error("naga makes no {language} of the WGSL: {reason}")]
    Translate {
        /// What was to be made.
        language: &'static str,
        /// naga's words.
        reason: String,
    },
}

/// The bytes of an export.
///
/// # Errors
/// [`ExportError::Half`] where the network does not fit into f16.
pub fn encode(mlp: &Mlp, format: Format) -> Result<Vec<u8>, ExportError> {
    encode_as(mlp, format, None)
}

/// The bytes of an export whose functions, constants and types have a prefix of their own. SPIR-V, ONNX and JSON have
/// no such names.
///
/// # Errors
/// As [`encode`].
pub fn encode_as(mlp: &Mlp, format: Format, prefix: Option<&Prefix>) -> Result<Vec<u8>, ExportError> {
    (format.target().description().write)(mlp, format, prefix)
}

/// Refuses early, before any export is made, where one of these formats is there and may not be replaced.
///
/// # Errors
/// [`FileError::Exists`].
pub fn may_write_to(mlp: &Mlp, folder: &Path, formats: &[Format], replace: Replace) -> Result<(), FileError> {
    formats
        .iter()
        .try_for_each(|f| may_write(&f.path(folder, mlp), replace))
}

/// Writes exports of a network into a folder and returns their paths: one a format, then of a network with a core the
/// files of both passes ([`core::chain`]), one a language among the formats.
///
/// # Errors
/// [`FileError::Exists`] before anything is written where one of them is there and may not be replaced, and whatever
/// [`encode`] refuses; otherwise [`FileError`] with no file half-written.
pub fn write(
    mlp: &Mlp,
    folder: &Path,
    formats: &[Format],
    prefix: Option<&Prefix>,
    replace: Replace,
) -> Result<Vec<PathBuf>, ExportError> {
    may_write_to(mlp, folder, formats, replace)?;
    let mut paths: Vec<_> = formats.iter().map(|f| f.path(folder, mlp)).collect();
    let mut encoded = formats
        .iter()
        .map(|&format| encode_as(mlp, format, prefix))
        .collect::<Result<Vec<_>, _>>()?;
    for file in core::chain_files(mlp, &core::chain_languages(formats), prefix)? {
        paths.push(folder.join(file.path));
        encoded.push(file.text.into_bytes());
    }
    paths.iter().try_for_each(|path| may_write(path, replace))?;
    create_folder(folder)?;
    for (bytes, path) in encoded.iter().zip(&paths) {
        write_atomically(path, replace, |w| w.write_all(bytes))?;
    }
    Ok(paths)
}
