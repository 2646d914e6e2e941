//! Turns `glsl/` into what the crate needs: constants (`limits.glsl`), structs (`types.glsl`) and shaders.
//!
//! Every shader is compiled twice from one source: buffers behind device addresses, and bound buffers that the
//! validation layer can watch. With the feature `shaderc` the GLSL is compiled here, warnings as errors. Without it
//! the SPIR-V committed in `glsl/spirv/` is used, so that nobody waits for a C++ compiler to be compiled in order to
//! see a picture; `glsl/spirv/sources` says of which GLSL it is, and a difference is an error.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{env, fs};

/// The two ways a shader reaches its buffers: file ending and preprocessor definition.
const VARIANTS: [(&str, Option<&str>); 2] = [("address", None), ("bound", Some("RARA_BOUND"))];

fn main() {
    println!("cargo::rerun-if-changed=glsl");
    println!("cargo::rerun-if-changed=build.rs");
    let out = PathBuf::from(env::var("OUT_DIR").expect("cargo sets OUT_DIR"));
    let write =
        |name: &str, text: String| fs::write(out.join(name), text).expect("OUT_DIR is writable");
    write("limits.rs", limits(&read("glsl/limits.glsl")));
    let shared = read("glsl/types.glsl");
    write("types.rs", types(&shared) + &limits(&shared));
    let spirv = out.join("spirv");
    fs::create_dir_all(&spirv).expect("OUT_DIR is writable");
    provide_spirv(&spirv);
    write("shaders.rs", shaders(&spirv));
}

fn read(path: &str) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// All files of `glsl/` itself, by name.
fn glsl_files() -> Vec<PathBuf> {
    let files = fs::read_dir("glsl")
        .expect("glsl/")
        .map(|entry| entry.expect("glsl/").path());
    let mut files: Vec<_> = files.filter(|path| path.is_file()).collect();
    files.sort();
    files
}

/// The shaders proper: files that end in a stage's name.
fn entries() -> Vec<PathBuf> {
    let stages = ["comp", "vert", "mesh", "frag"];
    let is_entry = |path: &PathBuf| {
        path.extension()
            .is_some_and(|e| stages.iter().any(|s| e == *s))
    };
    glsl_files().into_iter().filter(is_entry).collect()
}

/// FNV-1a over names and contents of all GLSL: which sources a set of SPIR-V was compiled from.
fn fingerprint() -> String {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    for path in glsl_files() {
        let name = path
            .file_name()
            .expect("a file")
            .to_string_lossy()
            .into_owned();
        for byte in name
            .bytes()
            .chain(fs::read(&path).expect("glsl/ is readable"))
        {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
    format!("{hash:016x}\n")
}

#[cfg(not(feature = "shaderc"))]
fn provide_spirv(to: &Path) {
    assert!(
        fs::read_to_string("glsl/spirv/sources").unwrap_or_default() == fingerprint(),
        "glsl/ has changed since glsl/spirv/ was compiled from it: run tools/shaders, or build with --features shaderc"
    );
    for file in fs::read_dir("glsl/spirv").expect("glsl/spirv/") {
        let file = file.expect("glsl/spirv/").path();
        fs::copy(&file, to.join(file.file_name().expect("a file"))).expect("OUT_DIR is writable");
    }
}

#[cfg(feature = "shaderc")]
fn provide_spirv(to: &Path) {
    use shaderc::{
        CompileOptions, Compiler, EnvVersion, OptimizationLevel, ResolvedInclude, ShaderKind,
        TargetEnv,
    };
    // Modules whose GLSL is gone must not be taken for current ones.
    fs::remove_dir_all(to).expect("OUT_DIR is writable");
    fs::create_dir_all(to).expect("OUT_DIR is writable");
    let compiler = Compiler::new().expect("shaderc starts");
    for path in entries() {
        let kind = match path.extension().and_then(|e| e.to_str()) {
            Some("comp") => ShaderKind::Compute,
            Some("vert") => ShaderKind::Vertex,
            Some("mesh") => ShaderKind::Mesh,
            _ => ShaderKind::Fragment,
        };
        let name = path.to_string_lossy();
        for (variant, define) in VARIANTS {
            let mut options = CompileOptions::new().expect("shaderc options");
            // Not 1.3: glslang would write LocalSizeId, which needs maintenance4 and complicates reflection.
            options.set_target_env(TargetEnv::Vulkan, EnvVersion::Vulkan1_2 as u32);
            // The bound variant serves the validation layer and reflection: it keeps names and every declared buffer.
            let optimise = if define.is_some() {
                OptimizationLevel::Zero
            } else {
                OptimizationLevel::Performance
            };
            options.set_optimization_level(optimise);
            options.set_warnings_as_errors();
            if let Some(define) = define {
                options.add_macro_definition(define, Some("1"));
            }
            options.set_include_callback(|file, _, _, _| {
                let content = fs::read_to_string(Path::new("glsl").join(file))
                    .map_err(|e| format!("{file}: {e}"))?;
                Ok(ResolvedInclude {
                    resolved_name: file.into(),
                    content,
                })
            });
            match compiler.compile_into_spirv(&read(&name), kind, &name, "main", Some(&options)) {
                Ok(artifact) => {
                    let file = path.file_name().expect("a file").to_string_lossy();
                    fs::write(
                        to.join(format!("{file}.{variant}.spv")),
                        artifact.as_binary_u8(),
                    )
                    .expect("OUT_DIR is writable");
                }
                Err(error) => {
                    println!("cargo::error={}", error.to_string().replace('\n', " | "));
                    eprintln!("{error}");
                    std::process::exit(1);
                }
            }
        }
    }
    fs::write(to.join("sources"), fingerprint()).expect("OUT_DIR is writable");
    // tools/shaders asks for a copy, to commit it or to compare it with what is committed.
    println!("cargo::rerun-if-env-changed=RARA_SPIRV_DIR");
    if let Ok(copy) = env::var("RARA_SPIRV_DIR") {
        for file in fs::read_dir(to).expect("OUT_DIR is readable") {
            let file = file.expect("OUT_DIR is readable");
            fs::copy(file.path(), Path::new(&copy).join(file.file_name()))
                .expect("RARA_SPIRV_DIR is writable");
        }
    }
}

/// `const float NAME = 1.0;` and `const uint NAME = 1u;`, each with the comment above it as its documentation.
fn limits(text: &str) -> String {
    let mut out = String::new();
    let mut doc = String::new();
    for line in text.lines() {
        if let Some(comment) = line.strip_prefix("//") {
            writeln!(doc, "///{comment}").unwrap();
            continue;
        }
        for (glsl, rust, suffix) in [("const float ", "f32", ""), ("const uint ", "u32", "u")] {
            if let Some(rest) = line.strip_prefix(glsl) {
                let (name, value) = rest
                    .trim_end_matches(';')
                    .split_once(" = ")
                    .expect("const TYPE NAME = VALUE;");
                let doc = if doc.is_empty() {
                    format!("/// `{name}` in GLSL.\n")
                } else {
                    doc.clone()
                };
                writeln!(
                    out,
                    "{doc}pub const {name}: {rust} = {};",
                    value.trim_end_matches(suffix)
                )
                .unwrap();
            }
        }
        doc.clear();
    }
    out
}

/// The structs of `types.glsl` as `#[repr(C)]` Rust, with the std430 offsets asserted at compile time.
fn types(text: &str) -> String {
    let mut out = String::new();
    let (mut doc, mut name, mut offset) = (String::new(), String::new(), 0_usize);
    for line in text.lines().map(str::trim) {
        if let Some(comment) = line.strip_prefix("//") {
            writeln!(doc, "///{comment}").unwrap();
        } else if let Some(rest) = line.strip_prefix("struct ") {
            name = rest.trim_end_matches(" {").into();
            offset = 0;
            let derives = "Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable";
            writeln!(
                out,
                "{doc}#[repr(C)]\n#[derive({derives})]\npub struct {name} {{"
            )
            .unwrap();
            doc.clear();
        } else if line == "};" {
            assert!(
                offset % 16 == 0,
                "{name}: pad it to a multiple of 16 bytes, or its array stride differs from Rust's"
            );
            let size = format!("std::mem::size_of::<{name}>() == {offset}");
            writeln!(out, "}}\nconst _: () = assert!({size});\n").unwrap();
            name.clear();
        } else if let Some((field, comment)) = line.split_once(';').filter(|_| !name.is_empty()) {
            let (ty, field) = field.split_once(' ').expect("TYPE NAME;");
            let (rust, size) = match ty {
                "float" => ("f32", 4),
                "uint" => ("u32", 4),
                "vec4" => ("[f32; 4]", 16),
                "uvec4" => ("[u32; 4]", 16),
                _ => panic!("types.glsl: {name}.{field}: build.rs does not translate {ty}"),
            };
            assert!(
                offset % size == 0,
                "types.glsl: {name}.{field} is not aligned: std430 would pad before it"
            );
            let (field, rust, count) = match field.trim_end_matches(']').split_once('[') {
                Some((field, "MAX_CLIP_PLANES")) => (
                    field,
                    format!("[{rust}; crate::limits::MAX_CLIP_PLANES as usize]"),
                    32,
                ),
                Some((field, n)) => (
                    field,
                    format!("[{rust}; {n}]"),
                    n.parse().expect("a literal array length"),
                ),
                None => (field, rust.to_string(), 1),
            };
            offset += size * count;
            let comment = comment.trim().trim_start_matches("//").trim();
            writeln!(out, "{doc}    /// {comment}\n    pub {field}: {rust},").unwrap();
            doc.clear();
        } else {
            doc.clear();
        }
    }
    out
}

/// A `Shader` constant for every entry, e.g. `CLASSIFY_COMP`.
fn shaders(spirv: &Path) -> String {
    let mut out = String::new();
    for path in entries() {
        let file = path
            .file_name()
            .expect("a file")
            .to_string_lossy()
            .into_owned();
        let (name, stage) = file.split_once('.').expect("NAME.STAGE");
        let stage_flag = match stage {
            "comp" => "COMPUTE",
            "vert" => "VERTEX",
            "mesh" => "MESH_EXT",
            _ => "FRAGMENT",
        };
        let [address, bound] =
            VARIANTS.map(|(variant, _)| words(&spirv.join(format!("{file}.{variant}.spv"))));
        let mut uses = String::new();
        for (binding, name, access) in buffers(&bound) {
            write!(uses, "BufferUse {{ name: {name:?}, binding: {binding}, access: BufferAccess::{access} }}, ").unwrap();
        }
        let constant = format!("{name}_{stage}").to_uppercase();
        write!(
            out,
            "/// `glsl/{file}`.\npub(crate) static {constant}: Shader = Shader {{ name: {name:?}, stage: ash::vk::ShaderStageFlags::{stage_flag}, \
             buffers: &[{uses}],\n address: &{address:?},\n bound: &{bound:?} }};\n"
        )
        .unwrap();
    }
    out
}

fn words(path: &Path) -> Vec<u32> {
    let bytes = fs::read(path)
        .unwrap_or_else(|error| panic!("{}: {error}; run tools/shaders", path.display()));
    bytes
        .chunks_exact(4)
        .map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
        .collect()
}

/// Reads from SPIR-V which storage buffers a module binds, their names, and whether they are read, written or both:
/// the GLSL's `readonly` and `writeonly` are the pass's only declaration, barriers are derived from them.
fn buffers(words: &[u32]) -> Vec<(u32, String, &'static str)> {
    const OP_NAME: u32 = 5;
    const OP_DECORATE: u32 = 71;
    const OP_MEMBER_DECORATE: u32 = 72;
    const OP_TYPE_POINTER: u32 = 32;
    const OP_VARIABLE: u32 = 59;
    const BINDING: u32 = 33;
    const NON_WRITABLE: u32 = 24;
    const NON_READABLE: u32 = 25;
    const STORAGE_BUFFER: u32 = 12;
    let bound = words[3] as usize;
    let (mut names, mut bindings) = (vec![String::new(); bound], vec![None; bound]);
    let (mut flags, mut pointees) = (vec![0_u32; bound], vec![0_usize; bound]);
    let mut found = Vec::new();
    let mut rest = &words[5..];
    while let Some(&head) = rest.first() {
        let (instruction, tail) = rest.split_at((head >> 16) as usize);
        rest = tail;
        let id = |index: usize| instruction[index] as usize;
        match head & 0xffff {
            OP_NAME => {
                let bytes: Vec<u8> = instruction[2..]
                    .iter()
                    .flat_map(|w| w.to_le_bytes())
                    .take_while(|b| *b != 0)
                    .collect();
                names[id(1)] = String::from_utf8(bytes).expect("names are UTF-8");
            }
            OP_DECORATE if instruction[2] == BINDING => bindings[id(1)] = Some(instruction[3]),
            OP_DECORATE if instruction[2] == NON_WRITABLE => flags[id(1)] |= 1,
            OP_DECORATE if instruction[2] == NON_READABLE => flags[id(1)] |= 2,
            OP_MEMBER_DECORATE if instruction[3] == NON_WRITABLE => flags[id(1)] |= 1,
            OP_MEMBER_DECORATE if instruction[3] == NON_READABLE => flags[id(1)] |= 2,
            OP_TYPE_POINTER => pointees[id(1)] = id(3),
            OP_VARIABLE if instruction[3] == STORAGE_BUFFER => found.push((id(2), pointees[id(1)])),
            _ => {}
        }
    }
    let describe = |&(variable, block): &(usize, usize)| {
        let access = match flags[variable] | flags[block] {
            1 => "Read",
            2 => "Write",
            _ => "ReadWrite",
        };
        (
            bindings[variable].expect("every buffer has a binding"),
            names[variable].clone(),
            access,
        )
    };
    let mut buffers: Vec<_> = found.iter().map(describe).collect();
    buffers.sort();
    buffers
}
