//! Curved shapes and combinations against the f64 reference.

use crate::common;
use rara::clip::Expression;
use rara::{Mode, Raster, Settings, scene};

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
    for camera in common::views(&gaussians, 2, common::scaled((253, 190))) {
        for text in expressions {
            let clip = text.parse::<Expression>().expect("an expression").clip();
            for mode in modes {
                for raster in rasters {
                    let settings = Settings::default().mode(*mode).raster(*raster);
                    let name = format!("{text}, {raster:?}");
                    common::check(&mut headless, &name, &gaussians, &camera, &clip, &settings);
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
