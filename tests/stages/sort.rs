//! Stage `sort`: the splats' order, from the depths that the stage before has found.

use std::collections::BTreeSet;

use glam::Vec3;
use rara::scene::{Kind, generate};
use rara::types::FrameData;
use rara::{Clip, Raster, Settings};
use rara_base::limits::SORT_BITS;
use rara_reference::sort;

use crate::stages::frame::{self, Stages};

/// The splats' depths and their numbers in the scene.
pub fn places(stages: &mut Stages) -> (Vec<f32>, Vec<u32>) {
    let splats = stages.splats();
    let depths = splats.iter().map(|splat| splat.curvature_depth[3]);
    (depths.collect(), stages.numbers_in_view(splats.len()))
}

fn check(stages: &mut Stages, what: &str) {
    let (depths, numbers) = places(stages);
    let twin = sort::order(&depths, &numbers);
    let (keys, order) = sorted(stages, depths.len());
    assert!(order == twin, "{what}: the order is not the twin's");
    // All bits count here: keys are the depths' bits, counted from one common number.
    let near = |(key, place): (&u32, &u32)| depths[*place as usize].to_bits().wrapping_sub(*key);
    let nears = keys.iter().zip(&twin).map(near);
    let firsts: BTreeSet<_> = nears.collect();
    assert!(firsts.len() <= 1, "{what}: keys are not the depths' bits");
}

/// The keys and the order in the buffers that the draw reads: each pass moves them to the other pair, and the span of the
/// keys gives the number of passes.
fn sorted(stages: &mut Stages, count: usize) -> (Vec<u32>, Vec<u32>) {
    let frame: FrameData = stages.read("frame")[0];
    let span = frame.eye.order.key_span >> frame.eye.order.key_shift;
    let bits = u32::BITS - span.leading_zeros();
    let passes = bits.div_ceil(SORT_BITS).max(1);
    let names = [("keys", "order"), ("sorted_keys", "sorted_order")][passes as usize % 2];
    let [mut keys, mut order] = [names.0, names.1].map(|name| stages.read::<u32>(name));
    keys.truncate(count);
    order.truncate(count);
    (keys, order)
}

#[test]
fn the_order_is_the_twins() {
    let settings = Settings::default().raster(Raster::Quad);
    assert_eq!(settings.precision.key_bits, 32);
    frame::for_each_scene(|stages, scene| {
        for camera in frame::views(scene) {
            stages.draw(&camera, &Clip::default(), &settings);
            if !scene.is_empty() {
                check(stages, &scene.len().to_string());
            }
        }
    });
}

/// Splats of one depth are in the order of their numbers, however many they are.
#[test]
fn equal_depths_are_in_the_files_order() {
    let mut stages = Stages::new();
    let (few, many) = (3_000, 70_000);
    for (count, layers) in [
        (few, 1),
        (few, 7),
        (few, 40),
        (few, 900),
        (4_096, 1),
        (4_097, 1),
        (6_000, 1),
        (many, 1),
        (many, 3),
        (many, 900),
    ] {
        check_layers(&mut stages, count, layers);
    }
}

/// Groups of one depth of every size that pipelines tell apart, in one scene: one splat, as many as an invocation, a workgroup and
/// a partition order, and one more of each, and groups that fill several partitions.
#[test]
fn groups_of_one_depth_of_every_size_are_in_the_files_order() {
    let sizes = [
        1, 2, 16, 17, 24, 25, 256, 257, 3_000, 4_096, 4_097, 1, 9_000, 300, 4_095, 20_000, 2, 5_000,
    ];
    let layers = (0..).zip(sizes).flat_map(|(layer, size)| vec![layer; size]);
    let mut layers: Vec<usize> = layers.collect();
    // The numbers of a group lie all over the file.
    let count = layers.len();
    for at in 0..count {
        layers.swap(at, at * 7919 % count);
    }
    check_depths(&mut Stages::new(), "every size", &layers);
}

/// Pipelines that divide the keys into partitions of 4096 have a last one that is full, lacks one key, or holds a single one.
#[test]
fn partitions_of_every_length_are_sorted() {
    let mut stages = Stages::new();
    for count in [2, 4_095, 4_096, 4_097, 12_287, 12_288, 12_289] {
        check_layers(&mut stages, count, count);
        check_layers(&mut stages, count, 2);
    }
}

/// Checks the order of Gaussians that stand in so many layers of one depth each, all of them in view.
fn check_layers(stages: &mut Stages, count: usize, layers: usize) {
    let of = |index| index * 7919 % layers;
    let layers_of: Vec<_> = (0..count).map(of).collect();
    check_depths(stages, &format!("{count} in {layers} layers"), &layers_of);
}

/// Checks the order of Gaussians that stand in these layers of one depth each, all of them in view.
fn check_depths(stages: &mut Stages, what: &str, layers: &[usize]) {
    let count = layers.len();
    let mut scene = generate(Kind::General, count, 2);
    let mut camera = frame::views(&scene)[0];
    camera.rotation = glam::DMat3::IDENTITY;
    camera.eye = glam::DVec3::new(0.0, 0.0, -40.0);
    for (position, layer) in scene.positions_mut().iter_mut().zip(layers) {
        *position = position.clamp(Vec3::NEG_ONE, Vec3::ONE);
        position.z = *layer as f32 / 64.0;
    }
    scene.opacities_mut().fill(0.5);
    stages.load(&scene);
    let settings = Settings::default().raster(Raster::Quad);
    let counts = stages.draw(&camera, &Clip::default(), &settings).counts;
    assert_eq!(counts.drawn, count as u32, "all are in view");
    check(stages, what);
}

/// With fewer bits only neighbours may change places.
#[test]
fn fewer_bits_keep_the_order_of_what_they_distinguish() {
    let mut stages = Stages::new();
    let scene = frame::scene(50_000);
    stages.load(&scene);
    for bits in [8, 16, 24] {
        let mut settings = Settings::default().raster(Raster::Quad);
        settings.precision.key_bits = bits;
        let camera = frame::views(&scene)[0];
        stages.draw(&camera, &Clip::default(), &settings);
        let (depths, numbers) = places(&mut stages);
        let (keys, order) = sorted(&mut stages, depths.len());
        let mut once = order.clone();
        once.sort_unstable();
        assert!(once.into_iter().eq(0..depths.len() as u32), "each once");
        let at = |i: usize| order[i] as usize;
        let mut deepest = 0.0_f32; // the deepest of the keys before
        let mut of_key = 0.0_f32;
        for i in 1..order.len() {
            of_key = of_key.max(depths[at(i - 1)]);
            if keys[i] != keys[i - 1] {
                deepest = of_key;
            }
            assert!((keys[i - 1], numbers[at(i - 1)]) < (keys[i], numbers[at(i)]));
            assert!(depths[at(i)] >= deepest, "{bits} bits");
            assert!(u64::from(keys[i]) < 1 << bits, "{bits} bits");
        }
    }
}
