use super::*;
use glam::DVec3;

fn clip(shapes: &[&str], clip_op: ClipOp) -> Result<Clip, Failure> {
    let clip = shapes.iter().map(|s| Region::shape(s).unwrap()).collect();
    let clip_file = Vec::new();
    let args = ClipArgs {
        clip,
        clip_expr: Vec::new(),
        clip_file,
        save_clip: None,
        clip_op,
    };
    Ok(args.meant()?.clip(&Scene::default())?)
}

fn keeps(clip: &Clip, x: f64, y: f64, z: f64) -> bool {
    clip.keeps(DVec3::new(x, y, z))
}

#[test]
fn planes_flip() {
    let half = clip(&["plane:2,0,0,-1"], ClipOp::And).unwrap();
    assert!(keeps(&half, 0.6, 0.0, 0.0) && !keeps(&half, 0.4, 0.0, 0.0));
    let other = clip(&["!plane:2,0,0,-1"], ClipOp::And).unwrap();
    assert!(!keeps(&other, 0.6, 0.0, 0.0) && keeps(&other, 0.4, 0.0, 0.0));
}

#[test]
fn boxes_keep_inside_or_outside_whatever_the_operation_says_when_alone() {
    for op in [ClipOp::And, ClipOp::Or] {
        let inside = clip(&["box:1,2,3,0.5,1,2"], op).unwrap();
        let outside = clip(&["!box:1,2,3,0.5,1,2"], op).unwrap();
        for (point, within) in [
            ([1.4, 2.9, 4.9], true),
            ([0.6, 1.1, 1.1], true),
            ([1.6, 2.0, 3.0], false),
            ([1.0, 0.9, 3.0], false),
            ([1.0, 2.0, 5.1], false),
        ] {
            let [x, y, z] = point;
            assert_eq!(keeps(&inside, x, y, z), within, "{point:?}");
            assert_eq!(keeps(&outside, x, y, z), !within, "{point:?}");
        }
    }
}

#[test]
fn a_box_turns_with_its_quaternion() {
    // A quarter turn about z, not normalised: the long side comes to lie along y.
    let turned = clip(&["box:0,0,0,3,1,1,5,0,0,5"], ClipOp::And).unwrap();
    assert!(keeps(&turned, 0.0, 2.9, 0.0) && !keeps(&turned, 2.0, 0.0, 0.0));
}

#[test]
fn shapes_of_any_kind_combine() {
    let flat = clip(&["box:0,0,0,1,1,1", "plane:1,0,0,0"], ClipOp::And).unwrap();
    assert!(flat.is_flat() && flat.surfaces.len() == 7);
    let bitten = clip(&["!box:0,0,0,1,1,1", "plane:1,0,0,0"], ClipOp::And).unwrap();
    assert!(keeps(&bitten, 1.5, 0.0, 0.0) && !keeps(&bitten, 0.5, 0.0, 0.0));
    let both = clip(&["box:0,0,0,1,1,1", "sphere:3,0,0,1"], ClipOp::Or).unwrap();
    assert!(keeps(&both, 0.5, 0.0, 0.0) && keeps(&both, 3.5, 0.0, 0.0));
    assert!(!keeps(&both, 1.5, 0.0, 0.0));
}

#[test]
fn nonsense_is_refused() {
    for text in [
        "plane",
        "plane:1,2,3",
        "plane:0,0,0,1",
        "plane:nan,0,0,1",
        "plane:1,0,0,inf",
        "box:0,0,0,1,1",
        "box:0,0,0,1,0,1",
        "box:0,0,0,1,1,1,0,0,0,0",
        "sphere:0,0,0,0",
        "cylinder:0,0,0,0,0,0,1",
        "cone:1",
        "",
    ] {
        assert!(Region::shape(text).is_err(), "{text}");
    }
}
