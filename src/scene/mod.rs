//! Fragment lists from files.

pub mod npz;
