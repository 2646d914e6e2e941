//! Cameras as engines have them: from a view and a projection matrix, whatever the signs in them.
//!
//! Nothing is asked of the matrices' signs. A projection's rows x, y and w say what becomes of a point across and down the
//! picture, so that they are taken apart into the camera's axes and its lens (the RQ decomposition of photogrammetry): the
//! axis along which w grows is forward, and a mirror anywhere, in the view, in the projection or in the picture, is left in
//! the axes, whose determinant is then -1. No stage minds: each takes the rows as they are.

use glam::{DMat3, DMat4, DVec3, DVec4};

use super::{Camera, Projection};
use crate::depth::DepthMap;
use rara_base::counted::counted;
use rara_base::error::{Error, Result};
use rara_base::limits::NEAR_Z;
use rara_base::setters;

setters! {
    /// The normalised device coordinates of a host, its clip space after the division by w, which its matrices do not describe.
    ///
    /// The default is [`VULKAN`](Self::VULKAN).
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
    #[non_exhaustive]
    pub struct Ndc {
        /// True if y = 1 is the upper edge of the picture, as in Direct3D, Metal, WebGPU and OpenGL, and in Vulkan with a
        /// viewport of negative height. False if it is the lower edge.
        pub y_up: bool,
        /// True if depths go from -1 to 1, as in OpenGL and with `VK_EXT_depth_clip_control`; the buffer then has `(z + 1) /
        /// 2`. False if depths go from 0 to 1; the buffer then has the depths themselves.
        pub negative_one_to_one: bool,
        /// True if nearer points have larger values in the depth buffer. It matters only for orthographic projections, because
        /// their matrices do not tell; the matrix of a perspective projection does.
        pub reversed: bool,
    }
}

impl Ndc {
    /// y down, depths from 0 to 1.
    pub const VULKAN: Self = Self {
        y_up: false,
        negative_one_to_one: false,
        reversed: false,
    };
    /// y up, depths from 0 to 1: Direct3D, Metal, WebGPU and wgpu, and Vulkan with a viewport of negative height.
    pub const DIRECT3D: Self = Self {
        y_up: true,
        ..Self::VULKAN
    };
    /// y up, depths from -1 to 1.
    pub const OPENGL: Self = Self {
        negative_one_to_one: true,
        ..Self::DIRECT3D
    };
}

impl Camera {
    /// The camera of a host's matrices, and the map of its depth buffer.
    ///
    /// Both matrices are for column vectors, a point in clip space being `projection * view * point`; a host of row vectors
    /// transposes them, and one in single precision widens them by `as_dmat4`. The axes of the view may be any, with y up or
    /// down and z forward or back, left-handed ones too: the camera's [`rotation`](Self::rotation) then has a mirror in it.
    /// The view may scale, evenly along its axes, and lead from a scene instead of the world (`view * model`), mirrors
    /// included. The projection may be reversed, infinite, off-centre, jittered, turned by quarters (as for a display's
    /// pre-rotation) or orthographic; `ndc` has what that leaves open. `size` is that of the viewport, pixels.
    ///
    /// The camera has the usual [near cut](Self::near_cut), whatever the projection's near plane. An orthographic camera's eye is moved back
    /// where that would leave out what lies behind the near plane, and the depth map counts from there.
    ///
    /// ```
    /// # use rara_scene as rara;
    /// use rara::glam::{DVec3, dcamera::rh};
    /// use rara::{Camera, Ndc};
    ///
    /// // A host on wgpu: right-handed, y up, reversed and infinite depth.
    /// let view = rh::view::look_at_mat4(DVec3::new(0.0, 1.0, 4.0), DVec3::ZERO, DVec3::Y);
    /// let projection = rh::proj::directx::perspective_infinite_reverse(0.9, 640.0 / 480.0, 0.1);
    /// let (camera, depth) = Camera::of_projection(view, projection, Ndc::DIRECT3D, (640, 480))?;
    /// assert!(camera.eye.distance(DVec3::new(0.0, 1.0, 4.0)) < 1e-12);
    /// assert!(depth.is_reversed() && (depth.at(0.1) - 1.0).abs() < 1e-12);
    /// # Ok::<(), rara::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Invalid`], which names the matrix and what in it is not possible: an entry that is not finite, a matrix that
    /// is singular or looks transposed, a view that shears or scales unevenly, a projection that shears, or whose depth is not
    /// a function of the distance alone (as with an oblique near plane); and an impossible size of picture.
    pub fn of_projection(
        view: DMat4,
        projection: DMat4,
        ndc: Ndc,
        size: (u32, u32),
    ) -> Result<(Self, DepthMap)> {
        Self::check_size(size)?;
        let view = View::new(view)?;
        check_projection(&projection)?;
        let lens = Lens::new(&projection, ndc, size)?;
        let turned = lens.axes * view.axes;
        // Of the camera's own axes, the depth's is the one that has to be kept best.
        let forward = turned.row(2).normalize();
        let right = turned.row(0);
        let right = (right - forward * right.dot(forward)).normalize();
        let down = forward.cross(right) * turned.determinant().signum();
        let rotation = DMat3::from_cols(right, down, forward).transpose();
        // Pixels of a unit of the view become those of a unit of the world.
        let (unit, map) = match lens.projection {
            Projection::Perspective => (1.0, [lens.depth[0], lens.depth[1] / view.unit]),
            Projection::Orthographic => (view.unit, [lens.depth[0], lens.depth[1] * view.unit]),
        };
        let back = match lens.projection {
            Projection::Perspective => 0.0,
            Projection::Orthographic => far_enough(map),
        };
        let [offset, scale] = map;
        let depth = DepthMap::new(lens.projection, offset + scale * back, scale)?;
        let eye = view.to_world(lens.eye) - back * forward;
        let camera = Self::centred(eye, rotation, lens.focal[0] * unit, size)
            .fy(lens.focal[1] * unit)
            .cx(lens.principal[0])
            .cy(lens.principal[1])
            .projection(lens.projection);
        Ok((camera.checked()?, depth))
    }
}

/// By how much an orthographic eye moves back so that the near plane, where the map `offset - scale z` is 0, or 1 where nearer
/// is more, is not nearer than what is drawn.
fn far_enough([offset, scale]: [f64; 2]) -> f64 {
    let at_near = if scale > 0.0 { 1.0 } else { 0.0 };
    let near = (offset - at_near) / scale;
    (f64::from(NEAR_Z) - near).max(0.0)
}

/// How unequal and how oblique the axes of a view may be, which hosts turn in single precision and by many small steps.
const VIEW_TOLERANCE: f64 = 1e-4;
/// How far the first numbers of a view's last row may be from 0.
const LAST_ROW_TOLERANCE: f64 = 1e-6;
/// How oblique a projection may be.
const SHEAR_TOLERANCE: f64 = 1e-6;

/// A view matrix taken apart.
struct View {
    /// The part that turns, and scales, as it is.
    linear: DMat3,
    offset: DVec3,
    /// How long a unit of the world is in the view.
    unit: f64,
    /// The part that turns, and mirrors perhaps.
    axes: DMat3,
}

impl View {
    fn new(matrix: DMat4) -> Result<Self> {
        check_finite(&matrix, "view")?;
        let last = matrix.row(3);
        // What a host has inverted in single precision is not exact.
        if last.truncate().abs().max_element() > LAST_ROW_TOLERANCE
            || (last.w - 1.0).abs() > VIEW_TOLERANCE
        {
            let transposed = matrix.w_axis == DVec4::W;
            return refused(format!(
                "the view matrix's last row is {last}, and not 0, 0, 0, 1{}",
                match transposed {
                    true => ": it is for row vectors; transpose it",
                    false => ": give the matrix from the world to the view, without a projection",
                }
            ));
        }
        let matrix = matrix * (1.0 / last.w);
        let linear = DMat3::from_mat4(matrix);
        let lengths = [linear.x_axis, linear.y_axis, linear.z_axis].map(DVec3::length);
        let unit = (linear.x_axis.length_squared()
            + linear.y_axis.length_squared()
            + linear.z_axis.length_squared())
        .sqrt()
            / 3.0_f64.sqrt();
        let axes = linear * (1.0 / unit);
        if !(unit > 0.0 && axes.is_finite()) {
            return refused(format!(
                "the view matrix is singular: its columns are {lengths:?} long; give a rotation and a translation"
            ));
        }
        if super::oblique(axes) > VIEW_TOLERANCE {
            return refused(format!(
                "the view matrix shears, or scales unevenly: its columns are {lengths:?} long and must be equally long and square to each other; leave such a scale out of the view"
            ));
        }
        Ok(Self {
            linear,
            offset: matrix.w_axis.truncate(),
            unit,
            axes,
        })
    }

    fn to_world(&self, point: DVec3) -> DVec3 {
        self.linear.inverse() * (point - self.offset)
    }
}

/// A projection matrix taken apart, in the units of the view.
struct Lens {
    projection: Projection,
    /// Rows: right, down and forward in the view.
    axes: DMat3,
    focal: [f64; 2],
    principal: [f64; 2],
    /// The eye in the view.
    eye: DVec3,
    /// Offset and scale of the depth map.
    depth: [f64; 2],
}

impl Lens {
    fn new(matrix: &DMat4, ndc: Ndc, size: (u32, u32)) -> Result<Self> {
        let [x, y, z, w] = [0, 1, 2, 3].map(|row| matrix.row(row));
        // From -1 at one edge to pixels from the left and the upper one.
        let half = [size.0, size.1].map(|side| f64::from(side) / 2.0);
        let y = if ndc.y_up { -y } else { y };
        let (x, y) = (half[0] * (w + x), half[1] * (w + y));
        let z = match ndc.negative_one_to_one {
            true => 0.5 * (z + w),
            false => z,
        };
        match w.truncate() == DVec3::ZERO {
            true => Self::orthographic([x, y, z].map(|row| row / w.w), ndc),
            false => Self::perspective([x, y, z], w),
        }
    }

    fn perspective([x, y, z]: [DVec4; 3], w: DVec4) -> Result<Self> {
        // Points are the same whatever the whole is multiplied by, but for the sign, which says what is in front.
        let length = w.truncate().length();
        let forward = w.truncate() / length;
        let [x, y, z] = [x, y, z].map(|row| row / length);
        let (right, cx) = across(x.truncate(), forward);
        let (down, cy) = across(y.truncate(), forward);
        let (axes, focal) = axes(right, down, forward)?;
        let rows = DMat3::from_cols(x.truncate(), y.truncate(), forward).transpose();
        let eye = -(rows.inverse() * DVec3::new(x.w, y.w, w.w / length));
        let (aside, offset) = across(z.truncate(), forward);
        let scale = z.truncate().dot(eye) + z.w;
        if aside.length() > SHEAR_TOLERANCE {
            return oblique();
        }
        if scale == 0.0 || !scale.is_finite() {
            return refused(format!(
                "the projection matrix is singular: its depth is {offset} at every distance; give row 2 the depths of a near and a far plane"
            ));
        }
        Ok(Self {
            projection: Projection::Perspective,
            axes,
            focal,
            principal: [cx, cy],
            eye,
            depth: [offset, scale],
        })
    }

    /// Rows are divided by w, which is the same everywhere.
    fn orthographic([x, y, z]: [DVec4; 3], ndc: Ndc) -> Result<Self> {
        let [right, down, deep] = [x, y, z].map(DVec4::truncate);
        let slope = deep.length();
        if slope == 0.0 {
            return refused(
                "the projection matrix is singular: its row 2 gives every point the same depth; give it the depths of a near and a far plane".into(),
            );
        }
        let forward = match ndc.reversed {
            true => -deep / slope,
            false => deep / slope,
        };
        let leans = |v: DVec3| v.dot(forward).abs() > SHEAR_TOLERANCE * v.length();
        if leans(right) || leans(down) {
            return oblique();
        }
        let (axes, focal) = axes(right, down, forward)?;
        Ok(Self {
            projection: Projection::Orthographic,
            axes,
            focal,
            principal: [x.w, y.w],
            eye: DVec3::ZERO,
            depth: [z.w, if ndc.reversed { slope } else { -slope }],
        })
    }
}

/// What of a row runs across the view's axis, and how much along it.
fn across(row: DVec3, forward: DVec3) -> (DVec3, f64) {
    let along = row.dot(forward);
    (row - along * forward, along)
}

/// The camera's axes, and the pixels of a unit along two of them.
fn axes(right: DVec3, down: DVec3, forward: DVec3) -> Result<(DMat3, [f64; 2])> {
    let focal = [right.length(), down.length()];
    for (row, focal) in focal.into_iter().enumerate() {
        if !(focal > 0.0 && focal.is_finite()) {
            return refused(format!(
                "the projection matrix is singular: its row {row} makes a picture of {} a unit",
                counted(focal, "pixel")
            ));
        }
    }
    let (right, down) = (right / focal[0], down / focal[1]);
    let shear = right.dot(down);
    if shear.abs() > SHEAR_TOLERANCE {
        return refused(format!(
            "the projection matrix shears the picture: the cosine between its rows 0 and 1 is {shear}, and must be 0; a camera's pixels are rectangles"
        ));
    }
    Ok((DMat3::from_cols(right, down, forward).transpose(), focal))
}

fn check_projection(matrix: &DMat4) -> Result<()> {
    check_finite(matrix, "projection")?;
    let (last, column) = (matrix.row(3), matrix.w_axis);
    if last == DVec4::ZERO {
        return refused("the projection matrix is singular: its last row is 0".into());
    }
    // Of a perspective one, the place of the 1 says it; of an orthographic one, the row that has to be 0, 0, 0, 1.
    let perspective = last.w == 0.0 && last.z.abs() != 1.0 && column.z.abs() == 1.0;
    let orthographic = last.w == 1.0 && last.truncate() != DVec3::ZERO && column == DVec4::W;
    if (perspective && last.truncate().truncate() == glam::DVec2::ZERO) || orthographic {
        return refused(format!(
            "the projection matrix's last row is {last}, and its last column {column}: it is for row vectors; transpose it"
        ));
    }
    Ok(())
}

fn check_finite(matrix: &DMat4, name: &str) -> Result<()> {
    for row in 0..4 {
        let entries = matrix.row(row).to_array();
        if let Some(column) = entries.iter().position(|entry| !entry.is_finite()) {
            return refused(format!(
                "the {name} matrix has {} in row {row}, column {column}, both from 0; all entries must be finite",
                entries[column]
            ));
        }
    }
    Ok(())
}

fn oblique<T>() -> Result<T> {
    refused(
        "the projection matrix's row 2 makes depths that are not a function of the distance alone: give it a near plane square to the view, as it is before it is made oblique".into(),
    )
}

fn refused<T>(message: String) -> Result<T> {
    Err(Error::Invalid(message))
}

#[cfg(test)]
mod tests;
