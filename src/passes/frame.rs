//! The frame on one page: its stages in order, from its constants to the draw.

use std::sync::LazyLock;

use ash::vk;
use smallvec::SmallVec;

use crate::passes::pipelines::PipelineKey;
use crate::passes::plan::Plan;
use crate::passes::recording::{Recording, Resources};
use crate::passes::sizes::Sizes;
use crate::passes::stage::{Stage, Targets};
use crate::passes::storage::Storage;
use crate::passes::work::Work;
use crate::passes::{
    bin, blocks, classify, clip, compact, composite, cutoff, depth, project, reclip, shared, sort,
    splat, tiles,
};
use rara_gpu::{Buffer, Recorder};

/// The stages whose results are the same for each eye. They come before those of an eye.
static OF_SCENE: [&Stage; 1] = [
    // Finds on which side of the clip each block of Gaussians lies, and each Gaussian of the blocks that it cuts.
    &clip::STAGE,
];

/// The stages that see with an eye.
static OF_VIEW: [&Stage; 12] = [
    // Finds which blocks are in view.
    &blocks::STAGE,
    // Finds which Gaussians are in view, in the blocks that are so in part.
    &classify::STAGE,
    // Lists them in order, and writes the sizes of all that follows.
    &compact::STAGE,
    // Writes the records from which the fragment stage weights the cut ones.
    &cutoff::STAGE,
    // Computes conic, quad, colour and depth key of the splats.
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

/// All stages in the order in which a frame has them. Nothing waits or is read back in between; each stage's work follows
/// from what the earlier ones left on the device.
fn stages() -> impl Iterator<Item = &'static Stage> {
    OF_SCENE.iter().chain(&OF_VIEW).copied()
}

/// The name of the draw, the last step, which a frame does without where the tiles' picture is the picture.
pub(crate) const DRAW: &str = "splat";

/// Bytes of the constants of a frame with few layers, for which recording takes no memory.
const FEW_LAYERS: usize = 4096;

/// The buffers of all stages.
static MEMORY: LazyLock<Vec<&'static Storage>> = LazyLock::new(|| {
    let of_stages = stages().flat_map(|stage| stage.memory);
    let all: Vec<_> = [shared::STORAGES]
        .iter()
        .chain(of_stages)
        .flat_map(|storages| storages.iter().copied())
        .collect();
    Storage::number(&all);
    all
});

/// Records everything up to the draw. `copied` is the rectangle of the host's depth under the picture; `readback` gets a copy
/// of the counts for the host.
pub(crate) fn record(
    plan: &Plan,
    recorder: &mut Recorder<'_>,
    resources: Resources<'_>,
    copied: vk::Rect2D,
    readback: &Buffer,
) {
    let b = resources.buffers;
    let shared = &shared::MEMORY;
    let [frame, surfaces, counts] =
        [&shared.frame, &shared.surfaces, &shared.counts].map(|s| b.get(s));
    if plan.work != Work::Draw {
        recorder.label("frame", |r| {
            let (layers, of_layers) = (plan.layers.layers(), plan.layers.surfaces());
            // By one command, since two into one buffer would wait for each other.
            let mut constants = SmallVec::<[u8; FEW_LAYERS]>::from(bytemuck::bytes_of(&plan.data));
            constants.extend_from_slice(bytemuck::cast_slice(layers));
            r.update(frame, 0, &constants);
            r.update(surfaces, 0, bytemuck::cast_slice(of_layers));
        });
    }
    record_stages(&mut Recording::new(plan, recorder, resources, copied));
    if plan.is_tiled() {
        let picture =
            [&tiles::MEMORY.tile_picture, &bin::lists::MEMORY.tile_begins].map(|s| b.get(s));
        match plan.is_drawn {
            true => recorder.ready_to_draw(&picture),
            false => recorder.ready_for_host(&picture),
        }
    }
    if plan.way.expects_depth {
        let depths = [&depth::MEMORY.depths, &depth::MEMORY.depth_draw].map(|s| b.get(s));
        recorder.ready_to_draw(&depths);
    }
    recorder.label("counts", |r| {
        let all = vk::BufferCopy::default().size(counts.size());
        r.copy(counts, readback, &[all]);
        r.ready_for_host(&[readback]);
    });
    let splats = &project::MEMORY;
    let drawn = [
        &splats.splats,
        &splats.quads,
        sort::order(plan),
        &cutoff::MEMORY.cut_records,
    ];
    let [splats, quads, order, cut_records] = drawn.map(|s| b.get(s));
    recorder.ready_to_draw(&[frame, counts, splats, quads, order, cut_records]);
}

fn record_stages(recording: &mut Recording<'_, '_>) {
    let plan = recording.plan;
    for stage in stages().filter(|stage| (stage.needed)(plan)) {
        recording.stage(stage.name, stage.record);
    }
}

impl Sizes {
    /// True when a picture's lists and pixels have so much room too.
    pub(crate) fn hold_tiles_of(&self, need: &Self) -> bool {
        let picture = [&bin::lists::MEMORY.tile_begins, &tiles::MEMORY.tile_picture];
        picture.iter().all(|s| self.bytes(s) >= need.bytes(s))
    }
}

impl Plan {
    /// The bytes of all buffers of the frame.
    pub(crate) fn sizes(&self) -> Sizes {
        Sizes::new(&MEMORY, self)
    }

    /// The pipelines of the whole frame.
    pub(crate) fn pipelines(&self, targets: Targets, need: &mut dyn FnMut(PipelineKey)) {
        let mut recording = Recording::dry(self, need);
        record_stages(&mut recording);
        if self.is_drawn {
            need(splat::draw(self, targets.colour).key());
        }
        if self.is_drawn && self.is_tiled() {
            need(composite::draw(self, targets).key());
        }
        if let Some(attachments) = targets.expected_depth {
            need(depth::draw(self, attachments).key());
        }
    }

    /// The stages that this frame does not need, among those of a whole one.
    pub(crate) fn skipped(&self) -> Vec<&'static str> {
        let is_empty = self.gaussians() == 0;
        let missed = |stage: &&Stage| (stage.missed)(self) && (is_empty || !(stage.needed)(self));
        let mut skipped: Vec<_> = stages().filter(missed).map(|stage| stage.name).collect();
        skipped.extend((is_empty || !self.is_drawn).then_some(DRAW));
        skipped
    }
}
