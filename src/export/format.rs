//! Export formats: what is written, how weights are laid out in it, and in which precision.

use super::Target;
use super::dialect::ShadingLanguage;
use crate::model::Mlp;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// How weights are laid out in shader source.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Form {
    /// Blocks of 4 × 4 weights as matrices; shorter, and faster on most devices.
    Packed,
    /// One scalar a weight, `[in][out]` flat; sums in the order of the reference forward pass.
    Plain,
}

/// What weights and activations are kept in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Precision {
    /// f32 throughout.
    F32,
    /// Weights and activations of hidden layers in f16; features, the last layer and the answer in f32.
    F16,
}

/// A form in which a network leaves the program: a target, a layout of the weights and a precision that it is offered
/// in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Format {
    target: Target,
    form: Form,
    precision: Precision,
}

/// Why there is no such format.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FormatError {
    /// The name is none.
    #[error("there is no format '{name}'; known are {}", names(Format::all()))]
    Unknown {
        /// The name.
        name: String,
    },
    /// The target has no form with unrolled scalars.
    #[error("{target} has no form with unrolled scalars; {} have",
        names(Format::all().filter(|f| f.form == Form::Plain)))]
    NoPlain {
        /// Name of the target.
        target: &'static str,
    },
    /// The target has no f16 form.
    #[error("{target} has no f16 form; {} have", names(Format::all().filter(|f| f.precision == Precision::F16)))]
    NoHalf {
        /// Name of the target.
        target: &'static str,
    },
}

fn names(formats: impl Iterator<Item = Format>) -> String {
    formats.map(Format::name).collect::<Vec<_>>().join(", ")
}

impl Format {
    /// WGSL, packed.
    pub const WGSL: Self = Self::of(Target::Wgsl);
    /// WGSL, unrolled scalars.
    pub const WGSL_PLAIN: Self = Self::WGSL.plain();
    /// WGSL, packed, hidden layers in f16.
    pub const WGSL_F16: Self = Self::WGSL.half();
    /// WGSL, unrolled scalars, hidden layers in f16.
    pub const WGSL_PLAIN_F16: Self = Self::WGSL_PLAIN.half();
    /// GLSL, packed.
    pub const GLSL: Self = Self::of(Target::Glsl);
    /// GLSL, unrolled scalars.
    pub const GLSL_PLAIN: Self = Self::GLSL.plain();
    /// HLSL, packed.
    pub const HLSL: Self = Self::of(Target::Hlsl);
    /// HLSL, unrolled scalars.
    pub const HLSL_PLAIN: Self = Self::HLSL.plain();
    /// HLSL, packed, hidden layers in f16.
    pub const HLSL_F16: Self = Self::HLSL.half();
    /// HLSL, unrolled scalars, hidden layers in f16.
    pub const HLSL_PLAIN_F16: Self = Self::HLSL_PLAIN.half();
    /// Metal's language.
    pub const METAL: Self = Self::of(Target::Metal);
    /// SPIR-V.
    pub const SPIRV: Self = Self::of(Target::Spirv);
    /// The model file.
    pub const JSON: Self = Self::of(Target::Json);
    /// ONNX.
    pub const ONNX: Self = Self::of(Target::Onnx);

    /// What is exported where nothing else is asked for: the faster form of every target, in f32.
    pub const DEFAULT: [Self; Target::ALL.len()] = {
        let mut formats = [Self::of(Target::ALL[0]); Target::ALL.len()];
        let mut index = 0;
        while index < formats.len() {
            formats[index] = Self::of(Target::ALL[index]);
            index += 1;
        }
        formats
    };

    /// A target's packed form in f32.
    pub const fn of(target: Target) -> Self {
        Self {
            target,
            form: Form::Packed,
            precision: Precision::F32,
        }
    }

    const fn plain(self) -> Self {
        Self {
            form: Form::Plain,
            ..self
        }
    }

    const fn half(self) -> Self {
        Self {
            precision: Precision::F16,
            ..self
        }
    }

    /// A format of these parts.
    ///
    /// # Errors
    /// [`FormatError`] where the target is not offered so.
    pub fn new(target: Target, form: Form, precision: Precision) -> Result<Self, FormatError> {
        let about = target.description();
        match (form, precision) {
            (Form::Plain, _) if !about.plain => Err(FormatError::NoPlain { target: about.names[0] }),
            (_, Precision::F16) if !about.half => Err(FormatError::NoHalf { target: about.names[0] }),
            _ => Ok(Self {
                target,
                form,
                precision,
            }),
        }
    }

    /// Every format, target by target.
    pub fn all() -> impl Iterator<Item = Self> {
        let forms = |target| [Form::Packed, Form::Plain].map(|form| (target, form));
        Target::ALL
            .into_iter()
            .flat_map(forms)
            .flat_map(|(target, form)| [Precision::F32, Precision::F16].map(|precision| (target, form, precision)))
            .filter_map(|(target, form, precision)| Self::new(target, form, precision).ok())
    }

    /// What it is written for.
    pub fn target(self) -> Target {
        self.target
    }

    /// How weights are laid out.
    pub fn form(self) -> Form {
        self.form
    }

    /// What hidden layers are kept in.
    pub fn precision(self) -> Precision {
        self.precision
    }

    /// The language that it is, or that it is translated from; none for what is no shader.
    pub fn language(self) -> Option<&'static dyn ShadingLanguage> {
        self.target.language()
    }

    /// The same in another precision.
    ///
    /// # Errors
    /// [`FormatError::NoHalf`].
    pub fn with_precision(self, precision: Precision) -> Result<Self, FormatError> {
        Self::new(self.target, self.form, precision)
    }

    /// Where its name stands among its target's.
    fn index(self) -> usize {
        2 * usize::from(self.form == Form::Plain) + usize::from(self.precision == Precision::F16)
    }

    /// Its name on the command line and in reports: the target, then `-plain` and `-f16` where they apply.
    pub fn name(self) -> &'static str {
        self.target.description().names[self.index()]
    }

    /// What follows the name of the network in the name of its file.
    pub fn suffix(self) -> &'static str {
        self.target.description().suffixes[self.index()]
    }

    /// Where the export of a network stands in a folder.
    pub fn path(self, folder: &Path, mlp: &Mlp) -> PathBuf {
        folder.join(format!("{}{}", mlp.name(), self.suffix()))
    }
}

impl FromStr for Format {
    type Err = FormatError;

    fn from_str(name: &str) -> Result<Self, FormatError> {
        for target in Target::ALL {
            if let Some(index) = target.description().names.iter().position(|n| *n == name) {
                let form = [Form::Packed, Form::Plain][index / 2];
                return Self::new(target, form, [Precision::F32, Precision::F16][index % 2]);
            }
        }
        Err(FormatError::Unknown { name: name.to_owned() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every format's name parses back to it, and no two share a name or a file. Controls: names that are nearly right.
    #[test]
    fn names_parse_back() {
        let all: Vec<Format> = Format::all().collect();
        assert!(all.len() >= 16);
        for format in &all {
            assert_eq!(format.name().parse::<Format>().as_ref(), Ok(format));
            let same = all
                .iter()
                .filter(|f| f.name() == format.name() || f.suffix() == format.suffix());
            assert_eq!(same.count(), 1, "{}", format.name());
        }
        assert_eq!(Format::WGSL_PLAIN_F16.name(), "wgsl-plain-f16");
        assert_eq!(Format::HLSL_PLAIN_F16.suffix(), ".plain.f16.hlsl");
        assert!(Format::DEFAULT.iter().all(|f| all.contains(f)));
        for wrong in ["", "Wgsl", "wgsl-f16-plain", "wgsl-plain-plain", "wgsl-", "plain"] {
            assert!(
                matches!(wrong.parse::<Format>(), Err(FormatError::Unknown { .. })),
                "{wrong}"
            );
        }
        assert_eq!(
            "glsl-f16".parse::<Format>(),
            Err(FormatError::NoHalf { target: "glsl" })
        );
        let message = "metal-plain".parse::<Format>().unwrap_err().to_string();
        assert!(message.contains("wgsl-plain, wgsl-plain-f16, glsl-plain"), "{message}");
    }
}
