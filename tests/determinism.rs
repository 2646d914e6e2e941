//! The same picture by every path and in every run.

mod common;

use std::path::Path;
use std::process::Command;

use glam::DVec3;
use rara::scene::{Kind, generate};
use rara::{Clip, ClipOp, Mode, Plane, Raster, Settings};

const SIZE: (u32, u32) = (300, 220);

#[test]
fn mesh_and_quad_paths_agree() {
    let mut headless = common::headless();
    if !headless.device().support().mesh_shader {
        eprintln!("SKIPPED: this device has no mesh shaders");
        return;
    }
    for (name, scene) in common::generated_scenes(4_000)
        .into_iter()
        .chain(common::trained_scenes())
    {
        headless.load(&scene).expect("uploads");
        for mode in [Mode::None, Mode::Rara, Mode::Exact] {
            let clip = common::clip(&scene, 2, ClipOp::And);
            let camera = common::views(&scene, 3, common::scaled(SIZE))[1];
            let mut picture = |raster| {
                let settings = Settings {
                    mode,
                    raster,
                    ..Settings::default()
                };
                headless.render(&camera, &clip, &settings).expect("renders");
                headless.picture().expect("reads back")
            };
            let (mesh, quad) = (picture(Raster::Mesh), picture(Raster::Quad));
            let apart = |(a, b): (&[f32; 4], &[f32; 4])| {
                a.iter()
                    .zip(b)
                    .map(|(a, b)| (a - b).abs())
                    .fold(0.0, f32::max)
            };
            let worst = mesh
                .pixels
                .iter()
                .zip(&quad.pixels)
                .map(apart)
                .fold(0.0, f32::max);
            assert!(
                worst <= 1.0 / 255.0,
                "{name}, {mode:?}: mesh and quad differ by {:.3}/255",
                worst * 255.0
            );
        }
    }
}

/// A frame must not see what an earlier one left: not even the order of its splats when only one is left to sort.
#[test]
fn a_lone_survivor_after_many_is_itself() {
    let mut scene = generate(Kind::Layers, 8, 3);
    for index in 0..scene.len() {
        scene.positions[index] = glam::Vec3::new(index as f32 * 0.2 - 0.7, 0.0, 0.0);
    }
    let camera = common::views(&scene, 1, SIZE)[0];
    let mut reused = common::headless();
    reused.load(&scene).expect("uploads");
    for end in 0..8 {
        // Keeps the centres from `end` to `end`: each of the eight alone.
        let x = f64::from(scene.positions[end].x);
        let keep = |sign: f64| Plane::new(sign * DVec3::X, 0.1 - sign * x).expect("a proper plane");
        let clip = Clip {
            planes: vec![keep(1.0), keep(-1.0)],
            op: ClipOp::And,
        };
        let hard = Settings {
            mode: Mode::Hard,
            ..Settings::default()
        };
        reused
            .render(&camera, &Clip::default(), &hard)
            .expect("renders");
        let stats = reused.render(&camera, &clip, &hard).expect("renders");
        assert_eq!(stats.counts.drawn, 1);
        let after_many = reused.picture().expect("reads back");
        let mut fresh = common::headless();
        fresh.load(&scene).expect("uploads");
        fresh.render(&camera, &clip, &hard).expect("renders");
        assert!(
            fresh.picture().expect("reads back") == after_many,
            "number {end}"
        );
    }
}

#[test]
fn every_run_with_any_number_of_driver_threads_gives_the_same_bytes() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let scene = folder.join("determinism.ply");
    let rara = || Command::new(env!("CARGO_BIN_EXE_rara"));
    let status = rara()
        .args(["generate", "general", "-n", "20000", "--seed", "7", "-o"])
        .arg(&scene)
        .status();
    assert!(status.expect("rara runs").success());
    let render = |run: usize, threads: &str| {
        let out = folder.join(format!("determinism-{run}.exr"));
        let mut command = rara();
        command
            .env("LP_NUM_THREADS", threads)
            .arg("render")
            .arg(&scene)
            .arg("-o")
            .arg(&out);
        command.args([
            "--size",
            "300x220",
            "--clip",
            "plane:1,0.2,0.1,0",
            "--validation",
        ]);
        if let Ok(device) = std::env::var("RARA_TEST_DEVICE") {
            command.args(["--device", &device]);
        }
        assert!(command.status().expect("rara runs").success());
        std::fs::read(out).expect("the picture was written")
    };
    let first = render(0, "1");
    for (run, threads) in ["1", "2", "3", "8"].iter().enumerate() {
        assert!(
            render(run + 1, threads) == first,
            "{threads} driver threads give other bytes than one"
        );
    }
}
