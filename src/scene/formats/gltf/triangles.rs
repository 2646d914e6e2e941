//! The triangles of a document, for meshes that cut scenes.

use glam::DVec3;
use serde_json::Value;

use super::super::{Failure, Files, bare, json, list};
use super::accessor::Accessor;
use super::buffers::Buffers;
use super::nodes::{self, Transform};
use super::{MOST_PRIMITIVES, attribute, chunks, count_of, index, size, turn};
use crate::placement::Placement;
use rara_base::counted::counted;
use rara_base::error::shortened;

/// Triangles that a byte of the buffers may be drawn as.
const MOST_DRAWN: u64 = 64;

/// Triangles over vertices, and sentences that say what was left out.
#[derive(Default)]
pub(crate) struct GltfTriangles {
    pub(crate) vertices: Vec<DVec3>,
    pub(crate) faces: Vec<[u32; 3]>,
    pub(crate) notes: Vec<String>,
}

/// Reads the triangles that the scene of a `.gltf` or a `.glb` draws, turned as its Gaussians are.
pub(crate) fn triangles(bytes: &[u8], files: Files<'_>) -> Result<GltfTriangles, Failure> {
    let (document, binary) = match bytes.starts_with(b"glTF") {
        true => {
            let (document, binary, _) = chunks(bytes)?;
            (document, binary)
        }
        false => (json(bare(bytes))?, None),
    };
    let document = &document;
    let mut buffers = Buffers::new(document, binary, files);
    let turned = Transform::Similar(Placement::new(DVec3::ZERO, turn(), 1.0)?);
    let mut made = GltfTriangles::default();
    let (mut others, mut hidden, mut drawn_primitives) = (0_u64, 0_u64, 0_u64);
    for drawn in nodes::meshes(document, &mut buffers)?.0 {
        let mesh = list(document, "meshes").get(drawn.mesh).ok_or_else(|| {
            format!(
                "a node of the glTF has mesh {}, which there is not; export the mesh again",
                drawn.mesh
            )
        })?;
        let transform = turned.of_inner(&drawn.transform)?;
        for primitive in list(mesh, "primitives") {
            drawn_primitives += 1;
            if drawn_primitives > MOST_PRIMITIVES {
                return Err(Failure::Format(format!(
                    "the glTF draws more than {MOST_PRIMITIVES} primitives; export the mesh as one"
                )));
            }
            let mode = index(primitive, "mode").unwrap_or(4);
            if !(4..=6).contains(&mode) {
                others += 1;
            } else if !drawn.is_visible || drawn.transform.hides() {
                hidden += 1;
            } else {
                add(
                    &mut made,
                    document,
                    &mut buffers,
                    primitive,
                    mode,
                    &transform,
                )?;
            }
        }
    }
    for (count, what) in [(others, "are no triangles"), (hidden, "are hidden")] {
        if count > 0 {
            made.notes.push(format!(
                "left out {} of the glTF that {what}",
                counted(count, "primitive")
            ));
        }
    }
    match made.faces.is_empty() {
        true => Err(Failure::Format(
            "the glTF draws no triangles; export it with a mesh in its scene".into(),
        )),
        false => Ok(made),
    }
}

/// Adds a primitive.
fn add(
    made: &mut GltfTriangles,
    document: &Value,
    buffers: &mut Buffers<'_>,
    primitive: &Value,
    mode: u64,
    transform: &Transform,
) -> Result<(), Failure> {
    let extensions = primitive.get("extensions").and_then(Value::as_object);
    let mut names = extensions.into_iter().flatten().map(|(name, _)| name);
    if let Some(name) = names.find(|name| name.contains("compression")) {
        return Err(Failure::Format(format!(
            "the triangles are compressed by {}, which is not read; export them uncompressed",
            shortened(name)
        )));
    }
    let attributes = primitive.get("attributes");
    let no_places =
        || "a primitive has no attribute POSITION with a count; export the mesh again".to_owned();
    let count = count_of(document, attributes, "POSITION").ok_or_else(no_places)?;
    let number = attribute(attributes, "POSITION").ok_or_else(no_places)?;
    let places = Accessor::from_json(document, buffers, number, "POSITION", count, 3)?;
    let indices = match size(primitive, "indices") {
        Some(number) => {
            let accessor = list(document, "accessors").get(number);
            let count = accessor.and_then(|accessor| index(accessor, "count"));
            let count = count.ok_or_else(|| {
                "a primitive has indices without a count; export the mesh again".to_owned()
            })?;
            let indices = Accessor::from_json(document, buffers, number, "indices", count, 1)?;
            Some((indices, count))
        }
        None => None,
    };
    let drawn = indices.as_ref().map_or(count, |indices| indices.1);
    let before = made.faces.len() as u64 + made.vertices.len() as u64;
    if before.saturating_add(drawn.max(count)) / MOST_DRAWN > buffers.size() as u64 {
        return Err(Failure::Format(format!(
            "the glTF draws {drawn} corners and more of {}, the same ones again and again; export the mesh once",
            counted(buffers.size(), "byte")
        )));
    }
    let first = made.vertices.len() as u64;
    if first + count > u64::from(u32::MAX) {
        return Err(Failure::Format(
            "the glTF has too many vertices; simplify it".into(),
        ));
    }
    let place = |at: u64| DVec3::new(places.at(at, 0), places.at(at, 1), places.at(at, 2));
    made.vertices
        .extend((0..count).map(|at| transform.of_point(place(at))));
    let corner = |at: u64| -> Result<u32, Failure> {
        let vertex = indices
            .as_ref()
            .map_or(at as f64, |indices| indices.0.at(at, 0));
        if vertex >= count as f64 {
            return Err(Failure::Format(format!(
                "a triangle of the glTF names vertex {vertex}, of {count}; export the mesh again"
            )));
        }
        Ok((first + vertex as u64) as u32)
    };
    // Triangles, a strip of them, and a fan.
    let triangle = |at: u64| match mode {
        4 => [3 * at, 3 * at + 1, 3 * at + 2],
        5 => [at, at + 1 + at % 2, at + 2 - at % 2],
        _ => [at + 1, at + 2, 0],
    };
    let all = if mode == 4 {
        drawn / 3
    } else {
        drawn.saturating_sub(2)
    };
    let is_mirrored = transform.mirrors();
    for at in 0..all {
        let [a, b, c] = triangle(at);
        let face = [corner(a)?, corner(b)?, corner(c)?];
        made.faces.push(match is_mirrored {
            false => face,
            true => [face[0], face[2], face[1]],
        });
    }
    Ok(())
}
