//! Clips: what stays visible, by the texts of the command line.

use std::path::PathBuf;

use pyo3::prelude::*;
use rara::clip::{Expression, NamedClip, load_clips};
use rara::scene::Bounds;
use rara::scene::layers::Region;
use rara::{Clip, Error, Result, Scene};

use crate::errors::{invalid, of_argument, raised};

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
}

/// Checks the text of a clip.
#[pyfunction]
pub(crate) fn check_clip(_clip: ClipOf) {}

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
