//! Wavefront OBJ, by the crate `tobj`: it is handed the vertices and the faces alone, with no more of either than their places.
//! Objects and groups are shells of one mesh, and how they look is of no use here.

use std::cell::Cell;

use glam::DVec3;
use tobj::{LoadError, LoadOptions};

use super::ReadMesh;
use super::handed::{Handed, quoted};
use crate::mesh::polygon::Polygons;
use rara_base::counted::grouped;

/// True for a text that has a vertex near its start.
pub(super) fn is(text: &[u8]) -> bool {
    let start = &text[..text.len().min(1 << 16)];
    let mut lines = start.split(|byte| matches!(byte, b'\n' | b'\r'));
    lines.any(|line| matches!(line.trim_ascii_start(), [b'v', b' ' | b'\t', ..]))
}

/// Reads a text.
pub(super) fn read(text: &[u8]) -> Result<ReadMesh, String> {
    let number = Cell::new(0);
    let options = LoadOptions {
        single_index: true,
        ignore_points: true,
        ignore_lines: true,
        ..LoadOptions::default()
    };
    let mut joined = String::new();
    let mut lines = Handed::new(text, &number, |line, made| hand(line, &mut joined, made));
    let no_materials = |_: &std::path::Path| Ok(Default::default());
    let read = tobj::load_obj_buf(&mut lines, &options, no_materials);
    let (models, _) = read.map_err(|error| wrong(error, text, number.get()))?;
    let mut made = ReadMesh::default();
    let mut polygons = Polygons::default();
    // What is handed on names no objects, so that there is one.
    for model in models {
        let (positions, _) = model.mesh.positions.as_chunks::<3>();
        made.vertices = positions.iter().copied().map(DVec3::from).collect();
        polygons = Polygons {
            corners: model.mesh.indices,
            counts: model.mesh.face_arities,
        };
    }
    made.faces = polygons.triangles(&made.vertices)?;
    if made.faces.is_empty() {
        return Err("the OBJ has no faces; export it as a mesh".into());
    }
    Ok(made)
}

/// Hands on a vertex with its three numbers, and the fourth where there are no colours, and a face with the numbers of its
/// vertices.
fn hand(line: Option<&str>, joined: &mut String, made: &mut String) {
    let line = line.unwrap_or_default();
    // A line may go on behind a backslash at its end.
    if let Some(part) = line.trim_end().strip_suffix('\\') {
        joined.push_str(part);
        joined.push(' ');
        return;
    }
    let whole = match joined.is_empty() {
        true => line,
        false => {
            joined.push_str(line);
            &*joined
        }
    };
    let mut words = whole.split_ascii_whitespace();
    match words.next() {
        Some("v") => {
            let count = words.clone().take(5).count();
            made.push('v');
            for word in words.take(if count == 4 { 4 } else { 3 }) {
                made.push(' ');
                made.push_str(word);
            }
            made.push('\n');
        }
        Some("f") => {
            made.push('f');
            for word in words.take_while(|word| !word.starts_with('#')) {
                made.push(' ');
                made.push_str(word.split('/').next().unwrap_or(word));
            }
            made.push('\n');
        }
        _ => {}
    }
    joined.clear();
}

/// What is wrong with a line.
fn wrong(error: LoadError, text: &[u8], line: u64) -> String {
    let what = match error {
        LoadError::PositionParseError => "is no vertex of three numbers",
        LoadError::ScalingByZeroError => "divides a vertex by zero",
        LoadError::FaceParseError => "is no face of vertices' numbers",
        LoadError::FaceVertexOutOfBounds => return out_of_bounds(text),
        _ => {
            return format!("the OBJ cannot be read ({error}); export the mesh again");
        }
    };
    format!(
        "line {line} {what}: \"{}\"; export the mesh again",
        quoted(text, line)
    )
}

/// Names the first face that names a vertex which there is not.
fn out_of_bounds(text: &[u8]) -> String {
    let number = Cell::new(0);
    let mut joined = String::new();
    let mut vertices = 0_i64;
    let mut faces: Vec<(u64, i64, i64)> = Vec::new();
    let mut lines = Handed::new(text, &number, |line, _| {
        let mut made = String::new();
        hand(line, &mut joined, &mut made);
        let mut words = made.split_ascii_whitespace();
        match words.next() {
            Some("v") => vertices += 1,
            Some("f") => {
                let numbers = words.filter_map(|word| word.parse::<i64>().ok());
                let numbers: Vec<_> = numbers
                    .map(|at| {
                        if at < 0 {
                            at.saturating_add(vertices + 1)
                        } else {
                            at
                        }
                    })
                    .collect();
                let ends = numbers.iter().min().zip(numbers.iter().max());
                faces.extend(ends.map(|(least, most)| (number.get(), *least, *most)));
            }
            _ => {}
        }
    });
    let _ = std::io::copy(&mut lines, &mut std::io::sink());
    drop(lines);
    let is_wrong = |face: &&(u64, i64, i64)| face.1 < 1 || face.2 > vertices;
    let line = faces.iter().find(is_wrong).map_or(0, |face| face.0);
    format!(
        "line {line} is a face of vertices that there are not, of {}: \"{}\"; export the mesh again",
        grouped(vertices as u64),
        quoted(text, line)
    )
}
