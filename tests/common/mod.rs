//! What the tests share: scenes, views around them, planes through them, and a renderer under validation.
#![allow(dead_code, unreachable_pub, reason = "each test binary uses a part")]

use std::path::PathBuf;

use glam::DVec3;
use rara::scene::{Bounds, Kind, generate, load};
use rara::{Camera, Clip, ClipOp, Gaussians, Headless, HeadlessDesc, Plane};

/// A renderer whose every validation message is an error.
pub fn headless() -> Headless {
    let desc = HeadlessDesc {
        device: std::env::var("RARA_TEST_DEVICE").ok(),
        validation: true,
    };
    Headless::new(&desc)
        .expect("a Vulkan device and the validation layer (tools/test installs both)")
}

/// Where tools/test has put the decoded scenes, if it found any.
fn decoded_scenes() -> Option<PathBuf> {
    std::env::var_os("RARA_SCENES")
        .map(PathBuf::from)
        .filter(|folder| folder.is_dir())
}

/// The trained scenes, each under its name; says so loudly where they are absent.
pub fn trained_scenes() -> Vec<(String, Gaussians)> {
    let Some(folder) = decoded_scenes() else {
        eprintln!(
            "SKIPPED: no trained scenes here (RARA_SCENES names no folder); generated ones are still tested"
        );
        return Vec::new();
    };
    let layers = [
        "mni_0_envelope",
        "mni_1_grey_matter",
        "mni_2_white_matter",
        "mni_3_csf_ventricles",
    ];
    let mut scenes: Vec<(&str, Vec<&str>)> = vec![("mni_layers", layers.to_vec())];
    for name in [
        "playbot_L3",
        "leica_8192_inria",
        "skull",
        "heart",
        "hair_bear",
    ] {
        scenes.push((name, vec![name]));
    }
    scenes
        .iter()
        .map(|(name, files)| (name.to_string(), merged(&folder, files)))
        .collect()
}

fn merged(folder: &std::path::Path, files: &[&str]) -> Gaussians {
    let mut scene = Gaussians::default();
    for file in files {
        let path = folder.join(file).with_extension("ply");
        scene.append(
            &load(&path, &mut |_, _| {})
                .expect("a shared scene loads")
                .gaussians,
        );
    }
    scene
}

/// One generated scene of each kind.
pub fn generated_scenes(count: usize) -> Vec<(String, Gaussians)> {
    let kinds = [
        ("general", Kind::General),
        ("strands", Kind::Strands),
        ("layers", Kind::Layers),
    ];
    kinds
        .iter()
        .map(|(name, kind)| (format!("generated {name}"), generate(*kind, count, 1)))
        .collect()
}

/// `count` views around a scene, from changing heights.
pub fn views(scene: &Gaussians, count: usize, size: (u32, u32)) -> Vec<Camera> {
    let bounds = Bounds::of(scene);
    let centre = bounds.centre();
    let view = |index: usize| {
        let turn = index as f64 / count as f64 * std::f64::consts::TAU + 0.3;
        let height = [0.35, -0.2, 0.7][index % 3];
        let direction = DVec3::new(turn.cos(), -height, turn.sin()).normalize();
        let eye = centre + direction * bounds.radius() * 2.2;
        Camera::look_at(eye, centre, -DVec3::Y, 50.0, size).expect("a view from outside")
    };
    (0..count).map(view).collect()
}

/// `count` oblique planes through the middle of a scene that together leave a part of it.
pub fn clip(scene: &Gaussians, count: usize, op: ClipOp) -> Clip {
    let bounds = Bounds::of(scene);
    let normals = [
        DVec3::new(0.9, 0.3, 0.2),
        DVec3::new(-0.8, 0.1, 0.7),
        DVec3::new(0.1, -0.9, 0.3),
        DVec3::new(0.2, 0.8, -0.4),
        DVec3::new(-0.3, 0.2, -0.9),
        DVec3::new(0.5, 0.5, 0.6),
    ];
    let plane = |(index, normal): (usize, &DVec3)| {
        // The first through the centre, the others away from it, so that the intersection is not empty.
        let shift = if index == 0 {
            0.0
        } else {
            0.3 * bounds.radius()
        };
        Plane::new(
            *normal,
            -normal.dot(bounds.centre()) + shift * normal.length(),
        )
        .expect("a proper plane")
    };
    Clip {
        planes: normals.iter().take(count).enumerate().map(plane).collect(),
        op,
    }
}
