//! JSON files that list the layers of a scene.

use std::path::{Path, PathBuf};

use glam::{DQuat, DVec3};
use rara_base::counted::counted;
use rara_base::error::{Error, Result};
use rara_base::json;
use serde::Deserialize;

use super::place::Place;
use super::region::Region;
use super::{LayerClip, LayerEntry, Selection, stem};
use crate::clip::Expression;
use crate::formats::SOG_DOCUMENTS;
use crate::layer::LayerState;

#[derive(Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "an object whose \"layers\" are a list"
)]
struct SceneJson {
    layers: Vec<LayerRecord>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a layer: an object with a \"path\"")]
struct LayerRecord {
    name: Option<String>,
    path: PathBuf,
    position: Option<[f64; 3]>,
    /// w, x, y, z.
    rotation: Option<[f64; 4]>,
    scale: Option<Scales>,
    opacity: Option<f32>,
    visible: Option<bool>,
    antialiased: Option<bool>,
    low_pass: Option<f32>,
    clip: Option<Expression>,
    /// An expression as text; `whole` keeps everything.
    clip_expr: Option<String>,
    #[serde(default)]
    select: Vec<SelectionRecord>,
}

#[derive(Deserialize)]
#[serde(
    untagged,
    expecting = "a scale is one number or one for each of the three axes"
)]
enum Scales {
    One(f64),
    OfAxes([f64; 3]),
}

/// A layer that is selected from another; what it does not say is as of that.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SelectionRecord {
    name: String,
    r#where: String,
    opacity: Option<f32>,
    visible: Option<bool>,
    clip: Option<Expression>,
    clip_expr: Option<String>,
}

/// The clip of a layer, as a tree or as text.
fn own_clip(tree: Option<Expression>, text: Option<String>) -> Result<Option<LayerClip<Region>>> {
    match (tree, text) {
        (Some(_), Some(_)) => Err(Error::Invalid(
            "it has both \"clip\" and \"clip_expr\"; keep one".into(),
        )),
        (Some(tree), None) => Ok(Some(LayerClip::Region(Region::Fixed(tree)))),
        (None, Some(text)) => LayerClip::parse(&text).map(Some),
        (None, None) => Ok(None),
    }
}

impl SelectionRecord {
    /// The layer that it makes of one.
    fn selection(self, layer: &LayerEntry) -> Result<Selection> {
        let mut selected = Selection::new(self.name, self.r#where.parse()?, layer);
        let state = selected.state;
        selected.state = state
            .opacity(self.opacity.unwrap_or(state.opacity))
            .visible(self.visible.unwrap_or(state.visible));
        if let Some(clip) = own_clip(self.clip, self.clip_expr)? {
            selected.clip = Some(clip);
        }
        Ok(selected)
    }
}

/// True for a file whose name ends in .json unless it is a scene itself: what describes a SOG scene, or glTF.
pub fn is_list(path: &Path) -> bool {
    /// What each of these has, and a list of layers has not.
    const OF_SCENES: [&str; 3] = ["means", "tree", "asset"];
    if path.extension().is_none_or(|ending| ending != "json") {
        return false;
    }
    if SOG_DOCUMENTS.iter().any(|name| path.ends_with(name)) {
        return false;
    }
    !json::short_document(path)
        .is_some_and(|document| OF_SCENES.iter().any(|key| document.get(key).is_some()))
}

/// The layers of a JSON file that lists them, whose paths are relative to its folder.
///
/// # Errors
/// [`Error::Io`] and [`Error::Format`], with the layer and its field.
pub fn read_list(path: &Path) -> Result<Vec<LayerEntry>> {
    let format = |message: String| Error::format(path, message);
    let size = std::fs::metadata(path).map_err(Error::io(path))?.len();
    if size > json::SHORT {
        return Err(format(format!(
            "{} are too many for a list of layers; name its files one by one",
            counted(size, "byte")
        )));
    }
    let text = std::fs::read(path).map_err(Error::io(path))?;
    let document: SceneJson = json::parse(json::bare(&text)).map_err(format)?;
    if document.layers.is_empty() {
        return Err(format("it has no layer; name at least one".into()));
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    let layers = document.layers.into_iter().enumerate();
    let layer = |(number, entry): (usize, LayerRecord)| {
        let of_entry = |error: Error| format(format!("layer {number}: {error}"));
        let [w, x, y, z] = entry.rotation.unwrap_or([1.0, 0.0, 0.0, 0.0]);
        let position = DVec3::from(entry.position.unwrap_or_default());
        let scales = match &entry.scale {
            Some(Scales::One(scale)) => std::slice::from_ref(scale),
            Some(Scales::OfAxes(scales)) => &scales[..],
            None => &[1.0],
        };
        let place = Place::new(position, DQuat::from_xyzw(x, y, z, w), scales).map_err(of_entry)?;
        let clip = own_clip(entry.clip, entry.clip_expr).map_err(of_entry)?;
        let state = LayerState::default()
            .placement(place.placement)
            .opacity(entry.opacity.unwrap_or(1.0))
            .visible(entry.visible.unwrap_or(true));
        let path = folder.join(entry.path);
        let mut layer = LayerEntry {
            name: entry.name.unwrap_or_else(|| stem(&path)),
            path,
            part: None,
            state,
            stretch: Some(place.stretch),
            antialiased: entry.antialiased,
            low_pass: entry.low_pass,
            clip,
            selected: Vec::new(),
        };
        for (at, selection) in entry.select.into_iter().enumerate() {
            let selected = selection.selection(&layer);
            let selected = selected
                .map_err(|error| format(format!("layer {number}, selection {at}: {error}")))?;
            selected.state.check(&selected.name).map_err(of_entry)?;
            layer.selected.push(selected);
        }
        layer.state.check(&layer.name).map_err(of_entry)?;
        Ok(layer)
    };
    layers.map(layer).collect()
}
