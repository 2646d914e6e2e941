use super::*;
use crate::placement::Placement;
use crate::{Gaussians, LayerState};
use glam::{DQuat, Quat, Vec3};

fn line(positions: impl Iterator<Item = f32>) -> Gaussians {
    let mut line = Gaussians::default();
    for x in positions {
        let at = Vec3::new(x, 0.0, 0.0);
        line.push(at, Vec3::ZERO, Quat::IDENTITY, 1.0, &[0.0; 3]);
    }
    line
}

#[test]
fn far_strays_do_not_count() {
    let scene = line(
        (0..=1000)
            .map(|i| i as f32 / 1000.0)
            .chain([1e30, -1e30, 1e6]),
    );
    let bounds = Bounds::of(&scene);
    assert!(
        (bounds.min.x - 0.01).abs() < 0.003 && (bounds.max.x - 0.99).abs() < 0.003,
        "{bounds:?}"
    );
    let (low, high) = extent_along(&scene, DVec3::new(-2.0, 1.0, 0.0));
    assert!(
        (low + 1.98).abs() < 0.008 && (high + 0.02).abs() < 0.008,
        "{low} {high}"
    );
}

/// What the guide says of them: percentiles of the centres, and the median Gaussian's size beyond.
#[test]
fn one_percent_lies_beyond_each_end_but_for_the_size_of_the_median_gaussian() {
    let mut random = crate::Random::new(7);
    for count in [1, 2, 3, 49, 51, 52, 100, 151, 152, 1000, 4000] {
        for large in [0.0, 0.3, 50.0] {
            let mut scene = Gaussians::default();
            for _ in 0..count {
                let at = Vec3::from([(); 3].map(|()| random.normal(2.0, 1.0).powi(3) as f32));
                let scale = Vec3::from([(); 3].map(|()| random.range(0.0, 2.0) as f32));
                scene.push(at, large * scale, Quat::IDENTITY, 1.0, &[0.0; 3]);
            }
            let sizes = scene.scales().iter().map(|scale| scale.max_element());
            let mut sizes: Vec<f32> = sizes.collect();
            sizes.sort_by(f32::total_cmp);
            let size = f64::from(sizes[count / 2]);
            let bounds = Bounds::of(&scene);
            for axis in 0..3 {
                let along = scene.positions().iter().map(|at| f64::from(at[axis]));
                let mut along: Vec<f64> = along.collect();
                along.sort_by(f64::total_cmp);
                let beyond = (0.01 * (count - 1) as f64).round() as usize;
                let (low, high) = (along[beyond], along[count - 1 - beyond]);
                let by = size.max(1e-6 * (1.0 + low.abs().max(high.abs())));
                let off =
                    (bounds.min[axis] - low + by).abs() + (bounds.max[axis] - high - by).abs();
                assert!(
                    off < 1e-9,
                    "{count} {large}: {bounds:?}, {low} to {high} and {by}"
                );
            }
        }
    }
}

#[test]
fn layers_count_where_they_are_placed_and_visible() {
    let scene = line((0..=1000).map(|i| i as f32 / 1000.0));
    let turn = DQuat::from_axis_angle(DVec3::Z, 90_f64.to_radians());
    let placement = Placement::new(DVec3::new(5.0, 0.0, 0.0), turn, 2.0).unwrap();
    let placed = LayerState::default().placement(placement);
    let hidden = LayerState::default().visible(false);
    let layers = [placed, hidden].map(|state| Layer::new("line", &scene).with(state));
    let bounds = Bounds::of(Scene::from_iter(layers));
    // From (5, 0, 0) along y.
    let corners = [DVec3::new(5.0, 0.02, 0.0), DVec3::new(5.0, 1.98, 0.0)];
    assert!(bounds.min.distance(corners[0]) < 0.01, "{bounds:?}");
    assert!(bounds.max.distance(corners[1]) < 0.01, "{bounds:?}");
}

#[test]
fn no_scene_has_empty_bounds() {
    for scene in [
        line([].into_iter()),
        line([3.0].into_iter()),
        line([3.0, 4.0].into_iter()),
        line([1e30; 9].into_iter()),
    ] {
        let bounds = Bounds::of(&scene);
        assert!(
            bounds.min.cmplt(bounds.max).all() && bounds.radius() > 0.0,
            "{bounds:?}"
        );
        assert!(bounds.centre().is_finite());
    }
    let unit = Bounds::of(&Gaussians::default());
    assert!((unit.min + 0.5).length() < 1e-5 && (unit.max - 0.5).length() < 1e-5);
}

#[test]
fn corners_are_all_eight() {
    let bounds = Bounds {
        min: DVec3::ZERO,
        max: DVec3::ONE,
    };
    let corners = bounds.corners();
    assert_eq!(corners.iter().copied().sum::<DVec3>(), DVec3::splat(4.0));
    assert_eq!(corners[7], DVec3::ONE);
}
