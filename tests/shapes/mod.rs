//! The pipelines for GPUs and those for CPU drivers, on whatever device there is: the same orders, lists and records to the bit,
//! and the same pictures but for the rounding of a pixel's weight.

mod frames;

use glam::{DMat3, DQuat, DVec3, Vec3};
use rara::clip::Expression;
use rara::scene::{Bounds, Kind, generate};
use rara::{
    Camera, Clip, ClipOp, Gaussians, Layer, LayerState, Mode, Placement, Raster, Scene, Settings,
};
use rara_base::limits::{RADIX_PARTITION, RECORD_PLANES, SORT_BITS};

use crate::common;

use frames::Shapes;

/// Not a multiple of a tile, nor of a macro-tile.
const SIZE: (u32, u32) = (253, 190);

/// The clips of the suite: a mode, how many planes, and how they combine.
const CLIPS: [(Mode, usize, ClipOp); 7] = [
    (Mode::None, 0, ClipOp::And),
    (Mode::Hard, 1, ClipOp::And),
    (Mode::Rara, 1, ClipOp::And),
    (Mode::Rara, 2, ClipOp::Or),
    (Mode::Exact, 1, ClipOp::And),
    (Mode::Exact, 3, ClipOp::And),
    (Mode::Exact, 2, ClipOp::Or),
];

/// Those whose splats have the longest way through the pipelines: what else a pipeline does depends on the mode, not on the scene.
const SPLIT: [(Mode, usize, ClipOp); 2] = [CLIPS[3], CLIPS[5]];

/// Gaussians of a scene: several partitions of the sort.
const COUNT: usize = 20_000;

#[test]
fn generated_scenes_in_every_mode() {
    let mut shapes = Shapes::new();
    for (index, (name, scene)) in common::generated_scenes(COUNT).into_iter().enumerate() {
        let clips = if index == 0 { &CLIPS[..] } else { &SPLIT };
        check_modes(&mut shapes, &name, &scene, clips);
    }
    shapes.close();
}

#[test]
fn trained_scenes_whose_splats_are_cut() {
    let mut shapes = Shapes::new();
    for (name, scene) in common::trained_scenes() {
        let step = scene.len().div_ceil(COUNT);
        let some = common::picked(&scene, (0..scene.len()).step_by(step));
        check_modes(&mut shapes, &name, &some, &SPLIT);
    }
    shapes.close();
}

fn check_modes(
    shapes: &mut Shapes,
    name: &str,
    scene: &Gaussians,
    clips: &[(Mode, usize, ClipOp)],
) {
    shapes.load(scene);
    let camera = common::views(scene, 3, common::scaled(SIZE))[1];
    for &(mode, planes, op) in clips {
        let clip = common::clip(scene, planes, op);
        let what = format!("{name}, {mode:?}, {planes} planes {op:?}");
        let settings = Settings::default().mode(mode).raster(Raster::Tiles);
        shapes.check_runs(&what, &camera, &clip, &settings);
        let counts = shapes.counts();
        let [few, several] = [counts.tile_groups, counts.several_tile_groups].map(|list| list[3]);
        let is_split = mode == Mode::Exact && planes > 1;
        assert_eq!(several > 0, is_split, "{what}: {few}, {several}");
    }
    // From within, where splats are cut by the image plane and cover the whole picture.
    let bounds = Bounds::of(scene);
    let ahead = bounds.centre() + DVec3::new(0.3, 0.1, 1.0);
    let inside = Camera::look_at(
        bounds.centre(),
        ahead,
        -DVec3::Y,
        70.0,
        common::scaled(SIZE),
    );
    let clip = common::clip(scene, 2, ClipOp::Or);
    let settings = Settings::default().raster(Raster::Tiles);
    let what = format!("{name}, from within");
    shapes.check(&what, &inside.expect("a view"), &clip, &settings);
    // Quads show the sorted keys, whose buffers the bin uses for more; nothing else of theirs depends on the pipelines.
    let settings = Settings::default().raster(Raster::Quad);
    let clip = common::clip(scene, 1, ClipOp::And);
    shapes.check(&format!("{name}, quads"), &camera, &clip, &settings);
}

/// A clip that moves before a camera that stands still.
#[test]
fn a_moving_clip() {
    let mut shapes = Shapes::new();
    let (name, scene) = common::generated_scenes(COUNT).remove(0);
    shapes.load(&scene);
    let camera = common::views(&scene, 3, SIZE)[0];
    let settings = Settings::default().raster(Raster::Tiles);
    for step in 0..4 {
        let clip = common::moved(common::clip(&scene, 2, ClipOp::And), 0.05 * f64::from(step));
        let what = format!("{name}, move {step}");
        shapes.check_next(&what, &camera, &clip, &settings);
    }
    shapes.close();
}

/// More blocks than a workgroup lists, in layers of which one is hidden, another placed and faded.
#[test]
fn many_blocks_in_layers() {
    let mut shapes = Shapes::new();
    let mut scene = generate(Kind::General, 140_000, 4);
    scene
        .scales_mut()
        .iter_mut()
        .for_each(|scale| *scale *= 0.3);
    let parts = [0, 1, 2].map(|part| common::picked(&scene, (part..scene.len()).step_by(3)));
    let hidden = LayerState::default().visible(false);
    let turned = Placement::new(DVec3::ZERO, DQuat::from_rotation_y(0.3), 0.8).expect("possible");
    let faded = LayerState::default().placement(turned).opacity(0.6);
    let layers = Scene::from_iter([
        Layer::new("hidden", &parts[0]).with(hidden),
        Layer::new("faded", &parts[1]).with(faded),
        Layer::new("whole", &parts[2]),
    ]);
    shapes.load(&layers);
    let camera = common::views(&scene, 3, SIZE)[0];
    let settings = Settings::default().raster(Raster::Tiles);
    for step in 0..3 {
        let clip = common::clip(&scene, 1, ClipOp::And);
        let clip = common::moved(clip, 0.05 * f64::from(step));
        shapes.check_next(&format!("move {step}"), &camera, &clip, &settings);
    }
    shapes.close();
}

/// Splats that reach no pixel's centre have no pairs, and the frame before has left the counts of many.
#[test]
fn splats_without_pixels() {
    let mut shapes = Shapes::new();
    let many = in_layers(5_000, 5_000);
    let settings = Settings::default().raster(Raster::Tiles);
    let mut one = in_layers(1, 1);
    one.positions_mut()[0] = Vec3::ZERO;
    one.scales_mut()[0] = Vec3::splat(0.03);
    for size in [SIZE, (8, 8)] {
        shapes.load(&many);
        shapes.check("many", &facing(size), &Clip::default(), &settings);
        shapes.load(&one);
        let mut missed = 0;
        for step in 0..16 {
            // The picture's corner moves over the splat, whose rectangle has corners that its ellipse does not reach.
            let mut camera = facing(size);
            camera.cx = f64::from(step) * -0.4;
            camera.cy = camera.cx;
            let what = format!("one, {size:?}, step {step}");
            let drawn = shapes.check_next(&what, &camera, &Clip::default(), &settings);
            missed += usize::from(drawn == 1 && shapes.counts().pairs == 0);
        }
        assert!(missed > 0, "a splat without pixels");
    }
    shapes.close();
}

/// No splat, one, and numbers around a partition of 4096, whose keys are all equal or all different.
#[test]
fn keys_and_counts_at_the_edges_of_partitions() {
    let mut shapes = Shapes::new();
    for count in [0, 1, 2, 255, 4_095, 4_096, 4_097, 12_289] {
        for layers in [1, count.max(1)] {
            let scene = in_layers(count, layers);
            shapes.load(&scene);
            let settings = Settings::default().raster(Raster::Tiles);
            let what = format!("{count} in {layers} layers");
            let drawn = shapes.check_runs(&what, &facing(SIZE), &Clip::default(), &settings);
            assert_eq!(drawn as usize, count, "{what}: all are in view");
        }
    }
    shapes.close();
}

/// More groups of one depth than a digit has values, each of more splats than a partition holds: therefore a million of them.
#[test]
fn many_large_groups_of_one_depth_are_in_the_files_order() {
    let groups = (1 << SORT_BITS) + 2;
    let mut scene = in_layers(groups * (RADIX_PARTITION as usize + 1), groups);
    scene.set_sh_degree(0);
    let mut shapes = Shapes::new();
    let found = shapes.numbers_in_order(&scene, &facing((8, 8)));
    let depth = |number: &u32| (64.0 * scene.positions()[*number as usize].z) as u32;
    let mut expected: Vec<u32> = (0..scene.len() as u32).collect();
    expected.sort_by_key(depth);
    assert!(found == expected, "the order is not the file's");
    shapes.close();
}

/// Splats over the whole picture and beyond what a mask of tiles holds, before, between and behind small ones; in pictures of
/// one tile, of one macro-tile, at the edges of macro-tiles, and of so many that their sort takes two passes.
#[test]
fn splats_over_the_whole_picture() {
    let mut shapes = Shapes::new();
    for (count, large, size) in [
        (5_000, 40, (8, 8)),
        (5_000, 40, (128, 64)),
        (5_000, 40, (129, 65)),
        (5_000, 40, SIZE),
        (50_000, 5, (1100, 700)),
        (3_000, 30, (2600, 1500)),
        (1, 1, SIZE),
        (300, 300, SIZE),
    ] {
        let mut scene = in_layers(count, count);
        for index in (0..count).step_by(count / large) {
            scene.scales_mut()[index] = Vec3::new(60.0, 40.0, 20.0);
            scene.opacities_mut()[index] = 0.1;
        }
        // Needles across many macro-tiles, of which they touch few.
        for index in (0..count).skip(7).step_by(count.div_ceil(large)) {
            scene.scales_mut()[index] = Vec3::new(9.0, 0.003, 0.003);
        }
        shapes.load(&scene);
        let settings = Settings::default().raster(Raster::Tiles);
        let what = format!("{large} large ones of {count}, {size:?}");
        shapes.check_runs(&what, &facing(size), &Clip::default(), &settings);
    }
    shapes.close();
}

/// Curved shapes and expressions by the pipelines for GPUs. Their combined records differ in bits from those for CPU drivers, so
/// that the reference's pictures are compared, within the bounds of every picture.
#[test]
fn shapes_and_expressions_are_the_references() {
    const UNION: &str =
        "any(sphere:-.5,.2,0,.2, sphere:.5,.3,.1,.25, box:0,-.5,0,.3,.2,.3, plane:.3,-1,.2,-.8)";
    const DIFFERENCE: &str =
        "all(box:.1,0,0,.7,.5,.6,.9,.1,.3,.2, not(cylinder:-.8,-.3,0,.7,.4,.2,.35))";
    // More sides than a record has room for, and splats near the axis that all of them cut.
    let sides = (0..3 * RECORD_PLANES).map(|side| {
        let (sine, cosine) = f64::from(side).sin_cos();
        format!("plane:{cosine},{sine},0,.03")
    });
    let prism = format!("all({})", sides.collect::<Vec<_>>().join(","));
    let scene = generate(Kind::General, 1_500, 3);
    let camera = common::views(&scene, 3, (64, 48))[1];
    let mut shapes = Shapes::new();
    shapes.load(&scene);
    // Of nine surfaces on, blocks have shortlists. Each program is compiled by one of the renderers.
    for (turn, (text, mode, least)) in [
        (DIFFERENCE, Mode::Exact, 300),
        ("sphere:.3,.1,0,.6", Mode::Exact, 300),
        (UNION, Mode::Rara, 300),
        (UNION, Mode::Exact, 300),
        (&prism, Mode::Exact, 150),
        (
            &format!("any({prism}, sphere:-.5,.2,0,.2)"),
            Mode::Exact,
            150,
        ),
    ]
    .into_iter()
    .enumerate()
    {
        let clip = text.parse::<Expression>().expect("an expression").clip();
        let settings = Settings::default().mode(mode).raster(Raster::Tiles);
        let renderer = shapes.for_gpus(turn);
        let stats = common::check(renderer, text, &scene, &camera, &clip, &settings);
        assert!(stats.counts.cutoff > least, "{text}: {:?}", stats.counts);
    }
    shapes.close();
}

/// Gaussians that stand in so many layers of one depth each, all of them in view of [`facing`].
fn in_layers(count: usize, layers: usize) -> Gaussians {
    let mut scene = generate(Kind::General, count, 2);
    for (index, position) in scene.positions_mut().iter_mut().enumerate() {
        *position = position.clamp(Vec3::NEG_ONE, Vec3::ONE);
        position.z = (index * 7919 % layers) as f32 / 64.0;
    }
    scene.opacities_mut().fill(0.5);
    scene
}

/// A camera before them that looks along z, so that those of a layer have one depth.
fn facing(size: (u32, u32)) -> Camera {
    let eye = DVec3::new(0.0, 0.0, -40.0);
    let mut camera = Camera::look_at(eye, DVec3::ZERO, -DVec3::Y, 5.0, size).expect("a view");
    camera.rotation = DMat3::IDENTITY;
    camera
}
