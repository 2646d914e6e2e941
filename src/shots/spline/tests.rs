use super::*;

fn cameras(eyes: &[(DVec3, DVec3)]) -> Vec<Camera> {
    let cameras = eyes.iter().enumerate().map(|(number, (eye, target))| {
        let fov_y = 40.0 + 5.0 * number as f64;
        Camera::look_at(*eye, *target, DVec3::NEG_Y, fov_y, (64, 48)).unwrap()
    });
    cameras.collect()
}

/// Places that are far apart, close together, and turned by nearly half a turn.
fn uneven() -> Vec<Camera> {
    let at = DVec3::new;
    cameras(&[
        (at(0.0, 0.0, -4.0), DVec3::ZERO),
        (at(3.0, -1.0, -3.0), DVec3::ZERO),
        (at(3.1, -1.0, -2.9), DVec3::ZERO),
        (at(9.0, 2.0, 5.0), at(9.0, 2.0, 50.0)),
        (at(-4.0, 0.5, 3.0), at(-4.0, 1.0, -50.0)),
    ])
}

fn difference(a: &Camera, b: &Camera) -> f64 {
    let turned = (a.rotation.transpose() - b.rotation.transpose()).to_cols_array();
    let turned = turned.iter().fold(0.0_f64, |most, one| most.max(one.abs()));
    turned
        .max(a.eye.distance(b.eye))
        .max((a.fx / b.fx - 1.0).abs())
}

#[test]
fn the_way_passes_every_camera_and_begins_and_ends_with_one() {
    for closed in [false, true] {
        let keys = uneven();
        let spline = Spline::through(&keys, closed).unwrap();
        let whole = spline.ways[spline.ways.len() - 1];
        for (number, key) in keys.iter().enumerate() {
            let passed = spline.camera_at(spline.ways[number * STEPS] / whole);
            assert!(difference(&passed, key) < 1e-12, "{number}");
        }
        let made = spline.cameras(9);
        assert!(difference(&made[0], &keys[0]) < 1e-15);
        if !closed {
            assert!(difference(&made[8], &keys[4]) < 1e-15);
        }
    }
}

#[test]
fn the_pace_is_even_and_nothing_jumps() {
    for closed in [false, true] {
        let spline = Spline::through(&uneven(), closed).unwrap();
        let made = spline.cameras(2000);
        let apart: Vec<(f64, f64)> = made
            .windows(2)
            .map(|two| Key::from_camera(&two[0]).apart(&Key::from_camera(&two[1])))
            .collect();
        let whole = apart
            .iter()
            .fold((0.0, 0.0), |whole, one| (whole.0 + one.0, whole.1 + one.1));
        // The chords' share of the whole, by which the spline weighs, is near that of the curves.
        let paces: Vec<f64> = apart
            .iter()
            .map(|one| (one.0 / whole.0).hypot(one.1 / whole.1) * 2000.0)
            .collect();
        let (least, most) = paces.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), one| {
            (a.min(*one), b.max(*one))
        });
        assert!(least > 0.6 && most < 1.8, "{least} to {most}");
        for two in paces.windows(2) {
            assert!((two[0] - two[1]).abs() < 0.2, "{two:?}");
        }
    }
}

#[test]
fn cameras_on_a_circle_stay_near_it() {
    let eyes: Vec<_> = (0..8)
        .map(|number| {
            let turn = f64::from(number) / 8.0 * std::f64::consts::TAU;
            (DVec3::new(turn.sin(), 0.0, -turn.cos()) * 4.0, DVec3::ZERO)
        })
        .collect();
    let spline = Spline::through(&cameras(&eyes), true).unwrap();
    for camera in spline.cameras(100) {
        assert!((camera.eye.length() - 4.0).abs() < 0.04, "{}", camera.eye);
        let looks = camera.rotation * -camera.eye / camera.eye.length();
        assert!(looks.z > 0.9999, "{looks}");
    }
}

#[test]
fn cameras_that_make_no_way_are_refused() {
    let one = &uneven()[..1];
    let twice = [one[0], one[0]];
    for none in [&[][..], one, &twice] {
        assert!(Spline::through(none, false).is_err());
        assert!(Spline::through(none, true).is_err());
    }
    let mut sizes = uneven();
    sizes[1].width = 65;
    let refused = Spline::through(&sizes, false).unwrap_err().to_string();
    assert!(refused.contains("several sizes"), "{refused}");
    // A camera that stands twice is passed once.
    let mut still = uneven();
    still.insert(1, still[0]);
    assert_eq!(Spline::through(&still, true).unwrap().keys.len(), 5);
}
