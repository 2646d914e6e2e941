//! The camera of a scene that came without one: as near as shows all of it.
//!
//! Commands that measure keep the camera that holds the box around the scene: the figures of the guide were taken with it.

use glam::{DMat3, DVec2, DVec3};
use rara::scene::Bounds;
use rara::{Camera, Scene};

use super::camera::{View, Views};
use super::failure::Failure;
use super::lens::Lens;
use super::path::Orbit;

/// Share of the picture's half that the Gaussians' centres may fill; the rest is for their extents.
const FILL: f64 = 0.9;
/// Deviations of each Gaussian that are in the picture, which may fill all of it. Of most scenes the rest that the centres
/// leave holds as many; one Gaussian, or a few coarse ones, need more.
const DEVIATIONS: f64 = 2.0;
/// The share of the Gaussians that may reach farther: the largest at the edges of a scene of many.
const BEYOND: f64 = 0.05;
/// The nearest Gaussian stays beyond this depth, as splats nearer than 0.2 are culled.
const NEAREST: f64 = 0.25;
/// The most Gaussians that are looked at.
const SAMPLE: usize = 100_000;

/// The cameras, once the scene is known; one that frames it is as near as shows all of it.
pub(super) fn views(views: Views, scene: &Scene<'_>) -> Result<Vec<View>, Failure> {
    let fit = match &views {
        Views::Framed {
            lens: Lens::Perspective(_),
            ..
        } => Some(nearer as fn(Camera, &Scene<'_>) -> Camera),
        Views::Framed {
            lens: Lens::Orthographic(None),
            ..
        } => Some(wider as fn(Camera, &Scene<'_>) -> Camera),
        _ => None,
    };
    let mut views = views.of(scene)?;
    if let Some(fit) = fit {
        for view in &mut views {
            view.camera = fit(view.camera, scene);
        }
    }
    Ok(views)
}

/// A Gaussian in a camera's axes, relative to its eye.
#[derive(Clone, Copy)]
struct Seen {
    centre: DVec3,
    /// How far it reaches along each axis.
    reach: DVec3,
}

/// Moves a camera that frames the box around a scene towards the scene itself, which seldom reaches the box's corners, and
/// into its middle. What lies outside of the robust bounds does not count.
fn nearer(camera: Camera, scene: &Scene<'_>) -> Camera {
    let all = seen(&camera, scene, &Bounds::of(scene));
    let whole = DVec2::new(camera.cx / camera.fx, camera.cy / camera.fy);
    // The eye in its own axes: x and y are in the middle of what is seen from there, which z moves.
    let mut eye = DVec3::ZERO;
    for _ in 0..4 {
        let on_screen = |one: &Seen| (one.centre - eye).truncate() / (one.centre - eye).z;
        let least = all.iter().map(on_screen).reduce(DVec2::min);
        let most = all.iter().map(on_screen).reduce(DVec2::max);
        let (Some(least), Some(most)) = (least, most) else {
            return camera;
        };
        let depth = all.iter().map(|one| one.centre.z).sum::<f64>() / all.len() as f64 - eye.z;
        let aside = (least + most) / 2.0 * depth;
        let (x, y) = (eye.x + aside.x, eye.y + aside.y);
        // As near as every centre allows, and all but a few of the Gaussians.
        let mut whole_ones = Vec::with_capacity(all.len());
        let of_centres = all.iter().fold(f64::INFINITY, |z, Seen { centre, reach }| {
            let off = DVec2::new(centre.x - x, centre.y - y).abs();
            let distance = ((off + reach.truncate()) / whole).max_element();
            whole_ones.push(centre.z - distance.max(NEAREST + reach.z));
            z.min(centre.z - (off / (whole * FILL)).max_element().max(NEAREST))
        });
        let z = of_centres.min(least_but_few(&mut whole_ones));
        eye = DVec3::new(x, y, z);
    }
    if !eye.is_finite() {
        return camera;
    }
    camera.eye(camera.eye + camera.rotation.transpose() * eye)
}

/// The most places of an orbit that are looked at.
const PLACES: usize = 64;

/// An orbit round the middle of the scene's bounds that begins at `camera`, which faces it, as near as shows all of the scene
/// from everywhere.
pub(super) fn round(
    orbit: Orbit,
    camera: Camera,
    (lens, up): (Lens, DVec3),
    scene: &Scene<'_>,
) -> Vec<View> {
    let bounds = Bounds::of(scene);
    let pivot = bounds.centre();
    let places = orbit.views(camera, (pivot, up));
    let step = places.len().div_ceil(PLACES).max(1);
    let whole = DVec2::new(camera.cx / camera.fx, camera.cy / camera.fy);
    // How far away the eye has to be, and how much wider than now an orthographic picture.
    let (mut distance, mut wider) = (0.0_f64, 0.0_f64);
    for place in places.iter().step_by(step) {
        // Places relative to the pivot, as if the eye were there.
        let all = seen(&place.camera.eye(pivot), scene, &bounds);
        let off = |at: DVec3, filled: DVec2| (at.truncate().abs() / filled).max_element();
        for Seen { centre, .. } in &all {
            distance = distance.max(off(*centre, whole * FILL).max(NEAREST) - centre.z);
        }
        let around = |one: &Seen| off(one.centre.abs() + one.reach, whole);
        let nearest = |one: &Seen| one.centre.z - around(one).max(NEAREST + one.reach.z);
        let mut nearest: Vec<f64> = all.iter().map(nearest).collect();
        if !nearest.is_empty() {
            distance = distance.max(-least_but_few(&mut nearest));
        }
        for corner in bounds.corners() {
            wider = wider.max(off(place.camera.rotation * (corner - pivot), whole * FILL));
        }
        let mut scales: Vec<f64> = all.iter().map(|one| around(one).recip()).collect();
        wider = wider.max(least_but_few(&mut scales).recip());
    }
    let away = (camera.eye - pivot).normalize_or_zero();
    let camera = match lens {
        Lens::Perspective(_) if distance > 0.0 => camera.eye(pivot + away * distance),
        Lens::Orthographic(None) if wider > 0.0 => {
            camera.fx(camera.fx / wider).fy(camera.fy / wider)
        }
        _ => camera,
    };
    orbit.views(camera, (pivot, up))
}

/// Makes an orthographic camera that frames the box around a scene show all of each Gaussian in it.
fn wider(camera: Camera, scene: &Scene<'_>) -> Camera {
    let half = DVec2::new(camera.cx, camera.cy);
    let scale_of = |one: &Seen| {
        let off = one.centre.truncate().abs() + one.reach.truncate();
        (half / off).min_element()
    };
    let all = seen(&camera, scene, &Bounds::of(scene));
    let mut scales: Vec<f64> = all.iter().map(scale_of).collect();
    let scale = camera.fx.min(least_but_few(&mut scales));
    match scale.is_finite() && scale > 0.0 {
        true => camera.fx(scale).fy(scale),
        false => camera,
    }
}

/// What is visible and has its centre within the robust bounds, which take longer to find than what is within.
fn seen(camera: &Camera, scene: &Scene<'_>, bounds: &Bounds) -> Vec<Seen> {
    let step = scene.gaussians().div_ceil(SAMPLE).max(1);
    let layers = scene.layers().iter();
    let visible = layers.filter(|layer| layer.state().visible);
    let placed = visible.flat_map(|layer| {
        let (placement, gaussians) = (layer.state().placement, layer.gaussians());
        (0..gaussians.len()).step_by(step).map(move |index| {
            let centre = placement.to_world(gaussians.positions()[index].as_dvec3());
            let turn = placement.rotation() * gaussians.rotations()[index].as_dquat();
            let scale = placement.scale() * gaussians.scales()[index].as_dvec3();
            (centre, DMat3::from_quat(turn) * DMat3::from_diagonal(scale))
        })
    });
    let inside =
        |(at, _): &(DVec3, DMat3)| at.cmpge(bounds.min).all() && at.cmple(bounds.max).all();
    placed
        .filter(inside)
        .map(|(centre, axes)| {
            let rows = (camera.rotation * axes).transpose();
            let deviations = [rows.x_axis, rows.y_axis, rows.z_axis].map(DVec3::length);
            Seen {
                centre: camera.rotation * (centre - camera.eye),
                reach: DEVIATIONS * DVec3::from(deviations),
            }
        })
        .collect()
}

/// The least of some numbers where the few that may be beyond it do not count; infinite without numbers.
fn least_but_few(numbers: &mut [f64]) -> f64 {
    if numbers.is_empty() {
        return f64::INFINITY;
    }
    let few = (BEYOND * numbers.len() as f64) as usize;
    *numbers.select_nth_unstable_by(few, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::super::lens::Depths;
    use super::*;
    use rara::glam::{Quat, Vec3};
    use rara::{Gaussians, Projection, scene};

    /// How much of the picture's halves the centres within the bounds fill: the least and the most of both axes.
    fn filled(camera: &Camera, gaussians: &Gaussians) -> (DVec2, DVec2) {
        let scene = Scene::from(gaussians);
        let seen = seen(camera, &scene, &Bounds::of(&scene));
        let seen = seen.into_iter().map(|one| {
            let p = one.centre;
            assert!(p.z > 0.2);
            let half = DVec2::new(camera.cx / camera.fx, camera.cy / camera.fy);
            p.truncate() / p.z / half
        });
        let seen: Vec<_> = seen.collect();
        let (least, most) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        (
            seen.iter().copied().fold(least, DVec2::min),
            seen.iter().copied().fold(most, DVec2::max),
        )
    }

    #[test]
    fn the_scene_fills_the_picture_and_is_in_its_middle() {
        for kind in [
            scene::Kind::General,
            scene::Kind::Layers,
            scene::Kind::Strands,
        ] {
            let made = scene::generate(kind, 3000, 1);
            for size in [(640, 480), (300, 900)] {
                let boxed = Camera::frame(&Bounds::of(&made), DVec3::NEG_Y, 50.0, size).unwrap();
                let camera = nearer(boxed, &(&made).into());
                let (least, most) = filled(&camera, &made);
                let widest = (most.max_element()).max(-least.min_element());
                assert!(
                    (0.85..=0.9 + 1e-9).contains(&widest),
                    "{kind:?}: {least} to {most}"
                );
                assert!(
                    (least + most).abs().max_element() < 0.05,
                    "{kind:?}: {least} to {most}"
                );
                let (was, _) = filled(&boxed, &made);
                assert!(was.min_element() > least.min_element(), "{kind:?}");
            }
        }
    }

    /// How much of the picture's halves the Gaussians reach, out to two deviations.
    fn reached(camera: &Camera, gaussians: &Gaussians) -> f64 {
        let half = DVec2::new(camera.cx / camera.fx, camera.cy / camera.fy);
        let all = seen(camera, &gaussians.into(), &Bounds::of(gaussians));
        let reached = all.into_iter().map(|Seen { centre, reach }| {
            let w = match camera.projection {
                Projection::Perspective => centre.z,
                _ => 1.0,
            };
            assert!(centre.z - reach.z > 0.2);
            ((centre.truncate().abs() + reach.truncate()) / w / half).max_element()
        });
        reached.fold(0.0, f64::max)
    }

    #[test]
    fn one_gaussian_and_a_few_coarse_ones_are_in_the_picture() {
        let mut one = Gaussians::default();
        let scale = Vec3::new(0.2, 0.5, 0.1);
        one.push(
            Vec3::new(3.0, 1.0, -2.0),
            scale,
            Quat::IDENTITY,
            0.9,
            &[0.0; 3],
        );
        let mut few = scene::generate(scene::Kind::General, 5, 1);
        few.scales_mut().fill(Vec3::new(0.6, 0.4, 0.5));
        let mut tiny = one.clone();
        tiny.scales_mut().fill(Vec3::splat(1e-4));
        for gaussians in [&one, &few, &tiny] {
            for size in [(64, 48), (30, 90)] {
                let views = |lens: Lens| {
                    let framed = Views::Framed {
                        lens,
                        up: DVec3::NEG_Y,
                        size,
                        depths: Depths::default(),
                    };
                    views(framed, &gaussians.into())
                        .expect("a view")
                        .remove(0)
                        .camera
                };
                let camera = views(Lens::Perspective(50.0));
                let reached = |camera: &Camera| reached(camera, gaussians);
                assert!(reached(&camera) <= 1.0 + 1e-9, "{size:?}");
                // What is larger than the nearest depth fills the picture.
                let large = gaussians.scales()[0].x > 1e-3;
                assert!(
                    !large || reached(&camera) > 0.9,
                    "{size:?}: {}",
                    reached(&camera)
                );
                let flat = views(Lens::Orthographic(None));
                assert!(
                    reached(&flat) <= 1.0 + 1e-9 && reached(&flat) > 0.2,
                    "{size:?}"
                );
            }
        }
    }

    #[test]
    fn a_large_gaussian_among_many_decides_nothing() {
        let made = scene::generate(scene::Kind::General, 3000, 1);
        let mut with_backdrop = made.clone();
        let at = Bounds::of(&made).centre().as_vec3();
        with_backdrop.push(at, Vec3::splat(50.0), Quat::IDENTITY, 0.9, made.sh_of(0));
        let boxed =
            Camera::frame(&Bounds::of(&made), DVec3::NEG_Y, 50.0, (64, 48)).expect("a view");
        let [without, with] = [&made, &with_backdrop].map(|set| nearer(boxed, &set.into()).eye);
        let apart = without.distance(with) / Bounds::of(&made).radius();
        assert!(apart < 0.02, "{apart}");
    }

    #[test]
    fn one_point_and_none_are_framed_too() {
        let mut one = scene::generate(scene::Kind::General, 1, 1);
        for gaussians in [one.clone(), {
            one = Gaussians::default();
            one
        }] {
            let boxed =
                Camera::frame(&Bounds::of(&gaussians), DVec3::NEG_Y, 50.0, (64, 64)).unwrap();
            assert!(nearer(boxed, &(&gaussians).into()).eye.is_finite());
        }
    }
}
