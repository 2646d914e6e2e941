//! The depth that the host has drawn already, copied to where the tiles' compute shader can read it, or sampled by stage
//! `host_depth`.

use ash::vk;

use crate::passes::eye_plan::EyePlan;
use crate::passes::pipelines::FromPlan;
use crate::passes::recording::{Groups, Recording};
use crate::passes::shaders::host_depth;
use crate::passes::stage::Stage;
use crate::passes::storage::buffers;
use crate::passes::tiles;
use crate::types;
use rara_base::limits;
use rara_scene::depth::DepthMap;

/// Reads depths that are sampled.
pub(super) static STAGE: Stage<EyePlan> = Stage {
    name: "host_depth",
    needed: |plan| plan.occluders.is_some_and(|occluders| occluders.sampled),
    missed: |_| false,
    memory: &[],
    record,
};

fn record(recording: &mut Recording<'_, '_, EyePlan>) {
    let Some(occluders) = recording.plan.occluders else {
        return;
    };
    let under = recording.depth().map(|depth| depth.under);
    let (first, size) = under.map_or(([0; 2], vk::Extent2D::default()), |under| {
        (under.first, under.part.extent)
    });
    let params = host_depth::Params {
        first,
        size: [size.width, size.height],
    };
    let buffers = buffers!(host_depth {
        tiles::MEMORY => [occluders],
    });
    let pixels_of_word = if occluders.form == types::DEPTH_16 {
        2
    } else {
        1
    };
    let words = (size.width * size.height).div_ceil(pixels_of_word);
    let groups = Groups::Count(words.div_ceil(limits::HOST_DEPTH_GROUP_SIZE));
    recording.dispatch(buffers, params, groups);
}

impl FromPlan<EyePlan> for host_depth::Constants {
    fn from_plan(plan: &EyePlan) -> Self {
        Self {
            depth_form: plan.occluders.map_or(types::DEPTH_NONE, |o| o.form),
        }
    }
}

/// How the host's depth hides the splats of tiles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Occluders {
    /// `DEPTH_*`: how a copied depth is stored.
    pub(crate) form: u32,
    /// The meaning of the stored numbers.
    pub(crate) map: DepthMap,
    /// True when they hide what lies behind them of a splat, not whole splats by their centres.
    pub(crate) soft: bool,
    /// True when they are sampled, not copied.
    pub(crate) sampled: bool,
    /// The picture's size, px.
    pub(crate) size: vk::Extent2D,
}

impl Occluders {
    /// The occluders of a host whose depth has this format and meaning, in a picture of no size yet.
    pub(crate) fn new(format: vk::Format, map: DepthMap) -> Self {
        let form = match format {
            vk::Format::D16_UNORM | vk::Format::D16_UNORM_S8_UINT => types::DEPTH_16,
            vk::Format::X8_D24_UNORM_PACK32 | vk::Format::D24_UNORM_S8_UINT => types::DEPTH_24,
            _ => types::DEPTH_FLOAT,
        };
        Self {
            form,
            map,
            soft: false,
            sampled: false,
            size: vk::Extent2D::default(),
        }
    }
}
