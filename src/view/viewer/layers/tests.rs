use super::super::action::Kind;
use super::*;
use rara::LayerState;

pub(in crate::viewer) fn layer(name: &str, visible: bool, clip: Option<&str>) -> LoadedLayer {
    let clip = clip.map(|text| LayerClip::parse(text).unwrap());
    LoadedLayer::new(name.into(), LayerState::default().visible(visible), clip)
}

fn clips(layers: &[LoadedLayer]) -> Clips {
    let frame = vec!["sphere:0,0,0,1".parse().unwrap()];
    Clips::new(
        ClipEditor::new(frame, ClipOp::And, DVec3::ZERO),
        layers,
        DVec3::ZERO,
    )
}

pub(in crate::viewer) fn camera() -> Camera {
    Camera::look_at(DVec3::NEG_Z, DVec3::ZERO, DVec3::NEG_Y, 50.0, (64, 64)).unwrap()
}

fn which(text: &str) -> Which {
    Which::Typed(text.into())
}

#[test]
fn layers_are_named_or_numbered() {
    let mut clips = clips(&[
        layer("skin", true, None),
        layer("a b", false, Some("plane:1,0,0,0")),
        layer("skin", true, None),
    ]);
    assert_eq!(clips.words().unwrap(), "sphere, without a b");
    clips.show(&which("2"), None).unwrap();
    clips.show(&which("skin"), Some(false)).unwrap();
    clips.edit(&Edit::Layer(which("a b"))).unwrap();
    assert_eq!(
        clips.words().unwrap(),
        "clip of a b: plane at 0.0000, without skin"
    );
    let own = |clips: &Clips| clips.layers()[1].clip(&[]);
    clips.act(GripAction::Flip, &camera(), 1.0);
    let flipped = LayerClip::parse("plane:-1,-0,-0,-0").unwrap();
    assert_eq!(own(&clips), Some(flipped));
    clips.edit(&Edit::Release).unwrap();
    assert_eq!(own(&clips), None);
    let error = clips.show(&which("3"), None).unwrap_err().to_string();
    assert!(error.contains("1 skin, 2 a b"), "{error}");
}

#[test]
fn opacities_and_tints_go_round() {
    let mut listed = layer("skin", true, None);
    listed.state = listed.state.opacity(0.4);
    let mut clips = clips(&[listed, layer("skin", true, None)]);
    assert_eq!(clips.layers().len(), 2, "they begin in two ways");
    let first = Which::Number(1);
    let mut said = |step| clips.fade(&first, step).unwrap();
    let keys = [(); 5].map(|()| said(Step::Next));
    let expected = [25, 10, 100, 50, 25].map(|percent| format!("skin: opacity {percent} %"));
    assert_eq!(keys, expected);
    assert_eq!(said(Step::To(0.7)), "skin: opacity 70 %");
    assert_eq!(clips.layers()[0].opacity, 0.7);
    assert_eq!(clips.layers()[1].opacity, 1.0);
    let second = Which::Number(2);
    let mut said = |step| {
        let (places, _, text) = clips.tint(&second, step).unwrap();
        assert_eq!(places, [1]);
        text
    };
    for name in TINTS.into_iter().chain(["none", TINTS[0]]) {
        assert_eq!(said(Step::Next), format!("skin: tint {name}"));
    }
    let own = "1,0,0.5:0.25".parse().unwrap();
    assert_eq!(said(Step::To(Some(own))), "skin: tint 1,0,0.5:0.25");
    assert_eq!(said(Step::Next), "skin: tint none");
    assert!(clips.fade(&Which::Number(3), Step::Next).is_err());
}

#[test]
fn keys_go_by_the_number_where_scripts_go_by_the_name_first() {
    let mut clips = clips(&[layer("0", true, None), layer("1", true, None)]);
    let hidden = |clips: &Clips| clips.words().unwrap();
    clips.show(&Which::Number(1), None).unwrap();
    assert_eq!(hidden(&clips), "sphere, without 0");
    clips.show(&which("1"), None).unwrap();
    assert_eq!(hidden(&clips), "sphere, without 0 and 1");
    clips.show(&which("2"), None).unwrap();
    assert_eq!(hidden(&clips), "sphere, without 0");
    for none in [Which::Number(0), Which::Number(3)] {
        let error = clips.show(&none, None).unwrap_err().to_string();
        assert!(error.contains("1 0, 2 1"), "{error}");
    }
}

#[test]
fn a_layer_gets_a_clip_of_its_own_when_one_is_asked_for() {
    let mut clips = clips(&[layer("skin", true, None), layer("bone", true, None)]);
    for words in ["clip of skin: as the frame", "clip of bone: as the frame"] {
        clips.edit(&Edit::Next).unwrap();
        clips.act(GripAction::Next, &camera(), 1.0);
        assert_eq!(clips.words().unwrap(), words);
    }
    assert_eq!(clips.in_force().count(), 1);
    clips.act(GripAction::Toggle, &camera(), 1.0);
    assert_eq!(clips.words().unwrap(), "clip of bone: plane at 0.0000");
    assert_eq!(clips.in_force().count(), 2);
    clips.act(GripAction::On(false), &camera(), 1.0);
    assert_eq!(clips.layers()[1].clip(&[]), Some(LayerClip::Whole));
    assert_eq!(clips.words().unwrap(), "clip of bone: whole");
    clips.edit(&Edit::Next).unwrap();
    assert_eq!(clips.words().unwrap(), "sphere");
}

#[test]
fn changes_of_clips_can_be_taken_back() {
    let mut clips = clips(&[layer("skin", true, None)]);
    let act = |clips: &mut Clips, action| clips.act(action, &camera(), 2.0);
    let text = |clips: &Clips| clips.frame.expressions()[0].to_string();
    act(&mut clips, GripAction::Become(Kind::Box));
    assert_eq!(text(&clips), "box:0,0,0,1,1,1");
    // Two steps of a drag are one change.
    for _ in 0..2 {
        act(&mut clips, GripAction::Scale(2.0));
    }
    assert_eq!(text(&clips), "box:0,0,0,4,4,4");
    clips.edit(&Edit::Next).unwrap();
    act(&mut clips, GripAction::Become(Kind::Sphere));
    let own = |clips: &Clips| clips.layers()[0].clip(&[]);
    let ball = LayerClip::parse("sphere:0,0,0,1").unwrap();
    assert_eq!(own(&clips), Some(ball.clone()));
    clips.edit(&Edit::Release).unwrap();
    assert_eq!(own(&clips), None);
    clips.undo();
    assert_eq!(own(&clips), Some(ball));
    clips.undo();
    assert_eq!(own(&clips), None);
    for expected in ["box:0,0,0,1,1,1", "sphere:0,0,0,1", "sphere:0,0,0,1"] {
        clips.undo();
        assert_eq!(text(&clips), expected);
    }
}
