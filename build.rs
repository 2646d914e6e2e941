//! Turns `glsl/` into what the crate needs: Rust constants from `limits.glsl` (and more to come).

use std::fmt::Write;
use std::{env, fs, path::Path};

fn main() {
    println!("cargo::rerun-if-changed=glsl");
    let out = env::var("OUT_DIR").expect("cargo sets OUT_DIR");
    let text = fs::read_to_string("glsl/limits.glsl").expect("glsl/limits.glsl");
    fs::write(Path::new(&out).join("limits.rs"), limits(&text)).expect("OUT_DIR is writable");
}

/// `const float NAME = 1.0;` and `const uint NAME = 1u;`, each with the comment above it as its documentation.
fn limits(text: &str) -> String {
    let mut out = String::new();
    let mut doc = String::new();
    for line in text.lines() {
        if let Some(comment) = line.strip_prefix("//") {
            writeln!(doc, "///{comment}").unwrap();
        } else if let Some(rest) = line.strip_prefix("const float ") {
            let (name, value) = rest
                .trim_end_matches(';')
                .split_once(" = ")
                .expect("const float NAME = VALUE;");
            writeln!(out, "{doc}pub const {name}: f32 = {value};").unwrap();
            doc.clear();
        } else if let Some(rest) = line.strip_prefix("const uint ") {
            let (name, value) = rest
                .trim_end_matches(';')
                .split_once(" = ")
                .expect("const uint NAME = VALUEu;");
            writeln!(
                out,
                "{doc}pub const {name}: u32 = {};",
                value.trim_end_matches('u')
            )
            .unwrap();
            doc.clear();
        } else {
            doc.clear();
        }
    }
    out
}
