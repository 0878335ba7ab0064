//! Metal's language, which naga makes of the packed WGSL.

use super::Wgsl;
use crate::export::target::{Description, Reader, names, suffixes};
use crate::export::translate;

/// Metal's language as a target.
pub(super) const TARGET: Description = Description {
    title: "MSL",
    names: names!("metal"),
    suffixes: suffixes!("metal"),
    language: Some(&Wgsl),
    text: true,
    plain: false,
    half: true,
    write: |mlp, format, prefix| Ok(translate::metal(mlp, format, prefix)?.into_bytes()),
    reader: Reader::Metal,
};
