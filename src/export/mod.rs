//! Exports: the network as shader source, as ONNX and as JSON.
//!
//! Every shader export is one self-contained include file: feature functions, `nmt_transmittance`, and a header comment that says what to feed
//! it, where it comes from and how accurate it is. Weights stand in constant arrays that are read by literal indices only; a run-time index makes
//! shader compilers copy the array at each access.

pub mod onnx;
mod recentred;
pub mod shader;

use crate::model::{Mlp, file};
use crate::numeric::file::{FileError, Replace, create_folder, may_write, write_atomically};
use std::path::{Path, PathBuf};

/// A form in which a network leaves the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Format {
    /// WGSL, unrolled scalars.
    Wgsl,
    /// WGSL, `vec4` and `mat4x4` constants.
    WgslPacked,
    /// GLSL, unrolled scalars.
    Glsl,
    /// GLSL, `vec4` and `mat4` constants.
    GlslPacked,
    /// The model file.
    Json,
    /// ONNX.
    Onnx,
}

impl Format {
    /// Every form.
    pub const ALL: [Self; 6] = [Self::Wgsl, Self::WgslPacked, Self::Glsl, Self::GlslPacked, Self::Json, Self::Onnx];

    /// Its name on the command line and in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Wgsl => "wgsl",
            Self::WgslPacked => "wgsl-packed",
            Self::Glsl => "glsl",
            Self::GlslPacked => "glsl-packed",
            Self::Json => "json",
            Self::Onnx => "onnx",
        }
    }

    /// What follows the name of the network in the name of its file.
    pub fn suffix(self) -> &'static str {
        match self {
            Self::Wgsl => ".wgsl",
            Self::WgslPacked => ".packed.wgsl",
            Self::Glsl => ".glsl",
            Self::GlslPacked => ".packed.glsl",
            Self::Json => ".json",
            Self::Onnx => ".onnx",
        }
    }

    /// Where the export of a network stands in a folder.
    pub fn path(self, folder: &Path, mlp: &Mlp) -> PathBuf {
        folder.join(format!("{}{}", mlp.name(), self.suffix()))
    }
}

/// The bytes of an export.
pub fn encode(mlp: &Mlp, format: Format) -> Vec<u8> {
    match format {
        Format::Wgsl => shader::source(mlp, shader::Language::Wgsl, shader::Form::Plain).into_bytes(),
        Format::WgslPacked => shader::source(mlp, shader::Language::Wgsl, shader::Form::Packed).into_bytes(),
        Format::Glsl => shader::source(mlp, shader::Language::Glsl, shader::Form::Plain).into_bytes(),
        Format::GlslPacked => shader::source(mlp, shader::Language::Glsl, shader::Form::Packed).into_bytes(),
        Format::Json => file::to_json(mlp).into_bytes(),
        Format::Onnx => onnx::encode(mlp),
    }
}

/// Writes exports of a network into a folder and returns their paths.
///
/// # Errors
/// [`FileError::Exists`] before anything is written where one of them is there and may not be replaced; otherwise [`FileError`] with no file half-written.
pub fn write(mlp: &Mlp, folder: &Path, formats: &[Format], replace: Replace) -> Result<Vec<PathBuf>, FileError> {
    let paths: Vec<_> = formats.iter().map(|f| f.path(folder, mlp)).collect();
    paths.iter().try_for_each(|path| may_write(path, replace))?;
    create_folder(folder)?;
    for (format, path) in formats.iter().zip(&paths) {
        write_atomically(path, replace, |w| w.write_all(&encode(mlp, *format)))?;
    }
    Ok(paths)
}
