use super::*;

const SIZE: (u32, u32) = (800, 600);

/// A viewpoint four units before the origin, level.
fn start() -> Viewpoint {
    let eye = DVec3::new(0.0, 0.0, -4.0);
    let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::NEG_Y, 50.0, SIZE).unwrap();
    Viewpoint::new(&camera, DVec3::NEG_Y, DVec3::new(0.3, 0.1, 0.0), 1.0)
}

fn pixel(view: &Viewpoint, point: DVec3) -> DVec2 {
    let c = view.camera(SIZE);
    let p = c.rotation * (point - c.eye);
    DVec2::new(c.fx * p.x / p.z + c.cx, c.fy * p.y / p.z + c.cy)
}

#[test]
fn the_first_camera_is_the_one_given() {
    let eye = DVec3::new(0.0, 1.0, -4.0);
    let given = Camera::look_at(eye, DVec3::ZERO, DVec3::NEG_Y, 50.0, SIZE).unwrap();
    let view = Viewpoint::new(&given, DVec3::NEG_Y, DVec3::ZERO, 1.0);
    assert_eq!(view.camera(SIZE), given);
}

#[test]
fn orbiting_keeps_the_pivot_in_the_middle_and_takes_what_is_in_front_along() {
    let mut view = start();
    let near = DVec3::new(0.0, 0.0, -1.0);
    let before = pixel(&view, near);
    view.turn(DVec2::new(10.0, 0.0));
    assert!(pixel(&view, near).x > before.x + 10.0);
    view.turn(DVec2::new(0.0, 10.0));
    assert!(pixel(&view, near).y > before.y + 10.0);
    assert!((view.camera(SIZE).eye.length() - 4.0).abs() < 1e-12);
    assert!((pixel(&view, DVec3::ZERO) - DVec2::new(400.0, 300.0)).length() < 1e-9);
}

#[test]
fn looking_about_keeps_the_eye_and_takes_what_is_in_front_along() {
    let mut view = start();
    view.walk = Walk::Fly;
    let before = pixel(&view, DVec3::ZERO);
    view.turn(DVec2::new(5.0, 5.0));
    let after = pixel(&view, DVec3::ZERO);
    assert!(
        after.x > before.x + 10.0 && after.y > before.y + 10.0,
        "{after}"
    );
    assert_eq!(view.camera(SIZE).eye, DVec3::new(0.0, 0.0, -4.0));
}

#[test]
fn no_turn_goes_over_a_pole_or_rolls_the_view() {
    for walk in [Walk::Orbit, Walk::Fly] {
        for direction in [1.0, -1.0] {
            let mut view = start();
            view.walk = walk;
            for _ in 0..1000 {
                view.turn(DVec2::new(3.7, direction * 2.9));
            }
            let axes = view.camera(SIZE).rotation.transpose();
            assert!(axes.x_axis.y.abs() < 1e-9, "rolled: {axes}");
            assert!(axes.y_axis.y > 0.0, "upside down: {axes}");
            let product = axes.transpose() * axes;
            assert!(
                (product - DMat3::IDENTITY)
                    .to_cols_array()
                    .iter()
                    .all(|e| e.abs() < 1e-12)
            );
        }
    }
}

#[test]
fn what_is_made_up_is_up_in_the_picture_and_in_the_view_at_the_start() {
    for up in [DVec3::X, DVec3::Y, DVec3::new(1.0, -2.0, 0.5)] {
        let mut view = start();
        view.turn(DVec2::new(20.0, 30.0));
        let before = view.camera(SIZE);
        view.set_up(up);
        let after = view.camera(SIZE);
        assert_eq!(after.eye, before.eye);
        assert!((after.rotation.row(2) - before.rotation.row(2)).length() < 1e-12);
        view.turn(DVec2::new(-50.0, 10.0));
        view.turn(DVec2::new(7.0, -3.0));
        for _ in 0..2 {
            let rows = view.camera(SIZE).rotation;
            assert!(rows.row(0).dot(up).abs() < 1e-9, "{up} rolls");
            assert!(rows.row(1).dot(up) < 0.0, "{up} is down");
            view.reset();
        }
        assert!(view.has_up(up.normalize()) && !view.has_up(-up.normalize()));
    }
    // Who looks along it sees it neither up nor down, and can still turn.
    let mut view = start();
    let before = view.camera(SIZE);
    view.set_up(DVec3::Z);
    assert_eq!(view.camera(SIZE), before);
    view.turn(DVec2::new(10.0, 40.0));
    let rows = view.camera(SIZE).rotation;
    assert!(rows.is_finite() && rows.row(0).dot(DVec3::Z).abs() < 1e-9);
}

#[test]
fn what_is_dragged_sideways_follows_the_mouse() {
    let mut view = start();
    let by = DVec2::new(30.0, -17.0);
    let before = pixel(&view, DVec3::ZERO);
    view.shift(by, SIZE.1);
    assert!((pixel(&view, DVec3::ZERO) - before - by).length() < 1e-9);
}

#[test]
fn zooming_there_and_back_is_no_change_and_never_passes_the_pivot() {
    let mut view = start();
    view.zoom(5.0);
    assert!(view.camera(SIZE).eye.z > -4.0);
    view.zoom(-5.0);
    assert!((view.camera(SIZE).eye.z + 4.0).abs() < 1e-12);
    view.zoom(1e4);
    assert!(view.camera(SIZE).eye.z < 0.0);
    view.reset();
    assert_eq!(view.camera(SIZE).eye.z, -4.0);
}

#[test]
fn an_orthographic_view_shows_the_pivot_at_the_scale_of_perspective_and_zooms() {
    let mut view = start();
    let aside = DVec3::new(0.5, -0.2, 0.0);
    let before = pixel(&view, aside);
    view.other_projection();
    let flat = |view: &Viewpoint, point: DVec3| {
        let c = view.camera(SIZE);
        let p = c.rotation * (point - c.eye);
        assert!(p.z > 0.2 && c.projection == Projection::Orthographic);
        DVec2::new(c.fx * p.x + c.cx, c.fy * p.y + c.cy)
    };
    assert!(flat(&view, aside).distance(before) < 1e-9);
    assert!(flat(&view, aside + DVec3::Z).distance(before) < 1e-9);
    let again = Viewpoint::new(&view.camera(SIZE), DVec3::NEG_Y, view.scene.0, view.scene.1);
    assert!(flat(&again, aside).distance(before) < 1e-9);
    view.zoom(20.0);
    let middle = DVec2::new(400.0, 300.0);
    let nearer = (flat(&view, aside) - middle).length() / (before - middle).length();
    assert!((nearer - 0.9_f64.powi(-20)).abs() < 1e-9, "{nearer}");
    view.reset();
    assert_eq!(view.camera(SIZE).projection, Projection::Perspective);
}

#[test]
fn flying_goes_along_the_view() {
    let mut view = start();
    view.go(DVec3::new(1.0, 2.0, 3.0));
    assert_eq!(view.camera(SIZE).eye, DVec3::new(1.0, 2.0, -1.0));
}

#[test]
fn an_eye_beyond_all_numbers_stays_where_it_was() {
    for walk in [Walk::Orbit, Walk::Fly] {
        let mut view = start();
        view.walk = walk;
        let before = view.camera(SIZE);
        for _ in 0..3 {
            view.go(DVec3::new(1e308, 0.0, 0.0));
            view.go(DVec3::new(0.0, -1e30, 1e30));
            view.go(DVec3::splat(f64::NAN));
            view.shift(DVec2::new(-1e308, 0.0), SIZE.1);
            view.shift(DVec2::new(0.0, f64::INFINITY), SIZE.1);
        }
        assert_eq!(view.camera(SIZE), before);
        for _ in 0..3 {
            view.go(DVec3::Z * 9e17);
            view.turn(DVec2::splat(1e308));
            view.zoom(-1e308);
        }
        let camera = view.camera(SIZE);
        assert!(camera.eye.abs().max_element() <= FARTHEST, "{camera:?}");
        assert!(camera.world_to_camera().is_finite(), "{camera:?}");
    }
}

#[test]
fn a_wider_window_shows_more_at_the_sides_and_as_much_in_height() {
    let view = start();
    let (narrow, wide) = (view.camera(SIZE), view.camera((1600, 600)));
    assert_eq!((narrow.fy, narrow.fx), (wide.fy, wide.fx));
    assert_eq!((wide.cx, wide.cy), (800.0, 300.0));
    assert_eq!(view.camera((400, 300)).fy, narrow.fy / 2.0);
}
