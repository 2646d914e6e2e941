//! rara in a host on wgpu, `tools/examples/wgpu`: a crate of its own that is built here, since rara does not depend on wgpu.
//! It compares its pictures with the headless ones by itself, under the validation layer.

use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A cargo command on the example.
fn cargo(what: &str) -> Command {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("tools/examples/wgpu/Cargo.toml");
    let mut cargo = Command::new(env::var_os("CARGO").unwrap_or("cargo".into()));
    cargo.args([what, "--locked", "--quiet", "--manifest-path"]);
    cargo.arg(manifest);
    cargo
}

fn run(command: &mut Command) -> (Output, String) {
    let output = command.output().expect("it starts");
    let said = [&*output.stdout, &*output.stderr].concat();
    let said = String::from_utf8_lossy(&said).into_owned();
    (output, said)
}

/// The example, built. `None`, with a message, where what it depends on can be had neither here nor from its registry.
fn example() -> Option<PathBuf> {
    let (_, rustc) = run(Command::new("rustc").arg("-vV"));
    let host = rustc.lines().find_map(|line| line.strip_prefix("host: "));
    // Where everything that this system needs is here already, this asks nobody.
    let (fetched, said) = run(cargo("fetch").args(["--target", host.expect("a system")]));
    assert!(
        !said.contains("--locked was passed"),
        "rara's dependencies have changed: `cargo update --workspace` in tools/examples/wgpu notes them: {said}"
    );
    if !fetched.status.success() {
        let why = said.lines().find(|line| line.starts_with("error"));
        let why = why.unwrap_or(&said);
        eprintln!(
            "SKIPPED: NO WGPU: rara was not drawn in a host on wgpu, which cannot be fetched: {why}"
        );
        return None;
    }
    // Beside what else is built, so that it is kept from one run to the next.
    let built = Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("wgpu");
    let mut build = cargo("build");
    let (output, said) = run(build.arg("--offline").arg("--target-dir").arg(&built));
    assert!(
        output.status.success(),
        "the example does not build: {said}"
    );
    Some(built.join("debug/rara-wgpu"))
}

/// Runs the example with a flag, which has to succeed; returns what it prints.
fn checked(flag: &str) -> Option<String> {
    let mut program = Command::new(example()?);
    let device = env::var("RARA_TEST_DEVICE").unwrap_or_default();
    let (output, said) = run(program.args(["--device", &device, flag]));
    assert!(
        output.status.success(),
        "{flag}: {:?}: {said}",
        output.status
    );
    Some(said)
}

#[test]
fn pictures_are_the_headless_ones_byte_for_byte_and_the_layer_is_silent() {
    let Some(said) = checked("--check") else {
        return;
    };
    for format in ["Rgba8Unorm", "Rgba16Float"] {
        let lines = said.lines().filter(|line| line.starts_with(format));
        assert_eq!(lines.count(), 3, "{said}"); // of one eye, of two, and over a wall
    }
}

#[test]
fn a_transition_and_a_barrier_that_are_left_out_are_seen() {
    checked("--check-careless");
}
