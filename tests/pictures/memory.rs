//! The memory that a scene takes on the device, and while it is uploaded.

use crate::common;
use rara::scene::{Kind, generate};
use rara::{Gaussians, Preset, ShFormat};

/// A scene of degree 3, without numbers that a shorter format could leave out.
fn scene(count: usize) -> Gaussians {
    let mut scene = generate(Kind::General, count, 1);
    scene.set_sh_degree(3);
    for (index, number) in scene.sh_mut().iter_mut().enumerate() {
        *number += (index % 97) as f32 * 1e-3;
    }
    scene
}

#[test]
fn a_gaussian_of_degree_3_takes_at_most_120_bytes_in_the_default_preset() {
    let mut headless = common::headless();
    let mut scene = scene(10_000);
    let mut bytes = |scene: &Gaussians, format| {
        headless.load_as(scene, format).expect("uploads");
        headless.scene_bytes() as f64 / scene.len() as f64
    };
    // A block of 256 has 48 bytes, and the last one is not full.
    let blocks = 0.193;
    for (preset, most) in [
        (Preset::Exact, 240.0 + blocks),
        (Preset::Balanced, 120.0),
        (Preset::Fast, 120.0),
    ] {
        let taken = bytes(&scene, preset.precision().sh);
        assert!(taken <= most, "{preset:?}: {taken} bytes a Gaussian");
    }
    for (degree, most) in [(2, 88.0), (1, 68.0), (0, 56.0)] {
        scene.set_sh_degree(degree);
        let taken = bytes(&scene, ShFormat::Packed);
        assert!(
            taken <= most + blocks,
            "degree {degree}: {taken} bytes a Gaussian"
        );
    }
}

#[test]
fn an_upload_holds_a_bounded_chunk_beside_the_scene() {
    let scene = scene((250_000.0 * common::scale()) as usize);
    for format in [ShFormat::Float, ShFormat::Packed] {
        let mut headless = common::headless();
        let before = headless.device_bytes();
        headless.load_as(&scene, format).expect("uploads");
        let most = headless.device().peak_device_bytes();
        let beside = most - before - headless.scene_bytes();
        assert!(
            beside <= (32 << 20) + (1 << 20),
            "{format:?}: {beside} bytes beside the scene's {}",
            headless.scene_bytes()
        );
        assert_eq!(headless.device_bytes() - before, headless.scene_bytes());
    }
}
