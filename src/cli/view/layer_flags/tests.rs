use super::*;
use glam::DVec3;
use rara::scene::layers::LoadedLayer;
use rara::{Camera, ClipOp, LayerState};
use rara_view::viewer::{ClipEditor, Clips, Edit, GripAction, Step, Which};

fn layer(name: &str, visible: bool, clip: Option<&str>) -> LoadedLayer {
    let clip = clip.map(|text| LayerClip::parse(text).unwrap());
    LoadedLayer::new(name.into(), LayerState::default().visible(visible), clip)
}

fn camera() -> Camera {
    Camera::look_at(DVec3::NEG_Z, DVec3::ZERO, DVec3::NEG_Y, 50.0, (64, 64)).unwrap()
}

fn said(clips: &Clips) -> Vec<String> {
    flags(clips.layers(), clips.frame.section())
}

fn noted(clips: &Clips) -> Option<String> {
    note(clips.layers(), clips.frame.section())
}

fn clips(layers: &[LoadedLayer]) -> Clips {
    let frame = ClipEditor::new(Vec::new(), ClipOp::And, DVec3::ZERO);
    Clips::new(frame, layers, DVec3::ZERO)
}

/// The same layer as flags have left it: hidden, or with another clip.
fn flagged(mut layer: LoadedLayer, visible: bool, clip: Option<&str>) -> LoadedLayer {
    layer.state = layer.state.visible(visible);
    layer.clip = clip.map(|text| LayerClip::parse(text).unwrap());
    layer
}

#[test]
fn a_clip_is_said_where_it_is_another_than_the_listed_one() {
    for listed in [
        "!plane:1,0,0,0",
        "whole",
        "all(sphere:0,0,0,1, plane:1,0,0,0)",
    ] {
        let mut clips = clips(&[layer("skin", true, Some(listed))]);
        assert!(said(&clips).is_empty(), "{listed}");
        clips.edit(&Edit::Next).unwrap();
        clips.act(
            GripAction::Set("sphere:0,0,0,2".parse().unwrap()),
            &camera(),
            1.0,
        );
        let flags = said(&clips);
        assert!(
            flags[0].contains("sphere:0,0,0,2") && flags.len() == 1,
            "{flags:?}"
        );
        clips.edit(&Edit::Release).unwrap();
        assert_eq!(said(&clips), ["--layer-clip=skin=frame"]);
    }
    // What flags have made of a layer is said again.
    let typed = flagged(
        layer("skin", true, Some("whole")),
        false,
        Some("plane:1,0,0,0"),
    );
    assert_eq!(
        said(&clips(&[typed])),
        ["--hide=skin", "--layer-clip=skin=plane:1,0,0,0"]
    );
}

#[test]
fn layers_of_one_name_that_differ_are_left_as_they_are_listed() {
    let mut clips = clips(&[
        layer("part", true, Some("plane:1,0,0,0")),
        layer("part", false, Some("sphere:0,0,0,1")),
    ]);
    assert!(said(&clips).is_empty() && noted(&clips).is_none());
    clips.show(&Which::Number(2), Some(true)).unwrap();
    assert_eq!(said(&clips), ["--unhide=part"]);
    clips.show(&Which::Number(1), Some(false)).unwrap();
    assert!(said(&clips).is_empty());
    let note = noted(&clips).unwrap();
    assert!(note.contains("the layers called part,"), "{note}");
    clips.show(&Which::Number(2), Some(false)).unwrap();
    assert_eq!(said(&clips), ["--hide=part"]);
    assert!(noted(&clips).is_none());
    // One of the clips is changed, and then both are the same.
    clips.edit(&Edit::Next).unwrap();
    clips.act(GripAction::On(false), &camera(), 1.0);
    assert_eq!(said(&clips), ["--hide=part"]);
    assert!(noted(&clips).is_some());
    clips.edit(&Edit::Next).unwrap();
    clips.act(GripAction::On(false), &camera(), 1.0);
    assert_eq!(said(&clips), ["--hide=part", "--layer-clip=part=whole"]);
    assert!(noted(&clips).is_none());
}

#[test]
fn layers_that_flags_have_made_alike_are_said_as_they_are_listed() {
    // The list shows one and hides the other, and --unhide has brought that back.
    let shown = layer("part", true, None);
    let hidden = flagged(layer("part", false, None), true, None);
    let mut alike = clips(&[shown, hidden]);
    assert_eq!(said(&alike), ["--unhide=part"]);
    alike
        .show(&Which::Typed("part".into()), Some(false))
        .unwrap();
    assert_eq!(said(&alike), ["--hide=part"]);
    // The same of a clip that only the second is listed with.
    let plain = layer("part", true, None);
    let freed = flagged(layer("part", true, Some("whole")), true, None);
    assert_eq!(said(&clips(&[plain, freed])), ["--layer-clip=part=frame"]);
}

#[test]
fn flags_say_what_differs_from_the_list() {
    let mut clips = clips(&[
        layer("skin", true, None),
        layer("a b", false, Some("plane:1,0,0,0")),
        layer("skin", true, None),
    ]);
    assert!(said(&clips).is_empty(), "all are as they are listed");
    clips.show(&Which::Number(2), None).unwrap();
    clips.show(&Which::Number(1), Some(false)).unwrap();
    clips.edit(&Edit::Layer(Which::Number(2))).unwrap();
    clips.act(GripAction::Flip, &camera(), 1.0);
    assert_eq!(
        said(&clips),
        [
            "--hide=skin",
            "--unhide='a b'",
            "--layer-clip='a b=plane:-1,-0,-0,-0'"
        ]
    );
    clips.edit(&Edit::Release).unwrap();
    assert_eq!(said(&clips)[2], "--layer-clip='a b=frame'");
}

#[test]
fn an_opacity_is_said_where_it_is_another_than_the_listed_one() {
    let mut listed = layer("a b", true, None);
    listed.state = listed.state.opacity(0.25);
    listed.listed.opacity = 0.5;
    let mut clips = clips(&[listed, layer("skin", true, None)]);
    assert_eq!(said(&clips), ["--layer-opacity='a b=0.25'"]);
    let mut fade = |number, opacity| clips.fade(&Which::Number(number), Step::To(opacity));
    fade(1, 0.5).unwrap();
    fade(2, 0.1).unwrap();
    assert_eq!(said(&clips), ["--layer-opacity=skin=0.1"]);
}

#[test]
fn a_layer_without_a_clip_of_its_own_is_said_when_it_has_one() {
    let mut clips = clips(&[layer("bone", true, None)]);
    clips.edit(&Edit::Next).unwrap();
    clips.act(GripAction::Next, &camera(), 1.0);
    assert!(said(&clips).is_empty());
    clips.act(GripAction::Toggle, &camera(), 1.0);
    clips.act(GripAction::On(false), &camera(), 1.0);
    assert_eq!(said(&clips), ["--layer-clip=bone=whole"]);
}
