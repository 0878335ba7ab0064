//! The command line as a user types it, a file for each command.

mod bench;
mod check;
mod config;
mod evaluate;
mod export;
mod files;
mod generate;
mod help;
mod import;
mod predict;
mod profile;
mod run;
mod scene;
mod stress;
mod train;
