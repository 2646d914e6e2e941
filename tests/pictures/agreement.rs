//! The renderer against the f64 reference, picture by picture, on trained and generated scenes.

use glam::DQuat;

use crate::common;
use rara::clip::Inside;
use rara::gpu::Bindings;
use rara::scene::Bounds;
use rara::{Clip, ClipOp, Gaussians, Mesh, MeshRule, Mode, Placement, Raster, Settings};
use rara_scene::mesh::shapes;

/// Small enough for the suite, and not a multiple of any workgroup.
const SIZE: (u32, u32) = (253, 190);
/// One from each of the heights.
const VIEWS: usize = 3;

fn check_scenes(scenes: Vec<(String, Gaussians)>, mode: Mode, clips: &[(usize, ClipOp)]) {
    check_scenes_by(Bindings::Mixed, scenes, VIEWS, &[(mode, clips)]);
}

fn check_scenes_by(
    bindings: Bindings,
    scenes: Vec<(String, Gaussians)>,
    views: usize,
    modes: &[(Mode, &[(usize, ClipOp)])],
) {
    let mut headless = common::headless_by(bindings);
    for (name, scene) in scenes {
        headless.load(&scene).expect("uploads");
        for camera in common::views(&scene, views, common::scaled(SIZE)) {
            for (mode, clips) in modes {
                let settings = Settings::default().mode(*mode);
                for (planes, op) in *clips {
                    let clip = common::clip(&scene, *planes, *op);
                    common::check(&mut headless, &name, &scene, &camera, &clip, &settings);
                }
            }
        }
    }
}

const CLIPS: [(usize, ClipOp); 4] = [
    (1, ClipOp::And),
    (2, ClipOp::And),
    (2, ClipOp::Or),
    (6, ClipOp::And),
];

/// Every mode with these clips; where nothing is clipped one does.
fn modes(clips: &[(usize, ClipOp)]) -> [(Mode, &[(usize, ClipOp)]); 4] {
    [
        (Mode::None, &clips[..1]),
        (Mode::Hard, clips),
        (Mode::Rara, clips),
        (Mode::Exact, clips),
    ]
}

#[test]
fn none_on_trained_scenes() {
    check_scenes(common::trained_scenes(), Mode::None, &[(0, ClipOp::And)]);
}

#[test]
fn hard_on_trained_scenes() {
    check_scenes(common::trained_scenes(), Mode::Hard, &CLIPS[..2]);
}

#[test]
fn rara_on_trained_scenes() {
    check_scenes(common::trained_scenes(), Mode::Rara, &CLIPS);
}

#[test]
fn exact_on_trained_scenes() {
    check_scenes(common::trained_scenes(), Mode::Exact, &CLIPS);
}

/// Splats as thin as paper, as long as needles and smaller than pixels, cut by faces of about their size and by tall walls.
#[test]
fn meshes_on_trained_scenes() {
    let mut headless = common::headless();
    let shapes = [shapes::torus(40, 20), shapes::prism(24, 50.0)];
    let meshes = shapes
        .map(|(vertices, faces)| Mesh::from_triangles(&vertices, &faces, MeshRule::Closed))
        .map(|mesh| mesh.expect("a closed mesh"));
    for (name, scene) in common::trained_scenes() {
        headless.load(&scene).expect("uploads");
        let bounds = Bounds::of(&scene);
        for camera in common::views(&scene, 1, common::scaled((96, 72))) {
            for mesh in &meshes {
                let size = 0.4 * bounds.radius();
                let there =
                    Placement::new(bounds.centre(), DQuat::IDENTITY, size).expect("a place");
                let clip = Clip::of([Inside::new(mesh.clone(), there)], ClipOp::And);
                let settings = Settings::default();
                common::check(&mut headless, &name, &scene, &camera, &clip, &settings);
            }
        }
    }
}

#[test]
fn every_mode_on_generated_scenes() {
    let scenes = common::generated_scenes(5_000);
    check_scenes_by(Bindings::Mixed, scenes, VIEWS, &modes(&CLIPS));
}

/// A CPU driver gets tiles by default, and a GPU gets draws.
#[test]
fn every_mode_by_quads() {
    let mut headless = common::headless();
    let mut scenes = common::generated_scenes(5_000);
    scenes.extend(common::trained_scenes());
    for (name, scene) in scenes {
        headless.load(&scene).expect("uploads");
        for camera in common::views(&scene, 2, common::scaled(SIZE)) {
            for (mode, planes) in [
                (Mode::None, 0),
                (Mode::Hard, 1),
                (Mode::Rara, 1),
                (Mode::Exact, 1),
                (Mode::Exact, 6),
            ] {
                let clip = common::clip(&scene, planes, ClipOp::And);
                let settings = Settings::default().mode(mode).raster(Raster::Quad);
                common::check(&mut headless, &name, &scene, &camera, &clip, &settings);
            }
        }
    }
}

/// The other tests reach buffers as users of CPU drivers do.
#[test]
fn every_mode_by_addresses() {
    let scenes = common::generated_scenes(5_000);
    check_scenes_by(Bindings::Address, scenes, 1, &modes(&CLIPS[2..]));
}

/// As under `--validation`.
#[test]
fn exact_by_bound_buffers() {
    let scenes = common::generated_scenes(5_000);
    check_scenes_by(Bindings::Bound, scenes, 1, &[(Mode::Exact, &CLIPS[1..2])]);
}
