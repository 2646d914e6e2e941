//! The statistics of a frame.

use std::ffi::c_char;

use rara::ash::vk;

use crate::boundary::{RaraResult, Versioned, guard, versioned, write, write_list};
use crate::handles::alive;
use crate::names::in_c;
use crate::renderer::RaraRenderer;
use crate::settings::{
    RARA_RASTER_AUTO, RARA_RASTER_MESH, RARA_RASTER_QUAD, RARA_RASTER_TILES, RaraRaster,
};
use crate::text::fixed;

/// Room for a stage's name, the NUL at its end included.
pub const RARA_NAME_SIZE: usize = 16;
/// Room for a reason, the NUL at its end included.
pub const RARA_REASON_SIZE: usize = 96;
/// Room for the stages of a frame.
pub const RARA_MAX_PASSES: usize = 32;

/// GPU time of one stage. It never grows.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct RaraPassTime {
    /// The stage: the same name as its shader and its debug label.
    pub name: [c_char; RARA_NAME_SIZE],
    /// Milliseconds between its timestamps.
    pub ms: f64,
}

/// The statistics of a frame. Counts and times are of the oldest frame in flight, which is the last one where there is
/// only one.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct RaraFrameStats {
    /// Set by rara_renderer_stats.
    pub struct_size: usize,
    /// Gaussians in view and untouched by the clip.
    pub visible: u32,
    /// Gaussians in view and cut by the clip.
    pub cutoff: u32,
    /// Gaussians in view but wholly clipped away.
    pub invisible: u32,
    /// Gaussians outside the view or too faint, whatever the clip says.
    pub culled: u32,
    /// Splats handed to the rasteriser.
    pub drawn: u32,
    /// How splats became pixels; RARA_RASTER_AUTO before the first frame.
    pub raster: RaraRaster,
    /// Why splats became pixels in that way.
    pub raster_reason: [c_char; RARA_REASON_SIZE],
    /// True when tiles had no room for their lists, so that they looked for their splats in coarse ones, which is slower and
    /// gives the same picture. The next rara_renderer_configure makes the room.
    pub fell_back: vk::Bool32,
    /// Number of passes; 0 without RaraRendererDesc's timing.
    pub pass_count: u32,
    /// GPU time of each stage, in order.
    pub passes: [RaraPassTime; RARA_MAX_PASSES],
    /// GPU time of the frame, milliseconds; NAN where pass_count is 0.
    pub gpu_ms: f64,
    /// Number of skipped stages.
    pub skipped_count: u32,
    /// The stages that the frame did not need.
    pub skipped: [[c_char; RARA_NAME_SIZE]; RARA_MAX_PASSES],
}

versioned!(RaraFrameStats);

/// The statistics of a frame, to be asked for after waiting for it and before the next rara_renderer_prepare.
/// `stats_size` is sizeof *stats.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_stats(
    renderer: *const RaraRenderer,
    stats: *mut RaraFrameStats,
    stats_size: usize,
) -> RaraResult {
    guard(|| {
        let renderer = &alive(renderer, "renderer")?.0;
        let (counts, raster) = (renderer.counts(), renderer.raster());
        let (times, skipped) = (renderer.pass_times(), renderer.skipped());
        let mut found = RaraFrameStats {
            visible: counts.visible,
            cutoff: counts.cutoff,
            invisible: counts.invisible,
            culled: counts.culled,
            drawn: counts.drawn,
            raster: match raster.path {
                "mesh" => RARA_RASTER_MESH,
                "quad" => RARA_RASTER_QUAD,
                "tiles" => RARA_RASTER_TILES,
                _ => RARA_RASTER_AUTO,
            },
            raster_reason: fixed(&in_c(raster.reason)),
            fell_back: renderer.fell_back().into(),
            pass_count: times.len().min(RARA_MAX_PASSES) as u32,
            gpu_ms: match times.is_empty() {
                true => f64::NAN,
                false => times.iter().map(|pass| pass.ms).sum(),
            },
            skipped_count: skipped.len().min(RARA_MAX_PASSES) as u32,
            ..Versioned::BLANK
        };
        for (to, from) in found.passes.iter_mut().zip(&times) {
            to.name = fixed(from.name);
            to.ms = from.ms;
        }
        for (to, from) in found.skipped.iter_mut().zip(&skipped) {
            *to = fixed(from);
        }
        write(stats, stats_size, &found, "stats")
    })
}

/// When one stage of a frame began and ended.
///
/// Ticks are of the device's clock: RaraSupport::timestamp_period nanoseconds each. They have as many bits as the queue family's
/// timestampValidBits, and begin at 0 again after those. vkGetCalibratedTimestampsEXT reads the same clock beside the host's. It never grows.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct RaraPassSpan {
    /// The stage, as in RaraPassTime.
    pub name: [c_char; RARA_NAME_SIZE],
    /// The tick at which all earlier work was done.
    pub begin: u64,
    /// The tick at which its own work was done too.
    pub end: u64,
}

/// The work of one stage, as the device counts it. It never grows.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct RaraPassStatistics {
    /// The stage, as in RaraPassTime.
    pub name: [c_char; RARA_NAME_SIZE],
    /// Compute shader invocations.
    pub compute_invocations: u64,
    /// Vertex shader invocations; mesh shaders have none.
    pub vertex_invocations: u64,
    /// Primitives that are left after clipping.
    pub primitives: u64,
    /// Fragment shader invocations.
    pub fragment_invocations: u64,
}

/// Lists when each stage of the frame of rara_renderer_stats began and ended, in the order in which they began; there are none
/// without RaraRendererDesc's timing. Asked for at the same moment.
///
/// On entry `*count` is how many there is room for at `spans`; it becomes how many there are. No more are written than there is
/// room for, and none where `spans` is null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_pass_spans(
    renderer: *const RaraRenderer,
    spans: *mut RaraPassSpan,
    count: *mut usize,
) -> RaraResult {
    guard(|| {
        let found = alive(renderer, "renderer")?.0.pass_spans();
        write_list(spans, count, &found, |span| RaraPassSpan {
            name: fixed(span.name),
            begin: span.begin,
            end: span.end,
        })
    })
}

/// Lists the work of each stage of the frame of rara_renderer_stats; there are none without RaraRendererDesc's timing and
/// statistics. Asked for at the same moment.
///
/// On entry `*count` is how many there is room for at `statistics`; it becomes how many there are. No more are written than there
/// is room for, and none where `statistics` is null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_pass_statistics(
    renderer: *const RaraRenderer,
    statistics: *mut RaraPassStatistics,
    count: *mut usize,
) -> RaraResult {
    guard(|| {
        let found = alive(renderer, "renderer")?.0.pass_statistics();
        write_list(statistics, count, &found, |pass| RaraPassStatistics {
            name: fixed(pass.name),
            compute_invocations: pass.compute_invocations,
            vertex_invocations: pass.vertex_invocations,
            primitives: pass.primitives,
            fragment_invocations: pass.fragment_invocations,
        })
    })
}
