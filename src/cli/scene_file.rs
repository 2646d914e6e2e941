//! Scene files: JSON that lists the layers of a scene.

use std::path::{Path, PathBuf};

use glam::{DQuat, DVec3};
use rara::clip::Expression;
use rara::{Clip, Error, LayerState, Placement, Result};
use serde::Deserialize;

/// The longest list that is read.
const MOST_BYTES: u64 = 16 << 20;

/// A layer that is to be read.
#[derive(Debug)]
pub(super) struct LayerEntry {
    /// What it is called; its file's name without the ending where nothing else is said.
    pub(super) name: String,
    /// Its file.
    pub(super) path: PathBuf,
    pub(super) state: LayerState,
    pub(super) clip: Option<LayerClip>,
}

/// The clip of one layer in place of the frame's, in the scene's space.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum LayerClip {
    /// Nothing cuts the layer, neither the frame's clip.
    Whole,
    Region(Expression),
}

impl LayerClip {
    /// The clip by its text: an expression, or `whole`.
    pub(super) fn parse(text: &str) -> Result<Self> {
        match text.trim() {
            "whole" => Ok(Self::Whole),
            text => text.parse().map(Self::Region),
        }
    }

    /// The region that it keeps.
    pub(super) fn clip(&self) -> Clip {
        match self {
            Self::Whole => Clip::default(),
            Self::Region(expression) => expression.clip(),
        }
    }
}

impl LayerEntry {
    /// The layer of a file, as it is.
    pub(super) fn of(path: &Path) -> Self {
        Self {
            name: stem(path),
            path: path.into(),
            state: LayerState::default(),
            clip: None,
        }
    }
}

fn stem(path: &Path) -> String {
    path.file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    layers: Vec<Entry>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    name: Option<String>,
    path: PathBuf,
    position: Option<[f64; 3]>,
    /// w, x, y, z.
    rotation: Option<[f64; 4]>,
    scale: Option<f64>,
    opacity: Option<f32>,
    visible: Option<bool>,
    /// An expression as a tree.
    clip: Option<Expression>,
    /// An expression as text; `whole` keeps everything.
    clip_expr: Option<String>,
}

/// The layers of a scene file, whose paths are relative to its folder.
pub(super) fn read(path: &Path) -> Result<Vec<LayerEntry>> {
    let format = |message: String| Error::format(path, message);
    let size = std::fs::metadata(path).map_err(Error::io(path))?.len();
    if size > MOST_BYTES {
        return Err(format(format!(
            "{size} bytes are too many for a list of layers; name its files one by one"
        )));
    }
    let text = std::fs::read(path).map_err(Error::io(path))?;
    let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&text);
    let document: Document =
        serde_json::from_slice(text).map_err(|error| format(error.to_string()))?;
    if document.layers.is_empty() {
        return Err(format("it has no layer; name at least one".into()));
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    let layers = document.layers.into_iter().enumerate();
    let layer = |(number, entry): (usize, Entry)| {
        let of_entry = |error: Error| format(format!("layer {number}: {error}"));
        let [w, x, y, z] = entry.rotation.unwrap_or([1.0, 0.0, 0.0, 0.0]);
        let position = DVec3::from(entry.position.unwrap_or_default());
        let scale = entry.scale.unwrap_or(1.0);
        let placement = Placement::new(position, DQuat::from_xyzw(x, y, z, w), scale);
        let clip = match (entry.clip, entry.clip_expr) {
            (Some(_), Some(_)) => {
                return Err(format(format!(
                    "layer {number} has both \"clip\" and \"clip_expr\"; keep one"
                )));
            }
            (Some(tree), None) => Some(LayerClip::Region(tree)),
            (None, Some(text)) => Some(LayerClip::parse(&text).map_err(of_entry)?),
            (None, None) => None,
        };
        let state = LayerState::default()
            .placement(placement.map_err(of_entry)?)
            .opacity(entry.opacity.unwrap_or(1.0))
            .visible(entry.visible.unwrap_or(true));
        let path = folder.join(entry.path);
        Ok(LayerEntry {
            name: entry.name.unwrap_or_else(|| stem(&path)),
            path,
            state,
            clip,
        })
    };
    layers.map(layer).collect()
}
