//! A picture that frames a scene may not hold all of it: what reaches out of it is counted.

use glam::{DMat3, DVec2, DVec3, Vec3Swizzles};
use rara::{Camera, Projection, Scene};

use super::reach::Reach;
use super::visible::AllReaches;

/// The number of visible Gaussians that reach out of a picture. Framing leaves out strays and backgrounds that would make the
/// rest small.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Outside {
    /// The Gaussians that are visible from somewhere.
    pub visible: u64,
    /// The Gaussians that reach out of the picture.
    pub outside: u64,
}

impl Outside {
    /// Counts the Gaussians of a scene.
    pub fn of(scene: &Scene<'_>, camera: &Camera) -> Self {
        let all = AllReaches::new(scene);
        let (mut visible, mut outside) = (0, 0);
        for layer in &all.layers {
            let reaches = (0..layer.gaussians().len()).filter_map(|index| all.reach(layer, index));
            for reach in reaches {
                visible += 1;
                outside += u64::from(reaches_out(camera, &reach));
            }
        }
        Self { visible, outside }
    }
}

/// True where some of a splat is beside the picture, or before it.
fn reaches_out(camera: &Camera, one: &Reach) -> bool {
    let at = camera.rotation * (one.centre - camera.eye);
    let axes = Reach {
        centre: at,
        axes: camera.rotation * one.axes,
    };
    let (across, place) = match camera.projection {
        Projection::Perspective => {
            if at.z < camera.nearest(1.0) {
                return true;
            }
            let slopes = at.xy() / at.z;
            let along = |axis: DVec3, slope: f64| axes.along(axis - slope * DVec3::Z) / at.z;
            (
                DVec2::new(along(DVec3::X, slopes.x), along(DVec3::Y, slopes.y)),
                slopes,
            )
        }
        Projection::Orthographic => (axes.across(DMat3::IDENTITY).xy(), at.xy()),
    };
    let focal = DVec2::new(camera.fx, camera.fy);
    let place = place * focal + DVec2::new(camera.cx, camera.cy);
    let size = DVec2::new(camera.width.into(), camera.height.into());
    let across = across * focal;
    (place - across).cmplt(DVec2::ZERO).any() || (place + across).cmpgt(size).any()
}
