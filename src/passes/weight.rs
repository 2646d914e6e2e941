//! The settings that the weight of cut splats depends on, as constants of the pipelines that compute it. Settings that a
//! mode does not use are left at one value, so that no two pipelines differ in them alone.

use crate::passes::eye_plan::EyePlan;
use crate::types;
use rara_scene::settings::Show;

/// The shaders' name of what a frame shows, `SHOW_*`.
pub(super) fn show_code(show: Show) -> u32 {
    match show {
        Show::Colour => types::SHOW_COLOUR,
        Show::Weight => types::SHOW_WEIGHT,
        Show::Count => types::SHOW_COUNT,
        Show::Mean => types::SHOW_MEAN,
        Show::Strongest => types::SHOW_STRONGEST,
    }
}

/// The constants of `glsl/weight_constants.glsl`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Weight {
    /// `MODE_*`.
    pub(crate) mode: u32,
    /// True when a splat may be cut by more than one surface.
    pub(crate) several: bool,
    /// True when splats may be weighed as combinations of surfaces that bend.
    pub(crate) combined: bool,
    /// True when the faces of a mesh may cut a splat.
    pub(crate) meshes: bool,
    /// True when more than `RECORD_SURFACES` may cut a splat.
    pub(crate) many: bool,
    /// `DECAY_*`.
    pub(crate) decay: u32,
    /// `MISS_*`.
    pub(crate) miss: u32,
    /// `PHI_*`.
    pub(crate) phi: u32,
}

impl Weight {
    /// The constants of a plan. After a hard clip nothing is left for the fragment stage to do.
    pub(crate) fn from_plan(plan: &EyePlan) -> Self {
        let when = |needed: bool, value: u32| if needed { value } else { 0 };
        let (cuts, mode, laws) = (plan.cut.cuts(), plan.cut.mode(), plan.laws);
        Self {
            mode: when(cuts, mode),
            several: cuts && plan.cut.layers.are_several(),
            combined: cuts && plan.cut.layers.are_combined(),
            meshes: cuts && plan.cut.layers.have_meshes(),
            many: cuts && plan.cut.layers.are_many(),
            decay: when(cuts, laws.decay),
            miss: when(cuts && mode == types::MODE_RARA, laws.miss),
            phi: when(cuts && mode == types::MODE_EXACT, laws.phi),
        }
    }

    /// True when tiles in which several surfaces, or one that bends, cut a splat are told from the others.
    pub(super) fn has_several_kinds(&self) -> bool {
        (self.several || self.combined) && self.mode == types::MODE_EXACT
    }
}
