//! Moments of absorbance over depth.

pub mod power;
