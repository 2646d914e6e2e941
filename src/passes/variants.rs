//! The constants of the programs that read layers, as they follow from a plan.

use crate::passes::pipelines::FromPlan;
use crate::passes::plan::Plan;
use crate::passes::shaders;
use rara_gpu::DeviceShape;

/// The constants of a program: whether there are several layers, and what else is named.
macro_rules! layered {
    ($program:ident $(, $constant:ident: $of:expr)*) => {
        impl FromPlan for shaders::$program::Constants {
            fn from_plan(plan: &Plan) -> Self {
                Self {
                    $($constant: $of(plan),)*
                    layered: plan.way.layered,
                }
            }
        }
    };
}

// Without a clip the shaders hold no clip code.
layered!(blocks, clip: Plan::view_is_clipped, combined: is_combined, shortlisted: Plan::is_shortlisted);
layered!(classify, clip: Plan::view_is_clipped, combined: is_combined, shortlisted: Plan::is_shortlisted, atomic_masks: suits_atomics);
layered!(clip_blocks, combined: is_combined, shortlisted: Plan::is_shortlisted);
layered!(clip, combined: is_combined, shortlisted: Plan::is_shortlisted, atomic_masks: suits_atomics);
layered!(compact_scan);
layered!(compact, cut: Plan::view_is_cut);
layered!(cutoff, has_terms: is_for_cpu, combined: is_combined, shortlisted: Plan::is_shortlisted);
layered!(depth, combined: is_combined, shortlisted: Plan::is_shortlisted);
layered!(reclip_blocks, combined: is_combined, shortlisted: Plan::is_shortlisted);
layered!(reclip, combined: is_combined, shortlisted: Plan::is_shortlisted, atomic_masks: suits_atomics);
layered!(recut, tiles: Plan::is_tiled, quads: Plan::needs_quads, rects: Plan::keeps_rects);

fn is_combined(plan: &Plan) -> bool {
    plan.layers.are_combined()
}

fn is_for_cpu(plan: &Plan) -> bool {
    plan.way.shape == DeviceShape::Cpu
}

fn suits_atomics(plan: &Plan) -> bool {
    !is_for_cpu(plan)
}
