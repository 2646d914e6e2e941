//! A list of blocks holds the numbers of those whose Gaussians differ, for the stage that comes next. It begins with the
//! indirect command over them.

use crate::passes::cut_plan::CutPlan;
use crate::passes::eye_plan::EyePlan;
use crate::passes::owner::Owner;
use crate::passes::pipelines::FromPlan;
use crate::passes::recording::{Groups, Recording};
use crate::passes::resources::EyeName;
use crate::passes::shaders::block_list;
use crate::passes::shared;
use crate::passes::storage::{Storage, memory, named};
use rara_base::limits;
use rara_gpu::DeviceShape;

memory! { EyePlan:
    /// The numbers of the blocks that the next stage looks at.
    block_list: |plan| bytes(plan.blocks());
}

/// The bytes of a list of so many blocks, its command included.
pub(super) fn bytes(blocks: u64) -> u64 {
    16 + 4 * blocks
}

/// Bytes of the two masks of a block, a bit a Gaussian in each.
pub(super) const MASK_BYTES: u64 = 2 * limits::BLOCK_SIZE as u64 / 8;

/// A plan whose stages list blocks.
pub(super) trait ListsBlocks: Owner {
    fn cut(&self) -> &CutPlan;
}

impl ListsBlocks for CutPlan {
    fn cut(&self) -> &CutPlan {
        self
    }
}

impl ListsBlocks for EyePlan {
    fn cut(&self) -> &CutPlan {
        &self.cut
    }
}

/// Lists the blocks whose two low bits in `sides` say that their Gaussians differ. `constants` begin with those of a cut.
pub(super) fn record<P: ListsBlocks>(
    recording: &mut Recording<'_, '_, P>,
    constants: P::Name,
    sides: P::Name,
    list: P::Name,
) where
    block_list::Constants: FromPlan<P>,
{
    let buffers = block_list::Buffers {
        cut: constants,
        sides,
        block_list: list,
    };
    recording.dispatch(buffers, (), groups_of_list(recording.plan));
}

/// Lists them for the next stage of an eye.
pub(super) fn list_differing(
    recording: &mut Recording<'_, '_, EyePlan>,
    sides: &'static Storage<EyePlan>,
) {
    let frame = named(&shared::MEMORY.frame);
    record(recording, frame, named(sides), named(&MEMORY.block_list));
}

/// The workgroups of the command at the beginning of a list.
pub(super) fn listed<N>(list: N) -> Groups<N> {
    Groups::Counted(list, 0)
}

/// The workgroups that look at the blocks of an eye's list.
pub(super) fn looked_at() -> Groups<EyeName> {
    listed(named(&MEMORY.block_list))
}

/// The workgroups that make a list of blocks: a single one on CPU drivers, whose invocations have many blocks each, and an
/// invocation a block on GPUs.
pub(super) fn groups_of_list<P: ListsBlocks>(plan: &P) -> Groups<P::Name> {
    let blocks = plan.cut().data.scene.block_count;
    Groups::Count(match plan.cut().shape {
        DeviceShape::Cpu => 1,
        DeviceShape::Gpu { .. } => blocks.div_ceil(list_invocations(plan)).max(1),
    })
}

/// The invocations of each of them.
pub(super) fn list_invocations(plan: &impl ListsBlocks) -> u32 {
    match plan.cut().shape {
        DeviceShape::Cpu => limits::RUN_ROW,
        DeviceShape::Gpu { .. } => limits::BLOCK_SIZE,
    }
}

/// An invocation a block.
pub(super) fn groups_of_blocks<P: ListsBlocks>(plan: &P) -> Groups<P::Name> {
    let blocks = plan.cut().data.scene.block_count;
    Groups::Count(blocks.div_ceil(limits::BLOCK_GROUP_SIZE))
}
