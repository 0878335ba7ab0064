//! Numbers only, no graphics words: precision-generic arithmetic, orthogonal polynomials, roots, storage rounding,
//! random streams, tolerances, hashing, safe file writing, and tools that a machine may lack.

pub mod complex;
pub mod digest;
pub mod doubles;
pub mod exact_sum;
pub mod file;
pub mod lanes;
pub mod npy;
pub mod orthogonal;
pub mod quantise;
pub mod real;
pub mod require;
pub mod rng;
pub mod roots;
pub mod scalar;
pub mod similar;
pub mod source;
pub mod tolerance;
pub mod unit_circle;

pub use real::Real;
pub use scalar::Scalar;
