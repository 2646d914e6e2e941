//! The constants of the programs that handle blocks, cut splats and their changes, as they follow from a plan.

use crate::passes::block_list::list_invocations;
use crate::passes::pipelines::FromPlan;
use crate::passes::plan::Plan;
use crate::passes::shaders;
use rara_base::limits;
use rara_gpu::DeviceShape;

/// The constants of a program, each a function of the plan.
macro_rules! constants {
    ($program:ident $(, $constant:ident: $of:expr)*) => {
        impl FromPlan for shaders::$program::Constants {
            fn from_plan(plan: &Plan) -> Self {
                Self {
                    $($constant: $of(plan),)*
                }
            }
        }
    };
}

/// The same of a program that reads layers: also whether there are several.
macro_rules! layered {
    ($program:ident $(, $constant:ident: $of:expr)*) => {
        constants!($program, layered: is_layered $(, $constant: $of)*);
    };
}

// Without a clip the shaders hold no clip code.
layered!(blocks, clip: Plan::view_is_clipped, combined: is_combined, shortlisted: Plan::is_shortlisted);
layered!(classify, clip: Plan::view_is_clipped, combined: is_combined, shortlisted: Plan::is_shortlisted, local_size_x: mask_invocations);
layered!(clip_blocks, combined: is_combined, shortlisted: Plan::is_shortlisted);
layered!(clip, combined: is_combined, shortlisted: Plan::is_shortlisted, local_size_x: mask_invocations);
constants!(block_list, local_size_x: list_invocations);
layered!(compact_scan, local_size_x: list_invocations);
layered!(compact, cut: Plan::view_is_cut);
layered!(cutoff, has_terms: is_for_cpu, combined: is_combined, shortlisted: Plan::is_shortlisted);
layered!(depth, combined: is_combined, shortlisted: Plan::is_shortlisted);
layered!(reclip_blocks, combined: is_combined, shortlisted: Plan::is_shortlisted);
layered!(reclip, combined: is_combined, shortlisted: Plan::is_shortlisted, local_size_x: mask_invocations);
constants!(reclip_scan, local_size_x: list_invocations);
layered!(recut, tiles: Plan::is_tiled, quads: Plan::needs_quads, rects: Plan::keeps_rects);

fn is_layered(plan: &Plan) -> bool {
    plan.way.layered
}

fn is_combined(plan: &Plan) -> bool {
    plan.layers.are_combined()
}

fn is_for_cpu(plan: &Plan) -> bool {
    plan.way.shape == DeviceShape::Cpu
}

/// The invocations that find a block's masks: one for each word of a mask on CPU drivers, and one for each Gaussian on GPUs.
fn mask_invocations(plan: &Plan) -> u32 {
    match plan.way.shape {
        DeviceShape::Cpu => limits::BLOCK_SIZE / u32::BITS,
        DeviceShape::Gpu { .. } => limits::BLOCK_SIZE,
    }
}
