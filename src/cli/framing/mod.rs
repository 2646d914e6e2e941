//! The camera of a scene that came without one: as near as shows all of it that is visible.
//!
//! Commands that measure keep the camera that holds the box around the scene: the figures of the guide were taken with it.

mod linked;
mod reach;
mod visible;

use rara::scene::Bounds;
use rara::{Camera, Scene};

use super::failure::Failure;
use super::lens::Lens;
use super::output;
use super::views::{Framing, NamedView, Orbit, Views};
pub(super) use visible::Visible;

/// The cameras, once the scene is known.
pub(super) fn views(views: Views, scene: &Scene<'_>) -> Result<Vec<NamedView>, Failure> {
    match views {
        Views::Given(views) => Ok(views),
        framed => {
            framed.note().into_iter().for_each(output::say_afterwards);
            views_of(framed, &Visible::from_scene(scene))
        }
    }
}

/// The camera of a command that measures; one that frames the scene holds the box around it.
pub(super) fn boxed_views(views: Views, scene: &Scene<'_>) -> Result<Vec<NamedView>, Failure> {
    match views {
        Views::Framed(framed) => {
            framed.note.iter().cloned().for_each(output::say_afterwards);
            Ok(vec![NamedView {
                number: 0,
                name: "framing".into(),
                camera: framed.boxed(&Bounds::of(scene))?,
            }])
        }
        other => self::views(other, scene),
    }
}

/// The cameras, once what is visible is known.
pub(super) fn views_of(views: Views, visible: &Visible) -> Result<Vec<NamedView>, Failure> {
    match views {
        Views::Given(views) => Ok(views),
        Views::Framed(framed) => Ok(vec![NamedView {
            number: 0,
            name: "framing".into(),
            camera: held(&framed, visible)?,
        }]),
        Views::Round(orbit, framed) => round(orbit, &framed, visible),
    }
}

/// The camera that holds what is visible, or looks at it from where a flag says.
fn held(framed: &Framing, visible: &Visible) -> Result<Camera, Failure> {
    let camera = framed.turned(visible.middle)?;
    let placed = match framed.lens {
        _ if framed.eye.is_some() => camera,
        Lens::Perspective(_) => {
            let near = visible.near(camera);
            framed.aimed(near, visible.middle)
        }
        Lens::Orthographic(height) => {
            let middle = visible.middle_across(camera.rotation);
            let camera = match height {
                Some(_) => camera,
                None => scaled(camera, visible.scale(&camera, middle)),
            };
            let point = framed.target.unwrap_or(middle);
            camera.eye(visible.before(camera.rotation, point))
        }
    };
    framed.depths.camera(placed)
}

/// The most places of an orbit that are looked at.
const PLACES: usize = 64;

/// An orbit round the middle of what is visible, or round the target, as near as shows all of it from everywhere; from the eye
/// where a flag says it.
fn round(orbit: Orbit, framed: &Framing, visible: &Visible) -> Result<Vec<NamedView>, Failure> {
    let pivot = framed.target.unwrap_or(visible.middle);
    let camera = framed.depths.camera(framed.turned(pivot)?)?;
    let places = orbit.views(camera, (pivot, framed.up));
    let step = places.len().div_ceil(PLACES).max(1);
    let looked_at = || places.iter().step_by(step).map(|place| &place.camera);
    let forward = camera.rotation.row(2);
    let camera = match framed.lens {
        _ if framed.eye.is_some() => return Ok(places),
        Lens::Perspective(_) => {
            let distances = looked_at().map(|camera| visible.distance(camera, pivot));
            camera.eye(pivot - forward * distances.fold(0.0, f64::max))
        }
        Lens::Orthographic(height) => {
            let scales = looked_at().map(|camera| visible.scale(camera, pivot));
            let camera = match height {
                Some(_) => camera,
                None => scaled(camera, scales.fold(f64::INFINITY, f64::min)),
            };
            // As far away as from the side on which the pivot is farthest behind all that is visible.
            let aside = pivot.distance(visible.middle);
            camera.eye(visible.before(camera.rotation, pivot) - forward * aside)
        }
    };
    Ok(orbit.views(camera, (pivot, framed.up)))
}

fn scaled(camera: Camera, scale: f64) -> Camera {
    camera.fx(scale).fy(scale)
}
#[cfg(test)]
mod tests;
