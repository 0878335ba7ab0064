//! The text of every method's passes as WGSL, without a device.
//!
//! A method ([`MethodShader`]) says what pass 1 adds and what pass 2 weighs by; [`passes`] makes render passes of it,
//! [`compute`] compute passes. WGSL lies in files beside the Rust, where words in capitals that begin with `OIT_` are
//! filled in, or is written by the formulas that all kinds of numbers share.

#[cfg(test)]
mod capabilities;
pub mod compute;
mod core;
pub mod method;
pub mod passes;

use crate::export::dialect::Wgsl;
use crate::features::recentred::formulas;
use crate::numeric::source::Source;
pub use crate::oit::MethodShader;

/// The absorbance of a fragment as a function of the passes, `oit_absorbance`.
fn absorbance() -> String {
    let source = Source::new(&Wgsl, "oit");
    formulas::absorbance(source.real("alpha"));
    source.into_text()
}

/// The logarithm of a ratio as a function of the passes, `oit_log_ratio`.
fn log_ratio() -> String {
    let source = Source::new(&Wgsl, "oit");
    formulas::log_ratio(source.real("a"), source.real("b"));
    source.into_text()
}

/// Why a network or a list makes no shader.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{label}: {reason}")]
pub struct ShaderError {
    /// The method.
    pub label: String,
    /// Why.
    pub reason: String,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both functions of the passes are those that a person would write. Control: they are two.
    #[test]
    fn formulas_become_functions_of_the_passes() {
        assert!(absorbance().contains("fn oit_absorbance(alpha: f32) -> f32 {"));
        assert!(log_ratio().contains("fn oit_log_ratio(a: f32, b: f32) -> f32 {"));
        assert_ne!(absorbance(), log_ratio());
    }
}
