//! The `rara` command: what was typed, what it means, done; one line when it could not be.
#![forbid(unsafe_code)]

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::main()
}
