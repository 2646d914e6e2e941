//! What a frame leaves in the buffers, and the work that this saves the next one.

use crate::passes::layers::Layers;
use crate::passes::plan::Plan;
use crate::passes::weight::Weight;
use crate::passes::work::{Work, same};
use crate::types::{self, RegionData};

/// The contents of the buffers after a frame.
#[derive(Debug)]
pub(crate) struct PreviousFrame {
    scene: u64,
    plan: Plan,
    /// True when the buffers are still those that the frame wrote.
    pub(crate) holds: bool,
    /// The splats are all in view, clipped away or not; `Some(true)` if no clip has changed them yet.
    base: Option<bool>,
    /// The regions and layers from which stage clip has found the sides.
    region: Option<(RegionData, Layers)>,
}

impl PreviousFrame {
    /// The work that is left for a plan, after a frame that left `previous`.
    pub(crate) fn work(previous: Option<&Self>, scene: u64, plan: &Plan) -> Work {
        let clip = plan.mode() != types::MODE_NONE;
        let Some(previous) = previous.filter(|previous| previous.scene == scene) else {
            return Work::Whole { clip };
        };
        let is_same = previous.plan.is_drawn_like(plan);
        if previous.holds && is_same {
            return Work::Draw;
        }
        // The same frame in other buffers is no reclipped frame.
        let is_still = previous.plan.sees_like(plan) && !is_same;
        if is_still && clip {
            let base = previous.base.filter(|_| previous.holds);
            return Work::Reclip {
                base: base.is_none(),
                fresh: base.unwrap_or(true),
            };
        }
        let has_classes = previous.holds
            && previous
                .region
                .as_ref()
                .is_some_and(|had| plan.has_classes_of(had));
        Work::Whole {
            clip: clip && !has_classes,
        }
    }

    /// The contents of the buffers once a plan has been recorded after a frame that left `before`.
    pub(crate) fn after(before: Option<Self>, scene: u64, plan: &Plan) -> Self {
        let before = before.filter(|previous| previous.holds && previous.scene == scene);
        let had = before.and_then(|previous| previous.region);
        let (base, region) = match plan.work {
            Work::Whole { .. } if plan.mode() == types::MODE_NONE => (Some(true), had),
            Work::Whole { .. } => (None, Some((plan.data.region, plan.layers.clone()))),
            // Its shortlists have replaced those of the stage's clip.
            Work::Reclip { .. } if plan.is_shortlisted() => (Some(false), None),
            Work::Reclip { .. } => (Some(false), had),
            Work::Draw => unreachable!("a frame that changes nothing leaves what there was"),
        };
        Self {
            scene,
            plan: plan.clone(),
            holds: true,
            base,
            region,
        }
    }
}

impl Plan {
    /// True when another plan gives the same pixels.
    fn is_drawn_like(&self, other: &Self) -> bool {
        self.sees_like(other)
            && same(&self.data.weight, &other.data.weight)
            && same(&self.data.region, &other.data.region)
            && self.layers.keep_like(&other.layers)
            && Weight::from_plan(self) == Weight::from_plan(other)
    }

    /// True when stage clip would find the sides that it has found from these regions and layers.
    fn has_classes_of(&self, (region, layers): &(RegionData, Layers)) -> bool {
        same(region, &self.data.region)
            && self.layers.contain_like(layers)
            && self.layers.keep_like(layers)
    }

    /// True when another plan differs in nothing but the clip and its weights, and its stages leave the same kinds of
    /// things in the same buffers.
    fn sees_like(&self, other: &Self) -> bool {
        same(&self.data.scene, &other.data.scene)
            && same(&self.data.views, &other.data.views)
            && same(&self.data.order, &other.data.order)
            && same(&self.data.tiles, &other.data.tiles)
            && self.layers.contain_like(&other.layers)
            && self.layers.see_like(&other.layers)
            && self.way == other.way
    }
}
