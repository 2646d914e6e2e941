use super::super::action::{Edit, GripAction};
use super::super::cut::ClipEditor;
use super::super::layers::Clips;
use super::super::layers::tests::{camera, layer};
use super::*;
use glam::DVec3;
use rara::ClipOp;

fn scenery(frame: &[&str], clips: &[Option<&str>]) -> Scenery {
    let mut scenery = Scenery::nothing(DVec3::NEG_Y).unwrap();
    let names = ["a", "b", "c"].into_iter().zip(clips);
    let layers: Vec<_> = names.map(|(name, clip)| layer(name, true, *clip)).collect();
    let frame = frame.iter().map(|text| text.parse().unwrap()).collect();
    let frame = ClipEditor::new(frame, ClipOp::And, DVec3::ZERO);
    scenery.clips = Clips::new(frame, &layers, DVec3::ZERO);
    scenery.scene.layers = layers;
    scenery
}

fn plan(scenery: &Scenery, slice: bool) -> Result<Option<FacePlan>, &'static str> {
    let manner = Manner {
        faces: FaceView {
            slice,
            edge: !slice,
            rim: false,
        },
        settings: Settings::default(),
        up: None,
        outlined: false,
        text: false,
    };
    FacePlan::new(scenery, &manner, &camera())
}

/// The visible layers, and how many surfaces the clip of each has.
fn shown(plan: &FacePlan) -> Vec<(usize, Option<usize>)> {
    let layers = plan.cut.layers.iter().enumerate();
    let visible = layers.filter(|(_, (state, _))| state.visible);
    let surfaces = |clip: &Clip| clip.all_surfaces().len();
    visible
        .map(|(at, (_, clip))| (at, clip.as_ref().map(surfaces)))
        .collect()
}

#[test]
fn marks_are_those_of_the_frame_and_slices_those_of_the_held_shape() {
    let mut scenery = scenery(
        &["plane:0,0,1,0", "sphere:0,0,0,1"],
        &[None, Some("slab:0,0,1,0,1"), None],
    );
    assert_eq!(plan(&scenery, false), Err(NO_MARKS), "there is a sphere");
    let frame = plan(&scenery, true).unwrap().unwrap();
    assert_eq!(shown(&frame), [(0, None), (1, Some(2)), (2, None)]);
    let [face] = &frame.cut.faces[..] else {
        panic!("one face: {frame:?}");
    };
    assert_eq!(face.plane.normal(), DVec3::Z);
    assert_eq!(face.rest.all_surfaces().len(), 1, "the sphere");
    // The clip of a layer bounds the slice of that layer alone.
    scenery
        .clips
        .edit(&Edit::Layer(super::super::Which::Number(2)))
        .unwrap();
    let own = plan(&scenery, true).unwrap().unwrap();
    assert_eq!(shown(&own), [(1, None)]);
    let [face] = &own.cut.faces[..] else {
        panic!("one face: {own:?}");
    };
    assert_eq!(face.rest.all_surfaces().len(), 1, "the other side");
    scenery.clips.act(GripAction::On(false), &camera(), 1.0);
    assert_eq!(plan(&scenery, true), Err(NO_SLICE), "it is off");
}

#[test]
fn a_clip_that_is_off_has_no_marks() {
    let mut scenery = scenery(&["box:0,0,5,1,1,1"], &[None]);
    let marked = plan(&scenery, false).unwrap().unwrap();
    assert_eq!(marked.cut.faces.len(), 1, "the camera is before the box");
    scenery.clips.act(GripAction::Toggle, &camera(), 1.0);
    assert_eq!(plan(&scenery, false), Err(NO_MARKS));
}

#[test]
fn what_is_before_covers_what_is_behind_by_its_alpha() {
    let mut behind = Picture::filled(2, 1, [0.0, 0.0, 0.5, 0.5]);
    let mut before = Picture::filled(2, 1, [0.0; 4]);
    before.pixels[1] = [0.5, 0.0, 0.0, 0.5];
    put_before(&mut behind, &before);
    assert_eq!(
        behind.pixels,
        [[0.0, 0.0, 0.5, 0.5], [0.5, 0.0, 0.25, 0.75]]
    );
}
