//! The text of every method's passes as WGSL, without a device.
//!
//! A method ([`MethodShader`]) says what pass 1 adds and what pass 2 weighs by; [`passes`] makes render passes of it,
//! [`compute`] compute passes. All WGSL lies in files beside the Rust; words in capitals that begin with `OIT_` are
//! filled in.

#[cfg(test)]
mod capabilities;
pub mod compute;
mod core;
pub mod method;
pub mod passes;

pub use crate::oit::MethodShader;

/// Why a network or a list makes no shader.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{label}: {reason}")]
pub struct ShaderError {
    /// The method.
    pub label: String,
    /// Why.
    pub reason: String,
}
