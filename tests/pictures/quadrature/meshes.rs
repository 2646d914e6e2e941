//! The same of splats that meshes and polygons cut: convex ones, concave ones, thin ones, with holes, in each other.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};
use rara::Placement;
use rara::clip::{Expression, Inside, MeshShape, Prism, PrismBase};
use rara_scene::mesh::shapes::{self, Triangles};
use rara_scene::mesh::{Mesh, MeshRule};

use super::{CLASSES, Case, Dice, Errors, STEPS, place, splat, study};
use crate::common;

/// Random cases of each class of size. RARA_CASES has another number of them: the guide's table is of 40, 200 of all five.
const CASES: usize = 8;
/// Rays along each side of the grid of a splat that is smaller than a pixel: as many small faces are seen by few of them.
const FINE_STEPS: u32 = 120;

/// A mesh of about the size of 1, and its name.
fn mesh(dice: &mut Dice) -> (String, Triangles) {
    let number = |dice: &mut Dice, low: f64, high: f64| dice.factor(low, high).round() as u32;
    match (dice.unit() * 8.0) as u32 {
        0 => {
            let halvings = (dice.unit() * 6.0) as u32;
            (format!("sphere {halvings}"), shapes::icosphere(halvings))
        }
        1 => {
            let half = DVec3::new(1.0, dice.factor(0.1, 1.0), dice.factor(0.1, 1.0));
            (format!("box {half}"), shapes::cuboid(-half, half))
        }
        2 => {
            let [around, along] = [number(dice, 5.0, 200.0), number(dice, 4.0, 100.0)];
            (
                format!("torus {around} {along}"),
                shapes::torus(around, along),
            )
        }
        3 => {
            let halvings = (dice.unit() * 3.0) as u32;
            (format!("nested {halvings}"), shapes::nested(3, halvings))
        }
        4 => {
            let valence = number(dice, 6.0, 40.0);
            (format!("fan {valence}"), shapes::needle_fan(valence))
        }
        5 => {
            let (cells, height) = (number(dice, 2.0, 60.0), dice.factor(1e-3, 0.1));
            (
                format!("sheet {cells} {height}"),
                shapes::sheet(cells, height),
            )
        }
        _ => {
            let (faces, seed) = (number(dice, 12.0, 100_000.0), (dice.unit() * 1e6) as u64);
            (format!("star {faces} {seed}"), shapes::star(faces, seed))
        }
    }
}

/// A polygon of about the size of 1, perhaps with a hole, between two heights or without ends.
fn polygon(dice: &mut Dice) -> (String, Prism) {
    let corners = dice.factor(3.0, 100.0).round() as u32;
    let inner = dice.range(0.3, 1.0);
    let mut ring = |size: f64| -> Vec<DVec2> {
        let corner = |at: u32| {
            let angle = TAU * f64::from(at) / f64::from(corners);
            let radius = size * dice.range(inner, 1.0);
            radius * DVec2::new(angle.cos(), angle.sin())
        };
        (0..corners).map(corner).collect()
    };
    // The hole is within the circle that all edges of the polygon are outside of.
    let hole = 0.9 * inner * (TAU * 0.5 / f64::from(corners)).cos();
    let mut rings = vec![ring(1.0), ring(hole)];
    rings.truncate(1 + (dice.unit() * 2.0) as usize);
    let ends = (dice.unit() < 0.5).then(|| [-dice.range(0.1, 1.0), dice.range(0.1, 1.0)]);
    let prism = Prism::new(PrismBase::Axis("z".into()), &rings, ends).expect("a polygon");
    (
        format!("polygon of {} times {corners} corners", rings.len()),
        prism,
    )
}

/// What cuts, and a point of its surface.
fn cutter(dice: &mut Dice) -> (String, Expression, DVec3) {
    if dice.unit() < 0.25 {
        let (name, prism) = polygon(dice);
        let ring = &prism.rings()[0];
        let at = (dice.unit() * ring.len() as f64) as usize;
        let point = ring[at].lerp(ring[(at + 1) % ring.len()], dice.unit());
        let [low, high] = prism.heights().unwrap_or([-1.0, 1.0]);
        let point = point.extend(dice.range(low, high));
        return (name, Expression::Prism(prism), point);
    }
    let (name, (vertices, faces)) = mesh(dice);
    let made = Mesh::from_triangles(&vertices, &faces, MeshRule::Closed);
    let made = made.unwrap_or_else(|error| panic!("{name}: {error}"));
    let face = (dice.unit() * made.faces().len() as f64) as u32;
    let [a, b, c] = made.corners(face);
    let [mut u, mut v] = [dice.unit(), dice.unit()];
    if u + v > 1.0 {
        (u, v) = (1.0 - u, 1.0 - v);
    }
    let point = a + u * (b - a) + v * (c - a);
    let shape = MeshShape::new("made up", Inside::new(made, Placement::IDENTITY));
    (name, Expression::Mesh(shape), point)
}

/// A splat of this size in pixels, and what cuts it: .3 to 100 of its largest deviations large.
fn case(dice: &mut Dice, sizes: [f64; 2]) -> Case {
    let (gaussians, camera) = splat(dice, sizes);
    let (_, at, _) = place(dice, &gaussians);
    let (name, cutter, point) = cutter(dice);
    let scale = dice.factor(0.3, 100.0) * f64::from(gaussians.scales()[0].max_element());
    let turn = dice.turn();
    // The point of the surface comes to that place.
    let placement = Placement::new(at - turn * (scale * point), turn, scale);
    let placement = placement.expect("a place, a rotation and a size");
    let clip = cutter.placed(&placement).expect("finite numbers").clip();
    let keeps_outside = dice.unit() < 0.5;
    Case {
        steps: if sizes[0] < 1.0 { FINE_STEPS } else { STEPS },
        clip: if keeps_outside {
            clip.complement()
        } else {
            clip
        },
        gaussians,
        camera,
        region: format!(
            "{}{name}, {scale:.4} large",
            if keeps_outside { "not " } else { "" }
        ),
    }
}

#[test]
fn random_meshes_and_polygons_keep_what_integration_finds() {
    let mut headless = common::headless();
    let mut dice = Dice::new(62);
    let cases = std::env::var("RARA_CASES").map_or(CASES, |cases| cases.parse().expect("a number"));
    let cases = (cases as f64 * common::scale()) as usize;
    let mut all = Vec::new();
    for class in CLASSES {
        let mut errors = Errors::default();
        for _ in 0..cases {
            let case = case(&mut dice, class);
            study(&mut headless, &mut dice, &case, &mut errors);
        }
        println!(
            "{class:?} px: {} pixels, {} partial; mean {:.4}, over 1/255 {}, worst {:.2} ({})",
            errors.pixels,
            errors.partial,
            errors.sum / errors.pixels as f64,
            errors.over_one,
            errors.worst,
            errors.worst_case
        );
        all.push(errors);
    }
    let sum = |of: fn(&Errors) -> f64| all.iter().map(of).sum::<f64>();
    let pixels = sum(|e| e.pixels as f64);
    let (mean, over) = (sum(|e| e.sum) / pixels, sum(|e| e.over_one as f64) / pixels);
    println!("mean {mean:.4}, {:.3} % more than 1/255 off", 100.0 * over);
    assert!(sum(|e| e.partial as f64) > 0.2 * pixels);
    assert!(mean < 0.02 && over <= 1e-3, "{all:#?}");
}
