//! Curved shapes and combinations against the f64 reference.

use crate::common;
use glam::DVec3;
use rara::clip::Expression;
use rara::{
    Camera, Clip, Gaussians, Headless, Layer, Mode, Picture, Plane, Raster, Scene, Settings, scene,
};
use rara_lab::measure::differences;

/// Every shape, and regions of several, through the middle of a generated scene of radius 1.
const EXPRESSIONS: [&str; 14] = [
    "slab:1,2,0,0.2,0.3",
    "sphere:0.3,0.1,0,0.6",
    "!sphere:0,-0.2,0.1,0.5",
    "ellipsoid:0,0,0,0.9,0.4,0.6,0.9,0.1,0.3,0.2",
    "cylinder:-0.8,-0.3,0,0.7,0.4,0.2,0.35",
    "!cylinder:-0.8,-0.3,0,0.7,0.4,0.2,0.35",
    "capsule:-0.4,-0.3,0,0.5,0.4,0.2,0.3",
    "cone:0,-0.9,0,0.1,0.9,0.1,0.8",
    "all(!box:0.2,0,0,0.3,0.3,0.3,0.9,0.2,0.1,0.3, plane:1,0.3,0.2,0.1)",
    "any(box:-0.4,0,0,0.3,0.3,0.3, box:0.4,0.1,0,0.3,0.4,0.3)",
    "all(sphere:0,0,0,0.7, not(any(sphere:0.3,0.1,0.2,0.4, plane:0,1,0.2,-0.3)))",
    "all(sphere:0,0,0,0.8, plane:1,0,0,0.2, plane:0,1,0,0.3)",
    "any(plane:1,0,0,-0.5, all(!plane:0,1,0,0, plane:0,0,1,0))",
    "sphere:0.2,0,0,0.02",
];

fn check(modes: &[Mode], rasters: &[Raster], expressions: &[&str]) {
    let gaussians = scene::generate(scene::Kind::General, 3_000, 3);
    let mut headless = common::headless();
    headless.load(&gaussians).expect("uploads");
    let views = common::views(&gaussians, 2, common::scaled((253, 190)));
    for text in expressions {
        let clip = text.parse::<Expression>().expect("an expression").clip();
        for camera in &views {
            for mode in modes {
                for raster in rasters {
                    let settings = Settings::default().mode(*mode).raster(*raster);
                    let name = format!("{text}, {raster:?}");
                    common::check(&mut headless, &name, &gaussians, camera, &clip, &settings);
                }
            }
        }
    }
}

#[test]
fn exact_shapes_are_the_references() {
    check(&[Mode::Exact], &[Raster::Tiles], &EXPRESSIONS);
}

#[test]
fn rara_and_hard_shapes_are_the_references() {
    check(&[Mode::Rara, Mode::Hard], &[Raster::Tiles], &EXPRESSIONS);
}

#[test]
fn quads_and_meshes_draw_shapes_like_tiles() {
    let modes = [Mode::Rara, Mode::Exact];
    check(&modes, &[Raster::Quad, Raster::Mesh], &EXPRESSIONS[8..11]);
}

/// A picture of what an expression keeps.
fn clipped(headless: &mut Headless, camera: &Camera, text: &str) -> Picture {
    let clip = text.parse::<Expression>().expect("an expression").clip();
    let settings = Settings::default();
    headless.render(camera, &clip, &settings).expect("renders");
    headless.picture().expect("reads back")
}

#[test]
fn a_huge_sphere_is_its_tangent_plane() {
    let gaussians = scene::generate(scene::Kind::General, 3_000, 3);
    let mut headless = common::headless();
    headless.load(&gaussians).expect("uploads");
    let camera = common::views(&gaussians, 1, common::scaled((253, 190))).remove(0);
    let mut picture = |text: &str| clipped(&mut headless, &camera, text);
    let plane = picture("plane:0.6,0,0.8,0.1");
    let sphere = picture("sphere:599999.94,0,799999.92,1000000");
    let outside = picture("!sphere:-600000.06,0,-800000.08,1000000");
    for curved in [sphere, outside] {
        let difference = differences(&curved, &plane).expect("the same size");
        assert!(difference.max < 0.3, "{difference:?}, in 1/255");
    }
}

#[test]
fn beyond_its_end_a_capsule_is_a_ball() {
    let all = scene::generate(scene::Kind::General, 3_000, 3);
    let mut beyond = all.empty_like();
    for splat in 0..all.len() {
        let (position, scale) = (all.positions()[splat], all.scales()[splat]);
        if position.x > 4.0 * scale.max_element() {
            let (turn, opacity) = (all.rotations()[splat], all.opacities()[splat]);
            beyond.push(position, scale, turn, opacity, all.sh_of(splat));
        }
    }
    assert!(beyond.len() > 1_000);
    let mut headless = common::headless();
    headless.load(&beyond).expect("uploads");
    let camera = common::views(&all, 1, common::scaled((253, 190))).remove(0);
    let mut picture = |text: &str| clipped(&mut headless, &camera, text);
    let capsule = picture("capsule:-0.9,0,0,0,0,0,0.3");
    let difference = differences(&capsule, &picture("sphere:0,0,0,0.3")).expect("the same size");
    assert!(difference.max < 0.01, "{difference:?}, in 1/255");
}

#[test]
fn a_region_and_its_complement_rebuild_the_whole() {
    let gaussians = scene::generate(scene::Kind::General, 3_000, 3);
    let mut headless = common::headless();
    headless.load(&gaussians).expect("uploads");
    let camera = common::views(&gaussians, 1, common::scaled((253, 190))).remove(0);
    let settings = Settings::default();
    headless
        .render(&camera, &Clip::default(), &settings)
        .expect("renders");
    let whole = headless.picture().expect("reads back");
    for text in EXPRESSIONS {
        let clip = text.parse::<Expression>().expect("an expression").clip();
        // Equal depths are drawn one after the other: what one layer keeps of a splat, then what the other does.
        let halves = Scene::from_iter([
            Layer::new("in", &gaussians).clipped(clip.clone()),
            Layer::new("out", &gaussians).clipped(clip.complement()),
        ]);
        headless.load(&halves).expect("uploads");
        headless
            .render(&camera, &Clip::default(), &settings)
            .expect("renders");
        let rebuilt = headless.picture().expect("reads back");
        let difference = differences(&rebuilt, &whole).expect("the same size");
        assert!(difference.max < 0.5, "{text}: {difference:?}, in 1/255");
    }
}

#[test]
fn a_shape_that_touches_nothing_changes_no_byte() {
    let gaussians = scene::generate(scene::Kind::General, 3_000, 3);
    let mut headless = common::headless();
    headless.load(&gaussians).expect("uploads");
    let camera = common::views(&gaussians, 1, common::scaled((253, 190))).remove(0);
    let mut picture = |text: &str| {
        let clip = text
            .parse::<Expression>()
            .map(|e| e.clip())
            .unwrap_or_default();
        headless
            .render(&camera, &clip, &Settings::default())
            .expect("renders");
        headless.picture().expect("reads back")
    };
    let whole = picture("");
    for text in [
        "sphere:0,0,0,50",
        "!capsule:40,0,0,50,0,0,3",
        "all(cone:0,0,-90,0,0,90,400, !box:30,0,0,1,1,1)",
    ] {
        assert_eq!(picture(text), whole, "{text}");
    }
}

/// Small splats in perspective follow the footprint; without perspective all do, also where they are large and graze a surface.
#[test]
fn large_splats_graze_surfaces_without_perspective() {
    let gaussians = scene::generate(scene::Kind::General, 1_500, 9);
    let mut headless = common::headless();
    headless.load(&gaussians).expect("uploads");
    let eye = DVec3::new(0.3, -0.2, -4.0);
    let camera = Camera::orthographic(eye, DVec3::ZERO, -DVec3::Y, 0.5, common::scaled((189, 142)));
    let camera = camera.expect("a view");
    for text in [
        "sphere:0.2,0,0,0.3",
        "!sphere:0,2.02,0,2",
        "all(sphere:0,-9.95,0,10, !cylinder:-1,0,0,1,0.1,0,0.1)",
    ] {
        let clip = text.parse::<Expression>().expect("an expression").clip();
        let settings = Settings::default().raster(Raster::Tiles);
        common::check(&mut headless, text, &gaussians, &camera, &clip, &settings);
    }
}

/// The surface that cuts a splat may lie around its centre, where it has no slope.
#[test]
fn a_splat_around_a_whole_sphere_keeps_its_share() {
    let mut gaussians = Gaussians::default();
    let size = glam::Vec3::splat(0.5);
    gaussians.push(
        glam::Vec3::ZERO,
        size,
        glam::Quat::IDENTITY,
        0.9,
        &[1.0, 0.5, 0.2],
    );
    let mut headless = common::headless();
    headless.load(&gaussians).expect("uploads");
    let camera = common::views(&gaussians, 1, common::scaled((95, 71))).remove(0);
    for text in [
        "sphere:0,0,0,0.3",
        "!sphere:0,0,0,0.3",
        "cylinder:0,-1,0,0,1,0,0.2",
    ] {
        let clip = text.parse::<Expression>().expect("an expression").clip();
        let settings = Settings::default().raster(Raster::Tiles);
        let stats = common::check(&mut headless, text, &gaussians, &camera, &clip, &settings);
        assert_eq!(stats.counts.cutoff, 1, "{text}");
    }
}

/// Records of a flat list of many planes are longer than those of a curved clip of another layer.
#[test]
fn layers_with_curved_clips_and_with_many_planes_stand_side_by_side() {
    let gaussians = scene::generate(scene::Kind::General, 800, 3);
    let plane = |number: i32| {
        let turn = f64::from(number) * 0.7;
        let normal = DVec3::new(turn.cos(), turn.sin(), 0.3);
        Plane::new(normal, 0.3 + 0.01 * f64::from(number)).expect("a normal")
    };
    let flat = Clip::of((0..30).map(plane), rara::ClipOp::And);
    let curved = "sphere:0.2,0,0,0.6"
        .parse::<Expression>()
        .expect("a shape")
        .clip();
    let layers = Scene::from_iter([
        Layer::new("flat", &gaussians).clipped(flat),
        Layer::new("curved", &gaussians).clipped(curved),
    ]);
    let mut headless = common::headless();
    headless.load(&layers).expect("uploads");
    let camera = common::views(&gaussians, 1, common::scaled((95, 71))).remove(0);
    let settings = Settings::default().raster(Raster::Tiles).trace_all(true);
    headless
        .render(&camera, &Clip::default(), &settings)
        .expect("renders");
    let picture = headless.picture().expect("reads back");
    let truth = rara_reference::render::<f64>(&layers, &camera, &Clip::default(), &settings);
    common::assert_agrees("thirty planes beside a sphere", &picture, &truth.picture);
}
