mod ball;
mod checks;
#[cfg(feature = "formats")]
mod faces;
#[cfg(feature = "formats")]
mod files;
mod inside;
mod lines;
mod packed;
#[cfg(feature = "formats")]
mod read;
mod repairs;
mod times;
mod tree;

use glam::DVec3;

use super::shapes::{self, Triangles};
use super::{Mesh, MeshRule};
use crate::generate::Random;

fn mesh((vertices, faces): Triangles) -> Mesh {
    Mesh::from_triangles(&vertices, &faces, MeshRule::Closed)
        .unwrap_or_else(|error| panic!("{error}"))
}

/// Closed meshes of all kinds, named.
fn all() -> Vec<(&'static str, Mesh)> {
    let mut apart = shapes::icosphere(1);
    let beside = shapes::icosphere(2);
    let moved = beside.0.iter().map(|at| *at + DVec3::new(2.5, 0.3, 0.0));
    shapes::join(&mut apart, (moved.collect(), beside.1));
    let far = shapes::star(300, 3);
    let far = far.0.iter().map(|at| *at * 1e-3 + 1e4).collect::<Vec<_>>();
    let shapes = [
        ("a cube", shapes::cuboid(DVec3::ZERO, DVec3::ONE)),
        ("an icosahedron", shapes::icosphere(0)),
        ("a sphere", shapes::icosphere(3)),
        ("a torus", shapes::torus(24, 12)),
        ("nested spheres", shapes::nested(4, 2)),
        ("a fan of needles", shapes::needle_fan(40)),
        ("a thin sheet", shapes::sheet(8, 1e-6)),
        ("a coarse star", shapes::star(12, 1)),
        ("a star", shapes::star(2_000, 2)),
        ("a star far away", (far, shapes::star(300, 3).1)),
        ("two spheres", apart),
    ];
    shapes.map(|(name, shape)| (name, mesh(shape))).into()
}

/// A point in the box of a mesh, which is taken a bit larger.
fn point_near(mesh: &Mesh, random: &mut Random) -> DVec3 {
    let within = DVec3::new(
        random.range(-1.1, 1.1),
        random.range(-1.1, 1.1),
        random.range(-1.1, 1.1),
    );
    let [low, high] = mesh.bounds();
    mesh.centre() + within * 0.5 * (high - low)
}

/// The winding number by the solid angles of all faces (Van Oosterom and Strackee 1983), which is a fraction in an open mesh.
fn by_angles(mesh: &Mesh, point: DVec3) -> f64 {
    let mut sum = 0.0;
    for face in 0..mesh.faces().len() as u32 {
        let [a, b, c] = mesh.corners(face).map(|corner| corner - point);
        let [la, lb, lc] = [a.length(), b.length(), c.length()];
        let above = a.dot(b.cross(c));
        let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        sum += 2.0 * above.atan2(below);
    }
    sum / (4.0 * std::f64::consts::PI)
}

/// Vertices, middles of edges and of faces of a mesh, some of each, exactly there as far as numbers can be.
fn special_points(mesh: &Mesh, random: &mut Random) -> Vec<DVec3> {
    let mut points = Vec::new();
    for _ in 0..60 {
        let face = (random.unit() * mesh.faces().len() as f64) as u32;
        let [a, b, c] = mesh.corners(face);
        points.extend([a, 0.5 * (a + b), (a + b + c) / 3.0]);
    }
    points
}
