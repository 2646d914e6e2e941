//! The `rara` command: it parses the command line, does the work, and prints one line if that fails.
#![deny(unsafe_code)] // the process's environment and signals alone need it

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::main()
}
