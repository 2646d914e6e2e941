//! The insides of meshes.

use glam::DVec3;

use super::make::{PLAIN, Setup};
use super::regions::strewn;
use super::{Case, Regime};
use rara::clip::{ClipOp, Inside};
use rara::{Clip, Mesh, MeshRule, Placement};
use rara_scene::mesh::shapes::{self, Triangles};

/// A limit of one level of 255.
const FITTED: &str = "a sheet of small faces is drawn as the quadric that fits it, if no pixel's alpha changes by more than half a level, and the \
                      sum over faces has four points on an edge";

pub fn regimes() -> Vec<Regime> {
    vec![
        Regime::new("a mesh of a box", || {
            cases(
                70,
                SMALL,
                shapes::cuboid(DVec3::splat(-0.4), DVec3::splat(0.4)),
            )
        }),
        limited("a mesh of a sphere", || {
            cases(71, SMALL, shapes::icosphere(5))
        }),
        limited("a mesh that is smaller than a splat", || {
            let (vertices, faces) = shapes::star(300, 1);
            let vertices = vertices.into_iter().map(|at| 0.02 * at).collect();
            cases(72, LARGE, (vertices, faces))
        }),
        limited("a sheet thinner than a splat", || {
            cases(73, SMALL, shapes::sheet(20, 0.01))
        }),
        limited("needles that meet in a vertex", || {
            cases(74, SMALL, shapes::needle_fan(40))
        }),
        limited("shells in each other", || {
            cases(75, SMALL, shapes::nested(3, 2))
        }),
        limited("a mesh of 50 000 faces", || {
            cases(76, LARGE, shapes::star(50_000, 3))
        }),
    ]
}

/// Standard deviations of splats, pixels.
const SMALL: [f64; 2] = [0.2, 6.0];
const LARGE: [f64; 2] = [2.0, 12.0];

fn limited(name: &'static str, cases: fn() -> Vec<Case>) -> Regime {
    Regime::new(name, cases).limited(4e-3, 50.0, FITTED)
}

/// Few splats, each cut by what many faces leave: the truth looks at all of these.
fn cases(seed: u64, pixels: [f64; 2], (vertices, faces): Triangles) -> Vec<Case> {
    let mesh = Mesh::from_triangles(&vertices, &faces, MeshRule::Closed).expect("a closed mesh");
    let clip = Clip::of([Inside::new(mesh, Placement::IDENTITY)], ClipOp::And);
    let stage = Setup {
        size: (128, 128),
        ..PLAIN
    };
    let crowds = [(12, true), (12, true), (30, false)];
    strewn((seed, stage), pixels, [clip.clone(), clip], &crowds)
}
