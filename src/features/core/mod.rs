//! Core and tail: single fragments of a pixel, stored one by one, and the sums of all others.

pub mod code;
