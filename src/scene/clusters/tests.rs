use super::*;
use crate::generate::{Kind, Random, generate};
use glam::{Quat, Vec3};

fn made(all: &[(Vec3, Vec3, Quat)]) -> Gaussians {
    let mut made = Gaussians::default();
    for &(centre, scale, turn) in all {
        made.push(centre, scale, turn, 0.5, &[0.0; 3]);
    }
    made
}

fn sizes(gaussians: &Gaussians) -> Vec<u32> {
    let clusters = Clusters::of(gaussians);
    (0..gaussians.len())
        .map(|index| clusters.size_at(index))
        .collect()
}

#[test]
fn gaussians_touch_where_their_ellipsoids_do() {
    let thin = Vec3::new(1.0, 0.01, 0.01);
    let along = |x: f32| (Vec3::X * x, thin, Quat::IDENTITY);
    // Two standard deviations of each: they touch up to a distance of 4 along the needles, and of 0.04 across.
    assert_eq!(sizes(&made(&[along(0.0), along(3.9)])), [2, 2]);
    assert_eq!(sizes(&made(&[along(0.0), along(4.1)])), [1, 1]);
    let beside = |y: f32| (Vec3::Y * y, thin, Quat::IDENTITY);
    assert_eq!(sizes(&made(&[along(0.0), beside(0.039)])), [2, 2]);
    assert_eq!(sizes(&made(&[along(0.0), beside(0.041)])), [1, 1]);
    let turned = Quat::from_rotation_z(std::f32::consts::FRAC_PI_2);
    assert_eq!(
        sizes(&made(&[along(0.0), (Vec3::Y * 1.9, thin, turned)])),
        [2, 2]
    );
    // One by the next, whatever their sizes and however far from zero they are.
    let chain: Vec<_> = (0..12)
        .map(|at| {
            let size = 0.5_f32.powi(at);
            (
                Vec3::new(1e4 + 4.0 * size, 0.0, 0.0),
                Vec3::splat(size),
                Quat::IDENTITY,
            )
        })
        .chain([(Vec3::new(1e4, 9.0, 0.0), Vec3::ZERO, Quat::IDENTITY)])
        .collect();
    let clusters = Clusters::of(&made(&chain));
    assert_eq!(clusters.sizes(), [12, 1]);
    assert!(clusters.is_in_largest(3) && !clusters.is_in_largest(12));
}

#[test]
fn clusters_are_those_of_all_pairs() {
    let mut random = Random::new(7);
    for seed in 0..6 {
        let mut scene = generate(Kind::General, 400, seed);
        for (index, centre) in scene.positions_mut().iter_mut().enumerate() {
            let apart = if index % 3 == 0 { 10.0 } else { 0.3 };
            *centre += (apart * random.in_ball()).as_vec3();
        }
        for (index, scale) in scene.scales_mut().iter_mut().enumerate() {
            *scale *= 2_f32.powi(index as i32 % 9 - 6);
        }
        let bodies: Vec<_> = (0..scene.len()).map(|i| Body::of(&scene, i)).collect();
        let mut sets = Sets::new(bodies.len());
        for a in 0..bodies.len() {
            for b in 0..a {
                if bodies[a].touches(&bodies[b]) {
                    sets.join(a as u32, b as u32);
                }
            }
        }
        let all = sets.clusters();
        assert!(all.sizes()[0] > 3 && all.sizes().len() > 20, "{all:?}");
        assert_eq!(Clusters::of(&scene), all, "{seed}");
    }
}

#[test]
fn points_and_nothing_have_clusters() {
    assert!(Clusters::of(&Gaussians::default()).sizes().is_empty());
    let points: Vec<_> = (0..3_000)
        .map(|at| (Vec3::X * (at / 3) as f32, Vec3::ZERO, Quat::IDENTITY))
        .collect();
    assert_eq!(Clusters::of(&made(&points)).sizes(), vec![3; 1_000]);
}
