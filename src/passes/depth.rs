//! Stage `depth`, only where a host asks for it: how deep each splat is in a pixel, on average of what the clip leaves of it;
//! and the draw that blends those depths.

use std::mem::offset_of;

use crate::depth::DepthMap;
use crate::error::Result;
use crate::gpu::{Attachments, ComputePipeline, Drawer, GraphicsPipeline, Groups, Recorder};
use crate::passes::buffers::{Buffers, DepthBuffers};
use crate::passes::context::Context;
use crate::passes::plan::Plan;
use crate::passes::scene_buffers::SceneBuffers;
use crate::passes::shaders;
use crate::passes::splat::{DEPTH, WeightKey, params};
use crate::types::FrameCounts;

/// The splats' depths.
#[derive(Debug, Clone)]
pub(crate) struct Depth {
    pipeline: ComputePipeline,
}

impl Depth {
    pub(crate) fn new(context: &Context<'_>) -> Result<Self> {
        Ok(Self {
            pipeline: context.compute("depth", &shaders::DEPTH_COMP, &[])?,
        })
    }

    pub(crate) fn record(
        &self,
        recorder: &mut Recorder<'_>,
        scene: &SceneBuffers,
        b: &Buffers,
        d: &DepthBuffers,
    ) {
        let buffers = [
            &b.frame,
            &scene.gaussians,
            &b.survivors,
            &b.counts,
            &d.depths,
        ];
        let groups = Groups::Indirect(&b.counts, offset_of!(FrameCounts, project_groups) as u64);
        recorder.dispatch(&self.pipeline, &buffers, &[], groups);
        // A quad a survivor, also where tiles draw their colours.
        let quad = [4_u32, 0, 0, 0];
        recorder.update(&d.draw, 0, bytemuck::bytes_of(&quad));
        let survivors = offset_of!(FrameCounts, mesh_groups) + 3 * size_of::<u32>();
        let region = ash::vk::BufferCopy {
            src_offset: survivors as u64,
            dst_offset: 4,
            size: 4,
        };
        recorder.copy(&b.counts, &d.draw, &[region]);
    }
}

/// The draw of the depths.
#[derive(Debug, Clone)]
pub(crate) struct SplatDepth {
    pipeline: GraphicsPipeline,
}

/// What tells one pipeline from another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct SplatDepthKey {
    attachments: Attachments,
    weight: WeightKey,
}

impl SplatDepthKey {
    /// The pipeline a plan needs.
    pub(crate) fn new(plan: &Plan, attachments: Attachments) -> Self {
        Self {
            attachments,
            weight: WeightKey::new(plan),
        }
    }
}

impl SplatDepth {
    pub(crate) fn new(context: &Context<'_>, key: SplatDepthKey) -> Result<Self> {
        let context = Context {
            attachments: key.attachments,
            ..*context
        };
        let test = key.attachments.depth.is_some();
        let [mode, op, decay, miss, phi] = key.weight.constants();
        let constants = [mode, op, decay, miss, phi, (DEPTH, test.into())];
        let (front, fragment) = (&shaders::SPLAT_DEPTH_VERT, &shaders::SPLAT_DEPTH_FRAG);
        Ok(Self {
            pipeline: context.graphics("splat_depth", front, fragment, &constants, test)?,
        })
    }

    /// Draws inside the host's rendering scope; `origin` is where its viewport begins, px, `map` what its depth buffer
    /// holds for a depth, `unit` what depths are multiplied by.
    pub(crate) fn record(
        &self,
        drawer: &mut Drawer<'_>,
        (b, d): (&Buffers, &DepthBuffers),
        plan: &Plan,
        origin: [f32; 2],
        map: Option<DepthMap>,
        unit: f64,
    ) {
        let order = &b.order[plan.sorted()];
        let buffers = [&b.frame, &b.counts, &b.splats, order, &b.cuts, &d.depths];
        let [x, y, sigma, stride, cx, cy, offset, scale] = params(plan, origin, map);
        let unit = (unit as f32).to_bits();
        let params = [x, y, sigma, stride, cx, cy, offset, scale, unit];
        drawer.draw_indirect(&self.pipeline, &buffers, &params, &d.draw, 0);
    }
}
