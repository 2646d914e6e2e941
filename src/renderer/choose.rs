//! Choices that suit a device: how splats become pixels on it, and how its sort is divided.

use rara_base::error::{Error, Result};
use rara_base::limits;
use rara_gpu::{DeviceShape, Support};
use rara_scene::settings::{Raster, Settings};

/// The properties of a host's targets that decide whether tiles can draw into them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Targets {
    pub(super) tiles: u32,
    /// True when splats are tested against a depth that tiles cannot read.
    pub(super) hidden: bool,
    pub(super) multisampled: bool,
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
                "where splats and host are not both linear light (ColorSpace::Linear, Training::linear), the picture is \
                 made by tiles alone, since quads blend into the host's own target; leave the raster to itself, and make \
                 the host's depth readable (DepthDesc::readable)"
                    .into(),
            ));
        }
        _ if needs_tiles && !can_tile => {
            return Err(Error::Invalid(format!(
                "Show::{:?} is made by tiles alone; leave the raster to itself, and make the host's depth readable",
                settings.show
            )));
        }
        Raster::Auto if needs_tiles => (Raster::Tiles, "only tiles show what is asked for"),
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
        Raster::Auto => (
            Raster::Tiles,
            "a GPU, for which tiles are predicted to be faster",
        ),
        chosen => (chosen, "asked for"),
    })
}

const HIDDEN: &str = "tiles need the host's depth before its scope (DepthDesc::readable)";

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

#[cfg(test)]
mod tests {
    use super::*;

    fn chosen(shape: DeviceShape, mesh_shader: bool, targets: Targets) -> Raster {
        let mut support = Support::default();
        support.mesh_shader = mesh_shader;
        let settings = Settings::default();
        let (raster, reason) = raster(&settings, &support, shape, targets).expect("a choice");
        assert!(!reason.is_empty());
        raster
    }

    #[test]
    fn linear_light_without_tiles_is_refused() {
        let targets = Targets {
            tiles: 1000,
            hidden: false,
            multisampled: false,
            converted: true,
        };
        let hidden = Targets {
            hidden: true,
            ..targets
        };
        let (usual, support) = (Settings::default(), Support::default());
        for (settings, targets) in [(usual.raster(Raster::Quad), targets), (usual, hidden)] {
            let refused = raster(&settings, &support, DeviceShape::Cpu, targets);
            let text = refused.expect_err("quads").to_string();
            assert!(text.contains("ColorSpace::Linear"), "{text}");
        }
    }

    #[test]
    fn tiles_are_chosen_where_they_can_draw() {
        let gpu = DeviceShape::Gpu { subgroup: 32 };
        let usual = Targets {
            tiles: 1000,
            hidden: false,
            multisampled: false,
            converted: false,
        };
        let hidden = Targets {
            hidden: true,
            ..usual
        };
        let multisampled = Targets {
            multisampled: true,
            ..usual
        };
        let large = Targets {
            tiles: 1 << 21,
            ..usual
        };
        for mesh_shader in [false, true] {
            assert_eq!(chosen(gpu, mesh_shader, usual), Raster::Tiles);
            let draws = if mesh_shader {
                Raster::Mesh
            } else {
                Raster::Quad
            };
            for targets in [hidden, multisampled, large] {
                assert_eq!(chosen(gpu, mesh_shader, targets), draws, "{targets:?}");
            }
            assert_eq!(chosen(DeviceShape::Cpu, mesh_shader, usual), Raster::Tiles);
            let linear = Targets {
                converted: true,
                ..multisampled
            };
            assert_eq!(chosen(gpu, mesh_shader, linear), Raster::Tiles);
            assert_eq!(
                chosen(DeviceShape::Cpu, mesh_shader, multisampled),
                Raster::Tiles
            );
            for targets in [hidden, large] {
                assert_eq!(chosen(DeviceShape::Cpu, mesh_shader, targets), Raster::Quad);
            }
        }
    }
}
