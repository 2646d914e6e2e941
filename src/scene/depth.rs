//! Depth maps: which number a host's depth buffer holds for a depth, by the host's projection.

use glam::DMat4;

use crate::camera::Projection;
use crate::placement::Placement;
use rara_base::error::{Error, Result};

/// A map from depths `z` along the view axis, in world units, to the values of a depth buffer, for viewports whose depths go
/// from 0 to 1. In perspective the value is `offset + scale / z`, and in an [orthographic](Self::orthographic) projection
/// `offset - scale z`. If `scale` is positive, nearer points have larger values ("reversed"). The camera of a frame must have
/// the same projection.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DepthMap {
    projection: Projection,
    offset: f64,
    scale: f64,
}

impl DepthMap {
    /// Makes the map with these numbers, for a camera of this projection.
    ///
    /// # Errors
    /// [`Error::Invalid`] unless both are finite and `scale` is not zero.
    pub fn new(projection: Projection, offset: f64, scale: f64) -> Result<Self> {
        if !(offset.is_finite() && scale.is_finite() && scale != 0.0) {
            return Err(Error::Invalid(format!(
                "a depth buffer with an offset of {offset} and a scale of {scale} is not possible; give finite numbers and a scale that is not zero"
            )));
        }
        Ok(Self {
            projection,
            offset,
            scale,
        })
    }

    /// Makes the map that is 0 at `near` and 1 at `far`, which may be infinite.
    ///
    /// # Errors
    /// [`Error::Invalid`] unless `0 < near < far`.
    pub fn ordinary(near: f64, far: f64) -> Result<Self> {
        let reversed = Self::reversed(near, far)?;
        Ok(Self {
            offset: 1.0 - reversed.offset,
            scale: -reversed.scale,
            ..reversed
        })
    }

    /// Makes the map that is 1 at `near` and 0 at `far`, which may be infinite.
    ///
    /// # Errors
    /// [`Error::Invalid`] unless `0 < near < far`.
    pub fn reversed(near: f64, far: f64) -> Result<Self> {
        if !(near > 0.0 && near < far && near.is_finite()) {
            return Err(Error::Invalid(format!(
                "a depth buffer from {near} to {far} is not possible; give 0 < near < far"
            )));
        }
        let share = near / far; // zero where far is infinite
        Ok(Self {
            projection: Projection::Perspective,
            offset: -share / (1.0 - share),
            scale: near / (1.0 - share),
        })
    }

    /// Makes the map of an orthographic camera: 0 at the depth `zero`, 1 at the depth `one`, and linear between them. Nearer
    /// depths have larger values if `one` is less than `zero`.
    ///
    /// # Errors
    /// [`Error::Invalid`] unless both are finite and differ.
    pub fn orthographic(zero: f64, one: f64) -> Result<Self> {
        let scale = 1.0 / (zero - one);
        if !(zero.is_finite() && scale.is_finite() && scale != 0.0) {
            return Err(Error::Invalid(format!(
                "a depth buffer from {zero} to {one} is not possible; give two depths that are finite and differ"
            )));
        }
        Ok(Self {
            projection: Projection::Orthographic,
            offset: scale * zero,
            scale,
        })
    }

    /// Returns the map of a projection matrix for column vectors and clip depths from 0 to w. The view looks along +z or -z.
    ///
    /// # Errors
    /// [`Error::Invalid`] if it is no perspective projection. The matrix of an orthographic one does not say which way its
    /// view looks: [`orthographic`](Self::orthographic) takes the depths instead.
    pub fn of_projection(projection: &DMat4) -> Result<Self> {
        let (z, w) = (projection.row(2), projection.row(3));
        let forward = w.z; // 1 where the view looks along +z, -1 along -z
        let is_perspective = [z.x, z.y, w.x, w.y, w.w].iter().all(|v| *v == 0.0)
            && forward.abs() == 1.0
            && z.w.is_finite()
            && z.w != 0.0
            && z.z.is_finite();
        if !is_perspective {
            return Err(Error::Invalid(
                "only the matrix of a perspective projection, with 1 or -1 in the last row's third place, says what depths mean; for an orthographic one give the two depths that become 0 and 1"
                    .into(),
            ));
        }
        Ok(Self {
            projection: Projection::Perspective,
            offset: z.z * forward,
            scale: z.w,
        })
    }

    /// Returns the map for depths in the units of a scene that has this placement, like those of
    /// [`Camera::in_scene`](crate::camera::Camera::in_scene).
    #[must_use]
    pub fn in_scene(self, placement: &Placement) -> Self {
        let scale = match self.projection {
            Projection::Perspective => self.scale / placement.scale(),
            Projection::Orthographic => self.scale * placement.scale(),
        };
        Self { scale, ..self }
    }

    /// Returns the projection of the camera of these depths.
    pub fn projection(&self) -> Projection {
        self.projection
    }

    /// Returns the value of the buffer infinitely far away or, for an orthographic camera, at the eye.
    pub fn offset(&self) -> f64 {
        self.offset
    }

    /// Returns the change of the value: per 1/depth in perspective, and per negative depth in an orthographic projection.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// Returns true if nearer points have larger values.
    pub fn is_reversed(&self) -> bool {
        self.scale > 0.0
    }

    /// Returns the value of the buffer for a depth along the view axis, clamped to 0 to 1.
    pub fn at(&self, depth: f64) -> f64 {
        let falling = match self.projection {
            Projection::Perspective => self.scale / depth,
            Projection::Orthographic => -self.scale * depth,
        };
        (self.offset + falling).clamp(0.0, 1.0)
    }

    /// Fails unless a camera's depths are of this form.
    #[doc(hidden)]
    pub fn check(&self, projection: Projection) -> Result<()> {
        match self.projection == projection {
            true => Ok(()),
            false => Err(Error::Invalid(format!(
                "the camera is {projection:?} and the depth map {:?}; give Renderer::set_depth_map the map of the camera's projection first",
                self.projection
            ))),
        }
    }

    /// Offset and scale, as parameters of the shaders.
    #[doc(hidden)]
    pub fn factors(&self) -> [f32; 2] {
        [self.offset, self.scale].map(|v| v as f32)
    }
}

#[cfg(test)]
mod tests;
