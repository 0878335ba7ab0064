//! Integration tests, in one binary: the command line as a user types it, the order of the layers, the code in the documentation, and an
//! independent reader.

mod cli;
mod docs;
mod fuzz;
mod layers;
mod methods;
mod python;
mod report;
mod shaders;
