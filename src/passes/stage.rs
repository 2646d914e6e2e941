//! A stage of the frame, and the context that it records with.

use ash::vk;

use crate::gpu::{Attachments, Groups, Recorder};
use crate::passes::buffers::{Buffers, DepthBuffers, ReclipBuffers, TileBuffers};
use crate::passes::pipelines::{Kernel, OfPlan, PipelineKey, Pipelines};
use crate::passes::plan::Plan;
use crate::passes::scene_buffers::SceneBuffers;
use crate::passes::shaders::{BufferSet, Compute};

/// A step of the frame that is computed before the draw.
#[derive(Debug)]
pub(crate) struct Stage {
    /// The name of its file, debug label, timer and statistics.
    pub(crate) name: &'static str,
    /// True for a frame that needs it.
    pub(crate) needed: fn(&Plan) -> bool,
    /// True for a frame that, without it, reports that it was skipped.
    pub(crate) missed: fn(&Plan) -> bool,
    /// The pipelines that it dispatches in a frame that needs it.
    pub(crate) pipelines: fn(&Plan, &mut dyn FnMut(PipelineKey)),
    /// Records it in a frame that needs it.
    pub(crate) record: fn(&Frame<'_>, &mut Recorder<'_>),
}

impl Stage {
    /// A stage of every frame that finds which Gaussians are in view.
    pub(crate) const fn when_finding_view(
        name: &'static str,
        pipelines: fn(&Plan, &mut dyn FnMut(PipelineKey)),
        record: fn(&Frame<'_>, &mut Recorder<'_>),
    ) -> Self {
        Self {
            name,
            needed: |plan| plan.finds_view(),
            missed: |_| true,
            pipelines,
            record,
        }
    }
}

/// One way to do a stage's work, where there may be several.
#[derive(Debug)]
pub(crate) struct KernelSet {
    /// As in a [`Stage`].
    pub(crate) pipelines: fn(&Plan, &mut dyn FnMut(PipelineKey)),
    /// As in a [`Stage`].
    pub(crate) record: fn(&Frame<'_>, &mut Recorder<'_>),
}

/// The context that a stage records with.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Frame<'a> {
    pub(crate) plan: &'a Plan,
    pub(crate) pipelines: &'a Pipelines,
    pub(crate) scene: &'a SceneBuffers,
    pub(crate) buffers: &'a Buffers,
    /// The rectangle of the host's depth under the picture, for tiles that it hides.
    pub(crate) copied: vk::Rect2D,
}

/// The attachments that a frame draws into.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Targets {
    pub(crate) colour: Attachments,
    /// Those of expected depths, where they are drawn.
    pub(crate) expected_depth: Option<Attachments>,
    /// True when the host's colours are linear light.
    pub(crate) linear: bool,
}

/// The pipeline that a plan makes of a program.
pub(crate) fn key<P>(plan: &Plan) -> PipelineKey
where
    P: Compute,
    P::Constants: OfPlan,
{
    Kernel::<P>::of(plan).key()
}

impl<'a> Frame<'a> {
    /// Records a dispatch of the program that has these buffers.
    pub(crate) fn dispatch<'b, B, P>(
        &self,
        recorder: &mut Recorder<'_>,
        buffers: B,
        params: P::Params,
        groups: Groups<'_>,
    ) where
        B: BufferSet<'b, Program = P>,
        P: Compute<Buffers<'b> = B>,
        P::Constants: OfPlan,
    {
        let kernel = Kernel::<P>::of(self.plan);
        kernel.dispatch(self.pipelines, recorder, buffers, params, groups);
    }

    /// The buffers of the tile rasteriser.
    pub(crate) fn tiles(&self) -> &'a TileBuffers {
        let tiles = self.buffers.tiles.as_ref();
        tiles.expect("a plan for tiles has their buffers")
    }

    /// The buffers of expected depths.
    pub(crate) fn depths(&self) -> &'a DepthBuffers {
        let depths = self.buffers.depth.as_ref();
        depths.expect("a plan that expects depths has their buffers")
    }

    /// The buffers of a reclipped frame.
    pub(crate) fn reclip(&self) -> &'a ReclipBuffers {
        let reclip = self.buffers.reclip.get();
        reclip.expect("configure() creates what a reclipped frame needs")
    }
}
