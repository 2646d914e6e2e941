//! Meshes for tests and measurements, as vertices and faces.

use std::collections::HashMap;
use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use crate::generate::Random;

/// Vertices and faces.
pub type Triangles = (Vec<DVec3>, Vec<[u32; 3]>);

/// A sphere: an icosahedron of radius 1 whose edges are halved so many times. It has 20 4^n faces.
pub fn icosphere(halvings: u32) -> Triangles {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let mut vertices = Vec::new();
    for (a, b) in [
        (-1.0, golden),
        (1.0, golden),
        (-1.0, -golden),
        (1.0, -golden),
    ] {
        vertices.push(DVec3::new(a, b, 0.0));
        vertices.push(DVec3::new(0.0, a, b));
        vertices.push(DVec3::new(b, 0.0, a));
    }
    for vertex in &mut vertices {
        *vertex = vertex.normalize();
    }
    // Each three that are at the length of an edge from each other.
    let edge = 2.0 / (1.0 + golden * golden).sqrt();
    let is_edge = |a: usize, b: usize| vertices[a].distance(vertices[b]) < 1.01 * edge;
    let mut faces = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if is_edge(a, b) && is_edge(b, c) && is_edge(c, a) {
                    let up = (vertices[b] - vertices[a]).cross(vertices[c] - vertices[a]);
                    let is_out = up.dot(vertices[a]) > 0.0;
                    let [a, b, c] = [a, b, c].map(|at| at as u32);
                    faces.push(if is_out { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    for _ in 0..halvings {
        let mut middles = HashMap::new();
        let mut halved = Vec::with_capacity(4 * faces.len());
        for [a, b, c] in faces {
            let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(from, to): (u32, u32)| {
                *middles
                    .entry((from.min(to), from.max(to)))
                    .or_insert_with(|| {
                        let middle = vertices[from as usize] + vertices[to as usize];
                        vertices.push(middle.normalize());
                        vertices.len() as u32 - 1
                    })
            });
            halved.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        faces = halved;
    }
    (vertices, faces)
}

/// The prism of a regular polygon of radius 1, as far up as down: of walls like needles if it is tall.
pub fn prism(corners: u32, height: f64) -> Triangles {
    let ring = |z: f64| {
        let angle = move |at: u32| f64::from(at) * TAU / f64::from(corners);
        let corner = move |at: u32| DVec2::from_angle(angle(at)).extend(z);
        (0..corners).map(corner)
    };
    let ends = [-height, height].map(|z| DVec3::new(0.0, 0.0, z));
    let vertices = ring(-height).chain(ring(height)).chain(ends).collect();
    let [low, high] = [2 * corners, 2 * corners + 1];
    let faces = (0..corners).flat_map(|a| {
        let b = (a + 1) % corners;
        let (over_a, over_b) = (a + corners, b + corners);
        [
            [a, b, over_b],
            [a, over_b, over_a],
            [low, b, a],
            [high, over_a, over_b],
        ]
    });
    (vertices, faces.collect())
}

/// The box between two corners.
pub fn cuboid(low: DVec3, high: DVec3) -> Triangles {
    let corner = |at: u32| {
        let pick = |axis: usize| {
            if at >> axis & 1 == 1 {
                high[axis]
            } else {
                low[axis]
            }
        };
        DVec3::new(pick(0), pick(1), pick(2))
    };
    let mut faces = Vec::new();
    for axis in 0..3 {
        let (x, y, z) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3), 1 << axis);
        faces.extend([[0, y, x + y], [0, x + y, x]]);
        faces.extend([[z, z + x, z + x + y], [z, z + x + y, z + y]]);
    }
    ((0..8).map(corner).collect(), faces)
}

/// A torus about z whose ring of radius 1 has `around` divisions, and its tube of radius 0.4 has `along`.
pub fn torus(around: u32, along: u32) -> Triangles {
    let vertex = |at: u32| {
        let angle = |number: u32, of: u32| TAU * f64::from(number) / f64::from(of);
        let (ring, tube) = (angle(at / along, around), angle(at % along, along));
        let radius = 1.0 + 0.4 * tube.cos();
        DVec3::new(radius * ring.cos(), radius * ring.sin(), 0.4 * tube.sin())
    };
    let faces = (0..around).flat_map(|ring| {
        (0..along).flat_map(move |tube| {
            let at = |ring: u32, tube: u32| (ring % around) * along + tube % along;
            let (a, b) = (at(ring, tube), at(ring + 1, tube));
            let (c, d) = (at(ring + 1, tube + 1), at(ring, tube + 1));
            [[a, b, c], [a, c, d]]
        })
    });
    ((0..around * along).map(vertex).collect(), faces.collect())
}

/// So many spheres of 20 4^n faces in each other, the outer one of radius 1.
pub fn nested(shells: u32, halvings: u32) -> Triangles {
    let mut all = (Vec::new(), Vec::new());
    for shell in 0..shells {
        let (vertices, faces) = icosphere(halvings);
        let radius = f64::from(shells - shell) / f64::from(shells);
        join(
            &mut all,
            (vertices.iter().map(|at| radius * at).collect(), faces),
        );
    }
    all
}

/// Adds the triangles of another mesh.
pub fn join(to: &mut Triangles, (vertices, faces): Triangles) {
    let first = to.0.len() as u32;
    to.0.extend(vertices);
    to.1.extend(
        faces
            .into_iter()
            .map(|face| face.map(|vertex| first + vertex)),
    );
}

/// A flat double cone with so many narrow faces at either tip, each a hundred times as long as wide for 40 and more.
pub fn needle_fan(valence: u32) -> Triangles {
    let rim = |at: u32| {
        let angle = TAU * f64::from(at) / f64::from(valence);
        let radius = if at.is_multiple_of(2) { 1.0 } else { 0.8 };
        DVec3::new(radius * angle.cos(), radius * angle.sin(), 0.0)
    };
    let mut vertices: Vec<DVec3> = (0..valence).map(rim).collect();
    vertices.extend([DVec3::new(0.0, 0.0, 0.1), DVec3::new(0.0, 0.0, -0.1)]);
    let faces = (0..valence).flat_map(|at| {
        let next = (at + 1) % valence;
        [[at, next, valence], [next, at, valence + 1]]
    });
    (vertices, faces.collect())
}

/// A sheet of `cells` by `cells` squares of a height, which waves.
pub fn sheet(cells: u32, height: f64) -> Triangles {
    let across = cells + 1;
    let vertex = |at: u32, up: f64| {
        let part = |number: u32| f64::from(number) / f64::from(cells) * 2.0 - 1.0;
        let (x, y) = (part(at % across), part(at / across));
        DVec3::new(x, y, 0.1 * (3.0 * x).sin() * (2.0 * y).cos() + up)
    };
    let layer = across * across;
    let mut vertices: Vec<DVec3> = (0..layer).map(|at| vertex(at, 0.5 * height)).collect();
    vertices.extend((0..layer).map(|at| vertex(at, -0.5 * height)));
    let mut faces = Vec::new();
    for at in (0..cells * across).filter(|at| at % across < cells) {
        let (a, b, c, d) = (at, at + 1, at + 1 + across, at + across);
        faces.extend([[a, b, c], [a, c, d]]);
        faces.extend([[a, c, b], [a, d, c]].map(|face| face.map(|vertex| layer + vertex)));
    }
    for at in 0..cells {
        let sides = [
            (at + 1, at),
            (at + cells * across, at + 1 + cells * across),
            (at * across, (at + 1) * across),
            ((at + 1) * across + cells, at * across + cells),
        ];
        for (from, to) in sides {
            faces.extend([[from, to, layer + to], [from, layer + to, layer + from]]);
        }
    }
    (vertices, faces)
}

/// A random closed mesh that is seen whole from the origin, of about so many faces, 12 at least: a sphere whose vertices have
/// random distances, from 0.1 to 1.1.
pub fn star(faces: u32, seed: u64) -> Triangles {
    let mut random = Random::new(seed);
    let rings = ((f64::from(faces) / 4.0).sqrt().round() as u32).max(2);
    let around = (faces / (2 * (rings - 1).max(1))).max(3);
    // Rings from pole to pole, the directions of each turned a bit.
    let mut vertices = vec![DVec3::Z];
    for ring in 1..rings {
        let height = (TAU * 0.5 * f64::from(ring) / f64::from(rings)).cos();
        let radius = (1.0 - height * height).sqrt();
        for at in 0..around {
            let angle = TAU * (f64::from(at) + 0.5 * f64::from(ring)) / f64::from(around);
            vertices.push(DVec3::new(
                radius * angle.cos(),
                radius * angle.sin(),
                height,
            ));
        }
    }
    vertices.push(-DVec3::Z);
    // Coarse ones are all spikes. Fine ones have bumps, and spikes about as high as their faces are long.
    let bumps: Vec<_> = (0..8)
        .map(|_| (random.direction(), random.range(2.0, 6.0)))
        .collect();
    let spike = (2.0 / f64::from(rings)).min(0.65);
    for vertex in &mut vertices {
        let bump = |(along, times): &(DVec3, f64)| (times * along.dot(*vertex)).sin();
        let height = bumps.iter().map(bump).sum::<f64>() / 8.0;
        *vertex *= (0.65 + 0.5 * (0.65 - spike) * height) * (1.0 + spike * random.range(-0.8, 0.8));
    }
    let at = |ring: u32, place: u32| 1 + (ring - 1) * around + place % around;
    let last = vertices.len() as u32 - 1;
    let mut made = Vec::new();
    for place in 0..around {
        made.push([0, at(1, place), at(1, place + 1)]);
        made.push([last, at(rings - 1, place + 1), at(rings - 1, place)]);
        for ring in 1..rings - 1 {
            let (a, b) = (at(ring, place), at(ring, place + 1));
            let (c, d) = (at(ring + 1, place + 1), at(ring + 1, place));
            made.extend([[a, d, b], [b, d, c]]);
        }
    }
    (vertices, made)
}
