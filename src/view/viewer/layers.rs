//! The layers of the scene, their clips, and the clip that is edited: the frame's, or a layer's own.

use std::mem::{Discriminant, discriminant};
use std::time::{Duration, Instant};

use glam::DVec3;
use rara::{Camera, Clip, ClipOp, Layer, LayerState, Scene};

use super::action::{Edit, GripAction, Step, Which};
use super::cut::ClipEditor;
use super::failure::Failure;
use crate::Windowed;
use rara::clip::{Expression, Lasso};
use rara::scene::layers::{LayerClip, ListedState, LoadedLayer, SceneLayers, Tint};
use rara_shots::{Face, faces};

/// The frame's clip and the layers.
#[derive(Debug, Clone)]
pub struct Clips {
    /// The clip of the frame, for all layers that have none of their own.
    pub frame: ClipEditor,
    /// The layers by name: those of one name that begin alike go together, as flags name them.
    layers: Vec<NamedLayer>,
    /// The number of the layer whose own clip is edited; `None` for the frame's.
    edited: Option<usize>,
    centre: DVec3,
    /// True when the window's scene is not yet as these say.
    changed: bool,
    /// What the clips were before each change, the last one at the end.
    past: Vec<Past>,
}

/// The clips before a change.
#[derive(Debug, Clone)]
struct Past {
    frame: ClipEditor,
    /// The layers' own.
    own: Vec<Option<ClipEditor>>,
    /// The kind of what has changed them, if more of it belongs to it, and when it did so last.
    by: (Option<Discriminant<GripAction>>, Instant),
}

/// The state of each layer of a scene, and its own clip.
pub(super) type ShownLayers = Vec<(LayerState, Option<Clip>)>;

/// The faces of a clip, and how the scene's layers are shown on them.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CutFaces {
    pub(super) faces: Vec<Face>,
    pub(super) layers: ShownLayers,
}

/// Changes that can be undone.
const MOST_UNDONE: usize = 200;
/// What follows a change of the same kind this soon belongs to it, as the steps of a drag do.
const AT_ONCE: Duration = Duration::from_millis(700);

/// The shares of its opacity that a key gives a layer.
const OPACITIES: [f32; 4] = [1.0, 0.5, 0.25, 0.1];
/// The colours that a key mixes into a layer.
const TINTS: [&str; 5] = ["red", "gold", "limegreen", "deepskyblue", "orchid"];

/// The layers of a name that begin alike.
#[derive(Debug, Clone)]
pub struct NamedLayer {
    /// Their name.
    pub name: String,
    /// Their numbers in the scene.
    places: Vec<usize>,
    /// True when they are shown.
    pub visible: bool,
    /// The factor of their opacities, 0 to 1.
    pub opacity: f32,
    /// The colour that the window has mixed into them; `None` where they are as they were read.
    pub tint: Option<Tint>,
    /// Their own clip; one that is off leaves them whole. `None` where the frame's holds.
    own: Option<ClipEditor>,
    /// What is listed of each of them, with clips as they can be edited.
    pub listed: Vec<ListedState>,
}

impl CutFaces {
    /// The scene of these layers as they are shown.
    pub(super) fn scene<'a>(&self, read: &'a SceneLayers) -> Scene<'a> {
        let layers = read.layers.iter().zip(&self.layers);
        let layers = layers.map(|(layer, (state, clip))| {
            let made = Layer::new(&layer.name, &layer.gaussians).with(*state);
            match clip {
                Some(clip) => made.clipped(clip.clone()),
                None => made,
            }
        });
        layers.collect()
    }
}

impl NamedLayer {
    /// Their own clip where a section cuts as well, as flags say it.
    pub fn clip(&self, section: &[Expression]) -> Option<LayerClip> {
        Some(layer_clip(self.own.as_ref()?).cut_by(section))
    }
}

impl Clips {
    /// The frame's clip and the layers of a scene of this middle, as they were read.
    pub fn new(frame: ClipEditor, loaded: &[LoadedLayer], centre: DVec3) -> Self {
        let mut layers: Vec<NamedLayer> = Vec::new();
        for (place, layer) in loaded.iter().enumerate() {
            let is_alike = |other: &&mut NamedLayer| {
                let first = &loaded[other.places[0]];
                let shown = |l: &LoadedLayer| (l.state.visible, l.state.opacity);
                let facts = |l: &LoadedLayer| (l.name.clone(), shown(l), l.clip.clone());
                facts(first) == facts(layer)
            };
            let listed = ListedState {
                visible: layer.listed.visible,
                opacity: layer.listed.opacity,
                clip: layer
                    .listed
                    .clip
                    .as_ref()
                    .map(|clip| layer_clip(&own(clip, centre))),
            };
            match layers.iter_mut().find(is_alike) {
                Some(other) => {
                    other.places.push(place);
                    other.listed.push(listed);
                }
                None => layers.push(NamedLayer {
                    name: layer.name.clone(),
                    places: vec![place],
                    visible: layer.state.visible,
                    opacity: layer.state.opacity,
                    tint: None,
                    own: layer.clip.as_ref().map(|clip| own(clip, centre)),
                    listed: vec![listed],
                }),
            }
        }
        let changed = frame.has_section();
        Self {
            frame,
            layers,
            edited: None,
            centre,
            changed,
            past: Vec::new(),
        }
    }

    /// Keeps what the clips are before something changes them.
    fn remember(&mut self, action: Option<GripAction>) {
        let by = (action.map(|action| discriminant(&action)), Instant::now());
        let goes_on =
            |last: &&mut Past| by.0.is_some() && last.by.0 == by.0 && by.1 - last.by.1 < AT_ONCE;
        if let Some(last) = self.past.last_mut().filter(goes_on) {
            last.by = by;
            return;
        }
        if self.past.len() == MOST_UNDONE {
            self.past.remove(0);
        }
        self.past.push(Past {
            frame: self.frame.clone(),
            own: self.layers.iter().map(|layer| layer.own.clone()).collect(),
            by,
        });
    }

    /// Makes the clips what they were before the last change, if there was one.
    pub fn undo(&mut self) {
        let Some(past) = self.past.pop() else {
            return;
        };
        self.frame = past.frame;
        for (layer, own) in self.layers.iter_mut().zip(past.own) {
            layer.own = own;
        }
        self.changed = true;
    }

    /// The layers by name.
    pub fn layers(&self) -> &[NamedLayer] {
        &self.layers
    }

    /// The clip that is edited, if it is there: a layer may have none of its own.
    pub(super) fn edited(&self) -> Option<&ClipEditor> {
        match self.edited {
            None => Some(&self.frame),
            Some(layer) => self.layers[layer].own.as_ref(),
        }
    }

    /// Every clip that cuts something of what is shown.
    pub(super) fn in_force(&self) -> impl Iterator<Item = &ClipEditor> {
        let shown = || self.layers.iter().filter(|layer| layer.visible);
        let is_cut = |own: &ClipEditor| own.on && !self.frame.section().is_empty();
        let frame = shown()
            .any(|layer| layer.own.as_ref().is_none_or(is_cut))
            .then_some(&self.frame);
        let own = shown().filter_map(|layer| layer.own.as_ref());
        frame.into_iter().chain(own).filter(|cut| cut.on)
    }

    /// Puts these expressions in place of the clip that is edited.
    pub(super) fn replace(&mut self, clip: Vec<Expression>) {
        self.remember(None);
        self.changed = true;
        match self.edited {
            None => self.frame = ClipEditor::new(clip, self.frame.op(), self.centre),
            Some(layer) => {
                self.layers[layer].own = Some(ClipEditor::new(clip, ClipOp::And, self.centre));
            }
        }
    }

    /// Gives the layers of a name a clip of their own; says whether there are any.
    pub(super) fn replace_of(&mut self, name: &str, clip: &LayerClip) -> bool {
        if !self.layers.iter().any(|layer| layer.name == name) {
            return false;
        }
        self.remember(None);
        self.changed = true;
        let centre = self.centre;
        for layer in self.layers.iter_mut().filter(|layer| layer.name == name) {
            layer.own = Some(own(clip, centre));
        }
        true
    }

    /// Does what is asked of the held shape. What changes the clip of a layer without one gives it one, whose only shape is a
    /// plane through the middle of the scene.
    pub fn act(&mut self, action: GripAction, camera: &Camera, radius: f64) {
        if action != GripAction::Next {
            self.remember(Some(action));
        }
        if action == GripAction::Next && self.edited().is_none() {
            return;
        }
        self.changing().act(action, camera, radius);
    }

    /// Keeps of what the edited clip keeps what a lasso keeps in a camera's picture.
    ///
    /// # Errors
    /// [`Failure::Asked`] where its numbers overflow.
    pub(super) fn lasso(&mut self, camera: &Camera, lasso: &Lasso) -> Result<(), Failure> {
        self.remember(None);
        let done = self.changing().lasso(camera, lasso);
        done.map_err(|error| Failure::Asked(error.to_string()))
    }

    /// The edited clip, which is about to change; a layer without one gets one.
    fn changing(&mut self) -> &mut ClipEditor {
        match self.edited {
            None => {
                self.changed |= self.frame.has_section();
                &mut self.frame
            }
            Some(layer) => {
                self.changed = true;
                let own = &mut self.layers[layer].own;
                own.get_or_insert_with(|| whole(self.centre))
            }
        }
    }

    /// Shows layers, hides them, or whichever they are not.
    ///
    /// # Errors
    /// [`Failure::Asked`] where there are no such layers.
    pub fn show(&mut self, which: &Which, visible: Option<bool>) -> Result<(), Failure> {
        let layer = self.find(which)?;
        let layer = &mut self.layers[layer];
        layer.visible = visible.unwrap_or(!layer.visible);
        self.changed = true;
        Ok(())
    }

    /// Gives layers a share of their opacity. Returns a few words on it.
    ///
    /// # Errors
    /// [`Failure::Asked`] where there are no such layers.
    pub fn fade(&mut self, which: &Which, opacity: Step<f32>) -> Result<String, Failure> {
        let layer = self.find(which)?;
        let layer = &mut self.layers[layer];
        layer.opacity = match opacity {
            Step::To(opacity) => opacity,
            Step::Next => {
                let less = OPACITIES.into_iter().find(|step| *step < layer.opacity);
                less.unwrap_or(OPACITIES[0])
            }
        };
        self.changed = true;
        let percent = 100.0 * layer.opacity;
        Ok(format!("{}: opacity {percent:.0} %", layer.name))
    }

    /// Notes that a colour is mixed into layers. Returns their numbers in the scene, the colour, and a few words on it.
    ///
    /// # Errors
    /// [`Failure::Asked`] where there are no such layers.
    pub(super) fn tint(
        &mut self,
        which: &Which,
        tint: Step<Option<Tint>>,
    ) -> Result<(Vec<usize>, Option<Tint>, String), Failure> {
        let layer = self.find(which)?;
        let layer = &mut self.layers[layer];
        layer.tint = match tint {
            Step::To(tint) => tint,
            Step::Next => next_tint(layer.tint),
        };
        // The layers come to the device anew, as they were read.
        self.changed = true;
        let name = layer.tint.map_or("none".into(), tint_name);
        let text = format!("{}: tint {name}", layer.name);
        Ok((layer.places.clone(), layer.tint, text))
    }

    /// Chooses the clip that is edited.
    ///
    /// # Errors
    /// [`Failure::Asked`] where there are no such layers.
    pub fn edit(&mut self, edit: &Edit) -> Result<(), Failure> {
        match (edit, self.edited) {
            (Edit::Frame, _) => self.edited = None,
            (Edit::Layer(which), _) => self.edited = Some(self.find(which)?),
            // After the last layer comes the frame again.
            (Edit::Next, None) => self.edited = Some(0).filter(|_| !self.layers.is_empty()),
            (Edit::Next, Some(layer)) => {
                self.edited = Some(layer + 1).filter(|&next| next < self.layers.len());
            }
            (Edit::Release, Some(layer)) => {
                self.remember(None);
                self.layers[layer].own = None;
                self.changed = true;
            }
            (Edit::Release, None) => {}
        }
        Ok(())
    }

    /// Makes the window's scene what is wanted of its layers. Returns how these were shown before, if that has changed.
    pub(super) fn apply(&mut self, windowed: &mut Windowed) -> rara::Result<Option<ShownLayers>> {
        if !std::mem::take(&mut self.changed) {
            return Ok(None);
        }
        let before = windowed.layers().iter();
        let before = before.map(|layer| (layer.state(), layer.clip().cloned()));
        let before = before.collect();
        for layer in &self.layers {
            let clip = layer.clip(self.frame.section()).map(|clip| clip.clip());
            for &place in &layer.places {
                let state = windowed.layers()[place].state();
                let state = state.visible(layer.visible).opacity(layer.opacity);
                windowed.set_layer_state(place, state)?;
                windowed.set_layer_clip(place, clip.clone())?;
            }
        }
        Ok(Some(before))
    }

    /// Shows the window's layers as they were before, until [`apply`](Self::apply) is called again.
    pub(super) fn take_back(
        &mut self,
        windowed: &mut Windowed,
        before: Option<ShownLayers>,
    ) -> rara::Result<()> {
        self.changed |= before.is_some();
        for (place, (state, clip)) in before.into_iter().flatten().enumerate() {
            windowed.set_layer_state(place, state)?;
            windowed.set_layer_clip(place, clip)?;
        }
        Ok(())
    }

    /// The faces that the frame's clip cuts and a camera sees, and how these layers are shown; `None` where it is off, where other
    /// shapes than planes, slabs and boxes cut, and where shapes do not cut together.
    pub(super) fn faces(&self, read: &[LoadedLayer], camera: &Camera) -> Option<CutFaces> {
        if !self.frame.on {
            return None;
        }
        let section = self.frame.section();
        Some(CutFaces {
            faces: faces(&self.frame.clip(), camera)?,
            layers: self.each(read, |layer| {
                (layer.visible, layer.clip(section).map(|clip| clip.clip()))
            }),
        })
    }

    /// The faces of the held shape that a camera sees, and how these layers are shown on them: if the shape is of the frame's clip,
    /// all layers that are shown, and otherwise those whose clip it is of. `None` where the held shape is no plane, slab or box, or
    /// does not cut together with others.
    pub(super) fn held_faces(&self, read: &[LoadedLayer], camera: &Camera) -> Option<CutFaces> {
        let (shape, others) = self.edited()?.held_apart()?;
        let mut faces = faces(&shape.clip(), camera)?;
        let mut beside: Vec<Clip> = others.iter().map(Expression::clip).collect();
        let layers = match self.edited {
            None => {
                let section = self.frame.section_beside_held();
                self.each(read, |layer| {
                    (layer.visible, layer.clip(section).map(|clip| clip.clip()))
                })
            }
            Some(edited) => {
                beside.extend(self.frame.section().iter().map(Expression::clip));
                let edited = &self.layers[edited];
                self.each(read, |layer| {
                    (layer.visible && std::ptr::eq(layer, edited), None)
                })
            }
        };
        for face in &mut faces {
            let all = beside.iter().chain([&face.rest]).cloned();
            face.rest = Clip::joined(all, ClipOp::And);
        }
        Some(CutFaces { faces, layers })
    }

    /// The state and the clip of each of these layers, where `shown` says whether it is visible and what clips it.
    fn each(
        &self,
        read: &[LoadedLayer],
        shown: impl Fn(&NamedLayer) -> (bool, Option<Clip>),
    ) -> ShownLayers {
        let mut all: Vec<_> = read.iter().map(|layer| (layer.state, None)).collect();
        for layer in &self.layers {
            let (visible, clip) = shown(layer);
            for &place in &layer.places {
                let (state, own) = &mut all[place];
                *state = state.visible(visible).opacity(layer.opacity);
                own.clone_from(&clip);
            }
        }
        all
    }

    /// A few words for the title: which shape of which clip is held, and which layers are hidden.
    pub(super) fn words(&self) -> Option<String> {
        let held = self.edited().filter(|cut| cut.on).map(ClipEditor::words);
        let mut words = Vec::new();
        match self.edited {
            None => words.extend(held),
            Some(layer) => {
                let layer = &self.layers[layer];
                let clip = match (&layer.own, held) {
                    (_, Some(held)) => held,
                    (Some(_), None) => "whole".into(),
                    (None, None) => "as the frame".into(),
                };
                words.push(format!("clip of {}: {clip}", layer.name));
            }
        }
        let hidden = self.layers.iter().filter(|layer| !layer.visible);
        let hidden: Vec<&str> = hidden.map(|layer| &layer.name[..]).collect();
        if !hidden.is_empty() {
            words.push(format!("without {}", hidden.join(" and ")));
        }
        (!words.is_empty()).then(|| words.join(", "))
    }

    /// The number, from 0, of the layers that are meant.
    fn find(&self, which: &Which) -> Result<usize, Failure> {
        let numbered = |number: usize| number.checked_sub(1);
        let found = match which {
            Which::Number(number) => numbered(*number),
            Which::Typed(text) => {
                let named = self.layers.iter().position(|layer| layer.name == *text);
                named.or_else(|| numbered(text.parse().ok()?))
            }
        };
        let found = found.filter(|&at| at < self.layers.len());
        found.ok_or_else(|| {
            let names = self.layers.iter().enumerate();
            let names: Vec<_> = names
                .map(|(at, l)| format!("{} {}", at + 1, l.name))
                .collect();
            Failure::Asked(format!(
                "there is no layer {which}; there are {}",
                names.join(", ")
            ))
        })
    }
}

/// The colours of [`TINTS`], with their names.
fn tints() -> impl Iterator<Item = (&'static str, Tint)> {
    let named = |name: &&'static str| Some((*name, name.parse().ok()?));
    TINTS.iter().filter_map(named)
}

/// The colour behind this one; none behind the last, and behind one that no key gives.
fn next_tint(now: Option<Tint>) -> Option<Tint> {
    let mut all = tints().map(|(_, tint)| tint);
    match now {
        None => all.next(),
        Some(now) => all.skip_while(|tint| *tint != now).nth(1),
    }
}

/// The name of a colour, or its numbers where no key gives it.
fn tint_name(tint: Tint) -> String {
    let name = tints().find(|(_, one)| *one == tint);
    name.map_or_else(|| tint.to_string(), |(name, _)| name.into())
}

/// A layer's own clip as it can be edited.
fn own(clip: &LayerClip, centre: DVec3) -> ClipEditor {
    match clip {
        LayerClip::Whole => whole(centre),
        LayerClip::Region(region) => ClipEditor::new(vec![region.clone()], ClipOp::And, centre),
    }
}

/// What a layer's own clip is as it has been edited.
fn layer_clip(own: &ClipEditor) -> LayerClip {
    match own.expressions() {
        [] => LayerClip::Whole,
        [only] => LayerClip::Region(only.clone()),
        all => LayerClip::Region(Expression::All(all.into())),
    }
}

/// A clip that is off.
fn whole(centre: DVec3) -> ClipEditor {
    ClipEditor::new(Vec::new(), ClipOp::And, centre)
}

#[cfg(test)]
pub(super) mod tests;
