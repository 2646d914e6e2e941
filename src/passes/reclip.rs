//! Stages `reclip` and `recut`, where the camera stands still and the clip moves, find the Gaussians between its old and its
//! new surface and change what the rasteriser holds of them. The survivors, which are all in view, and their centres,
//! colours, order and tiles stay.

use crate::gpu::Recorder;
#[cfg(feature = "lab")]
use crate::limits;
use crate::passes::block_list::{self, ListFor};
#[cfg(feature = "lab")]
use crate::passes::blocks::loads_of_list;
use crate::passes::blocks::{groups_of_blocks, groups_of_list};
use crate::passes::buffers::{buffers, indirect};
#[cfg(feature = "lab")]
use crate::passes::cost::{self, Cost};
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

#[cfg(feature = "lab")]
pub(super) const COSTS: &[Cost] = &[
    // The layer, the block's side in view, its totals. It reads the bounds too, reads and writes the block's side of the clip,
    // and writes whether it is revisited.
    Cost::of::<reclip_blocks::Program>(
        |n| n.blocks,
        |n| 1 + n.layer() + 2 + n.surfaces,
        |n| n.blocks * (cost::BOUNDS + cost::TOTALS + 4 * cost::WORD),
    ),
    // The number of its group's block, the block, its layer, whether the Gaussian is in view, its side before, that of the
    // block now, the Gaussian. It reads and writes the words that a reclipped frame keeps of the block.
    Cost::of::<reclip::Program>(
        |n| n.clip_blocks * u64::from(limits::BLOCK_SIZE),
        |n| 2 + n.layer() + 2 + 2 + 2 + n.asked_surfaces(),
        |n| n.clip_blocks * (3 * cost::WORD + cost::BLOCK + cost::MASKS / 2 + 2 * KEPT),
    ),
    // Each block says whether it is revisited and then has totals. It writes the block's places.
    Cost::of::<reclip_scan::Program>(
        |n| n.blocks,
        |n| loads_of_list(n, 2),
        |n| n.blocks * (cost::WORD + cost::TOTALS + 2 * cost::WORD),
    ),
    // The number of its group's block, the block, whether its Gaussian changes, its places; and the words of the masks. It
    // writes which survivors change, and the numbers of those that are cut.
    Cost::of::<reclip_compact::Program>(
        |n| n.clip_blocks * u64::from(limits::BLOCK_SIZE),
        |_| 4 + u64::from(limits::BLOCK_SIZE / u32::BITS) + 1,
        |n| {
            let block = 4 * cost::WORD + cost::MASKS / 2 + KEPT;
            n.clip_blocks * block + n.changed * CHANGE + n.cut * cost::WORD
        },
    ),
    // How many there are, which survivor, which Gaussian, its layer, the cutoff record, the mask and the splat, most of which
    // it writes.
    Cost::of::<recut::Program>(
        |n| n.changed,
        |n| 3 + n.layer() + 2 + 2,
        |n| {
            let survivor = cost::gathered(cost::SURVIVOR) + cost::gathered(cost::GAUSSIAN);
            let splat =
                cost::gathered(cost::TILE_MASK) + cost::SPLAT + cost::gathered(cost::CURVATURE);
            n.changed * (CHANGE + survivor + n.record_bytes + splat)
        },
    ),
];

/// Bytes of a change: the survivor, and its place among those that are cut.
#[cfg(feature = "lab")]
const CHANGE: u64 = 2 * cost::WORD;

/// Bytes that a reclipped frame keeps of a block.
#[cfg(feature = "lab")]
const KEPT: u64 = limits::RECLIP_WORDS as u64 * cost::WORD;

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
