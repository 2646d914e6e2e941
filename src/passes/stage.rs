//! What a stage of the frame is, and the list of all of them.

use ash::vk;

use crate::gpu::{Attachments, Recorder};
use crate::passes::buffers::{Buffers, DepthBuffers, ReclipBuffers, TileBuffers};
use crate::passes::pipelines::{PipelineKey, Pipelines};
use crate::passes::plan::Plan;
use crate::passes::scene_buffers::SceneBuffers;
use crate::passes::{
    bin, blocks, classify, clip, compact, cutoff, depth, project, reclip, sort, splat, tiles,
};

/// A step of the frame that is computed before the draw.
#[derive(Debug)]
pub(crate) struct Stage {
    /// Of its file, debug label, timer and statistics.
    pub(crate) name: &'static str,
    /// Whether a frame needs it.
    pub(crate) needed: fn(&Plan) -> bool,
    /// Whether it is said of a frame that it does without.
    pub(crate) missed: fn(&Plan) -> bool,
    /// What it dispatches in a frame that needs it.
    pub(crate) pipelines: fn(&Plan, &mut dyn FnMut(PipelineKey)),
    /// Records it in a frame that needs it.
    pub(crate) record: fn(&Frame<'_>, &mut Recorder<'_>),
}

/// All stages in the order in which a frame has them. Nothing waits or is read back in between; each stage's work follows
/// from what the ones before it left on the device.
pub(crate) const STAGES: [&Stage; 13] = [
    // On which side of the clip each block of Gaussians lies, and each Gaussian of those that it cuts.
    &clip::STAGE,
    // Which blocks are in view.
    &blocks::STAGE,
    // Which Gaussians of those that are so in part.
    &classify::STAGE,
    // Their numbers, in order, and the sizes of all that follows.
    &compact::STAGE,
    // What the fragment stage needs of the cut ones.
    &cutoff::STAGE,
    // Conic, quad, colour and depth key of the survivors.
    &project::STAGE,
    // Their order.
    &sort::STAGE,
    // Which of them each tile of pixels holds.
    &bin::STAGE,
    // The camera stands still and the clip has moved: which Gaussians in view change their class,
    &reclip::RECLIP,
    // what the fragment stage needs of those that are cut now,
    &cutoff::STAGE_OF_RECLIP,
    // and what the rasteriser holds of all that change.
    &reclip::RECUT,
    // The pixels, front to back.
    &tiles::STAGE,
    // How deep the splats are, for who asks.
    &depth::STAGE,
];

/// The name of the draw, the last step.
pub(crate) const DRAW: &str = "splat";

/// What a stage records with.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Frame<'a> {
    pub(crate) plan: &'a Plan,
    pub(crate) pipelines: &'a Pipelines,
    pub(crate) scene: &'a SceneBuffers,
    pub(crate) buffers: &'a Buffers,
    /// Where the host's depth lies under the picture, for tiles that it hides.
    pub(crate) copied: vk::Rect2D,
}

/// What a frame draws into.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Targets {
    pub(crate) colour: Attachments,
    /// Those of expected depths, where they are drawn.
    pub(crate) expected_depth: Option<Attachments>,
}

impl<'a> Frame<'a> {
    /// The buffers of the tile rasteriser.
    pub(crate) fn tiles(&self) -> &'a TileBuffers {
        let tiles = self.buffers.tiles.as_ref();
        tiles.expect("a plan for tiles has their buffers")
    }

    /// The buffers of expected depths.
    pub(crate) fn depths(&self) -> &'a DepthBuffers {
        let depths = self.buffers.depth.as_ref();
        depths.expect("a plan that expects depths has their buffers")
    }

    /// The buffers of a reclipped frame.
    pub(crate) fn reclip(&self) -> &'a ReclipBuffers {
        let reclip = self.buffers.reclip.as_ref();
        reclip.expect("configure() creates what a reclipped frame needs")
    }
}

impl Plan {
    /// The pipelines of the whole frame.
    pub(crate) fn pipelines(&self, targets: Targets, need: &mut dyn FnMut(PipelineKey)) {
        for stage in STAGES.iter().filter(|stage| (stage.needed)(self)) {
            (stage.pipelines)(self, need);
        }
        need(splat::draw(self, targets.colour).key());
        if self.is_tiled() {
            need(tiles::composite(targets.colour).key());
        }
        if let Some(attachments) = targets.expected_depth {
            need(depth::draw(self, attachments).key());
        }
    }

    /// The stages that this frame does not need, among those of a whole one.
    pub(crate) fn skipped(&self) -> Vec<&'static str> {
        let is_empty = self.gaussians() == 0;
        let missed = |stage: &&&Stage| (stage.missed)(self) && (is_empty || !(stage.needed)(self));
        let mut skipped: Vec<_> = STAGES
            .iter()
            .filter(missed)
            .map(|stage| stage.name)
            .collect();
        skipped.extend(is_empty.then_some(DRAW));
        skipped
    }
}
