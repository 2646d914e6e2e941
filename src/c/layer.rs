//! Layers: scenes of several sets of Gaussians, and how each of them is shown.

use std::ffi::c_char;

use rara::ash::vk;
use rara::{Error, LayerState, Result};

use crate::boundary::{
    RaraResult, Versioned, guard, invalid, read, read_list, recording, versioned, write,
};
use crate::clip::{self, RaraClip};
use crate::gaussians::RaraGaussians;
use crate::handles::{alive, alone, number};
use crate::layer_info::check_index;
use crate::placement::RaraPlacement;
use crate::scene::{HostLayer, RaraSceneBuffers};
use crate::staging::{self, RaraStaging};
use crate::text::text;

/// The state of a layer, which may change from frame to frame.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RaraLayerState {
    /// Set by rara_layer_state_default and rara_scene_buffers_layer_state.
    pub struct_size: usize,
    /// The layer's placement in its scene, which rara_renderer_set_placement places as a whole. Default: where it was
    /// made.
    pub placement: RaraPlacement,
    /// The factor of its Gaussians' opacities, 0 to 1. Default: 1.
    pub opacity: f32,
    /// True when it is drawn. A hidden layer costs next to nothing. Default: true.
    pub visible: vk::Bool32,
}

versioned!(RaraLayerState);

impl From<LayerState> for RaraLayerState {
    fn from(state: LayerState) -> Self {
        Self {
            struct_size: size_of::<Self>(),
            placement: state.placement.into(),
            opacity: state.opacity,
            visible: state.visible.into(),
        }
    }
}

/// Reads the state that a host gives; `layer` is the name of the layer that it is for.
unsafe fn state(state: *const RaraLayerState, name: &str, layer: &str) -> Result<LayerState> {
    let default = LayerState::default();
    let given = read(state, default.into(), name)?;
    let made = given.placement.placement().and_then(|placement| {
        let made = default
            .placement(placement)
            .opacity(given.opacity)
            .visible(given.visible != 0);
        made.check(layer).map(|()| made)
    });
    made.map_err(|error| Error::Invalid(format!("{name}: {error}")))
}

/// A layer of a scene that is to be uploaded. Only the call itself reads it: the name is copied, and the Gaussians may be
/// destroyed when the call returns.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct RaraLayer {
    /// Set by rara_layer_default.
    pub struct_size: usize,
    /// Its name: UTF-8, ends in NUL. Several layers may have the same.
    pub name: *const c_char,
    /// Its Gaussians. Several layers may have the same.
    pub gaussians: *const RaraGaussians,
    /// The state in which it is uploaded; null, the default, stands for that of rara_layer_state_default.
    pub state: *const RaraLayerState,
    /// Its own clip, as rara_scene_buffers_set_layer_clip sets it; null, the default, for the frame's clip.
    pub clip: *const RaraClip,
    /// How many Gaussians it has room for, so that rara_scene_buffers_replace_layer can give it as many later; less than it has,
    /// as the default of 0, is no room for more. Room takes as much memory on the device as Gaussians do. A layer without
    /// Gaussians and with room is one to be added later. No layer has room in a scene of Gaussians that rara_gaussians_select
    /// has divided.
    pub room: u32,
}

versioned!(RaraLayer);

impl RaraLayer {
    fn new(name: *const c_char, gaussians: *const RaraGaussians) -> Self {
        Self {
            name,
            gaussians,
            ..Versioned::BLANK
        }
    }

    /// Reads the layer; `place` names it in messages.
    unsafe fn layer(&self, place: &str) -> Result<HostLayer> {
        let name = text(self.name, &format!("{place}.name"))?;
        let mut layer = HostLayer {
            gaussians: alive(self.gaussians, &format!("{place}.gaussians"))?.keep(),
            name: name.to_owned(),
            state: LayerState::default(),
            clip: clip::clip(self.clip, &format!("{place}.clip"))?,
            room: self.room,
        };
        if !self.state.is_null() {
            layer.state = state(self.state, &format!("{place}.state"), name)?;
        }
        Ok(layer)
    }
}

pub(crate) unsafe fn given(layers: *const RaraLayer, layer_count: usize) -> Result<Vec<HostLayer>> {
    if layer_count == 0 {
        return invalid("layer_count is 0, and a scene has at least one layer: give one or more");
    }
    let layers: Vec<RaraLayer> = read_list(layers, layer_count, Versioned::BLANK, "layers")?;
    let layers = layers.iter().enumerate();
    let made = layers.map(|(index, layer)| layer.layer(&format!("layers[{index}]")));
    let made: Vec<HostLayer> = made.collect::<Result<_>>()?;
    let is_divided = made.iter().any(|layer| layer.gaussians.part.is_some());
    match made.iter().position(|layer| is_divided && layer.has_room()) {
        Some(index) => invalid(format!(
            "layers[{index}].room is {}, beside layers of Gaussians that rara_gaussians_select has divided, whose numbers leave \
             no room: give 0",
            made[index].room
        )),
        None => Ok(made),
    }
}

/// The state of a layer that stands where it was made, visible and with the opacities of its Gaussians. `state_size` is
/// sizeof *state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_layer_state_default(
    state: *mut RaraLayerState,
    state_size: usize,
) -> RaraResult {
    let default = LayerState::default().into();
    guard(|| write(state, state_size, &default, "state"))
}

/// A layer of Gaussians in the default state; `layer` keeps both pointers as they are. `layer_size` is sizeof *layer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_layer_default(
    layer: *mut RaraLayer,
    layer_size: usize,
    name: *const c_char,
    gaussians: *const RaraGaussians,
) -> RaraResult {
    let default = RaraLayer::new(name, gaussians);
    guard(|| write(layer, layer_size, &default, "layer"))
}

/// The state of a layer, as it was uploaded or last set; its rotation has length one. `state_size` is sizeof *state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_scene_buffers_layer_state(
    scene: *const RaraSceneBuffers,
    index: usize,
    state: *mut RaraLayerState,
    state_size: usize,
) -> RaraResult {
    guard(|| {
        let scene = alive(scene, "scene")?;
        check_index(&scene, index)?;
        let found = scene.buffers.layers()[index].state().into();
        write(state, state_size, &found, "state")
    })
}

/// Sets the state of a layer: the next rara_renderer_configure of every renderer takes it, and frames that are already
/// configured keep theirs, so that nothing has to be waited for. RARA_ERROR_INVALID for an opacity that is not 0 to 1 and
/// for an impossible placement; the state then stays as it was.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_scene_buffers_set_layer_state(
    scene: *mut RaraSceneBuffers,
    index: usize,
    state: *const RaraLayerState,
) -> RaraResult {
    guard(|| {
        let mut scene = alone(scene, "scene")?;
        check_index(&scene, index)?;
        let name = scene.buffers.layers()[index].name().to_owned();
        let state = self::state(state, "state", &name)?;
        scene.buffers.set_layer_state(index, state)
    })
}

/// Replaces the Gaussians of a layer by as many or fewer than it has room for, and waits for it. That adds a layer which was
/// uploaded empty with room, and removes one whose Gaussians are replaced by none. Nothing of the other layers is touched, and
/// the layer keeps its name, state and clip. The host has waited for all frames that show the scene; a frame
/// that was configured before, and a RaraCut, are configured anew. RARA_ERROR_INVALID for a number that no layer has, for more
/// Gaussians than it has room for or of a higher degree than the scene's, for colours of another light than the other layers',
/// and for a layer of Gaussians that rara_gaussians_select has divided.
///
/// # Safety
/// As for rara_scene_buffers_upload.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_scene_buffers_replace_layer(
    scene: *mut RaraSceneBuffers,
    index: usize,
    gaussians: *const RaraGaussians,
) -> RaraResult {
    guard(|| {
        let mut scene = alone(scene, "scene")?;
        check_index(&scene, index)?;
        let gaussians = alive(gaussians, "gaussians")?;
        scene.buffers.replace_layer(index, &gaussians.gaussians)
    })
}

/// Does what rara_scene_buffers_replace_layer does by the host's own means, as rara_scene_buffers_upload_with does: writes the
/// layer alone into the host's staging memory, which has rara_scene_buffers_layer_staging_bytes, and records the copies. Nothing
/// waits: frames that were submitted before show the layer as it was, those that are configured afterwards as it is.
///
/// # Safety
/// As for rara_scene_buffers_upload_with.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_scene_buffers_replace_layer_with(
    scene: *mut RaraSceneBuffers,
    cmd: vk::CommandBuffer,
    staging: *const RaraStaging,
    index: usize,
    gaussians: *const RaraGaussians,
) -> RaraResult {
    guard(|| {
        let mut scene = alone(scene, "scene")?;
        let cmd = recording(cmd)?;
        let staging = staging::staging(staging)?;
        check_index(&scene, index)?;
        let gaussians = alive(gaussians, "gaussians")?;
        let gaussians = &gaussians.gaussians;
        scene
            .buffers
            .replace_layer_with(cmd, staging, index, gaussians)
    })
}

/// Bytes of staging memory that rara_scene_buffers_replace_layer_with needs for so many Gaussians in place of a layer's; 0 for a
/// number that no layer has.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_scene_buffers_layer_staging_bytes(
    scene: *const RaraSceneBuffers,
    index: usize,
    gaussians: u32,
) -> u64 {
    number(scene, "scene", |scene| {
        scene.buffers.layer_staging_bytes(index, gaussians)
    })
}

/// Sets a clip for a layer alone, in place of the clip of rara_renderer_configure: a clip without planes keeps the whole
/// layer. Null gives the layer the frame's clip again. The clip stands in the scene: neither
/// the layer's placement nor that of rara_renderer_set_placement moves it, and the camera's planes are no part of it. It holds
/// from the next rara_renderer_configure of every renderer on. RARA_ERROR_INVALID for what is no clip; the layer's clip then
/// stays as it was.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_scene_buffers_set_layer_clip(
    scene: *mut RaraSceneBuffers,
    index: usize,
    clip: *const RaraClip,
) -> RaraResult {
    guard(|| {
        let mut scene = alone(scene, "scene")?;
        check_index(&scene, index)?;
        scene
            .buffers
            .set_layer_clip(index, clip::clip(clip, "clip")?)
    })
}

#[cfg(test)]
mod tests;
