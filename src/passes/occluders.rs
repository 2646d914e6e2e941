//! The depth that the host has drawn already, copied to where the tiles' compute shader can read it.

use ash::vk;

use crate::types;
use rara_scene::depth::DepthMap;

/// How the host's depth hides the splats of tiles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Occluders {
    /// `DEPTH_*`: how a copied depth is stored.
    pub(crate) form: u32,
    /// The meaning of the stored numbers.
    pub(crate) map: DepthMap,
    /// True when they hide what lies behind them of a splat, not whole splats by their centres.
    pub(crate) soft: bool,
    /// The picture's size, px.
    pub(crate) size: vk::Extent2D,
}

impl Occluders {
    /// The occluders of a host whose depth has this format and meaning, in a picture of no size yet.
    pub(crate) fn new(format: vk::Format, map: DepthMap, soft: bool) -> Self {
        let form = match format {
            vk::Format::D16_UNORM | vk::Format::D16_UNORM_S8_UINT => types::DEPTH_16,
            vk::Format::X8_D24_UNORM_PACK32 | vk::Format::D24_UNORM_S8_UINT => types::DEPTH_24,
            _ => types::DEPTH_FLOAT,
        };
        Self {
            form,
            map,
            soft,
            size: vk::Extent2D::default(),
        }
    }
}
