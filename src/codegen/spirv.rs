//! Reads from SPIR-V what a shader declares: its storage buffers, the members of its push constants and its specialisation
//! constants, by the names that the GLSL gives them. The module is compiled without optimisation, which keeps all names.

/// The declarations of a shader.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Declarations {
    /// The storage buffers, by ascending binding.
    pub(crate) buffers: Vec<Buffer>,
    /// The members of the push constants' `params`, in order.
    pub(crate) params: Vec<Param>,
    /// The specialisation constants, by ascending id.
    pub(crate) constants: Vec<Constant>,
    /// True when it has subgroup operations.
    pub(crate) subgroups: bool,
    /// True when it reads an image.
    pub(crate) image: bool,
    /// The sides of its workgroups where no constant decides them; 0 of other shaders.
    pub(crate) workgroup: [u32; 3],
}

/// A storage buffer.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Buffer {
    pub(crate) binding: u32,
    pub(crate) name: String,
    /// `Read`, `Write` or `ReadWrite`, by the GLSL's `readonly` and `writeonly`.
    pub(crate) access: &'static str,
}

/// A member of the push constants' `params`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Param {
    pub(crate) name: String,
    pub(crate) scalar: Scalar,
    /// Components of a vector; 1 of a scalar.
    pub(crate) count: u32,
    /// Bytes from the beginning of `params`.
    pub(crate) offset: u32,
}

/// A specialisation constant.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Constant {
    pub(crate) id: u32,
    pub(crate) name: String,
    pub(crate) scalar: Scalar,
}

/// The type of a number, of 32 bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Scalar {
    Bool,
    Int,
    Uint,
    Float,
}

impl Scalar {
    /// Its name in Rust.
    pub(crate) fn rust(self) -> &'static str {
        match self {
            Self::Bool => "bool",
            Self::Int => "i32",
            Self::Uint => "u32",
            Self::Float => "f32",
        }
    }
}

#[derive(Debug, Clone, PartialEq)]
enum Type {
    Scalar(Scalar),
    Vector(usize, u32),
    Struct(Vec<usize>),
    Pointer(usize),
}

/// The facts known about an id of the module.
#[derive(Debug, Clone, Default)]
struct TypeTable {
    name: String,
    ty: Option<Type>,
    member_names: Vec<(u32, String)>,
    member_offsets: Vec<(u32, u32)>,
    binding: Option<u32>,
    spec_id: Option<u32>,
    is_workgroup_size: bool,
    no_write: bool,
    no_read: bool,
}

/// The instructions of a module: the code of each, and all its words, of which the first holds that code.
///
/// # Panics
/// With a sentence where this is no module.
pub(crate) fn instructions(words: &[u32]) -> impl Iterator<Item = (u32, &[u32])> {
    assert!(
        words.len() > 5 && words[0] == 0x0723_0203,
        "this is no SPIR-V module"
    );
    let mut rest = &words[5..];
    std::iter::from_fn(move || {
        let head = *rest.first()?;
        let (instruction, tail) = rest.split_at((head >> 16) as usize);
        rest = tail;
        Some((head & 0xffff, instruction))
    })
}

/// Reads a module's declarations.
///
/// # Panics
/// With a sentence where this is no module, or it declares something that is not translated here.
pub(crate) fn declarations(words: &[u32]) -> Declarations {
    const STORAGE_BUFFER: u32 = 12;
    const PUSH_CONSTANT: u32 = 9;
    const UNIFORM_CONSTANT: u32 = 0;
    let all = instructions(words);
    let mut known = vec![TypeTable::default(); words[3] as usize];
    let (mut variables, mut specs, mut composites) = (Vec::new(), Vec::new(), Vec::new());
    let mut found = Declarations::default();
    for (code, instruction) in all {
        let word = |index: usize| instruction[index];
        let id = |index: usize| instruction[index] as usize;
        match code {
            17 if (61..=68).contains(&word(1)) => found.subgroups = true, // OpCapability GroupNonUniform...
            16 if word(2) == 17 => found.workgroup = [word(3), word(4), word(5)], // OpExecutionMode, LocalSize
            5 => known[id(1)].name = text(&instruction[2..]),                     // OpName
            6 => {
                let name = (word(2), text(&instruction[3..])); // OpMemberName
                known[id(1)].member_names.push(name);
            }
            20 => known[id(1)].ty = Some(Type::Scalar(Scalar::Bool)), // OpTypeBool
            21 => {
                let scalar = if word(3) == 0 {
                    Scalar::Uint
                } else {
                    Scalar::Int
                };
                known[id(1)].ty = (word(2) == 32).then_some(Type::Scalar(scalar)); // OpTypeInt
            }
            22 if word(2) == 32 => known[id(1)].ty = Some(Type::Scalar(Scalar::Float)), // OpTypeFloat
            23 => known[id(1)].ty = Some(Type::Vector(id(2), word(3))), // OpTypeVector
            30 => {
                let members = instruction[2..].iter().map(|member| *member as usize);
                known[id(1)].ty = Some(Type::Struct(members.collect())); // OpTypeStruct
            }
            32 => known[id(1)].ty = Some(Type::Pointer(id(3))), // OpTypePointer
            48..=50 => specs.push((id(2), id(1))), // OpSpecConstantTrue, -False, OpSpecConstant
            51 => composites.push((id(2), instruction[3..].to_vec())), // OpSpecConstantComposite
            59 => variables.push((id(2), id(1), word(3))), // OpVariable
            71 => decorate(&mut known[id(1)], &instruction[2..]), // OpDecorate
            72 if word(3) == 35 => known[id(1)].member_offsets.push((word(2), word(4))), // OpMemberDecorate, Offset
            72 => decorate(&mut known[id(1)], &instruction[3..]),
            _ => {}
        }
    }
    // The size of a workgroup has no name of its own in the GLSL; a constant decides one of its sides.
    for (composite, parts) in composites {
        if known[composite].is_workgroup_size {
            for (part, side) in parts.into_iter().zip(["x", "y", "z"]) {
                known[part as usize].name = format!("local_size_{side}");
            }
        }
    }
    let pointee = |pointer: usize| match known[pointer].ty {
        Some(Type::Pointer(to)) => to,
        _ => panic!("a variable's type is no pointer"),
    };
    for &(variable, pointer, storage) in &variables {
        match storage {
            STORAGE_BUFFER => found
                .buffers
                .push(buffer(&known[variable], &known[pointee(pointer)])),
            PUSH_CONSTANT => found.params = params(&known, pointee(pointer)),
            UNIFORM_CONSTANT => found.image = true,
            _ => {}
        }
    }
    for (constant, ty) in specs {
        // Numbers computed from a constant have no id of their own.
        if let (Some(id), Some(Type::Scalar(scalar))) = (known[constant].spec_id, &known[ty].ty) {
            let name = known[constant].name.to_lowercase();
            assert!(!name.is_empty(), "the constant of id {id} has no name");
            found.constants.push(Constant {
                id,
                name,
                scalar: *scalar,
            });
        }
    }
    found.buffers.sort();
    found.constants.sort_by_key(|constant| constant.id);
    found
}

/// Notes a decoration of an id, or of one of its members.
fn decorate(known: &mut TypeTable, decoration: &[u32]) {
    match decoration[0] {
        1 => known.spec_id = Some(decoration[1]),
        11 if decoration[1] == 25 => known.is_workgroup_size = true,
        24 => known.no_write = true,
        25 => known.no_read = true,
        33 => known.binding = Some(decoration[1]),
        _ => {}
    }
}

fn buffer(variable: &TypeTable, block: &TypeTable) -> Buffer {
    let no_write = variable.no_write || block.no_write;
    let no_read = variable.no_read || block.no_read;
    let binding = variable.binding;
    Buffer {
        binding: binding.unwrap_or_else(|| panic!("buffer {} has no binding", variable.name)),
        name: variable.name.clone(),
        access: match (no_write, no_read) {
            (true, _) => "Read",
            (_, true) => "Write",
            _ => "ReadWrite",
        },
    }
}

/// The members of the struct that a push constant block holds as `params`.
fn params(known: &[TypeTable], block: usize) -> Vec<Param> {
    let member = |of: usize, name: &str| {
        let mut names = known[of].member_names.iter();
        names.find(|(_, n)| n == name).map(|(at, _)| *at as usize)
    };
    let (Some(Type::Struct(members)), Some(at)) = (&known[block].ty, member(block, "params"))
    else {
        return Vec::new();
    };
    let params = members[at];
    let Some(Type::Struct(members)) = &known[params].ty else {
        panic!("the push constants' params are no struct");
    };
    let translate = |(at, &ty): (usize, &usize)| {
        let find = |list: &[(u32, u32)]| list.iter().find(|(m, _)| *m == at as u32).map(|x| x.1);
        let names = &known[params].member_names;
        let name = names.iter().find(|(m, _)| *m == at as u32);
        let name = name.expect("members have names").1.clone();
        let (scalar, count) = match &known[ty].ty {
            Some(Type::Scalar(scalar)) => (*scalar, 1),
            Some(Type::Vector(of, count)) => match &known[*of].ty {
                Some(Type::Scalar(scalar)) => (*scalar, *count),
                _ => panic!("params.{name}: its type is not translated"),
            },
            _ => panic!("params.{name}: its type is not translated"),
        };
        Param {
            offset: find(&known[params].member_offsets).expect("members have offsets"),
            name,
            scalar,
            count,
        }
    };
    members.iter().enumerate().map(translate).collect()
}

/// The text of an instruction's last words.
pub(crate) fn text(words: &[u32]) -> String {
    let bytes = words.iter().flat_map(|word| word.to_le_bytes());
    let bytes: Vec<u8> = bytes.take_while(|byte| *byte != 0).collect();
    String::from_utf8(bytes).expect("names are UTF-8")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn module(file: &str) -> Vec<u32> {
        let path = format!("{}/glsl/spirv/{file}", env!("CARGO_MANIFEST_DIR"));
        let bytes = std::fs::read(path).expect("a committed module");
        bytemuck::pod_collect_to_vec(&bytes)
    }

    #[test]
    fn subgroup_operations_are_seen_by_their_capabilities() {
        for (file, has) in [
            ("radix_scatter.comp.bound.spv", false),
            ("radix_scatter.subgroup.comp.bound.spv", true),
        ] {
            assert_eq!(declarations(&module(file)).subgroups, has, "{file}");
        }
    }

    #[test]
    fn a_compute_shader_declares_its_buffers_params_and_constants() {
        let found = declarations(&module("sort_scan.comp.bound.spv"));
        let buffers: Vec<_> = found
            .buffers
            .iter()
            .map(|b| (b.binding, &*b.name, b.access))
            .collect();
        assert_eq!(
            buffers,
            [
                (0, "frame", "Read"),
                (1, "counts", "ReadWrite"),
                (2, "histogram", "ReadWrite")
            ]
        );
        let params: Vec<_> = found
            .params
            .iter()
            .map(|p| (&*p.name, p.scalar, p.count, p.offset))
            .collect();
        assert_eq!(
            params,
            [("pass", Scalar::Uint, 1, 0), ("passes", Scalar::Uint, 1, 4)]
        );
        assert_eq!(found.constants, []);
        assert_eq!(found.workgroup, [256, 1, 1]);
    }

    #[test]
    fn the_side_of_a_workgroup_is_a_constant_with_a_name() {
        let found = declarations(&module("tiles.comp.bound.spv"));
        let find = |name: &str| found.constants.iter().find(|c| c.name == name);
        assert_eq!(find("local_size_y").map(|c| c.scalar), Some(Scalar::Uint));
        assert_eq!(find("reclipped").map(|c| c.scalar), Some(Scalar::Bool));
        let ids: Vec<_> = found.constants.iter().map(|c| c.id).collect();
        assert!(ids.is_sorted_by(|a, b| a < b), "{ids:?}");
    }

    #[test]
    #[should_panic(expected = "no SPIR-V module")]
    fn what_is_no_module_is_refused() {
        declarations(&[0; 8]);
    }
}
