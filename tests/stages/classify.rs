//! Stages `blocks` and `classify`: which Gaussians are in view, and what the clip does to them.

use glam::{DMat4, Quat, Vec3};
use rara::Training;
use rara::{Camera, Clip, ClipOp, Mode, Raster, Settings};
use rara_base::limits::BLOCK_SIZE;
use rara_reference::{Side, ViewTransform, classify};

use crate::stages::frame::{self, Stages};
use crate::stages::ties;

/// The side that the stages find for each Gaussian, in the device's order; `None` for one of which they do not keep
/// whether it is culled or invisible: a block only counts these.
pub fn sides(stages: &mut Stages) -> Vec<Option<Side>> {
    let of_blocks: Vec<u32> = stages.read("block_sides");
    let masks: Vec<[[u32; 8]; 2]> = stages.read("masks");
    let side = |index: usize| {
        let (block, place) = (index / BLOCK_SIZE as usize, index % BLOCK_SIZE as usize);
        let bit = |mask: &[u32; 8]| mask[place / 32] >> (place % 32) & 1 == 1;
        match of_blocks[block] & 3 {
            0 => Some(Side::Culled),
            1 => Some(Side::Invisible),
            2 => Some(Side::Visible),
            3 => match masks[block].each_ref().map(bit) {
                [true, true] => Some(Side::Cutoff),
                [true, false] => Some(Side::Visible),
                [false, false] => None,
                [false, true] => panic!("{index} is cut and does not survive"),
            },
            other => panic!("block {block} is on side {other}"),
        }
    };
    (0..stages.scene.len()).map(side).collect()
}

#[test]
fn classes_are_the_twins() {
    frame::for_each_scene(|stages, scene| {
        for camera in frame::views(scene) {
            for (mode, planes, op) in [
                (Mode::None, 0, ClipOp::And),
                (Mode::Exact, 1, ClipOp::And),
                (Mode::Rara, 2, ClipOp::Or),
                (Mode::Exact, 3, ClipOp::Or),
            ] {
                let settings = Settings::default().mode(mode).raster(Raster::Quad);
                let planes = frame::clip(scene, planes, op);
                let counts = stages.draw(&camera, &planes, &settings).counts;
                if scene.is_empty() {
                    assert_eq!(counts, rara::Counts::default());
                } else {
                    check(stages, &camera, &planes, &settings);
                }
            }
        }
    });
}

/// Gaussians of which many are smaller than a pixel, so that what makes up for the low-pass leaves some too faint.
#[test]
fn classes_of_antialiased_gaussians_are_the_twins() {
    let mut scene = frame::scene(3_000);
    scene
        .scales_mut()
        .iter_mut()
        .for_each(|scale| *scale *= 0.1);
    let mut stages = Stages::new();
    let camera = frame::views(&scene)[0];
    let mut culled = [0; 2];
    for (antialiased, culled) in [false, true].into_iter().zip(&mut culled) {
        let low_pass = if antialiased { 0.1 } else { 0.3 };
        let training = Training::default()
            .antialiased(antialiased)
            .low_pass(low_pass);
        scene.set_training(training).expect("can be drawn");
        stages.load(&scene);
        for (mode, planes) in [(Mode::None, 0), (Mode::Exact, 1), (Mode::Rara, 2)] {
            let settings = Settings::default().mode(mode).raster(Raster::Quad);
            let planes = frame::clip(&scene, planes, ClipOp::And);
            *culled = stages.draw(&camera, &planes, &settings).counts.culled;
            check(&mut stages, &camera, &planes, &settings);
        }
    }
    assert!(culled[1] > culled[0], "{culled:?}");
}

fn check(stages: &mut Stages, camera: &Camera, planes: &Clip, settings: &Settings) {
    let ours = sides(stages);
    let twin = classify::classify(
        &stages.scene,
        &ViewTransform::<f32>::new(camera),
        planes,
        settings,
    );
    let mut ties = 0;
    for (index, (ours, twin)) in ours.iter().zip(&twin).enumerate() {
        let is = |side: &Side| match ours {
            Some(ours) => ours == side,
            None => matches!(side, Side::Culled | Side::Invisible),
        };
        if !is(twin) {
            let possible = ties::classes(&stages.scene, index, Some(camera), planes, settings);
            assert!(
                possible.iter().any(is),
                "{index}: {ours:?}, the twin says {twin:?}, possible are {possible:?}: {settings:?}"
            );
            ties += 1;
        }
    }
    assert!(ties <= 1 + stages.scene.len() / 5_000, "{ties} ties");
    // How many are of each class, by block and in all, so that culled and invisible Gaussians are distinguished.
    let of_blocks: Vec<u32> = stages.read("block_sides");
    let totals: Vec<[u32; 4]> = stages.read("block_counts");
    let mut apart = 0;
    for (block, twin) in twin.chunks(BLOCK_SIZE as usize).enumerate() {
        if of_blocks[block] & 3 == 3 {
            let counts = rara_reference::counts(twin);
            let [visible, cutoff, invisible, _] = totals[block];
            apart += visible.abs_diff(counts.visible)
                + cutoff.abs_diff(counts.cutoff)
                + invisible.abs_diff(counts.invisible);
        }
    }
    assert!(
        apart as usize <= 2 * ties,
        "{apart} counted apart, {ties} ties"
    );
}

/// The literal rule: 3DGS does not draw what is nearer than 0.2 along the view axis.
#[test]
fn the_near_cut_is_at_a_fifth() {
    let camera = Camera::from_world_to_camera(DMat4::IDENTITY, (60.0, 60.0, 32.0, 24.0), (64, 48))
        .expect("a camera at the origin");
    let mut stages = Stages::new();
    for (z, side) in [(0.199, Side::Culled), (0.201, Side::Visible)] {
        let scene = frame::one(
            Vec3::new(0.01, 0.0, z),
            Vec3::splat(0.01),
            Quat::IDENTITY,
            0.9,
        );
        stages.load(&scene);
        let settings = Settings::default().raster(Raster::Quad);
        let clip = Clip::default();
        let counts = stages.draw(&camera, &clip, &settings).counts;
        assert_eq!(counts.visible, u32::from(side == Side::Visible), "{z}");
        assert_eq!(counts.culled, u32::from(side == Side::Culled), "{z}");
        let twin = classify::classify(
            &scene,
            &ViewTransform::<f32>::new(&camera),
            &clip,
            &settings,
        );
        assert_eq!(twin, [side], "{z}");
        let drawn = stages.headless.picture().expect("reads back");
        let is_there = drawn.pixels.iter().any(|pixel| pixel[3] > 0.5);
        assert_eq!(is_there, side == Side::Visible, "{z}");
    }
}
