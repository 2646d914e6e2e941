//! Baked scenes: what is cut is what a frame cuts, and the pictures are nearer to the exact cut than by centres.

use crate::common;
use glam::{DQuat, DVec3};
use rara::scene::{Bounds, Kind, generate};
use rara::{
    BakeSettings, Camera, Clip, ClipOp, ExactForm, Headless, Layer, LayerState, Mode, Picture,
    Placement, Plane, Scene, Settings, Shape, bake, bake_layer,
};
use rara_lab::measure::differences;

fn drawn(headless: &mut Headless, camera: &Camera, clip: &Clip, mode: Mode) -> Picture {
    let settings = Settings::default().mode(mode);
    headless.render(camera, clip, &settings).expect("renders");
    headless.picture().expect("reads back")
}

/// A plane through the middle of a scene, and boxes around the middle, inside and outside.
fn clips(bounds: &Bounds) -> [Clip; 3] {
    let middle = bounds.centre();
    let normal = DVec3::new(0.8, 0.1, 0.6).normalize();
    let plane = Plane::new(normal, -normal.dot(middle)).expect("a normal");
    let half = 0.25 * (bounds.max - bounds.min);
    let turn = DQuat::from_rotation_y(0.3);
    let inside = Shape::cuboid(middle, half, turn).expect("a box");
    let shaped = |shape: Shape| shape.clip();
    [
        Clip::of([plane], ClipOp::And),
        shaped(inside),
        shaped(inside.complement()),
    ]
}

#[test]
fn what_is_cut_is_what_a_frame_cuts() {
    let scene = generate(Kind::General, 6000, 11);
    let bounds = Bounds::of(&scene);
    // From so far away that all is in view. A camera widens the band only of splats in perspective.
    let eye = bounds.centre() - 20.0 * bounds.radius() * DVec3::Z;
    let camera = Camera::look_at(eye, bounds.centre(), -DVec3::Y, 20.0, (256, 256));
    let camera = camera.expect("a view");
    let mut headless = common::headless();
    headless.load(&scene).expect("uploads");
    for clip in clips(&bounds) {
        for mode in [Mode::Hard, Mode::Rara, Mode::Exact] {
            let settings = Settings::default().mode(mode).form(ExactForm::Affine);
            let stats = headless.render(&camera, &clip, &settings);
            let frame = stats.expect("renders").counts;
            let settings = BakeSettings::default().mode(mode);
            let baked = bake(&scene, &clip, &settings).expect("bakes").counts;
            assert_eq!(frame.culled, 0, "all are in view");
            // One on the edge of its band to seven digits may be counted on either side.
            for (ours, frame) in [
                (baked.visible, frame.visible),
                (baked.cutoff, frame.cutoff),
                (baked.invisible, frame.invisible),
            ] {
                assert!(
                    ours.abs_diff(frame.into()) <= 1,
                    "{mode:?}: {baked:?}, {frame:?}"
                );
            }
        }
    }
    headless.close().expect("nothing to validate");
}

#[test]
fn a_baked_scene_is_nearer_to_the_exact_cut_than_one_cut_by_centres() {
    let mut headless = common::headless();
    let made_up =
        [Kind::General, Kind::Layers].map(|kind| (format!("{kind:?}"), generate(kind, 8000, 4)));
    for (name, scene) in made_up.into_iter().chain(common::trained_scenes()) {
        let bounds = Bounds::of(&scene);
        let size = common::scaled((256, 256));
        let camera = Camera::frame(&bounds, -DVec3::Y, 50.0, size).expect("a view");
        let clips = clips(&bounds);
        headless.load(&scene).expect("uploads");
        let cut: Vec<_> = clips
            .iter()
            .map(|clip| {
                [Mode::Exact, Mode::Hard].map(|mode| drawn(&mut headless, &camera, clip, mode))
            })
            .collect();
        for (number, (clip, [exact, hard])) in clips.iter().zip(&cut).enumerate() {
            let baked = bake(&scene, clip, &BakeSettings::default()).expect("bakes");
            headless.load(&baked.gaussians).expect("uploads");
            let none = Clip::default();
            let shown = drawn(&mut headless, &camera, &none, Mode::None);
            let ours = differences(&shown, exact).expect("of one size");
            let theirs = differences(hard, exact).expect("of one size");
            println!(
                "{name}, clip {number}: {:.2} dB and {:.3} for {:.2} dB and {:.3}",
                ours.psnr, ours.l1, theirs.psnr, theirs.l1
            );
            // A cut that is hidden in the middle of something opaque leaves nothing to compare.
            assert!(ours.l1 < 0.8 * theirs.l1.max(0.05), "{name}, clip {number}");

            // Twice is once: to the bit inside of convex clips, and next to nothing moves around them.
            let again = bake(&baked.gaussians, clip, &BakeSettings::default()).expect("bakes");
            if number < 2 {
                assert_eq!(again.gaussians, baked.gaussians, "{name}, clip {number}");
            } else {
                headless.load(&again.gaussians).expect("uploads");
                let again = drawn(&mut headless, &camera, &none, Mode::None);
                let moved = differences(&again, &shown).expect("of one size").l1;
                println!("{name}: a second time moves {moved:.4}");
                assert!(moved < 0.1, "{name}: {moved}");
            }
        }
    }
    headless.close().expect("nothing to validate");
}

#[test]
fn a_baked_layer_takes_its_layers_place() {
    let (one, other) = (
        generate(Kind::General, 3000, 1),
        generate(Kind::Layers, 3000, 2),
    );
    let turn = DQuat::from_xyzw(0.1, 0.4, -0.2, 0.9);
    let placement = Placement::new(DVec3::new(0.5, -0.2, 0.3), turn, 0.8).expect("finite");
    let states = [
        LayerState::default(),
        LayerState::default().placement(placement).opacity(0.7),
    ];
    let layers = [
        Layer::new("one", &one).with(states[0]),
        Layer::new("other", &other).with(states[1]),
    ];
    let scene = Scene::from_iter(layers.clone());
    let bounds = Bounds::of(&scene);
    let camera = Camera::frame(&bounds, -DVec3::Y, 50.0, (200, 200)).expect("a view");
    let [clip, ..] = clips(&bounds);
    let mut headless = common::headless();
    headless.load(&scene).expect("uploads");
    let [exact, hard] =
        [Mode::Exact, Mode::Hard].map(|mode| drawn(&mut headless, &camera, &clip, mode));
    let baked = layers.map(|layer| {
        bake_layer(&layer, &clip, &BakeSettings::default())
            .expect("bakes")
            .gaussians
    });
    let layers = baked.iter().zip(states);
    let layers = layers.map(|(gaussians, state)| Layer::new("baked", gaussians).with(state));
    headless.load(Scene::from_iter(layers)).expect("uploads");
    let shown = drawn(&mut headless, &camera, &Clip::default(), Mode::None);
    let error = |picture| differences(picture, &exact).expect("of one size").l1;
    assert!(
        error(&shown) < 0.8 * error(&hard),
        "{}, {}",
        error(&shown),
        error(&hard)
    );
    headless.close().expect("nothing to validate");
}

/// The fade is the state of the layer, in which what is baked goes on to be drawn: it says what is visible at all, and is in
/// no opacity.
#[test]
fn a_faded_layer_keeps_its_gaussians_own_opacities() {
    let scene = generate(Kind::General, 1500, 6);
    let bounds = Bounds::of(&scene);
    let [clip, ..] = clips(&bounds);
    let faded = LayerState::default().opacity(0.5);
    let layer = Layer::new("faded", &scene).with(faded);

    let settings = BakeSettings::default();
    let baked = bake_layer(&layer, &clip, &settings).expect("bakes");
    let unfaded = bake(&scene, &clip, &settings).expect("bakes");
    assert!(baked.counts.children > 50 && baked.counts.visible > 500);
    for (source, opacity) in baked.sources.iter().zip(baked.gaussians.opacities()) {
        let own = scene.opacities()[*source as usize];
        let same = unfaded.sources.binary_search(source).expect("no fewer");
        let child = unfaded.gaussians.opacities()[same];
        assert!(
            [own, child].contains(opacity),
            "{opacity}, of {own} and {child}"
        );
    }

    // None is replaced by centres, and the layer's state is the only fade that shows.
    let by_centres = settings.mode(Mode::Hard);
    let baked = bake_layer(&layer, &clip, &by_centres).expect("bakes");
    let camera = Camera::frame(&bounds, -DVec3::Y, 50.0, (64, 48)).expect("a view");
    let mut headless = common::headless();
    headless.load(Scene::from_iter([layer])).expect("uploads");
    let cut = drawn(&mut headless, &camera, &clip, Mode::Hard);
    let again = Layer::new("baked", &baked.gaussians).with(faded);
    headless.load(Scene::from_iter([again])).expect("uploads");
    let shown = drawn(&mut headless, &camera, &Clip::default(), Mode::None);
    assert!(cut.pixels.iter().any(|pixel| pixel[3] > 0.5));
    let apart = differences(&shown, &cut).expect("of one size");
    assert!(apart.max < 0.01, "{apart:?}");
    headless.close().expect("nothing to validate");
}
