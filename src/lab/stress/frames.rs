//! Scenes that are difficult as a whole: layers, ties, opacities, colours, numbers, sizes.

use glam::{DVec3, Quat, Vec3};

use super::make::{PLAIN, Setup, any_normal, orientation, push, set_colour, strewn};
use super::places::mix;
use super::{Case, Regime};
use rara::{Camera, Clip, ClipOp, Gaussians, Plane};
use rara_scene::Random;

pub fn regimes() -> Vec<Regime> {
    vec![
        Regime::new("4000 thin layers", || vec![layers(4000, 1e-4)]),
        Regime::new("equal depths: order by number", || vec![ties()]).exact(1e-5),
        Regime::new("opacity 0, 1 and about 1/255", opacities),
        Regime::new("spherical harmonics of 1e4", bright),
        Regime {
            empty: true,
            ..Regime::new("no splat", || vec![counted(0)])
        },
        Regime::new("one splat", || vec![counted(1)]),
        Regime::new("a picture of 1x1", || sized((1, 1))),
        Regime::new("a picture of 17x251", || sized((17, 251))),
        Regime::new("coordinates to 1e38, planes to 1e300", || {
            [vast(1e-30), vast(1.0)].concat()
        }),
        Regime::new("coordinates to 1e38, scales of 1e10", || vast(1e10)),
    ]
}

/// Looks along +z at the origin, so that depths are z + 5 to the bit.
fn straight() -> Camera {
    let eye = DVec3::new(0.0, 0.0, -5.0);
    Camera::look_at(eye, DVec3::ZERO, -DVec3::Y, 46.0, (200, 200)).expect("a plain view")
}

fn oblique(offset: f64) -> Clip {
    Clip::of(
        [Plane::new(DVec3::new(1.0, 0.4, 0.3), offset).expect("a finite normal")],
        ClipOp::And,
    )
}

/// Adds a sheet across the view, whose deviations are between `low` and `high`.
fn push_sheet(
    scene: &mut Gaussians,
    random: &mut Random,
    depth: f64,
    [low, high]: [f64; 2],
    opacity: f32,
) {
    let at = DVec3::new(random.range(-1.0, 1.0), random.range(-1.0, 1.0), depth);
    let scales = DVec3::new(random.range(low, high), random.range(low, high), 1e-5);
    push(scene, at.as_vec3(), scales, Quat::IDENTITY, opacity);
    set_colour(scene, random);
}

/// Sheets across the view, `spacing` apart, which cover each other. They are shuffled, so that only the sort orders them.
fn layers(count: usize, spacing: f64) -> Case {
    let mut random = Random::new(40);
    let mut scene = Gaussians::default();
    for index in 0..count {
        // 7919 is prime to the counts: every depth once, in a scattered order.
        let depth = (index * 7919 % count) as f64 * spacing;
        push_sheet(&mut scene, &mut random, depth, [0.2, 0.5], 0.02);
    }
    Case {
        scene,
        camera: straight(),
        clip: oblique(0.05),
        apart: false,
    }
}

/// Sheets of one depth that cover the whole picture, so that every pixel shows their order and nothing else. Two
/// neighbours that change places change it by 0.0025 of the light that is left there, times the difference of their
/// colours.
fn ties() -> Case {
    let mut random = Random::new(46);
    let mut scene = Gaussians::default();
    for _ in 0..400 {
        push_sheet(&mut scene, &mut random, 0.0, [20.0, 50.0], 0.05);
    }
    Case {
        scene,
        camera: straight(),
        clip: oblique(1e6),
        apart: false,
    }
}

fn opacities() -> Vec<Case> {
    let mut random = Random::new(41);
    let least = 1.0 / 255.0;
    let values = [
        0.0,
        1e-30,
        0.5 * least,
        0.999 * least,
        least,
        1.000_001 * least,
        1.001 * least,
        1.1 * least,
        0.01,
        0.5,
        0.989,
        0.99,
        0.999,
        1.0,
    ];
    let set_opacities = |case: &mut Case| {
        let opacities = case.scene.opacities_mut().iter_mut();
        for (opacity, value) in opacities.zip(values.iter().cycle()) {
            *opacity = *value as f32;
        }
    };
    let mut case = strewn(&mut random, PLAIN, &any_normal, &mix, 60, true);
    set_opacities(&mut case);
    let mut crowd = strewn(&mut random, PLAIN, &any_normal, &mix, 400, false);
    set_opacities(&mut crowd);
    vec![case, crowd]
}

fn bright() -> Vec<Case> {
    let mut random = Random::new(42);
    let mut case = strewn(&mut random, PLAIN, &any_normal, &mix, 300, false);
    case.scene.set_sh_degree(3);
    for value in case.scene.sh_mut() {
        *value = random.range(-1e4, 1e4) as f32;
    }
    vec![case]
}

fn counted(count: usize) -> Case {
    strewn(&mut Random::new(43), PLAIN, &any_normal, &mix, count, true)
}

fn sized(size: (u32, u32)) -> Vec<Case> {
    let stage = Setup { size, ..PLAIN };
    let mut random = Random::new(44);
    let mut one = |index: usize| {
        let (count, apart) = if index == 0 { (200, false) } else { (20, true) };
        strewn(&mut random, stage, &any_normal, &mix, count, apart)
    };
    (0..8).map(&mut one).collect()
}

/// Positions, scales and planes that no scene has but a file can hold.
fn vast(scale: f64) -> Vec<Case> {
    let mut random = Random::new(45);
    let sizes = [1e3, 1e6, 1e10, 1e18, 1e25, 1e30, 1e36, 3e38];
    let case = |random: &mut Random, scale: f64, clip: Clip| {
        let mut scene = Gaussians::default();
        for size in sizes {
            let axis = DVec3::new(0.2 * random.unit(), 0.2 * random.unit(), 1.0);
            for at in [axis * size, DVec3::new(size, 1.0, 3.0), DVec3::Z * size] {
                let scales = DVec3::new(scale, scale * 0.5, scale * 0.1);
                let position = at.as_vec3().clamp(Vec3::splat(-3e38), Vec3::splat(3e38));
                push(&mut scene, position, scales, orientation(random), 0.6);
                set_colour(&mut scene, random);
            }
        }
        Case {
            scene,
            camera: straight(),
            clip,
            apart: false,
        }
    };
    let mut cases = Vec::new();
    for offset in [0.0, 1e10, -1e36, 1e300] {
        cases.push(case(&mut random, scale, oblique(offset)));
    }
    cases
}
