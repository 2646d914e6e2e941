//! The frame: every stage in order. Nothing waits or is read back in between; each stage's work follows from what the
//! one before left on the device.

use crate::gpu::{Buffer, Recorder};
use crate::passes::buffers::Buffers;
use crate::passes::plan::Plan;
use crate::passes::scene_buffers::SceneBuffers;
use crate::passes::stages::Stages;
use crate::settings::Raster;

/// Records everything up to the draw. `readback` gets a copy of the counts for the host.
pub(crate) fn record(
    recorder: &mut Recorder<'_>,
    stages: &Stages,
    scene: &SceneBuffers,
    b: &Buffers,
    plan: &Plan,
    readback: &Buffer,
) {
    recorder.update(&b.frame, 0, bytemuck::bytes_of(&plan.data));

    let list = &stages.block_list;
    // On which side of the clip each block of Gaussians lies, and each Gaussian of those that it cuts.
    if let Some(clip) = stages.clip.as_ref().filter(|_| plan.clip) {
        recorder.pass("clip", |r| clip.record(r, list, scene, b, plan));
    }
    // Which blocks are in view.
    recorder.pass("blocks", |r| {
        stages.blocks(plan).record(r, list, scene, b, plan)
    });
    // Which Gaussians of those that are so in part.
    recorder.pass("classify", |r| stages.classify(plan).record(r, scene, b));
    // Their numbers, in order, and the sizes of all that follows.
    recorder.pass("compact", |r| stages.compact.record(r, b));
    // What the fragment stage needs of the cut ones.
    if let Some(cutoff) = stages.cutoff.as_ref().filter(|_| plan.cutoff) {
        recorder.pass("cutoff", |r| cutoff.record(r, scene, b));
    }
    // Conic, quad, colour and depth key of the survivors.
    recorder.pass("project", |r| stages.project(plan).record(r, scene, b));
    // Their order.
    if plan.sort_passes > 0 {
        recorder.pass("sort", |r| stages.sort.record(r, scene, b, plan));
    }

    let tiles = stages.bin.as_ref().zip(b.tiles.as_ref());
    if let Some((bin, t)) = tiles.filter(|_| plan.raster == Raster::Tiles) {
        // Which of them each tile of pixels holds.
        recorder.pass("bin", |r| bin.record(r, &stages.sort, b, t, plan));
        // The pixels, front to back.
        recorder.pass("tiles", |r| stages.tiles(plan).record(r, b, t, plan));
        recorder.ready_to_draw(&[&t.picture]);
    }

    recorder.copy(
        &b.counts,
        readback,
        &[ash::vk::BufferCopy::default().size(b.counts.size())],
    );
    recorder.ready_for_host(&[readback]);
    let order = &b.order[plan.sorted()];
    recorder.ready_to_draw(&[&b.frame, &b.counts, &b.splats, order, &b.cuts]);
}
