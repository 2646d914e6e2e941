//! A scene that is mirrored for good has the mirror image for its picture.

use glam::{DAffine3, DVec3};
use rara::scene::{Kind, generate};
use rara::{Camera, Clip, ClipOp, Gaussians, Picture, Plane, Settings};
use rara_lab::measure::differences;

use super::{SIZE, draw};
use crate::common;

/// Elongated Gaussians whose colours depend much on the direction.
fn scene() -> Gaussians {
    let mut scene = generate(Kind::Strands, 2000, 3);
    scene.set_sh_degree(3);
    let mut number = 0_u32;
    scene.sh_mut().fill_with(|| {
        number = number.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        number as f32 / u32::MAX as f32 - 0.5
    });
    scene
}

/// The picture with its left on the right.
fn flipped(picture: &Picture) -> Picture {
    let mut flipped = picture.clone();
    for row in flipped.pixels.chunks_exact_mut(picture.width as usize) {
        row.reverse();
    }
    flipped
}

#[test]
fn a_mirrored_scene_is_its_mirror_image() {
    let mut headless = common::headless();
    let scene = scene();
    let mut mirrored = scene.clone();
    assert!(
        mirrored
            .transform(&DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0)))
            .is_empty()
    );
    // Seen along z from the middle, where x and the mirrored one are equally far from the sides.
    let camera = Camera::look_at(
        DVec3::new(0.0, 0.3, -3.0),
        DVec3::ZERO,
        -DVec3::Y,
        50.0,
        SIZE,
    );
    let camera = camera.expect("a view");
    let plane = |x: f64| Plane::new(DVec3::new(x, 0.5, -0.3), 0.1).expect("a normal");
    for planes in [[None; 2], [0.8, -0.8].map(|x| Some(plane(x)))] {
        let [clip, mirrored_clip] = planes.map(|plane| Clip::of(plane, ClipOp::And));
        let settings = Settings::default();
        headless.load(&scene).expect("uploads");
        let picture = draw(&mut headless, &camera, &clip, &settings);
        headless.load(&mirrored).expect("uploads");
        let image = draw(&mut headless, &camera, &mirrored_clip, &settings);
        let apart = |a: &Picture, b: &Picture| differences(a, b).expect("the same size");
        let same = apart(&flipped(&image), &picture);
        assert!(same.l1 < 0.01 && same.max < 4.0, "{same:?}");
        assert!(
            apart(&image, &picture).l1 > 1.0,
            "the scene is its own mirror image"
        );
    }
    headless.close().expect("no validation messages");
}
