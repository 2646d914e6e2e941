//! Cameras, and the cameras of orbits, paths and sections.

use std::path::PathBuf;

use glam::{DMat4, DVec3};
use pyo3::prelude::*;
use rara::camera_files::{NamedCamera, SavedCamera, load_camera, load_cameras};
use rara::clip::Expression;
use rara::scene::{Axis, Bounds};
use rara::{Camera as RaraCamera, Projection, Result};
use rara_base::files::write_atomically;
use rara_shots::{Depths, Ease, Framing, Lens, Orbit, Sections, Spline, UP, Visible};

use crate::arrays::{Array, fixed, owned};
use crate::clip::Clip;
use crate::errors::{called, check_room, choice, invalid, of_argument, raised};
use crate::scene::SceneOf;

/// The size of pictures where nothing else is said, as of the command line.
const SIZE: (u32, u32) = (1024, 1024);
/// The vertical field of view where nothing else is said, degrees.
const FOV_Y: f64 = 50.0;

/// A camera in COLMAP's convention: +x right, +y down, +z forward, pixel centres at half-integers. A camera does not change.
///
/// Where nothing else is said, pictures are 1024 x 1024 pixels, `fov_y` is 50 degrees, and up is -y.
/// `Camera.look_at`, `orthographic`, `from_matrices`, `frame`, `load` and `load_all` make cameras.
#[pyclass(frozen, eq, module = "rara")]
#[derive(PartialEq)]
pub(crate) struct Camera {
    pub(crate) camera: RaraCamera,
    /// Width and height of the picture, pixels.
    #[pyo3(get)]
    size: (u32, u32),
    /// The position, world units.
    #[pyo3(get)]
    eye: [f64; 3],
    /// True for a camera without perspective.
    #[pyo3(get)]
    ortho: bool,
}

impl From<RaraCamera> for Camera {
    fn from(camera: RaraCamera) -> Self {
        Self {
            size: (camera.width, camera.height),
            eye: camera.eye.into(),
            ortho: camera.projection == Projection::Orthographic,
            camera,
        }
    }
}

#[pymethods]
impl Camera {
    /// A camera in perspective at `eye` that looks at `target`; `up` is up in the picture, and `fov_y` the vertical field of view in
    /// degrees. `size` is the width and height of the picture, pixels.
    #[staticmethod]
    #[pyo3(signature = (eye, target, up=UP.to_array(), fov_y=FOV_Y, size=Size(SIZE)))]
    fn look_at(
        eye: [f64; 3],
        target: [f64; 3],
        up: [f64; 3],
        fov_y: f64,
        size: Size,
    ) -> PyResult<Self> {
        let [eye, target, up] = [eye, target, up].map(DVec3::from);
        made(RaraCamera::look_at(eye, target, up, fov_y, size.0))
    }

    /// A camera without perspective, whose picture is `height` world units high.
    #[staticmethod]
    #[pyo3(signature = (eye, target, height, up=UP.to_array(), size=Size(SIZE)))]
    fn orthographic(
        eye: [f64; 3],
        target: [f64; 3],
        height: f64,
        up: [f64; 3],
        size: Size,
    ) -> PyResult<Self> {
        let [eye, target, up] = [eye, target, up].map(DVec3::from);
        made(RaraCamera::orthographic(eye, target, up, height, size.0))
    }

    /// A camera of a rigid world-to-camera matrix `viewmat` [4, 4] and of `K` [3, 3]: focal lengths and the principal point in
    /// pixels, without skew. With `ortho`, the focal lengths are pixels to a world unit.
    #[staticmethod]
    #[pyo3(signature = (viewmat, K, width, height, ortho=false))]
    #[allow(non_snake_case)] // its name everywhere
    fn from_matrices(
        viewmat: &Bound<'_, PyAny>,
        K: &Bound<'_, PyAny>,
        width: u32,
        height: u32,
        ortho: bool,
    ) -> PyResult<Self> {
        let matrix = DMat4::from_cols_array(&fixed::<16>(viewmat, "viewmat", [4, 4])?).transpose();
        let lens = fixed::<9>(K, "K", [3, 3])?;
        let [fx, skew, cx, skew_y, fy, cy, last @ ..] = lens;
        if [skew, skew_y] != [0.0; 2] || last != [0.0, 0.0, 1.0] {
            let message = format!("K is {lens:?}; give [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]");
            return Err(invalid(message));
        }
        let camera = RaraCamera::from_world_to_camera(matrix, (fx, fy, cx, cy), (width, height));
        let camera = camera.map_err(of_argument("viewmat, K, width, height"))?;
        Ok(Self::from(match ortho {
            true => camera.projection(Projection::Orthographic),
            false => camera,
        }))
    }

    /// The camera that shows all that is visible of a scene, from the front, the right and above, as near as possible. `up` is
    /// by default that of the scene, or -y. With `ortho` it has no perspective.
    #[staticmethod]
    #[pyo3(signature = (scene, size=Size(SIZE), *, fov_y=FOV_Y, up=None, ortho=false))]
    fn frame(
        py: Python<'_>,
        scene: SceneOf,
        size: Size,
        fov_y: f64,
        up: Option<[f64; 3]>,
        ortho: bool,
    ) -> PyResult<Self> {
        let framing = framing(&scene, size.0, (fov_y, up, ortho));
        made(py.detach(|| framing.camera(&Visible::of(&scene.scene(&[])?))))
    }

    /// Reads one camera: that of a file of `save`, or with `view` the camera of a name or number in a file of several, such as
    /// cameras.json, transforms.json or a COLMAP folder. `undistort` takes the pinhole of a lens that bends straight lines.
    #[staticmethod]
    #[pyo3(signature = (path, view=None, *, undistort=false))]
    fn load(path: PathBuf, view: Option<Bound<'_, PyAny>>, undistort: bool) -> PyResult<Self> {
        let Some(view) = view else {
            return made(load_camera(&path));
        };
        let cameras = load_cameras(&path).map_err(raised)?;
        let found = called(cameras.iter().map(NamedCamera::name), &view)?;
        let missing = || invalid(format!("view: {} has no camera '{view}'", path.display()));
        named(&cameras[found.ok_or_else(missing)?], undistort)
    }

    /// Reads all cameras of a file or a COLMAP folder, with their names.
    #[staticmethod]
    #[pyo3(signature = (path, *, undistort=false))]
    fn load_all(path: PathBuf, undistort: bool) -> PyResult<Vec<(String, Self)>> {
        let cameras = load_cameras(&path).map_err(raised)?;
        let of = |camera: &NamedCamera| Ok((camera.name().to_owned(), named(camera, undistort)?));
        cameras.iter().map(of).collect()
    }

    /// Writes the camera to a JSON file for `load` and `rara --camera`.
    fn save(&self, path: PathBuf) -> PyResult<()> {
        let text = serde_json::to_string_pretty(&SavedCamera::from(&self.camera));
        let text = text.map_err(invalid)? + "\n";
        write_atomically(&path, |file| file.write_all(text.as_bytes())).map_err(raised)
    }

    /// The world-to-camera matrix: float64 [4, 4].
    #[getter]
    fn viewmat<'py>(&self, py: Python<'py>) -> PyResult<Array<'py, f64>> {
        let matrix = self.camera.world_to_camera().transpose();
        owned(py, matrix.to_cols_array().to_vec(), &[4, 4])
    }

    /// Focal lengths and principal point, pixels: float64 [3, 3].
    #[getter]
    #[allow(non_snake_case)] // its name everywhere
    fn K<'py>(&self, py: Python<'py>) -> PyResult<Array<'py, f64>> {
        let RaraCamera { fx, fy, cx, cy, .. } = self.camera;
        owned(py, vec![fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0], &[3, 3])
    }

    /// Returns the same camera with a picture of another size, and with other depths, world units: `clip_near` and `clip_far` are
    /// planes that cut the scene, and Gaussians with centres nearer than `near_cut` are left out whole.
    #[pyo3(signature = (*, size=None, clip_near=None, clip_far=None, near_cut=None))]
    fn replace(
        &self,
        size: Option<Size>,
        clip_near: Option<f64>,
        clip_far: Option<f64>,
        near_cut: Option<f64>,
    ) -> PyResult<Self> {
        let camera = self.camera.resized(size.map_or(self.size, |size| size.0));
        let (near, far, cut) = (clip_near, clip_far, near_cut);
        let depths = Depths { near, far, cut };
        made(camera.and_then(|camera| depths.camera(camera)))
    }

    fn __repr__(&self) -> String {
        let ((width, height), [x, y, z]) = (self.size, self.eye);
        let kind = if self.ortho { "orthographic, " } else { "" };
        format!("<rara.Camera: {kind}{width}x{height} at ({x}, {y}, {z})>")
    }
}

/// A camera as an argument.
pub(crate) struct CameraOf(pub(crate) RaraCamera);

impl<'py> FromPyObject<'_, 'py> for CameraOf {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let camera = given.cast::<Camera>().map_err(|_| {
            let kind = given.get_type();
            invalid(format!(
                "camera is a {kind}; give a rara.Camera, a clip by clip=..., and of a rara.Shot its camera, clip and section"
            ))
        })?;
        Ok(Self(camera.get().camera))
    }
}

/// The width and height of a picture as an argument: a sequence of both.
pub(crate) struct Size(pub(crate) (u32, u32));

impl<'py> FromPyObject<'_, 'py> for Size {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let [width, height] = given.extract().map_err(|_| {
            invalid(format!(
                "size is {:?}; give a width and a height, pixels",
                &*given
            ))
        })?;
        Ok(Self((width, height)))
    }
}

fn made(camera: Result<RaraCamera>) -> PyResult<Camera> {
    camera.map(Camera::from).map_err(raised)
}

fn named(camera: &NamedCamera, undistort: bool) -> PyResult<Camera> {
    made(match undistort {
        true => camera.undistorted(),
        false => camera.camera(),
    })
}

fn framing(
    scene: &SceneOf,
    size: (u32, u32),
    (fov_y, up, ortho): (f64, Option<[f64; 3]>, bool),
) -> Framing {
    let lens = match ortho {
        true => Lens::Orthographic(None),
        false => Lens::Perspective(fov_y),
    };
    Framing::new(lens, size).up(up.map(DVec3::from).or(scene.up).unwrap_or(UP))
}

/// The camera of a picture: the given one, in a given size, or the one that frames the scene.
pub(crate) fn camera_of(
    camera: Option<&RaraCamera>,
    size: Option<(u32, u32)>,
    scene: &SceneOf,
) -> Result<RaraCamera> {
    match (camera, size) {
        (Some(camera), None) => Ok(*camera),
        (Some(camera), Some(size)) => camera.resized(size),
        (None, size) => {
            let framing = framing(scene, size.unwrap_or(SIZE), (FOV_Y, None, false));
            framing.camera(&Visible::of(&scene.scene(&[])?))
        }
    }
}

/// Cameras that are as many as asked for.
fn several(
    py: Python<'_>,
    frames: u32,
    make: impl FnOnce() -> Result<Vec<RaraCamera>> + Send,
) -> PyResult<Vec<Camera>> {
    check_room(frames.into(), 2 * size_of::<Camera>() as u64, "cameras").map_err(raised)?;
    let cameras = py.detach(make).map_err(raised)?;
    Ok(cameras.into_iter().map(Camera::from).collect())
}

/// Cameras on an orbit around the middle of what is visible of a scene, as near as possible with all of it in every picture.
/// `turns` below zero turn to the left, and `ease` is the pace: "none", "in", "out" or "both".
#[pyfunction]
#[pyo3(signature = (scene, frames=120, *, turns=1.0, size=Size(SIZE), fov_y=FOV_Y, up=None, ortho=false, ease="none"))]
#[allow(clippy::too_many_arguments)] // they have names in Python
pub(crate) fn orbit(
    py: Python<'_>,
    scene: SceneOf,
    frames: u32,
    turns: f64,
    size: Size,
    fov_y: f64,
    up: Option<[f64; 3]>,
    ortho: bool,
    ease: &str,
) -> PyResult<Vec<Camera>> {
    let framing = framing(&scene, size.0, (fov_y, up, ortho));
    if !turns.is_finite() {
        return Err(invalid(format!("turns is {turns}; give a finite number")));
    }
    let orbit = Orbit::new(turns, frames).ease(choice("ease", ease)?);
    several(py, frames, || {
        framing.orbit(orbit, &Visible::of(&scene.scene(&[])?))
    })
}

/// Cameras on a smooth path through others, closed or from the first to the last.
#[pyfunction]
#[pyo3(signature = (cameras, frames=120, *, closed=false, ease="none"))]
pub(crate) fn path(
    py: Python<'_>,
    cameras: Vec<Bound<'_, Camera>>,
    frames: u32,
    closed: bool,
    ease: &str,
) -> PyResult<Vec<Camera>> {
    let through: Vec<_> = cameras.iter().map(|camera| camera.get().camera).collect();
    let ease: Ease = choice("ease", ease)?;
    several(py, frames, || {
        let spline = Spline::through(&through, closed)?.ease(ease);
        Ok(spline.cameras(frames))
    })
}

/// The camera of a section, and its clip: across an axis, "x" or "sagittal", "y" or "coronal", "z" or "axial" ("!" sees it
/// from the other side), at a share from 0 to 1 of the scene's bounds. `thickness` is that of a slab, and `scale` the world units to
/// a pixel; without them all that is behind the plane is kept and shown.
#[pyfunction]
#[pyo3(signature = (scene, axis, at, *, size=Size(SIZE), up=None, scale=None, thickness=None))]
#[allow(clippy::too_many_arguments)] // they have names in Python
pub(crate) fn section(
    py: Python<'_>,
    scene: SceneOf,
    axis: &str,
    at: f64,
    size: Size,
    up: Option<[f64; 3]>,
    scale: Option<f64>,
    thickness: Option<f64>,
) -> PyResult<(Camera, Clip)> {
    let unknown = || {
        invalid(format!(
            "axis: there is no '{axis}'; give x, y, z, sagittal, coronal or axial"
        ))
    };
    let axis = Axis::parse(axis).ok_or_else(unknown)?;
    let sections = Sections::new(size.0).up(up.map(DVec3::from));
    let sections = sections.scale(scale).thickness(thickness);
    let section = py.detach(|| {
        let scene = scene.scene(&[])?;
        sections.across(
            (&axis, at),
            &Bounds::of(&scene),
            &Visible::nearly_all_of(&scene),
        )
    });
    let section = section.map_err(raised)?;
    let mut shapes = section.shapes();
    let clip = match shapes.len() {
        1 => shapes.remove(0),
        _ => Expression::All(shapes),
    };
    Ok((section.camera.into(), clip.into()))
}
