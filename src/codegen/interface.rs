//! Makes the Rust interface of each program from what its shaders declare: a struct of its buffers, one of its parameters
//! and one of its specialisation constants, all by name.
//!
//! A program is all shaders of one name in `glsl/`: `sort_scan.comp`, or `splat.vert`, `splat.mesh` and three more. Its
//! shaders may each declare a part of the interface; where they declare the same thing, they agree on it.

use std::fmt::Write;

use super::spirv::{Buffer, Constant, Declarations, Param, Scalar};

/// A shader of a program.
pub(crate) struct Source {
    /// Its file, `splat.mesh`.
    pub(crate) file: String,
    pub(crate) declarations: Declarations,
    /// The bindings of the buffers that are bound where others are reached by address.
    pub(crate) common: Vec<u32>,
    /// The modules that reach their buffers by address, by binding, and by either.
    pub(crate) modules: [Vec<u32>; 3],
}

impl Source {
    /// The name of the program, and that of the shader in it: `tiles` and `SUBGROUP_COMP` of `tiles.subgroup.comp`.
    fn names(&self) -> (&str, String) {
        let (program, shader) = self.file.split_once('.').expect("NAME.STAGE");
        (program, shader.replace('.', "_").to_uppercase())
    }

    fn stage(&self) -> &'static str {
        match self.file.rsplit('.').next() {
            Some("comp") => "COMPUTE",
            Some("vert") => "VERTEX",
            Some("mesh") => "MESH_EXT",
            _ => "FRAGMENT",
        }
    }
}

/// A Rust module for each program, of shaders that are ordered by their files.
pub(crate) fn programs(shaders: &[Source]) -> String {
    let mut out = String::new();
    for program in shaders.chunk_by(|a, b| a.names().0 == b.names().0) {
        out += &module(program);
    }
    out
}

fn module(shaders: &[Source]) -> String {
    let name = shaders[0].names().0;
    let whole = union(name, shaders);
    let files: Vec<_> = shaders
        .iter()
        .map(|s| format!("`glsl/{}`", s.file))
        .collect();
    let mut out = format!("/// {}.\npub(crate) mod {name} {{\n", files.join(", "));
    for shader in shaders {
        let uses = shader.declarations.buffers.iter().map(|buffer| {
            let Buffer { binding, name, access } = buffer;
            format!("super::BufferUse {{ name: {name:?}, binding: {binding}, access: super::BufferAccess::{access}, \
                 common: {} }}, ", shader.common.contains(binding))
        });
        writeln!(
            out,
            "/// `glsl/{}`.\npub(crate) static {}: super::Shader = super::Shader {{ name: {name:?}, file: {:?}, \
             stage: ash::vk::ShaderStageFlags::{}, buffers: &[{}], address: &{:?}, bound: &{:?}, mixed: &{:?}, \
             subgroups: {}, image: {} }};",
            shader.file,
            shader.names().1,
            shader.file,
            shader.stage(),
            uses.collect::<String>(),
            shader.modules[0],
            shader.modules[1],
            shader.modules[2],
            shader.declarations.subgroups,
            shader.declarations.image,
        )
        .unwrap();
    }
    out += &buffers(&whole.buffers);
    out += &params(&whole.params);
    out += &constants(&whole.constants);
    writeln!(
        out,
        "/// The declarations of its shaders.\n#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]\npub(crate) struct Program;\n\
         impl super::Interface for Program {{\n\
         const NAME: &'static str = {name:?};\n\
         type Buffers<B: Copy> = Buffers<B>;\ntype Params = {};\ntype Constants = {};\n}}\n{}}}",
        if whole.params.is_empty() { "()" } else { "Params" },
        if whole.constants.is_empty() { "()" } else { "Constants" },
        match shaders {
            [only] if only.stage() == "COMPUTE" => format!(
                "impl super::Compute for Program {{ const SHADER: &'static super::Shader = &{}; }}\n",
                only.names().1
            ),
            _ => String::new(),
        },
    )
    .unwrap();
    out
}

/// All that the shaders of a program declare.
fn union(name: &str, shaders: &[Source]) -> Declarations {
    let mut whole = Declarations::default();
    for shader in shaders {
        let these = &shader.declarations;
        for buffer in &these.buffers {
            merge(name, &mut whole.buffers, buffer, |b| {
                (b.binding.to_string(), b.name.clone())
            });
        }
        for constant in &these.constants {
            merge(name, &mut whole.constants, constant, |c| {
                (c.id.to_string(), c.name.clone())
            });
        }
        assert!(
            whole.params.is_empty() || these.params.is_empty() || whole.params == these.params,
            "{name}: its shaders declare other params than each other"
        );
        if whole.params.is_empty() {
            whole.params.clone_from(&these.params);
        }
    }
    whole.buffers.sort();
    whole.constants.sort_by_key(|constant| constant.id);
    for (at, buffer) in whole.buffers.iter().enumerate() {
        assert!(
            buffer.binding as usize == at,
            "{name}: no buffer has binding {at}; bindings have no gaps"
        );
    }
    whole
}

/// Adds new items; items of the same number or the same name have to be the same.
fn merge<T: Clone + PartialEq>(
    program: &str,
    all: &mut Vec<T>,
    new: &T,
    names: impl Fn(&T) -> (String, String),
) {
    let (id, name) = names(new);
    let mut same = all.iter().filter(|known| {
        let (known_id, known_name) = names(known);
        known_id == id || known_name == name
    });
    match same.next() {
        None => all.push(new.clone()),
        Some(known) => assert!(
            known == new,
            "{program}: its shaders disagree about {name} (number {id})"
        ),
    }
}

fn buffers(buffers: &[Buffer]) -> String {
    let each = |line: &dyn Fn(&Buffer) -> String| buffers.iter().map(line).collect::<String>();
    format!(
        "/// Its buffers.\n#[derive(Debug, Clone, Copy)]\npub(crate) struct Buffers<B> {{\n{}}}\n\
         impl<B: Copy> super::BufferSet<B> for Buffers<B> {{\n\
         type Program = Program;\n\
         fn list(self) -> super::BufferList<B> {{ super::BufferList::from_slice(&[{}]) }}\n}}\n",
        each(&|b| format!("pub(crate) {}: B,\n", b.name)),
        each(&|b| format!("self.{}, ", b.name)),
    )
}

fn params(params: &[Param]) -> String {
    if params.is_empty() {
        return String::new();
    }
    let mut out = String::from(
        "/// Its parameters.\n#[repr(C)]\n#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]\n\
         pub(crate) struct Params {\n",
    );
    let mut offset = 0;
    for Param {
        name,
        scalar,
        count,
        offset: at,
    } in params
    {
        assert!(
            *at == offset && *scalar != Scalar::Bool,
            "params.{name}: order the members so that nothing is padded, and make none of them a bool"
        );
        offset += 4 * count;
        let rust = match count {
            1 => scalar.rust().to_string(),
            n => format!("[{}; {n}]", scalar.rust()),
        };
        writeln!(out, "pub(crate) {name}: {rust},").unwrap();
    }
    out + "}\n"
}

fn constants(constants: &[Constant]) -> String {
    if constants.is_empty() {
        return String::new();
    }
    let mut out = String::from(
        "/// Its specialisation constants: its pipelines differ in them.\n\
         #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]\npub(crate) struct Constants {\n",
    );
    let mut words = String::new();
    for Constant { id, name, scalar } in constants {
        assert!(
            *scalar != Scalar::Float,
            "{name}: pipelines cannot differ in a float"
        );
        writeln!(out, "pub(crate) {name}: {},", scalar.rust()).unwrap();
        let word = match scalar {
            Scalar::Uint => "",
            _ => " as u32",
        };
        write!(words, "({id}, self.{name}{word}), ").unwrap();
    }
    let count = constants.len();
    out + &format!(
        "}}\nconst _: () = assert!({count} <= super::MAX_CONSTANTS);\nimpl super::ConstantSet for Constants {{\n\
         fn list(self) -> super::ConstantList {{ super::ConstantList::from_slice(&[{words}]) }}\n}}\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(file: &str, buffers: &[(u32, &str)], constants: &[(u32, &str)]) -> Source {
        let buffer = |&(binding, name): &(u32, &str)| Buffer {
            binding,
            name: name.into(),
            access: "Read",
        };
        let constant = |&(id, name): &(u32, &str)| Constant {
            id,
            name: name.into(),
            scalar: Scalar::Uint,
        };
        Source {
            file: file.into(),
            declarations: Declarations {
                buffers: buffers.iter().map(buffer).collect(),
                params: Vec::new(),
                constants: constants.iter().map(constant).collect(),
                subgroups: false,
                image: false,
                workgroup: [0; 3],
            },
            common: Vec::new(),
            modules: [vec![], vec![], vec![]],
        }
    }

    #[test]
    fn shaders_of_a_name_are_one_program() {
        let text = programs(&[
            source("splat.frag", &[(1, "cut_records")], &[(0, "mode")]),
            source("splat.vert", &[(0, "frame")], &[(5, "depth")]),
            source("tiles.subgroup.comp", &[(0, "frame")], &[]),
        ]);
        for expected in [
            "pub(crate) mod splat {",
            "pub(crate) static FRAG:",
            "pub(crate) static VERT:",
            "&[self.frame, self.cut_records, ]",
            "&[(0, self.mode), (5, self.depth), ]",
            "pub(crate) static SUBGROUP_COMP:",
            "type Constants = ();",
            "const SHADER: &'static super::Shader = &SUBGROUP_COMP;",
        ] {
            assert!(text.contains(expected), "{expected} is not in\n{text}");
        }
    }

    #[test]
    #[should_panic(expected = "disagree about depth")]
    fn one_number_means_one_thing_in_a_program() {
        let a = source("a.frag", &[], &[(5, "rows")]);
        let b = source("a.vert", &[], &[(5, "depth")]);
        programs(&[a, b]);
    }

    #[test]
    #[should_panic(expected = "no gaps")]
    fn bindings_without_a_buffer_are_refused() {
        programs(&[source("a.comp", &[(0, "frame"), (2, "order")], &[])]);
    }
}
