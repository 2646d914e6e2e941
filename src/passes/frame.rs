//! The frame on one page: its stages in order, from its constants to the draw.

use smallvec::SmallVec;

use crate::gpu::{Buffer, Recorder};
use crate::passes::pipelines::PipelineKey;
use crate::passes::plan::Plan;
use crate::passes::stage::{Frame, Stage, Targets};
use crate::passes::work::Work;
use crate::passes::{
    bin, blocks, classify, clip, compact, cutoff, depth, project, reclip, sort, splat, tiles,
};

/// All stages in the order in which a frame has them. Nothing waits or is read back in between; each stage's work follows
/// from what the earlier ones left on the device.
pub(crate) const STAGES: [&Stage; 13] = [
    // Finds on which side of the clip each block of Gaussians lies, and each Gaussian of the blocks that it cuts.
    &clip::STAGE,
    // Finds which blocks are in view.
    &blocks::STAGE,
    // Finds which Gaussians are in view, in the blocks that are so in part.
    &classify::STAGE,
    // Lists them in order, and writes the sizes of all that follows.
    &compact::STAGE,
    // Writes the records from which the fragment stage weights the cut ones.
    &cutoff::STAGE,
    // Computes conic, quad, colour and depth key of the survivors.
    &project::STAGE,
    // Orders them by depth.
    &sort::STAGE,
    // Finds which of them each tile of pixels holds.
    &bin::STAGE,
    // Finds, where the camera stands still and the clip has moved, which Gaussians in view change their side,
    &reclip::RECLIP,
    // writes the records of those that are cut now,
    &cutoff::STAGE_OF_RECLIP,
    // and changes what the rasteriser holds of all that change.
    &reclip::RECUT,
    // Draws the pixels, front to back.
    &tiles::STAGE,
    // Finds how deep the splats are, for hosts that ask.
    &depth::STAGE,
];

/// The name of the draw, the last step, which a frame does without where the tiles' picture is the picture.
pub(crate) const DRAW: &str = "splat";

/// Bytes of the constants of a frame with few layers, for which recording takes no memory.
const FEW_LAYERS: usize = 4096;

/// Records everything up to the draw. `readback` gets a copy of the counts for the host.
pub(crate) fn record(frame: &Frame<'_>, recorder: &mut Recorder<'_>, readback: &Buffer) {
    let (plan, b) = (frame.plan, frame.buffers);
    if plan.work != Work::Draw {
        recorder.label("frame", |r| {
            let (layers, surfaces) = (plan.layers.layers(), plan.layers.surfaces());
            // By one command, since two into one buffer would wait for each other.
            let mut constants = SmallVec::<[u8; FEW_LAYERS]>::from(bytemuck::bytes_of(&plan.data));
            constants.extend_from_slice(bytemuck::cast_slice(layers));
            r.update(&b.frame, 0, &constants);
            r.update(&b.surfaces, 0, bytemuck::cast_slice(surfaces));
        });
    }
    for stage in STAGES.iter().filter(|stage| (stage.needed)(plan)) {
        recorder.pass(stage.name, |r| (stage.record)(frame, r));
    }
    if let Some(t) = b.tiles.as_ref().filter(|_| plan.is_tiled()) {
        if plan.is_drawn {
            recorder.ready_to_draw(&[&t.picture.pixels, &t.picture.begins]);
        } else {
            recorder.ready_for_host(&[&t.picture.pixels, &t.picture.begins]);
        }
    }
    if let Some(d) = b.depth.as_ref().filter(|_| plan.way.expects_depth) {
        recorder.ready_to_draw(&[&d.depths, &d.draw]);
    }
    recorder.label("counts", |r| {
        let all = ash::vk::BufferCopy::default().size(b.counts.size());
        r.copy(&b.counts, readback, &[all]);
        r.ready_for_host(&[readback]);
    });
    let order = &b.order[plan.sorted()];
    recorder.ready_to_draw(&[
        &b.frame,
        &b.counts,
        &b.splats,
        &b.quads,
        order,
        &b.cut_records,
    ]);
}

impl Plan {
    /// The pipelines of the whole frame.
    pub(crate) fn pipelines(&self, targets: Targets, need: &mut dyn FnMut(PipelineKey)) {
        for stage in STAGES.iter().filter(|stage| (stage.needed)(self)) {
            (stage.pipelines)(self, need);
        }
        if self.is_drawn {
            need(splat::draw(self, targets.colour).key());
        }
        if self.is_drawn && self.is_tiled() {
            need(tiles::composite(self, targets).key());
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
        skipped.extend((is_empty || !self.is_drawn).then_some(DRAW));
        skipped
    }
}
