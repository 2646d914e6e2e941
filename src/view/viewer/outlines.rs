//! The lines over the window's picture: the outlines of what clips it.

use glam::DVec3;
use rara::Camera;

use super::layers::Clips;
use crate::Line;

/// Colours and widths in px: of the held shape, of the others of its clip, and of other clips.
const HELD: ([f32; 3], f32) = ([1.0, 0.6, 0.1], 3.0);
const EDITED: ([f32; 3], f32) = ([0.25, 0.7, 1.0], 2.0);
const OTHERS: ([f32; 3], f32) = ([0.6, 0.6, 0.6], 1.5);

/// The most shapes beside the held one that are outlined; more lines than theirs would tell nobody anything.
const MOST: usize = 256;

/// The outlines of all shapes that clip what is shown, in a scene of this middle and radius. The held shape comes last, over
/// the others.
pub(super) fn lines(clips: &Clips, camera: &Camera, (centre, radius): (DVec3, f64)) -> Vec<Line> {
    let mut drawn = Vec::new();
    for cut in clips.in_force() {
        let is_edited = clips
            .edited()
            .is_some_and(|edited| std::ptr::eq(edited, cut));
        let shapes = cut.shapes().into_iter().enumerate();
        drawn.extend(shapes.map(|(number, shape)| match is_edited {
            true if number == cut.held() => (2, HELD, shape, cut.middle()),
            true => (1, EDITED, shape, centre),
            false => (0, OTHERS, shape, centre),
        }));
    }
    drawn.sort_by_key(|(importance, ..)| *importance);
    let least = drawn.len().saturating_sub(MOST + 1);
    let mut lines = Vec::new();
    for (_, (colour, width), shape, near) in drawn.drain(least..) {
        let outline = shape.outline(camera, near, radius);
        lines.extend(outline.into_iter().map(|ends| Line {
            ends,
            colour,
            width,
        }));
    }
    lines
}

#[cfg(test)]
mod tests;
