//! SPIR-V, which naga makes of the packed WGSL; it has no names that could take a prefix.

use super::Wgsl;
use crate::export::target::{Description, Reader, names, suffixes};
use crate::export::translate;

/// SPIR-V as a target.
pub(super) const TARGET: Description = Description {
    title: "SPIR-V",
    names: names!("spirv"),
    suffixes: suffixes!("spv"),
    language: Some(&Wgsl),
    text: false,
    plain: false,
    half: true,
    write: |mlp, format, _| translate::spirv(mlp, format),
    reader: Reader::Spirv,
};
