//! Stage 10: quads by a mesh shader or by instancing, back to front, blended `over`; the fragment stage consults the
//! cutoff buffer for cut splats only.

use std::mem::offset_of;

use crate::depth::DepthMap;
use crate::error::Result;
use crate::gpu::{Attachments, Drawer, GraphicsPipeline};
use crate::passes::buffers::Buffers;
use crate::passes::context::Context;
use crate::passes::plan::Plan;
use crate::passes::shaders;
use crate::settings::{Raster, Show};
use crate::types::{self, FrameCounts};

#[derive(Debug, Clone)]
pub(crate) struct Splat {
    pipeline: GraphicsPipeline,
    mesh: bool,
}

/// The specialisation constant of glsl/quad.glsl: whether splats have a depth in the host's buffer.
pub(crate) const DEPTH: u32 = 5;

/// What tells one pipeline from another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct SplatKey {
    mesh: bool,
    attachments: Attachments,
    weight: WeightKey,
    show: Show,
}

/// What of a frame the weight of cut splats depends on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct WeightKey {
    mode: u32,
    op: u32,
    decay: u32,
    miss: u32,
    phi: u32,
}

impl SplatKey {
    /// The pipeline a plan needs: after a hard clip nothing is left for the fragment stage to do, and what a mode does
    /// not ask for does not tell its pipelines apart.
    pub(crate) fn new(plan: &Plan, attachments: Attachments) -> Self {
        Self {
            mesh: plan.raster == Raster::Mesh,
            attachments,
            weight: WeightKey::new(plan),
            show: plan.show,
        }
    }
}

impl WeightKey {
    /// What a plan needs.
    pub(crate) fn new(plan: &Plan) -> Self {
        let when = |needed: bool, value: u32| if needed { value } else { 0 };
        let op = match plan.data.plane_count {
            1 => types::OP_ONE,
            _ => plan.data.op,
        };
        Self {
            mode: when(plan.cutoff, plan.mode),
            op: when(plan.cutoff, op),
            decay: when(plan.cutoff, plan.decay),
            miss: when(plan.cutoff && plan.mode == types::MODE_RARA, plan.miss),
            phi: when(plan.cutoff && plan.mode == types::MODE_EXACT, plan.phi),
        }
    }
}

impl WeightKey {
    /// The specialisation constants of glsl/weight.glsl.
    pub(crate) fn constants(self) -> [(u32, u32); 5] {
        [
            (0, self.mode),
            (1, self.op),
            (2, self.decay),
            (3, self.miss),
            (4, self.phi),
        ]
    }
}

impl Splat {
    /// What the weight depends on is fixed in the pipeline: without a clip the fragment shader holds no clip code.
    pub(crate) fn new(context: &Context<'_>, key: SplatKey) -> Result<Self> {
        let mesh = key.mesh;
        let front = if mesh {
            &shaders::SPLAT_MESH
        } else {
            &shaders::SPLAT_VERT
        };
        let depth = key.attachments.depth.is_some();
        let [mode, op, decay, miss, phi] = key.weight.constants();
        let show = (key.show == Show::Weight).into();
        let constants = [mode, op, decay, miss, phi, (DEPTH, depth.into()), (6, show)];
        let fragment = &shaders::SPLAT_FRAG;
        let pipeline = context.graphics("splat", front, fragment, &constants, depth)?;
        Ok(Self { pipeline, mesh })
    }

    /// Draws inside the host's rendering scope; `origin` is where its viewport begins, px. `map` is what the host's depth
    /// buffer holds for a depth, if it is tested.
    pub(crate) fn record(
        &self,
        drawer: &mut Drawer<'_>,
        b: &Buffers,
        plan: &Plan,
        origin: [f32; 2],
        map: Option<DepthMap>,
    ) {
        let buffers = [
            &b.frame,
            &b.counts,
            &b.splats,
            &b.order[plan.sorted()],
            &b.cuts,
        ];
        let params = params(plan, origin, map);
        if self.mesh {
            let at = offset_of!(FrameCounts, mesh_groups) as u64;
            drawer.draw_mesh_tasks_indirect(&self.pipeline, &buffers, &params, &b.counts, at);
        } else {
            let at = offset_of!(FrameCounts, draw) as u64;
            drawer.draw_indirect(&self.pipeline, &buffers, &params, &b.counts, at);
        }
    }
}

/// The parameters of glsl/quad.glsl, glsl/weight.glsl and glsl/host_depth.glsl.
pub(crate) fn params(plan: &Plan, origin: [f32; 2], map: Option<DepthMap>) -> [u32; 8] {
    let [x, y] = origin.map(f32::to_bits);
    let [_, _, cx, cy] = plan.data.focal;
    let [cx, cy] = [cx + origin[0], cy + origin[1]].map(f32::to_bits);
    let sigma = plan.data.sigma.to_bits();
    let [offset, scale] = map.map_or([0, 0], |map| map.words());
    [x, y, sigma, plan.cut_stride, cx, cy, offset, scale]
}
