//! What a frame leaves in an eye's buffers, and the work that this saves the next one.

use crate::passes::cut_plan::CutPlan;
use crate::passes::eye_plan::EyePlan;
use crate::passes::weight::Weight;
use crate::passes::work::{Work, same};

/// The contents of an eye's buffers after a frame.
#[derive(Debug)]
pub(crate) struct PreviousFrame {
    scene: u64,
    plan: EyePlan,
    /// True when the buffers are still those that the frame wrote.
    pub(crate) holds: bool,
    /// The splats are all in view, clipped away or not; `Some(true)` if no clip has changed them yet.
    base: Option<bool>,
}

impl PreviousFrame {
    /// The work that is left for a plan, after a frame that left `previous`.
    pub(crate) fn work(previous: Option<&Self>, scene: u64, plan: &EyePlan) -> Work {
        let Some(previous) = previous.filter(|previous| previous.scene == scene) else {
            return Work::Whole;
        };
        let is_same = previous.plan.is_drawn_like(plan);
        if previous.holds && is_same {
            return Work::Draw;
        }
        // The same frame in other buffers is no reclipped frame.
        let is_still = previous.plan.sees_like(plan) && !is_same;
        if is_still && plan.cut.clips() {
            let base = previous.base.filter(|_| previous.holds);
            return Work::Reclip {
                base: base.is_none(),
                fresh: base.unwrap_or(true),
            };
        }
        Work::Whole
    }

    /// The contents of the buffers once a plan has been recorded.
    pub(crate) fn after(scene: u64, plan: &EyePlan) -> Self {
        Self {
            scene,
            plan: plan.clone(),
            holds: true,
            base: match plan.work {
                Work::Whole => (!plan.cut.clips()).then_some(true),
                Work::Reclip { .. } => Some(false),
                Work::Draw => unreachable!("a frame that changes nothing leaves what there was"),
            },
        }
    }
}

/// What a cut's buffers hold.
#[derive(Debug)]
pub(crate) struct FoundSides {
    scene: u64,
    plan: CutPlan,
}

impl FoundSides {
    /// The sides of a cut that has been recorded.
    pub(crate) fn of(scene: u64, plan: &CutPlan) -> Self {
        let plan = plan.clone();
        Self { scene, plan }
    }

    /// True when they are those of a plan.
    pub(crate) fn are_of(&self, scene: u64, plan: &CutPlan) -> bool {
        self.scene == scene && self.plan.is_like(plan)
    }
}

impl EyePlan {
    /// True when another plan gives the same pixels.
    fn is_drawn_like(&self, other: &Self) -> bool {
        self.sees_like(other)
            && same(&self.data.weight, &other.data.weight)
            && self.cut.keeps_like(&other.cut)
            && Weight::from_plan(self) == Weight::from_plan(other)
    }

    /// True when another plan differs in nothing but the clip and its weights, and its stages leave the same kinds of
    /// things in the same buffers.
    fn sees_like(&self, other: &Self) -> bool {
        let [ours, theirs] = [self, other].map(|plan| bytemuck::cast_slice::<_, u8>(&plan.views));
        same(&self.data.view, &other.data.view)
            && same(&self.data.order, &other.data.order)
            && same(&self.data.tiles, &other.data.tiles)
            && self.cut.contains_like(&other.cut)
            && ours == theirs
            && self.way == other.way
    }
}
