//! Exports: the network as shader source, as ONNX and as JSON.
//!
//! Every shader export is one self-contained include file: feature functions, `nmt_transmittance`, and a header comment that says what to feed
//! it, where it comes from and how accurate it is. Weights stand in constant arrays that are read by literal indices only; a run-time index makes
//! shader compilers copy the array at each access. WGSL, GLSL and HLSL are written here; naga makes MSL and SPIR-V of the WGSL.

pub mod core;
pub mod dialect;
pub mod onnx;
pub mod recentred;
pub mod shader;
pub mod translate;

use crate::model::{Mlp, file};
use crate::numeric::file::{FileError, Replace, create_folder, may_write, write_atomically};
use shader::{Form, Kind, Language, Precision};
use std::path::{Path, PathBuf};

/// A form in which a network leaves the program. Where a language has two, the plain name is that of the faster: weights as `vec4` and `mat4x4` constants.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Format {
    /// WGSL, packed.
    Wgsl,
    /// WGSL, unrolled scalars.
    WgslPlain,
    /// GLSL, packed.
    Glsl,
    /// GLSL, unrolled scalars.
    GlslPlain,
    /// HLSL, packed.
    Hlsl,
    /// HLSL, unrolled scalars.
    HlslPlain,
    /// Metal's language, packed, through naga.
    Metal,
    /// SPIR-V, packed, through naga: a module with compute shaders.
    Spirv,
    /// WGSL, packed, hidden layers in f16.
    WgslF16,
    /// WGSL, unrolled scalars, hidden layers in f16.
    WgslPlainF16,
    /// HLSL, packed, hidden layers in f16.
    HlslF16,
    /// HLSL, unrolled scalars, hidden layers in f16.
    HlslPlainF16,
    /// Metal's language, packed, hidden layers in f16.
    MetalF16,
    /// SPIR-V, packed, hidden layers in f16.
    SpirvF16,
    /// The model file.
    Json,
    /// ONNX.
    Onnx,
}

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
    /// The language has no f16 form.
    #[error(
        "{0} is not offered in f16: no compiler that could execute it here reads it; wgsl, hlsl, metal and spirv are"
    )]
    NoHalf(&'static str),
    /// naga does not translate the source; a fault of this program.
    #[error("naga makes no {language} of the WGSL: {reason}")]
    Translate {
        /// What was to be made.
        language: &'static str,
        /// naga's words.
        reason: String,
    },
}

impl Format {
    /// Every form.
    pub const ALL: [Self; 16] = [
        Self::Wgsl,
        Self::WgslPlain,
        Self::Glsl,
        Self::GlslPlain,
        Self::Hlsl,
        Self::HlslPlain,
        Self::Metal,
        Self::Spirv,
        Self::WgslF16,
        Self::WgslPlainF16,
        Self::HlslF16,
        Self::HlslPlainF16,
        Self::MetalF16,
        Self::SpirvF16,
        Self::Json,
        Self::Onnx,
    ];

    /// What is exported where nothing else is asked for: the faster form of every language, in f32.
    pub const DEFAULT: [Self; 7] = [
        Self::Wgsl,
        Self::Glsl,
        Self::Hlsl,
        Self::Metal,
        Self::Spirv,
        Self::Json,
        Self::Onnx,
    ];

    /// Its name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Wgsl => "wgsl",
            Self::WgslPlain => "wgsl-plain",
            Self::Glsl => "glsl",
            Self::GlslPlain => "glsl-plain",
            Self::Hlsl => "hlsl",
            Self::HlslPlain => "hlsl-plain",
            Self::Metal => "metal",
            Self::Spirv => "spirv",
            Self::WgslF16 => "wgsl-f16",
            Self::WgslPlainF16 => "wgsl-plain-f16",
            Self::HlslF16 => "hlsl-f16",
            Self::HlslPlainF16 => "hlsl-plain-f16",
            Self::MetalF16 => "metal-f16",
            Self::SpirvF16 => "spirv-f16",
            Self::Json => "json",
            Self::Onnx => "onnx",
        }
    }

    /// What follows the name of the network in the name of its file.
    pub fn suffix(self) -> &'static str {
        match self {
            Self::Wgsl => ".wgsl",
            Self::WgslPlain => ".plain.wgsl",
            Self::Glsl => ".glsl",
            Self::GlslPlain => ".plain.glsl",
            Self::Hlsl => ".hlsl",
            Self::HlslPlain => ".plain.hlsl",
            Self::Metal => ".metal",
            Self::Spirv => ".spv",
            Self::WgslF16 => ".f16.wgsl",
            Self::WgslPlainF16 => ".plain.f16.wgsl",
            Self::HlslF16 => ".f16.hlsl",
            Self::HlslPlainF16 => ".plain.f16.hlsl",
            Self::MetalF16 => ".f16.metal",
            Self::SpirvF16 => ".f16.spv",
            Self::Json => ".json",
            Self::Onnx => ".onnx",
        }
    }

    /// The source that it is, or that it is made of; none for what is no shader.
    pub fn kind(self) -> Option<Kind> {
        let (language, form, precision) = match self {
            Self::Wgsl | Self::Metal | Self::Spirv => (Language::Wgsl, Form::Packed, Precision::F32),
            Self::WgslPlain => (Language::Wgsl, Form::Plain, Precision::F32),
            Self::Glsl => (Language::Glsl, Form::Packed, Precision::F32),
            Self::GlslPlain => (Language::Glsl, Form::Plain, Precision::F32),
            Self::Hlsl => (Language::Hlsl, Form::Packed, Precision::F32),
            Self::HlslPlain => (Language::Hlsl, Form::Plain, Precision::F32),
            Self::WgslF16 | Self::MetalF16 | Self::SpirvF16 => (Language::Wgsl, Form::Packed, Precision::F16),
            Self::WgslPlainF16 => (Language::Wgsl, Form::Plain, Precision::F16),
            Self::HlslF16 => (Language::Hlsl, Form::Packed, Precision::F16),
            Self::HlslPlainF16 => (Language::Hlsl, Form::Plain, Precision::F16),
            Self::Json | Self::Onnx => return None,
        };
        Some(Kind {
            language,
            form,
            precision,
        })
    }

    /// The same in another precision; none where there is no such form.
    pub fn with_precision(self, precision: Precision) -> Option<Self> {
        let pairs = [
            (Self::Wgsl, Self::WgslF16),
            (Self::WgslPlain, Self::WgslPlainF16),
            (Self::Hlsl, Self::HlslF16),
            (Self::HlslPlain, Self::HlslPlainF16),
            (Self::Metal, Self::MetalF16),
            (Self::Spirv, Self::SpirvF16),
        ];
        match precision {
            Precision::F32 => Some(pairs.into_iter().find(|p| p.1 == self).map_or(self, |p| p.0)),
            Precision::F16 => pairs.into_iter().find(|p| p.0 == self || p.1 == self).map(|p| p.1),
        }
    }

    /// Where the export of a network stands in a folder.
    pub fn path(self, folder: &Path, mlp: &Mlp) -> PathBuf {
        folder.join(format!("{}{}", mlp.name(), self.suffix()))
    }
}

/// The bytes of an export.
///
/// # Errors
/// [`ExportError::Half`] where the network does not fit into f16.
pub fn encode(mlp: &Mlp, format: Format) -> Result<Vec<u8>, ExportError> {
    Ok(match (format, format.kind()) {
        (Format::Metal | Format::MetalF16, Some(kind)) => translate::metal(mlp, kind)?.into_bytes(),
        (Format::Spirv | Format::SpirvF16, Some(kind)) => translate::spirv(mlp, kind)?,
        (_, Some(kind)) => shader::source(mlp, kind)?.into_bytes(),
        (Format::Json, _) => file::to_json(mlp).into_bytes(),
        (_, None) => onnx::encode(mlp),
    })
}

/// Writes exports of a network into a folder and returns their paths.
///
/// # Errors
/// [`FileError::Exists`] before anything is written where one of them is there and may not be replaced, and whatever [`encode`] refuses; otherwise
/// [`FileError`] with no file half-written.
pub fn write(mlp: &Mlp, folder: &Path, formats: &[Format], replace: Replace) -> Result<Vec<PathBuf>, ExportError> {
    let paths: Vec<_> = formats.iter().map(|f| f.path(folder, mlp)).collect();
    paths.iter().try_for_each(|path| may_write(path, replace))?;
    let encoded = formats
        .iter()
        .map(|&format| encode(mlp, format))
        .collect::<Result<Vec<_>, _>>()?;
    create_folder(folder)?;
    for (bytes, path) in encoded.iter().zip(&paths) {
        write_atomically(path, replace, |w| w.write_all(bytes))?;
    }
    Ok(paths)
}
