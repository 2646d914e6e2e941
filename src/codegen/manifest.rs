//! A manifest says from which GLSL committed SPIR-V was compiled. It is a small file beside the modules of a shader, so
//! that changes to different shaders touch different files.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use super::VARIANTS;
use rara_base::fnv;

/// The shaders proper: files of the folder that end in a stage's name.
pub(crate) fn shaders(folder: &Path) -> Vec<PathBuf> {
    let stages = ["comp", "vert", "mesh", "frag"];
    let files = fs::read_dir(folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    let mut shaders: Vec<_> = files
        .map(|file| file.expect("the folder is readable").path())
        .filter(|path| {
            path.extension()
                .is_some_and(|e| stages.iter().any(|s| e == *s))
        })
        .collect();
    shaders.sort();
    shaders
}

/// A shader's file and all that it includes, in turn, by name.
fn sources(folder: &Path, shader: &Path) -> BTreeSet<PathBuf> {
    let mut found = BTreeSet::new();
    let mut open = vec![shader.to_path_buf()];
    while let Some(path) = open.pop() {
        let text = read(&path);
        if !found.insert(path) {
            continue;
        }
        let includes = text.lines().filter_map(|line| {
            let name = line.trim().strip_prefix("#include \"")?;
            Some(folder.join(name.split('"').next()?))
        });
        open.extend(includes);
    }
    found
}

/// The text of a shader's manifest: a hash of its sources, and one of each of its modules.
pub(crate) fn manifest(folder: &Path, shader: &Path, spirv: &Path) -> String {
    let mut glsl = fnv::NOTHING;
    for path in sources(folder, shader) {
        let name = path.strip_prefix(folder).expect("inside the folder");
        glsl = hash_with(glsl, name.to_string_lossy().as_bytes());
        glsl = hash_with(glsl, read(&path).as_bytes());
    }
    let mut text = format!("glsl {glsl:016x}\n");
    for (variant, _) in VARIANTS {
        let module = fs::read(module_path(spirv, shader, variant)).unwrap_or_default();
        text += &format!("{variant} {:016x}\n", hash_with(fnv::NOTHING, &module));
    }
    text
}

/// The faults of a folder's SPIR-V: a sentence for each shader whose sources or modules are not those that its manifest was
/// written for, and for each file that belongs to no shader.
#[cfg_attr(all(feature = "shaderc", not(test)), allow(dead_code))]
pub(crate) fn stale(folder: &Path, spirv: &Path) -> Vec<String> {
    let mut stale = Vec::new();
    let mut known = BTreeSet::new();
    for shader in shaders(folder) {
        let path = manifest_path(spirv, &shader);
        let name = file_name(&shader);
        known.extend(VARIANTS.map(|(variant, _)| module_path(spirv, &shader, variant)));
        match fs::read_to_string(&path) {
            Err(_) => stale.push(format!("{name} has no manifest")),
            Ok(text) => {
                let now = manifest(folder, &shader, spirv);
                for (was, is) in text.lines().zip(now.lines()).filter(|(was, is)| was != is) {
                    let what = is.split(' ').next().unwrap_or_default();
                    stale.push(match what {
                        "glsl" => format!("{name}, or what it includes, has changed"),
                        _ => format!("its {what} module is not that of {name} ({was})"),
                    });
                }
                if text.lines().count() != now.lines().count() {
                    stale.push(format!("the manifest of {name} is not whole"));
                }
            }
        }
        known.insert(path);
    }
    let files = fs::read_dir(spirv).map(|files| files.flatten().collect::<Vec<_>>());
    for file in files.unwrap_or_default() {
        if !known.contains(&file.path()) {
            stale.push(format!("{} belongs to no shader", file.path().display()));
        }
    }
    stale
}

/// The path of a shader's manifest.
pub(crate) fn manifest_path(spirv: &Path, shader: &Path) -> PathBuf {
    spirv.join(format!("{}.manifest", file_name(shader)))
}

/// The path of a shader's module.
pub(crate) fn module_path(spirv: &Path, shader: &Path, variant: &str) -> PathBuf {
    spirv.join(format!("{}.{variant}.spv", file_name(shader)))
}

fn file_name(path: &Path) -> String {
    let name = path.file_name().expect("a file");
    name.to_string_lossy().into_owned()
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// A hash with these bytes, and how many they are, behind it.
fn hash_with(hash: u64, bytes: &[u8]) -> u64 {
    let length = (bytes.len() as u64).to_le_bytes();
    fnv::with(hash, length.iter().chain(bytes).copied())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_committed_modules_are_those_of_the_glsl() {
        let glsl = Path::new(env!("CARGO_MANIFEST_DIR")).join("glsl");
        assert_eq!(stale(&glsl, &glsl.join("spirv")), Vec::<String>::new());
    }

    #[test]
    fn every_change_is_noticed_and_named_by_its_shader() {
        let folder = std::env::temp_dir().join(format!("rara-manifest-{}", std::process::id()));
        let spirv = folder.join("spirv");
        fs::create_dir_all(&spirv).unwrap();
        let write = |name: &str, text: &str| fs::write(folder.join(name), text).unwrap();
        write("a.comp", "#include \"shared.glsl\"\n");
        write("b.comp", "void main() {}\n");
        write("shared.glsl", "one\n");
        for shader in shaders(&folder) {
            for (variant, _) in VARIANTS {
                fs::write(module_path(&spirv, &shader, variant), variant).unwrap();
            }
            let text = manifest(&folder, &shader, &spirv);
            fs::write(manifest_path(&spirv, &shader), text).unwrap();
        }
        assert_eq!(stale(&folder, &spirv), Vec::<String>::new());
        write("shared.glsl", "two\n");
        let found = stale(&folder, &spirv);
        assert_eq!(found, ["a.comp, or what it includes, has changed"]);
        write("shared.glsl", "one\n");
        fs::write(spirv.join("b.comp.bound.spv"), "other").unwrap();
        let found = stale(&folder, &spirv);
        assert!(found.len() == 1 && found[0].contains("b.comp"), "{found:?}");
        fs::write(spirv.join("b.comp.bound.spv"), "bound").unwrap();
        fs::write(spirv.join("c.comp.bound.spv"), "").unwrap();
        assert!(stale(&folder, &spirv)[0].contains("belongs to no shader"));
        fs::remove_dir_all(&folder).unwrap();
    }
}
