//! Scenes: layers of Gaussians, from files and from Python.

use std::cell::LazyCell;
use std::mem::take;
use std::path::PathBuf;
use std::sync::Arc;

use glam::{DQuat, DVec3};
use pyo3::prelude::*;
use rara::clip::Expression;
use rara::scene::layers::{
    LayerClip, LoadedLayer, Region, SceneLayers, SelectionRequest, entries, load_by,
};
use rara::scene::{Bounds, load_layer, load_with, trained_folder};
use rara::{BakeCounts, BakeSettings, Clip, Error, LayerState, Result, Scene};

use crate::clip::{ClipOf, own_clip, placement};
use crate::errors::{choice, invalid, of_argument, plain, raised};
use crate::gaussians::{Gaussians, Report, Set};

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
}

/// A layer that no Python object can change.
#[derive(Clone)]
pub(crate) struct Layer {
    name: String,
    set: Arc<Set>,
    state: LayerState,
    clip: Option<LayerClip<Region>>,
}

impl Layer {
    fn of(given: &LayerFields<'_>) -> PyResult<Self> {
        let placement = placement(given.position, given.rotation, given.scale);
        let placement = placement.map_err(of_argument(&given.name))?;
        let state = LayerState::default().placement(placement);
        let state = state.opacity(given.opacity).visible(given.visible);
        state.check(&given.name).map_err(raised)?;
        Ok(Self {
            name: given.name.clone(),
            set: given.gaussians.get().0.clone(),
            state,
            clip: given.clip.as_ref().map(own_clip).transpose()?,
        })
    }

    fn placed(&self) -> rara::Layer<'_> {
        rara::Layer::new(&self.name, &self.set.gaussians).with(self.state)
    }

    /// True for a layer of the same Gaussians.
    pub(crate) fn is_of(&self, other: &Self) -> bool {
        self.name == other.name && Arc::ptr_eq(&self.set, &other.set)
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
            let layer = Layer {
                name: "scene".into(),
                set: gaussians.get().0.clone(),
                state: LayerState::default(),
                clip: None,
            };
            return Ok(Self {
                layers: vec![layer],
                up: None,
            });
        }
        let (layers, up) = match given.getattr_opt("layers")? {
            Some(layers) => (layers.extract()?, given.getattr("up")?.extract()?),
            None if given.hasattr("gaussians")? => (vec![given.extract()?], None),
            None => {
                let kind = given.get_type();
                let message =
                    format!("scene is a {kind}; give a rara.Scene, rara.Layer or rara.Gaussians");
                return Err(invalid(message));
            }
        };
        let layers: Vec<LayerFields<'_>> = layers;
        Ok(Self {
            layers: layers.iter().map(Layer::of).collect::<PyResult<_>>()?,
            up: up.map(|up: [f64; 3]| up.into()),
        })
    }
}

impl SceneOf {
    pub(crate) fn bounds(&self) -> Bounds {
        let placed = self.layers.iter().map(Layer::placed);
        Bounds::of(placed.collect::<Scene<'_>>())
    }

    /// The scene, in which a section also cuts layers that have clips of their own.
    pub(crate) fn scene(&self, section: &[Expression]) -> Result<Scene<'_>> {
        let bounds = LazyCell::new(|| self.bounds());
        let layers = self.layers.iter().map(|layer| {
            let mut made = layer.placed();
            if let Some(clip) = &layer.clip {
                made = made.clipped(clip.within(|| *bounds)?.cut_by(section).clip());
            }
            if let Some((first, numbers)) = &layer.set.numbers {
                made = made.numbered(*first, numbers);
            }
            Ok(made)
        });
        layers.collect()
    }
}

/// Two corners of the box of a scene.
#[pyfunction]
pub(crate) fn bounds(py: Python<'_>, scene: SceneOf) -> [[f64; 3]; 2] {
    let bounds = py.detach(|| scene.bounds());
    [bounds.min.into(), bounds.max.into()]
}

/// A layer that was read: the fields of `rara.Layer` in their order.
type ReadLayer = (
    String,
    Gaussians,
    [f64; 3],
    [f64; 4],
    f64,
    f32,
    bool,
    Option<String>,
);

/// Reads the layers of files, the direction that is up in them, and a report.
#[pyfunction]
pub(crate) fn load(
    py: Python<'_>,
    paths: Vec<PathBuf>,
    select: Vec<String>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Vec<ReadLayer>, Option<[f64; 3]>, Report)> {
    let parsed = select.iter().map(|text| choice("select", text));
    let select = parsed.collect::<PyResult<Vec<SelectionRequest>>>()?;
    let mut told = Ok(());
    let read = py.detach(|| {
        let listed = paths.iter().map(|path| entries(path));
        let mut listed = listed.collect::<Result<Vec<_>>>()?.concat();
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
    let (mut loaded, up) = read.map_err(raised)?;
    // Those of several layers are not known by layer.
    let mut annotations = Some(take(&mut loaded.annotations)).filter(|_| loaded.layers.len() == 1);
    let properties = (0..loaded.layers.len()).map(|number| loaded.properties_of(number));
    let properties: Vec<_> = properties.collect();
    let layers = loaded.layers.into_iter().zip(properties);
    let layers = layers.map(|(layer, properties)| {
        let set = Set {
            properties,
            gaussians: layer.gaussians,
            annotations: annotations.take(),
            report: Report::default(),
            numbers: layer.numbers,
        };
        let placed = layer.state.placement;
        let DQuat { x, y, z, w } = placed.rotation();
        let (position, turn) = (placed.position().into(), [w, x, y, z]);
        let LayerState {
            opacity, visible, ..
        } = layer.state;
        let clip = layer.clip.map(|clip| clip.to_string());
        (
            layer.name,
            set.into(),
            position,
            turn,
            placed.scale(),
            opacity,
            visible,
            clip,
        )
    });
    let layers: Vec<_> = layers.collect();
    let report = Report {
        dropped: loaded.dropped,
        repaired: loaded.repaired,
        notes: loaded.notes,
    };
    Ok((layers, up.map(Into::into), report))
}

/// Makes one set of the layers that are visible, where they are placed, and as faded.
#[pyfunction]
pub(crate) fn merged(py: Python<'_>, scene: SceneOf) -> PyResult<Gaussians> {
    let mut all = SceneLayers::default();
    for layer in scene.layers.iter().filter(|layer| layer.state.visible) {
        if let Some(LayerClip::Region(_)) = layer.clip {
            let name = &layer.name;
            let message =
                format!("layer '{name}' has a clip of its own; bake it by rara.bake(scene)");
            return Err(invalid(message));
        }
        let mut loaded = LoadedLayer::new(layer.name.clone(), layer.state, None);
        loaded.gaussians = layer.set.gaussians.clone();
        all.layers.push(loaded);
        let properties = layer.set.properties.clone();
        all.extra.append(properties, Vec::new());
    }
    if let Some([a, b]) = all.trained_otherwise() {
        let (a, b) = (&a.name, &b.name);
        let message = format!(
            "the layers '{a}' and '{b}' were trained differently, as `training` says; save each by itself"
        );
        return Err(invalid(message));
    }
    let properties = take(&mut all.extra.properties);
    Ok(Gaussians::from(Set {
        gaussians: py.detach(|| all.merged()),
        properties,
        ..Set::default()
    }))
}

/// Bakes a clip, or the layers' own, into each layer: the Gaussians of each, and counts of what was done.
#[pyfunction]
pub(crate) fn bake(
    py: Python<'_>,
    scene: SceneOf,
    clip: Option<ClipOf>,
    mode: &str,
    settings: (f32, u32, f32), // sigma, children, leave
) -> PyResult<(Vec<Gaussians>, Py<PyAny>)> {
    let (sigma, children, leave) = settings;
    let settings = BakeSettings::default().mode(choice("mode", mode)?);
    let settings = settings.sigma(sigma).children(children).leave(leave);
    let baked = py.detach(|| {
        let clip = clip.map(|ClipOf(clip)| clip.region.resolve(|| scene.bounds()));
        let clip = clip
            .transpose()?
            .map_or_else(Clip::default, |clip| clip.clip());
        let made = scene.scene(&[])?;
        let layers = made.layers().iter();
        let baked = layers.map(|layer| rara::bake_layer(layer, &clip, &settings));
        baked.collect::<Result<Vec<_>>>()
    });
    let mut counts = BakeCounts::default();
    let baked = baked.map_err(raised)?.into_iter().zip(&scene.layers);
    let baked = baked.map(|(baked, layer)| {
        counts += baked.counts;
        layer.set.derived(baked.gaussians, &baked.sources)
    });
    Ok((baked.collect(), plain(py, &counts)?))
}
