//! The frame: every stage in order. Nothing waits or is read back in between; each stage's work follows from what the
//! one before left on the device.

use ash::vk;

use crate::gpu::{Buffer, Recorder};
use crate::passes::buffers::Buffers;
use crate::passes::plan::Plan;
use crate::passes::scene_buffers::SceneBuffers;
use crate::passes::stages::Stages;
use crate::passes::work::Work;
use crate::settings::Raster;

/// Records everything up to the draw. `readback` gets a copy of the counts for the host. `copied` is where the host's depth
/// lies under the picture, for tiles that it hides.
pub(crate) fn record(
    recorder: &mut Recorder<'_>,
    stages: &Stages,
    scene: &SceneBuffers,
    b: &Buffers,
    (plan, copied): (&Plan, vk::Rect2D),
    readback: &Buffer,
) {
    if plan.work != Work::Draw {
        recorder.label("frame", |r| {
            r.update(&b.frame, 0, bytemuck::bytes_of(&plan.data));
        });
    }
    match plan.work {
        Work::Whole { clip } => {
            let list = &stages.block_list;
            // On which side of the clip each block of Gaussians lies, and each Gaussian of those that it cuts.
            if let Some(stage) = stages.clip.as_ref().filter(|_| clip) {
                recorder.pass("clip", |r| stage.record(r, list, scene, b, plan));
            }
            view(recorder, stages, scene, b, plan);
        }
        Work::Sweep { base, fresh } => sweep(recorder, stages, scene, b, plan, [base, fresh]),
        Work::Draw => {}
    }
    if let Some(t) = b.tiles.as_ref().filter(|_| plan.raster == Raster::Tiles) {
        if plan.work != Work::Draw {
            // The pixels, front to back.
            recorder.pass("tiles", |r| {
                stages.tiles(plan).record(r, b, t, (plan, copied))
            });
        }
        recorder.ready_to_draw(&[&t.picture, &t.begins]);
    }
    if let Some((depth, d)) = stages
        .depth
        .as_ref()
        .zip(b.depth.as_ref())
        .filter(|_| plan.expects_depth)
    {
        if plan.work != Work::Draw {
            // How deep the splats are, for who asks.
            recorder.pass("depth", |r| depth.record(r, scene, b, d));
        }
        recorder.ready_to_draw(&[&d.depths, &d.draw]);
    }

    recorder.label("counts", |r| {
        let all = ash::vk::BufferCopy::default().size(b.counts.size());
        r.copy(&b.counts, readback, &[all]);
        r.ready_for_host(&[readback]);
    });
    let order = &b.order[plan.sorted()];
    recorder.ready_to_draw(&[&b.frame, &b.counts, &b.splats, order, &b.cuts]);
}

/// Which Gaussians survive, and what and where they are on the screen.
fn view(
    recorder: &mut Recorder<'_>,
    stages: &Stages,
    scene: &SceneBuffers,
    b: &Buffers,
    plan: &Plan,
) {
    let list = &stages.block_list;
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
    recorder.pass("sort", |r| stages.sort.record(r, scene, b, plan));
    let tiles = stages.bin.as_ref().zip(b.tiles.as_ref());
    if let Some((bin, t)) = tiles.filter(|_| plan.raster == Raster::Tiles) {
        // Which of them each tile of pixels holds.
        recorder.pass("bin", |r| bin.record(r, b, t, plan));
    }
}

/// What a clip that has moved changes, the camera standing still.
fn sweep(
    recorder: &mut Recorder<'_>,
    stages: &Stages,
    scene: &SceneBuffers,
    b: &Buffers,
    plan: &Plan,
    [base, fresh]: [bool; 2],
) {
    let (Some(reclip), Some(recut), Some(s)) = (&stages.reclip, stages.recut(plan), &b.sweep)
    else {
        unreachable!("configure() creates what a sweep needs");
    };
    if base {
        view(recorder, stages, scene, b, &plan.unclipped());
    }
    let list = &stages.block_list;
    // Which Gaussians in view change their class.
    recorder.pass("reclip", |r| {
        reclip.record(r, list, scene, b, s, (plan, fresh))
    });
    if let Some(cutoff) = stages.cutoff.as_ref().filter(|_| plan.cutoff) {
        recorder.pass("cutoff", |r| cutoff.record(r, scene, b));
    }
    // What of them depends on the clip, and the tiles to draw again: all, where no frame has drawn what is in view.
    recorder.pass("recut", |r| {
        r.fill(&s.dirty, 0, s.dirty.size(), base.into());
        recut.record(r, scene, b, s);
    });
}
