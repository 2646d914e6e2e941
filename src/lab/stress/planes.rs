//! Planes at extreme angles and in extreme company.

use glam::DVec3;

use super::make::{PLAIN, any_normal, axes, cases, on_plane, pop};
use super::places::mix;
use super::{Case, Regime};
use rara::{Camera, Clip, ClipOp, Plane, Surface};
use rara_scene::Random;

pub fn regimes() -> Vec<Regime> {
    vec![
        Regime::new("grazing plane, n.d = 1e-2", || grazing(1e-2)),
        Regime::new("grazing plane, n.d = 1e-4", || grazing(1e-4)),
        Regime::new("grazing plane, n.d = 1e-6", || grazing(1e-6)),
        Regime::new("grazing plane, n.d = 1e-9", || grazing(1e-9)),
        Regime::new("plane through the eye", || grazing(0.0)),
        Regime::new("plane parallel to the view direction", parallel),
        Regime::new("plane facing the camera", || {
            cases(22, PLAIN, &|_, camera| axes(camera).z_axis, &mix)
        }),
        Regime::new("opposed planes", || {
            together(ClipOp::And, |p| vec![p, back(p, 0.0)])
        }),
        Regime::new("opposed planes, either", || {
            together(ClipOp::Or, |p| vec![p, back(p, 0.0)])
        }),
        Regime::new("a slab", || {
            together(ClipOp::And, |p| vec![p, back(p, 0.02)])
        }),
        Regime::new("duplicate planes", || together(ClipOp::And, again)),
        Regime::new("duplicate planes, either", || together(ClipOp::Or, again)),
        Regime::new("the edge of two planes", || edge(ClipOp::And, 2)),
        Regime::new("the edge of two planes, either", || edge(ClipOp::Or, 2)),
        Regime::new("the edge of three planes", || edge(ClipOp::And, 3)),
        Regime::new("the edge of six planes, either", || edge(ClipOp::Or, 6)),
        Regime::new("32 planes", || {
            together(ClipOp::And, |p| {
                let turn = |i: u32| {
                    let tilt = DVec3::new(f64::from(i).sin(), f64::from(i).cos(), 0.3) * 0.02;
                    plane(p.normal() + tilt, p.offset() + 0.01 * f64::from(i % 5))
                };
                (0..32).map(turn).collect()
            })
        }),
    ]
}

/// One plane three times, a rounding apart, since planes that are the same to the bit count as one before anything is
/// drawn.
fn again(p: Plane) -> Vec<Plane> {
    let beside = |by: f64| plane(p.normal(), p.offset() + by);
    vec![p, beside(1e-13), beside(-1e-13)]
}

/// Planes through the middle of the picture that stand almost along the line of sight; at a tilt of 0 they go through the
/// eye.
fn grazing(tilt: f64) -> Vec<Case> {
    let normal = move |random: &mut Random, camera: &Camera| {
        let axes = axes(camera);
        let turn = random.range(0.0, std::f64::consts::TAU);
        let across = axes.x_axis * turn.cos() + axes.y_axis * turn.sin();
        across * (1.0 - tilt * tilt).sqrt() + axes.z_axis * tilt
    };
    cases(20, PLAIN, &normal, &mix)
}

/// Planes parallel to the view direction, but beside the eye.
fn parallel() -> Vec<Case> {
    let mut cases = grazing(0.0);
    for case in &mut cases {
        let shift = first_normal(case) * 0.4;
        case.camera.eye -= shift;
    }
    cases
}

/// Cuts by several planes that follow from one.
fn together(op: ClipOp, planes: fn(Plane) -> Vec<Plane>) -> Vec<Case> {
    let mut random = Random::new(23);
    let mut one = |index: usize| {
        let camera = PLAIN.camera(&mut random);
        let apart = index > 0;
        let first = plane(any_normal(&mut random, &camera), 0.0);
        let count = if apart { 40 } else { 100 };
        let scene = on_plane(&mut random, PLAIN, &camera, &first, &mix, count, apart);
        Case {
            scene,
            camera,
            clip: Clip::of(planes(first), op),
            apart,
        }
    };
    (0..4).map(&mut one).collect()
}

/// Small splats along the line in which all planes meet, so that all planes cut all of them. These are the splats that
/// the low-pass widens most.
fn edge(op: ClipOp, count: usize) -> Vec<Case> {
    let small = |random: &mut Random, px: f64| mix(random, px) * 0.05;
    let mut cases = cases(24, PLAIN, &any_normal, &small);
    let mut random = Random::new(25);
    for case in &mut cases {
        let first = first_normal(case);
        let line = first.cross(axes(&case.camera).z_axis).normalize();
        let scene = &mut case.scene;
        while case.apart && scene.len() > 20 {
            pop(scene);
        }
        let middle = scene.len() as f64 / 2.0;
        let step = 2.0 * PLAIN.radius() / scene.len() as f64;
        for (index, position) in scene.positions_mut().iter_mut().enumerate() {
            *position = (line * ((index as f64 - middle) * step)).as_vec3();
        }
        let mut turned = |_| {
            let turn = random.range(-1.2, 1.2);
            plane(first * turn.cos() + first.cross(line) * turn.sin(), 0.0)
        };
        let more = (1..count).map(&mut turned).map(Surface::from);
        case.clip.surfaces.extend(more);
        case.clip.op = op;
    }
    cases
}

fn first_normal(case: &Case) -> DVec3 {
    let plane = case.clip.surfaces[0].as_plane();
    plane.expect("a plane").normal()
}

fn plane(normal: DVec3, offset: f64) -> Plane {
    Plane::new(normal, offset).expect("a finite normal")
}

/// The other side of a plane, moved so that both keep a slab of this thickness.
fn back(p: Plane, thickness: f64) -> Plane {
    plane(-p.normal(), thickness - p.offset())
}
