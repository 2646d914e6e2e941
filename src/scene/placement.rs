//! The placement of a scene in a host's world.

use glam::{DQuat, DVec3};

use rara_base::error::{Error, Result};

/// The placement of a scene in a world, or of a [layer](crate::Layer) in its scene: points are scaled, then turned,
/// then moved.
///
/// A placed scene is drawn by taking the world's camera and clip into the scene
/// ([`Camera::in_scene`](crate::Camera::in_scene), [`Clip::in_scene`](crate::Clip::in_scene),
/// [`DepthMap::in_scene`](crate::DepthMap::in_scene)). This is exact, in double precision, and touches no Gaussian. The picture is that of the placed Gaussians; spherical harmonics turn with
/// the scene. All lengths are then in the scene's units, also the depth of 0.2 below which 3DGS culls centres; that holds
/// for a layer too, whose own units count before the camera alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    position: DVec3,
    rotation: DQuat,
    scale: f64,
}

impl Placement {
    /// A scene as it is.
    pub const IDENTITY: Self = Self {
        position: DVec3::ZERO,
        rotation: DQuat::IDENTITY,
        scale: 1.0,
    };

    /// `position` is where the scene's origin goes, and `scale` is how large one of the scene's units is, both in world
    /// units. The quaternion is normalised.
    ///
    /// # Errors
    /// [`Error::Invalid`] for numbers that are not finite, a scale that is not above zero and a rotation of zero.
    pub fn new(position: DVec3, rotation: DQuat, scale: f64) -> Result<Self> {
        let length = rotation.length();
        let is_proper = position.is_finite() && scale.is_finite() && scale > 0.0;
        if !(is_proper && length.is_finite() && length > 0.0) {
            return Err(Error::Invalid(
                "a scene's placement needs finite numbers, a scale above zero and a rotation that is not zero".into(),
            ));
        }
        Ok(Self {
            position,
            rotation: rotation / length,
            scale,
        })
    }

    /// The position of the scene's origin, world units.
    pub fn position(&self) -> DVec3 {
        self.position
    }

    /// How the scene is turned.
    pub fn rotation(&self) -> DQuat {
        self.rotation
    }

    /// How many world units one unit of the scene is.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// The placement of what is placed with its [origin](crate::Gaussians::origin) there.
    #[doc(hidden)]
    pub fn of_origin(&self, origin: DVec3) -> Self {
        Self {
            position: self.to_world(origin),
            ..*self
        }
    }

    /// A point of the scene in the world.
    pub fn to_world(&self, point: DVec3) -> DVec3 {
        self.position + self.rotation * (self.scale * point)
    }

    /// A point of the world in the scene.
    pub fn to_scene(&self, point: DVec3) -> DVec3 {
        self.rotation.inverse() * (point - self.position) / self.scale
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Camera, Plane, Projection, Quadric};

    fn placement() -> Placement {
        let turn = DQuat::from_xyzw(0.3, -0.5, 0.2, 0.9);
        Placement::new(DVec3::new(4.0, -1.0, 2.5), turn, 0.35).expect("finite numbers")
    }

    #[test]
    fn points_planes_and_views_agree() {
        let placement = placement();
        let plane = Plane::new(DVec3::new(1.0, 2.0, -0.5), 0.7).expect("a normal");
        let eye = DVec3::new(-3.0, -2.0, 9.0);
        let camera = Camera::look_at(eye, DVec3::ONE, DVec3::NEG_Y, 40.0, (90, 60));
        let camera = camera.expect("a view");
        let flat = camera.projection(Projection::Orthographic);
        assert_eq!(flat.in_scene(&placement).fx, camera.fx * placement.scale());
        let (inside, near) = (camera.in_scene(&placement), plane.in_scene(&placement));
        for point in [DVec3::ZERO, DVec3::new(1.5, -0.3, 0.8), DVec3::splat(-2.0)] {
            let world = placement.to_world(point);
            assert!(placement.to_scene(world).distance(point) < 1e-13);
            let distance = plane.distance(world) / placement.scale();
            assert!((near.distance(point) - distance).abs() < 1e-13);
            let (sphere, scale) = (Quadric::sphere(DVec3::ONE, 2.5), placement.scale());
            let sphere = sphere.expect("a radius");
            let distance = sphere.distance(world) / scale;
            assert!((sphere.in_scene(&placement).distance(point) - distance).abs() < 1e-12);
            let seen = camera.world_to_camera().transform_point3(world) / placement.scale();
            assert!(
                inside
                    .world_to_camera()
                    .transform_point3(point)
                    .distance(seen)
                    < 1e-12
            );
        }
    }

    #[test]
    fn what_is_no_placement_is_refused() {
        for (position, rotation, scale) in [
            (DVec3::ZERO, DQuat::IDENTITY, 0.0),
            (DVec3::ZERO, DQuat::IDENTITY, -1.0),
            (DVec3::ZERO, DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0), 1.0),
            (DVec3::NAN, DQuat::IDENTITY, 1.0),
        ] {
            assert!(Placement::new(position, rotation, scale).is_err());
        }
    }
}
