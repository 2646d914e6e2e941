//! Scene files: JSON that lists the layers of a scene.

use std::cell::LazyCell;
use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use glam::{DQuat, DVec3};
use rara::clip::Expression;
use rara::scene::Predicate;
use rara::{Bounds, Clip, Error, Gaussians, Layer, LayerState, Result, Scene};
use serde::Deserialize;

use super::json_kind;
use super::layer_place::Place;
use super::region::Region;

/// A layer that is to be read.
#[derive(Debug, Default)]
pub(super) struct LayerEntry {
    /// What it is called; its file's name without the ending where nothing else is said.
    pub(super) name: String,
    pub(super) path: PathBuf,
    pub(super) state: LayerState,
    /// The factors by which its axes are stretched; none where they stay as they are.
    pub(super) stretch: Option<DVec3>,
    /// Whether it was trained antialiased; none where its file says that.
    pub(super) antialiased: Option<bool>,
    /// The low-pass that it was trained with; none where its file says that.
    pub(super) low_pass: Option<f32>,
    pub(super) clip: Option<LayerClip<Region>>,
    /// The layers that take their splats from it, in the order in which they do so.
    pub(super) selected: Vec<Selection>,
}

/// A layer that a selection makes of what a predicate takes of another.
#[derive(Debug, Clone)]
pub(super) struct Selection {
    /// The Gaussians that it takes from: 0 for the file's own layer, or one more than the number of an earlier selection
    /// of the file.
    pub(super) from: usize,
    pub(super) predicate: Region<Predicate>,
    pub(super) name: String,
    pub(super) state: LayerState,
    pub(super) clip: Option<LayerClip<Region>>,
}

impl Selection {
    /// A selection from what a file's own layer is left with, whose state and clip it takes.
    pub(super) fn new(name: String, predicate: Region<Predicate>, entry: &LayerEntry) -> Self {
        Self {
            from: 0,
            predicate,
            name,
            state: entry.state,
            clip: entry.clip.clone(),
        }
    }
}

/// What of the entry's layers is known once all files are read.
pub(super) struct SceneDescription {
    pub(super) clips: Vec<Option<LayerClip>>,
    /// What its selections take.
    pub(super) predicates: Vec<Predicate>,
}

/// The clip of one layer in place of the frame's, in the scene's space.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum LayerClip<R = Expression> {
    /// Nothing cuts the layer, neither the frame's clip.
    Whole,
    Region(R),
}

impl<R: FromStr<Err = Error>> LayerClip<R> {
    /// The clip by its text: an expression, or `whole`.
    pub(super) fn parse(text: &str) -> Result<Self> {
        match text.trim() {
            "whole" => Ok(Self::Whole),
            text => text.parse().map(Self::Region),
        }
    }
}

impl LayerClip<Region> {
    /// The clip in a scene, whose bounds are asked for if it lies at shares of them.
    pub(super) fn within(&self, bounds: impl FnOnce() -> Bounds) -> Result<LayerClip> {
        Ok(match self {
            Self::Whole => LayerClip::Whole,
            Self::Region(region) => LayerClip::Region(region.resolve(bounds)?),
        })
    }
}

impl LayerClip {
    pub(super) fn from_expression(clip: Expression) -> Self {
        match clip {
            Expression::All(all) if all.is_empty() => Self::Whole,
            region => Self::Region(region),
        }
    }

    pub(super) fn expression(&self) -> Expression {
        match self {
            Self::Whole => Expression::All(Vec::new()),
            Self::Region(region) => region.clone(),
        }
    }

    pub(super) fn clip(&self) -> Clip {
        match self {
            Self::Whole => Clip::default(),
            Self::Region(expression) => expression.clip(),
        }
    }

    /// The same where a section's shapes cut as well. A layer that nothing cuts stays whole.
    pub(super) fn cut_by(&self, section: &[Expression]) -> Self {
        match self {
            Self::Region(region) if !section.is_empty() && !region.clip().is_everything() => {
                let both = [region].into_iter().chain(section);
                Self::Region(Expression::All(both.cloned().collect()))
            }
            whole => whole.clone(),
        }
    }
}

impl fmt::Display for LayerClip {
    /// The text that is parsed to it.
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Whole => to.write_str("whole"),
            Self::Region(expression) => expression.fmt(to),
        }
    }
}

impl LayerEntry {
    /// The layer of a file, as it is.
    pub(super) fn from_path(path: &Path) -> Self {
        Self {
            name: stem(path),
            path: path.into(),
            ..Self::default()
        }
    }

    /// The clips of the layers that the file makes: its own, then those that are selected.
    fn clips(&self) -> impl Iterator<Item = Option<&LayerClip<Region>>> {
        let selected = self.selected.iter().map(|one| one.clip.as_ref());
        std::iter::once(self.clip.as_ref()).chain(selected)
    }

    /// True when one of the layers that the file makes has a clip of its own.
    pub(super) fn has_clip(&self) -> bool {
        self.clips().any(|clip| clip.is_some())
    }

    /// What clips and selections mean in a scene, whose bounds are asked for if one of them lies at shares of them.
    fn settled(&self, bounds: impl Fn() -> Bounds) -> Result<SceneDescription> {
        let clips = self
            .clips()
            .map(|clip| clip.map(|clip| clip.within(&bounds)).transpose());
        let predicates = self
            .selected
            .iter()
            .map(|one| one.predicate.resolve(&bounds));
        Ok(SceneDescription {
            clips: clips.collect::<Result<_>>()?,
            predicates: predicates.collect::<Result<_>>()?,
        })
    }

    /// The names of the layers that the file makes: its own, then those that are selected.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        let selected = self.selected.iter().map(|one| one.name.as_str());
        std::iter::once(self.name.as_str()).chain(selected)
    }
}

/// What is known of entries once their files are read. What lies at shares lies at those of the scene that they list.
pub(super) fn settled<'a>(
    files: impl Iterator<Item = (&'a LayerEntry, &'a Gaussians)> + Clone,
) -> Result<Vec<SceneDescription>> {
    let bounds = LazyCell::new(|| {
        let layers = files.clone();
        let layers = layers.map(|(entry, of)| Layer::new(&entry.name, of).with(entry.state));
        Bounds::of(layers.collect::<Scene<'_>>())
    });
    let settled = files.clone().map(|(entry, _)| entry.settled(|| *bounds));
    settled.collect()
}

/// The names of what describes an unpacked SOG scene.
const NAMES: [&str; 2] = ["meta.json", "lod-meta.json"];

fn stem(path: &Path) -> String {
    let is_of_folder = NAMES.iter().any(|name| path.ends_with(name));
    let named = path
        .parent()
        .filter(|folder| is_of_folder && folder.file_name().is_some());
    named
        .unwrap_or(path)
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SceneJson {
    layers: Vec<LayerRecord>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
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
pub(super) fn is_list(path: &Path) -> bool {
    /// What each of these has, and a list of layers has not.
    const OF_SCENES: [&str; 3] = ["means", "tree", "asset"];
    if path.extension().is_none_or(|ending| ending != "json") {
        return false;
    }
    if NAMES.iter().any(|name| path.ends_with(name)) {
        return false;
    }
    !json_kind::document(path)
        .is_some_and(|document| OF_SCENES.iter().any(|key| document.get(key).is_some()))
}

/// The layers of a scene file, whose paths are relative to its folder.
pub(super) fn read(path: &Path) -> Result<Vec<LayerEntry>> {
    let format = |message: String| Error::format(path, message);
    let size = std::fs::metadata(path).map_err(Error::io(path))?.len();
    if size > json_kind::MOST_BYTES {
        return Err(format(format!(
            "{} are too many for a list of layers; name its files one by one",
            super::output::counted(size, "byte")
        )));
    }
    let text = std::fs::read(path).map_err(Error::io(path))?;
    let document: SceneJson = json_kind::parsed(path, &text)?;
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
            layer.selected.push(selected);
        }
        Ok(layer)
    };
    layers.map(layer).collect()
}
