use super::*;

fn parsed(text: &str) -> Action {
    text.parse()
        .unwrap_or_else(|error| panic!("{text}: {error}"))
}

#[test]
fn what_is_written_is_what_is_done() {
    assert_eq!(parsed("plane +0.1"), Action::Held(GripAction::Go(0.1)));
    assert_eq!(parsed("plane -2e-3"), Action::Held(GripAction::Go(-2e-3)));
    assert_eq!(parsed("plane  off "), Action::Held(GripAction::On(false)));
    assert_eq!(
        parsed("plane -1,0,0,2"),
        Action::Held(GripAction::Set(Plane::new(-DVec3::X, 2.0).unwrap().into()))
    );
    assert_eq!(
        parsed("tilt -5,2.5"),
        Action::Held(GripAction::Tilt(DVec2::new(-5.0, 2.5)))
    );
    assert_eq!(
        parsed("shape !sphere:0,0,0,1"),
        Action::Held(GripAction::Set("!sphere:0,0,0,1".parse().unwrap()))
    );
    assert_eq!(parsed("scale 1.5"), Action::Held(GripAction::Scale(1.5)));
    let which = |text: &str| Which::Typed(text.into());
    assert_eq!(parsed("layer 2"), Action::Layer(which("2"), None));
    assert_eq!(
        parsed("layer left lung off"),
        Action::Layer(which("left lung"), Some(false))
    );
    assert_eq!(
        parsed("layer left lung 40%"),
        Action::LayerOpacity(which("left lung"), Step::To(0.4))
    );
    let tint = |tint| Action::LayerTint(which("left lung"), Step::To(tint));
    let gold = "gold:30%".parse().unwrap();
    assert_eq!(parsed("layer left lung tint gold:30%"), tint(Some(gold)));
    assert_eq!(parsed("layer left lung tint none"), tint(None));
    assert_eq!(parsed("edit next"), Action::Edit(Edit::Next));
    assert_eq!(
        parsed("edit skin"),
        Action::Edit(Edit::Layer(which("skin")))
    );
    assert_eq!(parsed("outline off"), Action::Outline(Some(false)));
    assert_eq!(parsed("slice on"), Action::Slice(Some(true)));
    assert_eq!(parsed("edge off"), Action::Edge(Some(false)));
    assert_eq!(parsed("rim on"), Action::Rim(Some(true)));
    assert_eq!(parsed("keys on"), Action::Keys(Some(true)));
    assert_eq!(parsed("numbers off"), Action::Numbers(Some(false)));
    assert_eq!(parsed("drop a b.ply"), Action::Drop("a b.ply".into()));
    assert_eq!(parsed("mode hard"), Action::Mode(Mode::Hard));
    assert_eq!(parsed("up -z"), Action::Up(DVec3::NEG_Z));
    assert_eq!(parsed("up 0,1,2"), Action::Up(DVec3::new(0.0, 1.0, 2.0)));
    assert_eq!(parsed("camera fly"), Action::Walk(Walk::Fly));
    assert_eq!(
        parsed("move 1,0,-2"),
        Action::Go(DVec3::new(1.0, 0.0, -2.0))
    );
    assert_eq!(parsed("screenshot"), Action::Screenshot(None));
    assert_eq!(
        parsed("screenshot a b.png"),
        Action::Screenshot(Some("a b.png".into()))
    );
    assert_eq!(parsed("resize 640x480"), Action::Resize((640, 480)));
    assert_eq!(parsed("\tquit"), Action::Quit);
}

#[test]
fn what_means_nothing_is_refused_with_what_would() {
    for (text, says) in [
        ("jump", "there are turn"),
        ("plane 0.1", "a step like +0.1"),
        ("plane up", "on, off"),
        ("plane 0,0,0,1", "non-zero normal"),
        ("plane +", "'+' is not a finite number"),
        ("shape up", "sphere:0,0,0,1"),
        ("shape torus:1", "not a shape"),
        ("up", "-z or X,Y,Z"),
        ("up 0,0,0", "cannot be zero"),
        ("scale 0", "above zero"),
        ("scale -2", "above zero"),
        ("layer", "number from 1"),
        ("layer  off", "number from 1"),
        (
            "layer skin 101%",
            "layer skin 101%: expected a number from 0",
        ),
        ("layer skin tint rouge", "no colour 'rouge'"),
        ("edit", "next, frame"),
        ("outline", "on or off"),
        ("slice", "slice : on or off"),
        ("keys 1", "keys 1: on or off"),
        ("drop", "takes a file"),
        ("turn 5", "expected 2 numbers"),
        ("mode soft", "none, hard"),
        ("resize 640", "like 1024x768"),
        ("quit now", "takes nothing"),
        ("", "is not an action"),
    ] {
        let error = text.parse::<Action>().expect_err(text);
        assert!(error.contains(says), "{text}: {error}");
    }
}

#[test]
fn only_moves_follow_each_other_without_waiting() {
    assert!(parsed("turn 1,1").moves() && parsed("plane +1").moves());
    assert!(!parsed("screenshot").moves() && !parsed("timings").moves());
}
