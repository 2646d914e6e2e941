//! What is framed, by scenes whose every Gaussian is known.

use glam::{DQuat, DVec2, DVec3, Quat, Vec3};
use rara::scene::{self, Kind};
use rara::{Camera, Gaussians, Layer, LayerState, Placement, Plane, Projection, Scene};

use super::*;

fn camera<'a>(framed: Framing, scene: impl Into<Scene<'a>>) -> Camera {
    let visible = Visible::of(&scene.into());
    framed.camera(&visible).expect("a camera")
}

fn perspective<'a>(scene: impl Into<Scene<'a>>) -> Camera {
    camera(Framing::new(Lens::Perspective(50.0), (640, 480)), scene)
}

/// Where a picture's edges are relative to its middle, of these Gaussians out to where they are drawn: how much of its halves
/// they fill at the left and the top, and at the right and the bottom. All of them are behind the near plane.
fn filled(camera: &Camera, gaussians: &Gaussians) -> (DVec2, DVec2) {
    filled_by(camera, gaussians, gaussians.len())
}

/// The same of so many of them.
fn filled_by(camera: &Camera, gaussians: &Gaussians, count: usize) -> (DVec2, DVec2) {
    let half = DVec2::new(camera.cx / camera.fx, camera.cy / camera.fy);
    let (mut least, mut most) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for index in 0..count {
        let opacity = f64::from(gaussians.opacities()[index]);
        let sigmas = (2.0 * (255.0 * opacity).max(1.0).ln()).sqrt();
        let turn =
            camera.rotation * glam::DMat3::from_quat(gaussians.rotations()[index].as_dquat());
        let axes = turn * glam::DMat3::from_diagonal(gaussians.scales()[index].as_dvec3());
        let reach = |direction: DVec3| sigmas * (axes.transpose() * direction).length();
        let at = camera.rotation * (gaussians.positions()[index].as_dvec3() - camera.eye);
        assert!(at.z > 0.2, "{at}");
        // The planes through the eye that touch the ellipsoid.
        let edge = |axis: DVec3, side: f64| match camera.projection {
            Projection::Orthographic => axis.dot(at) + side * reach(axis),
            _ => (0..40).fold(0.0, |slope, _| {
                (axis.dot(at) + side * reach(axis - slope * DVec3::Z)) / at.z
            }),
        };
        let edges = |side: f64| DVec2::new(edge(DVec3::X, side), edge(DVec3::Y, side)) / half;
        least = least.min(edges(-1.0));
        most = most.max(edges(1.0));
    }
    (least, most)
}

/// A ball of small opaque Gaussians of radius 1 about a point.
fn ball(at: Vec3, count: usize) -> Gaussians {
    let mut ball = Gaussians::default();
    for index in 0..count {
        // Fibonacci's lattice.
        let height = 1.0 - 2.0 * (index as f32 + 0.5) / count as f32;
        let turn = index as f32 * 2.399_963;
        let wide = (1.0 - height * height).sqrt();
        let off = Vec3::new(wide * turn.cos(), height, wide * turn.sin());
        ball.push(at + off, Vec3::splat(0.04), Quat::IDENTITY, 0.9, &[0.0; 3]);
    }
    ball
}

/// Numbers from -1 to 1 that are spread evenly, as places are that have nothing to do with each other.
fn scattered(index: usize) -> Vec3 {
    let share = |step: f64| ((index as f64 + 1.0) * step).fract() as f32 * 2.0 - 1.0;
    Vec3::new(share(0.819_172_5), share(0.671_043_6), share(0.549_700_5))
}

fn near(a: &Camera, b: &Camera, tolerance: f64) {
    let apart = a.eye.distance(b.eye) / b.eye.length();
    assert!(apart <= tolerance, "{} and {}: {apart}", a.eye, b.eye);
    assert!((a.fx / b.fx - 1.0).abs() <= tolerance, "{} {}", a.fx, b.fx);
}

#[test]
fn what_is_visible_fills_the_picture_and_is_in_its_middle() {
    for kind in [Kind::General, Kind::Layers, Kind::Strands] {
        let made = scene::generate(kind, 3000, 1);
        // The last of a general scene are faint and off its surfaces.
        let count = if kind == Kind::General { 2940 } else { 3000 };
        for size in [(640, 480), (300, 900)] {
            for lens in [Lens::Perspective(50.0), Lens::Orthographic(None)] {
                let camera = camera(Framing::new(lens, size), &made);
                let (least, most) = filled_by(&camera, &made, count);
                let widest = most.max(-least).max_element();
                let least_wide = if kind == Kind::General { 0.75 } else { 0.9 };
                assert!(
                    (least_wide..0.93).contains(&widest),
                    "{kind:?} {lens:?}: {least} to {most}"
                );
                let aside = (least + most).abs();
                let on = if most.x > most.y { aside.x } else { aside.y };
                // The faint ones are in the picture too.
                let most_aside = if kind == Kind::General { 0.2 } else { 0.02 };
                assert!(on < most_aside, "{kind:?} {lens:?}: {least} to {most}");
                let outside = Outside::of(&(&made).into(), &camera);
                assert!(outside.outside == 0 || kind == Kind::General, "{outside:?}");
            }
        }
    }
}

#[test]
fn one_gaussian_a_few_coarse_ones_and_none_are_framed() {
    let mut one = Gaussians::default();
    let scale = Vec3::new(0.2, 0.5, 0.1);
    one.push(
        Vec3::new(3.0, 1.0, -2.0),
        scale,
        Quat::IDENTITY,
        0.9,
        &[0.0; 3],
    );
    let mut few = scene::generate(Kind::General, 5, 1);
    few.scales_mut().fill(Vec3::new(0.6, 0.4, 0.5));
    let mut faint = one.clone();
    faint.opacities_mut().fill(0.03);
    for (gaussians, seen) in [(&one, &one), (&few, &few), (&faint, &faint)] {
        for lens in [Lens::Perspective(50.0), Lens::Orthographic(None)] {
            let camera = camera(Framing::new(lens, (64, 48)), gaussians);
            let (least, most) = filled(&camera, seen);
            let widest = most.max(-least).max_element();
            assert!((0.8..0.95).contains(&widest), "{lens:?}: {least} to {most}");
        }
    }
    let mut tiny = one.clone();
    tiny.scales_mut().fill(Vec3::splat(1e-4));
    assert!(filled(&perspective(&tiny), &tiny).1.max_element() < 0.01);
    // However far apart they are for their size, a few are the scene.
    let mut apart = Gaussians::default();
    for at in [
        Vec3::ZERO,
        Vec3::new(9.0, 1.0, 0.0),
        Vec3::new(4.0, -6.0, 5.0),
    ] {
        apart.push(at, Vec3::splat(1e-3), Quat::IDENTITY, 0.5, &[0.0; 3]);
    }
    let (least, most) = filled(&perspective(&apart), &apart);
    let widest = most.max(-least).max_element();
    assert!((0.9..0.93).contains(&widest), "{least} to {most}");
    let nothing = perspective(&Gaussians::default());
    assert!(nothing.eye.is_finite() && nothing.eye.length() > 0.5);
}

#[test]
fn a_wide_and_faint_background_leaves_the_object_large() {
    let object = ball(Vec3::new(2.0, 0.0, 1.0), 3000);
    let alone = perspective(&object);
    let with = |count: usize, size: f32, opacity: f32| {
        let mut all = object.clone();
        for index in 0..count {
            let at = Vec3::new(2.0, 0.0, 1.0) + 12.0 * scattered(index);
            all.push(at, Vec3::splat(size), Quat::IDENTITY, opacity, &[0.0; 3]);
        }
        perspective(&all)
    };
    near(&with(600, 1.5, 0.06), &alone, 0.02);
    near(&with(300, 0.3, 0.9), &alone, 0.1);
    // Of the same Gaussians only the number differs: these are what there is to see.
    let away = with(30_000, 0.3, 0.9).eye.distance(alone.eye);
    assert!(away > 5.0, "{away}");
}

#[test]
fn strays_and_a_backdrop_decide_nothing() {
    let object = ball(Vec3::ZERO, 3000);
    let alone = perspective(&object);
    for (at, size) in [
        (Vec3::ZERO, 50.0),
        (Vec3::splat(1e6), 0.04),
        (Vec3::new(-1e30, 0.0, 0.0), 1e20),
        (Vec3::new(0.0, 9.0, 0.0), 0.04),
    ] {
        let mut all = object.clone();
        all.push(at, Vec3::splat(size), Quat::IDENTITY, 0.9, &[0.0; 3]);
        near(&perspective(&all), &alone, 1e-9);
    }
}

#[test]
fn what_reaches_out_of_an_object_is_shown() {
    let mut object = ball(Vec3::ZERO, 3000);
    let alone = perspective(&object);
    for direction in [Vec3::X, Vec3::new(0.0, -0.6, 0.8)] {
        let turn = Quat::from_rotation_arc(Vec3::X, direction);
        for piece in 0..20 {
            let at = direction * (1.0 + 0.1 * piece as f32);
            object.push(at, Vec3::new(0.05, 0.002, 0.002), turn, 0.9, &[0.0; 3]);
        }
    }
    let camera = perspective(&object);
    let (least, most) = filled(&camera, &object);
    assert!(most.max(-least).max_element() < 0.93, "{least} to {most}");
    assert!(camera.eye.distance(alone.eye) > 0.5);
}

#[test]
fn a_layer_is_framed_wherever_it_is_placed_unless_it_is_hidden() {
    let (large, small) = (ball(Vec3::ZERO, 3000), ball(Vec3::ZERO, 40));
    let of = |at: DVec3, visible: bool| {
        let placement = Placement::new(at, DQuat::IDENTITY, 0.1).expect("a placement");
        let state = LayerState::default().placement(placement).visible(visible);
        Scene::from_iter([Layer::new("a", &large), Layer::new("b", &small).with(state)])
    };
    let alone = perspective(&large);
    let at = DVec3::new(9.0, 0.0, 0.0);
    near(&perspective(of(at, false)), &alone, 1e-9);
    let camera = perspective(of(at, true));
    let mut placed = Gaussians::default();
    placed.push(
        at.as_vec3(),
        Vec3::splat(0.1),
        Quat::IDENTITY,
        0.9,
        &[0.0; 3],
    );
    let (least, most) = filled(&camera, &placed);
    assert!(
        most.x < 1.0 && most.x > 0.5 && least.y > -1.0,
        "{least} to {most}"
    );
    assert!(filled(&camera, &large).0.x > -0.93);
}

#[test]
fn an_orbit_holds_what_is_visible_in_every_place() {
    let made = scene::generate(Kind::Strands, 2000, 3);
    let orbit = Orbit::new(1.0, 30);
    for lens in [Lens::Perspective(40.0), Lens::Orthographic(None)] {
        let visible = Visible::of(&(&made).into());
        let round = |framed: Framing| framed.orbit(orbit, &visible).expect("cameras");
        let plain = Framing::new(lens, (80, 60));
        let mut widest = 0.0_f64;
        for camera in round(plain) {
            let (least, most) = filled(&camera, &made);
            widest = widest.max(most.max(-least).max_element());
        }
        assert!((0.9..0.93).contains(&widest), "{lens:?}: {widest}");
        // Round a target it is wider, and each place looks at the target.
        for target in [DVec3::new(0.5, 0.0, 0.3), DVec3::new(5.0, 0.0, 0.3)] {
            for camera in round(plain.target(Some(target))) {
                let (least, most) = filled(&camera, &made);
                assert!(most.max(-least).max_element() < 0.93, "{lens:?}");
                let seen = camera.rotation * (target - camera.eye);
                assert!(seen.truncate().length() < 1e-9 && seen.z > 0.0);
            }
        }
    }
}

#[test]
fn an_eye_or_a_target_by_itself_keeps_the_rest_of_the_frame() {
    let made = ball(Vec3::new(1.0, 2.0, 3.0), 2000);
    let plain = Framing::new(Lens::Perspective(50.0), (640, 480));
    let usual = camera(plain, &made);
    let eye = DVec3::new(-3.0, 0.0, 1.0);
    let from = camera(plain.eye(Some(eye)), &made);
    assert_eq!(from.eye, eye);
    let middle = from.rotation * (DVec3::new(1.0, 2.0, 3.0) - eye);
    assert!(middle.truncate().length() < 0.01 * middle.z, "{middle}");
    // The middle is as far away as before, and in the same direction.
    let target = DVec3::new(5.0, -2.0, 0.0);
    let at = camera(plain.target(Some(target)), &made);
    assert_eq!(at.rotation, usual.rotation);
    let seen = at.rotation * (target - at.eye);
    let depth = (usual.rotation * (DVec3::new(1.0, 2.0, 3.0) - usual.eye)).z;
    assert!(seen.truncate().length() < 1e-9 && (seen.z / depth - 1.0).abs() < 0.01);
}

#[test]
fn sections_hold_all_that_is_visible_at_one_scale() {
    let made = scene::generate(Kind::Strands, 3000, 2);
    let visible = Visible::nearly_all_of(&(&made).into());
    for (normal, up) in [(DVec3::X, DVec3::Z), (DVec3::NEG_Z, UP), (DVec3::ONE, UP)] {
        let mut scales = Vec::new();
        for offset in [-0.8, 0.0, 0.3] {
            let plane = Plane::new(normal, offset).expect("a plane");
            let camera = visible.facing(&plane, up, (90, 60)).expect("a camera");
            assert!(camera.rotation.row(2).distance(normal.normalize()) < 1e-12);
            assert!(plane.distance(camera.eye) < -visible.radius());
            let (least, most) = filled(&camera, &made);
            let widest = most.max(-least).max_element();
            assert!((0.9..0.93).contains(&widest), "{normal}: {least} to {most}");
            scales.push(camera.fx);
        }
        assert!(scales.iter().all(|scale| *scale == scales[0]), "{scales:?}");
    }
}

/// Figures of programs that measure rest on the camera that holds the box.
#[test]
fn a_box_is_held_as_camera_frame_holds_it() {
    let made = rara::scene::generate(rara::scene::Kind::General, 300, 1);
    let bounds = Bounds::of(&made);
    let plain = Framing::new(Lens::Perspective(50.0), (64, 48));
    let camera = |framed: Framing| framed.boxed(&bounds).expect("a camera");
    let boxed = Camera::frame(&bounds, UP, 50.0, (64, 48)).expect("a view");
    assert_eq!(camera(plain), boxed);
    let aside = DVec3::new(1.0, 2.0, 3.0);
    let moved = camera(plain.target(Some(bounds.centre() + aside)));
    assert!((moved.eye - boxed.eye).distance(aside) < 1e-12);
    let from = camera(plain.eye(Some(aside)));
    let facing = Camera::look_at(aside, bounds.centre(), UP, 50.0, (64, 48));
    assert_eq!(from, facing.expect("a view"));
}

/// The Gaussians that reach out of a picture are counted, out to where they are drawn.
#[test]
fn what_reaches_out_of_the_picture_is_counted() {
    let object = ball(Vec3::ZERO, 3000);
    let counted = |gaussians: &Gaussians, lens: Lens| {
        let camera = camera(Framing::new(lens, (64, 64)), gaussians);
        let Outside { visible, outside } = Outside::of(&gaussians.into(), &camera);
        (outside, visible)
    };
    for lens in [Lens::Perspective(50.0), Lens::Orthographic(None)] {
        assert_eq!(counted(&object, lens), (0, 3000));
        let mut strays = object.clone();
        for at in [9.0, -9.0, 1e6] {
            strays.push(
                Vec3::new(0.0, at, 0.0),
                Vec3::splat(0.04),
                Quat::IDENTITY,
                0.9,
                &[0.0; 3],
            );
        }
        // One that is too faint to be drawn.
        strays.push(Vec3::X, Vec3::splat(50.0), Quat::IDENTITY, 0.003, &[0.0; 3]);
        assert_eq!(counted(&strays, lens), (3, 3003));
    }
}

/// A few opaque Gaussians beside an object, which nothing links to it, are in its picture where that hardly becomes smaller.
#[test]
fn what_lies_just_beside_an_object_is_in_the_picture() {
    for (off, is_held) in [(1.32, true), (1.8, false)] {
        let mut scene = ball(Vec3::ZERO, 2000);
        let count = scene.len();
        for side in [-1.0, 1.0] {
            let at = Vec3::new(0.1, side * off, 0.0);
            scene.push(at, Vec3::splat(0.003), Quat::IDENTITY, 0.9, &[0.0; 3]);
        }
        let camera = perspective(&scene);
        let (least, most) = filled(&camera, &scene);
        let holds = least.min_element() >= -1.0 && most.max_element() <= 1.0;
        assert_eq!(holds, is_held, "{off}: {least}, {most}");
        let (least, most) = filled_by(&camera, &scene, count);
        assert!((most - least).max_element() > 1.6, "{off}: {least}, {most}");
    }
}

/// Faint Gaussians, and those of large scenes that are not among those looked at, reach out of what they are linked to.
#[test]
fn faint_tips_are_in_the_picture() {
    let mut object = ball(Vec3::ZERO, 3000);
    for index in 0..200 {
        let off = scattered(index).normalize() * 1.1;
        let scale = Vec3::new(0.06, 0.01, 0.01);
        let turn = Quat::from_rotation_arc(Vec3::X, off.normalize());
        object.push(off, scale, turn, 0.015, &[0.0; 3]);
    }
    for lens in [Lens::Perspective(50.0), Lens::Orthographic(None)] {
        let camera = camera(Framing::new(lens, (640, 480)), &object);
        let (least, most) = filled(&camera, &object);
        let widest = most.max(-least).max_element();
        assert!((0.9..0.93).contains(&widest), "{lens:?}: {least} to {most}");
        assert_eq!(Outside::of(&(&object).into(), &camera).outside, 0);
    }
}
