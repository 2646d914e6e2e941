//! PLY with vertices and faces, in all its encodings: the header by `ply-rs`, as scenes have theirs read.

use glam::DVec3;
use ply_rs::ply::{ElementDef, Encoding, PropertyType};

use super::ReadMesh;
use crate::mesh::MOST_FACES;
use crate::mesh::polygon::Polygons;
use crate::ply::{Number, PlyHeader};
use rara_base::error::shortened;

/// The names that the list of a face's vertices has.
const LISTS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// Reads a file.
pub(super) fn read(bytes: &[u8]) -> Result<ReadMesh, String> {
    let start = &bytes[..bytes.len().min(PlyHeader::MOST_BYTES)];
    let header = PlyHeader::parse(start)?;
    let element = |name: &str| header.elements.iter().find(|element| element.name == name);
    let no_mesh = |what: &str| format!("the PLY has no element `{what}`; export it as a mesh");
    let vertices = element("vertex").ok_or_else(|| no_mesh("vertex"))?;
    if element("face").is_none() && element("tristrips").is_some() {
        return Err("the PLY has its faces as strips; export them as triangles".into());
    }
    let faces = element("face").ok_or_else(|| {
        "the PLY has points or Gaussians and no element `face`; export it as a mesh".to_owned()
    })?;
    for (element, what) in [(vertices, "vertices"), (faces, "faces")] {
        if element.count > 3 * MOST_FACES {
            return Err(format!(
                "the PLY says to have {} {what}, and at most {MOST_FACES} faces are read; simplify it",
                element.count
            ));
        }
    }
    let mut source = Source {
        rest: bytes.get(header.size as usize..).unwrap_or_default(),
        encoding: header.encoding,
        line: header.lines + 1,
        line_end: header.line_end,
    };
    let mut made = ReadMesh::default();
    let mut polygons = Polygons::default();
    for element in &header.elements {
        let least = element.properties.values().map(|property| {
            match (&property.data_type, header.encoding) {
                (_, Encoding::Ascii) => 2,
                (PropertyType::Scalar(kind) | PropertyType::List(kind, _), _) => {
                    Number::from(kind).size()
                }
            }
        });
        let least = least.sum::<usize>().saturating_mul(element.count);
        if least > source.rest.len() + 1 {
            return Err(format!(
                "the PLY says to have {} of element `{}`, and there are not the bytes for them; it is cut off, get it again",
                element.count,
                shortened(&element.name)
            ));
        }
        match &element.name[..] {
            "vertex" => made.vertices = source.vertices(element)?,
            "face" => polygons = source.faces(element, vertices.count)?,
            _ => {
                let mut none = [];
                for number in 0..element.count {
                    source.row(element, number, &mut none, &[], &mut Vec::new(), None)?;
                }
            }
        }
    }
    made.faces = polygons.triangles(&made.vertices)?;
    match made.faces.is_empty() {
        true => Err("the PLY has no faces; export it as a mesh".into()),
        false => Ok(made),
    }
}

/// What is left of a file's payload.
struct Source<'a> {
    rest: &'a [u8],
    encoding: Encoding,
    /// The line that a text is at.
    line: u64,
    line_end: u8,
}

impl Source<'_> {
    fn vertices(&mut self, element: &ElementDef) -> Result<Vec<DVec3>, String> {
        let slot = |name: &str| {
            let names = element
                .properties
                .values()
                .map(|property| &property.name[..]);
            let at = names.clone().position(|own| own == name);
            at.ok_or_else(|| {
                format!("the vertices of the PLY have no property `{name}`; export it as a mesh")
            })
        };
        let slots = [slot("x")?, slot("y")?, slot("z")?];
        let mut made = Vec::with_capacity(element.count);
        for number in 0..element.count {
            let mut place = [0.0; 3];
            self.row(element, number, &mut place, &slots, &mut Vec::new(), None)?;
            made.push(DVec3::from(place));
        }
        Ok(made)
    }

    fn faces(&mut self, element: &ElementDef, vertices: usize) -> Result<Polygons, String> {
        let mut properties = element.properties.values();
        let is_list = |property: &PropertyType| matches!(property, PropertyType::List(..));
        let list = properties.position(|property| {
            LISTS.contains(&&property.name[..]) && is_list(&property.data_type)
        });
        let list = list.ok_or_else(|| {
            format!(
                "the faces of the PLY have no list `{}`; export it as a mesh",
                LISTS[0]
            )
        })?;
        let mut made = Polygons::default();
        made.counts.reserve(element.count);
        let mut corners = Vec::new();
        for number in 0..element.count {
            corners.clear();
            self.row(element, number, &mut [], &[], &mut corners, Some(list))?;
            for corner in &corners {
                // Anything that is no number of a vertex fails one of these.
                let is_known = *corner >= 0.0 && *corner < vertices as f64 && corner.fract() == 0.0;
                if !is_known {
                    return Err(format!(
                        "face {number} of the PLY names vertex {corner}, of {vertices}; export the mesh again"
                    ));
                }
                made.corners.push(*corner as u32);
            }
            made.counts.push(corners.len() as u32);
        }
        if made.counts.iter().all(|count| *count == 3) {
            made.counts.clear();
        }
        Ok(made)
    }

    /// Reads an element: some of its numbers into `slots`, and the numbers of one of its lists.
    fn row(
        &mut self,
        element: &ElementDef,
        number: usize,
        to: &mut [f64],
        slots: &[usize],
        items: &mut Vec<f64>,
        list: Option<usize>,
    ) -> Result<(), String> {
        let place = || format!("`{}` {number}", shortened(&element.name));
        for (at, property) in element.properties.values().enumerate() {
            match &property.data_type {
                PropertyType::Scalar(kind) => {
                    let value = self.number(kind.into(), &place)?;
                    if let Some(slot) = slots.iter().position(|slot| *slot == at) {
                        to[slot] = value;
                    }
                }
                PropertyType::List(length, kind) => {
                    let count = self.number(length.into(), &place)?;
                    // Each takes a byte at least.
                    let is_possible = count >= 0.0 && count <= self.rest.len() as f64;
                    if !is_possible || count.fract() != 0.0 {
                        return Err(format!(
                            "{} has a list of {count} numbers{}, and there are not the bytes for them; it is cut off or damaged, \
                             get it again",
                            place(),
                            self.at()
                        ));
                    }
                    for _ in 0..count as u64 {
                        let value = self.number(kind.into(), &place)?;
                        if list == Some(at) {
                            items.push(value);
                        }
                    }
                }
            }
        }
        Ok(())
    }

    /// The line of a text, as messages have it.
    fn at(&self) -> String {
        match self.encoding {
            Encoding::Ascii => format!(" in line {}", self.line),
            _ => String::new(),
        }
    }

    fn number(&mut self, kind: Number, place: &dyn Fn() -> String) -> Result<f64, String> {
        let big_endian = match self.encoding {
            Encoding::Ascii => return self.word(place),
            Encoding::BinaryBigEndian => true,
            Encoding::BinaryLittleEndian => false,
        };
        let (bytes, rest) = self
            .rest
            .split_at_checked(kind.size())
            .ok_or_else(|| cut_off(place))?;
        self.rest = rest;
        Ok(kind.decode(bytes, big_endian))
    }

    fn word(&mut self, place: &dyn Fn() -> String) -> Result<f64, String> {
        let blank = self
            .rest
            .iter()
            .take_while(|byte| byte.is_ascii_whitespace())
            .count();
        let lines = self.rest[..blank]
            .iter()
            .filter(|byte| **byte == self.line_end);
        self.line += lines.count() as u64;
        let rest = &self.rest[blank..];
        let length = rest
            .iter()
            .position(u8::is_ascii_whitespace)
            .unwrap_or(rest.len());
        let (word, rest) = rest.split_at(length);
        self.rest = rest;
        if word.is_empty() {
            return Err(cut_off(place));
        }
        let text = std::str::from_utf8(word).ok();
        let number = text.and_then(|text| text.parse().ok());
        number.ok_or_else(|| {
            format!(
                "{} has \"{}\" where a number should be{}; export the mesh again",
                place(),
                shortened(&String::from_utf8_lossy(word)),
                self.at()
            )
        })
    }
}

fn cut_off(place: &dyn Fn() -> String) -> String {
    format!(
        "the PLY ends in {}; it is cut off (or its header wrong), get it again",
        place()
    )
}
