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
use rara_gpu::{Attachments, Buffer, DepthUse, Drawer, Shader};
use rara_scene::depth::DepthMap;

/// What is drawn of the tiles' picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Part {
    /// The colours, in the light of the target where that is another.
    Colours,
    /// The expected depths, into attachments of their own.
    ExpectedDepth(Attachments),
    /// The depths for the host's depth buffer.
    WrittenDepth,
}

pub(crate) fn draw(plan: &EyePlan, targets: Targets, part: Part) -> Draw<composite::Program> {
    let show = plan.way.show;
    let converts = part == Part::Colours && !show.needs_tiles() && targets.convert(show);
    let (fragment, attachments, depth) = match part {
        Part::Colours => (&composite::FRAG, targets.colour, DepthUse::Ignored),
        Part::ExpectedDepth(attachments) => (&composite::FRAG, attachments, DepthUse::Ignored),
        Part::WrittenDepth => (&composite::DEPTH_FRAG, targets.colour, DepthUse::Written),
    };
    let (front, scope_view) = front([&composite::VERT, &composite::MULTIVIEW_VERT], attachments);
    let constants = composite::Constants {
        scope_view,
        linear: converts && targets.linear,
        stored: converts && !targets.linear,
        depths: matches!(part, Part::ExpectedDepth(_)),
        // Written depths begin behind the pixels, or behind the expected depths where a frame has these.
        expected_depth: part == Part::WrittenDepth && plan.way.expects_depth,
        written_depth: false,
        strongest: false,
    };
    Draw::new([front, fragment], constants, attachments, depth)
}

/// The shader of the picture's quads, of one for scopes of one view and one for scopes of several, and the view that it draws.
pub(super) fn front(
    [one, several]: [&'static Shader; 2],
    attachments: Attachments,
) -> (&'static Shader, u32) {
    match attachments.target.view() {
        None => (one, 0),
        Some(view) => (several, view),
    }
}

/// Blends a part of the tiles' picture onto what the host has drawn, inside the host's rendering scope. `origin` is where its
/// viewport begins, px; `map` says what its depth buffer holds for a depth, and depths are multiplied by `unit`.
pub(crate) fn record(
    drawer: &mut Drawer<'_>,
    pipelines: &Pipelines,
    (draw, b): (Draw<composite::Program>, &Buffers<EyePlan>),
    origin: [f32; 2],
    (map, unit): (Option<DepthMap>, f64),
) {
    let buffers = buffers!(composite {
        shared::MEMORY => [frame],
        lists::MEMORY => [tile_begins];
        picture: &tiles::MEMORY.tile_picture,
    });
    let [depth_offset, depth_scale] = map.map_or([0.0; 2], |map| map.factors());
    let params = composite::Params {
        origin,
        unit: unit as f32,
        depth_offset,
        depth_scale,
    };
    let buffers = (buffers, |storage| b.get(storage));
    draw.draw(pipelines, drawer, buffers, params, args(b));
}

/// The indirect draw of the tiles' picture.
pub(super) fn args(b: &Buffers<EyePlan>) -> (&Buffer, u64) {
    let counts = b.get(&shared::MEMORY.counts);
    (counts, offset_of!(FrameCounts, composite) as u64)
}
