//! The planes that move with the camera cut as any other planes do.

use crate::common;
use glam::{DQuat, DVec3};
use rara::clip::Expression;
use rara::scene::{Kind, generate};
use rara::{
    Camera, Clip, ClipOp, Gaussians, Layer, LayerState, Mode, Picture, Placement, Plane, Scene,
    Settings,
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

/// The Gaussians whose centres are at a depth or deeper.
fn deeper(scene: &Gaussians, camera: &Camera, depth: f64) -> Gaussians {
    let forward = camera.rotation.row(2);
    let is_deep = |at: usize| forward.dot(scene.positions()[at].as_dvec3() - camera.eye) >= depth;
    let mut kept = Gaussians::default();
    kept.set_sh_degree(scene.sh_degree());
    for at in (0..scene.len()).filter(|at| is_deep(*at)) {
        kept.push(
            scene.positions()[at],
            scene.scales()[at],
            scene.rotations()[at],
            scene.opacities()[at],
            scene.sh_of(at),
        );
    }
    kept
}

#[test]
fn a_near_cut_leaves_out_whole_splats() {
    let scene = generate(Kind::General, 1_500, 8);
    let mut headless = common::headless();
    let clip = common::clip(&scene, 1, ClipOp::And);
    let settings = Settings::default();
    for camera in views() {
        // Frames take turns, so that none takes over what another near cut has left.
        for depth in [2.7, 0.2, 3.1, 0.01] {
            let cut = camera.near_cut(Some(depth));
            headless.load(&scene).expect("uploads");
            headless.render(&camera, &clip, &settings).expect("renders");
            headless.render(&cut, &clip, &settings).expect("renders");
            let found = headless.picture().expect("reads back");
            common::check(&mut headless, "near cut", &scene, &cut, &clip, &settings);
            let rest = deeper(&scene, &camera, depth);
            assert!(depth < 1.0 || (100..scene.len() - 100).contains(&rest.len()));
            headless.load(&rest).expect("uploads");
            headless.render(&camera, &clip, &settings).expect("renders");
            let expected = headless.picture().expect("reads back");
            common::assert_agrees("the deeper ones alone", &found, &expected);
        }
        // In a scene of half the size the cut is where it is in the world.
        let half = Placement::new(DVec3::ZERO, DQuat::IDENTITY, 0.5).expect("a placement");
        let half = Layer::new("half", &scene).with(LayerState::default().placement(half));
        let (placed, cut) = (Scene::from_iter([half]), camera.near_cut(Some(2.9)));
        let truth = rara_reference::render::<f64>(placed.clone(), &cut, &clip, &settings);
        headless.load(placed).expect("uploads");
        let stats = headless.render(&cut, &clip, &settings).expect("renders");
        assert!((100..1400).contains(&stats.counts.culled), "{stats:?}");
        let found = headless.picture().expect("reads back");
        common::assert_agrees("placed", &found, &truth.picture);
    }
    let nowhere = views()[0].near_cut(Some(0.0));
    let refused = headless.render(&nowhere, &clip, &settings);
    let text = refused.expect_err("nothing lies there").to_string();
    assert!(text.contains("near cut at a depth of 0"), "{text}");
    headless.close().expect("no validation messages");
}

/// Splats closer than 0.2 are drawn where the near cut lets them.
#[test]
fn splats_close_to_the_eye_are_drawn_with_a_nearer_cut() {
    let mut near = Gaussians::default();
    for (x, depth) in [(-0.01, 0.05_f32), (0.012, 0.08), (0.0, 0.15), (0.3, 1.0)] {
        let at = glam::Vec3::new(x, 0.0, depth);
        let scale = glam::Vec3::splat(0.05 * depth);
        near.push(at, scale, glam::Quat::IDENTITY, 0.7, &[1.0, 0.2 * x, 0.5]);
    }
    let mut headless = common::headless();
    let (size, settings) = (common::scaled((96, 64)), Settings::default());
    let camera = Camera::look_at(DVec3::ZERO, DVec3::Z, -DVec3::Y, 60.0, size).expect("a view");
    headless.load(&near).expect("uploads");
    let mut drawn = |camera: &Camera| {
        let stats = headless.render(camera, &Clip::default(), &settings);
        stats.expect("renders").counts.drawn
    };
    assert_eq!(drawn(&camera), 1);
    assert_eq!(drawn(&camera.near_cut(Some(0.1))), 2);
    let close = camera.near_cut(Some(0.01));
    assert_eq!(drawn(&close), 4);
    common::check(
        &mut headless,
        "close",
        &near,
        &close,
        &Clip::default(),
        &settings,
    );
    headless.close().expect("no validation messages");
}
