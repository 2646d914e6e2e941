//! Stages `reclip` and `recut`, where the camera stands still and the clip moves, find the Gaussians between its old and its
//! new surface and change what the rasteriser holds of them. The survivors, which are all in view, and their centres,
//! colours, order and tiles stay.

use crate::gpu::Recorder;
use crate::passes::block_list::{self, ListFor};
use crate::passes::blocks::{groups_of_blocks, groups_of_list};
use crate::passes::buffers::{buffers, indirect};
use crate::passes::shaders::{reclip, reclip_blocks, reclip_compact, reclip_scan, recut};
use crate::passes::stage::{Frame, Stage, key};
use crate::passes::work::Work;
use crate::types::FrameCounts;

/// The stage that finds which sides change.
pub(crate) const RECLIP: Stage = Stage {
    name: "reclip",
    needed: |plan| plan.reclips(),
    missed: |_| false,
    pipelines: |plan, need| {
        need(key::<reclip_blocks::Program>(plan));
        need(key::<block_list::Program>(plan));
        need(key::<reclip::Program>(plan));
        need(key::<reclip_scan::Program>(plan));
        need(key::<reclip_compact::Program>(plan));
    },
    record: record_reclip,
};

/// The stage that changes what the rasteriser holds of those survivors.
pub(crate) const RECUT: Stage = Stage {
    name: "recut",
    needed: |plan| plan.reclips(),
    missed: |_| false,
    pipelines: |plan, need| need(key::<recut::Program>(plan)),
    record: record_recut,
};

fn record_reclip(frame: &Frame<'_>, recorder: &mut Recorder<'_>) {
    let (scene, b, s) = (frame.scene, frame.buffers, frame.reclip());
    let buffers = buffers!(reclip_blocks {
        b => [frame, surfaces, block_sides, block_counts, shortlists],
        scene => [blocks],
        s => [revisits, reclips],
    });
    // No clip may have changed the survivors yet.
    let fresh = matches!(frame.plan.work, Work::Reclip { fresh: true, .. });
    let params = reclip_blocks::Params {
        fresh: fresh.into(),
    };
    let groups = groups_of_blocks(frame.plan);
    frame.dispatch(recorder, buffers, params, groups);
    block_list::record(frame, recorder, &s.revisits, ListFor::Clip);
    let looked_at = indirect!(b.counts, FrameCounts, clip_groups);
    let buffers = buffers!(reclip {
        b => [frame, surfaces, block_list, counts, block_sides, masks, shortlists],
        scene => [gaussians],
        s => [revisits, reclips],
    });
    frame.dispatch(recorder, buffers, (), looked_at);
    let buffers = buffers!(reclip_scan {
        b => [frame, counts],
        s => [revisits, reclips],
    });
    frame.dispatch(recorder, buffers, (), groups_of_list(frame.plan));
    let buffers = buffers!(reclip_compact {
        b => [frame, block_list, counts, block_sides, masks, block_offsets, cutoffs],
        s => [reclips, recuts],
    });
    frame.dispatch(recorder, buffers, (), looked_at);
}

fn record_recut(frame: &Frame<'_>, recorder: &mut Recorder<'_>) {
    let (scene, b, s) = (frame.scene, frame.buffers, frame.reclip());
    // All tiles are drawn again where no frame has drawn what is in view.
    let all = frame.plan.finds_view();
    recorder.fill(&s.dirty, 0, s.dirty.size(), all.into());
    let buffers = buffers!(recut {
        b => [frame, survivors, counts, cut_records, tile_masks, splats, quads],
        scene => [gaussians],
        s => [recuts, dirty],
    });
    let groups = indirect!(b.counts, FrameCounts, recut_groups);
    frame.dispatch(recorder, buffers, (), groups);
}
