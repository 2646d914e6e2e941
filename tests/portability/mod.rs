//! Whether the shaders can be had where there is no Vulkan: the committed SPIR-V is translated by spirv-cross to the
//! languages of Metal and of Direct3D 12, so that a change of GLSL that neither can express is seen when it is made.
//!
//! Nothing is drawn. A text has to have what a host binds, and to keep the arithmetic exact that has to be; glslang, which
//! reads Direct3D's language too, has to take it. No free compiler reads Metal's.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use crate::common::folder::Folder;
use crate::spirv::{self, Constant};

/// The programs that translate, and that read what is translated.
const SPIRV_CROSS: &str = "spirv-cross";
const GLSLANG: &str = "glslangValidator";

/// Metal 2.1 is the first with the subgroup operations of `*.subgroup.comp`.
const TO_METAL: [&str; 3] = ["--msl", "--msl-version", "20100"];

/// Shader model 6.0 is the first with subgroup operations, and the last whose loads from buffers glslang reads.
const TO_DIRECT3D: [&str; 3] = ["--hlsl", "--shader-model", "60"];

/// The shaders that cannot be had in Direct3D's language, and how spirv-cross refuses them. Each has a sibling without
/// `.subgroup`, which does the same and can.
///
/// `radix_scatter` counts the keys of each subgroup by its number within the workgroup. That language has no such number, and
/// promises no order of invocations from which to compute it. Of the views of a scope it knows since shader model 6.1.
const NOT_IN_DIRECT3D: [(&str, &str); 3] = [
    ("radix_scatter.subgroup.comp", "Unsupported builtin in HLSL"),
    ("composite.multiview.vert", "View Index input"),
    ("motion.multiview.vert", "View Index input"),
];

/// The modules by address that cannot be had in Metal's language, and how spirv-cross refuses them; bound, all can.
///
/// `radix_ties` and `cutoff` count in device memory by atomics, which spirv-cross writes only of bound buffers.
const NOT_IN_METAL_BY_ADDRESS: [(&str, &str); 2] = [
    (
        "radix_ties.comp",
        "No backing variable for atomic operation",
    ),
    ("cutoff.comp", "No backing variable for atomic operation"),
];

/// A committed module.
struct Module {
    /// Its shader, `sort_scan.comp`.
    shader: String,
    path: PathBuf,
    words: Vec<u32>,
}

impl Module {
    /// All that reach their buffers in this way, by shader.
    fn all(variant: &str) -> Vec<Self> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("glsl/spirv");
        let ending = format!(".{variant}.spv");
        let mut all = Vec::new();
        for file in fs::read_dir(folder).expect("the committed modules") {
            let path = file.expect("a file").path();
            let name = path.file_name().expect("a name").to_string_lossy();
            if let Some(shader) = name.strip_suffix(&ending) {
                all.push(Self {
                    shader: shader.to_owned(),
                    words: words(&path),
                    path,
                });
            }
        }
        assert!(all.len() > 40, "only {} modules {ending}", all.len());
        all.sort_by(|a, b| a.shader.cmp(&b.shader));
        all
    }

    /// All but mesh shaders and what is drawn behind them: spirv-cross writes what is none of those without a word, and quads
    /// draw the same.
    fn without_meshes(variant: &str) -> Vec<Self> {
        let mut all = Self::all(variant);
        let is_meshes = |module: &Self| module.is("mesh") || module.is("mesh.frag");
        let quads = |mesh: &str| {
            let program = mesh.split('.').next().expect("a name");
            let sibling = |stage| format!("{program}.{stage}");
            let has = |file: String| all.iter().any(|module| module.shader == file);
            has(sibling("vert")) && has(sibling("frag"))
        };
        for module in all.iter().filter(|module| is_meshes(module)) {
            assert!(quads(&module.shader), "{} has no quads", module.shader);
        }
        all.retain(|module| !is_meshes(module));
        all
    }

    fn is(&self, stage: &str) -> bool {
        self.shader.ends_with(&format!(".{stage}"))
    }

    /// The text in another language, or what spirv-cross says instead.
    fn translated(&self, language: &[&str]) -> Result<String, String> {
        let mut command = Command::new(SPIRV_CROSS);
        let output = command.args(language).arg(&self.path).output();
        let output = output.expect("spirv-cross starts");
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        if output.status.success() {
            Ok(text(&output.stdout))
        } else {
            Err(text(&output.stderr))
        }
    }
}

#[test]
fn bound_modules_know_no_addresses() {
    for module in Module::all("bound") {
        assert!(!has_addresses(&module.words), "{}", module.shader);
    }
    // Seen nowhere, they might as well be overlooked.
    for module in Module::all("address") {
        assert!(has_addresses(&module.words), "{}", module.shader);
    }
}

#[test]
fn shaders_translate_to_metals_language() {
    if !is_there(SPIRV_CROSS, "no shader was translated to Metal's language") {
        return;
    }
    for variant in ["bound", "address"] {
        for module in Module::without_meshes(variant) {
            let shader = &module.shader;
            let text = module.translated(&TO_METAL);
            let mut refused = NOT_IN_METAL_BY_ADDRESS.iter();
            let refused = refused.find(|(name, _)| variant == "address" && *name == *shader);
            if let Some((_, why)) = refused {
                let said = text.expect_err("it is no exception any more");
                assert!(said.contains(why), "{shader} {variant}: {said}");
                continue;
            }
            let text = text.unwrap_or_else(|said| panic!("{shader} {variant}: {said}"));
            let main = text.lines().find(|line| line.contains(" main0("));
            let main = main.unwrap_or_else(|| panic!("{shader} {variant}: no entry point"));
            if variant == "bound" {
                let declared = spirv::declarations(&module.words);
                for buffer in declared.buffers {
                    let bound = format!("& {} [[buffer(", buffer.name);
                    let used = is_used(&module.words, &buffer.name);
                    assert_eq!(main.contains(&bound), used, "{shader}: {bound} in {main}");
                }
                for Constant { id, name, .. } in declared.constants {
                    // A macro decides the length of an array.
                    let macro_of = format!("#define SPIRV_CROSS_CONSTANT_ID_{id} ");
                    let defined = text.contains(&format!("[[function_constant({id})]]"));
                    assert!(defined || text.contains(&macro_of), "{shader}: no {name}");
                }
            } else {
                // Addresses are in the push constants, and these modules have lost their names.
                assert!(main.contains("[[buffer(0)]]"), "{shader}: {main}");
            }
            let exact = ["spvFAdd(", "spvFSub(", "spvFMul("];
            let exact = exact.iter().any(|function| text.contains(function));
            assert_eq!(exact, is_exact(&module.words), "{shader} {variant}");
        }
    }
}

#[test]
fn bound_shaders_translate_to_direct3ds_language() {
    if !is_there(
        SPIRV_CROSS,
        "no shader was translated to Direct3D's language",
    ) {
        return;
    }
    let compiles = is_there(GLSLANG, "nothing read what is in Direct3D's language");
    let folder = Folder::new("portability");
    let (mut done, mut refused) = (Vec::new(), Vec::new());
    for module in Module::without_meshes("bound") {
        let shader = &module.shader;
        let exception = NOT_IN_DIRECT3D.iter().find(|(name, _)| name == shader);
        let text = match (module.translated(&TO_DIRECT3D), exception) {
            (Ok(text), None) => text,
            (Err(said), Some((_, why))) if said.contains(why) => {
                refused.push(shader.replace(".subgroup", "").replace(".multiview", ""));
                continue;
            }
            (Ok(_), Some(_)) => panic!("{shader} does translate: strike it from NOT_IN_DIRECT3D"),
            (Err(said), _) => panic!("{shader}: {said}"),
        };
        assert!(text.contains(" main("), "{shader}: no entry point");
        let declared = spirv::declarations(&module.words);
        for buffer in &declared.buffers {
            // Their registers have the numbers of the bindings.
            let kind = if buffer.access == "Read" { 't' } else { 'u' };
            let bound = format!("{} : register({kind}{}, ", buffer.name, buffer.binding);
            assert!(text.contains(&bound), "{shader}: no {bound}");
        }
        for constant in &declared.constants {
            let defined = format!("#define SPIRV_CROSS_CONSTANT_ID_{} ", constant.id);
            assert!(text.contains(&defined), "{shader}: no {defined}");
        }
        // The text alone can tell: what glslang makes of it has lost this in places.
        let exact = text.contains("precise float");
        assert_eq!(exact, is_exact(&module.words), "{shader}");
        if compiles {
            let words = compiled(&text, &module, &folder);
            let found = spirv::declarations(&words).workgroup;
            assert_eq!(found, declared.workgroup, "{shader}");
        }
        done.push(module.shader);
    }
    assert_eq!(refused.len(), NOT_IN_DIRECT3D.len(), "exceptions are gone");
    for sibling in refused {
        assert!(done.contains(&sibling), "{sibling} does not stand in");
    }
}

/// False, with a message, where there is no such program.
fn is_there(program: &str, what: &str) -> bool {
    let there = Command::new(program).arg("--help").output().is_ok();
    if !there {
        eprintln!("SKIPPED: NO {program}: {what}; tools/setup test installs it");
    }
    there
}

/// The SPIR-V that Direct3D's language compiles to.
fn compiled(text: &str, of: &Module, folder: &Folder) -> Vec<u32> {
    let source = folder.join(format!("{}.hlsl", of.shader));
    let module = folder.join(format!("{}.spv", of.shader));
    fs::write(&source, text).expect("the folder is writable");
    let stage = of.shader.rsplit('.').next().expect("a stage");
    let mut command = Command::new(GLSLANG);
    command.args(["-D", "-V", "--target-env", "vulkan1.2", "-e", "main", "-S"]);
    let output = command.arg(stage).arg("-o").arg(&module).arg(&source);
    let output = output.output().expect("glslang starts");
    let said = String::from_utf8_lossy(&output.stdout); // glslang complains here
    assert!(output.status.success(), "{}: {said}", of.shader);
    words(&module)
}

fn words(path: &Path) -> Vec<u32> {
    let bytes = fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    bytemuck::pod_collect_to_vec(&bytes)
}

/// True if a module reaches into its buffer of that name. Metal's language names no others.
fn is_used(module: &[u32], name: &str) -> bool {
    let named = |id: u32| {
        let mut all = spirv::instructions(module);
        all.any(|(code, words)| code == 5 && words[1] == id && spirv::text(&words[2..]) == name) // OpName
    };
    let reached = |id: u32| {
        let mut all = spirv::instructions(module);
        all.any(|(code, words)| code == 65 && words[3] == id) // OpAccessChain
    };
    // OpVariable, StorageBuffer
    spirv::instructions(module)
        .any(|(code, words)| code == 59 && words[3] == 12 && named(words[2]) && reached(words[2]))
}

/// True if a module can follow addresses, or is given any.
fn has_addresses(module: &[u32]) -> bool {
    spirv::instructions(module).any(|(code, words)| match code {
        17 => words[1] == 5347, // OpCapability, PhysicalStorageBufferAddresses
        6 => spirv::text(&words[3..]) == "address", // OpMemberName
        _ => false,
    })
}

/// True if some of its arithmetic must not be contracted or reordered, as two floats that stand for one number need.
fn is_exact(module: &[u32]) -> bool {
    // OpDecorate, NoContraction
    spirv::instructions(module).any(|(code, words)| code == 71 && words[2] == 42)
}
