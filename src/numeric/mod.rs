//! Numbers only, no graphics words: precision-generic arithmetic, random streams, tolerances, hashing and safe file writing.

pub mod digest;
pub mod file;
pub mod npy;
pub mod real;
pub mod rng;
pub mod tolerance;

pub use real::Real;
