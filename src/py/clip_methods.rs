//! The methods that clips have in Python.

use std::path::PathBuf;

use glam::DVec3;
use pyo3::prelude::*;
use pyo3::types::PyString;
use rara::Error;
use rara::clip::{Expression, NamedClip, clips_to_json, load_clips};
use rara::scene::layers::Region;
use rara_base::files::write_atomically;

use crate::arrays::{Array, numbers, owned};
use crate::clip::{Clip, ClipOf};
use crate::errors::{called, invalid, raised};
use crate::scene::SceneOf;

#[pymethods]
impl Clip {
    #[new]
    fn new(text: String) -> PyResult<Self> {
        Self::of(text)
    }

    /// Returns what all clips keep.
    #[staticmethod]
    fn all(clips: &Bound<'_, PyAny>) -> PyResult<Self> {
        joined("all", clips.try_iter()?)
    }

    /// Returns what at least one of the clips keeps.
    #[staticmethod]
    fn any(clips: &Bound<'_, PyAny>) -> PyResult<Self> {
        joined("any", clips.try_iter()?)
    }

    fn __and__<'py>(this: Bound<'py, Self>, other: Bound<'py, PyAny>) -> PyResult<Self> {
        joined("all", [this.into_any(), other].map(Ok))
    }

    fn __rand__<'py>(this: Bound<'py, Self>, other: Bound<'py, PyAny>) -> PyResult<Self> {
        joined("all", [other, this.into_any()].map(Ok))
    }

    fn __or__<'py>(this: Bound<'py, Self>, other: Bound<'py, PyAny>) -> PyResult<Self> {
        joined("any", [this.into_any(), other].map(Ok))
    }

    fn __ror__<'py>(this: Bound<'py, Self>, other: Bound<'py, PyAny>) -> PyResult<Self> {
        joined("any", [other, this.into_any()].map(Ok))
    }

    fn __invert__(&self) -> PyResult<Self> {
        Ok(match &self.region {
            Region::Fixed(Expression::Not(inner)) => Self::from(Expression::clone(inner)),
            // The text's shape is one that keeps the outside.
            Region::Fixed(Expression::Shape(_)) | Region::Relative(..) => {
                Self::of(format!("!{}", self.text))?
            }
            Region::Fixed(fixed) => Self {
                text: format!("!{}", self.text),
                region: Region::Fixed(Expression::Not(Box::new(fixed.clone()))),
            },
        })
    }

    /// Says of each point, [N, 3], whether the clip keeps it: bool [N]. `scene` is for lengths in percent.
    #[pyo3(signature = (points, scene=None))]
    fn keeps<'py>(
        &self,
        points: &Bound<'py, PyAny>,
        scene: Option<SceneOf>,
    ) -> PyResult<Array<'py, bool>> {
        let py = points.py();
        let clip = self.within(scene.as_ref())?.clip();
        let array = numbers::<f64>(points, "points", &[None, Some(3)])?;
        let points = array.as_slice()?.as_chunks().0;
        let keeps = |point: &[f64; 3]| clip.keeps(DVec3::from_array(*point));
        let kept: Vec<_> = py.detach(|| points.iter().map(keeps).collect());
        owned(py, kept, &[points.len()])
    }

    /// Returns the clip at a share, 0 to 1, of the way to another one of the same shapes.
    #[pyo3(signature = (other, share, scene=None))]
    fn between(&self, other: ClipOf, share: f64, scene: Option<SceneOf>) -> PyResult<Self> {
        let [from, to] = [self, &other.0].map(|clip| clip.within(scene.as_ref()));
        if !(0.0..=1.0).contains(&share) {
            return Err(invalid(format!("share is {share}; give 0 to 1")));
        }
        Ok(from?.between(&to?, share).map_err(raised)?.into())
    }

    /// Reads a clip, by its name or number, from a file that `save` or `rara --save-clip` wrote.
    #[staticmethod]
    #[pyo3(signature = (path, name=None))]
    fn load(path: PathBuf, name: Option<Bound<'_, PyAny>>) -> PyResult<Self> {
        let mut clips = load_clips(&path).map_err(raised)?;
        let found = match name {
            None => Some(0).filter(|_| clips.len() == 1),
            Some(name) => called(clips.iter().map(|clip| &clip.name[..]), &name)?,
        };
        let found = found.map(|at| clips.swap_remove(at)).ok_or_else(|| {
            let names: Vec<_> = clips.iter().map(|clip| clip.name.as_str()).collect();
            let message = format!("name one of its clips: {}", names.join(", "));
            raised(Error::format(&path, message))
        })?;
        Ok(found.clip.into())
    }

    /// Writes the clip to a JSON file for `load` and `rara --clip-file`. `scene` is for lengths in percent.
    #[pyo3(signature = (path, scene=None))]
    fn save(&self, path: PathBuf, scene: Option<SceneOf>) -> PyResult<()> {
        let json = clips_to_json(&[NamedClip {
            name: rara::scene::layers::stem(&path),
            clip: self.within(scene.as_ref())?,
            layer: None,
        }]);
        write_atomically(&path, |file| file.write_all(json.as_bytes())).map_err(raised)
    }

    fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        PyString::new(py, &self.text).hash()
    }

    fn __repr__(&self) -> String {
        format!("rara.Clip({:?})", self.text)
    }
}

impl Clip {
    /// The clip in a scene, where it needs one.
    fn within(&self, scene: Option<&SceneOf>) -> PyResult<Expression> {
        match (&self.region, scene) {
            (Region::Fixed(fixed), _) => Ok(fixed.clone()),
            (region, Some(scene)) => region.resolve(|| scene.bounds()).map_err(raised),
            (_, None) => Err(invalid(
                "scene is missing: the clip has lengths in percent of one",
            )),
        }
    }
}

/// The most levels of parentheses that clips are joined to.
const DEEP: i32 = 40;

/// The clip of several that an operator joins. What the same operator has joined is not nested, so that long chains are not deep.
fn joined<'py>(
    operator: &str,
    clips: impl IntoIterator<Item = PyResult<Bound<'py, PyAny>>>,
) -> PyResult<Clip> {
    let (mut texts, mut fixed, mut is_fixed) = (Vec::new(), Vec::new(), true);
    for clip in clips {
        let Clip { text, region } = clip?.extract::<ClipOf>()?.0;
        let inner = text.strip_prefix(operator).and_then(|text| {
            let inner = text.strip_prefix('(')?.strip_suffix(')')?;
            Some(inner).filter(|inner| !inner.trim().is_empty())
        });
        match (region, inner) {
            (Region::Fixed(Expression::All(own) | Expression::Any(own)), Some(_)) => {
                fixed.extend(own);
            }
            (Region::Fixed(own), None) => fixed.push(own),
            _ => is_fixed = false,
        }
        texts.push(inner.unwrap_or(&text).to_owned());
    }
    let text = format!("{operator}({})", texts.join(", "));
    let (mut open, mut depth) = (0, 0);
    for letter in text.chars() {
        open += i32::from(letter == '(') - i32::from(letter == ')');
        depth = depth.max(open);
    }
    // Files of meshes are not read again, as the text's would be.
    if !is_fixed || fixed.is_empty() || depth > DEEP {
        return Clip::of(text);
    }
    let region = Region::Fixed(match operator {
        "all" => Expression::All(fixed),
        _ => Expression::Any(fixed),
    });
    Ok(Clip { text, region })
}
