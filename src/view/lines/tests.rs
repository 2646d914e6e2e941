use super::*;

fn camera() -> Camera {
    // 100 px a unit of the slope.
    Camera::look_at(
        DVec3::ZERO,
        DVec3::Z,
        DVec3::NEG_Y,
        2.0 * 1.0_f64.atan().to_degrees(),
        (400, 200),
    )
    .unwrap()
}

fn seen(from: [f64; 3], to: [f64; 3], camera: &Camera) -> Option<[f32; 4]> {
    let line = Line {
        ends: [from, to].map(DVec3::from),
        colour: [1.0; 3],
        width: 2.0,
    };
    line.seen_by(camera).map(|line| line.ends)
}

fn close(a: [f32; 4], b: [f32; 4]) {
    for (a, b) in a.into_iter().zip(b) {
        assert!((a - b).abs() < 1e-3, "{a} is not {b}");
    }
}

#[test]
fn a_line_before_the_eye_is_seen_between_its_ends() {
    let line = seen([-1.0, 0.5, 2.0], [1.0, 0.0, 1.0], &camera());
    close(line.expect("it is seen"), [150.0, 125.0, 300.0, 100.0]);
}

#[test]
fn what_is_behind_the_eye_is_left_out_and_what_is_beside_the_picture_ends_there() {
    let camera = camera();
    assert_eq!(seen([0.0, 0.0, -1.0], [1.0, 0.0, -2.0], &camera), None);
    assert_eq!(seen([9.0, 0.0, 1.0], [9.0, 5.0, 1.0], &camera), None);
    // From straight ahead to the right and behind: it leaves the picture at its right edge, on its way.
    let line = seen([0.0, 0.0, 1.0], [1.0, 0.0, -1.0], &camera);
    close(line.expect("it is seen"), [200.0, 100.0, 404.0, 100.0]);
    // The other way round it is the same line.
    let line = seen([1.0, 0.0, -1.0], [0.0, 0.0, 1.0], &camera);
    close(line.expect("it is seen"), [404.0, 100.0, 200.0, 100.0]);
    // Through the eye itself, and with an end in it.
    assert!(seen([0.0, 0.0, -1.0], [0.0, 0.0, 1.0], &camera).is_some());
    assert!(seen([0.0, 0.0, 0.0], [0.5, 0.0, 1.0], &camera).is_some());
    for far in [1e300, f64::INFINITY, f64::NAN] {
        if let Some(line) = seen([far, 1.0, 2.0], [0.0, 0.0, 1.0], &camera) {
            assert!(line.iter().all(|v| v.is_finite()), "{far}: {line:?}");
        }
    }
}

#[test]
fn a_camera_without_perspective_sees_lines_wherever_they_are_along_its_axis() {
    let size = (400, 200);
    let camera = Camera::orthographic(DVec3::ZERO, DVec3::Z, DVec3::NEG_Y, 2.0, size).unwrap();
    let line = seen([-1.0, 0.5, -7.0], [1.0, 0.0, 70.0], &camera);
    close(line.expect("it is seen"), [100.0, 150.0, 300.0, 100.0]);
}
