//! The planes that move with the camera cut as any other planes do.

use crate::common;
use glam::{DQuat, DVec3};
use rara::clip::Expression;
use rara::scene::{Kind, generate};
use rara::{
    Camera, Clip, ClipOp, Layer, LayerState, Mode, Picture, Placement, Plane, Scene, Settings,
};

fn views() -> [Camera; 2] {
    let (eye, size) = (DVec3::new(0.4, -0.7, -3.0), common::scaled((125, 94)));
    let perspective = Camera::look_at(eye, DVec3::ZERO, -DVec3::Y, 50.0, size);
    let parallel = Camera::orthographic(eye, DVec3::ZERO, -DVec3::Y, 2.0, size);
    [perspective, parallel].map(|camera| camera.expect("a view"))
}

/// The planes across a camera's axis at two depths, made from a point on each.
fn planes_at(camera: &Camera, near: f64, far: f64) -> [Plane; 2] {
    let forward = camera.rotation.transpose() * DVec3::Z;
    let through = |normal: DVec3, depth: f64| {
        let point = camera.eye + depth * forward;
        Plane::new(normal, -normal.dot(point)).expect("a normal")
    };
    [through(forward, near), through(-forward, far)]
}

#[test]
fn near_and_far_planes_cut_every_layer_beside_its_own_clip() {
    let gaussians = generate(Kind::General, 800, 3);
    let turned = Placement::new(DVec3::new(0.3, 0.1, 0.4), DQuat::from_rotation_y(0.6), 0.7);
    let state = LayerState::default().placement(turned.expect("a placement"));
    let sphere = "sphere:0,0,0,.8"
        .parse::<Expression>()
        .expect("a shape")
        .clip();
    let frames = Clip::of([Plane::new(DVec3::Y, 0.2).expect("a normal")], ClipOp::Or);
    let mut headless = common::headless();
    for camera in views() {
        let (near, far) = (2.6, 3.3);
        let between = Clip::of(planes_at(&camera, near, far), ClipOp::And);
        let and_between = |clip: &Clip| Clip::joined([clip.clone(), between.clone()], ClipOp::And);
        let scene = |clip: Clip| {
            Scene::from_iter([
                Layer::new("the frame's clip", &gaussians),
                Layer::new("its own", &gaussians).with(state).clipped(clip),
            ])
        };
        for mode in [Mode::Exact, Mode::Rara, Mode::Hard] {
            let settings = Settings::default().mode(mode);
            let mut picture = |clip: Clip, camera: &Camera, frames: &Clip| -> Picture {
                headless.load(scene(clip)).expect("uploads");
                headless.render(camera, frames, &settings).expect("renders");
                headless.picture().expect("reads back")
            };
            let cutting = camera.clip_near(Some(near)).clip_far(Some(far));
            let ours = picture(sphere.clone(), &cutting, &frames);
            let theirs = picture(and_between(&sphere), &camera, &and_between(&frames));
            common::assert_agrees(&format!("{mode:?}"), &ours, &theirs);
            let whole = picture(sphere.clone(), &camera, &frames);
            assert!(ours != whole, "they cut something");
        }
    }
}

#[test]
fn planes_follow_the_camera_from_frame_to_frame() {
    let gaussians = generate(Kind::General, 2_000, 3);
    let [mut keeps, mut forgets] = [(); 2].map(|()| {
        let mut headless = common::headless();
        headless.load(&gaussians).expect("uploads");
        headless
    });
    let [first, _] = views();
    let second = first.eye(DVec3::new(0.5, -0.7, -2.9));
    let walk = [
        first.clip_near(Some(2.9)),
        first.clip_near(Some(3.0)),
        second.clip_near(Some(3.0)),
        second.clip_far(Some(3.0)),
        second,
    ];
    for (number, camera) in walk.into_iter().enumerate() {
        forgets.forget();
        let [kept, fresh] = [&mut keeps, &mut forgets].map(|headless| {
            let settings = Settings::default();
            headless
                .render(&camera, &Clip::default(), &settings)
                .expect("renders");
            headless.picture().expect("reads back")
        });
        assert!(kept == fresh, "frame {number}");
    }
}

#[test]
fn planes_that_mean_nothing_are_refused() {
    let gaussians = generate(Kind::General, 10, 3);
    let mut headless = common::headless();
    headless.load(&gaussians).expect("uploads");
    let [camera, _] = views();
    for camera in [
        camera.clip_near(Some(f64::NAN)),
        camera.clip_far(Some(f64::INFINITY)),
        camera.clip_near(Some(2.0)).clip_far(Some(2.0)),
    ] {
        let drawn = headless.render(&camera, &Clip::default(), &Settings::default());
        assert!(matches!(drawn, Err(rara::Error::Invalid(_))), "{drawn:?}");
    }
}
