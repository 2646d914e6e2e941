//! Picking: the Gaussians that a part of a picture shows most of.

use rara::ash::vk;
use rara::{Kept, PickTicket, Picker, Result};

use crate::boundary::{RaraResult, exclusive, guard, invalid, recording, shared};
use crate::camera::{self, RaraCamera};
use crate::clip::{self, RaraClip};
use crate::cut::RaraCut;
use crate::handles::{alive, alone, create, destroy};
use crate::placement::RaraPlacement;
use crate::renderer::RaraRenderer;
use crate::scene::RaraSceneBuffers;
use crate::settings::{self, RaraSettings};

/// Finds the Gaussians that pixels show most of. Calls of several threads take turns.
pub struct RaraPicker(Picker);

/// A request that a picker has recorded. It never grows.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct RaraPickTicket {
    /// The picker's number.
    pub picker: u64,
    /// The request's.
    pub request: u64,
}

/// The splat that adds most to a pixel's alpha. It never grows.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct RaraPick {
    /// Its Gaussian's number in the scene: that in its layer, behind the room of the layers before it. Layers that
    /// rara_gaussians_select has divided number as the set did where all of them are in the scene, else without those that are
    /// missing.
    pub number: u32,
    /// The number of its layer.
    pub layer: u32,
    /// The alpha that the splat adds to the pixel, from 1/255 to 1. If no splat adds as much, it and all other fields are 0.
    pub alpha: f32,
}

/// Makes a picker beside a renderer, whose compiled pipelines it shares, and whose placement of this moment it takes. So many
/// requests, from 1 to 16, may be unfinished at once.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_picker_create(
    renderer: *const RaraRenderer,
    in_flight: u32,
    picker: *mut *mut RaraPicker,
) -> RaraResult {
    create(picker, "picker", || {
        let renderer = alive(renderer, "renderer")?;
        Ok(RaraPicker(Picker::new(&renderer.0, in_flight)?))
    })
}

/// Places the scene in the world, as rara_renderer_set_placement does for what is drawn.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_picker_set_placement(
    picker: *mut RaraPicker,
    placement: *const RaraPlacement,
) -> RaraResult {
    guard(|| {
        let mut picker = alone(picker, "picker")?;
        let placement = shared(placement, "placement")?.placement()?;
        picker.0.set_placement(placement);
        Ok(())
    })
}

/// Records the question what the pixels of a rectangle show most of, in the picture of a camera, outside a rendering scope. The
/// part of the picture is drawn into memory of the picker's own, with the clip, layers and weights of the whole; nothing of the
/// host's targets, of a renderer or of the scene changes, and nothing waits. The host's depth hides nothing from it. The first
/// request compiles what no frame needs: make one that nobody waits for.
/// RARA_ERROR_INVALID for a rectangle without pixels, or one that reaches out of the picture.
///
/// # Safety
/// As for rara_renderer_configure and rara_renderer_prepare, with requests in place of frames: of so many as
/// rara_picker_create was told the first one has finished before one more is recorded, and all of them before the picker ends.
/// `ticket` may be overwritten.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_picker_record(
    picker: *mut RaraPicker,
    cmd: vk::CommandBuffer,
    scene: *const RaraSceneBuffers,
    camera: *const RaraCamera,
    clip: *const RaraClip,
    settings: *const RaraSettings,
    x: i32,
    y: i32,
    width: u32,
    height: u32,
    ticket: *mut RaraPickTicket,
) -> RaraResult {
    guard(|| {
        let ticket = exclusive(ticket, "ticket")?;
        let clip = clip::clip(clip, "clip")?.unwrap_or_default();
        let rect = rect(x, y, width, height);
        *ticket = asked(picker, cmd, scene, camera, &clip, settings, rect)?;
        Ok(())
    })
}

/// Does what rara_picker_record does, for a picture that shows a cut in place of a clip's. The commands of rara_cut_prepare come
/// before in the queue.
///
/// # Safety
/// As for rara_picker_record. The cut lives until the commands have executed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_picker_record_cut(
    picker: *mut RaraPicker,
    cmd: vk::CommandBuffer,
    scene: *const RaraSceneBuffers,
    camera: *const RaraCamera,
    cut: *const RaraCut,
    settings: *const RaraSettings,
    x: i32,
    y: i32,
    width: u32,
    height: u32,
    ticket: *mut RaraPickTicket,
) -> RaraResult {
    guard(|| {
        let ticket = exclusive(ticket, "ticket")?;
        let cut = alive(cut, "cut")?;
        let rect = rect(x, y, width, height);
        *ticket = asked(picker, cmd, scene, camera, &cut.0, settings, rect)?;
        Ok(())
    })
}

/// Records a request about a picture that shows what a clip or a cut keeps.
unsafe fn asked<'a>(
    picker: *mut RaraPicker,
    cmd: vk::CommandBuffer,
    scene: *const RaraSceneBuffers,
    camera: *const RaraCamera,
    kept: impl Into<Kept<'a>>,
    settings: *const RaraSettings,
    rect: vk::Rect2D,
) -> Result<RaraPickTicket> {
    let mut picker = alone(picker, "picker")?;
    let scene = alive(scene, "scene")?;
    let camera = camera::camera(camera)?;
    let settings = settings::settings(settings)?;
    let (cmd, kept) = (recording(cmd)?, kept.into());
    let picker = &mut picker.0;
    let made = picker.record(cmd, &scene.buffers, &camera, kept, &settings, rect)?;
    let [picker, request] = made.numbers();
    Ok(RaraPickTicket { picker, request })
}

fn rect(x: i32, y: i32, width: u32, height: u32) -> vk::Rect2D {
    vk::Rect2D {
        offset: vk::Offset2D { x, y },
        extent: vk::Extent2D { width, height },
    }
}

/// Writes the answer to a request: a pick for each pixel of the rectangle, row by row from the upper left.
/// RARA_ERROR_INVALID for another picker's request, for one whose memory a later one has taken, and where `pick_count` is not
/// the number of pixels.
///
/// # Safety
/// `picker` is alive, and no other thread changes it; the submission in which the request was recorded has finished; `picks`
/// has room for `pick_count`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_picker_read(
    picker: *const RaraPicker,
    ticket: RaraPickTicket,
    picks: *mut RaraPick,
    pick_count: usize,
) -> RaraResult {
    guard(|| {
        let picker = alive(picker, "picker")?;
        if picks.is_null() {
            return invalid("picks is null");
        }
        let ticket = PickTicket::of_numbers([ticket.picker, ticket.request]);
        let found = picker.0.read(ticket)?;
        if found.pixels.len() != pick_count {
            return invalid(format!(
                "pick_count is {pick_count}, and the rectangle has {} pixels",
                found.pixels.len()
            ));
        }
        for (at, pick) in found.pixels.iter().enumerate() {
            let pick = pick.map_or(RaraPick::default(), |pick| RaraPick {
                number: pick.number,
                layer: pick.layer as u32,
                alpha: pick.alpha,
            });
            picks.add(at).write_unaligned(pick);
        }
        Ok(())
    })
}

/// Ends a picker; null is ignored. The device is done with its requests, or the host calls rara_device_destroy_after.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_picker_destroy(picker: *mut RaraPicker) {
    destroy(picker);
}
