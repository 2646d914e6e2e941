//! Choices that suit a device: how splats become pixels on it, and how its sort is divided.

use crate::error::{Error, Result};
use crate::gpu::{DeviceShape, Support};
use crate::limits;
use crate::settings::Raster;

/// How splats become pixels on a device, and why in that way. `hidden` says that tiles cannot see the host's depth.
pub(super) fn raster(
    wanted: Raster,
    support: &Support,
    shape: DeviceShape,
    tiles: u32,
    hidden: bool,
) -> Result<(Raster, &'static str)> {
    let tiled = wanted == Raster::Tiles || (wanted == Raster::Auto && shape == DeviceShape::Cpu);
    Ok(match wanted {
        Raster::Auto | Raster::Tiles if hidden && tiled => {
            let reason = "tiles need the host's depth before its scope (DepthDesc::readable)";
            (Raster::Quad, reason)
        }
        Raster::Auto if u64::from(tiles) * TILE_BYTES > MOST_PICTURE => {
            let reason = "the tiles' picture would take more than 1 GiB";
            (Raster::Quad, reason)
        }
        // See the guide's measurements (src/guide/speed.md).
        Raster::Auto if shape == DeviceShape::Cpu => {
            (Raster::Tiles, "a CPU driver charges for each drawn splat")
        }
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

/// The bytes of a tile's pixels, and the most that a picture of them may take: what every device can allocate at once.
const TILE_BYTES: u64 = (limits::TILE_WIDTH * limits::TILE_HEIGHT) as u64 * 16;
const MOST_PICTURE: u64 = 1 << 30;

/// Runs of the sort and of the bin: on CPU drivers at least as many as all cores have lanes, but few, since each has counts of
/// its own. The kernels for GPUs have none; they divide their work into partitions.
pub(super) fn runs(shape: DeviceShape, gaussians: u32) -> u32 {
    match (shape, gaussians) {
        (DeviceShape::Cpu, ..32_768) => 128,
        (DeviceShape::Cpu, _) => 256,
        (DeviceShape::Gpu { .. }, _) => 0,
    }
}
