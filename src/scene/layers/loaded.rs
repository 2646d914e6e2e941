//! The layers of a scene that have been read.

use std::path::PathBuf;

use glam::DVec3;
use rara_base::counted::counted;
use rara_base::error::{Error, Result};

use super::select::{self, FileNumbers};
use super::{LayerClip, LayerEntry, SceneDescription, place, settled};
use crate::annotations::Annotations;
use crate::clip::Expression;
use crate::format::Format;
use crate::gaussians::Gaussians;
use crate::input::LoadOptions;
use crate::layer::{Layer, LayerState, Scene};
use crate::property::Property;
use crate::scene_file::SceneFile;
use crate::trained_folder;
use crate::training::SortBy;

/// A layer that has been read.
#[derive(Debug, Clone)]
pub struct LoadedLayer {
    /// What it is called.
    pub name: String,
    /// Its Gaussians, about its own origin.
    pub gaussians: Gaussians,
    /// Its file's format; none where it comes from no file.
    pub format: Option<Format>,
    /// How it is shown.
    pub state: LayerState,
    /// The direction that is up in its file, where that says so.
    pub up: Option<DVec3>,
    /// The factors by which its Gaussians' axes have been stretched since they were read.
    pub stretch: DVec3,
    /// What cuts it in place of the frame's clip, if anything does.
    pub clip: Option<LayerClip>,
    /// Its place in the files, where it is a part of one.
    pub numbers: Option<FileNumbers>,
    /// Its file; none where it comes from no file.
    pub file: Option<PathBuf>,
    /// The settings of its training that say that it was trained antialiased, where its file says nothing.
    pub antialiased_by: Option<PathBuf>,
    /// The state that its list gives it, before anything changes that.
    pub listed: ListedState,
}

/// What the list of a scene's layers says of one, in so far as it is often changed.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ListedState {
    /// Whether it is shown.
    pub visible: bool,
    /// The factor of its opacities, 0 to 1.
    pub opacity: f32,
    /// What cuts it in place of the frame's clip, if anything does.
    pub clip: Option<LayerClip>,
}

impl LoadedLayer {
    /// A layer that is shown as its list says, before it has any Gaussians.
    pub fn new(name: String, state: LayerState, clip: Option<LayerClip>) -> Self {
        Self {
            name,
            state,
            listed: ListedState {
                visible: state.visible,
                opacity: state.opacity,
                clip: clip.clone(),
            },
            clip,
            up: None,
            stretch: DVec3::ONE,
            gaussians: Gaussians::default(),
            format: None,
            numbers: None,
            file: None,
            antialiased_by: None,
        }
    }

    /// A layer of its Gaussians as it is shown, its own clip cut by a section.
    fn shown<'a>(&'a self, made: Layer<'a>, section: &[Expression]) -> Layer<'a> {
        let mut made = made.with(self.state);
        if let Some(clip) = &self.clip {
            made = made.clipped(clip.cut_by(section).clip());
        }
        if let Some((first, numbers)) = &self.numbers {
            made = made.numbered(*first, numbers);
        }
        made
    }
}

/// The layers of a scene, and what their files have beside them.
#[derive(Debug, Default)]
pub struct SceneLayers {
    /// In the order of their files.
    pub layers: Vec<LoadedLayer>,
    /// Gaussians that had a field put right.
    pub repaired: u64,
    /// Gaussians that could not be used.
    pub dropped: u64,
    /// The loader's reports, a line each.
    pub notes: Vec<String>,
    /// Names and the like, which the files have around their Gaussians.
    pub annotations: Annotations,
    /// What the files have of each Gaussian beside that.
    pub extra: Extra,
}

/// What files have beside what is drawn: the properties of their Gaussians that were asked for, one file's after the other's, and
/// the names of the rest.
#[derive(Debug, Default)]
pub struct Extra {
    /// The properties that all files have, of the Gaussians in their order.
    pub properties: Vec<Property>,
    /// The names of the rest.
    pub others: Vec<String>,
    files: usize,
}

impl Extra {
    /// Appends those of another file; only the properties that all files have stay.
    pub fn append(&mut self, mut properties: Vec<Property>, others: Vec<String>) {
        let first = self.files == 0;
        self.files += 1;
        let mut own = std::mem::take(&mut self.properties);
        if first {
            own = properties;
        } else {
            let taken =
                own.extract_if(.., |one| !properties.iter().any(|new| new.name == one.name));
            let left: Vec<_> = taken.map(|one| one.name).collect();
            self.others.extend(left);
            for one in &mut own {
                let at = properties.iter().position(|new| new.name == one.name);
                let new = at.map(|at| properties.swap_remove(at)).unwrap_or_default();
                one.single &= new.single;
                one.values.extend(new.values);
            }
            self.others
                .extend(properties.into_iter().map(|one| one.name));
        }
        self.properties = own;
        self.others.extend(others);
        self.others.sort_unstable();
        self.others.dedup();
    }

    /// Keeps the values of the Gaussians of these numbers, which ascend.
    pub fn keep(&mut self, numbers: &[u32]) {
        for property in &mut self.properties {
            *property = property.of(numbers);
        }
    }

    /// The warning that a file of this format does not have them, and that others are not read.
    pub fn lost(&self, format: Format) -> Option<String> {
        let is_lost = format != Format::Ply;
        let lost = self
            .properties
            .iter()
            .filter(|_| is_lost)
            .map(|one| &one.name);
        let names: Vec<_> = lost.chain(&self.others).map(String::as_str).collect();
        let keeps = match is_lost && !self.properties.is_empty() {
            true => "; a .ply keeps numbers of each Gaussian",
            false => "",
        };
        let count = counted(names.len() as u64, "property");
        (!names.is_empty()).then(|| {
            format!(
                "left out {count} of the scene that drawing does not use: {}{keeps}",
                names.join(", ")
            )
        })
    }
}

impl SceneLayers {
    /// Gaussians that come from no file.
    pub fn made_up(name: &str, gaussians: Gaussians) -> Self {
        Self {
            layers: vec![LoadedLayer {
                gaussians,
                ..LoadedLayer::new(name.to_owned(), LayerState::default(), None)
            }],
            ..Self::default()
        }
    }

    /// True when a layer has a clip of its own that keeps less than everything.
    pub fn has_clips(&self) -> bool {
        let mut own = self.layers.iter().filter_map(|layer| layer.clip.as_ref());
        own.any(|own| !own.clip().is_everything())
    }

    /// True when a layer with Gaussians is shown, or there are none.
    pub fn is_shown(&self) -> bool {
        let mut all = self
            .layers
            .iter()
            .filter(|layer| !layer.gaussians.is_empty())
            .peekable();
        all.peek().is_none() || all.any(|layer| layer.state.visible)
    }

    /// The properties that all files have, of the Gaussians of the layer of a number.
    pub fn properties_of(&self, number: usize) -> Vec<Property> {
        let (before, layer) = (&self.layers[..number], &self.layers[number]);
        let numbers: Vec<u32> = match &layer.numbers {
            Some((first, numbers)) => numbers.iter().map(|number| first + number).collect(),
            None => {
                let first: usize = before.iter().map(|layer| layer.gaussians.len()).sum();
                (first as u32..).take(layer.gaussians.len()).collect()
            }
        };
        let properties = self.extra.properties.iter();
        properties.map(|one| one.of(&numbers)).collect()
    }

    /// Two visible layers whose Gaussians were trained so differently that they cannot be [merged](Self::merged), if there are any.
    pub fn trained_otherwise(&self) -> Option<[&LoadedLayer; 2]> {
        let mut shown = self
            .layers
            .iter()
            .filter(|layer| layer.state.visible && !layer.gaussians.is_empty());
        // The order of what is one file is that of the first, and the most that a splat covers comes of the format.
        let of = |layer: &LoadedLayer| {
            let training = layer.gaussians.training();
            training.sort_by(SortBy::default()).alpha_max(1.0)
        };
        let first = shown.next()?;
        let other = shown.find(|layer| of(layer) != of(first))?;
        Some([first, other])
    }

    /// The scene of the layers.
    pub fn scene(&self) -> Scene<'_> {
        self.scene_cut_by(&[])
    }

    /// The scene of the layers, of whose own clips each is cut by a section.
    pub fn scene_cut_by(&self, section: &[Expression]) -> Scene<'_> {
        let layers = self.layers.iter();
        let shown =
            layers.map(|layer| layer.shown(Layer::new(&layer.name, &layer.gaussians), section));
        shown.collect()
    }

    /// The scene of the layers, which have no Gaussians themselves from then on: its upload frees them.
    pub fn take_scene(&mut self) -> Scene<'_> {
        let layers = self.layers.iter_mut().map(|layer| {
            let gaussians = std::mem::take(&mut layer.gaussians);
            layer.shown(Layer::owned(&layer.name, gaussians), &[])
        });
        layers.collect()
    }

    /// Adds the layers that an entry makes of its file's Gaussians, of which `first` are in the files before.
    fn add(
        &mut self,
        (entry, described): (LayerEntry, SceneDescription),
        gaussians: Gaussians,
        properties: &[Property],
        first: u32,
    ) -> Result<()> {
        let mut clips = described.clips.into_iter();
        let clip = clips.next().flatten();
        let mut layer = LoadedLayer::new(entry.name.clone(), entry.state, clip);
        if entry.selected.is_empty() {
            layer.gaussians = gaussians;
            self.layers.push(layer);
            return Ok(());
        }
        let by = (&entry, &described.predicates[..]);
        let parts = select::divide(gaussians, properties, by)?.into_iter();
        let own = std::iter::once(layer);
        let selected = entry.selected.into_iter().zip(clips);
        let selected = selected.map(|(one, clip)| LoadedLayer::new(one.name, one.state, clip));
        for (number, (mut layer, part)) in own.chain(selected).zip(parts).enumerate() {
            if number > 0 && part.numbers.is_empty() {
                self.notes.push(format!(
                    "{}: the selection '{}' takes nothing",
                    entry.path.display(),
                    layer.name
                ));
            }
            layer.gaussians = part.gaussians;
            layer.numbers = Some((first, part.numbers));
            self.layers.push(layer);
        }
        Ok(())
    }

    /// The end of the name in a text `NAME=` and more; none in a text without the sign. A name may hold it too.
    pub fn end_of_name(&self, text: &str) -> Option<usize> {
        let signs = || text.match_indices('=').map(|(at, _)| at);
        let of_a_layer = |at: &usize| self.layers.iter().any(|l| l.name == text[..*at]);
        signs().find(of_a_layer).or(signs().next())
    }

    /// All files' Gaussians as one set, where they are placed.
    pub fn merged(self) -> Gaussians {
        let mut layers = self.layers.into_iter().map(|mut layer| {
            // What single precision cannot hold there is in no picture either.
            let _ = layer.gaussians.place(&layer.state.placement);
            if layer.state.opacity != 1.0 {
                let opacities = layer.gaussians.opacities_mut().iter_mut();
                opacities.for_each(|opacity| *opacity *= layer.state.opacity);
            }
            layer.gaussians
        });
        let mut merged = layers.next().unwrap_or_default();
        layers.for_each(|more| merged.append(&more));
        merged
    }
}

/// Reads layers with what their files say of them.
///
/// # Errors
/// [`Error::Io`] and [`Error::Format`] of the first file that cannot be read, [`Error::Invalid`] for a layer that cannot be drawn as
/// its list says.
pub fn load(entries: Vec<LayerEntry>) -> Result<SceneLayers> {
    load_by(entries, false, |entry, _, options| match entry.part {
        Some(number) => crate::load_layer(&entry.path, number, options, &mut |_, _| ()),
        None => crate::load_with(&entry.path, options, &mut |_, _| ()),
    })
}

/// The same, each file read by `read`, which is told the entry, its number from 0, and what selections need of it. With
/// `is_whole`, all that the files have of each Gaussian is kept.
///
/// # Errors
/// As of [`load`], and those of `read`.
pub fn load_by(
    entries: Vec<LayerEntry>,
    is_whole: bool,
    mut read: impl FnMut(&LayerEntry, usize, LoadOptions<'_>) -> Result<(SceneFile, Vec<Property>)>,
) -> Result<SceneLayers> {
    let mut files = Vec::with_capacity(entries.len());
    for (number, entry) in entries.into_iter().enumerate() {
        let mut wanted = select::compared(&entry.selected);
        wanted.extend(is_whole.then_some("*"));
        let (mut file, properties) = read(&entry, number, LoadOptions::from(&wanted))?;
        let by = entry.stretch.unwrap_or(DVec3::ONE);
        place::stretch(&mut file.gaussians, by)
            .map_err(|error| Error::format(&entry.path, error.to_string()))?;
        files.push((entry, file, properties));
    }
    let gaussians = files
        .iter()
        .map(|(entry, file, _)| (entry, &file.gaussians));
    let described = settled(gaussians)?;
    let mut all = SceneLayers::default();
    let mut before = 0;
    for ((entry, mut file, properties), described) in files.into_iter().zip(described) {
        let path = entry.path.clone();
        let said = file.gaussians.training();
        let is_said = entry.antialiased.or(file.antialiased).is_some();
        let antialiased_by = (!is_said)
            .then(|| trained_folder::antialiased_by(&path))
            .flatten();
        let antialiased = said.antialiased || antialiased_by.is_some();
        let training = said
            .antialiased(entry.antialiased.unwrap_or(antialiased))
            .low_pass(entry.low_pass.unwrap_or(said.low_pass));
        let set = file.gaussians.set_training(training);
        set.map_err(|error| Error::Invalid(format!("the layer '{}': {error}", entry.name)))?;
        all.repaired += file.report.repaired;
        all.dropped += file.report.dropped;
        let lines = file.report.lines().into_iter();
        all.notes
            .extend(lines.map(|line| format!("{}: {line}", path.display())));
        let count = file.gaussians.len() as u32;
        let usual = || Annotations::of(&file.gaussians);
        all.annotations
            .append(file.annotations.unwrap_or_else(usual));
        let stretch = entry.stretch.unwrap_or(DVec3::ONE);
        let first = all.layers.len();
        all.add((entry, described), file.gaussians, &properties, before)?;
        let kept = if is_whole { properties } else { Vec::new() };
        all.extra.append(kept, file.others);
        for layer in &mut all.layers[first..] {
            layer.format = Some(file.format);
            layer.up = file.up;
            layer.stretch = stretch;
            layer.file = Some(path.clone());
            layer.antialiased_by.clone_from(&antialiased_by);
        }
        before = before.saturating_add(count);
    }
    Ok(all)
}
