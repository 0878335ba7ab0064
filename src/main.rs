//! The `nmt` command.

fn main() {}
