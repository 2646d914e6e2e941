//! What of a frame has to be computed, given what the frame before has left in the buffers.

use bytemuck::bytes_of;

use crate::passes::layers::Layers;
use crate::passes::plan::Plan;
use crate::passes::weight::Weight;
use crate::types::{self, RegionData};

/// What of a frame has to be computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Work {
    /// Everything, the clip's classes included unless they are those that are there.
    Whole {
        /// Whether they have to be found.
        clip: bool,
    },
    /// The camera stands still and the clip has moved: the classes that change, and what follows from them.
    Reclip {
        /// Whether what is in view, clipped away or not, has to be found first.
        base: bool,
        /// Whether no clip has changed it yet.
        fresh: bool,
    },
    /// Nothing has changed: the draw alone.
    Draw,
}

/// What the buffers hold after a frame.
#[derive(Debug)]
pub(crate) struct Kept {
    scene: u64,
    plan: Plan,
    /// The buffers are still those that the frame wrote.
    pub(crate) holds: bool,
    /// The survivors are all in view, clipped away or not; `Some(true)` if no clip has changed them yet.
    base: Option<bool>,
    /// What the classes of the clip stage are of.
    region: Option<(RegionData, Layers)>,
}

impl Kept {
    /// What is left to do for a plan, after a frame that left `kept`.
    pub(crate) fn work(kept: Option<&Self>, scene: u64, plan: &Plan) -> Work {
        let clip = plan.mode() != types::MODE_NONE;
        let Some(kept) = kept.filter(|kept| kept.scene == scene) else {
            return Work::Whole { clip };
        };
        let is_same = kept.plan.is_drawn_like(plan);
        if kept.holds && is_same {
            return Work::Draw;
        }
        // The same frame in other buffers is no reclipped frame.
        let is_still = kept.plan.sees_like(plan) && !is_same;
        if is_still && clip {
            let base = kept.base.filter(|_| kept.holds);
            return Work::Reclip {
                base: base.is_none(),
                fresh: base.unwrap_or(true),
            };
        }
        let has_classes = kept.holds
            && kept
                .region
                .as_ref()
                .is_some_and(|had| plan.has_classes_of(had));
        Work::Whole {
            clip: clip && !has_classes,
        }
    }

    /// What the buffers hold once a plan has been recorded after a frame that left `before`.
    pub(crate) fn after(before: Option<Self>, scene: u64, plan: &Plan) -> Self {
        let before = before.filter(|kept| kept.holds && kept.scene == scene);
        let had = before.and_then(|kept| kept.region);
        let (base, region) = match plan.work {
            Work::Whole { .. } if plan.mode() == types::MODE_NONE => (Some(true), had),
            Work::Whole { .. } => (None, Some((plan.data.region, plan.layers.clone()))),
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
    /// Whether another plan gives the same pixels.
    fn is_drawn_like(&self, other: &Self) -> bool {
        self.sees_like(other)
            && same(&self.data.weight, &other.data.weight)
            && same(&self.data.region, &other.data.region)
            && self.layers.keep_like(&other.layers)
            && Weight::of(self) == Weight::of(other)
    }

    /// Whether the clip stage would find the classes that it has found of such regions and layers.
    fn has_classes_of(&self, (region, layers): &(RegionData, Layers)) -> bool {
        same(region, &self.data.region)
            && self.layers.contain_like(layers)
            && self.layers.keep_like(layers)
    }

    /// Whether another plan differs in nothing but the clip and its weights, and its stages leave the same kinds of things
    /// in the same buffers.
    fn sees_like(&self, other: &Self) -> bool {
        same(&self.data.scene, &other.data.scene)
            && same(&self.data.view, &other.data.view)
            && same(&self.data.order, &other.data.order)
            && same(&self.data.tiles, &other.data.tiles)
            && self.layers.contain_like(&other.layers)
            && self.layers.see_like(&other.layers)
            && self.way == other.way
    }
}

/// By their bytes: what is no number is itself.
pub(super) fn same<T: bytemuck::NoUninit>(a: &T, b: &T) -> bool {
    bytes_of(a) == bytes_of(b)
}
