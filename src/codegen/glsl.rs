//! Reads the GLSL that host and shaders share: `const` lines become Rust constants, structs become `#[repr(C)]` ones whose
//! std430 offsets are asserted.

use std::collections::HashMap;
use std::fmt::Write;

/// The constants of a GLSL text in Rust: `const float NAME = 1.0;` and `const uint NAME = 1u;`, each with the comment above
/// it as its documentation.
pub(crate) fn constants(text: &str) -> String {
    let mut out = String::new();
    let mut doc = String::new();
    for line in text.lines() {
        if let Some(comment) = line.strip_prefix("//") {
            writeln!(doc, "///{comment}").unwrap();
            continue;
        }
        if let Some((ty, name, value)) = constant(line) {
            if doc.is_empty() {
                writeln!(doc, "/// `{name}` in GLSL.").unwrap();
            }
            writeln!(out, "{doc}pub const {name}: {ty} = {value};").unwrap();
        }
        doc.clear();
    }
    out
}

/// Rust type, name and value of a line that declares a constant.
fn constant(line: &str) -> Option<(&'static str, &str, &str)> {
    for (glsl, rust, suffix) in [("const float ", "f32", ""), ("const uint ", "u32", "u")] {
        if let Some(rest) = line.strip_prefix(glsl) {
            let (name, value) = rest
                .trim_end_matches(';')
                .split_once(" = ")
                .expect("const TYPE NAME = VALUE;");
            return Some((rust, name, value.trim_end_matches(suffix)));
        }
    }
    None
}

/// The names of the constants that begin like this, in their order.
pub(crate) fn kinds<'a>(text: &'a str, prefix: &'a str) -> impl Iterator<Item = &'a str> {
    let names = text.lines().filter_map(constant).map(|(_, name, _)| name);
    names.filter(move |name| name.starts_with(prefix))
}

/// A Rust text of constants, `pub const NAME: f32 = 1.0;` and `pub const NAME: u32 = 1;`, in GLSL with its comments.
pub(crate) fn limits(rust: &str) -> String {
    let mut out = String::from(
        "// The numbers of src/base/limits.rs, written by tools/shaders.\n#ifndef RARA_LIMITS\n#define RARA_LIMITS\n\n",
    );
    for line in rust.lines() {
        if let Some(comment) = line.strip_prefix("///") {
            writeln!(out, "//{comment}").unwrap();
        } else if let Some(constant) = line.strip_prefix("pub const ") {
            let (name, rest) = constant.split_once(": ").expect("NAME: TYPE");
            let (ty, value) = rest.split_once(" = ").expect("TYPE = VALUE;");
            let value = value.trim_end_matches(';');
            let (ty, suffix) = match (ty, value.parse::<u32>()) {
                ("f32", _) => ("float", ""),
                ("u32", Ok(_)) => ("uint", "u"),
                ("u32", Err(_)) => ("uint", ""),
                _ => panic!("{name}: shaders have f32 and u32 alone"),
            };
            writeln!(out, "const {ty} {name} = {value}{suffix};").unwrap();
        }
    }
    out + "\n#endif\n"
}

/// The structs of a GLSL text as Rust. `numbers` is the text whose constants array lengths may name.
pub(crate) fn structs(text: &str, numbers: &str) -> String {
    let lengths: HashMap<&str, usize> = numbers
        .lines()
        .filter_map(constant)
        .filter_map(|(_, name, value)| Some((name, value.parse().ok()?)))
        .collect();
    let mut sizes: HashMap<String, [usize; 2]> = HashMap::new();
    let mut out = String::new();
    let (mut doc, mut name) = (String::new(), String::new());
    let (mut offset, mut largest) = (0_usize, 4);
    for line in text.lines().map(str::trim) {
        if let Some(comment) = line.strip_prefix("//") {
            writeln!(doc, "///{comment}").unwrap();
        } else if let Some(rest) = line.strip_prefix("struct ") {
            name = rest.trim_end_matches(" {").into();
            (offset, largest) = (0, 4);
            let derives = "Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable";
            write!(
                out,
                "{doc}#[repr(C)]\n#[derive({derives})]\npub struct {name} {{\n"
            )
            .unwrap();
            doc.clear();
        } else if line == "};" {
            assert!(
                offset.is_multiple_of(largest),
                "{name}: pad it to a multiple of {largest} bytes, or its array stride differs from Rust's"
            );
            let size = format!("std::mem::size_of::<{name}>() == {offset}");
            writeln!(out, "}}\nconst _: () = assert!({size});\n").unwrap();
            sizes.insert(std::mem::take(&mut name), [offset, largest]);
        } else if let Some((field, comment)) = line.split_once(';').filter(|_| !name.is_empty()) {
            let (ty, field) = field.split_once(' ').expect("TYPE NAME;");
            let (rust, [size, align]) = match ty {
                "float" => ("f32", [4, 4]),
                "uint" => ("u32", [4, 4]),
                "vec2" => ("[f32; 2]", [8, 8]),
                "vec4" => ("[f32; 4]", [16, 16]),
                "uvec4" => ("[u32; 4]", [16, 16]),
                inner => match sizes.get(inner) {
                    Some(size) => (inner, *size),
                    None => panic!("{name}.{field}: {ty} is not translated to Rust"),
                },
            };
            assert!(
                offset.is_multiple_of(align),
                "{name}.{field} is not aligned: std430 would pad before it"
            );
            let (field, rust, count) = match field.trim_end_matches(']').split_once('[') {
                Some((field, length)) => {
                    let count = match length.parse() {
                        Ok(count) => count,
                        Err(_) => *lengths.get(length).unwrap_or_else(|| {
                            panic!("{name}.{field}: no constant is called {length}")
                        }),
                    };
                    (field, format!("[{rust}; {count}]"), count)
                }
                None => (field, rust.to_string(), 1),
            };
            offset += size * count;
            largest = largest.max(align);
            let comment = comment.trim().trim_start_matches("//").trim();
            writeln!(out, "{doc}    /// {comment}\n    pub {field}: {rust},").unwrap();
            doc.clear();
        } else {
            doc.clear();
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_rust_have_suffixes_in_glsl() {
        let rust = "//! Numbers.\n\n/// How many.\npub const MOST: u32 = 32;\n/// All.\npub const ALL: u32 = MOST * MOST;\n\
                    /// A share.\npub const HALF: f32 = 1.0 / 2.0;\n";
        let glsl = "\n\n// How many.\nconst uint MOST = 32u;\n// All.\nconst uint ALL = MOST * MOST;\n\
                    // A share.\nconst float HALF = 1.0 / 2.0;\n\n#endif\n";
        assert!(limits(rust).ends_with(glsl), "{}", limits(rust));
    }

    #[test]
    fn constants_keep_their_comments_and_lose_their_suffixes() {
        let text =
            "// How many.\nconst uint MOST = 32u;\n\nconst float HALF = 1.0 / 2.0;\nuint other;\n";
        assert_eq!(
            constants(text),
            "/// How many.\npub const MOST: u32 = 32;\n/// `HALF` in GLSL.\npub const HALF: f32 = 1.0 / 2.0;\n"
        );
    }

    #[test]
    fn kinds_are_the_constants_of_a_prefix() {
        let text = "const uint OP_AND = 0u;\nconst uint SURFACE_PLANE = 0u;\nconst uint SURFACE_QUADRIC = 1u;\n";
        let names: Vec<_> = kinds(text, "SURFACE_").collect();
        assert_eq!(names, ["SURFACE_PLANE", "SURFACE_QUADRIC"]);
    }

    #[test]
    fn structs_nest_and_array_lengths_may_be_constants() {
        let text = "// A pair.\nstruct Pair {\n    vec4 low; // least\n    uvec4 high;\n};\n\
                    struct Triple {\n    vec2 all[3];\n};\n\
                    struct Whole {\n    Pair pairs[MOST];\n    float x;\n    uint pad[3];\n};\n";
        let rust = structs(text, "const uint MOST = 2u;\n");
        for expected in [
            "/// A pair.\n#[repr(C)]\n",
            "    /// least\n    pub low: [f32; 4],\n",
            "    pub pairs: [Pair; 2],\n",
            "    pub pad: [u32; 3],\n",
            "size_of::<Whole>() == 80",
            "    pub all: [[f32; 2]; 3],\n",
            "size_of::<Triple>() == 24",
        ] {
            assert!(rust.contains(expected), "{expected} is not in\n{rust}");
        }
    }

    #[test]
    #[should_panic(expected = "not aligned")]
    fn a_field_that_std430_would_move_is_refused() {
        structs("struct A {\n    uint x;\n    vec4 y;\n};\n", "");
    }

    #[test]
    #[should_panic(expected = "multiple of 16")]
    fn a_struct_whose_stride_would_differ_is_refused() {
        structs("struct A {\n    vec4 x;\n    uint y;\n};\n", "");
    }

    #[test]
    #[should_panic(expected = "no constant is called MANY")]
    fn an_unknown_length_is_refused() {
        structs("struct A {\n    vec4 x[MANY];\n};\n", "");
    }
}
