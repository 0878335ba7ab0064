//! Neural moment transparency: a tiny network that answers, for every transparent fragment of a pixel, how much light passes in front of it.
//!
//! Data flows down this list of modules, and a module imports only from those above it:
//! [`numeric`], [`pixel`], [`synth`] and [`scene`], [`moments`], [`features`], [`dataset`], [`model`], [`train`], [`oit`], [`export`],
//! [`gpu`], [`check`], [`evaluate`], [`mod@bench`], [`stress`], [`profile`] and [`report`].

#![warn(missing_docs)]

pub mod bench;
pub mod check;
pub mod cli;
pub mod dataset;
pub mod evaluate;
pub mod export;
pub mod features;
pub mod gpu;
pub mod infer;
pub mod model;
pub mod moments;
pub mod numeric;
pub mod oit;
pub mod pixel;
pub mod profile;
pub mod report;
pub mod scene;
pub mod shader;
pub mod stress;
pub mod synth;
pub mod train;

/// The Rust in docs/integration.md, run as documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../docs/integration.md")]
pub struct Integration;
