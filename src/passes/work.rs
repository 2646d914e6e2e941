//! What of a frame has to be computed, given what the frame before has left in the buffers.

use bytemuck::bytes_of;

use crate::passes::plan::Plan;
use crate::passes::weight::Weight;
use crate::types::{self, FrameData};

/// What of a frame has to be computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Work {
    /// Everything, the clip's classes included unless they are those that are there.
    Whole {
        /// Whether they have to be found.
        clip: bool,
    },
    /// The camera stands still and the clip has moved: the classes that change, and what follows from them.
    Sweep {
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
    clip: Option<FrameData>,
}

impl Kept {
    /// What is left to do for a plan, after a frame that left `kept`.
    pub(crate) fn work(kept: Option<&Self>, scene: u64, plan: &Plan) -> Work {
        let clip = plan.mode != types::MODE_NONE;
        let Some(kept) = kept.filter(|kept| kept.scene == scene) else {
            return Work::Whole { clip };
        };
        let is_same = kept.plan.is_drawn_like(plan);
        if kept.holds && is_same {
            return Work::Draw;
        }
        // The same frame in other buffers is no sweep.
        let is_still = kept.plan.sees_like(plan) && !is_same;
        if is_still && clip {
            let base = kept.base.filter(|_| kept.holds);
            return Work::Sweep {
                base: base.is_none(),
                fresh: base.unwrap_or(true),
            };
        }
        let constants = clip_constants(plan);
        let has_classes = kept.holds && kept.clip.is_some_and(|had| same(&had, &constants));
        Work::Whole {
            clip: clip && !has_classes,
        }
    }

    /// What the buffers hold once a plan has been recorded after a frame that left `before`.
    pub(crate) fn after(before: Option<Self>, scene: u64, plan: &Plan) -> Self {
        let clip = before.filter(|kept| kept.holds && kept.scene == scene);
        let had = clip.and_then(|kept| kept.clip);
        let (base, clip) = match plan.work {
            Work::Whole { .. } if plan.mode == types::MODE_NONE => (Some(true), had),
            Work::Whole { .. } => (None, Some(clip_constants(plan))),
            Work::Sweep { .. } => (Some(false), had),
            Work::Draw => unreachable!("a frame that changes nothing leaves what there was"),
        };
        Self {
            scene,
            plan: plan.clone(),
            holds: true,
            base,
            clip,
        }
    }
}

impl Plan {
    /// Whether another plan gives the same pixels.
    fn is_drawn_like(&self, other: &Self) -> bool {
        let data = |plan: &Self| FrameData {
            pair_capacity: 0,
            redrawn: 0,
            ..plan.data
        };
        same(&data(self), &data(other))
            && Weight::of(self) == Weight::of(other)
            && self.goes_the_way_of(other)
    }

    /// Whether another plan differs in nothing but the clip.
    fn sees_like(&self, other: &Self) -> bool {
        let data = |plan: &Self| {
            let (plane_high, plane_low) = <_>::default();
            FrameData {
                mode: 0,
                op: 0,
                sigma: 0.0,
                form: 0,
                beam_switch: 0.0,
                trace_all: 0,
                cut_stride: 0,
                plane_count: 0,
                pair_capacity: 0,
                redrawn: 0,
                plane_high,
                plane_low,
                ..plan.data
            }
        };
        same(&data(self), &data(other)) && self.goes_the_way_of(other)
    }

    /// Whether the stages of another plan leave the same kinds of things in the same buffers.
    fn goes_the_way_of(&self, other: &Self) -> bool {
        self.raster == other.raster
            && self.expects_depth == other.expects_depth
            && self.show == other.show
            && self.sh_format == other.sh_format
            && self.sort_passes == other.sort_passes
    }
}

/// What the clip stage's classes depend on.
fn clip_constants(plan: &Plan) -> FrameData {
    let mut data: FrameData = bytemuck::Zeroable::zeroed();
    data.mode = plan.data.mode;
    data.op = plan.data.op;
    data.trace_all = plan.data.trace_all;
    data.plane_count = plan.data.plane_count;
    data.plane_high = plan.data.plane_high;
    data.plane_low = plan.data.plane_low;
    if plan.mode == types::MODE_RARA {
        data.sigma = plan.data.sigma;
    }
    data
}

/// By their bytes: what is no number is itself.
fn same(a: &FrameData, b: &FrameData) -> bool {
    bytes_of(a) == bytes_of(b)
}
