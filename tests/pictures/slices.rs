//! What tiles show beside colours and weights: how many splats make a pixel, and the mean of their colours, which makes slices
//! of cross-sections.

use crate::common;
use glam::{DQuat, DVec3, Quat, Vec3};
use rara::clip::Expression;
use rara::scene::{Bounds, Kind, cross_section, generate};
use rara::{
    Aov, Camera, Clip, ClipOp, Gaussians, Layer, LayerState, Mode, Placement, Plane, Raster, Scene,
    Settings, Show,
};

#[test]
fn counts_and_means_are_the_references() {
    let mut headless = common::headless();
    let scene = generate(Kind::General, 2_000, 3);
    headless.load(&scene).expect("uploads");
    for camera in common::views(&scene, 2, common::scaled((125, 94))) {
        for (mode, planes) in [(Mode::Exact, 2), (Mode::Rara, 1), (Mode::None, 0)] {
            let clip = common::clip(&scene, planes, ClipOp::And);
            let settings = Settings::default().mode(mode);
            let mean = settings.show(Show::Mean);
            common::check(&mut headless, "means", &scene, &camera, &clip, &mean);
            let count = settings.show(Show::Count);
            headless.render(&camera, &clip, &count).expect("renders");
            let ours = headless.picture().expect("reads back");
            let truth = rara_reference::render::<f64>(&scene, &camera, &clip, &count).picture;
            let pairs = ours.pixels.iter().zip(&truth.pixels);
            // A splat may be at its threshold of alpha, or a pixel at that of saturation.
            let apart = pairs
                .filter(|(ours, truth)| (ours[0] - truth[0]).abs() > 0.5)
                .count();
            assert!(
                apart * 500 <= truth.pixels.len(),
                "{apart} pixels count others"
            );
            assert!(
                truth.pixels.iter().any(|pixel| pixel[0] > 20.0),
                "many in one pixel"
            );
        }
    }
}

#[test]
fn only_tiles_count() {
    let scene = generate(Kind::General, 10, 3);
    let camera = common::views(&scene, 1, (32, 32))[0];
    let mut headless = common::headless();
    headless.load(&scene).expect("uploads");
    let settings = Settings::default().show(Show::Count).raster(Raster::Quad);
    let error = headless.render(&camera, &Clip::default(), &settings);
    let error = error.expect_err("quads cannot").to_string();
    assert!(error.contains("only tiles can draw"), "{error}");
}

/// Two layers of large splats, of which one is placed, against sums over the splats at each pixel's point of the plane.
#[test]
fn a_slice_has_the_mean_colour_of_what_lies_on_the_plane() {
    let splats = |seed: u64| {
        let from = generate(Kind::General, 40, seed);
        let mut large = Gaussians::default();
        for index in 0..from.len() {
            let scale = from.scales()[index].max(Vec3::splat(0.1));
            let (at, turn) = (from.positions()[index], from.rotations()[index]);
            let colour = [0.5, -0.3, 0.1].map(|c: f32| c * index as f32 / 40.0);
            large.push(at, scale, turn, from.opacities()[index], &colour);
        }
        large
    };
    let sets = [splats(3), splats(4)];
    let placed = Placement::new(DVec3::new(0.3, 0.1, 0.0), DQuat::from_rotation_x(0.7), 1.5);
    let states = [
        LayerState::default(),
        LayerState::default()
            .placement(placed.expect("a placement"))
            .opacity(0.6),
    ];
    let plane = Plane::new(DVec3::new(0.3, 0.2, 1.0), 0.1).expect("a normal");
    let kept = "!sphere:0.2,0.1,-0.1,0.4"
        .parse::<Expression>()
        .expect("a shape")
        .clip();
    let bounds = Bounds {
        min: DVec3::NEG_ONE,
        max: DVec3::ONE,
    };
    let camera = Camera::facing(&plane, &bounds, -DVec3::Y, (120, 90)).expect("a view");

    let flat: Vec<Gaussians> = sets
        .iter()
        .zip(&states)
        .map(|(set, state)| cross_section(set, &plane.in_scene(&state.placement)))
        .collect();
    let layers = flat
        .iter()
        .zip(states)
        .map(|(flat, state)| Layer::new("a layer", flat).with(state));
    let scene: Scene<'_> = layers.collect();
    let mut headless = common::headless();
    headless.load(&scene).expect("uploads");
    let settings = Settings::default().show(Show::Mean);
    headless.render(&camera, &kept, &settings).expect("renders");
    let slice = headless.picture().expect("reads back");

    let mut compared = 0;
    for (at, pixel) in slice.pixels.iter().enumerate() {
        let (x, y) = ((at % 120) as f64 + 0.5, (at / 120) as f64 + 0.5);
        let seen = DVec3::new(
            (x - camera.cx) / camera.fx,
            (y - camera.cy) / camera.fy,
            0.0,
        );
        let point = camera.eye + camera.rotation.transpose() * seen;
        let point = point - plane.normal() * plane.distance(point);
        // A pixel at the edge of what is kept shows some of both sides.
        let from_edge = (point - DVec3::new(0.2, 0.1, -0.1)).length() - 0.4;
        if from_edge.abs() < 0.06 {
            continue;
        }
        let (mut sum, mut total, mut left) = (DVec3::ZERO, 0.0, 1.0);
        for (set, state) in sets.iter().zip(&states).filter(|_| from_edge > 0.0) {
            let inside = state.placement.to_scene(point);
            for index in 0..set.len() {
                let turn: Quat = set.rotations()[index];
                let apart = inside - set.positions()[index].as_dvec3();
                let unit = turn.as_dquat().inverse() * apart / set.scales()[index].as_dvec3();
                let opacity = f64::from(set.opacities()[index] * state.opacity);
                let alpha = (opacity * (-0.5 * unit.length_squared()).exp()).min(0.99);
                let colour = Vec3::from_slice(&set.sh_of(index)[..3]) * 0.282_094_8 + 0.5;
                sum += alpha * colour.as_dvec3();
                total += alpha;
                left *= 1.0 - alpha;
            }
        }
        let truth = sum / f64::max(total, 1e-9) * (1.0 - left);
        let ours = Vec3::from_slice(&pixel[..3]).as_dvec3();
        // What is fainter than 1/255 is not drawn, and the low-pass widens each splat by a half of a pixel's width.
        assert!(
            (ours - truth).abs().max_element() < 0.03,
            "{at}: {ours} and {truth}"
        );
        compared += usize::from(total > 0.1);
    }
    assert!(compared > 2_000, "{compared}");
}

#[test]
fn channels_name_layers_and_count_splats() {
    let ball = |x: f32, colour: f32| {
        let mut ball = Gaussians::default();
        for _ in 0..3 {
            ball.push(
                Vec3::X * x,
                Vec3::splat(0.2),
                Quat::IDENTITY,
                0.5,
                &[colour; 3],
            );
        }
        ball
    };
    let balls: Vec<Gaussians> = (0..5).map(|n| ball(n as f32 - 2.0, 0.3)).collect();
    let layers = balls.iter().map(|ball| Layer::new("a ball", ball));
    let scene: Scene<'_> = layers.collect();
    let camera = Camera::orthographic(-5.0 * DVec3::Z, DVec3::ZERO, -DVec3::Y, 4.0, (100, 80));
    let camera = camera.expect("a view");
    let mut headless = common::headless();
    headless.load(&scene).expect("uploads");
    let frame = (&camera, &Clip::default(), &Settings::default());
    headless.render(frame.0, frame.1, frame.2).expect("renders");
    let before = headless.picture().expect("reads back");
    let aovs = [Aov::Layer, Aov::Count, Aov::Layer];
    let channels = headless.channels(&aovs, frame).expect("draws");
    let names: Vec<&str> = channels
        .iter()
        .map(|channel| channel.name.as_str())
        .collect();
    assert_eq!(names, ["layer", "count"]);
    for number in 0..5 {
        let x = (camera.cx + camera.fx * (number as f64 - 2.0)) as usize;
        let at = 40 * 100 + x;
        assert_eq!(channels[0].values[at], number as f32, "pixel {x}");
        assert_eq!(channels[1].values[at], 3.0, "pixel {x}");
    }
    let nothing = 0;
    assert_eq!(
        (channels[0].values[nothing], channels[1].values[nothing]),
        (-1.0, 0.0)
    );
    // The scene is as it was.
    headless.render(frame.0, frame.1, frame.2).expect("renders");
    assert_eq!(headless.picture().expect("reads back"), before);
}
