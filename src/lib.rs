//! Neural moment transparency: a tiny network that answers, for every transparent fragment of a pixel, how much light
//! passes in front of it.
//!
//! ```
//! use nmt::{evaluate::transmittance_error, features::Target, model::shipped, oit, scene};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let network = oit::neural::Neural::new(shipped::named("recommended").ok_or("there is one")?);
//! let options = scene::Options { size: Some((64, 48)), seed: None };
//! let fragments = scene::build(&scene::open("teapots")?, &options)?;
//! let answers = network.transmittance(&fragments, oit::Context::default(), &|_| {})?;
//! let error = transmittance_error(&answers, &Target::Transmittance.of_list(&fragments));
//! println!("T-MSE {:.2e} over {} fragments", error.mse(), error.count());
//! assert!(error.mse() < 1e-3);
//! # Ok(()) }
//! ```
//!
//! `examples/` has more: training and exporting a network, fragments of one's own, a method of one's own.
//!
//! Data flows down this list of modules, and a module imports only from those above it: [`numeric`], [`pixel`] and
//! [`chart`], [`synth`] and [`scene`], [`moments`], [`features`], [`dataset`], [`model`], [`train`], [`oit`],
//! [`export`], [`gpu`], [`check`], [`evaluate`], [`mod@bench`], [`stress`], [`profile`] and [`report`].

#![warn(missing_docs)]

pub mod bench;
pub mod chart;
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
