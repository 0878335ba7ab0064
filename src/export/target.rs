//! What is known of a target: all that its one file says of it, and that names, lists, writing and checking follow.

use super::dialect::ShadingLanguage;
use super::{ExportError, Format, Prefix};
use crate::model::{Mlp, file};

/// Writes a network in a format of a target; where a prefix is given, names begin with it in place of `nmt`.
pub type Write = fn(&Mlp, Format, Option<&Prefix>) -> Result<Vec<u8>, ExportError>;

/// What reads an export back, and what executes it, where it is held against the network.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reader {
    /// naga reads WGSL; the interpreter and a GPU execute the module.
    Wgsl,
    /// naga reads GLSL, and glslangValidator compiles it; the interpreter and a GPU execute naga's module.
    Glsl,
    /// glslangValidator compiles HLSL, and slangc makes WGSL of it, which the interpreter and a GPU execute.
    Hlsl,
    /// Nothing here compiles Metal's language: the weights are read from the text.
    Metal,
    /// spirv-val validates the module, and the weights are read from its constants.
    Spirv,
    /// The model file is read as any other.
    Model,
    /// Our own interpreter of ONNX graphs, rten and ONNX Runtime execute the graph.
    Onnx,
}

/// All that is known of a target.
pub struct Description {
    /// What a person calls it.
    pub title: &'static str,
    /// Names on the command line and in reports: packed, packed in f16, plain, plain in f16.
    pub names: [&'static str; 4],
    /// What follows the name of the network in the names of files, in the same order.
    pub suffixes: [&'static str; 4],
    /// The language that it is, or that it is translated from; none for what is no shader.
    pub language: Option<&'static dyn ShadingLanguage>,
    /// Whether it is source text of a shader, to be included by another, with a header of comments.
    pub text: bool,
    /// Whether it is offered with unrolled scalars.
    pub plain: bool,
    /// Whether it is offered with hidden layers in f16.
    pub half: bool,
    /// What writes it.
    pub write: Write,
    /// What reads it back.
    pub reader: Reader,
}

/// The names of a target's formats, of the name of the target.
macro_rules! names {
    ($name:literal) => {
        [
            $name,
            concat!($name, "-f16"),
            concat!($name, "-plain"),
            concat!($name, "-plain-f16"),
        ]
    };
}

/// The endings of a target's files, of the last part of them.
macro_rules! suffixes {
    ($extension:literal) => {
        [
            concat!(".", $extension),
            concat!(".f16.", $extension),
            concat!(".plain.", $extension),
            concat!(".plain.f16.", $extension),
        ]
    };
}

/// [`Target`](super::Target) of a table of its variants, each with its [`Description`] and a line about it.
macro_rules! targets {
    ($($target:ident: $description:expr, $about:literal;)*) => {
        /// What an export is written for.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Target {
            $(#[doc = $about] $target,)*
        }

        impl Target {
            /// Every target.
            pub const ALL: [Self; [$(Self::$target),*].len()] = [$(Self::$target),*];

            /// All that is known of it.
            pub(crate) fn description(self) -> &'static Description {
                match self {
                    $(Self::$target => &$description,)*
                }
            }
        }
    };
}

pub(super) use {names, suffixes, targets};

impl super::Target {
    /// What a person calls it.
    pub fn title(self) -> &'static str {
        self.description().title
    }

    /// The language that it is, or that it is translated from; none for what is no shader.
    pub fn language(self) -> Option<&'static dyn ShadingLanguage> {
        self.description().language
    }

    /// What lines of its header begin with; none where it is no source text.
    pub fn comment(self) -> Option<&'static str> {
        let language = self.language().filter(|_| self.description().text);
        language.map(ShadingLanguage::comment)
    }

    /// What reads it back.
    pub fn reader(self) -> Reader {
        self.description().reader
    }

    /// Every target that is source text, to be included by a shader.
    pub fn all_of_text() -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(|target| target.comment().is_some())
    }
}

/// The model file.
pub(super) const JSON: Description = Description {
    title: "JSON",
    names: names!("json"),
    suffixes: suffixes!("json"),
    language: None,
    text: false,
    plain: false,
    half: false,
    write: |mlp, _, _| Ok(file::to_json(mlp).into_bytes()),
    reader: Reader::Model,
};
