//! Makes `rara.h` of the sources, and lists the names that it has, for messages. Gives the shared library the name by which
//! programs look for it: librara.so and the version of the header, which changes when they must be compiled anew. For the tests,
//! lists what the header has: functions with arguments that are null, and structs.

use std::env;
use std::fmt::Write;
use std::fs;
use std::path::PathBuf;

fn main() {
    let mut sources = String::new();
    for entry in fs::read_dir(".").expect("this folder").flatten() {
        let path = entry.path();
        if path.extension().is_some_and(|extension| extension == "rs") {
            println!("cargo:rerun-if-changed={}", path.display());
            sources += &fs::read_to_string(path).expect("a source");
        }
    }
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("set by cargo"));
    println!("cargo:rerun-if-changed=cbindgen.toml");
    let config = cbindgen::Config::from_file("cbindgen.toml").expect("a configuration");
    let header = cbindgen::Builder::new()
        .with_config(config)
        .with_src("lib.rs"); // with its modules
    let header = header.generate().expect("C has all that the sources use");
    header.write_to_file(out.join("rara.h"));
    fs::write(out.join("lists.rs"), lists(&sources)).expect("cargo's folder");
    fs::write(out.join("names.rs"), names(&sources)).expect("cargo's folder");

    let named = sources.split("RARA_ABI_VERSION: u32 = ").nth(1);
    let version = named.and_then(|from| from.split(';').next());
    let version = version.expect("boundary.rs says the version of rara.h");
    let system = env::var("CARGO_CFG_TARGET_OS").unwrap_or_default();
    let name = match system.as_str() {
        "linux" | "freebsd" | "netbsd" | "openbsd" | "dragonfly" => {
            format!("-soname,librara.so.{version}")
        }
        "macos" | "ios" => format!("-install_name,@rpath/librara.{version}.dylib"),
        // Libraries are found there by the names of their files.
        _ => return,
    };
    println!("cargo:rustc-cdylib-link-arg=-Wl,{name}");
}

/// Macros that hand a macro of the test's what the sources declare: the functions that return a result and those that return
/// none, each with arguments, the structs with their last fields, and what fills those that go in.
fn lists(sources: &str) -> String {
    let [mut results, mut others, mut structs, mut defaults] = [const { String::new() }; 4];
    for (name, fields) in fields(sources) {
        if let Some(last) = fields.last() {
            let grows = fields.contains(&"struct_size");
            let _ = write!(structs, "{name} {last} {grows}, ");
        }
    }
    for text in sources.split("extern \"C\" fn ").skip(1) {
        let Some((name, rest)) = text.split_once('(') else {
            continue;
        };
        let (parameters, rest) = parameters(rest);
        if !is_name(name) || parameters.is_empty() {
            continue;
        }
        let mut arguments = Vec::new();
        for (index, (name, kind)) in parameters.iter().enumerate() {
            let before = index
                .checked_sub(1)
                .map_or("", |before| parameters[before].1);
            arguments.push(match stands_for_nothing(kind, sources) {
                true => nothing(kind),
                false => argument(name, kind, before, &structs),
            });
        }
        let named = parameters
            .iter()
            .filter(|(_, kind)| stands_for_nothing(kind, sources));
        let named: Vec<_> = named.map(|(name, _)| format!("\"{name}\"")).collect();
        let list = if rest.starts_with(" -> RaraResult") {
            &mut results
        } else {
            &mut others
        };
        let call = format!("{name}({})", arguments.join(", "));
        let _ = write!(list, "{call} [{}], ", named.join(", "));
        if name.ends_with("_default") {
            let filled = parameters[0].1.trim_start_matches("*mut ");
            let _ = write!(defaults, "{filled} {name}({}), ", arguments[2..].join(", "));
        }
    }
    let lists = [
        ("results", results),
        ("others", others),
        ("structs", structs),
        ("defaults", defaults),
    ];
    let list = |(name, list): &(&str, String)| {
        format!(
            "#[allow(unused_macros)] macro_rules! {name} {{ ($with:ident) => {{ $with! {{ {list} }} }} }}\n"
        )
    };
    lists.iter().map(list).collect()
}

/// Lists, as names.rs, the fields of the structs, and the functions and constants.
fn names(sources: &str) -> String {
    let [mut all, mut others] = [const { String::new() }; 2];
    for (name, fields) in fields(sources) {
        for field in fields {
            let _ = write!(all, "(\"{name}\", \"{field}\"), ");
        }
    }
    for before in ["extern \"C\" fn ", "pub const "] {
        for text in sources.split(before).skip(1) {
            let name = text.split(['(', ':']).next().filter(|name| is_name(name));
            if let Some(name) = name {
                let _ = write!(others, "\"{name}\", ");
            }
        }
    }
    format!("const FIELDS: &[(&str, &str)] = &[{all}];\nconst NAMES: &[&str] = &[{others}];\n")
}

/// The structs of the header, and the names of their fields.
fn fields(sources: &str) -> Vec<(&str, Vec<&str>)> {
    let mut found = Vec::new();
    for text in sources.split("pub struct ").skip(1) {
        let Some((name, body)) = text.split_once(" {\n") else {
            continue;
        };
        let body = body.split("\n}").next().unwrap_or_default();
        let fields = body
            .lines()
            .filter_map(|line| line.strip_prefix("    pub ")?.split(':').next());
        if is_name(name) {
            found.push((name, fields.collect()));
        }
    }
    found
}

fn is_name(text: &str) -> bool {
    text.to_ascii_lowercase().starts_with("rara")
        && text.chars().all(|c| c.is_alphanumeric() || c == '_')
}

/// The names and types of parameters, and what follows them.
fn parameters(text: &str) -> (Vec<(&str, &str)>, &str) {
    let (mut depth, mut begin, mut all) = (0, 0, Vec::new());
    for (at, letter) in text.char_indices() {
        match letter {
            '(' => depth += 1,
            ')' | ',' if depth == 0 => {
                all.extend(text[begin..at].trim().split_once(": "));
                begin = at + 1;
                if letter == ')' {
                    break;
                }
            }
            ')' => depth -= 1,
            _ => {}
        }
    }
    (all, &text[begin..])
}

/// True for pointers and for functions, of which there may be none.
fn stands_for_nothing(kind: &str, sources: &str) -> bool {
    let is_function = kind.starts_with("Option<")
        || sources.contains(&format!("type {kind} = Option<"))
        || sources.contains(&format!("type {kind} =\n    Option<"));
    kind.starts_with('*') || is_function
}

fn nothing(kind: &str) -> String {
    match kind {
        _ if kind.starts_with("*const") => "null()".into(),
        _ if kind.starts_with("*mut") => "null_mut()".into(),
        _ => "None".into(),
    }
}

/// The size of the struct before it, and else a number or what is all zero.
fn argument(name: &str, kind: &str, before: &str, structs: &str) -> String {
    match kind {
        "usize" if name.ends_with("_size") && before.contains("Rara") => {
            format!(
                "size_of::<{}>()",
                before.rsplit(' ').next().unwrap_or_default()
            )
        }
        "f64" | "f32" => "1.0".into(),
        "vk::Format" => "vk::Format::R8G8B8A8_UNORM".into(),
        "vk::Bool32" => "1".into(),
        _ if kind.starts_with("vk::") => "Default::default()".into(),
        _ if structs.contains(&format!("{kind} ")) => "std::mem::zeroed()".into(),
        _ => "1".into(),
    }
}
