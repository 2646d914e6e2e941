//! Choices that suit a device: how splats become pixels on it, how its sort is divided, and how buffers are reached.

use rara_base::counted::counted;
use rara_base::error::{Error, Result};
use rara_base::limits;
use rara_gpu::{Bindings, DeviceShape, Support};
use rara_scene::settings::{Raster, Settings};

/// The properties of a host's targets that decide whether tiles can draw into them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Targets {
    pub(super) tiles: u32,
    /// True when splats are tested against a depth that tiles cannot read.
    pub(super) hidden: bool,
    pub(super) multisampled: bool,
    /// True when only tiles draw what the host gets beside colours and expected depths, or where it gets them: depths for its
    /// depth buffer, parts of splats, motion, one of several views.
    pub(super) beside: bool,
    /// True when colours become linear light, or are stored, once splats are blended.
    pub(super) converted: bool,
}

/// How splats become pixels on a device, and why in that way.
pub(super) fn raster(
    settings: &Settings,
    support: &Support,
    shape: DeviceShape,
    targets: Targets,
) -> Result<(Raster, &'static str)> {
    let draws = if support.mesh_shader && shape != DeviceShape::Cpu {
        Raster::Mesh
    } else {
        Raster::Quad
    };
    let needs_tiles = settings.show.needs_tiles() || targets.converted;
    let can_tile = !targets.hidden && matches!(settings.raster, Raster::Auto | Raster::Tiles);
    Ok(match settings.raster {
        _ if targets.converted && !can_tile => {
            return Err(Error::Invalid(
                "either the scene was trained in linear light or the host has it (ColorSpace::Linear), and only tiles can \
                 convert them for the other; use Raster::Auto or Raster::Tiles, and make the host's depth readable \
                 (DepthDesc::readable)"
                    .into(),
            ));
        }
        _ if needs_tiles && !can_tile => {
            return Err(Error::Invalid(format!(
                "only tiles can draw Show::{:?}; use Raster::Auto or Raster::Tiles, and a depth of the host's that is readable, if there is one",
                settings.show
            )));
        }
        _ if targets.beside && !can_tile => {
            return Err(Error::Invalid(
                "only tiles can write depths (DepthDesc::write_alpha), hide parts of splats (DepthDesc::soft), find motion \
                 (RendererDesc::motion) and draw into one view of a view mask; use Raster::Auto or Raster::Tiles"
                    .into(),
            ));
        }
        Raster::Auto if needs_tiles || targets.beside => {
            (Raster::Tiles, "only tiles show what is asked for")
        }
        Raster::Mesh if !support.mesh_shader => {
            return Err(Error::Device(
                "this device has no mesh shaders (VK_EXT_mesh_shader); use --raster quad".into(),
            ));
        }
        Raster::Auto if targets.hidden => (draws, HIDDEN),
        Raster::Tiles if targets.hidden => (Raster::Quad, HIDDEN),
        Raster::Auto if targets.tiles > MOST_TILES => {
            (draws, "the tiles' picture would take more than 1 GiB")
        }
        // See the guide's measurements (src/guide/speed.md).
        Raster::Auto if shape == DeviceShape::Cpu => {
            (Raster::Tiles, "a CPU driver charges for each drawn splat")
        }
        Raster::Auto if targets.multisampled => {
            (draws, "a GPU, and a target of several samples a pixel")
        }
        Raster::Auto => (Raster::Tiles, "a GPU, on which tiles are faster"),
        chosen => (chosen, "asked for"),
    })
}

pub(super) const HIDDEN: &str =
    "tiles need the host's depth before its scope (DepthDesc::readable)";

/// The bytes of a tile's pixels, and the most that a picture of them may take: what every device can allocate at once.
const TILE_BYTES: u64 = (limits::TILE_WIDTH * limits::TILE_HEIGHT) as u64 * 16;
const MOST_PICTURE: u64 = 1 << 30;

pub(super) const MOST_TILES: u32 = (MOST_PICTURE / TILE_BYTES) as u32;

/// Runs of the sort and of the bin: on CPU drivers at least as many as all cores have lanes, but few, since each has counts of
/// its own. The pipelines for GPUs have none; they divide their work into partitions.
pub(super) fn runs(shape: DeviceShape, gaussians: u32) -> u32 {
    match (shape, gaussians) {
        (DeviceShape::Cpu, ..32_768) => 128,
        (DeviceShape::Cpu, _) => 256,
        (DeviceShape::Gpu { .. }, _) => 0,
    }
}

/// How buffers are reached, the largest of which has so many bytes: as wanted, or else as the device can.
pub(super) fn bindings(support: &Support, wanted: Bindings, largest: u64) -> Result<Bindings> {
    let most = support.max_storage_buffer_range;
    match wanted.or_other(support) {
        // What is bound of others is small.
        Bindings::Bound if largest > most && support.buffer_device_address => Ok(Bindings::Address),
        Bindings::Bound if largest > most => Err(Error::Device(format!(
            "a buffer of {} cannot be bound: this device binds at most {most} (maxStorageBufferRange), and has no buffer \
             addresses, which have no such limit; enable bufferDeviceAddress, or draw fewer Gaussians or a smaller picture",
            counted(largest, "byte")
        ))),
        way => Ok(way),
    }
}

#[cfg(test)]
mod tests;
