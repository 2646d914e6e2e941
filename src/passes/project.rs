//! Stage `project`, one invocation a survivor, computes conic, colour and depth key, the mask of tiles and, where it is
//! drawn as one, the quad.

use crate::gpu::Recorder;
use crate::passes::buffers::{buffers, indirect};
#[cfg(feature = "lab")]
use crate::passes::cost::{self, Cost};
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

#[cfg(feature = "lab")]
pub(super) const COSTS: &[Cost] = &[
    // How many there are, its Gaussian's number, the layer; the Gaussian meanwhile. Then the cutoff record's header and the
    // rest of it, the colour's constant, its units and those of three degrees; the record once more for the tiles.
    // It reads the survivor, the Gaussian, its colour and the record, and writes the splat, its depth, its rectangle of tiles and
    // its key, the curvatures of cut splats, and the masks of those that need one, which have a pair each at least; quads are left out, which frames of
    // tiles do without.
    Cost::of::<project::Program>(
        |n| n.survivors,
        |n| 2 + n.layer() + 2 + 5 + 2,
        |n| {
            let read = cost::SURVIVOR + cost::GAUSSIAN + n.sh_bytes;
            let written = cost::SPLAT + 3 * cost::WORD;
            let masks = n.masked_pairs * cost::gathered(cost::TILE_MASK);
            let cut = n.record_bytes + cost::gathered(cost::CURVATURE);
            n.survivors * (read + written) + n.cuts() + masks + n.cut * cut
        },
    ),
];

fn record(frame: &Frame<'_>, recorder: &mut Recorder<'_>) {
    let (scene, b) = (frame.scene, frame.buffers);
    let buffers = buffers!(project {
        b => [frame, survivors, counts, splats, quads, depth_keys, cut_records, tile_masks],
        scene => [gaussians, sh],
    });
    let groups = indirect!(b.counts, FrameCounts, project_groups);
    frame.dispatch(recorder, buffers, (), groups);
}
