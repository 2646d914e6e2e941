//! Orthographic pictures against the f64 reference, and against each other.

use crate::common;
use glam::DVec3;
use rara::gpu::Bindings;
use rara::scene::{Bounds, Kind, generate};
use rara::{
    Camera, Clip, ClipOp, Decay, ExactForm, Gaussians, Mode, Picture, Projection, Raster, Settings,
};

/// Not a multiple of any workgroup.
const SIZE: (u32, u32) = (253, 190);

/// A view from outside, and one that depths count from in the middle of the scene, so that splats reach behind it.
fn views(scene: &Gaussians) -> [Camera; 2] {
    let outside = common::views(scene, 3, common::scaled(SIZE))[1];
    let outside = common::flattened(&outside, scene);
    [outside, outside.eye(Bounds::of(scene).centre())]
}

const CLIPS: [(Mode, usize, ClipOp); 6] = [
    (Mode::None, 0, ClipOp::And),
    (Mode::Hard, 1, ClipOp::And),
    (Mode::Rara, 2, ClipOp::And),
    (Mode::Exact, 1, ClipOp::And),
    (Mode::Exact, 2, ClipOp::Or),
    (Mode::Exact, 6, ClipOp::And),
];

#[test]
fn every_mode_by_every_way_of_drawing() {
    for bindings in [Bindings::Mixed, Bindings::Address] {
        let mut headless = common::headless_by(bindings);
        for (name, scene) in common::generated_scenes(4_000) {
            headless.load(&scene).expect("uploads");
            for camera in views(&scene) {
                for raster in common::rasters(headless.device()) {
                    for (mode, planes, op) in CLIPS {
                        let clip = common::clip(&scene, planes, op);
                        let settings = Settings::default().mode(mode).raster(raster);
                        common::check(&mut headless, &name, &scene, &camera, &clip, &settings);
                    }
                }
            }
        }
    }
}

#[test]
fn trained_scenes() {
    let mut headless = common::headless();
    for (name, scene) in common::trained_scenes() {
        headless.load(&scene).expect("uploads");
        for camera in views(&scene) {
            for (mode, planes, op) in CLIPS {
                let clip = common::clip(&scene, planes, op);
                let settings = Settings::default().mode(mode);
                common::check(&mut headless, &name, &scene, &camera, &clip, &settings);
            }
        }
    }
}

/// Splats of a hundredth of a pixel to twenty pictures, most of which reach behind the point that depths count from.
#[test]
fn splats_of_every_size_in_every_form() {
    let mut scene = generate(Kind::General, 400, 3);
    let radius = Bounds::of(&scene).radius() as f32;
    for (index, scale) in scene.scales_mut().iter_mut().enumerate() {
        let size = 1e-4 * radius * 10_f32.powf((index % 11) as f32 * 0.6);
        *scale *= size / scale.max_element();
    }
    for opacity in scene.opacities_mut() {
        *opacity *= 0.3;
    }
    let mut headless = common::headless();
    headless.load(&scene).expect("uploads");
    for camera in views(&scene) {
        for (mode, form) in [
            (Mode::Rara, ExactForm::Auto),
            (Mode::Exact, ExactForm::Auto),
            (Mode::Exact, ExactForm::Affine),
            (Mode::Exact, ExactForm::Beam),
        ] {
            for (planes, op) in [(1, ClipOp::And), (3, ClipOp::Or)] {
                let clip = common::clip(&scene, planes, op);
                let settings = Settings::default().mode(mode).form(form);
                common::check(&mut headless, "sizes", &scene, &camera, &clip, &settings);
            }
        }
    }
}

fn picture(
    headless: &mut rara::Headless,
    camera: &Camera,
    clip: &Clip,
    settings: &Settings,
) -> Picture {
    headless.render(camera, clip, settings).expect("renders");
    headless.picture().expect("reads back")
}

/// A clip that moves, and a change of the projection alone: frames that take over what they can are those from nothing.
#[test]
fn frames_that_are_taken_over_are_the_same_bytes() {
    let scene = generate(Kind::General, 20_000, 1);
    let mut headless = common::headless();
    headless.load(&scene).expect("uploads");
    let [camera, _] = views(&scene);
    let clip = common::clip(&scene, 1, ClipOp::And);
    let settings = Settings::default();
    let step = 0.02 * Bounds::of(&scene).radius();
    for (camera, clip) in [
        (camera, clip.clone()),
        (camera, common::moved(clip.clone(), step)),
        (camera, common::moved(clip.clone(), 2.0 * step)),
        (camera.projection(Projection::Perspective), clip.clone()),
        (camera, clip),
    ] {
        let taken = picture(&mut headless, &camera, &clip, &settings);
        headless.forget();
        let anew = picture(&mut headless, &camera, &clip, &settings);
        assert!(taken == anew, "{camera:?}");
    }
}

/// By optical depth, what a plane keeps and what it cuts away are the whole, whatever a splat's size.
#[test]
fn complementary_halves_rebuild_the_whole() {
    let mut scene = generate(Kind::General, 1, 2);
    scene.positions_mut()[0] = glam::Vec3::ZERO;
    scene.opacities_mut()[0] = 0.9;
    let mut headless = common::headless();
    for size in [1e-3, 0.1, 10.0, 1e3] {
        scene.scales_mut()[0] = glam::Vec3::new(1.0, 0.4, 0.7) * size;
        headless.load(&scene).expect("uploads");
        let eye = DVec3::new(0.1, -0.2, -1.0);
        let camera = Camera::orthographic(eye, DVec3::ZERO, DVec3::NEG_Y, 2.0, SIZE);
        let camera = camera.expect("a view");
        let settings = Settings::default()
            .decay(Some(Decay::Depth))
            .raster(Raster::Tiles);
        let normal = DVec3::new(0.6, -0.2, 0.5);
        let mut alphas = [normal, -normal].map(|normal| {
            let plane = rara::Plane::new(normal, 0.0).expect("a normal");
            let clip = Clip::of([plane], ClipOp::And);
            let picture = picture(&mut headless, &camera, &clip, &settings);
            picture.pixels.into_iter().map(|p| p[3]).collect::<Vec<_>>()
        });
        let whole = picture(&mut headless, &camera, &Clip::default(), &settings);
        let kept = std::mem::take(&mut alphas[0]);
        for ((a, b), whole) in kept.into_iter().zip(&alphas[1]).zip(&whole.pixels) {
            let both = 1.0 - (1.0 - a) * (1.0 - b);
            assert!(
                (both - whole[3]).abs() < 1e-4,
                "{size}: {a}, {b}, {whole:?}"
            );
        }
        assert!(whole.pixels.iter().any(|pixel| pixel[3] > 0.5), "{size}");
    }
}
