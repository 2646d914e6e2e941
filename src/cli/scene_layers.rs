//! The layers of a scene that have been read.

use glam::DVec3;
use rara::clip::Expression;
use rara::scene::{Annotations, Format, Property};
use rara::{Gaussians, Layer, LayerState};

use super::failure::Failure;
use super::scene_file::{LayerClip, LayerEntry, SceneDescription};
use super::select;

/// A layer that has been read.
pub(super) struct LoadedLayer {
    pub(super) name: String,
    pub(super) gaussians: Gaussians,
    /// Its file's format; none where it comes from no file.
    pub(super) format: Option<Format>,
    pub(super) state: LayerState,
    /// The factors by which its Gaussians' axes have been stretched since they were read.
    pub(super) stretch: DVec3,
    pub(super) clip: Option<LayerClip>,
    /// Its place in the files, where it is a part of one.
    pub(super) numbers: Option<select::Numbers>,
    /// The sentence to say where it is antialiased because its training's settings say so, and its file says nothing.
    pub(super) trained: Option<String>,
    /// The state that its list gives it, before any flag changes that.
    #[cfg_attr(not(feature = "view"), allow(dead_code))]
    pub(super) listed: ListedState,
}

/// What the list of a scene's layers says of one, in so far as flags may say otherwise.
#[derive(Debug, Clone, Default, PartialEq)]
#[cfg_attr(not(feature = "view"), allow(dead_code))]
pub(super) struct ListedState {
    pub(super) visible: bool,
    pub(super) clip: Option<LayerClip>,
}

impl LoadedLayer {
    /// A layer that is shown as its list says, before it has any Gaussians.
    pub(super) fn new(name: String, state: LayerState, clip: Option<LayerClip>) -> Self {
        Self {
            name,
            state,
            listed: ListedState {
                visible: state.visible,
                clip: clip.clone(),
            },
            clip,
            stretch: DVec3::ONE,
            gaussians: Gaussians::default(),
            format: None,
            numbers: None,
            trained: None,
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

#[derive(Default)]
pub(super) struct SceneLayers {
    pub(super) layers: Vec<LoadedLayer>,
    /// Gaussians that had a field put right.
    pub(super) repaired: u64,
    /// Gaussians that could not be used.
    pub(super) dropped: u64,
    /// The loader's reports, a line each.
    pub(super) notes: Vec<String>,
    /// Names and the like, which the files have around their Gaussians.
    pub(super) annotations: Annotations,
}

impl SceneLayers {
    /// Gaussians that come from no file.
    pub(super) fn made_up(name: &str, gaussians: Gaussians) -> Self {
        Self {
            layers: vec![LoadedLayer {
                gaussians,
                ..LoadedLayer::new(name.to_owned(), LayerState::default(), None)
            }],
            ..Self::default()
        }
    }

    /// True when a layer has a clip of its own that keeps less than everything.
    pub(super) fn has_clips(&self) -> bool {
        let mut own = self.layers.iter().filter_map(|layer| layer.clip.as_ref());
        own.any(|own| !own.clip().is_everything())
    }

    pub(super) fn scene(&self) -> rara::Scene<'_> {
        self.scene_cut_by(&[])
    }

    /// The scene of the layers, of whose own clips each is cut by a section.
    pub(super) fn scene_cut_by(&self, section: &[Expression]) -> rara::Scene<'_> {
        let layers = self.layers.iter();
        let shown =
            layers.map(|layer| layer.shown(Layer::new(&layer.name, &layer.gaussians), section));
        shown.collect()
    }

    /// The scene of the layers, which have no Gaussians themselves from then on: its upload frees them.
    pub(super) fn take_scene(&mut self) -> rara::Scene<'_> {
        let layers = self.layers.iter_mut().map(|layer| {
            let gaussians = std::mem::take(&mut layer.gaussians);
            layer.shown(Layer::owned(&layer.name, gaussians), &[])
        });
        layers.collect()
    }

    /// Adds the layers that an entry makes of its file's Gaussians, of which `first` are in the files before.
    pub(super) fn add(
        &mut self,
        (entry, settled): (LayerEntry, SceneDescription),
        gaussians: Gaussians,
        properties: &[Property],
        first: u32,
    ) -> rara::Result<()> {
        let mut clips = settled.clips.into_iter();
        let clip = clips.next().flatten();
        let mut layer = LoadedLayer::new(entry.name.clone(), entry.state, clip);
        if entry.selected.is_empty() {
            layer.gaussians = gaussians;
            self.layers.push(layer);
            return Ok(());
        }
        let by = (&entry, &settled.predicates[..]);
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

    /// The end of the name in the text of a flag, `NAME=` and more; none in a text without the sign. A name may hold it too.
    pub(super) fn end_of_name(&self, text: &str) -> Option<usize> {
        let signs = || text.match_indices('=').map(|(at, _)| at);
        let of_a_layer = |at: &usize| self.layers.iter().any(|l| l.name == text[..*at]);
        signs().find(of_a_layer).or(signs().next())
    }

    /// The layers of a name, which `flag` asks for.
    pub(super) fn named(
        &mut self,
        flag: &str,
        name: &str,
    ) -> Result<Vec<&mut LoadedLayer>, Failure> {
        let names: Vec<_> = self.layers.iter().map(|layer| layer.name.clone()).collect();
        let found: Vec<_> = self
            .layers
            .iter_mut()
            .filter(|layer| layer.name == name)
            .collect();
        match found.is_empty() {
            true => Err(select::no_layer(
                flag,
                name,
                names.iter().map(String::as_str),
            )),
            false => Ok(found),
        }
    }

    /// All files' Gaussians as one set, where they are placed.
    pub(super) fn merged(self) -> Gaussians {
        let mut layers = self.layers.into_iter().map(|mut layer| {
            // What single precision cannot hold there is in no picture either.
            let _ = layer.gaussians.place(&layer.state.placement);
            layer.gaussians
        });
        let mut merged = layers.next().unwrap_or_default();
        layers.for_each(|more| merged.append(&more));
        merged
    }
}
