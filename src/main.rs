//! The `nmt` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    nmt::cli::main()
}
