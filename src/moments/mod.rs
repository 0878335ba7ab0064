//! Moments of absorbance over depth: how they are added up, stored, and turned back into absorbance in front of a
//! depth.

pub mod hamburger;
pub mod power;
pub mod storage;
pub mod trigonometric;
