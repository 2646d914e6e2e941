//! The same picture by every path and in every run.

use crate::common;
use glam::DVec3;
use rara::scene::{Kind, generate};
use rara::{Camera, Clip, ClipOp, Headless, Mode, Picture, Plane, Raster, Settings};
use rara_lab::measure::differences;

const SIZE: (u32, u32) = (300, 220);

/// Largest difference of a channel, in units of 1/255.
fn apart(a: &Picture, b: &Picture) -> f32 {
    let pairs = a.pixels.iter().flatten().zip(b.pixels.iter().flatten());
    255.0 * pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

#[test]
fn quads_meshes_and_tiles_give_one_picture() {
    let mut headless = common::headless();
    let mut others = vec![Raster::Tiles];
    if headless.device().support().mesh_shader {
        others.push(Raster::Mesh);
    } else {
        eprintln!("SKIPPED: this device has no mesh shaders; tiles and quads are compared");
    }
    let scenes = common::generated_scenes(4_000).into_iter();
    for (name, scene) in scenes.chain(common::trained_scenes()) {
        headless.load(&scene).expect("uploads");
        let camera = common::views(&scene, 3, common::scaled(SIZE))[1];
        for (mode, planes, op) in [
            (Mode::None, 0, ClipOp::And),
            (Mode::Hard, 1, ClipOp::And),
            (Mode::Rara, 2, ClipOp::And),
            (Mode::Exact, 1, ClipOp::And),
            (Mode::Exact, 2, ClipOp::And),
            (Mode::Exact, 2, ClipOp::Or),
        ] {
            let clip = common::clip(&scene, planes, op);
            let mut picture = |raster| {
                let settings = Settings::default().mode(mode).raster(raster);
                headless.render(&camera, &clip, &settings).expect("renders");
                headless.picture().expect("reads back")
            };
            let quads = picture(Raster::Quad);
            for raster in &others {
                let worst = apart(&picture(*raster), &quads);
                assert!(
                    worst <= 1.0,
                    "{name}, {mode:?}, {planes} planes {op:?}: {raster:?} and quads differ by {worst:.3}/255"
                );
            }
        }
    }
}

/// The way in which a scene was rasterised when one way was asked for, and its picture.
fn drawn(
    headless: &mut Headless,
    (camera, clip, raster): (&Camera, &Clip, Raster),
) -> (&'static str, Picture) {
    let settings = Settings::default().raster(raster);
    let stats = headless.render(camera, clip, &settings).expect("renders");
    (stats.raster.path, headless.picture().expect("reads back"))
}

/// A picture with more rows of tiles than one scan takes at once and larger than what can be bound; then a small one in
/// the same buffers.
#[test]
fn a_wide_picture_of_many_tiles_is_that_of_quads() {
    let scene = generate(Kind::General, 2_000, 9);
    // At full scale there are more tiles than a row of workgroups has; on slow drivers there are as many rows, but
    // shorter ones.
    let width = (4101.0 * common::scale()) as u32;
    let camera = common::views(&scene, 1, (width, 2057))[0];
    let clip = common::clip(&scene, 1, ClipOp::And);
    let mut headless = common::headless();
    headless.load(&scene).expect("uploads");
    let (path, tiles) = drawn(&mut headless, (&camera, &clip, Raster::Tiles));
    assert_eq!(path, "tiles");
    let (_, quads) = drawn(&mut headless, (&camera, &clip, Raster::Quad));
    let worst = apart(&tiles, &quads);
    assert!(worst <= 1.0, "tiles and quads differ by {worst:.3}/255");
    let camera = common::views(&scene, 1, SIZE)[0];
    let mut fresh = headless.sharing().expect("another renderer");
    fresh.load(&scene).expect("uploads");
    let [after, alone] = [&mut headless, &mut fresh]
        .map(|headless| drawn(headless, (&camera, &clip, Raster::Tiles)).1);
    let worst = apart(&after, &alone);
    // The old buffers are large and reached by address, in shaders that are compiled separately and round differently.
    assert!(worst <= 1e-3, "{worst}/255 from a picture in new buffers");
}

/// Pictures of a pixel, a row, a column, and less than a tile.
#[test]
fn pictures_of_a_row_or_a_column_of_tiles_are_those_of_quads() {
    let scene = generate(Kind::General, 2_000, 9);
    let clip = common::clip(&scene, 1, ClipOp::And);
    let mut headless = common::headless();
    headless.load(&scene).expect("uploads");
    for size in [(1, 1), (1, 300), (300, 1), (5, 3), (2100, 7), (7, 2100)] {
        let camera = common::views(&scene, 1, size)[0];
        let [tiles, quads] = [Raster::Tiles, Raster::Quad]
            .map(|raster| drawn(&mut headless, (&camera, &clip, raster)).1);
        let worst = apart(&tiles, &quads);
        assert!(worst <= 1.0, "{size:?}: {worst:.3}/255");
    }
}

/// A frame must not depend on what an earlier one left, not even on the order of its splats when only one is left to
/// sort.
#[test]
fn a_lone_splat_after_many_is_itself() {
    let mut scene = generate(Kind::Layers, 8, 3);
    for index in 0..scene.len() {
        scene.positions_mut()[index] = glam::Vec3::new(index as f32 * 0.2 - 0.7, 0.0, 0.0);
    }
    let camera = common::views(&scene, 1, SIZE)[0];
    let mut reused = common::headless();
    reused.load(&scene).expect("uploads");
    for end in 0..8 {
        // Keeps the centres from `end` to `end`: each of the eight alone.
        let x = f64::from(scene.positions()[end].x);
        let keep = |sign: f64| Plane::new(sign * DVec3::X, 0.1 - sign * x).expect("a proper plane");
        let clip = Clip::of([keep(1.0), keep(-1.0)], ClipOp::And);
        let hard = Settings::default().mode(Mode::Hard);
        reused
            .render(&camera, &Clip::default(), &hard)
            .expect("renders");
        let stats = reused.render(&camera, &clip, &hard).expect("renders");
        assert_eq!(stats.counts.drawn, 1);
        let after_many = reused.picture().expect("reads back");
        let mut fresh = reused.sharing().expect("another renderer");
        fresh.load(&scene).expect("uploads");
        fresh.render(&camera, &clip, &hard).expect("renders");
        assert!(
            fresh.picture().expect("reads back") == after_many,
            "number {end}"
        );
    }
}

#[test]
fn splats_of_one_depth_keep_the_order_of_the_file() {
    let mut headless = common::headless();
    let mut scene = generate(Kind::General, 6_000, 3);
    let eye = DVec3::new(0.0, 0.0, -5.0);
    let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::NEG_Y, 50.0, SIZE).expect("a view");
    // One layer; a few, longer than a run of the sort; many, several of them in a run; pairs and threes.
    for layers in [1, 7, 200, 2500] {
        for (index, position) in scene.positions_mut().iter_mut().enumerate() {
            position.z = (index * 37 % layers) as f32 / 4096.0;
        }
        headless.load(&scene).expect("uploads");
        for raster in [Raster::Tiles, Raster::Quad] {
            let settings = Settings::default().raster(raster);
            let rendered = headless.render(&camera, &Clip::default(), &settings);
            rendered.expect("renders");
            let ours = headless.picture().expect("reads back");
            let truth = common::truth(&scene, &camera, &Clip::default(), &settings);
            let psnr = differences(&ours, &truth.picture).expect("one size").psnr;
            assert!(psnr > 90.0, "{layers} layers, {raster:?}: {psnr} dB");
        }
    }
}

/// The sort leaves out passes in which all keys agree; the box around all centres says how many passes there are at most.
#[test]
fn a_scene_with_a_wider_box_is_sorted_alike() {
    let mut headless = common::headless();
    let eye = DVec3::new(0.0, 0.0, -5.0);
    let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::NEG_Y, 50.0, SIZE).expect("a view");
    let scene = generate(Kind::General, 3_000, 4);
    // From one depth for all to depths that differ in three digits of a key and, around the eye, in four.
    for (thickness, shift) in [
        (0.0, 0.0),
        (1e-6, 0.0),
        (1e-3, 0.0),
        (1.0, 0.0),
        (4.0, -4.7),
    ] {
        let mut thin = scene.clone();
        for position in thin.positions_mut() {
            position.z = position.z * thickness + shift;
        }
        // One Gaussian that nobody sees: beside the others, behind them, and a long way behind.
        for raster in [Raster::Tiles, Raster::Quad] {
            let settings = Settings::default().raster(raster);
            let pictures = [0.0, 0.05, 5.0, 1e6].map(|behind| {
                thin.opacities_mut()[7] = 0.0;
                thin.positions_mut()[7] = glam::Vec3::new(0.0, 0.0, behind + shift);
                headless.load(&thin).expect("uploads");
                let rendered = headless.render(&camera, &Clip::default(), &settings);
                assert!(rendered.expect("renders").counts.drawn > 1000);
                headless.picture().expect("reads back")
            });
            let first = &pictures[0];
            assert!(
                pictures.iter().all(|picture| picture == first),
                "{thickness}, {raster:?}"
            );
        }
    }
}
