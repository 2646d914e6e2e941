//! `rara.h`, which the build makes, has all functions, and C and the guide's C++ compile with it. The modules of the C++
//! host are what glslang makes of its shaders.

use std::path::Path;
use std::process::Command;

use crate::compiler::{compiler, root, run};
use crate::folder::Folder;

/// The folder of `rara.h`.
pub(crate) const HEADER: &str = env!("OUT_DIR");

/// The functions that the library exports, by what its files say.
fn exported(folder: &Path) -> Vec<String> {
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("a file").path();
        if path.extension().is_some_and(|ending| ending == "rs") {
            let text = std::fs::read_to_string(&path).expect("a text");
            let found = text.split("extern \"C\" fn ").skip(1);
            let found = found.filter_map(|after| after.split('(').next());
            names.extend(
                found
                    .filter(|name| name.starts_with("rara_"))
                    .map(str::to_owned),
            );
        }
    }
    assert!(names.len() > 80, "{} functions", names.len());
    names
}

#[test]
fn the_header_has_all_functions() {
    let header = std::fs::read_to_string(Path::new(HEADER).join("rara.h")).expect("a header");
    for name in exported(Path::new(env!("CARGO_MANIFEST_DIR"))) {
        assert!(header.contains(&format!("{name}(")), "{name} is missing");
    }
}

/// Asserts that code compiles without a warning; the compiler writes no file.
pub(crate) fn assert_compiles(compiler: &str, flags: &[&str], name: &str, code: &str) {
    let own = Folder::new("c-header");
    let path = own.join(name);
    std::fs::write(&path, code).expect("a temporary file");
    let mut command = Command::new(compiler);
    command.args(["-fsyntax-only", "-Wall", "-Wextra", "-Werror"]);
    command.args(flags).arg("-I").arg(HEADER);
    let says = format!("{name} does not compile (tools/setup test installs the Vulkan headers)");
    run(command.arg(&path), &says);
}

#[test]
fn the_header_is_c_and_the_guides_snippets_are_cpp() {
    let Some(compiler) = compiler("neither rara.h in C nor the guide's C++ was compiled") else {
        return;
    };
    let c =
        "#include \"rara.h\"\nint main(void) { return rara_abi_version() != RARA_ABI_VERSION; }\n";
    let c99 = ["-x", "c", "-std=c99", "-pedantic"];
    assert_compiles(&compiler, &c99, "header.c", c);

    let chapter = std::fs::read_to_string(root().join("src/guide/c.md")).expect("a chapter");
    let snippets: Vec<_> = chapter
        .split("\n```cpp\n")
        .skip(1)
        .map(|from| from.split("\n```").next().expect("all before the end"))
        .collect();
    assert!(!snippets.is_empty(), "no C++ in the guide");
    let snippets = snippets.join("\n");
    // A compiler checks all of a template only where it is used.
    let used =
        "void use(Splats &s, VkCommandBuffer cmd) { frame(s, cmd, VK_NULL_HANDLE, [] {}, [] {}); }";
    let code = format!("{snippets}\n{used}\n");
    assert_compiles(&compiler, &["-std=c++17"], "guide.cpp", &code);
}

#[test]
fn the_cpp_hosts_mesh_is_what_its_shaders_compile_to() {
    let glslang = "glslangValidator";
    let Ok(version) = Command::new(glslang).arg("--version").output() else {
        eprintln!("SKIPPED: NO {glslang}: the C++ host's mesh was not compared with its shaders");
        return;
    };
    let version = String::from_utf8_lossy(&version.stdout);
    let version = version
        .lines()
        .next()
        .and_then(|line| line.rsplit(' ').next());
    let folder = root().join("tools/examples");
    let readme = std::fs::read_to_string(folder.join("README.md")).expect("a README");
    if !version.is_some_and(|version| readme.contains(&format!("made here by glslang {version}:")))
    {
        eprintln!(
            "SKIPPED: ANOTHER {glslang}, {version:?}: the C++ host's mesh was not compared with its shaders"
        );
        return;
    }
    let own = Folder::new("c-mesh");
    for stage in ["vert", "frag"] {
        let name = format!("mesh.{stage}.spv");
        let out = own.join(&name);
        let mut command = Command::new(glslang);
        command.args(["-V", "--quiet", "--target-env", "vulkan1.2"]);
        command.arg(folder.join(format!("mesh.{stage}")));
        run(command.arg("-o").arg(&out), "a shader does not compile");
        let read = |path| std::fs::read(path).expect("a module");
        assert!(
            read(out) == read(folder.join(&name)),
            "tools/examples/{name} is stale: its README says how it is made"
        );
    }
}
