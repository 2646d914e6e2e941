//! Frames without perspective. A `RaraCamera` has no room to say its projection, so that the calls say it.

use rara::{Camera, DepthMap, Projection};

use crate::boundary::RaraResult;
use crate::camera::{RaraCamera, look, make};
use crate::clip::{self, RaraClip};
use crate::frame::{RaraFrame, configure};
use crate::renderer::{RaraRenderer, with};
use crate::scene::RaraSceneBuffers;
use crate::settings::RaraSettings;

/// A camera for rara_renderer_configure_orthographic at `eye` that looks at `target`, whose picture of `width` x `height`
/// pixels is `view_height` world units high. `eye`, `target` and `up` are as for rara_camera_look_at; RaraClip::near_cut
/// says from which depth on splats are drawn.
///
/// # Safety
/// `eye`, `target` and `up` point to three numbers each; `camera` may be overwritten.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_camera_orthographic(
    eye: *const f64,
    target: *const f64,
    up: *const f64,
    view_height: f64,
    width: u32,
    height: u32,
    camera: *mut RaraCamera,
) -> RaraResult {
    // SAFETY: the caller's promises.
    unsafe {
        make(camera, || {
            let [eye, target, up] = look(eye, target, up)?;
            Camera::orthographic(eye, target, up, view_height, (width, height))
        })
    }
}

/// As rara_renderer_configure, for a frame without perspective: lines of sight run along the view axis, and the camera's `fx`
/// and `fy` are the pixels of a world unit. A renderer with a depth attachment needs
/// rara_renderer_set_orthographic_depth_map before.
///
/// # Safety
/// As for rara_renderer_configure.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_configure_orthographic(
    renderer: *mut RaraRenderer,
    scene: *const RaraSceneBuffers,
    camera: *const RaraCamera,
    clip: *const RaraClip,
    settings: *const RaraSettings,
    frame: *mut *mut RaraFrame,
) -> RaraResult {
    // SAFETY: the caller's promises.
    unsafe {
        let seen = || Ok((Projection::Orthographic, clip::kept(clip)?));
        configure(renderer, scene, camera, seen, settings, frame)
    }
}

/// Changes what the host's depth buffer holds for a depth, from the next rara_renderer_configure_orthographic on: 0 at
/// `z_zero` along the view axis, 1 at `z_one`, world units, and linear between them. Nearer is more where `z_one` is the
/// nearer one.
///
/// # Safety
/// `renderer` is alive, was created with a depth attachment, and is not used by another thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_set_orthographic_depth_map(
    renderer: *mut RaraRenderer,
    z_zero: f64,
    z_one: f64,
) -> RaraResult {
    with(renderer, |renderer| {
        renderer.set_depth_map(DepthMap::orthographic(z_zero, z_one)?)
    })
}
