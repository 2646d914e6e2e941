//! Clips: the regions that stay visible, from planes, from text and from files.

use std::ffi::c_char;
use std::path::Path;

use rara::ash::vk;
use rara::clip::{Expression, Inside, NamedClip, clips_from_json, load_clips};
use rara::glam::DVec3;
use rara::{Clip, ClipOp, Error, Mesh, Placement, Plane, Result};

use crate::boundary::{RaraResult, exclusive, guard, invalid, list};
use crate::camera::vector;
use crate::handles::{alive, create, destroy};
use crate::settings::choice;
use crate::text::{self, text};

/// The region that stays visible, made of planes, slabs, boxes, spheres, ellipsoids, cylinders, capsules, cones, prisms and
/// meshes. Where a function takes one, null means everything. It does not change; several threads, renderers and layers may use
/// it at once.
pub struct RaraClip(pub(crate) Clip);

/// A half-space: the points x with normal . x + offset >= 0 are visible. The normal need not have length one, but must
/// not be zero. It never grows.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RaraPlane {
    /// The normal of the plane; it points to the visible side.
    pub normal: [f64; 3],
    /// The offset d of the plane, in world units times the length of the normal.
    pub offset: f64,
}

impl RaraPlane {
    /// The plane; `name` is that of the argument.
    pub(crate) fn plane(&self, name: &str) -> Result<Plane> {
        let made = Plane::new(DVec3::from(self.normal), self.offset);
        made.map_err(|error| Error::Invalid(format!("{name}: {error}")))
    }
}

/// How several planes combine.
pub type RaraClipOp = u32;
/// A point is visible if every plane keeps it.
pub const RARA_CLIP_OP_AND: RaraClipOp = 0;
/// A point is visible if at least one plane keeps it.
pub const RARA_CLIP_OP_OR: RaraClipOp = 1;

/// Makes a clip of half-spaces, at most 65536; none keep everything.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_clip_of_planes(
    planes: *const RaraPlane,
    count: usize,
    op: RaraClipOp,
    clip: *mut *mut RaraClip,
) -> RaraResult {
    create(clip, "clip", || {
        if count > Clip::MAX_SURFACES {
            return invalid(format!(
                "count is {count}, and a clip has at most {} planes",
                Clip::MAX_SURFACES
            ));
        }
        let planes = list(planes, count, "planes")?.iter().enumerate();
        let named = |(index, plane): (usize, &RaraPlane)| plane.plane(&format!("planes[{index}]"));
        let planes: Vec<_> = planes.map(named).collect::<Result<_>>()?;
        Ok(RaraClip(Clip::of(planes, choice(op, "op")?)))
    })
}

/// Makes a clip of the text of an expression: a shape, as "sphere:0,0,0,1" or "!box:0,0,0,1,1,2", whose "!" keeps the
/// outside, or all(...), any(...) and not(...) of expressions, as in "all(box:0,0,0,1,1,2, not(sphere:1,0,0,0.5))".
/// `rara help clip` has the numbers of each shape. RARA_ERROR_INVALID says what is wrong and in which column.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_clip_parse(
    expression: *const c_char,
    clip: *mut *mut RaraClip,
) -> RaraResult {
    create(clip, "clip", || {
        let expression: Expression = text(expression, "expression")?.parse()?;
        Ok(RaraClip(expression.clip()))
    })
}

/// The rule by which a point is inside of a mesh.
pub type RaraMeshRule = u32;
/// The mesh is closed and does not cut itself; its shells lie in each other or apart.
pub const RARA_MESH_RULE_CLOSED: RaraMeshRule = 0;
/// A point is inside where the winding number of the faces around it is not zero. Faces may cut each other, and holes are closed.
pub const RARA_MESH_RULE_WINDING: RaraMeshRule = 1;

/// Makes a clip of the inside of a mesh of triangles, in world units. `vertices` are x, y and z of each, and `faces` the numbers of
/// three vertices each, which turn to the left as seen from outside. RARA_ERROR_INVALID names the edge or the face where it is not as
/// the rule asks for. A mesh of a file is the text "mesh:FILE" for rara_clip_parse.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_clip_of_mesh(
    vertices: *const [f64; 3],
    vertex_count: usize,
    faces: *const [u32; 3],
    face_count: usize,
    rule: RaraMeshRule,
    clip: *mut *mut RaraClip,
) -> RaraResult {
    create(clip, "clip", || {
        let vertices = list(vertices, vertex_count, "vertices")?.iter();
        let vertices: Vec<DVec3> = vertices.map(|at| DVec3::from(*at)).collect();
        let faces = list(faces, face_count, "faces")?;
        let mesh = Mesh::from_triangles(&vertices, faces, choice(rule, "rule")?)?;
        let inside = Inside::new(mesh, Placement::IDENTITY);
        Ok(RaraClip(Clip::of([inside], ClipOp::And)))
    })
}

/// Makes a clip of JSON, of which `rara --save-clip` writes files: a list whose elements have a "name" or not, and
/// either "clip", an expression as a tree, or "normal" and "d", a plane. `name` is the name of the element to take, or its
/// number where none is called so; null takes the only one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_clip_from_json(
    json: *const u8,
    size: usize,
    name: *const c_char,
    clip: *mut *mut RaraClip,
) -> RaraResult {
    create(clip, "clip", || {
        let path = Path::new("json");
        let clips = clips_from_json(list(json, size, "json")?, path)?;
        named(&clips, name, path)
    })
}

/// Makes a clip of a JSON file, as rara_clip_from_json does. `path` is as for rara_gaussians_load.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_clip_load(
    path: *const c_char,
    name: *const c_char,
    clip: *mut *mut RaraClip,
) -> RaraResult {
    create(clip, "clip", || {
        let path = text::path(path, "path")?;
        named(&load_clips(&path)?, name, &path)
    })
}

/// The clip of a name or, where none is called so, of a number; for null the only one.
unsafe fn named(clips: &[NamedClip], name: *const c_char, path: &Path) -> Result<RaraClip> {
    let found = match name.is_null() {
        true => <&[NamedClip; 1]>::try_from(clips).ok().map(|[only]| only),
        false => {
            let name = text(name, "name")?;
            let called = clips.iter().find(|clip| clip.name == name);
            called.or_else(|| clips.get(name.parse::<usize>().ok()?))
        }
    };
    match found {
        Some(found) => Ok(RaraClip(found.clip.clip())),
        None => {
            let names: Vec<_> = clips.iter().map(|clip| clip.name.as_str()).collect();
            let message = format!("name one of its clips: {}", names.join(", "));
            Err(Error::format(path, message))
        }
    }
}

/// Frees a clip; null is ignored. Renderers and layers that were given it have copies of their own.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_clip_destroy(clip: *mut RaraClip) {
    destroy(clip);
}

/// The clip that a handle is, which messages call so; `None` for null.
pub(crate) fn clip(clip: *const RaraClip, name: &str) -> Result<Option<Clip>> {
    if clip.is_null() {
        return Ok(None);
    }
    Ok(Some(alive(clip, name)?.0.clone()))
}

/// Says in `kept` whether a clip keeps a point, three numbers; a surface's own points are kept.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_clip_keeps(
    clip: *const RaraClip,
    point: *const f64,
    kept: *mut vk::Bool32,
) -> RaraResult {
    guard(|| {
        let kept = exclusive(kept, "kept")?;
        let clip = alive(clip, "clip")?;
        *kept = clip.0.keeps(vector(point, "point")?).into();
        Ok(())
    })
}

#[cfg(test)]
mod tests;
