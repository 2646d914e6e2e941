//! Regions that bend, and combinations of shapes.

use glam::DVec3;

use super::make::{PLAIN, Setup, on_surface, three_between};
use super::{Case, Regime};
use rara::Clip;
use rara::clip::Expression;
use rara_scene::Random;

/// Both sides of the region are within a hundredth of a splat, and each is known to a thousandth of that.
const THIN: &str = "24 bits place both sides of a region that is a thousandth as thick as wide to a thousandth of a splat";

pub fn regimes() -> Vec<Regime> {
    vec![
        Regime::new("spheres", || cases(50, PLAIN, ROUND, "sphere:0,0,0,1")),
        Regime::new("outside of a sphere", || {
            cases(51, PLAIN, ROUND, "!sphere:0,0,0,1")
        }),
        Regime::new("a sphere that is smaller than a splat", || {
            cases(52, PLAIN, [5.0, 20.0], "sphere:0.1,0,0,0.02")
        }),
        Regime::new("a sphere that a splat of 300 px is in", || {
            cases(53, PLAIN, [100.0, 300.0], "sphere:0.2,0.1,0,1")
        }),
        Regime::new("a sphere of radius 1e6", || {
            cases(54, PLAIN, ROUND, "sphere:599999.94,0,799999.92,1000000")
        }),
        Regime::new("a sphere in a world at 1e4", || {
            let there = Setup {
                centre: DVec3::new(1e4, -1e4, 1e4),
                ..PLAIN
            };
            cases(55, there, ROUND, "sphere:10000,-10000,10000,1")
        }),
        Regime::new("ellipsoids, aspect 1e3", || {
            cases(
                56,
                PLAIN,
                ROUND,
                "ellipsoid:0,0,0,1,0.8,0.001,0.9,0.1,0.3,0.2",
            )
        })
        .limited(2e-3, 60.0, THIN),
        Regime::new("a thin cylinder", || {
            cases(57, PLAIN, ROUND, "cylinder:-1,-0.3,0,1,0.3,0,0.003")
        }),
        Regime::new("the seams of capsules", || {
            cases(58, PLAIN, ROUND, "capsule:-0.1,0,0,0.1,0.05,0,0.6")
        }),
        Regime::new("the tip of a cone", || {
            cases(59, PLAIN, ROUND, "cone:0,0,0,0.05,0.2,0.1,0.1")
        }),
        Regime::new("edges and corners of a box", || {
            let small = "box:0,0,0,0.1,0.08,0.06,0.9,0.2,0.1,0.3";
            cases(60, PLAIN, ROUND, small)
        }),
        Regime::new("spheres that touch", || {
            let touching = "any(sphere:-0.3,0,0,0.3, sphere:0.3,0,0,0.3)";
            cases(61, PLAIN, ROUND, touching)
        }),
        Regime::new("a lens", || {
            let lens = "all(sphere:-0.99,0,0,1, sphere:0.99,0,0,1)";
            cases(62, PLAIN, ROUND, lens)
        }),
        Regime::new("a shell thinner than a pixel", || {
            let shell = "all(sphere:0,0,0,1, !sphere:0,0,0,0.999)";
            cases(63, PLAIN, ROUND, shell)
        }),
        Regime::new("a region and its complement", || {
            let all = "any(sphere:0,0,0,1, not(sphere:0,0,0,1), plane:1,0,0,-9)";
            seen(64, PLAIN, ROUND, "sphere:0,0,0,1", all)
        }),
        Regime::new("five shapes nested", || {
            let nested = "all(sphere:0,0,0,1, any(plane:1,0.2,0,0, all(!cylinder:-1,0,0,1,0.2,0,0.3, \
                          any(box:0,0,0,0.5,0.5,2, !sphere:0,0.2,0,0.4))))";
            cases(65, PLAIN, ROUND, nested)
        }),
        Regime::new("sixty spheres", || {
            let mut random = Random::new(66);
            let spheres = (0..60).map(|_| {
                let at = random.direction() * random.unit();
                format!("sphere:{},{},{},0.3", at.x, at.y, at.z)
            });
            let all = format!("any({})", spheres.collect::<Vec<_>>().join(", "));
            cases(67, PLAIN, ROUND, &all)
        }),
    ]
}

/// Standard deviations of ordinary splats, pixels.
const ROUND: [f64; 2] = [0.2, 20.0];

/// Splats of this size strewn over the border of a region that cuts them.
fn cases(seed: u64, stage: Setup, pixels: [f64; 2], region: &str) -> Vec<Case> {
    seen(seed, stage, pixels, region, region)
}

/// Splats strewn over the border of one region and cut by another: four cases of single ones and a crowd.
fn seen(seed: u64, stage: Setup, pixels: [f64; 2], border: &str, region: &str) -> Vec<Case> {
    let parsed = |text: &str| text.parse::<Expression>().expect("a region").clip();
    let crowds = [(40, true), (40, true), (40, true), (40, true), (100, false)];
    strewn(
        (seed, stage),
        pixels,
        [parsed(border), parsed(region)],
        &crowds,
    )
}

/// So many splats in each case, apart or not, over the border of one region, and cut by another.
pub(super) fn strewn(
    (seed, stage): (u64, Setup),
    pixels: [f64; 2],
    [border, clip]: [Clip; 2],
    crowds: &[(usize, bool)],
) -> Vec<Case> {
    let mut random = Random::new(seed);
    let shape = |random: &mut Random, px: f64| px * three_between(random, pixels[0], pixels[1]);
    let mut case = |&(count, apart): &(usize, bool)| {
        let camera = stage.camera(&mut random);
        let place = |random: &mut Random| on_border(random, stage, &border);
        Case {
            scene: on_surface(&mut random, &camera, &place, &shape, count, apart),
            camera,
            clip: clip.clone(),
            apart,
        }
    };
    crowds.iter().map(&mut case).collect()
}

/// A point in which a random line leaves or enters a region, and the normal of the surface there.
fn on_border(random: &mut Random, stage: Setup, region: &Clip) -> (DVec3, DVec3) {
    let any =
        |random: &mut Random| stage.centre + random.direction() * (stage.radius() * random.unit());
    for _ in 0..100_000 {
        let (mut inside, mut outside) = (any(random), any(random));
        if region.keeps(inside) == region.keeps(outside) {
            continue;
        }
        if !region.keeps(inside) {
            std::mem::swap(&mut inside, &mut outside);
        }
        for _ in 0..60 {
            let middle = 0.5 * (inside + outside);
            match region.keeps(middle) {
                true => inside = middle,
                false => outside = middle,
            }
        }
        let surfaces = region.all_surfaces();
        let nearest = surfaces.iter().min_by(|a, b| {
            let distance = |surface: &rara::Surface| surface.distance(inside).abs();
            distance(a).total_cmp(&distance(b))
        });
        let normal = nearest.expect("a region has surfaces").gradient(inside);
        return (inside, normal.normalize_or(DVec3::X));
    }
    panic!("no line crosses the region");
}
