use super::*;

const CENTRE: DVec3 = DVec3::new(1.0, 2.0, 3.0);

fn cut(typed: &[&str]) -> ClipEditor {
    let typed = typed.iter().map(|text| text.parse().unwrap());
    ClipEditor::new(typed.collect(), ClipOp::And, CENTRE)
}

#[test]
fn without_a_clip_nothing_is_cut_until_a_shape_is_set() {
    let mut cut = cut(&[]);
    assert_eq!(cut.clip(), Clip::default());
    cut.set("sphere:0,0,0,1".parse().unwrap());
    assert_eq!(
        cut.clip(),
        "sphere:0,0,0,1".parse::<Shape>().unwrap().clip()
    );
    cut.on = false;
    assert!(cut.clip().is_everything() && cut.expressions().is_empty());
}

#[test]
fn shapes_are_held_in_turn_wherever_they_stand() {
    let mut cut = cut(&[
        "all(sphere:0,0,0,1, not(any(box:0,0,0,1,1,1, !plane:1,0,0,2)))",
        "plane:0,1,0,0",
    ]);
    let mut held = Vec::new();
    for _ in 0..4 {
        held.push(cut.words());
        cut.flip();
        cut.next();
    }
    assert_eq!(
        held,
        [
            "plane 1 of 4 at 0.0000",
            "sphere 2 of 4",
            "box 3 of 4",
            "plane 4 of 4 at 2.0000"
        ]
    );
    let text: Vec<String> = cut.expressions().iter().map(ToString::to_string).collect();
    assert_eq!(
        text,
        [
            "plane:-0,-1,-0,-0",
            "all(!sphere:0,0,0,1, not(any(!box:0,0,0,1,1,1, plane:1,0,0,2)))"
        ]
    );
    assert_eq!(cut.held(), 0);
}

#[test]
fn the_outside_of_a_plane_is_flipped_at_once() {
    let mut cut = cut(&[]);
    cut.set("!plane:1,0,0,0".parse().unwrap());
    assert_eq!(cut.shape(), Some(&"plane:-1,0,0,0".parse().unwrap()));
    assert_eq!(cut.words(), "plane at 0.0000");
    cut.flip();
    assert_eq!(cut.shape(), Some(&"plane:1,0,0,0".parse().unwrap()));
}

#[test]
fn a_prism_is_held_as_shapes_are() {
    let mut cut = cut(&["polygon:z=0..2;0,0;2,0;2,1"]);
    assert_eq!((cut.words(), cut.on), ("polygon".into(), true));
    let shown = |cut: &ClipEditor| cut.expressions()[0].to_string();
    cut.flip();
    assert_eq!(shown(&cut), "not(polygon:z=0..2;0,0;2,0;2,1)");
    assert_eq!(cut.middle(), DVec3::new(1.0, 0.5, 1.0));
    cut.place(&Placement::new(DVec3::ONE, glam::DQuat::IDENTITY, 2.0).unwrap());
    assert_eq!(shown(&cut), "not(polygon:z=1..5;1,1;5,1;5,3)");
    assert_eq!(cut.middle(), DVec3::new(3.0, 2.0, 3.0));
    cut.flip();
    assert_eq!(shown(&cut), "polygon:z=1..5;1,1;5,1;5,3");
    cut.next();
    assert_eq!(cut.held(), 0);
}

#[test]
fn a_clip_that_keeps_everything_holds_no_shape_until_one_is_set() {
    let mut cut = ClipEditor::new(vec![Expression::All(Vec::new())], ClipOp::And, CENTRE);
    assert_eq!((cut.shape(), cut.words()), (None, "whole".into()));
    cut.next();
    cut.flip();
    assert_eq!(cut.middle(), CENTRE);
    cut.set("sphere:0,0,0,1".parse().unwrap());
    assert_eq!(cut.words(), "sphere");
}

#[test]
fn an_outline_keeps_of_what_is_kept_what_it_holds() {
    let camera = Camera::look_at(-DVec3::Z, DVec3::ZERO, -DVec3::Y, 90.0, (100, 100)).unwrap();
    let lasso = |text: &str| text.parse().unwrap();
    let right = DVec3::new(0.4, 0.0, 0.5);
    let (mut cut, mut rest) = (cut(&[]), cut(&["sphere:0,0,0,1", "plane:0,1,0,0"]));
    cut.lasso(&camera, &lasso("50,0;100,0;100,100;50,100"))
        .unwrap();
    assert!(cut.clip().keeps(right) && !cut.clip().keeps(-right) && cut.held() == 0);
    rest.op = ClipOp::Or;
    rest.lasso(&camera, &lasso("!50,0;100,0;100,100;50,100"))
        .unwrap();
    assert_eq!(
        (rest.op(), rest.expressions().len(), rest.held()),
        (ClipOp::And, 2, 2)
    );
    let left = right * DVec3::new(-1.0, 1.0, 1.0);
    assert!(rest.clip().keeps(left) && !rest.clip().keeps(right));
}

#[test]
fn a_shape_that_would_overflow_stays_where_it_was() {
    let mut cut = cut(&["box:1e300,0,0,1,1,1"]);
    let huge = Placement::new(DVec3::ZERO, glam::DQuat::IDENTITY, 1e300).unwrap();
    let before = cut.clip();
    cut.place(&huge);
    assert_eq!(cut.clip(), before);
}

#[test]
fn the_held_shape_stands_apart_where_all_must_keep_a_point() {
    let mut two = cut(&["any(sphere:0,0,0,1)", "plane:0,1,0,0"]);
    let (shape, others) = two.held_apart().expect("a plane");
    assert_eq!((shape.solid().name(), others.len()), ("plane", 1));
    two.next();
    assert!(two.held_apart().is_none(), "it is within an expression");
    let typed = ["plane:0,1,0,0", "plane:1,0,0,0"].map(|text| text.parse().unwrap());
    let either = ClipEditor::new(typed.to_vec(), ClipOp::Or, CENTRE);
    assert!(either.held_apart().is_none());
    let one = ClipEditor::new(typed[..1].to_vec(), ClipOp::Or, CENTRE);
    assert!(one.held_apart().is_some());
    let mut off = cut(&["plane:0,1,0,0"]);
    off.on = false;
    assert!(off.held_apart().is_none());
}

#[test]
fn a_held_section_leaves_the_other_layers_alone() {
    let [plane, sphere] = ["plane:0,1,0,0", "sphere:0,0,0,1"].map(|text| text.parse().unwrap());
    let mut cut = ClipEditor::of_section(vec![plane], vec![sphere], CENTRE);
    assert!(cut.section_beside_held().is_empty());
    cut.next();
    assert_eq!(cut.section_beside_held().len(), 1);
}
