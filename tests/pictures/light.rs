//! Gaussians whose colours are linear light, and Gaussians that may cover a pixel wholly, as `KHR_gaussian_splatting` has them:
//! by closed forms, and against the reference.

use crate::common;
use glam::{DVec3, Quat, Vec3};
use rara::clip::Expression;
use rara::scene::{self, Kind};
use rara::{
    Camera, Clip, Error, Gaussians, Headless, Layer, Mode, Picture, Precision, Raster, Scene,
    Settings, Show, TargetFormat, Training,
};
use rara_lab::measure::differences;

const SIZE: (u32, u32) = (64, 48);
/// The spherical harmonic of degree 0.
const SH_0: f32 = 0.282_094_8;

fn khr() -> Training {
    Training::default().alpha_max(1.0)
}

/// A splat in the middle that covers many pixels.
fn one(opacity: f32, colour: [f32; 3], training: Training) -> Gaussians {
    let mut one = Gaussians::default();
    let sh = colour.map(|value| (value - 0.5) / SH_0);
    one.push(Vec3::ZERO, Vec3::splat(10.0), Quat::IDENTITY, opacity, &sh);
    one.set_training(training).expect("it can be drawn");
    one
}

fn camera() -> Camera {
    let camera = Camera::look_at(
        DVec3::new(0.0, 0.0, -20.0),
        DVec3::ZERO,
        -DVec3::Y,
        50.0,
        SIZE,
    );
    camera.expect("a view")
}

fn drawn(headless: &mut Headless, camera: &Camera, clip: &Clip, settings: &Settings) -> Picture {
    headless.render(camera, clip, settings).expect("renders");
    headless.picture().expect("reads back")
}

fn middle(picture: &Picture) -> [f32; 4] {
    picture.at(SIZE.0 / 2, SIZE.1 / 2)
}

fn assert_near(found: [f32; 4], expected: [f32; 4], what: &str) {
    let apart = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
    assert!(
        apart.fold(0.0, f32::max) < 2e-3,
        "{what}: {found:?}, not {expected:?}"
    );
}

#[test]
fn linear_light_is_blended_as_such_and_stored_once() {
    let mut headless = common::headless();
    let (red, blue) = ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
    for raster in [Raster::Tiles, Raster::Quad] {
        let plain = Settings::default().raster(raster);
        for (linear, on_blue, share) in [(true, 0.735_357, 0.5), (false, 0.5, 0.5)] {
            headless
                .load(&one(0.5, red, khr().linear(linear)))
                .expect("uploads");
            let what = format!("{raster:?}, linear {linear}");
            let alone = drawn(&mut headless, &camera(), &Clip::default(), &plain);
            // Alone it is its own colour, premultiplied.
            assert_near(middle(&alone), [share, 0.0, 0.0, 0.5], &what);
            let settings = plain.background(Some(blue));
            let on = drawn(&mut headless, &camera(), &Clip::default(), &settings);
            assert_near(middle(&on), [on_blue, 0.0, on_blue, 1.0], &what);
            // A background that shows through is what it was, whatever it has been meanwhile.
            let grey = plain.background(Some([0.4, 0.5, 0.001]));
            let corner = drawn(
                &mut headless,
                &camera().eye(DVec3::new(0.0, 0.0, 99.0)),
                &Clip::default(),
                &grey,
            );
            assert_near(corner.at(0, 0), [0.4, 0.5, 0.001, 1.0], &what);
        }
        // Half of the light of grey is not half of grey, and of few bits it is not darker.
        let grey = one(1.0, [0.214_041, 0.001, 0.0], khr().linear(true));
        headless.load(&grey).expect("uploads");
        let few = plain.precision(Precision::default().target(TargetFormat::Unorm8));
        for settings in [plain, few] {
            let picture = drawn(&mut headless, &camera(), &Clip::default(), &settings);
            assert_near(middle(&picture), [0.5, 0.012_92, 0.0, 1.0], "grey");
        }
        // Views of other things than colours are no light.
        if raster == Raster::Tiles {
            let weights = drawn(
                &mut headless,
                &camera(),
                &Clip::default(),
                &plain.show(Show::Weight),
            );
            assert_near(middle(&weights), [0.25, 0.45, 0.9, 1.0], "weights");
        }
    }
    headless.close().expect("no validation messages");
}

#[test]
fn lights_are_not_mixed() {
    let mut headless = common::headless();
    let [linear, stored] = [true, false].map(|linear| one(0.5, [1.0; 3], khr().linear(linear)));
    let both = [Layer::new("light", &linear), Layer::new("paint", &stored)];
    let error = headless
        .load(Scene::from_iter(both))
        .expect_err("two lights");
    assert!(
        matches!(&error, Error::Invalid(text) if text.contains("'light'") && text.contains("'paint'")),
        "{error}"
    );
    // A layer of nothing has no light.
    let nothing = Gaussians::default();
    let both = [
        Layer::new("light", &linear),
        Layer::new("nothing", &nothing),
    ];
    headless.load(Scene::from_iter(both)).expect("uploads");
    headless.close().expect("no validation messages");
}

/// 3DGS leaves a hundredth of what is behind, and glTF nothing.
#[test]
fn what_is_opaque_covers_a_pixel_as_its_format_has_it() {
    let mut headless = common::headless();
    for raster in [Raster::Tiles, Raster::Quad] {
        let settings = Settings::default().raster(raster);
        for (training, alpha) in [(khr(), 1.0), (Training::default(), 0.99)] {
            headless
                .load(&one(1.0, [0.5; 3], training))
                .expect("uploads");
            let picture = drawn(&mut headless, &camera(), &Clip::default(), &settings);
            let [.., found] = middle(&picture);
            assert!(
                (found - alpha).abs() < 1e-3,
                "{raster:?}: {found}, not {alpha}"
            );
        }
    }
    // With one layer of 3DGS the scene is drawn as 3DGS draws.
    let [khr, of_3dgs] = [khr(), Training::default()].map(|training| one(1.0, [0.5; 3], training));
    let empty = Gaussians::default();
    for (other, alpha) in [(&khr, 1.0), (&of_3dgs, 0.9999), (&empty, 0.999_62)] {
        let both = [Layer::new("first", &khr), Layer::new("second", other)];
        headless.load(Scene::from_iter(both)).expect("uploads");
        let picture = drawn(
            &mut headless,
            &camera(),
            &Clip::default(),
            &Settings::default(),
        );
        assert!(
            (middle(&picture)[3] - alpha).abs() < 2e-5,
            "{:?}",
            middle(&picture)
        );
    }
    headless.close().expect("no validation messages");
}

/// Opaque and linear, whole and cut: in each way of drawing the picture of the reference.
#[test]
fn pictures_of_khr_are_the_references() {
    let mut headless = common::headless();
    let mut scene = scene::generate(Kind::General, 900, 7);
    scene
        .opacities_mut()
        .iter_mut()
        .step_by(2)
        .for_each(|opacity| *opacity = 1.0);
    scene
        .set_training(khr().linear(true))
        .expect("it can be drawn");
    headless.load(&scene).expect("uploads");
    let camera = common::views(&scene, 3, SIZE)[0];
    let cut = |text: &str| text.parse::<Expression>().expect("an expression").clip();
    for clip in [
        Clip::default(),
        cut("plane:1,0.2,0.1,0"),
        cut("sphere:0,0,0,0.5"),
    ] {
        for mode in [Mode::Exact, Mode::Hard] {
            for background in [None, Some([0.2, 0.4, 0.9])] {
                for raster in [Raster::Tiles, Raster::Quad] {
                    let settings = Settings::default()
                        .mode(mode)
                        .raster(raster)
                        .background(background);
                    let ours = drawn(&mut headless, &camera, &clip, &settings);
                    let truth = rara_reference::render::<f64>(&scene, &camera, &clip, &settings);
                    let apart = differences(&ours, &truth.picture).expect("the same size");
                    assert!(
                        apart.l1 < 0.02 && apart.max < 6.0,
                        "{mode:?} {raster:?}: {apart:?}"
                    );
                    assert!(ours.pixels.iter().flatten().all(|value| value.is_finite()));
                }
            }
        }
    }
    headless.close().expect("no validation messages");
}
