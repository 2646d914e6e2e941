//! Structs lie in memory as C compilers lay them out, and those that may grow begin with their size.

use std::fmt::Write;
use std::path::Path;

use crate::compiler::compiler;
use crate::header::{HEADER, assert_compiles};
use rara_c::arrays::*;
use rara_c::bake::*;
use rara_c::camera::*;
use rara_c::camera_files::*;
use rara_c::channels::*;
use rara_c::clip::*;
use rara_c::depth::*;
use rara_c::device::*;
use rara_c::editor::*;
use rara_c::gaussians::*;
use rara_c::layer::*;
use rara_c::layer_info::*;
use rara_c::layers::*;
use rara_c::lent::*;
use rara_c::matrices::*;
use rara_c::picker::*;
use rara_c::placement::*;
use rara_c::renderer_desc::*;
use rara_c::reserve::*;
use rara_c::settings::*;
use rara_c::staging::*;
use rara_c::stats::*;
use rara_c::support::*;

/// A struct, its size, and the name and the offset of its last field.
type Layout = (&'static str, usize, &'static str, usize);

include!(concat!(env!("OUT_DIR"), "/lists.rs"));

/// The structs, and whether later versions may make each larger; the others are parts of structs, elements of arrays and what
/// is given by value.
fn layouts() -> Vec<(Layout, bool)> {
    macro_rules! layout {
        ($($name:ident $last:ident $grows:literal,)*) => {
            vec![$((
                (
                    stringify!($name),
                    size_of::<$name>(),
                    stringify!($last),
                    std::mem::offset_of!($name, $last),
                ),
                $grows,
            )),*]
        };
    }
    structs!(layout)
}

/// The structs of the header whose fields are known: what their comments say, their names and their first fields.
fn of_header(header: &str) -> Vec<(String, &str, &str)> {
    let mut found = Vec::new();
    let mut comment = String::new();
    let mut lines = header.lines();
    while let Some(line) = lines.next() {
        if let Some(said) = line.strip_prefix("//") {
            comment.push_str(said);
            continue;
        }
        if let Some(name) = line.strip_prefix("typedef struct ")
            && let Some(name) = name.strip_suffix(" {")
        {
            let mut fields = lines.by_ref().map(str::trim);
            let first = fields.find(|line| !line.starts_with("//"));
            found.push((comment.clone(), name, first.expect("a field")));
        }
        comment.clear();
    }
    found
}

#[test]
fn structs_begin_with_their_size_or_never_grow() {
    let header = std::fs::read_to_string(Path::new(HEADER).join("rara.h")).expect("a header");
    let structs = of_header(&header);
    let layouts = layouts();
    assert_eq!(structs.len(), layouts.len());
    for (comment, name, first) in structs {
        let own = layouts.iter().find(|((own, ..), _)| *own == name);
        let (_, grows) = *own.unwrap_or_else(|| panic!("{name} is in no source"));
        assert_eq!(first == "size_t struct_size;", grows, "{name}: {first}");
        assert_eq!(
            comment.ends_with(" It never grows."),
            !grows,
            "{name}: {comment}"
        );
    }
}

#[test]
fn structs_lie_in_memory_as_in_c() {
    let Some(compiler) = compiler("layouts were not compared with those of C") else {
        return;
    };
    let mut code = String::from("#include <stddef.h>\n#include \"rara.h\"\n");
    for ((name, size, last, offset), _) in layouts() {
        let _ = writeln!(
            code,
            "_Static_assert(sizeof({name}) == {size} && offsetof({name}, {last}) == {offset}, \"{name}\");"
        );
    }
    code.push_str("int main(void) { return 0; }\n");
    assert_compiles(&compiler, &["-x", "c", "-std=c11"], "layouts.c", &code);
}
