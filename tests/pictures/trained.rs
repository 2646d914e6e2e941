//! Gaussians that were trained antialiased, whose opacities make up for the low-pass, with another low-pass than that of 3DGS, or
//! in another order: against the reference, whole and cut.

use crate::common;
use rara::clip::Expression;
use rara::scene::{self, Kind};
use rara::{
    Camera, Clip, ClipOp, Gaussians, Headless, Layer, LayerState, Mode, Picture, Raster, Scene,
    Settings, SortBy, Training,
};

const SIZE: (u32, u32) = (64, 48);

/// Gaussians of less than a pixel, of about one and of many.
fn small_and_large() -> Gaussians {
    let mut scene = scene::generate(Kind::General, 900, 7);
    for (index, scale) in scene.scales_mut().iter_mut().enumerate() {
        *scale *= [0.03, 0.3, 1.0][index % 3];
    }
    scene.set_antialiased(true);
    scene
}

fn plain(scene: &Gaussians) -> Gaussians {
    let mut plain = scene.clone();
    plain.set_antialiased(false);
    plain
}

fn view(scene: &Gaussians) -> Camera {
    common::views(scene, 3, SIZE)[0]
}

fn of(expression: &str) -> Clip {
    let parsed = expression.parse::<Expression>();
    parsed.expect("an expression").clip()
}

fn drawn(headless: &mut Headless, camera: &Camera, clip: &Clip, settings: &Settings) -> Picture {
    headless.render(camera, clip, settings).expect("renders");
    headless.picture().expect("reads back")
}

fn light(picture: &Picture) -> f64 {
    picture.pixels.iter().map(|pixel| f64::from(pixel[3])).sum()
}

#[test]
fn antialiased_pictures_are_the_references() {
    agrees_with_the_reference(&small_and_large(), "antialiased");
}

#[test]
fn pictures_of_another_low_pass_are_the_references() {
    let mut scene = small_and_large();
    for training in [
        Training::default().antialiased(true).low_pass(0.1),
        Training::default().low_pass(0.03),
        Training::default().low_pass(2.0),
    ] {
        scene.set_training(training).expect("can be drawn");
        agrees_with_the_reference(&scene, &training.to_string());
    }
}

/// Compares pictures of every mode, and of several clips.
fn agrees_with_the_reference(scene: &Gaussians, name: &str) {
    let mut headless = common::headless();
    headless.load(scene).expect("uploads");
    let camera = view(scene);
    let rasters = common::rasters(headless.device());
    let mut check = |mode: Mode, raster: Raster, clip: &Clip, camera: &Camera| {
        let settings = Settings::default().mode(mode).raster(raster);
        let name = format!("{name} by {raster:?}");
        common::check(&mut headless, &name, scene, camera, clip, &settings);
    };
    let planes = |count: usize, op: ClipOp| common::clip(scene, count, op);
    let one = planes(1, ClipOp::And);
    let shapes = of("any(box:-0.4,0,0,0.3,0.3,0.3, !sphere:0.1,0,0,0.5)");
    for (mode, clip) in [
        (Mode::None, &Clip::default()),
        (Mode::Hard, &one),
        (Mode::Rara, &one),
        (Mode::Exact, &planes(3, ClipOp::Or)),
    ] {
        check(mode, Raster::Tiles, clip, &camera);
    }
    for raster in rasters {
        check(Mode::Exact, raster, &one, &camera);
        check(Mode::Exact, raster, &shapes, &camera);
    }
    let flat = common::flattened(&camera, scene);
    check(Mode::Exact, Raster::Tiles, &one, &flat);
}

/// The comparison above would hold too if nothing made up for anything on either side.
#[test]
fn small_splats_are_darker_antialiased() {
    let mut scene = small_and_large();
    scene
        .scales_mut()
        .iter_mut()
        .for_each(|scale| *scale *= 0.1);
    let camera = view(&scene);
    let mut headless = common::headless();
    let mut lights = [0.0; 2];
    for (scene, light_of) in [&scene, &plain(&scene)].into_iter().zip(&mut lights) {
        headless.load(scene).expect("uploads");
        *light_of = light(&drawn(
            &mut headless,
            &camera,
            &Clip::default(),
            &Settings::default(),
        ));
    }
    let [antialiased, plain] = lights;
    assert!(antialiased > 0.0 && antialiased < 0.3 * plain, "{lights:?}");
}

/// A scene may have layers of both kinds, each of which is drawn as it was trained.
#[test]
fn layers_are_antialiased_one_by_one() {
    let whole = small_and_large();
    let half = |parity: usize| common::picked(&whole, (parity..whole.len()).step_by(2));
    let (mut antialiased, plain) = (half(0), plain(&half(1)));
    let training = antialiased.training().low_pass(0.1);
    antialiased.set_training(training).expect("can be drawn");
    let camera = view(&whole);
    let clip = common::clip(&whole, 1, ClipOp::And);
    let mut headless = common::headless();
    let mixed = |visible: bool| {
        let layer = Layer::new("antialiased", &antialiased);
        let layer = layer.with(LayerState::default().visible(visible));
        Scene::from_iter([layer, Layer::new("plain", &plain)])
    };
    for raster in common::rasters(headless.device()) {
        let settings = Settings::default().raster(raster);
        headless.load(mixed(true)).expect("uploads");
        let picture = drawn(&mut headless, &camera, &clip, &settings);
        let truth = rara_reference::render::<f64>(mixed(true), &camera, &clip, &settings);
        common::assert_agrees("mixed layers", &picture, &truth.picture);
        // The layer that is not antialiased is drawn to the bit as it is in a scene without any that is.
        headless.load(mixed(false)).expect("uploads");
        let beside = drawn(&mut headless, &camera, &clip, &settings);
        headless.load(&plain).expect("uploads");
        let alone = drawn(&mut headless, &camera, &clip, &settings);
        assert!(beside.pixels == alone.pixels, "{raster:?}");
    }
}

/// A frame after a moved clip takes over what does not depend on it.
#[test]
fn moved_clips_leave_the_same_antialiased_pictures() {
    let scene = small_and_large();
    let camera = view(&scene);
    let mut headless = common::headless();
    headless.load(&scene).expect("uploads");
    let clips = [0.0, 0.05, 0.2].map(|by| of(&format!("plane:0.9,0.3,0.2,{by}")));
    for raster in [Raster::Tiles, Raster::Quad] {
        let settings = Settings::default().raster(raster);
        let kept = clips
            .each_ref()
            .map(|clip| drawn(&mut headless, &camera, clip, &settings));
        for (clip, kept) in clips.iter().zip(kept) {
            headless.forget();
            let whole = drawn(&mut headless, &camera, clip, &settings);
            assert!(kept.pixels == whole.pixels, "{raster:?} {clip:?}");
        }
    }
}

/// Splats in the order of their distance from the eye, by the setting and by what all layers ask for.
#[test]
fn splats_in_the_order_of_distance_are_the_references() {
    let mut scene = small_and_large();
    let mut headless = common::headless();
    headless.load(&scene).expect("uploads");
    let camera = common::views(&scene, 3, SIZE)[1];
    let camera = camera.fx(0.4 * camera.fx).fy(0.4 * camera.fy); // wide: the orders differ most at the edges
    let clip = common::clip(&scene, 1, ClipOp::And);
    let by_distance = Settings::default().sort_by(Some(SortBy::Distance));
    for raster in common::rasters(headless.device()) {
        let settings = by_distance.raster(raster);
        for (mode, clip) in [(Mode::None, &Clip::default()), (Mode::Exact, &clip)] {
            let settings = settings.mode(mode);
            let name = format!("by distance by {raster:?}");
            common::check(&mut headless, &name, &scene, &camera, clip, &settings);
        }
    }
    let usual = Settings::default();
    let depth = drawn(&mut headless, &camera, &clip, &usual);
    let distance = drawn(&mut headless, &camera, &clip, &by_distance);
    assert!(
        depth.pixels != distance.pixels,
        "the orders do not differ here"
    );
    // Parallel lines of sight have no eye.
    let flat = common::flattened(&camera, &scene);
    let [one, other] = [&usual, &by_distance].map(|by| drawn(&mut headless, &flat, &clip, by));
    assert!(one.pixels == other.pixels);

    let plain = scene.clone();
    let training = scene.training().sort_by(SortBy::Distance);
    scene.set_training(training).expect("can be drawn");
    headless.load(&scene).expect("uploads");
    let asked = drawn(&mut headless, &camera, &clip, &usual);
    assert!(asked.pixels == distance.pixels, "the scene asks for it");
    let by_depth = usual.sort_by(Some(SortBy::Depth));
    let other = drawn(&mut headless, &camera, &clip, &by_depth);
    assert!(other.pixels == depth.pixels, "the setting comes first");
    for (visible, expected) in [(true, SortBy::Depth), (false, SortBy::Distance)] {
        let hidden = Layer::new("plain", &plain).with(LayerState::default().visible(visible));
        headless
            .load(Scene::from_iter([Layer::new("asks", &scene), hidden]))
            .expect("uploads");
        let found = drawn(&mut headless, &camera, &clip, &usual);
        let expected = usual.sort_by(Some(expected));
        let expected = drawn(&mut headless, &camera, &clip, &expected);
        assert!(found.pixels == expected.pixels, "visible: {visible}");
    }
}
