//! Two layers, one of all that a clip keeps and one of all that it cuts away.

use std::cell::Cell;

use glam::{DMat4, DQuat, DVec3, Vec3};
use proptest::prelude::*;
use rara::{Camera, Clip, Decay, ExactForm, Gaussians, Mode, Picture, Plane, Settings};

use super::{CASES, SIZE, check, directions, draw, operations};

/// Splats of every shape so far apart that no two share a pixel: a grid of 5 x 4 before a camera at the origin.
fn separated() -> impl Strategy<Value = (Gaussians, Camera)> {
    let splat = (
        [0.0..1.0_f32, 0.0..1.0, 0.0..1.0],
        (directions(), -3.0..3.0_f64),
        0.05..1.0_f32,
    );
    prop::collection::vec(splat, 20).prop_map(|splats| {
        let mut scene = Gaussians::default();
        for (index, (shape, (axis, angle), opacity)) in splats.into_iter().enumerate() {
            // 20 pixels apart at most 3.33 deviations of 2.5 pixels (and the low-pass) to either side.
            let (column, row) = ((index % 5) as f32 - 2.0, (index / 5) as f32 - 1.5);
            let depth = 2.0 + 0.1 * index as f32;
            let pixel = depth / 100.0;
            let position = Vec3::new(20.0 * pixel * column, 19.0 * pixel * row, depth);
            let deviations = shape.map(|s| 2.5 * pixel * 10.0_f32.powf(-3.0 * s));
            let rotation = DQuat::from_axis_angle(axis, angle).as_quat();
            let colour = [1.0, 0.3, -0.7];
            scene.push(position, deviations.into(), rotation, opacity, &colour);
        }
        let lens = (100.0, 100.0, 50.5, 38.5);
        let camera = Camera::from_world_to_camera(DMat4::IDENTITY, lens, SIZE);
        (scene, camera.expect("a camera at the origin"))
    })
}

/// Planes through some of those splats: which, the normal, and the distance from its centre in deviations along it.
type Through = Vec<(prop::sample::Index, DVec3, f64)>;

fn planes_through_splats() -> impl Strategy<Value = Through> {
    prop::collection::vec(
        (any::<prop::sample::Index>(), directions(), -2.0..2.0_f64),
        1..4,
    )
}

fn resolved(scene: &Gaussians, planes: &Through) -> Vec<Plane> {
    let plane = |(index, normal, deviations): &(prop::sample::Index, DVec3, f64)| {
        let i = index.index(scene.len());
        let along = scene.rotations()[i].as_dquat().inverse() * *normal;
        let extent = (along * scene.scales()[i].as_dvec3()).length();
        let centre = scene.positions()[i].as_dvec3();
        Plane::new(*normal, deviations * extent - normal.dot(centre)).unwrap()
    };
    planes.iter().map(plane).collect()
}

/// Largest difference of a channel between a picture and two layers, one behind the other.
fn apart(front: &Picture, back: &Picture, whole: &Picture) -> f32 {
    let pixels = front.pixels.iter().zip(&back.pixels).zip(&whole.pixels);
    let channels = pixels.flat_map(|((front, back), whole)| {
        (0..4).map(|c| (front[c] + (1.0 - front[3]) * back[c] - whole[c]).abs())
    });
    channels.fold(0.0, f32::max)
}

/// Each splat is rebuilt from its halves to 2e-7 in the twin (reference/tests/laws.rs). The shaders' exp2 and log2 lose
/// another 3e-7 each where `1 - (1 - alpha)^w` is taken, and colours reach 1: a few times that. A splat's quad leaves out
/// what lies 4 deviations behind a plane, a weight of 3.2e-5; of the whole that takes `-(1 - alpha) ln(1 - alpha)` times
/// as much, which is at most 1.2e-5. Far below 1/255.
const LAYERS: f32 = 1.2e-5 + 3e-6;

#[test]
fn complementary_halves_as_two_layers_are_the_whole() {
    let strategy = (separated(), planes_through_splats(), operations());
    let cut = Cell::new(0);
    check(strategy, |headless, ((scene, camera), planes, op)| {
        let planes = resolved(&scene, &planes);
        headless.load(&scene).expect("uploads");
        let whole = draw(headless, &camera, &Clip::default(), &Settings::default());
        let other = Clip::of(planes.iter().map(Plane::flipped), op.dual());
        let [auto, beam] = [ExactForm::Auto, ExactForm::Beam];
        let modes = [
            (Mode::Hard, auto),
            (Mode::Rara, auto),
            (Mode::Exact, auto),
            (Mode::Exact, beam),
        ];
        for (mode, form) in modes {
            let settings = Settings::default()
                .mode(mode)
                .form(form)
                .decay(Some(Decay::Depth));
            let clip = Clip::of(planes.clone(), op);
            let halves = [clip, other.clone()].map(|c| draw(headless, &camera, &c, &settings));
            let difference = apart(&halves[0], &halves[1], &whole);
            prop_assert!(difference <= LAYERS, "{mode:?}: {difference:e}");
            cut.set(
                cut.get()
                    + headless
                        .render(&camera, &other, &settings)
                        .expect("renders")
                        .counts
                        .cutoff,
            );
            let back_to_front = apart(&halves[1], &halves[0], &whole);
            prop_assert!(back_to_front <= LAYERS, "{mode:?}: {back_to_front:e}");
        }
        Ok(())
    });
    assert!(cut.get() > CASES, "only {} splats were cut", cut.get());
}
