//! The program `rara`, which the library of this crate has.

fn main() -> std::process::ExitCode {
    rara_cli::main()
}
