//! Stage `composite` draws the picture that tiles have made onto what the host has drawn.

use std::mem::offset_of;

use crate::passes::bin::lists;
use crate::passes::buffers::Buffers;
use crate::passes::eye_plan::EyePlan;
use crate::passes::pipelines::{Draw, Pipelines};
use crate::passes::shaders::composite;
use crate::passes::stage::Targets;
use crate::passes::storage::buffers;
use crate::passes::{shared, tiles};
use crate::types::FrameCounts;
use rara_gpu::Drawer;
use rara_scene::settings::Show;

/// The draw of the tiles' picture, in the light of the target where that is another and colours are shown.
pub(crate) fn draw(plan: &EyePlan, targets: Targets) -> Draw<composite::Program> {
    let shows_colours = matches!(plan.way.show, Show::Colour | Show::Weight);
    let converts = shows_colours && targets.convert(plan.way.show);
    let constants = composite::Constants {
        linear: converts && targets.linear,
        stored: converts && !targets.linear,
    };
    let shaders = [&composite::VERT, &composite::FRAG];
    Draw::new(shaders, constants, targets.colour, false)
}

/// Blends the tiles' picture onto what the host has drawn, inside the host's rendering scope. `origin` is where its viewport
/// begins, px.
pub(crate) fn record(
    drawer: &mut Drawer<'_>,
    pipelines: &Pipelines,
    (plan, b): (&EyePlan, &Buffers<EyePlan>),
    targets: Targets,
    origin: [f32; 2],
) {
    let buffers = buffers!(composite {
        shared::MEMORY => [frame],
        lists::MEMORY => [tile_begins];
        picture: &tiles::MEMORY.tile_picture,
    });
    let args = (
        b.get(&shared::MEMORY.counts),
        offset_of!(FrameCounts, composite) as u64,
    );
    let params = composite::Params { origin };
    let buffers = (buffers, |storage| b.get(storage));
    draw(plan, targets).draw(pipelines, drawer, buffers, params, args);
}
