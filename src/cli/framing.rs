//! The camera of a scene that came without one: as near as shows all of it.
//!
//! Commands that measure keep the camera that holds the box around the scene: the figures of the guide were taken with it.

use glam::{DVec2, DVec3};
use rara::scene::Bounds;
use rara::{Camera, Scene};

use super::camera::{View, Views};
use super::failure::Failure;
use super::lens::Lens;
use super::path::Orbit;

/// Share of the picture's half that the Gaussians' centres may fill; the rest is for their extents.
const FILL: f64 = 0.9;
/// The nearest centre stays beyond this depth, as splats nearer than 0.2 are culled.
const NEAREST: f64 = 0.25;
/// The most centres that are looked at.
const SAMPLE: usize = 100_000;

/// The cameras, once the scene is known; one that frames it is as near as shows all of it.
pub(super) fn views(views: Views, scene: &Scene<'_>) -> Result<Vec<View>, Failure> {
    let frames = matches!(
        &views,
        Views::Framed {
            lens: Lens::Perspective(_),
            ..
        }
    );
    let mut views = views.of(scene)?;
    for view in views.iter_mut().filter(|_| frames) {
        view.camera = nearer(view.camera, scene);
    }
    Ok(views)
}

/// Moves a camera that frames the box around a scene towards the scene itself, which seldom reaches the box's corners, and
/// into its middle. What lies outside of the robust bounds does not count.
fn nearer(camera: Camera, scene: &Scene<'_>) -> Camera {
    let centres: Vec<DVec3> = centres(scene)
        .into_iter()
        .map(|centre| camera.rotation * (centre - camera.eye))
        .collect();
    let half = DVec2::new(camera.cx / camera.fx, camera.cy / camera.fy) * FILL;
    // The eye in its own axes: x and y are in the middle of what is seen from there, which z moves.
    let mut eye = DVec3::ZERO;
    for _ in 0..4 {
        let seen = |at: &DVec3| (at - eye).truncate() / (at - eye).z;
        let least = centres.iter().map(seen).reduce(DVec2::min);
        let most = centres.iter().map(seen).reduce(DVec2::max);
        let (Some(least), Some(most)) = (least, most) else {
            return camera;
        };
        let depth = centres.iter().map(|at| at.z).sum::<f64>() / centres.len() as f64 - eye.z;
        let aside = (least + most) / 2.0 * depth;
        let (x, y) = (eye.x + aside.x, eye.y + aside.y);
        // As near as every one of them allows.
        let z = centres.iter().fold(f64::INFINITY, |z, at| {
            let off = DVec2::new(at.x - x, at.y - y).abs() / half;
            z.min(at.z - off.max_element().max(NEAREST))
        });
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
    let centres = centres(scene);
    let places = orbit.views(camera, (pivot, up));
    let step = places.len().div_ceil(PLACES).max(1);
    let half = DVec2::new(camera.cx / camera.fx, camera.cy / camera.fy) * FILL;
    // How far away the eye has to be, and how much wider than now an orthographic picture.
    let (mut distance, mut wider) = (0.0_f64, 0.0_f64);
    for place in places.iter().step_by(step) {
        let off = |at: DVec3| (at.truncate().abs() / half).max_element();
        let turned = |at: &DVec3| place.camera.rotation * (*at - pivot);
        for at in centres.iter().map(turned) {
            distance = distance.max(off(at).max(NEAREST) - at.z);
        }
        for at in bounds.corners().iter().map(turned) {
            wider = wider.max(off(at));
        }
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

/// Centres of what is visible, within the robust bounds.
fn centres(scene: &Scene<'_>) -> Vec<DVec3> {
    let bounds = Bounds::of(scene);
    let step = scene.gaussians().div_ceil(SAMPLE).max(1);
    let layers = scene.layers().iter();
    let visible = layers.filter(|layer| layer.state().visible);
    let placed = visible.flat_map(|layer| {
        let placement = layer.state().placement;
        let positions = layer.gaussians().positions().iter().step_by(step);
        positions.map(move |at| placement.to_world(at.as_dvec3()))
    });
    let inside = |at: &DVec3| at.cmpge(bounds.min).all() && at.cmple(bounds.max).all();
    placed.filter(inside).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rara::{Gaussians, scene};

    /// How much of the picture's halves the centres within the bounds fill: the least and the most of both axes.
    fn filled(camera: &Camera, gaussians: &Gaussians) -> (DVec2, DVec2) {
        let scene = Scene::from(gaussians);
        let seen = centres(&scene).into_iter().map(|at| {
            let p = camera.rotation * (at - camera.eye);
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
