//! The constants of the programs that handle blocks, cut splats and their changes, as they follow from a plan.

use crate::passes::block_list::{ListsBlocks, list_invocations};
use crate::passes::cut_plan::CutPlan;
use crate::passes::eye_plan::EyePlan;
use crate::passes::pipelines::FromPlan;
use crate::passes::shaders;
use rara_base::limits;
use rara_gpu::DeviceShape;

/// The constants of a program, each a function of the plan of its owner.
macro_rules! constants {
    ($owner:ty: $program:ident $(, $constant:ident: $of:expr)*) => {
        impl FromPlan<$owner> for shaders::$program::Constants {
            fn from_plan(plan: &$owner) -> Self {
                Self {
                    $($constant: $of(plan),)*
                }
            }
        }
    };
}

/// The same of a program that reads layers: also whether there are several.
macro_rules! layered {
    ($owner:ty: $program:ident $(, $constant:ident: $of:expr)*) => {
        constants!($owner: $program, layered: is_layered $(, $constant: $of)*);
    };
}

// Without a clip the shaders hold no clip code.
layered!(CutPlan: clip_blocks, combined: is_combined, meshes: has_meshes, shortlisted: is_shortlisted);
layered!(CutPlan: clip, combined: is_combined, meshes: has_meshes, shortlisted: is_shortlisted, local_size_x: mask_invocations);
constants!(CutPlan: block_list, local_size_x: list_invocations);
constants!(EyePlan: block_list, local_size_x: list_invocations);
layered!(EyePlan: blocks, clip: EyePlan::view_is_clipped, combined: is_combined, meshes: has_meshes, shortlisted: is_shortlisted);
layered!(EyePlan: classify, clip: EyePlan::view_is_clipped, combined: is_combined, meshes: has_meshes, shortlisted: is_shortlisted, local_size_x: mask_invocations);
layered!(EyePlan: compact_scan, local_size_x: list_invocations);
layered!(EyePlan: compact, cuts: EyePlan::view_is_cut);
layered!(EyePlan: cutoff, has_terms: is_for_cpu, combined: is_combined, meshes: has_meshes, several: is_several, many: is_many, shortlisted: is_shortlisted);
layered!(EyePlan: depth, combined: is_combined, meshes: has_meshes, shortlisted: is_shortlisted);
layered!(EyePlan: reclip_blocks, combined: is_combined, meshes: has_meshes, shortlisted: is_shortlisted);
layered!(EyePlan: reclip, combined: is_combined, meshes: has_meshes, shortlisted: is_shortlisted, local_size_x: mask_invocations);
constants!(EyePlan: reclip_scan, local_size_x: list_invocations);
layered!(EyePlan: recut, tiles: EyePlan::is_tiled, quads: EyePlan::needs_quads, rects: EyePlan::keeps_rects);

fn is_layered(plan: &impl ListsBlocks) -> bool {
    plan.cut().layered
}

fn is_combined(plan: &impl ListsBlocks) -> bool {
    plan.cut().layers.are_combined()
}

fn has_meshes(plan: &impl ListsBlocks) -> bool {
    plan.cut().layers.have_meshes()
}

fn is_shortlisted(plan: &impl ListsBlocks) -> bool {
    plan.cut().is_shortlisted()
}

/// Programs for planes alone are the same for one and for several.
fn is_several(plan: &EyePlan) -> bool {
    plan.cut.layers.are_combined() && plan.cut.layers.are_several()
}

fn is_many(plan: &EyePlan) -> bool {
    plan.cut.layers.are_many()
}

fn is_for_cpu(plan: &EyePlan) -> bool {
    plan.cut.shape == DeviceShape::Cpu
}

/// The invocations that find a block's masks: one for each word of a mask on CPU drivers, and one for each Gaussian on GPUs.
fn mask_invocations(plan: &impl ListsBlocks) -> u32 {
    match plan.cut().shape {
        DeviceShape::Cpu => limits::BLOCK_SIZE / u32::BITS,
        DeviceShape::Gpu { .. } => limits::BLOCK_SIZE,
    }
}
