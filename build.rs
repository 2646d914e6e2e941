//! Turns `glsl/` into the crate's structs (`types.glsl`), and the SPIR-V and the interface of every shader.
//!
//! Every shader is compiled thrice from one source: with buffers behind device addresses, with bound buffers that the
//! validation layer can watch, and with some of either for CPU drivers. With the feature `shaderc` the GLSL is compiled
//! here, warnings as errors. Without it the SPIR-V committed in `glsl/spirv/` is used, so that nobody has to compile a C++
//! compiler to see a picture; the manifest beside each module says from which GLSL it was compiled, and a difference is an error.

use std::path::{Path, PathBuf};
use std::{env, fs};

#[path = "src/codegen/mod.rs"]
mod codegen;

use codegen::{VARIANTS, glsl, interface, manifest, pictures, spirv};

fn main() {
    for changed in ["glsl", "build.rs", "src/codegen", "tools/pictures"] {
        println!("cargo::rerun-if-changed={changed}");
    }
    let out = PathBuf::from(env::var("OUT_DIR").expect("cargo sets OUT_DIR"));
    let write =
        |name: &str, text: String| fs::write(out.join(name), text).expect("OUT_DIR is writable");
    let limits = limits();
    let types = read("glsl/types.glsl");
    write(
        "types.rs",
        glsl::structs(&types, &limits) + &glsl::constants(&types),
    );
    let answers = read("glsl/region/surface.glsl");
    for kind in glsl::kinds(&types, "SURFACE_").skip(1) {
        assert!(
            answers.contains(&format!("case {kind}: ")),
            "glsl/region/surface.glsl: RETURN_ANSWER has no line for {kind}, a kind of glsl/types.glsl"
        );
    }
    let modules = spirv_of(Path::new("glsl"), &out);
    write("shaders.rs", shaders(Path::new("glsl"), &modules));
    for name in pictures::NAMES {
        let png = fs::read(format!("tools/pictures/{name}.png")).expect("tools/pictures/");
        write(&format!("{name}.md"), pictures::definition(name, &png));
    }
}

/// The text of `glsl/limits.glsl`, which tools/shaders has written here.
fn limits() -> String {
    let limits = glsl::limits(rara_base::LIMITS);
    let file = "glsl/limits.glsl";
    println!("cargo::rerun-if-env-changed=RARA_RENEW_LIMITS");
    if env::var_os("RARA_RENEW_LIMITS").is_some() && read(file) != limits {
        fs::write(file, &limits).expect("glsl/ is writable");
    }
    assert!(
        read(file) == limits,
        "{file} is not what src/base/limits.rs says: run tools/shaders"
    );
    limits
}

fn read(path: &str) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The folder of the committed SPIR-V, which has to be compiled from the current GLSL.
#[cfg(not(feature = "shaderc"))]
fn spirv_of(glsl: &Path, _: &Path) -> PathBuf {
    let folder = glsl.join("spirv");
    let stale = manifest::stale(glsl, &folder);
    assert!(
        stale.is_empty(),
        "glsl/spirv/ is not what glsl/ was compiled to: run tools/shaders, or build with --features shaderc. {}",
        stale.join("; ")
    );
    folder
}

/// Compiles the SPIR-V, and returns its folder.
#[cfg(feature = "shaderc")]
fn spirv_of(glsl: &Path, out: &Path) -> PathBuf {
    // tools/shaders names another folder, to commit the SPIR-V or to compare it with the committed one.
    println!("cargo::rerun-if-env-changed=RARA_SPIRV_DIR");
    let folder = env::var_os("RARA_SPIRV_DIR").map_or(out.join("spirv"), PathBuf::from);
    // Modules whose GLSL is gone must not be taken for current ones.
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("the folder for SPIR-V is writable");
    if let Err(error) = codegen::compile::compile(glsl, &folder) {
        println!("cargo::error={}", error.replace('\n', " | "));
        eprintln!("{error}");
        std::process::exit(1);
    }
    folder
}

/// The interfaces of all programs.
fn shaders(glsl: &Path, modules: &Path) -> String {
    let source = |path: PathBuf| {
        let [address, bound, mixed] =
            VARIANTS.map(|(variant, _)| words(&manifest::module_path(modules, &path, variant)));
        interface::Source {
            file: path.file_name().expect("a file").to_string_lossy().into(),
            declarations: spirv::declarations(&bound),
            common: spirv::declarations(&mixed)
                .buffers
                .iter()
                .map(|b| b.binding)
                .collect(),
            modules: [address, bound, mixed],
        }
    };
    let sources: Vec<_> = manifest::shaders(glsl).into_iter().map(source).collect();
    interface::programs(&sources)
}

fn words(path: &Path) -> Vec<u32> {
    let bytes = fs::read(path)
        .unwrap_or_else(|error| panic!("{}: {error}; run tools/shaders", path.display()));
    bytes
        .chunks_exact(4)
        .map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
        .collect()
}
