//! The camera as the stages use it, in the reference's own number type.

use super::real::{Real, Vec3};
use rara_base::limits::CLAMP_MARGIN;
use rara_scene::camera::{Camera, Projection};
use rara_scene::placement::Placement;

/// The camera's numbers that the stages need. In f32 they are those that the GPU is given.
#[derive(Debug, Clone, Copy)]
pub struct ViewTransform<T> {
    /// Picture width and height, pixels.
    pub size: [u32; 2],
    pub projection: Projection,
    /// Focal lengths along x and y, pixels; of an orthographic camera the pixels of a unit of the scene.
    pub focal: [T; 2],
    /// Principal point, pixels from the picture's top left corner.
    pub principal: [T; 2],
    /// Smallest x/z and y/z at which the projection's Jacobian is evaluated.
    pub slope_min: [T; 2],
    /// Largest x/z and y/z at which the projection's Jacobian is evaluated.
    pub slope_max: [T; 2],
    /// Rows of the layer to camera rotation, right, down and forward, times the layer's unit: vectors that they turn are in
    /// the scene's units.
    pub rows: [Vec3<T>; 3],
    /// The eye in the layer, rounded to `T`.
    pub eye_high: Vec3<T>,
    /// The part that the rounding lost: zero in f64.
    pub eye_low: Vec3<T>,
    /// Units of the scene in one of the layer's.
    pub unit: T,
    /// The depth from which centres are drawn, the scene's units.
    pub near_cut: T,
}

impl<T: Real> ViewTransform<T> {
    /// The view that a scene's camera gives a layer that is not placed otherwise.
    pub fn new(camera: &Camera) -> Self {
        Self::in_layer(camera, &Placement::IDENTITY)
    }

    /// The view that a scene's camera gives a layer that is placed in the scene.
    pub fn in_layer(camera: &Camera, placement: &Placement) -> Self {
        let (placed, unit) = (camera.in_scene(placement), placement.scale());
        let margin = f64::from(CLAMP_MARGIN);
        let size = [camera.width, camera.height].map(f64::from);
        let (focal, principal) = ([camera.fx, camera.fy], [camera.cx, camera.cy]);
        let slope = |axis: usize, edge: f64| match camera.projection {
            Projection::Perspective => T::of((edge * size[axis] - principal[axis]) / focal[axis]),
            // The Jacobian is the same everywhere, so that there is nothing to clamp.
            Projection::Orthographic => T::of(f64::INFINITY.copysign(edge)),
        };
        let rows = placed.rotation.transpose();
        let eye_high = Vec3::<T>::of(placed.eye);
        let rounded = glam::DVec3::new(eye_high.x.wide(), eye_high.y.wide(), eye_high.z.wide());
        Self {
            size: [camera.width, camera.height],
            projection: camera.projection,
            focal: focal.map(T::of),
            principal: principal.map(T::of),
            slope_min: [slope(0, -margin), slope(1, -margin)],
            slope_max: [slope(0, 1.0 + margin), slope(1, 1.0 + margin)],
            rows: [rows.x_axis, rows.y_axis, rows.z_axis].map(|row| Vec3::of(unit * row)),
            eye_high,
            eye_low: Vec3::of(placed.eye - rounded),
            unit: T::of(unit),
            near_cut: T::of(camera.nearest(1.0)),
        }
    }

    /// A point of the layer relative to the eye, along the layer's axes. Subtracting the eye in two steps keeps the digits
    /// that a single-precision eye far from the origin would lose.
    pub fn relative(&self, point: glam::Vec3) -> Vec3<T> {
        (Vec3::of(point.as_dvec3()) - self.eye_high) - self.eye_low
    }

    /// The direction in which a point of the layer is seen that is `relative` to the eye, along the layer's axes, of any
    /// length.
    pub fn direction(&self, relative: Vec3<T>) -> Vec3<T> {
        match self.projection {
            Projection::Perspective => relative,
            Projection::Orthographic => self.rows[2],
        }
    }

    /// A vector of the layer in camera axes, the scene's units.
    pub fn turn(&self, v: Vec3<T>) -> Vec3<T> {
        Vec3 {
            x: self.rows[0].dot(v),
            y: self.rows[1].dot(v),
            z: self.rows[2].dot(v),
        }
    }
}
