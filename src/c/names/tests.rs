//! Whatever rara says of its own items has a name in C.

use std::path::Path;

use super::*;
use crate::boundary::*;
use crate::tests::assert_fails;

#[test]
fn paths_of_rust_become_names_of_the_header() {
    for (rust, c) in [
        ("RendererDesc::samples", "RaraRendererDesc.samples"),
        (
            "RendererDesc::expected_depth",
            "RaraRendererDesc.expected_depth_format",
        ),
        (
            "ExpectedDepthDesc::format",
            "RaraRendererDesc.expected_depth_format",
        ),
        ("Renderer::draw", "rara_renderer_draw"),
        ("gpu::check", "rara_check"),
        ("ColorSpace::Linear", "RARA_COLOR_SPACE_LINEAR"),
        (
            "VkApplicationInfo::apiVersion",
            "VkApplicationInfo.apiVersion",
        ),
        ("Nobody::knows", "Nobody::knows"),
        ("a::b::c", "a::b::c"),
        ("::", "::"),
        ("ä::ö", "ä::ö"),
    ] {
        let sentence = |name| format!("give ({name}), not {name}: ä");
        assert_eq!(in_c(&sentence(rust)), sentence(c));
    }
    let failed = guard(|| invalid("Cut::prepare comes first"));
    assert_fails(failed, RARA_ERROR_INVALID, "rara_cut_prepare comes first");
}

/// The literals of a source that are sentences.
fn sentences(source: &str) -> Vec<&str> {
    let (mut rest, mut found) = (source, Vec::new());
    while let Some(first) = rest.chars().next() {
        let length = match first {
            '/' if rest.starts_with("//") => rest.find('\n'),
            'r' if rest.starts_with("r#\"") => rest.find("\"#").map(|at| at + 2),
            '\'' if rest.starts_with("'\"'") => Some(3),
            '"' => {
                let mut is_escaped = false;
                let end = rest[1..].find(|letter| {
                    let ends = letter == '"' && !is_escaped;
                    is_escaped = letter == '\\' && !is_escaped;
                    ends
                });
                let end = 1 + end.expect("a literal ends");
                found.push(&rest[1..end]);
                Some(end + 1)
            }
            _ => Some(first.len_utf8()),
        };
        rest = &rest[length.unwrap_or(rest.len())..];
    }
    found.retain(|literal| literal.contains(' '));
    found
}

/// Calls a function with each source of a folder whose messages hosts in C get.
fn each_source(folder: &Path, seen: &mut impl FnMut(&Path, &str)) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let is_left_out = ["tests", "cli", "codegen", "lab", "target", "view"];
        if is_left_out.contains(&&*name) {
            continue;
        }
        if path.is_dir() {
            each_source(&path, seen);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            let source = std::fs::read_to_string(&path).expect("a source");
            let code = source.split("\n#[cfg(test)]\nmod tests {").next();
            seen(&path, code.expect("all before the tests"));
        }
    }
}

#[test]
fn every_path_in_a_message_has_a_name_in_c() {
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).parent();
    let mut count = 0;
    each_source(sources.expect("src"), &mut |path, source| {
        for sentence in sentences(source) {
            // What is written in place of {} is a value's name, as codes_are_the_constants_of_the_header compares them all.
            let sentence = sentence.replace("::{", " {");
            let said = in_c(&sentence);
            assert!(!said.contains("::"), "{}: {said}", path.display());
            count += usize::from(said != sentence);
        }
    });
    assert!(count > 10, "{count} sentences with paths");
}
