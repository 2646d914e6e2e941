//! What a stage records with: its commands go into a command buffer, or, dry, leave the pipelines that they need.

use ash::vk;

use crate::passes::buffers::Buffers;
use crate::passes::pipelines::{FromPlan, Pipeline, PipelineKey, Pipelines};
use crate::passes::plan::Plan;
use crate::passes::scene_buffers::SceneBuffers;
use crate::passes::shaders::{BufferSet, Compute, Interface};
use crate::passes::shared;
use crate::passes::storage::Storage;
use rara_gpu::{self, Buffer, Recorder};

/// The recording of a frame's stages.
pub(crate) struct Recording<'a, 'r> {
    pub(crate) plan: &'a Plan,
    /// The rectangle of the host's depth under the picture, for tiles that it hides.
    pub(crate) copied: vk::Rect2D,
    target: Target<'a, 'r>,
}

/// Where the commands go.
enum Target<'a, 'r> {
    /// Nowhere: the function gets the pipelines that they need.
    Dry(&'a mut dyn FnMut(PipelineKey)),
    Commands(&'a mut Recorder<'r>, Resources<'a>),
}

/// What a frame is recorded with.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Resources<'a> {
    pub(crate) pipelines: &'a Pipelines,
    pub(crate) scene: &'a SceneBuffers,
    pub(crate) buffers: &'a Buffers,
}

impl<'a> Resources<'a> {
    /// The buffer of a declaration.
    fn buffer(&self, storage: &Storage) -> &'a Buffer {
        match storage.of_scene {
            Some(buffer) => buffer(self.scene),
            None => self.buffers.get(storage),
        }
    }
}

/// How many workgroups a dispatch has.
#[derive(Debug, Clone, Copy)]
pub(super) enum Groups {
    Count(u32),
    /// Those of the indirect command at this offset in the frame's counts.
    Counted(usize),
}

/// The workgroups of the indirect command in a field of the frame's counts.
macro_rules! counted {
    ($field:ident) => {
        $crate::passes::recording::Groups::Counted(std::mem::offset_of!(
            $crate::types::FrameCounts,
            $field
        ))
    };
}
pub(super) use counted;

impl<'a, 'r> Recording<'a, 'r> {
    /// Records into a command buffer.
    pub(super) fn new(
        plan: &'a Plan,
        recorder: &'a mut Recorder<'r>,
        resources: Resources<'a>,
        copied: vk::Rect2D,
    ) -> Self {
        let target = Target::Commands(recorder, resources);
        Self {
            plan,
            copied,
            target,
        }
    }

    /// Records nothing; `need` gets each pipeline.
    pub(super) fn dry(plan: &'a Plan, need: &'a mut dyn FnMut(PipelineKey)) -> Self {
        Self {
            plan,
            copied: vk::Rect2D::default(),
            target: Target::Dry(need),
        }
    }

    /// Records a dispatch of the program that has these buffers.
    pub(super) fn dispatch<B, P>(&mut self, buffers: B, params: P::Params, groups: Groups)
    where
        B: BufferSet<&'static Storage, Program = P>,
        P: Compute<Buffers<&'static Storage> = B>,
        P::Constants: FromPlan,
    {
        let pipeline = Pipeline::<P>::from_plan(self.plan);
        self.dispatch_pipeline(&pipeline, buffers, params, groups);
    }

    /// The same of one of several pipelines of a program.
    pub(super) fn dispatch_pipeline<P: Interface>(
        &mut self,
        pipeline: &Pipeline<P>,
        buffers: P::Buffers<&'static Storage>,
        params: P::Params,
        groups: Groups,
    ) {
        match &mut self.target {
            Target::Dry(need) => need(pipeline.key()),
            Target::Commands(recorder, resources) => {
                let buffer = |storage| resources.buffer(storage);
                let groups = match groups {
                    Groups::Count(count) => rara_gpu::Groups::Count(count),
                    Groups::Counted(offset) => {
                        rara_gpu::Groups::Indirect(buffer(&shared::MEMORY.counts), offset as u64)
                    }
                };
                let pipelines = resources.pipelines;
                pipeline.dispatch(pipelines, recorder, (buffers, buffer), params, groups);
            }
        }
    }

    /// Fills a buffer with a word.
    pub(super) fn fill(&mut self, storage: &Storage, value: u32) {
        if let Target::Commands(recorder, resources) = &mut self.target {
            let buffer = resources.buffer(storage);
            recorder.fill(buffer, 0, buffer.size(), value);
        }
    }

    /// Writes a few bytes to the beginning of a buffer.
    pub(super) fn update(&mut self, storage: &Storage, bytes: &[u8]) {
        if let Target::Commands(recorder, resources) = &mut self.target {
            recorder.update(resources.buffer(storage), 0, bytes);
        }
    }

    pub(super) fn copy(&mut self, from: &Storage, to: &Storage, region: vk::BufferCopy) {
        if let Target::Commands(recorder, resources) = &mut self.target {
            recorder.copy(resources.buffer(from), resources.buffer(to), &[region]);
        }
    }

    /// Records a stage under its name.
    pub(super) fn stage(&mut self, name: &'static str, record: fn(&mut Recording<'_, '_>)) {
        let (plan, copied) = (self.plan, self.copied);
        match &mut self.target {
            Target::Dry(_) => record(self),
            Target::Commands(recorder, resources) => recorder.pass(name, |recorder| {
                record(&mut Recording::new(plan, recorder, *resources, copied));
            }),
        }
    }
}
