//! What of a frame the weight of cut splats depends on, fixed in the pipelines that compute it: what a mode does not ask for
//! does not tell pipelines apart.

use crate::passes::plan::Plan;
use crate::types;

/// The constants of `glsl/weight_constants.glsl`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Weight {
    /// `MODE_*`.
    pub(crate) mode: u32,
    /// `OP_*`.
    pub(crate) op: u32,
    /// `DECAY_*`.
    pub(crate) decay: u32,
    /// `MISS_*`.
    pub(crate) miss: u32,
    /// `PHI_*`.
    pub(crate) phi: u32,
}

impl Weight {
    /// What a plan needs: after a hard clip nothing is left for the fragment stage to do.
    pub(crate) fn of(plan: &Plan) -> Self {
        let when = |needed: bool, value: u32| if needed { value } else { 0 };
        let op = match plan.data.plane_count {
            1 => types::OP_ONE,
            _ => plan.data.op,
        };
        Self {
            mode: when(plan.cutoff, plan.mode),
            op: when(plan.cutoff, op),
            decay: when(plan.cutoff, plan.decay),
            miss: when(plan.cutoff && plan.mode == types::MODE_RARA, plan.miss),
            phi: when(plan.cutoff && plan.mode == types::MODE_EXACT, plan.phi),
        }
    }
}
