//! The C++ compiler that the tests of `rara.h` call: `CXX`, or `c++`.

use std::env;
use std::path::PathBuf;
use std::process::Command;

/// Its name; `None`, with a message, if there is no compiler.
pub(crate) fn compiler(what: &str) -> Option<String> {
    let compiler = env::var("CXX").unwrap_or_else(|_| "c++".into());
    if Command::new(&compiler).arg("--version").output().is_err() {
        eprintln!("SKIPPED: NO C++ COMPILER ({compiler}): {what}; tools/setup test installs one");
        return None;
    }
    Some(compiler)
}

/// The repository.
pub(crate) fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The folder beside this test, where cargo puts the libraries.
pub(crate) fn libraries() -> PathBuf {
    let test = env::current_exe().expect("a path");
    test.parent().expect("a folder").to_owned()
}

/// Runs a command, which must succeed; `says` is the message if it does not.
pub(crate) fn run(command: &mut Command, says: &str) {
    let output = command.output().expect("the compiler starts");
    let said = String::from_utf8_lossy(&output.stderr);
    let printed = String::from_utf8_lossy(&output.stdout); // glslang complains here
    assert!(output.status.success(), "{says}: {said}{printed}");
}

/// Runs a host on a device under validation with synchronisation checks; it must report no problem. Returns what it prints.
pub(crate) fn run_host(host: &mut Command, device: &str) -> String {
    let output = host
        .env("RARA_VALIDATION", "1")
        .env("RARA_DEVICE", device)
        .env(
            "VK_LAYER_ENABLES",
            "VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT",
        )
        .output()
        .expect("the host starts");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.success() && said.is_empty(),
        "{host:?}: {said}"
    );
    String::from_utf8_lossy(&output.stdout).into_owned()
}
