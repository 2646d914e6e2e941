//! The frame on one page: its stages in order, from its constants to the draw.

use std::sync::LazyLock;

use ash::vk;
use bytemuck::{bytes_of, cast_slice};
use smallvec::SmallVec;

use crate::passes::buffers::Buffers;
use crate::passes::composite::Part;
use crate::passes::cut_plan::CutPlan;
use crate::passes::eye_plan::EyePlan;
use crate::passes::motion::Sight;
use crate::passes::owner::Owner;
use crate::passes::pipelines::PipelineKey;
use crate::passes::recording::Recording;
use crate::passes::resources::{CutName, CutResources, EyeName, EyeResources};
use crate::passes::sizes::Sizes;
use crate::passes::stage::{Stage, Targets};
use crate::passes::storage::Storage;
use crate::passes::work::Work;
use crate::passes::{
    bin, blocks, classify, clip, compact, composite, cutoff, depth, motion, occluders, project,
    reclip, shared, sort, splat, tiles,
};
use crate::types::{FrameData, LayerData};
use rara_gpu::{Buffer, Recorder};

/// The stages of a cut. They come before those of the eyes that see it.
static OF_CUT: [&Stage<CutPlan>; 1] = [
    // Finds on which side of the clip each block of Gaussians lies, and each Gaussian of the blocks that it cuts.
    &clip::STAGE,
];

/// The stages of an eye. Nothing waits or is read back in between; each stage's work follows from what the earlier ones left on
/// the device.
static OF_EYE: [&Stage<EyePlan>; 13] = [
    // Reads the host's depth where it is sampled.
    &occluders::STAGE,
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
    // Finds how deep they are, for hosts that ask. The barrier that the next stage needs in any case is this one's too.
    &depth::STAGE,
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
];

/// The name of the draw, the last step, which a frame does without where the tiles' picture is the picture.
pub(crate) const DRAW: &str = "splat";

/// Bytes of the constants of a frame with few layers, for which recording takes no memory.
const FEW_LAYERS: usize = 4096;

impl Owner for CutPlan {
    type Name = CutName;

    fn storages() -> &'static [&'static Storage<Self>] {
        static ALL: LazyLock<Vec<&Storage<CutPlan>>> =
            LazyLock::new(|| Storage::numbered(OF_CUT.iter().flat_map(|stage| stage.memory)));
        &ALL
    }

    fn empty() -> &'static Storage<Self> {
        &clip::MEMORY.empty
    }

    fn scene_size(&self) -> [u64; 2] {
        [self.gaussians(), self.blocks()]
    }
}

impl Owner for EyePlan {
    type Name = EyeName;

    fn storages() -> &'static [&'static Storage<Self>] {
        static ALL: LazyLock<Vec<&Storage<EyePlan>>> = LazyLock::new(|| {
            let of_stages = OF_EYE.iter().flat_map(|stage| stage.memory);
            Storage::numbered([shared::STORAGES].iter().chain(of_stages))
        });
        &ALL
    }

    fn empty() -> &'static Storage<Self> {
        &shared::MEMORY.empty
    }

    fn scene_size(&self) -> [u64; 2] {
        self.cut.scene_size()
    }
}

/// Writes the surfaces of a cut, which the stages of its eyes read too, and, for the stage that finds sides, its constants.
fn write_cut(plan: &CutPlan, recorder: &mut Recorder<'_>, buffers: &Buffers<CutPlan>) {
    let memory = &clip::MEMORY;
    if plan.finds_sides {
        let mut constants = SmallVec::<[u8; FEW_LAYERS]>::from(bytes_of(&plan.data));
        constants.extend_from_slice(cast_slice(plan.layers.layers()));
        recorder.update(buffers.get(&memory.cut), 0, &constants);
    }
    if plan.clips() {
        let surfaces = cast_slice(plan.layers.surfaces());
        recorder.update(buffers.get(&memory.surfaces), 0, surfaces);
        for (at, quads) in plan.layers.meshes().placed() {
            recorder.update(buffers.get(&memory.meshes), at, cast_slice(quads));
        }
    }
}

/// Writes the constants of a frame.
fn write_frame(plan: &EyePlan, recorder: &mut Recorder<'_>, frame: &Buffer) {
    let data = FrameData {
        cut: plan.cut.data,
        eye: plan.data,
    };
    // By one command, since two into one buffer would wait for each other.
    let mut constants = SmallVec::<[u8; FEW_LAYERS]>::from(bytes_of(&data));
    for (&cut, &view) in plan.cut.layers.layers().iter().zip(plan.views.iter()) {
        constants.extend_from_slice(bytes_of(&LayerData { cut, view }));
    }
    recorder.update(frame, 0, &constants);
}

/// Writes how the layers have moved since the frame before.
fn write_motions(
    recorder: &mut Recorder<'_>,
    b: &Buffers<EyePlan>,
    now: &Sight,
    before: Option<&Sight>,
) {
    let memory = &tiles::MEMORY;
    let mut constants = SmallVec::<[u8; FEW_LAYERS]>::new();
    let mut has_moved = false;
    for motion in now.motions(before) {
        has_moved |= motion.clip_has_moved != 0;
        constants.extend_from_slice(bytes_of(&motion));
    }
    recorder.update(b.get(&memory.motions), 0, &constants);
    if has_moved {
        constants.clear();
        for sight in before.into_iter().chain([now]) {
            constants.extend_from_slice(cast_slice(sight.surfaces()));
        }
        recorder.update(b.get(&memory.motion_surfaces), 0, &constants);
    }
}

/// Records a cut by itself, for all eyes that will see it.
pub(crate) fn record_cut(plan: &CutPlan, recorder: &mut Recorder<'_>, resources: CutResources<'_>) {
    recorder.label("cut", |r| write_cut(plan, r, resources.buffers));
    record_stages(&mut Recording::new(plan, recorder, &resources), &OF_CUT);
}

/// Records everything up to the draw. The frame's cut is recorded with it where that is its own. `readback` gets a copy of the
/// counts for the host.
pub(crate) fn record(
    plan: &EyePlan,
    recorder: &mut Recorder<'_>,
    resources: EyeResources<'_>,
    owns_cut: bool,
    readback: &Buffer,
) {
    let b = resources.buffers;
    let shared = &shared::MEMORY;
    let [frame, counts] = [&shared.frame, &shared.counts].map(|s| b.get(s));
    if plan.work != Work::Draw {
        recorder.label("frame", |r| {
            if owns_cut {
                write_cut(&plan.cut, r, resources.cut.buffers);
            }
            write_frame(plan, r, frame);
        });
    }
    if plan.way.draws_motion
        && let [Some(now), before] = resources.sights
    {
        let before = now.after(before);
        recorder.label("motion", |r| write_motions(r, b, now, before));
    }
    if owns_cut {
        record_stages(
            &mut Recording::new(&plan.cut, recorder, &resources.cut),
            &OF_CUT,
        );
    }
    record_stages(&mut Recording::new(plan, recorder, &resources), &OF_EYE);
    if plan.is_tiled() {
        let picture =
            [&tiles::MEMORY.tile_picture, &bin::lists::MEMORY.tile_begins].map(|s| b.get(s));
        match plan.is_drawn {
            true => recorder.ready_to_draw(&picture),
            false => recorder.ready_for_host(&picture),
        }
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
        &compact::MEMORY.splat_gaussians,
        &tiles::MEMORY.motions,
        &tiles::MEMORY.motion_surfaces,
        &shared.frame,
        &shared.counts,
    ];
    recorder.ready_to_draw(&drawn.map(|s| b.get(s)));
}

fn record_stages<P: Owner>(recording: &mut Recording<'_, '_, P>, stages: &[&Stage<P>]) {
    let plan = recording.plan;
    for stage in stages.iter().filter(|stage| (stage.needed)(plan)) {
        recording.stage(stage.name, stage.record);
    }
}

impl Sizes<EyePlan> {
    /// True when a picture's lists and pixels have so much room too.
    pub(crate) fn hold_tiles_of(&self, need: &Self) -> bool {
        let picture = [&bin::lists::MEMORY.tile_begins, &tiles::MEMORY.tile_picture];
        picture.iter().all(|s| self.bytes(s) >= need.bytes(s))
    }
}

impl CutPlan {
    /// The pipelines of its stages.
    pub(crate) fn pipelines(&self, need: &mut dyn FnMut(PipelineKey)) {
        record_stages(&mut Recording::dry(self, need), &OF_CUT);
    }

    /// The stages that the cut does not need.
    fn skipped(&self) -> impl Iterator<Item = &'static str> {
        skipped(&OF_CUT, self, self.gaussians() == 0)
    }
}

impl EyePlan {
    /// The pipelines of the whole frame.
    pub(crate) fn pipelines(&self, targets: Targets, need: &mut dyn FnMut(PipelineKey)) {
        self.cut.pipelines(need);
        record_stages(&mut Recording::dry(self, need), &OF_EYE);
        if self.is_drawn {
            need(match self.is_tiled() {
                true => composite::draw(self, targets, Part::Colours).key(),
                false => splat::draw(self, targets.colour).key(),
            });
        }
        if self.way.writes_depth {
            need(composite::draw(self, targets, Part::WrittenDepth).key());
        }
        if let Some(attachments) = targets.motion.filter(|_| self.way.draws_motion) {
            need(motion::draw(self, attachments).key());
        }
        if let Some(attachments) = targets.expected_depth {
            need(match self.is_tiled() {
                true => composite::draw(self, targets, Part::ExpectedDepth(attachments)).key(),
                false => depth::draw(self, attachments).key(),
            });
        }
    }

    /// The stages that this frame does not need, among those of a whole one.
    pub(crate) fn skipped(&self) -> Vec<&'static str> {
        let is_empty = self.gaussians() == 0;
        let of_eye = skipped(&OF_EYE, self, is_empty);
        let draw = (is_empty || !self.is_drawn).then_some(DRAW);
        self.cut.skipped().chain(of_eye).chain(draw).collect()
    }
}

/// The stages, of these, that a plan reports as skipped.
fn skipped<P: Owner>(
    stages: &[&Stage<P>],
    plan: &P,
    is_empty: bool,
) -> impl Iterator<Item = &'static str> {
    let missed =
        move |stage: &&&Stage<P>| (stage.missed)(plan) && (is_empty || !(stage.needed)(plan));
    stages.iter().filter(missed).map(|stage| stage.name)
}
