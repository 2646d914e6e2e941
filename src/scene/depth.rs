//! Depth maps: which number a host's depth buffer holds for a depth, by the host's projection.

use glam::DMat4;

use crate::camera::Projection;
use crate::placement::Placement;
use rara_base::error::{Error, Result};

/// The value that a depth buffer holds at a depth `z` along the view axis, world units, with viewports whose depths go from
/// 0 to 1: `offset + scale / z`, which is every perspective projection, or, of an [orthographic](Self::orthographic) one,
/// `offset - scale z`. Nearer is more ("reversed") where `scale` is positive. The camera of a frame has the same
/// projection.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DepthMap {
    projection: Projection,
    offset: f64,
    scale: f64,
}

impl DepthMap {
    /// The map with these numbers, for a camera of this projection.
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

    /// 0 at `near`, 1 at `far`, which may be infinite.
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

    /// 1 at `near`, 0 at `far`, which may be infinite.
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

    /// Of an orthographic camera: 0 at the depth `zero`, 1 at the depth `one`, and linear between them. Nearer is more where
    /// `one` is the nearer one.
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

    /// The map of a projection matrix for column vectors and clip depths from 0 to w, whose view looks along +z or -z.
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

    /// The same buffer as a scene with this placement sees it: its depths are then in the scene's units, like those of
    /// [`Camera::in_scene`](crate::camera::Camera::in_scene).
    #[must_use]
    pub fn in_scene(self, placement: &Placement) -> Self {
        let scale = match self.projection {
            Projection::Perspective => self.scale / placement.scale(),
            Projection::Orthographic => self.scale * placement.scale(),
        };
        Self { scale, ..self }
    }

    /// How the camera of such depths sees.
    pub fn projection(&self) -> Projection {
        self.projection
    }

    /// The buffer's value infinitely far away or, of an orthographic camera, at the eye.
    pub fn offset(&self) -> f64 {
        self.offset
    }

    /// What the buffer's value changes by: for the inverse of a depth in perspective, for a depth's negative without.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// True when nearer is more.
    pub fn is_reversed(&self) -> bool {
        self.scale > 0.0
    }

    /// The buffer's value for a depth along the view axis, kept within 0 to 1.
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
                "the camera is {projection:?} and the depth map {:?}; give set_depth_map the map of the camera's projection first",
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
mod tests {
    use super::*;
    use glam::DVec4;

    #[test]
    fn near_and_far_are_the_ends() {
        for (near, far) in [(0.1, 1000.0), (1.0, 2.0), (0.5, f64::INFINITY)] {
            let far_enough = far.min(1e12);
            let [ordinary, reversed] = [DepthMap::ordinary, DepthMap::reversed]
                .map(|make| make(near, far).expect("0 < near < far"));
            for (map, ends) in [(ordinary, [0.0, 1.0]), (reversed, [1.0, 0.0])] {
                assert!((map.at(near) - ends[0]).abs() < 1e-12);
                assert!((map.at(far_enough) - ends[1]).abs() < 1e-11);
                assert_eq!(map.at(near / 2.0), ends[0], "kept within the buffer");
                assert_eq!(map.is_reversed(), ends[0] == 1.0);
            }
        }
        for (near, far) in [(0.0, 1.0), (1.0, 1.0), (-1.0, 1.0), (f64::NAN, 1.0)] {
            assert!(DepthMap::ordinary(near, far).is_err(), "{near} {far}");
        }
    }

    #[test]
    fn orthographic_depths_are_linear_between_their_ends() {
        for (zero, one) in [(-2.0, 6.0), (6.0, -2.0)] {
            let map = DepthMap::orthographic(zero, one).expect("two depths");
            let values = [zero, one, 2.0, 2.0 * zero - one].map(|z| map.at(z));
            assert_eq!(values, [0.0, 1.0, 0.5, 0.0], "kept within the buffer");
            assert_eq!(map.is_reversed(), one < zero);
            assert!(map.check(Projection::Orthographic).is_ok());
            assert!(map.check(Projection::Perspective).is_err());
        }
        for (zero, one) in [(1.0, 1.0), (0.0, f64::INFINITY), (f64::NAN, 1.0)] {
            assert!(DepthMap::orthographic(zero, one).is_err(), "{zero} {one}");
        }
    }

    #[test]
    fn a_projection_matrix_says_the_same() {
        // Focal lengths do not matter; the view looks along -z in the first and along +z in the second.
        let matrix = |z: f64, offset: f64, w: f64| {
            let (x, y) = (DVec4::X * 1.3, DVec4::Y * 0.9);
            DMat4::from_cols(x, y, DVec4::new(0.1, 0.0, z, w), DVec4::Z * offset)
        };
        let (near, far) = (0.1, 50.0);
        let away = matrix(far / (near - far), near * far / (near - far), -1.0);
        let turned = matrix(near / (near - far), near * far / (far - near), 1.0);
        let [map, reversed] =
            [away, turned].map(|matrix| DepthMap::of_projection(&matrix).expect("perspective"));
        assert!(map.at(near) < 1e-12 && map.at(far) > 1.0 - 1e-12);
        for z in [near, 0.7, 12.0, far] {
            let clip = away * DVec4::new(0.3, -0.2, -z, 1.0);
            assert!((map.at(z) - clip.z / clip.w).abs() < 1e-12);
            let clip = turned * DVec4::new(0.3, -0.2, z, 1.0);
            assert!((reversed.at(z) - clip.z / clip.w).abs() < 1e-12);
        }
        assert!(reversed.is_reversed() && !map.is_reversed());
        let flat = DMat4::from_scale(glam::DVec3::new(1.0, 1.0, 0.1));
        assert!(DepthMap::of_projection(&flat).is_err());
    }

    #[test]
    fn a_scene_of_another_scale_has_the_same_depths() {
        let map = DepthMap::reversed(0.1, 100.0).expect("0 < near < far");
        let placement = Placement::new(glam::DVec3::ONE, glam::DQuat::IDENTITY, 4.0);
        let placement = placement.expect("a scale");
        assert_eq!(map.in_scene(&placement).at(2.0), map.at(8.0));
        let flat = DepthMap::orthographic(-3.0, 13.0).expect("two depths");
        assert_eq!(flat.in_scene(&placement).at(2.0), flat.at(8.0));
    }
}
