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
        let wrong = match () {
            () if !position.is_finite() => Some("its position needs finite numbers"),
            () if !(scale.is_finite() && scale > 0.0) => {
                Some("its scale has to be finite and above zero")
            }
            () if !length.is_finite() => Some("its rotation needs finite numbers"),
            () if length == 0.0 => Some("its rotation cannot be zero"),
            () => None,
        };
        if let Some(wrong) = wrong {
            return Err(Error::Invalid(format!(
                "a scene cannot be placed so: {wrong}"
            )));
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

    /// The placement of what is placed so in a scene that is placed in turn.
    pub(crate) fn placed(&self, scene: &Self) -> Result<Self> {
        Self::new(
            scene.to_world(self.position),
            scene.rotation * self.rotation,
            scene.scale * self.scale,
        )
    }

    /// The placement of the same thing in the space of a scene that has another placement.
    pub(crate) fn in_scene(&self, scene: &Self) -> Self {
        if *scene == Self::IDENTITY {
            return *self; // to the bit
        }
        Self {
            position: scene.to_scene(self.position),
            rotation: (scene.rotation.inverse() * self.rotation).normalize(),
            scale: self.scale / scene.scale,
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
mod tests;
