//! The layers of a scene by their files: single files, folders, and JSON files that list layers, with what each says of where a
//! layer stands, what is selected from it and what cuts it.
//!
//! ```no_run
//! use rara_scene::layers::{SelectionRequest, entries, load};
//!
//! let mut entries = entries("scene.json".as_ref())?;
//! let vessels: SelectionRequest = "brain/vessels=label in 3,4".parse()?;
//! assert!(vessels.add_to(&mut entries), "a layer is called brain");
//! let loaded = load(entries)?;
//! let scene = loaded.scene();
//! # Ok::<(), rara_scene::Error>(())
//! ```

mod list;
mod loaded;
mod place;
mod region;
mod select;
mod tint;

use std::cell::LazyCell;
use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use glam::DVec3;
use rara_base::error::{Error, Result};

use crate::bounds::Bounds;
use crate::clip::{Clip, Expression};
use crate::formats::{FileLayer, SOG_DOCUMENTS, file_layers};
use crate::gaussians::Gaussians;
use crate::layer::{Layer, LayerState, Scene};
use crate::predicate::Predicate;
use crate::trained_folder;

pub use crate::parts::without;
pub use list::{is_list, read_list};
pub use loaded::{Extra, ListedState, LoadedLayer, SceneLayers, load, load_by};
pub use place::{Place, stretch};
pub use region::Region;
pub use select::{FileNumbers, LayerRemains, SelectionRequest, compared, joined};
pub use tint::Tint;

/// A layer that is to be read.
#[derive(Debug, Clone, Default)]
pub struct LayerEntry {
    /// What it is called; its file's name without the ending where nothing else is said.
    pub name: String,
    /// Its file.
    pub path: PathBuf,
    /// Its number among the layers of its file, where that lists several.
    pub part: Option<usize>,
    /// How it is shown.
    pub state: LayerState,
    /// The factors by which its axes are stretched; none where they stay as they are.
    pub stretch: Option<DVec3>,
    /// Whether it was trained antialiased; none where its file says that.
    pub antialiased: Option<bool>,
    /// The low-pass that it was trained with; none where its file says that.
    pub low_pass: Option<f32>,
    /// What cuts it in place of the frame's clip, if anything does.
    pub clip: Option<LayerClip<Region>>,
    /// The layers that take their splats from it, in the order in which they do so.
    pub selected: Vec<Selection>,
}

/// A layer that a selection makes of what a predicate takes of another.
#[derive(Debug, Clone)]
pub struct Selection {
    /// The Gaussians that it takes from: 0 for the file's own layer, or one more than the number of an earlier selection
    /// of the file.
    pub from: usize,
    /// What it takes.
    pub predicate: Region<Predicate>,
    /// The name of the layer that it makes.
    pub name: String,
    /// How that is shown.
    pub state: LayerState,
    /// What cuts it in place of the frame's clip, if anything does.
    pub clip: Option<LayerClip<Region>>,
}

impl Selection {
    /// A selection from what a file's own layer is left with, whose state and clip it takes.
    pub fn new(name: String, predicate: Region<Predicate>, entry: &LayerEntry) -> Self {
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
struct SceneDescription {
    clips: Vec<Option<LayerClip>>,
    /// What its selections take.
    predicates: Vec<Predicate>,
}

/// The clip of one layer in place of the frame's, in the scene's space.
#[derive(Debug, Clone, PartialEq)]
pub enum LayerClip<R = Expression> {
    /// Nothing cuts the layer, neither the frame's clip.
    Whole,
    /// This cuts it.
    Region(R),
}

impl<R: FromStr<Err = Error>> LayerClip<R> {
    /// The clip by its text: an expression, or `whole`.
    ///
    /// # Errors
    /// [`Error::Invalid`] for other text.
    pub fn parse(text: &str) -> Result<Self> {
        match text.trim() {
            "whole" => Ok(Self::Whole),
            text => text.parse().map(Self::Region),
        }
    }
}

impl LayerClip<Region> {
    /// The clip in a scene, whose bounds are asked for if it lies at shares of them.
    ///
    /// # Errors
    /// [`Error::Invalid`] if it is not possible within these bounds.
    pub fn within(&self, bounds: impl FnOnce() -> Bounds) -> Result<LayerClip> {
        Ok(match self {
            Self::Whole => LayerClip::Whole,
            Self::Region(region) => LayerClip::Region(region.resolve(bounds)?),
        })
    }
}

impl LayerClip {
    /// The clip that an expression is; one of nothing is whole.
    pub fn from_expression(clip: Expression) -> Self {
        match clip {
            Expression::All(all) if all.is_empty() => Self::Whole,
            region => Self::Region(region),
        }
    }

    /// The expression that it is.
    pub fn expression(&self) -> Expression {
        match self {
            Self::Whole => Expression::All(Vec::new()),
            Self::Region(region) => region.clone(),
        }
    }

    /// The clip of a [`Layer`].
    pub fn clip(&self) -> Clip {
        match self {
            Self::Whole => Clip::default(),
            Self::Region(expression) => expression.clip(),
        }
    }

    /// The same where a section's shapes cut as well. A layer that nothing cuts stays whole.
    pub fn cut_by(&self, section: &[Expression]) -> Self {
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
    pub fn from_path(path: &Path) -> Self {
        Self {
            name: stem(path),
            path: path.into(),
            ..Self::default()
        }
    }

    /// A layer of those that a file lists.
    pub fn of_file(path: &Path, (part, layer): (usize, FileLayer)) -> Self {
        Self {
            name: layer.name,
            path: path.into(),
            part: Some(part),
            state: layer.state,
            stretch: Some(layer.stretch),
            ..Self::default()
        }
    }

    /// The clips of the layers that the file makes: its own, then those that are selected.
    fn clips(&self) -> impl Iterator<Item = Option<&LayerClip<Region>>> {
        let selected = self.selected.iter().map(|one| one.clip.as_ref());
        std::iter::once(self.clip.as_ref()).chain(selected)
    }

    /// True when one of the layers that the file makes has a clip of its own.
    pub fn has_clip(&self) -> bool {
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
    pub fn names(&self) -> impl Iterator<Item = &str> {
        let selected = self.selected.iter().map(|one| one.name.as_str());
        std::iter::once(self.name.as_str()).chain(selected)
    }
}

/// What is known of entries once their files are read. What lies at shares lies at those of the scene that they list.
fn settled<'a>(
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

/// The layers of a file, a folder that training left, a project of several layers, or a list of layers. None is read yet.
///
/// # Errors
/// [`Error::Io`] and [`Error::Format`] if the file is not there or lists no layers that can be read.
pub fn entries(path: &Path) -> Result<Vec<LayerEntry>> {
    if is_list(path) {
        return read_list(path);
    }
    let mut entry = LayerEntry::from_path(path);
    if let Some(trained) = trained_folder::scene_in(path)? {
        entry.path = trained;
    }
    let layers = file_layers(&entry.path)?;
    let listed = layers.into_iter().enumerate();
    let listed: Vec<_> = listed
        .map(|layer| LayerEntry::of_file(&entry.path, layer))
        .collect();
    Ok(match listed.is_empty() {
        true => vec![entry],
        false => listed,
    })
}

/// The name of what is in a file: that of the file without its ending, or of its folder.
pub fn stem(path: &Path) -> String {
    let is_of_folder = SOG_DOCUMENTS.iter().any(|name| path.ends_with(name));
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
