//! Integration tests, in one binary: the command line as a user types it, the order of the layers, the code in the
//! documentation, and an independent reader.

mod bench_gpu;
mod cli;
#[path = "../common/mod.rs"]
mod common;
mod content_deep;
mod content_lists;
mod content_meshes;
mod content_splats;
mod content_work;
mod core;
mod docs;
mod documents;
mod layers;
mod lines;
mod metal;
mod methods;
mod over_time;
mod python;
mod report;
mod shader_folder;
mod shaders;
mod sources;
