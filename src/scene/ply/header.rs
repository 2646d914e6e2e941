//! The header of a PLY file: cut out under a size cap, scanned for what the library lets pass, parsed by `ply-rs`.
//!
//! The library keeps elements and properties in maps, so a second declaration of a name silently replaces the first
//! and every offset after it would be wrong; our own scan finds those by line. It also takes any count.

use std::collections::HashSet;

use glam::DVec3;
use ply_rs::parser::{Parser, Reader};
use ply_rs::ply::{DefaultElement, ElementDef, Encoding, PropertyType, ScalarType};

use super::trained::{self, TrainerKind};
use crate::Training;
use rara_base::error::shortened;

/// Headers of real files are below 5 kB; this leaves room for long comments. No more is read before the header is known.
pub(super) const MAX_BYTES: usize = 1 << 20;
/// Files with more elements or properties than this are no scenes; the caps keep each row's bookkeeping small.
const MAX_ELEMENTS: usize = 64;
const MAX_PROPERTIES: usize = 4096;

/// A header that passed every check that needs no knowledge of Gaussians.
#[derive(Debug)]
pub(crate) struct PlyHeader {
    pub(crate) encoding: Encoding,
    /// In file order.
    pub(crate) elements: Vec<ElementDef>,
    /// The offset of the payload, bytes.
    pub(crate) size: u64,
    /// Lines up to and with `end_header`.
    pub(crate) lines: u64,
    /// How many of them are blank, which no header should have.
    pub(super) blank: usize,
    /// The byte that ends each line of an ascii payload.
    pub(crate) line_end: u8,
    /// What the comments say of the Gaussians.
    pub(super) kind: Option<TrainerKind>,
    /// The direction that is up, where a comment says it.
    pub(super) up: Option<DVec3>,
    /// How they were trained by that and by who wrote the file, and what there is to say of it.
    pub(super) training: (Training, Vec<String>),
}

impl PlyHeader {
    /// No header is longer.
    pub(crate) const MOST_BYTES: usize = MAX_BYTES;

    /// Parses the header at the start of `bytes`, the file's first [`MAX_BYTES`] (or all of it, if shorter).
    pub(crate) fn parse(bytes: &[u8]) -> Result<Self, String> {
        let (mut lines, size, line_end) = cut(bytes)?;
        scan(&lines)?;
        let all = lines.len();
        lines.retain(|line| !line.trim().is_empty());
        let mut text = lines.join("\n");
        text.push('\n');
        let parsed = Parser::<DefaultElement>::new()
            .read_header(&mut Reader::new(text.as_bytes()))
            .map_err(
                |error| match error.line().filter(|&n| n >= 1 && n <= lines.len()) {
                    Some(n) => format!(
                        "line {n} of the header is not valid PLY: \"{}\"; export the scene again",
                        shortened(&lines[n - 1])
                    ),
                    None => "the header has no valid `format` line; export the scene again".into(),
                },
            )?;
        let mut elements: Vec<ElementDef> = parsed.elements.into_values().collect();
        // Without properties an element has no bytes, but lines in a text.
        elements.retain(|e| parsed.encoding == Encoding::Ascii || !e.properties.is_empty());
        for element in &elements {
            check(element)?;
        }
        Ok(Self {
            encoding: parsed.encoding,
            elements,
            size: size as u64,
            lines: all as u64,
            blank: all - lines.len(),
            line_end,
            kind: TrainerKind::from_comments(&lines),
            up: trained::up(&lines),
            training: trained::training(&lines),
        })
    }
}

/// The header's lines (without their ends), its length in bytes, and the byte that ends a line.
fn cut(bytes: &[u8]) -> Result<(Vec<String>, usize, u8), String> {
    if !bytes.starts_with(b"ply") || !matches!(bytes.get(3), Some(b'\n' | b'\r' | b' ' | b'\t')) {
        let guess = match bytes {
            [] => " (it is empty)",
            [0x1f, 0x8b, ..] => " (it is compressed with gzip, like .spz scenes)",
            [b'P', b'K', ..] => " (it is a zip archive, like .sog scenes)",
            _ => "",
        };
        return Err(format!(
            "this is not a PLY file, which begins with the line \"ply\"{guess}; convert it to a 3DGS .ply"
        ));
    }
    // Old files end lines with a carriage return alone. Only the first line is asked, since a byte of the payload could
    // mislead.
    let first_end = bytes.iter().position(|b| matches!(b, b'\n' | b'\r'));
    let line_end = match first_end.map(|i| (bytes[i], bytes.get(i + 1))) {
        Some((b'\r', next)) if next != Some(&b'\n') => b'\r',
        _ => b'\n',
    };
    let mut lines = Vec::new();
    let mut start = 0;
    while let Some(length) = bytes[start..].iter().position(|&b| b == line_end) {
        let line = bytes[start..start + length].trim_ascii_end();
        start += length + 1;
        let last = line == b"end_header";
        lines.push(String::from_utf8_lossy(line).into_owned());
        if last {
            return Ok((lines, start, line_end));
        }
    }
    // A header-only file may end without a line end.
    if bytes[start..].trim_ascii_end() == b"end_header" {
        lines.push("end_header".into());
        return Ok((lines, bytes.len(), line_end));
    }
    Err(if bytes.len() >= MAX_BYTES {
        format!(
            "the header is longer than {MAX_BYTES} bytes or has no `end_header` line; export the scene again"
        )
    } else {
        "the file ends inside its header (no `end_header` line); it is cut off, get it again".into()
    })
}

/// Finds what the library would accept silently: names declared twice and unreasonable numbers of declarations.
fn scan(lines: &[String]) -> Result<(), String> {
    let mut elements = HashSet::new();
    let mut properties = HashSet::new();
    for (number, line) in (1..).zip(lines) {
        let repeated = |kind: &str, name: &str| {
            format!(
                "line {number} of the header declares the {kind} `{}` a second time; remove one",
                shortened(name)
            )
        };
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("element") => {
                let name = words.next().unwrap_or_default();
                if !elements.insert(name) {
                    return Err(repeated("element", name));
                }
                properties.clear();
            }
            Some("property") => {
                let name = words.next_back().unwrap_or_default();
                if !properties.insert(name) {
                    return Err(repeated("property", name));
                }
            }
            _ => {}
        }
        if elements.len() > MAX_ELEMENTS || properties.len() > MAX_PROPERTIES {
            return Err(format!(
                "line {number}: the header declares more than {MAX_ELEMENTS} elements or {MAX_PROPERTIES} \
                 properties of one, which no scene needs"
            ));
        }
    }
    Ok(())
}

fn check(element: &ElementDef) -> Result<(), String> {
    let ElementDef {
        name,
        count,
        properties,
    } = element;
    if properties.is_empty() && *count > 0 {
        return Err(format!(
            "the header declares {count} of element `{name}` without any property; remove that element"
        ));
    }
    for property in properties.values() {
        if let PropertyType::List(ScalarType::Float | ScalarType::Double, _) = property.data_type {
            return Err(format!(
                "the list `{}` of element `{name}` has a length that is not an integer type; export the scene again",
                property.name
            ));
        }
    }
    Ok(())
}
