use super::*;
use rara::ClipOp;
use rara::clip::Expression;

const CENTRE: DVec3 = DVec3::new(1.0, 2.0, 3.0);
const SHAPES: [&str; 8] = [
    "plane:0.6,0,0.8,-1",
    "slab:0,0.6,0.8,-3,0.75",
    "box:1,2,3,1,2,0.5,0.9,0.1,0.3,0.2",
    "sphere:1,0,3,1.5",
    "ellipsoid:1,2,2,1,2,0.5,0.5,0.5,0.1,0.2",
    "cylinder:0,1,2,1,3,4,0.75",
    "capsule:0,1,2,1,3,4,0.75",
    "cone:0,1,2,1,3,4,0.75",
];

/// A clip of which a shape is held that is alone, outside, or within an expression.
fn cuts(text: &str) -> [ClipEditor; 3] {
    let nested = format!("any(sphere:0,0,0,1, not(all({text}, plane:1,0,0,0)))");
    [text.into(), format!("!{text}"), nested].map(|typed| {
        let mut cut = ClipEditor::new(vec![typed.parse().unwrap()], ClipOp::And, CENTRE);
        if typed.starts_with("any") {
            cut.next();
        }
        cut
    })
}

fn plane(normal: DVec3) -> ClipEditor {
    let mut cut = ClipEditor::new(Vec::new(), ClipOp::And, CENTRE);
    cut.align(normal);
    cut
}

fn camera(from: DVec3) -> Camera {
    let eye = CENTRE + 5.0 * from;
    Camera::look_at(eye, CENTRE, DVec3::NEG_Y, 50.0, (800, 600)).unwrap()
}

fn cameras() -> [Camera; 2] {
    let camera = camera(DVec3::new(0.2, -0.1, -1.0).normalize());
    let flat = camera.projection(Projection::Orthographic);
    [camera, flat.fx(90.0).fy(90.0)]
}

fn pixel(camera: &Camera, point: DVec3) -> DVec2 {
    let p = camera.rotation * (point - camera.eye);
    let depth = match camera.projection {
        Projection::Orthographic => 1.0,
        _ => p.z,
    };
    DVec2::new(camera.fx, camera.fy) * p.truncate() / depth
}

/// The numbers of all its shapes. Quaternions of either sign are one rotation.
fn numbers(cut: &ClipEditor) -> Vec<f64> {
    let mut numbers = Vec::new();
    for shape in cut.expressions().iter().flat_map(Expression::shapes) {
        let text = shape.to_string();
        let list = text.split_once(':').unwrap().1.split(',');
        let mut list: Vec<f64> = list.map(|v| v.parse().unwrap()).collect();
        if list.len() == 6 {
            list.extend([1.0, 0.0, 0.0, 0.0]);
        }
        if list.len() == 10 && list[6] < 0.0 {
            list[6..].iter_mut().for_each(|v| *v = -*v);
        }
        numbers.extend(list);
    }
    numbers
}

fn apart(a: &ClipEditor, b: &ClipEditor) -> f64 {
    let (a, b) = (numbers(a), numbers(b));
    assert_eq!(a.len(), b.len());
    a.iter()
        .zip(&b)
        .fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()))
}

#[test]
fn every_shape_comes_back_from_where_it_was_moved_turned_and_scaled_to() {
    let degrees = DVec2::new(25.0, -40.0);
    let there_and_back: [[GripAction; 2]; 4] = [
        [GripAction::Go(0.7), GripAction::Go(-0.7)],
        [GripAction::Step(30.0), GripAction::Step(-30.0)],
        [GripAction::Tilt(degrees), GripAction::Tilt(-degrees)],
        [GripAction::Scale(1.7), GripAction::Scale(1.0 / 1.7)],
    ];
    for camera in cameras() {
        for text in SHAPES {
            for cut in cuts(text) {
                for [there, back] in there_and_back {
                    let mut moved = cut.clone();
                    moved.act(there, &camera, 2.0);
                    let is_flat = text.starts_with("plane");
                    let is_round = text.starts_with("sphere");
                    let stays = matches!(there, GripAction::Scale(_)) && is_flat
                        || matches!(there, GripAction::Tilt(_)) && is_round;
                    assert_eq!(apart(&moved, &cut) < 1e-12, stays, "{text}: {there:?}");
                    moved.act(back, &camera, 2.0);
                    let off = apart(&moved, &cut);
                    assert!(off < 1e-14 * 64.0, "{text}: {there:?} and back: {off}");
                }
            }
        }
    }
}

#[test]
fn a_dragged_shape_follows_the_mouse() {
    for camera in cameras() {
        for text in &SHAPES[2..] {
            for mut cut in cuts(text) {
                let before = pixel(&camera, cut.middle());
                let pixels = DVec2::new(31.0, -17.0);
                cut.drag(pixels, &camera);
                let by = pixel(&camera, cut.middle()) - before;
                assert!((by - pixels).length() < 1e-9, "{text}: {by}");
                cut.drag(-pixels, &camera);
                let by = pixel(&camera, cut.middle()) - before;
                assert!(by.length() < 1e-9, "{text}: {by}");
            }
        }
        // Planes and slabs go along their normals.
        for text in ["plane:1,0,0,-1", "slab:1,0,0,0,2"] {
            let [mut cut, ..] = cuts(text);
            let before = cut.middle();
            cut.drag(DVec2::new(2.0, 0.0), &camera);
            let along = pixel(&camera, cut.middle()) - pixel(&camera, before);
            assert!((along.x - 2.0).abs() < 0.1, "{text}: {along}");
            assert!((cut.middle() - before).reject_from(DVec3::X).length() < 1e-12);
        }
    }
}

#[test]
fn a_plane_that_faces_the_eye_goes_away_when_dragged_up() {
    for normal in [DVec3::Z, -DVec3::Z] {
        let camera = camera(-DVec3::Z);
        let mut cut = plane(normal);
        cut.drag(DVec2::new(40.0, -10.0), &camera);
        let depth = (camera.rotation * (cut.middle() - camera.eye)).z;
        assert!((depth - 5.0 - 50.0 / camera.fy).abs() < 1e-9, "{depth}");
    }
}

#[test]
fn a_shape_behind_the_eye_can_be_dragged_too() {
    for text in SHAPES {
        let mut camera = camera(-DVec3::Z);
        camera.eye += DVec3::Z * 20.0;
        let [mut cut, ..] = cuts(text);
        cut.drag(DVec2::new(5.0, 5.0), &camera);
        camera.eye = cut.middle();
        cut.drag(DVec2::new(5.0, 5.0), &camera);
        assert!(numbers(&cut).iter().all(|v| v.is_finite()), "{text}");
    }
}

#[test]
fn tilting_turns_about_the_middle() {
    let camera = camera(-DVec3::Z);
    let mut cut = plane(-DVec3::Z);
    cut.go(0.5, &camera);
    let middle = cut.middle();
    let towards = |cut: &ClipEditor| normal(cut.shape()).unwrap();
    cut.tilt(DVec2::new(30.0, 0.0), &camera);
    assert!(
        cut.shape().unwrap().clip().surfaces[0]
            .distance(middle)
            .abs()
            < 1e-12
    );
    // The normal pointed at the eye; now also to the right.
    let right = DVec3::new(0.5, 0.0, -0.75_f64.sqrt());
    assert!((towards(&cut) - right).length() < 1e-12);
    cut.tilt(DVec2::new(0.0, 30.0), &camera);
    assert!(towards(&cut).y > 0.1, "down: {}", towards(&cut));
    for text in &SHAPES[2..] {
        let [mut cut, ..] = cuts(text);
        let before = cut.middle();
        cut.tilt(DVec2::new(20.0, 50.0), &camera);
        assert!(cut.middle().distance(before) < 1e-12, "{text}");
    }
}

#[test]
fn shapes_align_with_axes() {
    for (text, aligned) in [
        ("box:1,2,3,1,2,0.5,0.9,0.1,0.3,0.2", "box:1,2,3,1,2,0.5"),
        ("cylinder:0,0,0,0,2,0,1", "cylinder:-1,1,0,1,1,0,1"),
        ("cone:0,0,0,0,0,2,1", "cone:-1,0,1,1,0,1,1"),
        ("plane:0,0,1,5", "plane:1,0,0,-1"),
        ("sphere:0,0,1,5", "sphere:0,0,1,5"),
    ] {
        let [mut cut, ..] = cuts(text);
        cut.align(DVec3::X);
        let [expected, ..] = cuts(aligned);
        assert!(apart(&cut, &expected) < 1e-12, "{text}: {:?}", cut.shape());
    }
}
