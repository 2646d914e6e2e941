//! Stage `clip`: the side of each block and, of those that are cut, of each Gaussian.

use glam::{DVec3, Quat, Vec3};
use rara::clip::Expression;
use rara::types::Block;
use rara::{Clip, ClipOp, Mode, Plane, Raster, Settings};
use rara_base::limits::{self, ALPHA_MIN, BLOCK_SIZE};
use rara_reference::region::{Bounds, box_side};
use rara_reference::{Side, clip};

use crate::stages::frame::{self, Stages};
use crate::stages::ties;

/// The side that the stage finds for each Gaussian, in the device's order.
pub fn sides(stages: &mut Stages) -> Vec<Side> {
    let of_blocks: Vec<u32> = stages.read("clip_sides");
    let masks: Vec<[[u32; 8]; 2]> = stages.read("clip_masks");
    let side = |index: usize| {
        let (block, place) = (index / BLOCK_SIZE as usize, index % BLOCK_SIZE as usize);
        let bit = |mask: &[u32; 8]| mask[place / 32] >> (place % 32) & 1 == 1;
        match of_blocks[block] {
            1 => Side::Invisible,
            2 => Side::Visible,
            3 => match masks[block].each_ref().map(bit) {
                [false, true] => Side::Cutoff,
                [true, false] => Side::Visible,
                [false, false] => Side::Invisible,
                [true, true] => panic!("{index} is visible and cut"),
            },
            other => panic!("block {block} is on side {other}"),
        }
    };
    (0..stages.scene.len()).map(side).collect()
}

#[test]
fn the_clips_sides_are_the_twins() {
    frame::for_each_scene(|stages, scene| {
        let mut cases = vec![(Mode::Exact, 1, ClipOp::And), (Mode::Rara, 3, ClipOp::Or)];
        cases.extend([(Mode::Hard, 2, ClipOp::And), (Mode::Exact, 3, ClipOp::Or)]);
        for (mode, planes, op) in cases {
            let settings = Settings::default().mode(mode).raster(Raster::Quad);
            let planes = frame::clip(scene, planes, op);
            stages.draw(&frame::views(scene)[0], &planes, &settings);
            if !scene.is_empty() {
                check(stages, &planes, &settings);
                check_blocks(stages, &planes, &settings);
            }
        }
    });
}

#[test]
fn the_sides_of_shapes_are_the_twins() {
    frame::for_each_scene(|stages, scene| {
        let bounds = rara::scene::Bounds::of(scene);
        let (c, r) = (bounds.centre(), bounds.radius());
        let (x, y, z) = (c.x, c.y, c.z);
        let texts = [
            format!("sphere:{},{y},{z},{}", x + 0.3 * r, 0.5 * r),
            format!(
                "!cylinder:{x},{},{z},{x},{},{},{}",
                y - r,
                y + r,
                z + r,
                0.4 * r
            ),
            format!(
                "any(cone:{x},{y},{z},{x},{},{z},{r}, all(ellipsoid:{x},{y},{z},{r},{},{}, plane:1,0,0,{}))",
                y + r,
                0.5 * r,
                0.3 * r,
                -x
            ),
        ];
        let modes = [Mode::Exact, Mode::Rara, Mode::Exact];
        for (text, mode) in texts.iter().zip(modes) {
            let clip = text.parse::<Expression>().expect("an expression").clip();
            let settings = Settings::default().mode(mode).raster(Raster::Quad);
            stages.draw(&frame::views(scene)[0], &clip, &settings);
            if !scene.is_empty() {
                check(stages, &clip, &settings);
                check_blocks(stages, &clip, &settings);
            }
        }
    });
}

/// Of a region of many surfaces a block's Gaussians ask those that its bounds leave open, and find the same sides.
#[test]
fn the_sides_by_shortlists_are_the_twins() {
    const ROOM: u32 = limits::SHORTLIST_SURFACES;
    let mut stages = Stages::new();
    let scene = frame::scene(50_000);
    stages.load(&scene);
    let at = |number: u32| {
        let turn = |by: f64| (f64::from(number) * by).sin();
        format!("{},{},{}", turn(1.7), turn(2.3), turn(0.9))
    };
    let spheres: Vec<String> = (0..60).map(|n| format!("sphere:{},.2", at(n))).collect();
    let holes: Vec<String> = (60..90)
        .map(|n| format!("!box:{},.1,.2,.1", at(n)))
        .collect();
    let text = format!("any(all({}), {})", holes.join(","), spheres.join(","));
    let clip = text.parse::<Expression>().expect("an expression").clip();
    for mode in [Mode::Exact, Mode::Rara, Mode::Hard] {
        let settings = Settings::default().mode(mode).raster(Raster::Quad);
        stages.draw(&frame::views(&scene)[0], &clip, &settings);
        check(&mut stages, &clip, &settings);
        check_blocks(&mut stages, &clip, &settings);
        let lists: Vec<[u32; limits::SHORTLIST_WORDS as usize]> = stages.read("shortlists");
        let shorter = lists.iter().filter(|list| list[0] != u32::MAX);
        let open: Vec<u32> = shorter.map(|list| list[0] >> 2).collect();
        assert!(open.iter().all(|&surfaces| surfaces <= ROOM));
        assert!(open.iter().any(|&surfaces| surfaces > 5), "{open:?}");
        assert!(
            2 * open.len() > lists.len(),
            "most blocks ask few: {open:?}"
        );
    }
}

fn check(stages: &mut Stages, planes: &Clip, settings: &Settings) {
    let ours = sides(stages);
    let twin = clip::clip::<f32>(&stages.scene, planes, settings);
    let mut ties = 0;
    for (index, (ours, twin)) in ours.iter().zip(&twin).enumerate() {
        // Gaussians that no pixel shows do not count: their block may be settled without them.
        if ours != twin && stages.scene.opacities()[index] >= ALPHA_MIN {
            let possible = ties::classes(&stages.scene, index, None, planes, settings);
            assert!(
                possible.contains(ours),
                "{index}: {ours:?}, the twin says {twin:?}: {settings:?}"
            );
            ties += 1;
        }
    }
    assert!(ties <= 1 + stages.scene.len() / 5_000, "{ties} ties");
    if stages.scene.len() > 1_000 && settings.mode != Mode::Hard {
        for side in [Side::Visible, Side::Cutoff, Side::Invisible] {
            assert!(ours.contains(&side), "some are {side:?}: {settings:?}");
        }
    }
}

/// The shader widens the box and the band by what rounding may take. Where it settles a block its twin does so too, and
/// it leaves hardly a block open that the twin settles.
fn check_blocks(stages: &mut Stages, planes: &Clip, settings: &Settings) {
    let sides: Vec<u32> = stages.read("clip_sides");
    let blocks: Vec<Block> = stages.read("blocks");
    let count = stages.scene.len().div_ceil(BLOCK_SIZE as usize);
    let mut open = 0;
    for (side, block) in sides.into_iter().zip(blocks).take(count) {
        let corner =
            |corner: [f32; 4]| DVec3::new(corner[0].into(), corner[1].into(), corner[2].into());
        let (low, high) = (corner(block.low_reach), corner(block.high_sigma));
        let bounds = Bounds {
            middle: 0.5 * (low + high),
            half: 0.5 * (high - low),
            reach: f64::from(block.low_reach[3]).max(0.0),
            sigma: f64::from(block.high_sigma[3]).abs(),
        };
        let twin = box_side(&bounds, planes, settings);
        match side {
            1 => assert_eq!(twin, Side::Invisible, "{block:?}"),
            2 => assert_eq!(twin, Side::Visible, "{block:?}"),
            _ => open += usize::from(twin != Side::Cutoff),
        }
    }
    assert!(
        open <= 1 + count / 50,
        "{open} of {count} blocks are left open"
    );
}

/// At coordinates of a million single precision knows an offset only to a sixteenth; the low word has the rest.
#[test]
fn a_planes_distance_has_its_low_word() {
    let mut stages = Stages::new();
    let at = Vec3::new(1e6, 0.0, 0.0);
    let scene = frame::one(at, Vec3::splat(0.002), Quat::IDENTITY, 0.9);
    stages.load(&scene);
    let eye = at.as_dvec3() - 4.0 * DVec3::Z;
    let camera = rara::Camera::look_at(eye, at.as_dvec3(), -DVec3::Y, 50.0, (64, 64));
    let camera = camera.expect("a view");
    for (offset, side) in [
        (-1e6 + 0.02, Side::Visible),
        (-1e6 + 0.01, Side::Visible),
        (-1e6 + 0.003, Side::Cutoff),
        (-1e6 - 0.003, Side::Cutoff),
        (-1e6 - 0.01, Side::Invisible),
    ] {
        assert_eq!(offset as f32, -1e6, "one number in single precision");
        let planes = Clip::of(
            [Plane::new(DVec3::X, offset).expect("a finite normal")],
            ClipOp::And,
        );
        let settings = Settings::default().raster(Raster::Quad);
        stages.draw(&camera, &planes, &settings);
        assert_eq!(sides(&mut stages), [side], "{offset}");
        assert_eq!(clip::clip::<f32>(&scene, &planes, &settings), [side]);
    }
}
