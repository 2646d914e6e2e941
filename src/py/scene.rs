//! Scenes: layers of Gaussians, reading them, and clips within them.

use std::cell::LazyCell;
use std::path::PathBuf;
use std::sync::Arc;

use glam::{DQuat, DVec3};
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use rara::clip::{Expression, NamedClip, clips_to_json};
use rara::scene::layers::{FileNumbers, LayerClip, Region, SelectionRequest, entries, load_by};
use rara::scene::{Bounds, Property, load_layer, load_with, trained_folder};
use rara::{Error, LayerState, Placement, Result, Scene};
use rara_base::files::write_atomically;

use crate::arrays::{numbers, owned};
use crate::clip::ClipOf;
use crate::errors::{invalid, of_argument, raised};
use crate::gaussians::{Gaussians, Report, Set};

/// The place of a layer's Gaussians among those of its file, if it is a part of them.
#[pyclass(frozen)]
pub(crate) struct Numbers(Arc<FileNumbers>);

/// A layer as `rara.Layer` has it.
#[derive(FromPyObject)]
struct LayerFields<'py> {
    name: String,
    gaussians: Bound<'py, Gaussians>,
    position: [f64; 3],
    rotation: [f64; 4],
    scale: f64,
    opacity: f32,
    visible: bool,
    clip: Option<Bound<'py, PyAny>>,
    numbers: Option<Bound<'py, Numbers>>,
}

/// A layer that no Python object can change.
#[derive(Clone)]
pub(crate) struct Layer {
    name: String,
    set: Arc<Set>,
    state: LayerState,
    clip: Option<LayerClip<Region>>,
    numbers: Option<Arc<FileNumbers>>,
}

impl Layer {
    fn of(given: &LayerFields<'_>) -> PyResult<Self> {
        let [w, x, y, z] = given.rotation;
        let rotation = DQuat::from_xyzw(x, y, z, w);
        let named = of_argument(&given.name);
        let placement =
            Placement::new(given.position.into(), rotation, given.scale).map_err(named)?;
        let state = LayerState::default().placement(placement);
        let state = state.opacity(given.opacity).visible(given.visible);
        state.check(&given.name).map_err(raised)?;
        let clip = given.clip.as_ref().map(|clip| {
            let text = clip.str()?.to_string();
            LayerClip::parse(&text).map_err(of_argument("clip"))
        });
        Ok(Self {
            name: given.name.clone(),
            set: given.gaussians.get().0.clone(),
            state,
            clip: clip.transpose()?,
            numbers: given
                .numbers
                .as_ref()
                .map(|numbers| numbers.get().0.clone()),
        })
    }

    /// True for a layer of the same Gaussians in the same order.
    pub(crate) fn is_of(&self, other: &Self) -> bool {
        self.name == other.name
            && Arc::ptr_eq(&self.set, &other.set)
            && self.numbers == other.numbers
    }
}

/// A scene as an argument: a `rara.Scene`, a `rara.Layer`, or `Gaussians`.
#[derive(Clone)]
pub(crate) struct SceneOf {
    pub(crate) layers: Vec<Layer>,
    pub(crate) up: Option<DVec3>,
}

impl<'py> FromPyObject<'_, 'py> for SceneOf {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(gaussians) = given.cast::<Gaussians>() {
            let (name, set) = ("scene".into(), gaussians.get().0.clone());
            let (state, clip, numbers) = (LayerState::default(), None, None);
            let layers = vec![Layer {
                name,
                set,
                state,
                clip,
                numbers,
            }];
            return Ok(Self { layers, up: None });
        }
        let (layers, up) = match given.getattr_opt("layers")? {
            Some(layers) => (
                layers.extract()?,
                given.getattr("up")?.extract::<Option<[f64; 3]>>()?,
            ),
            None if given.hasattr("gaussians")? => {
                (vec![given.extract::<LayerFields<'_>>()?], None)
            }
            None => {
                let kind = given.get_type();
                let message =
                    format!("scene is a {kind}; give a rara.Scene, rara.Layer or rara.Gaussians");
                return Err(invalid(message));
            }
        };
        let layers = layers.iter().map(Layer::of).collect::<PyResult<_>>()?;
        Ok(Self {
            layers,
            up: up.map(DVec3::from),
        })
    }
}

impl SceneOf {
    /// The scene, in which a section also cuts layers that have clips of their own.
    pub(crate) fn scene(&self, section: &[Expression]) -> Result<Scene<'_>> {
        let placed = self.layers.iter().map(Layer::placed);
        let bounds = LazyCell::new(|| Bounds::of(placed.clone().collect::<Scene<'_>>()));
        let layers = self.layers.iter().map(|layer| {
            let mut made = layer.placed();
            if let Some(clip) = &layer.clip {
                made = made.clipped(clip.within(|| *bounds)?.cut_by(section).clip());
            }
            if let Some(numbers) = &layer.numbers {
                made = made.numbered(numbers.0, &numbers.1);
            }
            Ok(made)
        });
        layers.collect()
    }
}

impl Layer {
    fn placed(&self) -> rara::Layer<'_> {
        rara::Layer::new(&self.name, &self.set.gaussians).with(self.state)
    }
}

/// Two corners of the box of a scene.
#[pyfunction]
pub(crate) fn bounds(py: Python<'_>, scene: SceneOf) -> PyResult<[[f64; 3]; 2]> {
    let bounds = py
        .detach(|| scene.scene(&[]).map(Bounds::of))
        .map_err(raised)?;
    Ok([bounds.min.into(), bounds.max.into()])
}

/// A layer that was read: the fields of `rara.Layer` in their order.
type ReadLayer = (
    (String, Gaussians),
    ([f64; 3], [f64; 4], f64),
    (f32, bool, Option<String>, Option<Numbers>),
);

/// Reads the layers of files, the direction that is up in them, and a report.
#[pyfunction]
pub(crate) fn load(
    py: Python<'_>,
    paths: Vec<PathBuf>,
    select: Vec<String>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Vec<ReadLayer>, Option<[f64; 3]>, Report)> {
    let parse = |text: &String| text.parse::<SelectionRequest>();
    let select = select
        .iter()
        .map(|text| parse(text).map_err(of_argument("select")));
    let select = select.collect::<PyResult<Vec<_>>>()?;
    let mut told = Ok(());
    let read = py.detach(|| {
        let listed = paths
            .iter()
            .map(|path| entries(path))
            .collect::<Result<Vec<_>>>()?;
        let mut listed = listed.concat();
        for request in &select {
            if !request.add_to(&mut listed) {
                let name = request.layer.as_deref().unwrap_or_default();
                let message = format!("select: there is no layer '{name}' to take Gaussians from");
                return Err(Error::Invalid(message));
            }
        }
        let loaded = load_by(listed, true, |entry, _, options| {
            let mut tell = |done: u64, total: u64| {
                if let (Some(progress), Ok(())) = (&progress, &told) {
                    told = Python::attach(|py| progress.call1(py, (done, total)).map(drop));
                }
            };
            match entry.part {
                Some(number) => load_layer(&entry.path, number, options, &mut tell),
                None => load_with(&entry.path, options, &mut tell),
            }
        })?;
        let common = || trained_folder::up_of_cameras(&paths).map(|common| common.direction);
        Ok((loaded, trained_folder::stated_up(&paths).or_else(common)))
    });
    told?;
    let (loaded, up) = read.map_err(raised)?;
    let (dropped, repaired, notes) = (loaded.dropped, loaded.repaired, loaded.notes);
    let mut before = 0;
    let one = loaded.layers.len() == 1;
    let annotations = Some(loaded.annotations).filter(|_| one);
    let layers = loaded.layers.into_iter().map(|layer| {
        let end = before + layer.gaussians.len();
        let values = |one: &Property| match &layer.numbers {
            None => one.values[before..end].to_vec(),
            Some((first, numbers)) => {
                let all = numbers
                    .iter()
                    .map(|number| one.values[(first + number) as usize]);
                all.collect()
            }
        };
        let properties = loaded.extra.properties.iter();
        let properties = properties.map(|one| Property::new(&one.name, values(one)));
        let set = Set {
            properties: properties.collect(),
            gaussians: layer.gaussians,
            annotations: annotations.clone(),
            report: Report::default(),
        };
        before = end;
        let LayerState {
            placement,
            opacity,
            visible,
            ..
        } = layer.state;
        let DQuat { x, y, z, w } = placement.rotation();
        let clip = layer.clip.map(|clip| clip.to_string());
        let numbers = layer.numbers.map(|numbers| Numbers(Arc::new(numbers)));
        (
            (layer.name, Gaussians(Arc::new(set))),
            (placement.position().into(), [w, x, y, z], placement.scale()),
            (opacity, visible, clip, numbers),
        )
    });
    let report = Report {
        dropped,
        repaired,
        notes,
    };
    Ok((layers.collect(), up.map(Into::into), report))
}

/// The expression of a clip that may need a scene.
fn settled(clip: &ClipOf, scene: Option<&SceneOf>) -> PyResult<Expression> {
    match (&clip.0, scene) {
        (Region::Fixed(fixed), _) => Ok(fixed.clone()),
        (_, Some(scene)) => clip
            .expression(&scene.scene(&[]).map_err(raised)?)
            .map_err(raised),
        (_, None) => Err(invalid(
            "scene is missing: the clip has lengths in percent of one",
        )),
    }
}

/// Says of each point whether a clip keeps it.
#[pyfunction]
pub(crate) fn clip_keeps<'py>(
    clip: ClipOf,
    points: &Bound<'py, PyAny>,
    scene: Option<SceneOf>,
) -> PyResult<Bound<'py, PyArrayDyn<bool>>> {
    let clip = settled(&clip, scene.as_ref())?.clip();
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
    let (from, to) = (
        settled(&from, scene.as_ref())?,
        settled(&to, scene.as_ref())?,
    );
    Ok(from.between(&to, share).map_err(raised)?.to_string())
}

/// Writes a clip to a JSON file.
#[pyfunction]
pub(crate) fn save_clip(clip: ClipOf, path: PathBuf, scene: Option<SceneOf>) -> PyResult<()> {
    let name = path
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into();
    let clip = settled(&clip, scene.as_ref())?;
    let json = clips_to_json(&[NamedClip {
        name,
        clip,
        layer: None,
    }]);
    write_atomically(&path, |file| file.write_all(json.as_bytes())).map_err(raised)
}
