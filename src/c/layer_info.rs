//! What a scene in device memory says of its layers.

use std::ffi::c_char;

use rara::Result;

use crate::boundary::{RaraResult, exclusive, guard, invalid, versioned, write};
use crate::handles::{alive, number};
use crate::scene::RaraSceneBuffers;
use crate::text::text;

/// A layer of a scene in device memory.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct RaraLayerInfo {
    /// Set by rara_scene_buffers_layer_info.
    pub struct_size: usize,
    /// Its name: UTF-8, ends in NUL, lives as long as the RaraSceneBuffers.
    pub name: *const c_char,
    /// Gaussians in the layer.
    pub count: u64,
    /// Gaussians that it has room for.
    pub room: u64,
}

versioned!(RaraLayerInfo);

/// How many layers a scene has, one or more; 0 for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_scene_buffers_layer_count(scene: *const RaraSceneBuffers) -> usize {
    number(scene, "scene", |scene| scene.names.len())
}

/// Checks that a scene has a layer of this number.
pub(crate) fn check_index(scene: &RaraSceneBuffers, index: usize) -> Result<()> {
    let count = scene.names.len();
    if index < count {
        return Ok(());
    }
    invalid(format!(
        "index is {index}, and rara_scene_buffers_layer_count is {count}: give less than that"
    ))
}

/// Describes a layer. Layers are numbered from 0, in the order in which they were given. `info_size` is sizeof *info.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_scene_buffers_layer_info(
    scene: *const RaraSceneBuffers,
    index: usize,
    info: *mut RaraLayerInfo,
    info_size: usize,
) -> RaraResult {
    guard(|| {
        let scene = alive(scene, "scene")?;
        check_index(&scene, index)?;
        let layer = &scene.buffers.layers()[index];
        let found = RaraLayerInfo {
            struct_size: size_of::<RaraLayerInfo>(),
            name: scene.names[index].as_ptr(),
            count: layer.gaussians().into(),
            room: layer.room().into(),
        };
        write(info, info_size, &found, "info")
    })
}

/// The number of the first layer of a name. RARA_ERROR_INVALID, which lists the names that there are, where no layer is called
/// so; `index` is then left alone.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_scene_buffers_layer_by_name(
    scene: *const RaraSceneBuffers,
    name: *const c_char,
    index: *mut usize,
) -> RaraResult {
    guard(|| {
        let scene = alive(scene, "scene")?;
        let (name, index) = (text(name, "name")?, exclusive(index, "index")?);
        *index = scene.buffers.layer_index(name)?;
        Ok(())
    })
}
