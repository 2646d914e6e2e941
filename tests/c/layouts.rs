//! Structs lie in memory as C compilers lay them out, and those that may grow begin with their size.

use std::fmt::Write;

use crate::compiler::{compiler, root};
use crate::header::assert_compiles;
use rara_c::arrays::*;
use rara_c::bake::*;
use rara_c::camera::*;
use rara_c::camera_files::*;
use rara_c::channels::*;
use rara_c::clip::*;
use rara_c::depth::*;
use rara_c::device::*;
use rara_c::gaussians::*;
use rara_c::layer::*;
use rara_c::layer_info::*;
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

macro_rules! layouts {
    ($($name:ident: $last:ident),* $(,)?) => {
        [$((
            stringify!($name),
            size_of::<$name>(),
            stringify!($last),
            std::mem::offset_of!($name, $last),
        )),*]
    };
}

/// The same of structs whose size comes first, which is checked when this is compiled.
macro_rules! growing {
    ($($name:ident: $last:ident),* $(,)?) => {{
        $(const _: () = assert!(std::mem::offset_of!($name, struct_size) == 0);)*
        layouts![$($name: $last),*]
    }};
}

/// Structs that later versions may make larger.
fn growing() -> Vec<Layout> {
    growing![
        RaraAdoptDesc: allocator_user,
        RaraBakeCounts: children,
        RaraBakeSettings: leave,
        RaraChannels: value_count,
        RaraClip: near_cut,
        RaraDepthDesc: map,
        RaraDepthImage: y,
        RaraDeviceMemory: pipeline_count,
        RaraFrameLimits: settings_count,
        RaraFrameStats: skipped,
        RaraGaussianArrays: antialiased,
        RaraGaussiansInfo: antialiased,
        RaraHostView: depth_scale,
        RaraLayer: region,
        RaraLayerInfo: count,
        RaraLayerState: visible,
        RaraMemory: user,
        RaraMemoryRequest: memory_use,
        RaraNdc: reversed,
        RaraRendererDesc: color_space,
        RaraSettings: transmittance_min,
        RaraStaging: size,
        RaraSupport: full_subgroups,
    ]
    .into()
}

/// Parts of structs, elements of arrays and what is given by value: they stay as they are.
fn fixed() -> Vec<Layout> {
    layouts![
        RaraCamera: rotation,
        RaraDepthMap: reversed,
        RaraNamedCamera: camera,
        RaraPassTime: ms,
        RaraPick: alpha,
        RaraPickTicket: request,
        RaraPlacement: scale,
        RaraPlane: offset,
    ]
    .into()
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
    let header = std::fs::read_to_string(root().join("src/c/rara.h")).expect("a header");
    let structs = of_header(&header);
    let (growing, fixed) = (growing(), fixed());
    assert_eq!(structs.len(), growing.len() + fixed.len());
    for (comment, name, first) in structs {
        let grows = growing.iter().any(|(own, ..)| *own == name);
        assert!(
            grows || fixed.iter().any(|(own, ..)| *own == name),
            "{name} is in neither list above"
        );
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
    for (name, size, last, offset) in growing().into_iter().chain(fixed()) {
        let _ = writeln!(
            code,
            "_Static_assert(sizeof({name}) == {size} && offsetof({name}, {last}) == {offset}, \"{name}\");"
        );
    }
    code.push_str("int main(void) { return 0; }\n");
    assert_compiles(&compiler, &["-x", "c", "-std=c11"], "layouts.c", &code);
}
