//! The pipelines of all stages, in one cache: each is made when a frame first needs it, and is found again by its
//! [`PipelineKey`].

use std::collections::HashMap;
use std::hash::{Hash, Hasher};
use std::marker::PhantomData;
use std::time::Instant;

use ash::vk;

use crate::passes::shaders::{
    BufferList, BufferSet, Compute, ConstantList, ConstantSet, Interface,
};
use rara_base::error::Result;
use rara_gpu::{
    Attachments, Bindings, Buffer, ComputeDesc, ComputePipeline, DepthUse, Device, Drawer,
    GraphicsDesc, GraphicsPipeline, Groups, Recorder, Shader,
};

/// A pipeline's identity: its shaders, their constants, and what it draws into.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) struct PipelineKey {
    /// For debuggers, validation messages and errors.
    name: &'static str,
    shader: Identity,
    constants: ConstantList,
    draw: Option<DrawKey>,
}

/// What a draw has besides.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct DrawKey {
    fragment: Identity,
    attachments: Attachments,
    /// The use for the host's depth.
    depth: DepthUse,
    /// True where colours are blended `over` those that are there.
    blends: bool,
}

/// A shader, compared by where it is.
#[derive(Debug, Clone, Copy)]
struct Identity(&'static Shader);

impl PartialEq for Identity {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.0, other.0)
    }
}

impl Eq for Identity {}

impl Hash for Identity {
    fn hash<H: Hasher>(&self, state: &mut H) {
        std::ptr::from_ref(self.0).hash(state);
    }
}

/// Constants that follow from a plan.
pub(crate) trait FromPlan<P> {
    fn from_plan(plan: &P) -> Self;
}

impl<P> FromPlan<P> for () {
    fn from_plan(_: &P) {}
}

/// A compute pipeline that a stage dispatches: a shader of a program, with constants.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Pipeline<P> {
    key: PipelineKey,
    program: PhantomData<P>,
}

impl<P: Interface> Pipeline<P> {
    pub(crate) fn new(shader: &'static Shader, constants: P::Constants) -> Self {
        let key = PipelineKey {
            name: P::NAME,
            shader: Identity(shader),
            constants: constants.list(),
            draw: None,
        };
        Self {
            key,
            program: PhantomData,
        }
    }

    /// The same pipeline by another name, where a program does the work of two stages.
    pub(crate) fn named(mut self, name: &'static str) -> Self {
        self.key.name = name;
        self
    }

    /// The pipeline that a plan makes of a program.
    pub(crate) fn from_plan<O>(plan: &O) -> Self
    where
        P: Compute,
        P::Constants: FromPlan<O>,
    {
        Self::new(P::SHADER, P::Constants::from_plan(plan))
    }

    pub(super) fn key(&self) -> PipelineKey {
        self.key.clone()
    }

    /// Records a dispatch; the function finds the buffers, and a shader that reads an image gets that.
    pub(super) fn dispatch<'b, B: Copy>(
        &self,
        pipelines: &Pipelines,
        recorder: &mut Recorder<'_>,
        (buffers, buffer): (P::Buffers<B>, impl Fn(B) -> &'b Buffer),
        params: P::Params,
        (groups, image): (Groups<'_>, Option<(vk::ImageView, vk::ImageLayout)>),
    ) {
        let pipeline = &pipelines.compute[&self.key];
        let buffers: BufferList<_> = buffers.list().into_iter().map(buffer).collect();
        let params = words(&params);
        match image.filter(|_| self.key.shader.0.image) {
            None => recorder.dispatch(pipeline, &buffers, params, groups),
            // SAFETY: whoever gave the host's depth promised what is asked for here.
            Some(image) => unsafe {
                recorder.dispatch_on_image(pipeline, &buffers, params, groups, image);
            },
        }
    }
}

/// A graphics pipeline that a stage draws with.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Draw<P> {
    key: PipelineKey,
    program: PhantomData<P>,
}

impl<P: Interface> Draw<P> {
    pub(crate) fn new(
        [front, fragment]: [&'static Shader; 2],
        constants: P::Constants,
        attachments: Attachments,
        depth: DepthUse,
    ) -> Self {
        let key = PipelineKey {
            name: P::NAME,
            shader: Identity(front),
            constants: constants.list(),
            draw: Some(DrawKey {
                fragment: Identity(fragment),
                attachments,
                depth,
                blends: depth != DepthUse::Written,
            }),
        };
        Self {
            key,
            program: PhantomData,
        }
    }

    /// The same where fragments take the place of what is there.
    pub(super) fn overwriting(mut self) -> Self {
        self.key.draw = self.key.draw.map(|draw| DrawKey {
            blends: false,
            ..draw
        });
        self
    }

    pub(super) fn key(&self) -> PipelineKey {
        self.key.clone()
    }

    /// Records a draw whose indirect command, of meshes or of vertices, is at `offset` in `args`; the function finds the
    /// buffers.
    pub(super) fn draw<'b, B: Copy>(
        &self,
        pipelines: &Pipelines,
        drawer: &mut Drawer<'_>,
        (buffers, buffer): (P::Buffers<B>, impl Fn(B) -> &'b Buffer),
        params: P::Params,
        (args, offset): (&Buffer, u64),
    ) {
        let pipeline = &pipelines.graphics[&self.key];
        let buffers: BufferList<_> = buffers.list().into_iter().map(buffer).collect();
        let params = words(&params);
        if self.key.shader.0.stage == vk::ShaderStageFlags::MESH_EXT {
            drawer.draw_mesh_tasks_indirect(pipeline, &buffers, params, args, offset);
        } else {
            drawer.draw_indirect(pipeline, &buffers, params, args, offset);
        }
    }
}

/// A program's parameters as they go into the push constants.
fn words<P: bytemuck::Pod>(params: &P) -> &[u32] {
    match size_of::<P>() {
        0 => &[], // an empty struct may lie at any address, words may not
        _ => bytemuck::cast_slice(bytemuck::bytes_of(params)),
    }
}

/// Every pipeline that frames have needed so far, for one way of binding. A copy has the same pipelines.
#[derive(Debug, Clone)]
pub(crate) struct Pipelines {
    bindings: Bindings,
    compute: HashMap<PipelineKey, ComputePipeline>,
    graphics: HashMap<PipelineKey, GraphicsPipeline>,
}

impl Pipelines {
    pub(crate) fn new(bindings: Bindings) -> Self {
        Self {
            bindings,
            compute: HashMap::new(),
            graphics: HashMap::new(),
        }
    }

    pub(crate) fn has(&self, key: &PipelineKey) -> bool {
        self.compute.contains_key(key) || self.graphics.contains_key(key)
    }

    /// Makes the pipelines that are not there yet, on as many threads as the device allows.
    pub(crate) fn ensure(&mut self, device: &Device, keys: Vec<PipelineKey>) -> Result<()> {
        let mut missing: Vec<PipelineKey> = Vec::new();
        for key in keys {
            if !self.has(&key) && !missing.contains(&key) {
                missing.push(key);
            }
        }
        // The largest first, so that no thread is left alone with it at the end.
        missing.sort_by_key(|key| std::cmp::Reverse(key.shader.0.bound.len()));
        let bindings = self.bindings;
        let made = device.making_pipelines(
            &missing,
            |key| key.compute_desc(bindings),
            |key| key.make(device, bindings),
        )?;
        for (key, pipeline) in missing.into_iter().zip(made) {
            match pipeline {
                AnyPipeline::Compute(pipeline) => drop(self.compute.insert(key, pipeline)),
                AnyPipeline::Graphics(pipeline) => drop(self.graphics.insert(key, pipeline)),
            }
        }
        Ok(())
    }
}

enum AnyPipeline {
    Compute(ComputePipeline),
    Graphics(GraphicsPipeline),
}

impl PipelineKey {
    /// The description of a compute pipeline; `None` for a draw.
    fn compute_desc(&self, bindings: Bindings) -> Option<ComputeDesc<'_>> {
        self.draw.is_none().then(|| ComputeDesc {
            name: self.name,
            shader: self.shader.0,
            constants: &self.constants,
            bindings,
        })
    }

    fn make(&self, device: &Device, bindings: Bindings) -> Result<AnyPipeline> {
        let begun = Instant::now();
        let made = match (self.compute_desc(bindings), self.draw) {
            (Some(desc), _) => AnyPipeline::Compute(ComputePipeline::new(device, &desc)?),
            (None, draw) => {
                let DrawKey {
                    fragment: Identity(fragment),
                    attachments,
                    depth,
                    blends,
                } = draw.expect("what computes nothing draws");
                let desc = GraphicsDesc {
                    name: self.name,
                    front: self.shader.0,
                    fragment,
                    constants: &self.constants,
                    attachments,
                    depth,
                    blend: blends.then_some(OVER),
                    topology: vk::PrimitiveTopology::TRIANGLE_STRIP,
                    bindings,
                };
                AnyPipeline::Graphics(GraphicsPipeline::new(device, &desc)?)
            }
        };
        let ms = 1e3 * begun.elapsed().as_secs_f64();
        log::debug!("pipeline \"{}\" was made in {ms:.1} ms", self.name);
        Ok(made)
    }
}

/// Premultiplied `over`.
const OVER: vk::PipelineColorBlendAttachmentState = vk::PipelineColorBlendAttachmentState {
    blend_enable: vk::TRUE,
    src_color_blend_factor: vk::BlendFactor::ONE,
    dst_color_blend_factor: vk::BlendFactor::ONE_MINUS_SRC_ALPHA,
    color_blend_op: vk::BlendOp::ADD,
    src_alpha_blend_factor: vk::BlendFactor::ONE,
    dst_alpha_blend_factor: vk::BlendFactor::ONE_MINUS_SRC_ALPHA,
    alpha_blend_op: vk::BlendOp::ADD,
    color_write_mask: vk::ColorComponentFlags::RGBA,
};
