//! A camera in COLMAP's convention: +x right, +y down, +z forward, pixel centres at half-integers.

mod matrices;

use std::borrow::Cow;

use glam::{DMat3, DMat4, DVec3};

use crate::clip::{Clip, ClipOp, Plane};
use crate::placement::Placement;
pub use matrices::Ndc;
use rara_base::error::{Error, Result};
use rara_base::limits;
use rara_base::setters;

/// How a camera takes points in its own axes, X right, Y down and Z forward, to pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(
    feature = "json",
    derive(serde::Deserialize, serde::Serialize),
    serde(rename_all = "lowercase")
)]
pub enum Projection {
    /// A pinhole camera: lines of sight pass through the eye, and a point is seen at `(fx X / Z + cx, fy Y / Z + cy)`.
    #[default]
    Perspective,
    /// A camera without perspective: lines of sight are parallel to the view axis, and a point is seen at `(fx X + cx, fy Y +
    /// cy)` at every depth. The footprint of a Gaussian is then exact, whatever its size, and so is its share in mode `exact`.
    Orthographic,
}

setters! {
    /// A camera and the size of its picture, in double precision. The GPU gets values in single precision that are computed
    /// from it.
    #[derive(Debug, Clone, Copy, PartialEq)]
    #[non_exhaustive]
    pub struct Camera {
        /// Picture width, pixels.
        pub width: u32,
        /// Picture height, pixels.
        pub height: u32,
        /// Focal length along x, in pixels; for an orthographic camera, in pixels per world unit.
        pub fx: f64,
        /// Focal length along y, in pixels; for an orthographic camera, in pixels per world unit.
        pub fy: f64,
        /// The x of the principal point, in pixels from the picture's left edge (`width / 2` is the middle).
        pub cx: f64,
        /// The y of the principal point, in pixels from the picture's top edge (`height / 2` is the middle).
        pub cy: f64,
        /// The position of the eye, in world units. An orthographic camera sees the same picture from every point of a line
        /// along its view axis, except for splats that are nearer than its [near cut](Self::near_cut). Its depths count from
        /// the eye too, in single precision. Keep the eye at most a few scene sizes away, so that splats that are close
        /// together are sorted correctly.
        pub eye: DVec3,
        /// The rotation from world to camera. Its rows are the camera's right, down and forward axes in the world. If its
        /// determinant is -1, as [`of_projection`](Self::of_projection) returns for a left-handed host, the picture shows the
        /// world mirrored.
        pub rotation: DMat3,
        /// How points become pixels.
        pub projection: Projection,
        /// The depth, in world units along the view axis, of a clip plane that cuts away everything nearer. The plane is
        /// perpendicular to the axis, moves with the camera and cuts every layer, in addition to all clips. It cuts splats like
        /// any other plane, by the mode of the [settings](crate::settings::Settings); in mode `none` it has no effect.
        pub clip_near: Option<f64>,
        /// The depth of a clip plane that cuts away everything deeper. It is like [`clip_near`](Self::clip_near) otherwise.
        pub clip_far: Option<f64>,
        /// The near cut: splats whose centres are nearer than this depth, in world units, are not drawn. `None` means 0.2 units
        /// of the scene, as in 3DGS, whatever the scale of the scene in the world.
        pub near_cut: Option<f64>,
    }
}

impl Camera {
    /// Largest picture side, pixels. Vulkan guarantees 4096; every driver we know has at least this.
    pub const MAX_SIZE: u32 = 16384;

    /// Makes a camera at `eye` that looks at `target`. `up` points up in the picture (the default world has y down: `-Y`).
    /// `fov_y` is the full vertical field of view in degrees.
    pub fn look_at(
        eye: DVec3,
        target: DVec3,
        up: DVec3,
        fov_y: f64,
        (width, height): (u32, u32),
    ) -> Result<Self> {
        let rotation = facing(eye, target, up)?;
        if !(fov_y > 0.0 && fov_y < 180.0) {
            return Err(Error::Invalid(format!(
                "a field of view of {fov_y} degrees is not between 0 and 180"
            )));
        }
        let focal = f64::from(height) / 2.0 / (fov_y.to_radians() / 2.0).tan();
        Self::centred(eye, rotation, focal, (width, height)).checked()
    }

    /// Makes an orthographic camera at `eye` that looks at `target`. Its picture is `height` world units high. `up` is as for
    /// [`look_at`](Self::look_at).
    ///
    /// ```
    /// # use rara_scene as rara;
    /// use rara::{Camera, Projection, glam::DVec3};
    ///
    /// let camera = Camera::orthographic(DVec3::NEG_Z, DVec3::ZERO, DVec3::NEG_Y, 2.5, (640, 500))?;
    /// assert_eq!((camera.fx, camera.projection), (200.0, Projection::Orthographic));
    /// # Ok::<(), rara::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Invalid`] for a height that is not above zero, for numbers that are not finite, a `target` that is the eye,
    /// an `up` along the view axis, and an impossible size of picture.
    pub fn orthographic(
        eye: DVec3,
        target: DVec3,
        up: DVec3,
        height: f64,
        size: (u32, u32),
    ) -> Result<Self> {
        let rotation = facing(eye, target, up)?;
        if !(height.is_finite() && height > 0.0) {
            return Err(Error::Invalid(format!(
                "an orthographic picture {height} world units high is not possible; give a height above zero"
            )));
        }
        let scale = f64::from(size.1) / height;
        Self::centred(eye, rotation, scale, size)
            .projection(Projection::Orthographic)
            .checked()
    }

    /// A camera whose principal point is the picture's middle and whose pixels are square.
    fn centred(eye: DVec3, rotation: DMat3, focal: f64, (width, height): (u32, u32)) -> Self {
        Self {
            width,
            height,
            fx: focal,
            fy: focal,
            cx: f64::from(width) / 2.0,
            cy: f64::from(height) / 2.0,
            eye,
            rotation,
            projection: Projection::Perspective,
            clip_near: None,
            clip_far: None,
            near_cut: None,
        }
    }

    /// Makes a camera from a rigid world-to-camera matrix. A rotation that is only nearly orthonormal, because a file has
    /// rounded it, is made orthonormal. A scale, a shear or a mirror is an error.
    pub fn from_world_to_camera(
        matrix: DMat4,
        (fx, fy, cx, cy): (f64, f64, f64, f64),
        (width, height): (u32, u32),
    ) -> Result<Self> {
        let rows = DMat3::from_mat4(matrix).transpose();
        if !matrix.is_finite() || oblique(rows) > 1e-3 || rows.determinant() < 0.0 {
            return Err(Error::Invalid("the camera's matrix is not a rotation and a translation (scale, shear and mirrors are not supported)".into()));
        }
        let forward = rows.z_axis.normalize();
        let right = (rows.x_axis - forward * rows.x_axis.dot(forward)).normalize();
        let rotation = DMat3::from_cols(right, forward.cross(right), forward).transpose();
        let eye = -(rotation.transpose() * matrix.w_axis.truncate());
        Self::centred(eye, rotation, fx, (width, height))
            .fy(fy)
            .cx(cx)
            .cy(cy)
            .checked()
    }

    fn check_size((width, height): (u32, u32)) -> Result<()> {
        let possible = 1..=Self::MAX_SIZE;
        if !(possible.contains(&width) && possible.contains(&height)) {
            return Err(Error::Invalid(format!(
                "a picture of {width}x{height} is not possible; each side is 1 to {} pixels",
                Self::MAX_SIZE
            )));
        }
        Ok(())
    }

    fn checked(self) -> Result<Self> {
        Self::check_size((self.width, self.height))?;
        let focal_ok = |f: f64| f.is_finite() && f > 0.0;
        if !(focal_ok(self.fx) && focal_ok(self.fy) && self.cx.is_finite() && self.cy.is_finite()) {
            return Err(Error::Invalid(
                "the camera's focal lengths must be finite and above 0, and its principal point finite".into(),
            ));
        }
        // Finite numbers of a file can still sum up beyond the range.
        if !self.eye.is_finite() {
            return Err(Error::Invalid("the camera's position is not finite".into()));
        }
        Ok(self)
    }

    /// Returns the same camera for a picture of another size. Focal lengths and principal point scale with the size.
    pub fn resized(self, (width, height): (u32, u32)) -> Result<Self> {
        let (sx, sy) = (
            f64::from(width) / f64::from(self.width),
            f64::from(height) / f64::from(self.height),
        );
        Self {
            width,
            height,
            fx: self.fx * sx,
            fy: self.fy * sy,
            cx: self.cx * sx,
            cy: self.cy * sy,
            ..self
        }
        .checked()
    }

    /// Returns the planes at [`clip_near`](Self::clip_near) and [`clip_far`](Self::clip_far).
    ///
    /// # Errors
    /// [`Error::Invalid`] for depths that are not finite, and where nothing lies between the two.
    pub fn clip_planes(&self) -> Result<Vec<Plane>> {
        if let (Some(near), Some(far)) = (self.clip_near, self.clip_far)
            && near >= far
        {
            return Err(Error::Invalid(format!(
                "the near plane is at a depth of {near} and the far plane at {far}, so that both together cut away everything; give a far plane behind the near one"
            )));
        }
        let forward = self.rotation.transpose() * DVec3::Z;
        let depth_of_origin = -forward.dot(self.eye);
        let near = self
            .clip_near
            .map(|near| Plane::new(forward, depth_of_origin - near));
        let far = self
            .clip_far
            .map(|far| Plane::new(-forward, far - depth_of_origin));
        near.into_iter().chain(far).collect()
    }

    /// The depth from which splats are drawn, the scene's units, of which one of the camera's has so many.
    #[doc(hidden)]
    pub fn nearest(&self, unit: f64) -> f64 {
        self.near_cut
            .map_or(f64::from(limits::NEAR_Z), |depth| depth * unit)
    }

    /// Checks that splats can be drawn from its [near cut](Self::near_cut) on.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a depth that is not above 0, or not finite, in single precision.
    pub fn check_near_cut(&self) -> Result<()> {
        let is_depth = |depth: f32| depth.is_finite() && depth > 0.0;
        match self.near_cut {
            Some(depth) if !is_depth(depth as f32) => Err(Error::Invalid(format!(
                "a near cut at a depth of {depth} is not in front of the eye; give a depth above 0"
            ))),
            _ => Ok(()),
        }
    }

    /// True when a plane that moves with the camera cuts the scene.
    #[doc(hidden)]
    pub fn clips(&self) -> bool {
        self.clip_near.is_some() || self.clip_far.is_some()
    }

    /// What this camera sees of a region: the rest between its own planes.
    #[doc(hidden)]
    pub fn sees_of<'a>(&self, clip: &'a Clip) -> Result<Cow<'a, Clip>> {
        if !self.clips() {
            return Ok(Cow::Borrowed(clip));
        }
        let planes = Clip::of(self.clip_planes()?, ClipOp::And);
        Ok(Cow::Owned(Clip::joined(
            [clip.clone(), planes],
            ClipOp::And,
        )))
    }

    /// Returns the view matrix, from world to camera.
    pub fn world_to_camera(&self) -> DMat4 {
        DMat4::from_mat3_translation(self.rotation, -(self.rotation * self.eye))
    }

    /// Returns the camera in the space of a scene that has this placement.
    #[must_use]
    pub fn in_scene(&self, placement: &Placement) -> Self {
        if *placement == Placement::IDENTITY {
            return *self; // to the bit
        }
        // In perspective only directions count; the pixels of a unit depend on how large it is.
        let unit = match self.projection {
            Projection::Perspective => 1.0,
            Projection::Orthographic => placement.scale(),
        };
        Self {
            fx: self.fx * unit,
            fy: self.fy * unit,
            eye: placement.to_scene(self.eye),
            rotation: self.rotation * DMat3::from_quat(placement.rotation()),
            clip_near: self.clip_near.map(|depth| depth / placement.scale()),
            clip_far: self.clip_far.map(|depth| depth / placement.scale()),
            near_cut: self.near_cut.map(|depth| depth / placement.scale()),
            ..*self
        }
    }
}

/// How far axes are from unit length and from being square to each other; infinitely far if they are no numbers.
pub(crate) fn oblique(axes: DMat3) -> f64 {
    let errors = (axes.transpose() * axes - DMat3::IDENTITY).to_cols_array();
    errors.iter().fold(0.0, |most, error| match error.is_nan() {
        true => f64::INFINITY,
        false => f64::max(most, error.abs()),
    })
}

/// The world to camera rotation of a camera at `eye` that looks at `target` and has `up` upwards in its picture.
fn facing(eye: DVec3, target: DVec3, up: DVec3) -> Result<DMat3> {
    if !(eye.is_finite() && target.is_finite() && up.is_finite()) {
        return Err(Error::Invalid(
            "the camera's eye, target and up must be finite numbers".into(),
        ));
    }
    let forward = (target - eye).try_normalize();
    let forward = forward.ok_or_else(|| {
        Error::Invalid("the camera's eye and target are the same point; give two points".into())
    })?;
    let right = forward
        .cross(up)
        .try_normalize()
        .filter(|_| forward.cross(up).length() > 1e-12 * up.length());
    let right = right.ok_or_else(|| {
        Error::Invalid("the camera looks along its own up vector; give another --up".into())
    })?;
    Ok(DMat3::from_cols(right, forward.cross(right), forward).transpose())
}
