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
use rara_gpu::{Attachments, Drawer};
use rara_scene::settings::Show;

/// The draw of the tiles' picture, in the light of the target where that is another and colours are shown.
pub(crate) fn draw(plan: &EyePlan, targets: Targets) -> Draw<composite::Program> {
    let shows_colours = matches!(plan.way.show, Show::Colour | Show::Weight);
    let converts = shows_colours && targets.convert(plan.way.show);
    let constants = composite::Constants {
        linear: converts && targets.linear,
        stored: converts && !targets.linear,
        expected_depth: false,
    };
    let shaders = [&composite::VERT, &composite::FRAG];
    Draw::new(shaders, constants, targets.colour, false)
}

/// The draw of the expected depths that tiles have found.
pub(crate) fn draw_depth(attachments: Attachments) -> Draw<composite::Program> {
    let constants = composite::Constants {
        linear: false,
        stored: false,
        expected_depth: true,
    };
    let shaders = [&composite::VERT, &composite::FRAG];
    Draw::new(shaders, constants, attachments, false)
}

/// Blends the tiles' picture onto what the host has drawn, inside the host's rendering scope. `origin` is where its viewport
/// begins, px, and depths are multiplied by `unit`.
pub(crate) fn record(
    drawer: &mut Drawer<'_>,
    pipelines: &Pipelines,
    (draw, b): (Draw<composite::Program>, &Buffers<EyePlan>),
    origin: [f32; 2],
    unit: f64,
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
    let unit = unit as f32;
    let params = composite::Params { origin, unit };
    let buffers = (buffers, |storage| b.get(storage));
    draw.draw(pipelines, drawer, buffers, params, args);
}
