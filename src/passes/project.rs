//! Stage `project`, one invocation a survivor, computes conic, colour and depth key, the mask of tiles and, where it is
//! drawn as one, the quad.

use crate::gpu::Recorder;
use crate::passes::buffers::{buffers, indirect};
use crate::passes::pipelines::OfPlan;
use crate::passes::plan::Plan;
use crate::passes::shaders::project;
use crate::passes::stage::{Frame, Stage, key};
use crate::settings::Show;
use crate::types::FrameCounts;

pub(crate) const STAGE: Stage = Stage::when_finding_view(
    "project",
    |plan, need| need(key::<project::Program>(plan)),
    record,
);

/// The shader reads spherical harmonics in one format; without cut splats it reads no cutoff records.
impl OfPlan for project::Constants {
    fn of(plan: &Plan) -> Self {
        Self {
            cut: plan.view_is_cut(),
            layered: plan.way.layered,
            sh_format: plan.way.sh_format.code(),
            tiles: plan.is_tiled(),
            quads: plan.needs_quads(),
            rects: plan.keeps_rects(),
            numbered: plan.way.show == Show::Strongest,
        }
    }
}

fn record(frame: &Frame<'_>, recorder: &mut Recorder<'_>) {
    let (scene, b) = (frame.scene, frame.buffers);
    let buffers = buffers!(project {
        b => [frame, survivors, counts, splats, quads, depth_keys, cut_records, tile_masks],
        scene => [gaussians, sh],
    });
    let groups = indirect!(b.counts, FrameCounts, project_groups);
    frame.dispatch(recorder, buffers, (), groups);
}
