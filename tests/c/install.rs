//! `tools/install-c` into a folder of the test's own: programs find rara there by CMake and by pkg-config, shared and static,
//! build and run.

use std::path::Path;
use std::process::Command;

use crate::compiler::{compiler, libraries, root, run};
use crate::folder::Folder;
use rara_c::boundary::RARA_ABI_VERSION;

/// What needs no device: a region of a text, and the message of one that is none.
const PROGRAM: &str = r#"
#include "rara.h"
#include <stdio.h>
int main(void) {
    const double inside[3] = {0.1, 0, 0};
    RaraClip *clip = NULL;
    VkBool32 kept = VK_FALSE;
    if (rara_abi_version() != RARA_ABI_VERSION) return 2;
    if (rara_clip_parse("sphere:0,0,0,1", &clip) != RARA_OK) return 3;
    if (rara_clip_keeps(clip, inside, &kept) != RARA_OK || !kept) return 4;
    rara_clip_destroy(clip);
    if (rara_clip_parse("cube:1", &clip) != RARA_ERROR_INVALID) return 5;
    printf("%u %s", rara_abi_version(), rara_last_error_message());
    return 0;
}
"#;

const PROJECT: &str = r#"
cmake_minimum_required(VERSION 3.16)
project(installed C)
find_package(rara 0.1 REQUIRED)
find_package(rara 99 QUIET)
if(rara_FOUND)
  message(FATAL_ERROR "version 99 was found")
endif()
find_package(rara REQUIRED)
add_executable(shared program.c)
target_link_libraries(shared rara::rara)
add_executable(static program.c)
target_link_libraries(static rara::static)
"#;

/// Installs the libraries that cargo has put beside this test.
pub(crate) fn installed(folder: &Folder) -> std::path::PathBuf {
    let prefix = folder.join("prefix of mine"); // build systems have to quote it
    let mut install = Command::new(root().join("tools/install-c"));
    run(
        install.arg(&prefix).arg(libraries()),
        "tools/install-c fails",
    );
    prefix
}

/// What tools/install-c says where it installs nothing.
#[cfg(target_os = "linux")]
fn refused(install: &mut Command) -> String {
    let output = install.output().expect("it starts");
    assert!(!output.status.success());
    String::from_utf8(output.stderr).expect("UTF-8")
}

#[test]
#[cfg(target_os = "linux")]
fn what_is_missing_is_said_before_anything_is_made() {
    let folder = Folder::new("c-missing");
    let (tools, prefix) = (folder.join("tools"), folder.join("not/there"));
    std::fs::create_dir(&tools).expect("a temporary folder");
    let path = std::env::var_os("PATH").expect("it is set");
    for tool in ["bash", "dirname", "sed", "uname"] {
        let mut places = std::env::split_paths(&path).map(|place| place.join(tool));
        let own = places
            .find(|own| own.exists())
            .expect("it is on every machine");
        std::os::unix::fs::symlink(own, tools.join(tool)).expect("a link");
    }
    let script = root().join("tools/install-c");
    let bare = || {
        let mut bash = Command::new(tools.join("bash"));
        bash.arg(&script)
            .env("PATH", &tools)
            .env("CARGO_HOME", &*folder);
        bash
    };
    let said = refused(bare().arg(&prefix));
    for tool in ["cargo", "cc", "ld", "objcopy", "ar"] {
        assert!(
            said.contains(&format!("\n  {tool}: install ")),
            "{tool}: {said}"
        );
    }
    assert!(!said.contains("a folder to write to"), "{said}");
    assert!(!folder.join("not").exists(), "nothing was made");
    // The libraries are built already, and a file is in the way.
    let file = folder.join("file");
    std::fs::write(&file, "").expect("a temporary file");
    let said = refused(bare().arg(file.join("prefix")).arg(&*folder));
    assert!(!said.contains("cargo"), "{said}");
    let none = format!("a folder to write to: {} is none", file.display());
    assert_eq!(said.matches(&none).count(), 1, "{said}");
    let said = refused(bare().arg(&prefix).arg(&prefix));
    assert!(said.contains("is no folder; give cargo's"), "{said}");
}

/// True where a tool starts; says what is not tested where it does not.
pub(crate) fn has(tool: &str) -> bool {
    let found = Command::new(tool).arg("--version").output().is_ok();
    if !found {
        eprintln!(
            "SKIPPED: NO {tool}: what tools/install-c gives it was not tried; tools/setup test installs it"
        );
    }
    found
}

#[track_caller]
fn assert_runs(program: &mut Command) {
    let output = program.output().expect("it starts");
    let said = String::from_utf8_lossy(&output.stdout);
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.success(),
        "{:?}: {said}{complaint}",
        output.status
    );
    let version = format!("{RARA_ABI_VERSION} ");
    assert!(
        said.starts_with(&version) && said.contains("cube"),
        "{said}"
    );
}

#[test]
fn cmake_finds_what_was_installed() {
    let Some(compiler) = compiler("no program was built with what tools/install-c installs") else {
        return;
    };
    if !has("cmake") {
        return;
    }
    let folder = Folder::new("c-cmake");
    // Where it was moved to counts, not where it was installed.
    let prefix = folder.join("moved");
    std::fs::rename(installed(&folder), &prefix).expect("a folder");
    std::fs::write(folder.join("program.c"), PROGRAM).expect("a temporary file");
    std::fs::write(folder.join("CMakeLists.txt"), PROJECT).expect("a temporary file");
    let build = folder.join("build");
    let mut configure = Command::new("cmake");
    configure.arg("-S").arg(&*folder).arg("-B").arg(&build);
    configure.arg(format!("-DCMAKE_PREFIX_PATH={}", prefix.display()));
    run(
        &mut configure,
        &format!("CMake does not configure, beside {compiler}"),
    );
    run(
        Command::new("cmake").arg("--build").arg(&build),
        "it does not build",
    );
    for program in ["shared", "static"] {
        assert_runs(&mut Command::new(build.join(program)));
    }
}

/// What pkg-config says of the installed library.
pub(crate) fn flags(library: &Path, of: &[&str]) -> String {
    let output = Command::new("pkg-config")
        .args(of)
        .arg("rara")
        .env("PKG_CONFIG_PATH", library.join("pkgconfig"))
        .output()
        .expect("it starts");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8(output.stdout)
        .expect("UTF-8")
        .trim()
        .to_owned()
}

/// Builds a program in C with flags as pkg-config says them, which the shell takes apart where they are quoted.
pub(crate) fn build(compiler: &str, source: &Path, out: &Path, flags: &str) {
    let line = format!("\"$0\" -x c \"$1\" -x none -o \"$2\" {flags}");
    let mut shell = Command::new("sh");
    shell.args(["-c", &line, compiler]).arg(source).arg(out);
    run(&mut shell, flags);
}

#[test]
fn pkg_config_finds_what_was_installed() {
    let Some(compiler) = compiler("no program was built with what tools/install-c installs") else {
        return;
    };
    if !has("pkg-config") {
        return;
    }
    let folder = Folder::new("c-pkg-config");
    let prefix = installed(&folder);
    let library = prefix.join("lib");
    let flags = |of: &[&str]| flags(&library, of);
    assert_eq!(flags(&["--modversion"]), env!("CARGO_PKG_VERSION"));
    let program = folder.join("program.c");
    std::fs::write(&program, PROGRAM).expect("a temporary file");
    let build = |out: &Path, flags: &str| build(&compiler, &program, out, flags);
    let shared = folder.join("shared");
    build(&shared, &flags(&["--cflags", "--libs"]));
    assert_runs(Command::new(&shared).env("LD_LIBRARY_PATH", &library));
    // What the archive needs besides, and the archive itself in place of the library.
    let archive = folder.join("static");
    let private = flags(&["--static", "--libs", "--cflags"]).replace("-lrara", "-l:librara.a");
    build(&archive, &private);
    assert_runs(&mut Command::new(&archive));
}

/// The name under which programs look for the library, and what else there is for their linkers to see.
#[test]
fn libraries_have_a_name_and_no_symbols_of_others() {
    let Some(_) = compiler("the installed libraries were not looked at") else {
        return;
    };
    if !has("readelf") || !has("nm") {
        return;
    }
    let folder = Folder::new("c-symbols");
    let library = installed(&folder).join("lib");
    let shared = library.join(format!("librara.so.{RARA_ABI_VERSION}"));
    let said = |tool: &str, flags: &[&str], file: &Path| {
        let output = Command::new(tool).args(flags).arg(file).output();
        String::from_utf8(output.expect("it starts").stdout).expect("UTF-8")
    };
    let name = format!("[librara.so.{RARA_ABI_VERSION}]");
    assert!(said("readelf", &["-d"], &shared).contains(&name));
    let archive = library.join("librara.a");
    let all = said("nm", &["-g", "--defined-only"], &archive);
    let names = all.lines().filter_map(|line| line.split(' ').nth(2));
    let (ours, others): (Vec<_>, Vec<_>) = names.partition(|name| name.starts_with("rara_"));
    assert!(
        ours.contains(&"rara_device_adopt") && ours.len() > 40,
        "{ours:?}"
    );
    assert_eq!(others, Vec::<&str>::new());
    for file in [&shared, &archive] {
        assert!(!said("readelf", &["-S", "-W"], file).contains(".debug_info"));
    }
}
