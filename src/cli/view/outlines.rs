//! The lines over the window's picture: the outlines of what clips it.

use glam::DVec3;
use rara::{Camera, Line};

use super::layers::Clips;

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
        let outline = shape.outline(camera, near, radius).into_iter();
        lines.extend(outline.map(|ends| Line {
            ends,
            colour,
            width,
        }));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::action::{Edit, Which};
    use crate::view::cut::ClipEditor;
    use crate::view::layers::tests::layer;
    use rara::ClipOp;

    fn clips(frame: &[&str]) -> Clips {
        let frame = frame.iter().map(|text| text.parse().unwrap()).collect();
        let layers = [
            layer("skin", true, None),
            layer("bone", true, Some("box:0,0,0,1,1,1")),
        ];
        Clips::new(
            ClipEditor::new(frame, ClipOp::Or, DVec3::ZERO),
            &layers,
            DVec3::ZERO,
        )
    }

    fn widths(clips: &Clips) -> Vec<(f32, usize)> {
        let eye = DVec3::new(1.0, 2.0, -5.0);
        let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::NEG_Y, 50.0, (64, 64)).unwrap();
        let lines = lines(clips, &camera, (DVec3::ZERO, 1.0));
        let runs = lines.chunk_by(|a, b| a.width == b.width);
        runs.map(|run| (run[0].width, run.len())).collect()
    }

    #[test]
    fn the_held_shape_is_drawn_over_the_others_of_its_clip_and_those_over_other_clips() {
        let mut clips = clips(&["box:0,0,0,1,1,1", "slab:1,0,0,0,1"]);
        assert_eq!(widths(&clips), [(1.5, 12), (2.0, 8), (3.0, 12)]);
        let bone = Which::Typed("bone".into());
        clips.edit(&Edit::Layer(bone.clone())).unwrap();
        assert_eq!(widths(&clips), [(1.5, 20), (3.0, 12)]);
        clips.show(&bone, Some(false)).unwrap();
        assert_eq!(widths(&clips), [(1.5, 20)]);
        clips.frame.on = false;
        assert_eq!(widths(&clips), []);
    }

    #[test]
    fn of_very_many_shapes_the_held_one_and_some_others_are_outlined() {
        let clips = clips(&vec!["box:0,0,0,1,1,1"; 1000]);
        let lines: usize = widths(&clips).iter().map(|(_, count)| count).sum();
        assert_eq!(lines, 12 * (MOST + 1));
        assert_eq!(widths(&clips).last(), Some(&(3.0, 12)));
    }
}
