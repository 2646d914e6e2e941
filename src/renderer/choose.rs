//! What suits a device: how splats become pixels on it, and how its sort is divided.

use crate::error::{Error, Result};
use crate::gpu::Support;
use crate::limits;
use crate::settings::Raster;

/// How splats become pixels on a device, and why in that way. `hidden` is what tiles cannot see: the host's depth.
pub(super) fn raster(
    wanted: Raster,
    support: &Support,
    is_cpu: bool,
    tiles: u32,
    hidden: bool,
) -> Result<(Raster, &'static str)> {
    let tiled = wanted == Raster::Tiles || (wanted == Raster::Auto && is_cpu);
    Ok(match wanted {
        Raster::Auto | Raster::Tiles if hidden && tiled => {
            let reason = "tiles need the host's depth before its scope (DepthDesc::readable)";
            (Raster::Quad, reason)
        }
        Raster::Auto if u64::from(tiles) * TILE_BYTES > MOST_PICTURE => {
            let reason = "the tiles' picture would take more than 1 GiB";
            (Raster::Quad, reason)
        }
        // See the guide's measurements (src/guide/frame.md).
        Raster::Auto if is_cpu => (Raster::Tiles, "a CPU driver charges for each drawn splat"),
        Raster::Auto if support.mesh_shader => (Raster::Mesh, "a GPU with mesh shaders"),
        Raster::Auto => (Raster::Quad, "a GPU without mesh shaders"),
        Raster::Mesh if !support.mesh_shader => {
            return Err(Error::Device(
                "this device has no mesh shaders (VK_EXT_mesh_shader); use --raster quad".into(),
            ));
        }
        chosen => (chosen, "asked for"),
    })
}

/// What a tile's pixels take, and the most that a picture of them may: what every device can allocate at once.
const TILE_BYTES: u64 = (limits::TILE_WIDTH * limits::TILE_HEIGHT) as u64 * 16;
const MOST_PICTURE: u64 = 1 << 30;

/// Runs of the sort: each costs a histogram, so few where there is little to sort and on CPU drivers; but at least the
/// lanes of all cores there, and on GPUs enough invocations to hide the latency of their scattered writes.
pub(super) fn sort_runs(is_cpu: bool, gaussians: u32) -> u32 {
    match (is_cpu, gaussians) {
        (true, ..32_768) => 128,
        (true, _) => 256,
        (false, _) => 2048,
    }
}
