//! What lies on a plane of a scene: each Gaussian's restriction to the plane is a flat Gaussian again.

use glam::{DMat2, DMat3, DQuat, DVec2, DVec3};

use super::Gaussians;
use crate::clip::Plane;
use rara_base::limits::ALPHA_MIN_INVERSE;

/// Returns the cross-section of Gaussians by a plane: flat Gaussians on the plane. At each point of the plane, the opacity of a
/// flat Gaussian is that of the original one there. Gaussians whose opacity on the plane is below 1/255 everywhere are left
/// out. Colours and the order of the Gaussians stay the same.
///
/// On the plane `n.x + d = 0` the exponent of a Gaussian of mean `mu` and covariance `S` is that of the Gaussian of mean
/// `mu - g S n / v` and covariance `S - S n (S n)^T / v`, plus `g^2 / 2 v`, with the centre's distance `g = n.mu + d` and the
/// variance `v = n.S n` along the normal (the update of a Kalman filter that has observed the distance without noise). The plane
/// is relative to the Gaussians' [origin](Gaussians::origin).
///
/// Drawn by a camera that faces the plane, with [`Show::Mean`](crate::settings::Show::Mean), it is the slice that the plane makes.
///
/// ```
/// # use rara_scene as rara;
/// use rara::glam::{DVec3, Quat, Vec3};
/// use rara::{Gaussians, Plane, scene::cross_section};
///
/// let mut ball = Gaussians::default();
/// ball.push(Vec3::ZERO, Vec3::splat(0.5), Quat::IDENTITY, 0.8, &[1.0, 0.0, 0.0]);
/// let slice = cross_section(&ball, &Plane::new(DVec3::Z, -0.5)?);
/// // One standard deviation from the centre.
/// assert!((slice.opacities()[0] - 0.8 * (-0.5_f32).exp()).abs() < 1e-6);
/// assert!((slice.positions()[0].z - 0.5).abs() < 1e-6);
/// # Ok::<(), rara::Error>(())
/// ```
pub fn cross_section(gaussians: &Gaussians, plane: &Plane) -> Gaussians {
    let mut on_plane = gaussians.empty_like();
    let normal = plane.normal();
    let first = normal.any_orthonormal_vector();
    let across = [first, normal.cross(first)];
    for index in 0..gaussians.len() {
        let position = gaussians.positions()[index].as_dvec3();
        let axes = DMat3::from_quat(gaussians.rotations()[index].as_dquat().normalize())
            * DMat3::from_diagonal(gaussians.scales()[index].as_dvec3());
        let opacity = f64::from(gaussians.opacities()[index]);
        let Some(flat) = restricted(position, axes, plane, across) else {
            continue;
        };
        let opacity = (opacity * (-0.5 * flat.distance * flat.distance).exp()) as f32;
        if opacity * ALPHA_MIN_INVERSE < 1.0 {
            continue;
        }
        on_plane.push(
            flat.mean.as_vec3(),
            flat.deviations.extend(0.0).as_vec3(),
            flat.rotation.as_quat(),
            opacity,
            gaussians.sh_of(index),
        );
    }
    on_plane
}

/// A Gaussian on a plane.
struct Flat {
    /// Of its centre from the plane, standard deviations.
    distance: f64,
    mean: DVec3,
    /// Along the first two axes of its rotation; the third is the plane's normal.
    deviations: DVec2,
    rotation: DQuat,
}

/// `axes` are a Gaussian's half axes, and `across` two directions on the plane. None of it where a Gaussian without thickness
/// lies beside the plane.
fn restricted(mean: DVec3, axes: DMat3, plane: &Plane, across: [DVec3; 2]) -> Option<Flat> {
    let gap = plane.distance(mean);
    // The normal in the unit space, whose length is the deviation along it.
    let along = axes.transpose() * plane.normal();
    let deviation = along.length();
    if deviation
        <= 1e-9
            * axes
                .to_cols_array()
                .into_iter()
                .fold(0.0, |a: f64, b| a.max(b.abs()))
    {
        return None;
    }
    let direction = along / deviation;
    let distance = gap / deviation;
    // In the unit space the plane lies `distance` from the origin, against its normal.
    let mean = mean - axes * (direction * distance);
    // The half axes without their part along the normal.
    let flat = across.map(|axis| {
        let inside = axes.transpose() * axis;
        inside - direction * inside.dot(direction)
    });
    let (x, y, xy) = (
        flat[0].dot(flat[0]),
        flat[1].dot(flat[1]),
        flat[0].dot(flat[1]),
    );
    let turn = 0.5 * (2.0 * xy).atan2(x - y);
    let (sine, cosine) = turn.sin_cos();
    let turned = DMat2::from_cols(DVec2::new(cosine, sine), DVec2::new(-sine, cosine));
    let deviation = |axis: DVec2| (flat[0] * axis.x + flat[1] * axis.y).length();
    let deviations = DVec2::new(deviation(turned.x_axis), deviation(turned.y_axis));
    let [first, second] =
        [turned.x_axis, turned.y_axis].map(|axis| across[0] * axis.x + across[1] * axis.y);
    let rotation = DMat3::from_cols(first, second, first.cross(second));
    Some(Flat {
        distance,
        mean,
        deviations,
        rotation: DQuat::from_mat3(&rotation),
    })
}

#[cfg(test)]
mod tests;
