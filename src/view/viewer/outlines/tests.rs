use super::*;
use crate::viewer::action::{Edit, Which};
use crate::viewer::cut::ClipEditor;
use crate::viewer::layers::tests::layer;
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
