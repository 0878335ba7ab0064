//! Integration tests, in one binary: the command line as a user types it, the order of the layers, and an independent reader.

mod cli;
mod fuzz;
mod layers;
mod python;
mod report;
