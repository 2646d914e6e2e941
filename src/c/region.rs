//! Regions: clips of any shapes, however they combine, from text and from files.

use std::ffi::c_char;
use std::path::Path;

use rara::ash::vk;
use rara::clip::{Expression, NamedClip, clips_from_json, load_clips};
use rara::{Clip, Error, Projection, Result};

use crate::boundary::{RaraResult, exclusive, guard, invalid, list};
use crate::camera::{RaraCamera, vector};
use crate::frame::{RaraFrame, configure};
use crate::handles::{alive, alone, create, destroy};
use crate::layer_info::check_index;
use crate::renderer::RaraRenderer;
use crate::scene::RaraSceneBuffers;
use crate::settings::RaraSettings;
use crate::text::{self, text};

/// The region that stays visible, made of planes, slabs, boxes, spheres, ellipsoids, cylinders, capsules and cones. It does
/// not change; several threads, renderers and layers may use it at once.
pub struct RaraRegion(pub(crate) Clip);

/// How a camera sees.
pub type RaraProjection = u32;
/// In perspective, as rara_renderer_configure.
pub const RARA_PROJECTION_PERSPECTIVE: RaraProjection = 0;
/// Without, as rara_renderer_configure_orthographic.
pub const RARA_PROJECTION_ORTHOGRAPHIC: RaraProjection = 1;

pub(crate) fn projection(value: RaraProjection) -> Result<Projection> {
    Ok(match value {
        RARA_PROJECTION_PERSPECTIVE => Projection::Perspective,
        RARA_PROJECTION_ORTHOGRAPHIC => Projection::Orthographic,
        _ => return invalid(format!("projection {value} is no RaraProjection")),
    })
}

/// Makes a region of the text of an expression: a shape, as "sphere:0,0,0,1" or "!box:0,0,0,1,1,2", whose "!" keeps the
/// outside, or all(...), any(...) and not(...) of expressions, as in "all(box:0,0,0,1,1,2, not(sphere:1,0,0,0.5))".
/// `rara help render` has the numbers of each shape. RARA_ERROR_INVALID says what is wrong and in which column.
///
/// # Safety
/// `expression` ends in NUL; `region` may be overwritten.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_region_parse(
    expression: *const c_char,
    region: *mut *mut RaraRegion,
) -> RaraResult {
    // SAFETY: the caller's promises.
    guard(|| unsafe {
        create(region, "region", || {
            let expression: Expression = text(expression, "expression")?.parse()?;
            Ok(RaraRegion(expression.clip()))
        })
    })
}

/// Makes a region of a clip in JSON, of which `rara --save-clip` writes files: a list whose elements have a "name" or not, and
/// either "clip", an expression as a tree, or "normal" and "d", a plane. `name` is the name of the element to take, or its
/// number where none is called so; null takes the only one.
///
/// # Safety
/// `json` points to `size` bytes, which are not used afterwards; `name` is null or ends in NUL; `region` may be overwritten.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_region_from_json(
    json: *const u8,
    size: usize,
    name: *const c_char,
    region: *mut *mut RaraRegion,
) -> RaraResult {
    // SAFETY: the caller's promises.
    guard(|| unsafe {
        create(region, "region", || {
            let path = Path::new("json");
            let clips = clips_from_json(list(json, size, "json")?, path)?;
            named(&clips, name, path)
        })
    })
}

/// Makes a region of a clip in a JSON file, as rara_region_from_json does. `path` is as for rara_gaussians_load.
///
/// # Safety
/// `path` ends in NUL, `name` is null or ends in NUL, and `region` may be overwritten.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_region_load(
    path: *const c_char,
    name: *const c_char,
    region: *mut *mut RaraRegion,
) -> RaraResult {
    // SAFETY: the caller's promises.
    guard(|| unsafe {
        create(region, "region", || {
            let path = text::path(path, "path")?;
            named(&load_clips(&path)?, name, &path)
        })
    })
}

/// The clip of a name or, where none is called so, of a number; for null the only one.
///
/// # Safety
/// `name` is null or ends in NUL.
unsafe fn named(clips: &[NamedClip], name: *const c_char, path: &Path) -> Result<RaraRegion> {
    let found = match name.is_null() {
        true => <&[NamedClip; 1]>::try_from(clips).ok().map(|[only]| only),
        false => {
            // SAFETY: the caller's promise.
            let name = unsafe { text(name, "name") }?;
            let called = clips.iter().find(|clip| clip.name == name);
            called.or_else(|| clips.get(name.parse::<usize>().ok()?))
        }
    };
    match found {
        Some(found) => Ok(RaraRegion(found.clip.clip())),
        None => {
            let names: Vec<_> = clips.iter().map(|clip| clip.name.as_str()).collect();
            let message = format!("name one of its clips: {}", names.join(", "));
            Err(Error::format(path, message))
        }
    }
}

/// Frees a region; null is ignored. Renderers and layers that were given it have copies of their own.
///
/// # Safety
/// `region` is null, or alive and not used any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_region_destroy(region: *mut RaraRegion) {
    destroy(region);
}

/// As rara_renderer_configure or rara_renderer_configure_orthographic, with a region in place of a clip; null keeps
/// everything. A region with planes that move with the camera is a RaraClip.
///
/// # Safety
/// As for rara_renderer_configure; `region` is null or alive.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_configure_region(
    renderer: *mut RaraRenderer,
    scene: *const RaraSceneBuffers,
    camera: *const RaraCamera,
    projection: RaraProjection,
    region: *const RaraRegion,
    settings: *const RaraSettings,
    frame: *mut *mut RaraFrame,
) -> RaraResult {
    // SAFETY: the caller's promises.
    unsafe {
        let seen = || {
            Ok((
                self::projection(projection)?,
                clip(region, "region")?.unwrap_or_default().into(),
            ))
        };
        configure(renderer, scene, camera, seen, settings, frame)
    }
}

/// The clip that a region is, which messages call so; `None` for null.
pub(crate) fn clip(region: *const RaraRegion, name: &str) -> Result<Option<Clip>> {
    if region.is_null() {
        return Ok(None);
    }
    Ok(Some(alive(region, name)?.0.clone()))
}

/// As rara_scene_buffers_set_layer_clip, with a region in place of planes; null gives the layer the frame's clip again.
///
/// # Safety
/// `scene` is alive, and no other thread uses it meanwhile, rara_renderer_configure and rara_renderer_prepare included;
/// `region` is null or alive.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_scene_buffers_set_layer_region(
    scene: *mut RaraSceneBuffers,
    index: usize,
    region: *const RaraRegion,
) -> RaraResult {
    guard(|| {
        let mut scene = alone(scene, "scene")?;
        check_index(&scene, index)?;
        scene.buffers.set_layer_clip(index, clip(region, "region")?)
    })
}

/// Says in `kept` whether a region keeps a point; a surface's own points are kept.
///
/// # Safety
/// `region` is alive, `point` points to three numbers, and `kept` may be overwritten.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_region_keeps(
    region: *const RaraRegion,
    point: *const f64,
    kept: *mut vk::Bool32,
) -> RaraResult {
    // SAFETY: the caller's promises.
    guard(|| unsafe {
        let kept = exclusive(kept, "kept")?;
        let region = alive(region, "region")?;
        *kept = region.0.keeps(vector(point, "point")?).into();
        Ok(())
    })
}

#[cfg(test)]
mod tests;
