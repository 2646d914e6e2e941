//! The share of a normal distribution that lies within a closed mesh, as a sum over its faces; glsl/region/face_mass.glsl says how. Here it
//! is in double precision, over all faces that come near, and by ten points on an edge.

use std::f64::consts::{FRAC_1_PI, PI};

use glam::{DMat3, DVec3};
use libm::erf;
use rara_scene::mesh::Mesh;

/// Beyond so many deviations nothing counts.
const REACH: f64 = 7.0;
/// A vertex has no solid angle as seen from itself: the mean is this much aside of where it could be one.
const NUDGE: DVec3 = DVec3::new(1.1e-8, -2.3e-8, 1.7e-8);
/// A sum may be off by so much.
const DOUBT: f64 = 1e-3;
/// An edge's points are at equal steps of the angle at which they are seen from this far.
const EDGE_REACH: f64 = 2.0;
/// Gauss and Legendre's ten points and weights, of which the others are the same on the other side.
const POINTS: [[f64; 2]; 5] = [
    [0.148_874_338_981_631_2, 0.295_524_224_714_752_9],
    [0.433_395_394_129_247_2, 0.269_266_719_309_996_4],
    [0.679_409_568_299_024_4, 0.219_086_362_515_982_04],
    [0.865_063_366_688_984_5, 0.149_451_349_150_580_6],
    [0.973_906_528_517_171_7, 0.066_671_344_308_688_14],
];

/// (Phi(r) - 1/2)/r, of r squared.
fn excess(square: f64) -> f64 {
    let r = square.sqrt();
    match r < 1e-4 {
        true => (0.5 * FRAC_1_PI).sqrt() * (1.0 - square / 6.0),
        false => 0.5 * erf(r * 0.5_f64.sqrt()) / r,
    }
}

/// An edge of a face, whose ends are as seen from the foot of the mean on its plane, at the distance p.
struct Edge {
    /// How far its line is on the inner side of the foot.
    aside: f64,
    /// The integral of p/r over its angle about the foot, where r is its distance from the mean.
    turn: f64,
    /// The integral of what the face's solid angle is too large by.
    rest: f64,
}

impl Edge {
    fn new([a, b]: [DVec3; 2], normal: DVec3, p: f64) -> Option<Self> {
        let along = (b - a).try_normalize()?;
        let aside = a.cross(along).dot(normal);
        let [start, end] = [a, b].map(|corner| corner.dot(along));
        let [from, to] = [a, b].map(|corner| corner.length().hypot(p));
        // The difference of two arctangents of p t / (aside r).
        let turn = (p * aside * (end * from - start * to))
            .atan2(aside * aside * from * to + p * p * start * end);
        let reach = aside.hypot(EDGE_REACH);
        let [from, to] = [start, end].map(|place| (place / reach).atan());
        let (middle, half) = (from.midpoint(to), 0.5 * (to - from));
        let at = |[point, weight]: [f64; 2]| {
            let slope = (middle + half * point).tan();
            let square = aside * aside + reach * reach * slope * slope;
            let change = excess(p * p) - excess(p * p + square);
            weight * (1.0 + slope * slope) * change / square.max(1e-20)
        };
        let both = |&[point, weight]: &[f64; 2]| at([point, weight]) + at([-point, weight]);
        let rest = 2.0 * p * aside * reach * half * POINTS.iter().map(both).sum::<f64>();
        Some(Self { aside, turn, rest })
    }
}

/// The share of the distribution of deviations 1 and mean 0 that a face hides; negative where its front is seen from the mean.
fn face_mass([a, b, c]: [DVec3; 3]) -> f64 {
    let Some(normal) = (b - a).cross(c - a).try_normalize() else {
        return 0.0;
    };
    let p = normal.dot(a);
    if p.abs() > REACH {
        return 0.0;
    }
    let [a, b, c] = [a, b, c].map(|corner| corner - p * normal);
    let edges = [[a, b], [b, c], [c, a]].map(|ends| Edge::new(ends, normal, p));
    let edges = || edges.iter().flatten();
    let is_over = edges().all(|edge| edge.aside > 0.0);
    let whole = if is_over { p.signum() * 2.0 * PI } else { 0.0 };
    let hidden: f64 = edges().map(|edge| edge.turn + edge.rest).sum();
    (whole - hidden) / (4.0 * PI)
}

/// The share of a normal distribution of this mean and these deviations, the columns, that lies within a mesh that does not cut itself.
pub(super) fn mesh_share(mesh: &Mesh, mean: DVec3, deviations: DMat3) -> f64 {
    let mut faces = Vec::new();
    mesh.faces_in_ball(mean, deviations, REACH, &mut faces);
    let even = deviations.inverse();
    let hidden = |face: &u32| {
        face_mass(
            mesh.corners(*face)
                .map(|corner| even * (corner - mean) - NUDGE),
        )
    };
    let sum: f64 = faces.iter().map(hidden).sum();
    let share = (-sum).rem_euclid(1.0);
    // Where hardly anything is kept or dropped, rounding does not say which; whether the mesh is around the mean does, but on a face.
    let whole = (f64::from(u8::from(mesh.keeps(mean + deviations * NUDGE))) - sum - share).round();
    let known = share + whole;
    match (-DOUBT..=1.0 + DOUBT).contains(&known) {
        true => known.clamp(0.0, 1.0),
        false => share,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::real::Real;
    use rara_scene::mesh::{MeshRule, shapes};

    #[test]
    fn a_box_holds_what_three_normal_distributions_say() {
        // The second has faces like needles.
        for half in [DVec3::new(1.0, 0.7, 2.0), DVec3::new(0.02, 0.03, 40.0)] {
            let (vertices, faces) = shapes::cuboid(-half, half);
            let mesh = Mesh::from_triangles(&vertices, &faces, MeshRule::Closed).expect("a box");
            for mean in [
                DVec3::ZERO,
                half,
                half * 0.999_999,
                DVec3::new(0.3, -0.7, 3.0),
                DVec3::new(-2.0, 0.1, 0.2),
            ] {
                for size in [0.01, 0.3, 1.0, 4.0] {
                    let along = |axis: usize| {
                        let to = |end: f64| Real::phi((end - mean[axis]) / size);
                        to(half[axis]) - to(-half[axis])
                    };
                    let share = mesh_share(&mesh, mean, DMat3::from_diagonal(DVec3::splat(size)));
                    let expected = along(0) * along(1) * along(2);
                    assert!(
                        (share - expected).abs() < 1e-6,
                        "{mean} {size}: {share}, not {expected}"
                    );
                }
            }
        }
    }
}
