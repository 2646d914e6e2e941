//! Scenes onto the device.

use std::ffi::CString;
use std::sync::Arc;

use rara::{Clip, Layer, LayerState, Scene, SceneBuffers};

use crate::boundary::c_string;
use crate::gaussians::RaraGaussians;
use crate::handles::{destroy, number};
use crate::numbering::{Numbers, numbers};

/// A scene in device memory: one layer or several. Several threads and renderers may use it at once, but nobody else
/// while rara_scene_buffers_set_layer_state runs.
pub struct RaraSceneBuffers {
    pub(crate) buffers: SceneBuffers,
    /// The layers' names.
    pub(crate) names: Vec<CString>,
}

impl RaraSceneBuffers {
    pub(crate) fn new(buffers: SceneBuffers) -> Self {
        let layers = buffers.layers().iter();
        Self {
            names: layers.map(|layer| c_string(layer.name())).collect(),
            buffers,
        }
    }
}

/// How spherical harmonics lie in device memory; the sizes are of one Gaussian of degree 3.
pub type RaraShFormat = u32;
/// 8 bits a coefficient: 56 bytes.
pub const RARA_SH_FORMAT_BYTE: RaraShFormat = 0;
/// 10 to 11 bits a coefficient: 68 bytes. The preset balanced uses it.
pub const RARA_SH_FORMAT_PACKED: RaraShFormat = 1;
/// 16-bit floats: 96 bytes.
pub const RARA_SH_FORMAT_HALF: RaraShFormat = 2;
/// 32-bit floats: 192 bytes.
pub const RARA_SH_FORMAT_FLOAT: RaraShFormat = 3;

/// A layer of a scene that is to be uploaded.
pub(crate) struct HostLayer {
    pub(crate) gaussians: Arc<RaraGaussians>,
    pub(crate) name: String,
    pub(crate) state: LayerState,
    /// Its own; `None` where the frame's holds.
    pub(crate) clip: Option<Clip>,
    /// How many Gaussians it has room for, if that is more than it has.
    pub(crate) room: u32,
}

impl HostLayer {
    /// True where it has room for more Gaussians than it has.
    pub(crate) fn has_room(&self) -> bool {
        self.room as usize > self.gaussians.gaussians.len()
    }
}

/// What the Gaussians of these layers are numbered by.
pub(crate) fn numbers_of(given: &[HostLayer]) -> Vec<Numbers<'_>> {
    let layers = given.iter().map(|given| {
        let RaraGaussians {
            gaussians, part, ..
        } = &*given.gaussians;
        (gaussians.len(), part.as_ref())
    });
    numbers(&layers.collect::<Vec<_>>())
}

/// The scene of these layers, whose numbers are those of [`numbers_of`].
pub(crate) fn of_layers<'a>(given: &'a [HostLayer], numbers: &'a [Numbers<'_>]) -> Scene<'a> {
    let layer = |(given, numbers): (&'a HostLayer, &'a Numbers<'_>)| {
        let mut layer = Layer::new(given.name.as_str(), &given.gaussians.gaussians)
            .with(given.state)
            .with_room(given.room);
        if let Some(clip) = &given.clip {
            layer = layer.clipped(clip.clone());
        }
        match numbers {
            Some((first, in_set)) => layer.numbered(*first, in_set),
            None => layer,
        }
    };
    given.iter().zip(numbers).map(layer).collect()
}

/// Bytes of device memory that a scene takes, 0 for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_scene_buffers_bytes(scene: *const RaraSceneBuffers) -> u64 {
    number(scene, "scene", |scene| scene.buffers.bytes())
}

/// Frees a scene's device memory; null is ignored. The host has waited for the frames that use it, or calls
/// rara_device_destroy_after.
///
/// # Safety
/// `scene` is null, or alive and not used any more, not even by the device.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_scene_buffers_destroy(scene: *mut RaraSceneBuffers) {
    destroy(scene);
}
