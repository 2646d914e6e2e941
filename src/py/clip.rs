//! A clip, and clips as arguments.

use std::path::PathBuf;

use glam::DQuat;
use pyo3::prelude::*;
use rara::clip::{Expression, MeshShape};
use rara::scene::layers::{LayerClip, Region};
use rara::{MeshRule, Placement, Result};

use crate::errors::{invalid, of_argument, raised};

/// A region that stays visible, by the text of a shape or of an expression.
///
/// Texts are those of the command line: "plane:0,0,1,-2", "!sphere:0,0,0,1", "all(box:0,0,0,1,1,1, not(plane:z=40%))".
/// Lengths in percent are shares of the bounds of the scene that is cut. `a & b` keeps what both keep, `a | b` what either
/// keeps, and `~a` what `a` does not keep. InvalidError says what is wrong with a text, and in which column.
#[pyclass(frozen, subclass, eq, str = "{text}", module = "rara")]
#[derive(Clone, PartialEq)]
pub(crate) struct Clip {
    /// The text.
    #[pyo3(get)]
    pub(crate) text: String,
    /// The text's meaning; the files that it names have been read.
    pub(crate) region: Region,
}

impl Clip {
    pub(crate) fn of(text: String) -> PyResult<Self> {
        let region = text.parse().map_err(of_argument("clip"))?;
        Ok(Self { text, region })
    }
}

impl From<Expression> for Clip {
    fn from(expression: Expression) -> Self {
        Self {
            text: expression.to_string(),
            region: Region::Fixed(expression),
        }
    }
}

/// Keeps the inside of the closed mesh of a file (.obj, .stl, .ply, .gltf or .glb), scaled, turned by a quaternion w, x, y, z, and
/// then moved, world units. The file is read once.
///
/// With `winding`, the mesh may be open or cut itself: its inside is where the winding number is not zero.
#[pyclass(frozen, extends = Clip, module = "rara")]
pub(crate) struct Mesh;

#[pymethods]
impl Mesh {
    #[new]
    #[pyo3(signature = (path, *, scale=1.0, rotation=[1.0, 0.0, 0.0, 0.0], position=[0.0; 3], winding=false))]
    fn new(
        path: PathBuf,
        scale: f64,
        rotation: [f64; 4],
        position: [f64; 3],
        winding: bool,
    ) -> PyResult<PyClassInitializer<Self>> {
        let rule = match winding {
            true => MeshRule::Winding,
            false => MeshRule::Closed,
        };
        let mesh = placement(position, rotation, scale)
            .and_then(|placement| MeshShape::read(path, rule, placement));
        let mesh = Expression::Mesh(mesh.map_err(raised)?);
        Ok(PyClassInitializer::from(Clip::from(mesh)).add_subclass(Self))
    }
}

/// The placement of what is scaled, turned by a quaternion w, x, y, z, and then moved.
pub(crate) fn placement(
    position: [f64; 3],
    [w, x, y, z]: [f64; 4],
    scale: f64,
) -> Result<Placement> {
    Placement::new(position.into(), DQuat::from_xyzw(x, y, z, w), scale)
}

/// A clip as an argument: a `rara.Clip`, or a text.
#[derive(Clone)]
pub(crate) struct ClipOf(pub(crate) Clip);

impl<'py> FromPyObject<'_, 'py> for ClipOf {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(clip) = given.cast::<Clip>() {
            return Ok(Self(clip.get().clone()));
        }
        let text = given.extract().map_err(|_| {
            let kind = given.get_type();
            invalid(format!(
                "clip is a {kind}; give a rara.Clip or the text of one"
            ))
        });
        Clip::of(text?).map(Self)
    }
}

/// The clip of a layer as an argument: a clip, or "whole".
pub(crate) fn own_clip(given: &Bound<'_, PyAny>) -> PyResult<LayerClip<Region>> {
    match given.extract::<String>() {
        Ok(text) => LayerClip::parse(&text).map_err(of_argument("clip")),
        Err(_) => Ok(LayerClip::Region(given.extract::<ClipOf>()?.0.region)),
    }
}
