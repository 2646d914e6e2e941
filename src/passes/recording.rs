//! What a stage records with: its commands go into a command buffer, or, dry, leave the pipelines that they need.

use ash::vk;

use crate::passes::owner::Owner;
use crate::passes::pipelines::{FromPlan, Pipeline, PipelineKey};
use crate::passes::resources::{HostDepth, Resources};
use crate::passes::shaders::{BufferSet, Compute, Interface};
use rara_gpu::{self, Recorder};

/// The recording of an owner's stages.
pub(crate) struct Recording<'a, 'r, P: Owner> {
    pub(crate) plan: &'a P,
    target: Target<'a, 'r, P>,
}

/// Where the commands go.
enum Target<'a, 'r, P: Owner> {
    /// Nowhere: the function gets the pipelines that they need.
    Dry(&'a mut dyn FnMut(PipelineKey)),
    Commands(&'a mut Recorder<'r>, &'a (dyn Resources<P::Name> + 'a)),
}

/// How many workgroups a dispatch has.
#[derive(Debug, Clone, Copy)]
pub(super) enum Groups<N> {
    Count(u32),
    /// Those of the indirect command at this offset in a buffer.
    Counted(N, usize),
}

/// The workgroups of the indirect command in a field of the frame's counts.
macro_rules! counted {
    ($field:ident) => {
        $crate::passes::recording::Groups::Counted(
            $crate::passes::storage::named(&$crate::passes::shared::MEMORY.counts),
            std::mem::offset_of!($crate::types::FrameCounts, $field),
        )
    };
}
pub(super) use counted;

impl<'a, 'r, P: Owner> Recording<'a, 'r, P> {
    /// Records into a command buffer.
    pub(super) fn new(
        plan: &'a P,
        recorder: &'a mut Recorder<'r>,
        resources: &'a (dyn Resources<P::Name> + 'a),
    ) -> Self {
        let target = Target::Commands(recorder, resources);
        Self { plan, target }
    }

    /// Records nothing; `need` gets each pipeline.
    pub(super) fn dry(plan: &'a P, need: &'a mut dyn FnMut(PipelineKey)) -> Self {
        Self {
            plan,
            target: Target::Dry(need),
        }
    }

    /// The host's depth, for tiles that it hides.
    pub(super) fn depth(&self) -> Option<&HostDepth> {
        match &self.target {
            Target::Dry(_) => None,
            Target::Commands(_, resources) => resources.depth(),
        }
    }

    /// Records a dispatch of the program that has these buffers.
    pub(super) fn dispatch<B, C>(&mut self, buffers: B, params: C::Params, groups: Groups<P::Name>)
    where
        B: BufferSet<P::Name, Program = C>,
        C: Compute<Buffers<P::Name> = B>,
        C::Constants: FromPlan<P>,
    {
        let pipeline = Pipeline::<C>::from_plan(self.plan);
        self.dispatch_pipeline(&pipeline, buffers, params, groups);
    }

    /// The same of one of several pipelines of a program.
    pub(super) fn dispatch_pipeline<C: Interface>(
        &mut self,
        pipeline: &Pipeline<C>,
        buffers: C::Buffers<P::Name>,
        params: C::Params,
        groups: Groups<P::Name>,
    ) {
        match &mut self.target {
            Target::Dry(need) => need(pipeline.key()),
            Target::Commands(recorder, resources) => {
                let resources = *resources;
                let buffer = |name| resources.buffer(name);
                let groups = match groups {
                    Groups::Count(count) => rara_gpu::Groups::Count(count),
                    Groups::Counted(name, offset) => {
                        rara_gpu::Groups::Indirect(buffer(name), offset as u64)
                    }
                };
                let pipelines = resources.pipelines();
                let depth = resources.depth().map(|depth| depth.sampled);
                pipeline.dispatch(
                    pipelines,
                    recorder,
                    (buffers, buffer),
                    params,
                    (groups, depth),
                );
            }
        }
    }

    /// Fills a buffer with a word.
    pub(super) fn fill(&mut self, name: impl Into<P::Name>, value: u32) {
        if let Target::Commands(recorder, resources) = &mut self.target {
            let buffer = resources.buffer(name.into());
            recorder.fill(buffer, 0, buffer.size(), value);
        }
    }

    /// Copies a buffer into another one, from a byte of that on.
    pub(super) fn copy(&mut self, from: impl Into<P::Name>, to: impl Into<P::Name>, at: u64) {
        if let Target::Commands(recorder, resources) = &mut self.target {
            let [from, to] = [from.into(), to.into()].map(|name| resources.buffer(name));
            let whole = vk::BufferCopy {
                src_offset: 0,
                dst_offset: at,
                size: from.size(),
            };
            recorder.copy(from, to, &[whole]);
        }
    }

    /// Records a stage under its name.
    pub(super) fn stage(&mut self, name: &'static str, record: fn(&mut Recording<'_, '_, P>)) {
        let plan = self.plan;
        match &mut self.target {
            Target::Dry(_) => record(self),
            Target::Commands(recorder, resources) => recorder.pass(name, |recorder| {
                record(&mut Recording::new(plan, recorder, *resources));
            }),
        }
    }
}
