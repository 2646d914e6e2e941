//! STL, binary and as a text, by the crate `stl_io`. The text is put in the form that it takes: keywords in small letters, one
//! solid for all, and no normals, which follow from the corners.

use std::cell::Cell;
use std::io::Cursor;

use glam::{DVec3, Vec3};

use super::ReadMesh;
use super::handed::{Handed, quoted};
use crate::mesh::MOST_FACES;
use rara_base::counted::counted;

/// Bytes before the first face of a binary file.
const HEADER: usize = 84;
/// Bytes of each face.
const FACE: usize = 50;

/// The number of faces that a binary file says to have.
fn stated(bytes: &[u8]) -> Option<usize> {
    let count = bytes.get(HEADER - 4..HEADER)?.try_into().ok()?;
    usize::try_from(u32::from_le_bytes(count)).ok()
}

/// True for a binary file, which is as long as it says. The word "solid" may stand at the start of it too.
pub(super) fn is_binary(bytes: &[u8]) -> bool {
    let size = |faces: usize| faces.checked_mul(FACE)?.checked_add(HEADER);
    stated(bytes).and_then(size) == Some(bytes.len())
}

/// True for a text. Binary files that are cut off may begin with the same word.
pub(super) fn is_text(text: &[u8]) -> bool {
    let start = text.trim_ascii_start();
    let (word, rest) = start.split_at(start.len().min(5));
    let is_word =
        word.eq_ignore_ascii_case(b"solid") && !rest.first().is_some_and(u8::is_ascii_alphanumeric);
    is_word && !text[..text.len().min(2 * HEADER)].contains(&0)
}

/// What is wrong with a file that is neither.
pub(super) fn cut_off(bytes: &[u8]) -> String {
    match stated(bytes) {
        Some(count) => format!(
            "the STL says to have {}, and has the bytes of {}; it is cut off or damaged, get it again",
            counted(count, "face"),
            (bytes.len() - HEADER) / FACE
        ),
        None => "the STL is shorter than its header; it is cut off, get it again".into(),
    }
}

/// Reads a binary file.
pub(super) fn read_binary(bytes: &[u8]) -> Result<ReadMesh, String> {
    let count = stated(bytes).unwrap_or(0);
    check_count(count)?;
    // Its text at the start would make it look like a text.
    let mut bytes = bytes.to_vec();
    bytes[..HEADER - 4].fill(0);
    let mut made = ReadMesh::default();
    made.vertices.reserve(3 * count);
    let mut source = Cursor::new(bytes);
    let reader = stl_io::create_stl_reader(&mut source);
    for face in reader.into_iter().flatten() {
        let face = face.map_err(|error| {
            format!(
                "face {} cannot be read: {error}; get it again",
                made.faces.len()
            )
        })?;
        add(&mut made, &face);
    }
    with_faces(made)
}

/// Reads a text.
pub(super) fn read_text(text: &[u8]) -> Result<ReadMesh, String> {
    let number = Cell::new(0);
    let mut has_begun = false;
    let mut has_ended = false;
    let mut lines = Handed::new(text, &number, |line, made| {
        let Some(line) = line else {
            if has_ended {
                made.push_str("endsolid\n");
            }
            return;
        };
        if number.get() <= 1 {
            has_begun = false; // from the start again
        }
        let line = line.trim();
        let word = line.split_ascii_whitespace().next().unwrap_or_default();
        let is = |known: &str| word.eq_ignore_ascii_case(known);
        if is("solid") {
            if !has_begun {
                made.push_str("solid mesh\n");
            }
            has_begun = true;
            has_ended = false;
        } else if is("endsolid") {
            has_ended = true;
        } else if is("facet") {
            made.push_str("facet normal 0 0 0\n");
        } else if is("vertex") {
            made.push_str("vertex");
            made.push_str(&line[word.len()..]);
            made.push('\n');
        } else if !word.is_empty() {
            made.extend(line.chars().map(|letter| letter.to_ascii_lowercase()));
            made.push('\n');
        }
    });
    let mut made = ReadMesh::default();
    let wrong = |error: std::io::Error, number: u64| {
        format!(
            "line {number} is not what an STL has there: \"{}\" ({error}); export the mesh again",
            quoted(text, number)
        )
    };
    let reader = stl_io::create_stl_reader(&mut lines);
    let reader = reader.map_err(|error| wrong(error, number.get()))?;
    for face in reader {
        add(
            &mut made,
            &face.map_err(|error| wrong(error, number.get()))?,
        );
        check_count(made.faces.len())?;
    }
    with_faces(made)
}

fn check_count(count: usize) -> Result<(), String> {
    match count <= MOST_FACES {
        true => Ok(()),
        false => Err(format!(
            "the STL has {count} faces or more, and at most {MOST_FACES} are read; simplify it"
        )),
    }
}

fn add(made: &mut ReadMesh, face: &stl_io::Triangle) {
    let first = made.vertices.len() as u32;
    let corners = face.vertices.map(|corner| Vec3::from(corner.0).as_dvec3());
    made.vertices.extend::<[DVec3; 3]>(corners);
    made.faces.push([first, first + 1, first + 2]);
}

fn with_faces(made: ReadMesh) -> Result<ReadMesh, String> {
    match made.faces.is_empty() {
        true => Err("the STL has no faces; export it as a mesh".into()),
        false => Ok(made),
    }
}
