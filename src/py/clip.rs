//! Clips: what stays visible, by the texts of the command line.

use std::path::PathBuf;

use glam::DVec3;
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use rara::clip::{Expression, NamedClip, clips_to_json, load_clips};
use rara::scene::Bounds;
use rara::scene::layers::Region;
use rara::{Clip, Error, Result, Scene};
use rara_base::files::write_atomically;

use crate::arrays::{numbers, owned};
use crate::errors::{invalid, of_argument, raised};
use crate::scene::SceneOf;

/// A clip as an argument: a text, or an object that has one.
#[derive(Clone)]
pub(crate) struct ClipOf(pub(crate) Region);

impl<'py> FromPyObject<'_, 'py> for ClipOf {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let text = given.getattr("text").and_then(|text| text.extract());
        let text: String = text.or_else(|_| given.extract()).map_err(|_| {
            let kind = given.get_type();
            invalid(format!(
                "clip is a {kind}; give a rara.Clip or the text of one"
            ))
        })?;
        text.parse().map(Self).map_err(of_argument("clip"))
    }
}

impl ClipOf {
    pub(crate) fn expression(&self, scene: &Scene<'_>) -> Result<Expression> {
        self.0.resolve(|| Bounds::of(scene))
    }

    pub(crate) fn within(&self, scene: &Scene<'_>) -> Result<Clip> {
        Ok(self.expression(scene)?.clip())
    }

    /// The expression of a clip that may need a scene.
    fn settled(&self, scene: Option<&SceneOf>) -> PyResult<Expression> {
        match (&self.0, scene) {
            (Region::Fixed(fixed), _) => Ok(fixed.clone()),
            (_, Some(scene)) => self
                .expression(&scene.scene(&[]).map_err(raised)?)
                .map_err(raised),
            (_, None) => Err(invalid(
                "scene is missing: the clip has lengths in percent of one",
            )),
        }
    }
}

/// Checks the text of a clip.
#[pyfunction]
pub(crate) fn check_clip(_clip: ClipOf) {}

/// Says of each point whether a clip keeps it.
#[pyfunction]
pub(crate) fn clip_keeps<'py>(
    clip: ClipOf,
    points: &Bound<'py, PyAny>,
    scene: Option<SceneOf>,
) -> PyResult<Bound<'py, PyArrayDyn<bool>>> {
    let clip = clip.settled(scene.as_ref())?.clip();
    let array = numbers::<f64>(points, "points", &[None, Some(3)])?;
    let each = array.as_slice()?.as_chunks().0.iter();
    let kept: Vec<_> = each
        .map(|point| clip.keeps(DVec3::from_array(*point)))
        .collect();
    let count = kept.len();
    owned(points.py(), kept, &[count])
}

/// The text of the clip between two others.
#[pyfunction]
pub(crate) fn clip_between(
    from: ClipOf,
    to: ClipOf,
    share: f64,
    scene: Option<SceneOf>,
) -> PyResult<String> {
    let (from, to) = (from.settled(scene.as_ref())?, to.settled(scene.as_ref())?);
    Ok(from.between(&to, share).map_err(raised)?.to_string())
}

/// The text of a clip of a JSON file, by its name or its number.
#[pyfunction]
pub(crate) fn load_clip(path: PathBuf, name: Option<&str>) -> PyResult<String> {
    let clips = load_clips(&path).map_err(raised)?;
    let found = match name {
        None => <&[NamedClip; 1]>::try_from(&clips[..])
            .ok()
            .map(|[only]| only),
        Some(name) => {
            let called = clips.iter().find(|clip| clip.name == name);
            called.or_else(|| clips.get(name.parse::<usize>().ok()?))
        }
    };
    let found = found.ok_or_else(|| {
        let names: Vec<_> = clips.iter().map(|clip| clip.name.as_str()).collect();
        let message = format!("name one of its clips: {}", names.join(", "));
        raised(Error::format(&path, message))
    })?;
    Ok(found.clip.to_string())
}

/// Writes a clip to a JSON file.
#[pyfunction]
pub(crate) fn save_clip(clip: ClipOf, path: PathBuf, scene: Option<SceneOf>) -> PyResult<()> {
    let name = path
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into();
    let clip = clip.settled(scene.as_ref())?;
    let json = clips_to_json(&[NamedClip {
        name,
        clip,
        layer: None,
    }]);
    write_atomically(&path, |file| file.write_all(json.as_bytes())).map_err(raised)
}
