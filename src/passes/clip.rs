//! Stage `clip`, only where the clip has changed, finds the side of each block of Gaussians, and of each Gaussian in the
//! blocks that are cut: the paper's three classes (section 3.2). The camera has no part in it.

use crate::passes::block_list::{self, groups_of_blocks, listed};
use crate::passes::cut_plan::CutPlan;
use crate::passes::recording::Recording;
use crate::passes::shaders::{clip, clip_blocks};
use crate::passes::shared::SCENE;
use crate::passes::stage::Stage;
use crate::passes::storage::{buffers, memory, named};
use crate::types::{CutData, CutLayer, SurfaceData};
use rara_base::limits;

pub(crate) static STAGE: Stage<CutPlan> = Stage {
    name: "clip",
    needed: |plan| plan.finds_sides,
    missed: |_| true,
    memory: &[STORAGES],
    record,
};

memory! { CutPlan:
    /// The cut's constants, and those of its layers.
    cut: |plan| {
        let layers = u64::from(plan.data.scene.layer_count);
        size_of::<CutData>() as u64 + layers * size_of::<CutLayer>() as u64
    };
    /// The surfaces of the layers' regions; for all layers wherever they are placed, so that one that moves needs no other
    /// buffer.
    surfaces: |plan| {
        let most = u64::from(plan.data.scene.layer_count) * u64::from(plan.layers.most_surfaces());
        most * size_of::<SurfaceData>() as u64
    };
    /// The meshes that these are the insides of, each with the hierarchy of its faces; empty without any.
    meshes: |plan| plan.layers.meshes().bytes();
    /// The clip's sides of the blocks; empty without a clip.
    clip_sides: |plan| when_clipped(plan, 4 * plan.blocks());
    /// The clip's masks of the blocks; empty without a clip.
    clip_masks: |plan| when_clipped(plan, block_list::MASK_BYTES * plan.blocks());
    /// The blocks that the clip may cut; empty without a clip.
    clip_list: |plan| when_clipped(plan, block_list::bytes(plan.blocks()));
    /// The blocks' shortlists of surfaces; empty where no region has many.
    shortlists: |plan| match plan.is_shortlisted() {
        true => 4 * u64::from(limits::SHORTLIST_WORDS) * plan.blocks(),
        false => 0,
    };
    /// It is bound in place of the buffers of which a cut needs no byte.
    empty: |_| 16;
}

/// So many bytes where there is anything to clip with.
fn when_clipped(plan: &CutPlan, bytes: u64) -> u64 {
    if plan.clips() { bytes } else { 0 }
}

fn record(recording: &mut Recording<'_, '_, CutPlan>) {
    let buffers = buffers!(clip_blocks {
        SCENE => [blocks],
        MEMORY => [cut, surfaces, clip_sides, shortlists, meshes],
    });
    recording.dispatch(buffers, (), groups_of_blocks(recording.plan));
    let [cut, sides, list] = [&MEMORY.cut, &MEMORY.clip_sides, &MEMORY.clip_list].map(named);
    block_list::record(recording, cut, sides, list);
    let buffers = buffers!(clip {
        SCENE => [gaussians],
        MEMORY => [cut, surfaces, clip_masks, shortlists, meshes];
        block_list: &MEMORY.clip_list,
    });
    recording.dispatch(buffers, (), listed(list));
}
