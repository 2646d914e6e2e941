//! `.compressed.ply`: centres, scales and colours within the ranges of chunks of 256 Gaussians.

use std::io::Read;

use ply_rs::ply::{ElementDef, Encoding};

use super::header::PlyHeader;
use super::layout::{Field, fixed_size};
use crate::SH_0;
use crate::assemble::{
    Assembler, ColumnForm, OPACITY, ROTATION, SCALES, SH, degree_of, room, unit_quaternion,
};
use crate::failure::Failure;
use crate::input::{Progress, Source};
use rara_base::counted::counted;
use rara_base::error::shortened;

/// Gaussians in a chunk.
const CHUNK: usize = 256;

/// True for a file of this format.
pub(super) fn is(header: &PlyHeader) -> bool {
    let vertex = header
        .elements
        .iter()
        .find(|element| element.name == "vertex");
    vertex.is_some_and(|vertex| vertex.properties.contains_key("packed_position"))
}

/// The names of what a file of this format has beside its Gaussians.
pub(super) fn others(header: &PlyHeader) -> Vec<String> {
    let elements = header.elements.iter();
    let names = elements.flat_map(|element| match element.name.as_str() {
        "vertex" => {
            let names = element.properties.keys();
            let left = names.filter(|name| !PACKED.contains(&name.as_str()));
            left.map(|name| shortened(name)).collect()
        }
        "chunk" | "sh" => Vec::new(),
        _ if element.count == 0 => Vec::new(),
        other => vec![shortened(other)],
    });
    names.collect()
}

/// The properties of a Gaussian.
const PACKED: [&str; 4] = [
    "packed_position",
    "packed_rotation",
    "packed_scale",
    "packed_color",
];

/// An element's rows in memory.
struct Table {
    rows: Vec<u8>,
    fields: Vec<(String, Field, usize)>,
    stride: usize,
    count: usize,
    big_endian: bool,
}

/// A property's place in the rows.
#[derive(Clone, Copy)]
struct Column(Field, usize);

impl Table {
    /// The next element of the file, for whose rows there are bytes.
    fn read(
        source: &mut dyn Source,
        element: &ElementDef,
        big_endian: bool,
    ) -> Result<Self, Failure> {
        let mut stride = 0;
        let mut fields = Vec::new();
        for property in element.properties.values() {
            let field = Field::from(&property.data_type);
            if let Field::Scalar(kind, _) = field {
                fields.push((property.name.clone(), field, stride));
                stride += kind.size();
            }
        }
        let size = stride.saturating_mul(element.count);
        let mut rows = Vec::new();
        rows.try_reserve_exact(size)
            .map_err(|_| Failure::Memory(counted(element.count, "element")))?;
        source
            .take(size as u64)
            .read_to_end(&mut rows)
            .map_err(Failure::Io)?;
        if rows.len() < size {
            return Err(Failure::Format(format!(
                "the file ends inside the `{}` elements; it is cut off, get it again",
                element.name
            )));
        }
        Ok(Self {
            rows,
            fields,
            stride,
            count: element.count,
            big_endian,
        })
    }

    fn column(&self, name: &str) -> Option<Column> {
        let found = self.fields.iter().find(|(own, ..)| own == name);
        found.map(|&(_, field, offset)| Column(field, offset))
    }

    fn needed<const N: usize>(
        &self,
        names: [&str; N],
        element: &str,
    ) -> Result<[Column; N], String> {
        let mut columns = Vec::new();
        for name in names {
            columns.push(self.column(name).ok_or_else(|| {
                format!("the `{element}` element does not have {name}; export the scene again")
            })?);
        }
        Ok(std::array::from_fn(|at| columns[at]))
    }

    fn number(&self, row: usize, Column(field, offset): Column) -> f64 {
        match field {
            Field::Scalar(kind, _) => {
                kind.decode(&self.rows[row * self.stride + offset..], self.big_endian)
            }
            Field::List(..) => 0.0,
        }
    }
}

/// The ranges of one attribute's three parts in a chunk.
struct Ranges([Column; 3], [Column; 3]);

impl Ranges {
    fn from_chunks(chunks: &Table, low: [&str; 3], high: [&str; 3]) -> Result<Self, String> {
        Ok(Self(
            chunks.needed(low, "chunk")?,
            chunks.needed(high, "chunk")?,
        ))
    }

    /// Shares of the ranges in numbers.
    fn between(&self, chunks: &Table, row: usize, shares: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|axis| {
            let low = chunks.number(row, self.0[axis]);
            low + (chunks.number(row, self.1[axis]) - low) * shares[axis]
        })
    }
}

/// Reads the payload that begins at the source's position; `left` bytes remain of it there.
pub(super) fn read(
    source: &mut dyn Source,
    header: &PlyHeader,
    mut left: u64,
    progress: &mut Progress<'_>,
) -> Result<Assembler, Failure> {
    if header.encoding == Encoding::Ascii {
        return Err(Failure::Format(
            "a compressed PLY is binary, and this one is ascii; export the scene again".into(),
        ));
    }
    let big_endian = header.encoding == Encoding::BinaryBigEndian;
    let (mut chunks, mut vertices, mut harmonics) = (None, None, None);
    for element in &header.elements {
        let size = fixed_size(element).and_then(|size| size.checked_mul(element.count as u64));
        let rest = size.and_then(|size| left.checked_sub(size));
        left = rest.ok_or_else(|| {
            format!(
                "`{}` with its {} has lists or does not fit into the {} that are left; the file is cut off, get it again",
                element.name,
                counted(element.count, "element"),
                counted(left, "byte")
            )
        })?;
        let table = Table::read(source, element, big_endian)?;
        progress.left(left);
        match element.name.as_str() {
            "chunk" => chunks = Some(table),
            "vertex" => vertices = Some(table),
            "sh" => harmonics = Some(table),
            _ => {}
        }
    }
    let (Some(chunks), Some(vertices)) = (chunks, vertices) else {
        return Err(Failure::Format(
            "a compressed PLY needs a `chunk` element, and this one has none; export the scene again".into(),
        ));
    };
    if chunks.count < vertices.count.div_ceil(CHUNK) {
        return Err(Failure::Format(format!(
            "{} are too few for {}, {CHUNK} each; export the scene again",
            counted(chunks.count, "chunk"),
            counted(vertices.count, "Gaussian")
        )));
    }
    let mut assembler = assemble(&chunks, &vertices, harmonics.as_ref())?;
    assembler.report.trailing_bytes = left;
    Ok(assembler)
}

fn assemble(
    chunks: &Table,
    vertices: &Table,
    harmonics: Option<&Table>,
) -> Result<Assembler, Failure> {
    let (low, high) = (["min_x", "min_y", "min_z"], ["max_x", "max_y", "max_z"]);
    let positions = Ranges::from_chunks(chunks, low, high)?;
    let (low, high) = (
        ["min_scale_x", "min_scale_y", "min_scale_z"],
        ["max_scale_x", "max_scale_y", "max_scale_z"],
    );
    let scales = Ranges::from_chunks(chunks, low, high)?;
    // Without a range, bytes are the colours themselves.
    let colours = match chunks.column("min_r") {
        Some(_) => Some(Ranges::from_chunks(
            chunks,
            ["min_r", "min_g", "min_b"],
            ["max_r", "max_g", "max_b"],
        )?),
        None => None,
    };
    let packed = vertices.needed(PACKED, "vertex")?;
    let rest = harmonics.map_or(0, |table| table.fields.len());
    let degree = degree_of(rest).ok_or_else(|| {
        format!(
            "the `sh` element has {}; degree 1, 2, 3 or 4 has 9, 24, 45 or 72, export the scene again",
            counted(rest, "property")
        )
    })?;
    let harmonics = harmonics.filter(|_| degree > 0);
    let columns: Result<Vec<Column>, String> = (0..rest)
        .map(|number| {
            let name = format!("f_rest_{number}");
            let column = harmonics.and_then(|table| table.column(&name));
            column.ok_or_else(|| {
                format!("the `sh` element does not have {name}; export the scene again")
            })
        })
        .collect();
    let columns = columns?;
    if let Some(table) = harmonics.filter(|table| table.count < vertices.count) {
        return Err(Failure::Format(format!(
            "spherical harmonics of {} are too few for {}; export the scene again",
            table.count,
            counted(vertices.count, "Gaussian")
        )));
    }
    let room = room(vertices.count as u64, degree, ColumnForm::LogScales)?;
    room.make(|index, row| {
        let [position, rotation, scale, colour] =
            packed.map(|column| vertices.number(index, column) as u32);
        let chunk = index / CHUNK;
        row[..SCALES].copy_from_slice(&positions.between(chunks, chunk, thirds(position)));
        row[SCALES..ROTATION].copy_from_slice(&scales.between(chunks, chunk, thirds(scale)));
        row[ROTATION..OPACITY].copy_from_slice(&quaternion(rotation));
        let [red, green, blue, alpha] = colour.to_be_bytes().map(|byte| f64::from(byte) / 255.0);
        let rgb = [red, green, blue];
        let rgb = colours
            .as_ref()
            .map_or(rgb, |colours| colours.between(chunks, chunk, rgb));
        for (to, value) in row[SH..].iter_mut().zip(rgb) {
            *to = (value - 0.5) / SH_0;
        }
        row[OPACITY] = alpha;
        if let Some(table) = harmonics {
            for (number, &column) in columns.iter().enumerate() {
                let (channel, coefficient) = (number / (rest / 3), number % (rest / 3));
                if let Some(to) = row.get_mut(SH + 3 + 3 * coefficient + channel) {
                    *to = coefficient_of(table.number(index, column));
                }
            }
        }
        Ok(())
    })
}

/// A coefficient above degree 0 by its byte: the middle of one of 256 steps from -4 to 4, but for the ends.
fn coefficient_of(byte: f64) -> f64 {
    let share = match byte {
        byte if byte <= 0.0 => 0.0,
        byte if byte >= 255.0 => 1.0,
        byte => (byte + 0.5) / 256.0,
    };
    8.0 * (share - 0.5)
}

/// Shares in 11, 10 and 11 bits.
fn thirds(packed: u32) -> [f64; 3] {
    let share = |value: u32, most: u32| f64::from(value & most) / f64::from(most);
    [
        share(packed >> 21, 2047),
        share(packed >> 11, 1023),
        share(packed, 2047),
    ]
}

/// The place of the largest of w, x, y, z in two bits, and the others in ten each.
fn quaternion(packed: u32) -> [f64; 4] {
    let part =
        |shift: u32| (f64::from(packed >> shift & 1023) / 1023.0 - 0.5) * std::f64::consts::SQRT_2;
    unit_quaternion((packed >> 30) as usize, [part(20), part(10), part(0)])
}
