//! A cut is what a clip keeps of a scene, for any number of renderers.

use rara::Cut;
use rara::ash::vk;

use crate::boundary::{RaraResult, guard, recording, shared};
use crate::clip::{self, RaraClip};
use crate::handles::{alive, alone, create, destroy, number};
use crate::placement::RaraPlacement;
use crate::renderer::RaraRenderer;
use crate::scene::RaraSceneBuffers;
use crate::settings::{self, RaraSettings};

/// A cut is what a clip keeps of a scene. It is found once for any number of eyes: renderers, each with a size, targets and
/// formats of its own, and pickers. rara_cut_configure says which clip cuts which scene, and rara_cut_prepare records the
/// commands that find what is kept. rara_renderer_configure_cut and rara_picker_record_cut then take the cut in place of a clip.
/// Calls of several threads take turns.
///
/// The cut has the settings mode, trace_all and, where the mode is RARA_MODE_RARA, sigma; each eye has all others. The states and
/// clips of the layers are as they were when the cut was configured. A camera's own near and far planes would cut as well, so that
/// the camera of an eye that is given a cut has none.
///
/// The commands of rara_cut_prepare come before those of the eyes in the queue. Memory that a cut has outgrown lives until the cut
/// has been recorded as many more times as the renderer of rara_cut_create has frames in flight.
pub struct RaraCut(pub(crate) Cut);

/// Creates a cut beside a renderer. It shares the renderer's compiled pipelines and takes its placement of this moment.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_cut_create(
    renderer: *const RaraRenderer,
    cut: *mut *mut RaraCut,
) -> RaraResult {
    create(cut, "cut", || {
        let renderer = alive(renderer, "renderer")?;
        Ok(RaraCut(Cut::new(&renderer.0)))
    })
}

/// Places the scene in the world, from the next rara_cut_configure on, as rara_renderer_set_placement does. The clip stays where
/// it is in the world.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_cut_set_placement(
    cut: *mut RaraCut,
    placement: *const RaraPlacement,
) -> RaraResult {
    guard(|| {
        let mut cut = alone(cut, "cut")?;
        cut.0
            .set_placement(shared(placement, "placement")?.placement()?);
        Ok(())
    })
}

/// Decides what is cut, and allocates and compiles what is missing. A null `clip` clips nothing, null `settings` are the
/// defaults. The call costs nothing where the same is cut as before.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_cut_configure(
    cut: *mut RaraCut,
    scene: *const RaraSceneBuffers,
    clip: *const RaraClip,
    settings: *const RaraSettings,
) -> RaraResult {
    guard(|| {
        let mut cut = alone(cut, "cut")?;
        let scene = alive(scene, "scene")?;
        let clip = clip::clip(clip, "clip")?.unwrap_or_default();
        let settings = settings::settings(settings)?;
        cut.0.configure(&scene.buffers, &clip, &settings)
    })
}

/// Records the commands that find what is kept, outside any rendering scope. Where they have been recorded since the cut was
/// configured, this records nothing. RARA_ERROR_INVALID before the cut is configured.
///
/// # Safety
/// `cmd` is recording outside a rendering scope, and will be submitted to the device's queue before the commands of the eyes. The
/// scene lives until the commands have executed. The host has waited for the frames that RaraRenderer says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_cut_prepare(cut: *mut RaraCut, cmd: vk::CommandBuffer) -> RaraResult {
    guard(|| {
        let mut cut = alone(cut, "cut")?;
        cut.0.prepare(recording(cmd)?)
    })
}

/// Forgets what was recorded, as is needed after commands that were never submitted: the next rara_cut_prepare records
/// everything.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_cut_forget(cut: *mut RaraCut) -> RaraResult {
    guard(|| {
        alone(cut, "cut")?.0.forget();
        Ok(())
    })
}

/// Returns the bytes of device memory that a cut takes, or 0 for what is no cut that is alive.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_cut_bytes(cut: *const RaraCut) -> u64 {
    number(cut, "cut", |cut| cut.0.bytes())
}

/// Frees a cut's memory; null is ignored. The host has waited for the frames that show it, or calls rara_device_destroy_after.
///
/// # Safety
/// `cut` is null, or alive and not used any more, not even by the device.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_cut_destroy(cut: *mut RaraCut) {
    destroy(cut);
}
