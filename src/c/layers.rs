//! The layers of a scene by its files.

use std::ffi::{CString, c_char};
use std::ptr::without_provenance;

use rara::Result;
use rara::scene::layers::{LoadedLayer, entries, load};

use crate::boundary::{RaraResult, Versioned, c_string, guard, invalid, versioned, write};
use crate::clip::RaraClip;
use crate::gaussians::RaraGaussians;
use crate::handles::{add, alive, create, destroy};
use crate::layer::{RaraLayer, RaraLayerState};
use crate::text::path;

/// The layers of a scene that was read, with what they are made of. It does not change; several threads may use it at once.
pub struct RaraLayers {
    layers: Vec<OwnedLayer>,
    info: RaraLayersInfo,
}

/// Describes the layers of a scene, and what of their files could not be used.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct RaraLayersInfo {
    /// Set by rara_layers_info.
    pub struct_size: usize,
    /// Layers in the scene.
    pub count: usize,
    /// Gaussians of all files that were left out: numbers that are not finite.
    pub dropped: u64,
    /// Gaussians of all files that were kept with a value put right.
    pub repaired: u64,
}

versioned!(RaraLayersInfo);

/// A layer, and the handles that end with it, by their numbers.
struct OwnedLayer {
    name: CString,
    state: RaraLayerState,
    gaussians: usize,
    clip: Option<usize>,
}

impl OwnedLayer {
    fn new(layer: LoadedLayer) -> Result<Self> {
        let clip = layer.clip.map(|clip| add(RaraClip(clip.clip())));
        // What is made is owned before anything else can fail.
        let mut owned = Self {
            name: c_string(&layer.name),
            state: layer.state.into(),
            gaussians: 0,
            clip: clip.transpose()?.map(<*mut _>::addr),
        };
        owned.gaussians = add::<RaraGaussians>(layer.gaussians.into())?.addr();
        Ok(owned)
    }
}

impl Drop for OwnedLayer {
    fn drop(&mut self) {
        destroy(without_provenance::<RaraGaussians>(self.gaussians).cast_mut());
        if let Some(clip) = self.clip {
            destroy(without_provenance::<RaraClip>(clip).cast_mut());
        }
    }
}

/// Loads the layers of a scene: those of a JSON file that lists layers, with their places, states and clips; those of a file
/// that has several, as a project of SuperSplat; or the only one of a file that rara_gaussians_load reads or of a folder that
/// 3DGS, nerfstudio or gsplat have trained. What the files say that is worth knowing goes to the log. `path` is as for rara_gaussians_load.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_layers_load(
    path: *const c_char,
    layers: *mut *mut RaraLayers,
) -> RaraResult {
    create(layers, "layers", || {
        let loaded = load(entries(&self::path(path, "path")?)?)?;
        for note in &loaded.notes {
            log::info!("{note}");
        }
        let info = RaraLayersInfo {
            count: loaded.layers.len(),
            dropped: loaded.dropped,
            repaired: loaded.repaired,
            ..Versioned::BLANK
        };
        let owned = loaded.layers.into_iter().map(OwnedLayer::new);
        let layers = owned.collect::<Result<_>>()?;
        Ok(RaraLayers { layers, info })
    })
}

/// Describes layers. `info_size` is sizeof *info.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_layers_info(
    layers: *const RaraLayers,
    info: *mut RaraLayersInfo,
    info_size: usize,
) -> RaraResult {
    guard(|| write(info, info_size, &alive(layers, "layers")?.info, "info"))
}

/// A layer by its number from 0, as rara_scene_buffers_upload takes it. What it points to belongs to `layers`, and ends with it.
/// `layer_size` is sizeof *layer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_layers_get(
    layers: *const RaraLayers,
    index: usize,
    layer: *mut RaraLayer,
    layer_size: usize,
) -> RaraResult {
    guard(|| {
        let layers = alive(layers, "layers")?;
        let Some(owned) = layers.layers.get(index) else {
            let count = layers.layers.len();
            return invalid(format!(
                "index is {index}, and there are {count} layers: numbers count from 0"
            ));
        };
        let made = RaraLayer {
            name: owned.name.as_ptr(),
            gaussians: without_provenance(owned.gaussians),
            state: &raw const owned.state,
            clip: owned.clip.map_or(std::ptr::null(), without_provenance),
            ..Versioned::BLANK
        };
        write(layer, layer_size, &made, "layer")
    })
}

/// Frees layers, with their names, states, clips and Gaussians; null is ignored.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_layers_destroy(layers: *mut RaraLayers) {
    destroy(layers);
}

#[cfg(test)]
mod tests;
