//! What a headless renderer says of a pixel beside its colour.

use crate::common;
use glam::{DQuat, DVec3, Vec3};
use rara::scene::{Kind, generate};
use rara::{
    Aov, Camera, Clip, ClipOp, Gaussians, Headless, Layer, LayerState, Mode, Placement, Projection,
    Raster, Scene, Settings, Show,
};

#[test]
fn headless_expected_depths_are_the_references() {
    let scene = generate(Kind::General, 3_000, 5);
    let camera = common::views(&scene, 3, common::scaled((160, 120)))[1];
    let mut headless = common::headless();
    headless.load(&scene).expect("uploads");
    for (mode, planes) in [(Mode::None, 0), (Mode::Exact, 1), (Mode::Hard, 1)] {
        let clip = common::clip(&scene, planes, ClipOp::And);
        let settings = Settings::default().mode(mode);
        headless.render(&camera, &clip, &settings).expect("renders");
        let before = headless.picture().expect("reads back");
        let depths = headless.expected_depth(&camera, &clip, &settings);
        let depths = depths.expect("draws depths");
        let truth = rara_reference::depth::expected::<f64>(&scene, &camera, &clip, &settings);
        assert_eq!(depths.len(), truth.len());
        let mut errors: Vec<f64> = depths
            .iter()
            .zip(&truth)
            .filter(|(_, truth)| truth[1] > 0.02)
            .map(|(ours, truth)| (f64::from(*ours) / (truth[0] / truth[1]) - 1.0).abs())
            .collect();
        errors.sort_by(f64::total_cmp);
        assert!(errors.len() > 1_000, "{} pixels", errors.len());
        // As a host's depths are held to the reference: a splat at its threshold is in a pixel or is not.
        let (most, worst) = (errors[errors.len() * 998 / 1000], errors[errors.len() - 1]);
        assert!(
            most < 2e-4 && worst < 0.02,
            "{mode:?}: {most:.1e}, {worst:.1e}"
        );
        // What a picture shows is no matter, also where that is made by tiles alone.
        for show in [Show::Weight, Show::Count, Show::Mean] {
            let again = headless.expected_depth(&camera, &clip, &settings.show(show));
            assert!(again.expect("draws depths") == depths, "{show:?}");
        }
        // The picture stays.
        assert_eq!(headless.picture().expect("reads back"), before);
        headless.render(&camera, &clip, &settings).expect("renders");
        assert_eq!(headless.picture().expect("reads back"), before);
    }
    let tiles = Settings::default().raster(Raster::Tiles);
    let nothing = common::clip(&scene, 1, ClipOp::And);
    let away = common::moved(nothing, -1e6);
    let depths = headless.expected_depth(&camera, &away, &tiles);
    assert!(
        depths
            .expect("draws nothing")
            .iter()
            .all(|depth| *depth == 0.0)
    );
    headless.close().expect("nothing to validate");
}

/// A disc aside that shows the eye one face and the plane of the eye the other.
#[test]
fn normals_are_turned_to_the_eye_and_not_to_its_plane() {
    let normal = DVec3::new(-0.9, 0.0, 0.44).normalize();
    let at = DVec3::new(1.0, 0.0, 1.2);
    let mut disc = Gaussians::default();
    let turn = DQuat::from_rotation_arc(DVec3::Z, normal).as_quat();
    let thin = Vec3::new(0.15, 0.15, 0.001);
    disc.push(at.as_vec3(), thin, turn, 0.9, &[0.0; 3]);
    let camera = Camera::look_at(DVec3::ZERO, DVec3::Z, -DVec3::Y, 90.0, (64, 64));
    let camera = camera.expect("a view");
    let flat = camera.projection(Projection::Orthographic);
    let mut headless = common::headless();
    headless.load(&disc).expect("uploads");
    for (camera, expected) in [(camera, normal), (flat.fx(20.0).fy(20.0), -normal)] {
        for found in normals(&mut headless, &camera) {
            assert!(found.distance(expected) < 1e-3, "{found}, not {expected}");
        }
    }
    headless.close().expect("nothing to validate");
}

/// Parallel lines of sight see a disc of a turned layer from the same side, whichever axis of the scene they follow.
#[test]
fn normals_of_a_turned_layer_are_turned_to_parallel_lines_of_sight() {
    let normal = DVec3::new(0.5, -0.6, 0.62).normalize();
    let mut disc = Gaussians::default();
    let own = DQuat::from_rotation_arc(DVec3::Z, normal).as_quat();
    let thin = Vec3::new(0.15, 0.15, 0.001);
    disc.push(Vec3::new(0.3, -0.1, 0.2), thin, own, 0.9, &[0.0; 3]);
    let turn = DQuat::from_axis_angle(DVec3::new(0.3, 0.9, -0.2).normalize(), 2.5);
    let placement = Placement::new(DVec3::new(5.0, -3.0, 2.0), turn, 2.0).expect("a placement");
    let target = placement.to_world(disc.centre(0));
    let layer = Layer::new("turned", &disc).with(LayerState::default().placement(placement));
    let mut headless = common::headless();
    headless.load(Scene::from_iter([layer])).expect("uploads");
    for sight in [DVec3::X, DVec3::Y, DVec3::Z]
        .into_iter()
        .flat_map(|axis| [axis, -axis])
    {
        let up = if sight.y == 0.0 { -DVec3::Y } else { DVec3::Z };
        let camera = Camera::orthographic(target - 4.0 * sight, target, up, 1.0, (32, 32));
        let camera = camera.expect("a view");
        let seen = turn * normal;
        let expected = -seen.dot(sight).signum() * seen;
        for found in normals(&mut headless, &camera) {
            assert!(
                found.distance(expected) < 1e-3,
                "{sight}: {found}, not {expected}"
            );
        }
    }
    headless.close().expect("nothing to validate");
}

/// The normals of the pixels that have one.
fn normals(headless: &mut Headless, camera: &Camera) -> Vec<DVec3> {
    let frame = (camera, &Clip::default(), &Settings::default());
    let channels = headless.channels(&[Aov::Normal], frame);
    let channels = channels.expect("channels");
    let [x, y, z] = channels.as_slice() else {
        panic!("{} channels", channels.len());
    };
    let all = x.values.iter().zip(&y.values).zip(&z.values);
    let all = all.map(|((x, y), z)| Vec3::new(*x, *y, *z).as_dvec3());
    let shown: Vec<_> = all.filter(|found| *found != DVec3::ZERO).collect();
    assert!(shown.len() > 10, "{} pixels", shown.len());
    shown
}

#[test]
fn depths_need_a_scene() {
    let camera = Camera::look_at(DVec3::Z, DVec3::ZERO, -DVec3::Y, 40.0, (8, 8));
    let error = common::headless()
        .expected_depth(
            &camera.expect("a view"),
            &Clip::default(),
            &Settings::default(),
        )
        .expect_err("there is no scene");
    assert!(error.to_string().contains("load one first"), "{error}");
}
