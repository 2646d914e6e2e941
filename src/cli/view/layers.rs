//! The layers of the scene, their clips, and the clip that is edited: the frame's, or a layer's own.

use glam::DVec3;
use rara::{Camera, ClipOp, Windowed};

use super::action::{Edit, GripAction, Which};
use super::cut::ClipEditor;
use super::layer_flags;
use super::shots::quoted;
use crate::failure::Failure;
use crate::scene_file::LayerClip;
use crate::scene_layers::{ListedState, LoadedLayer};
use rara::clip::Expression;

/// The frame's clip and the layers.
#[derive(Debug, Clone)]
pub(super) struct Clips {
    pub(super) frame: ClipEditor,
    /// The layers by name: those of one name that begin alike go together, as flags name them.
    layers: Vec<NamedLayer>,
    /// The number of the layer whose own clip is edited; `None` for the frame's.
    edited: Option<usize>,
    /// The flags that were typed, which make layers of files.
    typed: Vec<String>,
    centre: DVec3,
    /// True when the window's scene is not yet as these say.
    changed: bool,
}

/// The layers of a name that begin alike.
#[derive(Debug, Clone)]
pub(super) struct NamedLayer {
    pub(super) name: String,
    /// Their numbers in the scene.
    places: Vec<usize>,
    pub(super) visible: bool,
    /// Their own clip; one that is off leaves them whole. `None` where the frame's holds.
    own: Option<ClipEditor>,
    /// What is listed of each of them, with clips as they can be edited.
    pub(super) listed: Vec<ListedState>,
}

impl NamedLayer {
    /// Their own clip where a section cuts as well, as flags say it.
    pub(super) fn clip(&self, section: &[Expression]) -> Option<LayerClip> {
        Some(layer_clip(self.own.as_ref()?).cut_by(section))
    }
}

impl Clips {
    pub(super) fn new(frame: ClipEditor, loaded: &[LoadedLayer], centre: DVec3) -> Self {
        let mut layers: Vec<NamedLayer> = Vec::new();
        for (place, layer) in loaded.iter().enumerate() {
            let is_alike = |other: &&mut NamedLayer| {
                let first = &loaded[other.places[0]];
                let facts = |l: &LoadedLayer| (l.name.clone(), l.state.visible, l.clip.clone());
                facts(first) == facts(layer)
            };
            let listed = ListedState {
                visible: layer.listed.visible,
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
            typed: Vec::new(),
            centre,
            changed,
        }
    }

    /// The same with the flags that made its layers, as they were typed.
    pub(super) fn typed(self, flags: &[(&str, &str)]) -> Self {
        let typed = |(flag, text): &(&str, &str)| format!("{flag}={}", quoted(text));
        Self {
            typed: flags.iter().map(typed).collect(),
            ..self
        }
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
        let centre = self.centre;
        let mut is_there = false;
        for layer in self.layers.iter_mut().filter(|layer| layer.name == name) {
            layer.own = Some(own(clip, centre));
            (is_there, self.changed) = (true, true);
        }
        is_there
    }

    /// Does what is asked of the held shape. What changes the clip of a layer without one gives it one, whose only shape is a
    /// plane through the middle of the scene.
    pub(super) fn act(&mut self, action: GripAction, camera: &Camera, radius: f64) {
        let cut = match self.edited {
            None => {
                self.changed |= self.frame.has_section();
                &mut self.frame
            }
            Some(layer) => {
                let own = &mut self.layers[layer].own;
                if own.is_none() && action == GripAction::Next {
                    return;
                }
                self.changed = true;
                own.get_or_insert_with(|| whole(self.centre))
            }
        };
        cut.act(action, camera, radius);
    }

    /// Shows layers, hides them, or whichever they are not.
    pub(super) fn show(&mut self, which: &Which, visible: Option<bool>) -> Result<(), Failure> {
        let layer = self.find(which)?;
        let layer = &mut self.layers[layer];
        layer.visible = visible.unwrap_or(!layer.visible);
        self.changed = true;
        Ok(())
    }

    /// Chooses the clip that is edited.
    pub(super) fn edit(&mut self, edit: &Edit) -> Result<(), Failure> {
        match (edit, self.edited) {
            (Edit::Frame, _) => self.edited = None,
            (Edit::Layer(which), _) => self.edited = Some(self.find(which)?),
            // After the last layer comes the frame again.
            (Edit::Next, None) => self.edited = Some(0).filter(|_| !self.layers.is_empty()),
            (Edit::Next, Some(layer)) => {
                self.edited = Some(layer + 1).filter(|&next| next < self.layers.len());
            }
            (Edit::Release, Some(layer)) => {
                self.layers[layer].own = None;
                self.changed = true;
            }
            (Edit::Release, None) => {}
        }
        Ok(())
    }

    /// Makes the window's scene what is wanted of its layers.
    pub(super) fn apply(&mut self, windowed: &mut Windowed) -> rara::Result<()> {
        if !std::mem::take(&mut self.changed) {
            return Ok(());
        }
        for layer in &self.layers {
            let clip = layer.clip(self.frame.section()).map(|clip| clip.clip());
            for &place in &layer.places {
                let state = windowed.layers()[place].state();
                windowed.set_layer_state(place, state.visible(layer.visible))?;
                windowed.set_layer_clip(place, clip.clone())?;
            }
        }
        Ok(())
    }

    /// The flags that make the layers of the same files what they are.
    pub(super) fn flags(&self) -> Vec<String> {
        let mut flags = self.typed.clone();
        flags.extend(layer_flags::flags(&self.layers, self.frame.section()));
        flags
    }

    /// A note on what no flags can say.
    pub(super) fn note(&self) -> Option<String> {
        layer_flags::note(&self.layers, self.frame.section())
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
            Failure::Usage(format!(
                "there is no layer {which}; there are {}",
                names.join(", ")
            ))
        })
    }
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
pub(super) mod tests {
    use super::*;
    use rara::LayerState;

    pub(in crate::view) fn layer(name: &str, visible: bool, clip: Option<&str>) -> LoadedLayer {
        let clip = clip.map(|text| LayerClip::parse(text).unwrap());
        LoadedLayer::new(name.into(), LayerState::default().visible(visible), clip)
    }

    fn clips(layers: &[LoadedLayer]) -> Clips {
        let frame = vec!["sphere:0,0,0,1".parse().unwrap()];
        Clips::new(
            ClipEditor::new(frame, ClipOp::And, DVec3::ZERO),
            layers,
            DVec3::ZERO,
        )
    }

    pub(in crate::view) fn camera() -> Camera {
        Camera::look_at(DVec3::NEG_Z, DVec3::ZERO, DVec3::NEG_Y, 50.0, (64, 64)).unwrap()
    }

    fn which(text: &str) -> Which {
        Which::Typed(text.into())
    }

    #[test]
    fn layers_are_named_or_numbered_and_flags_say_what_differs_from_their_list() {
        let mut clips = clips(&[
            layer("skin", true, None),
            layer("a b", false, Some("plane:1,0,0,0")),
            layer("skin", true, None),
        ]);
        assert!(clips.flags().is_empty(), "all are as they are listed");
        assert_eq!(clips.words().unwrap(), "sphere, without a b");
        clips.show(&which("2"), None).unwrap();
        clips.show(&which("skin"), Some(false)).unwrap();
        clips.edit(&Edit::Layer(which("a b"))).unwrap();
        assert_eq!(
            clips.words().unwrap(),
            "clip of a b: plane at 0.0000, without skin"
        );
        clips.act(GripAction::Flip, &camera(), 1.0);
        assert_eq!(
            clips.flags(),
            [
                "--hide=skin",
                "--unhide='a b'",
                "--layer-clip='a b=plane:-1,-0,-0,-0'"
            ]
        );
        clips.edit(&Edit::Release).unwrap();
        assert_eq!(clips.flags()[2], "--layer-clip='a b=frame'");
        let error = clips.show(&which("3"), None).unwrap_err().to_string();
        assert!(error.contains("1 skin, 2 a b"), "{error}");
    }

    #[test]
    fn keys_go_by_the_number_where_scripts_go_by_the_name_first() {
        let mut clips = clips(&[layer("0", true, None), layer("1", true, None)]);
        let hidden = |clips: &Clips| clips.words().unwrap();
        clips.show(&Which::Number(1), None).unwrap();
        assert_eq!(hidden(&clips), "sphere, without 0");
        clips.show(&which("1"), None).unwrap();
        assert_eq!(hidden(&clips), "sphere, without 0 and 1");
        clips.show(&which("2"), None).unwrap();
        assert_eq!(hidden(&clips), "sphere, without 0");
        for none in [Which::Number(0), Which::Number(3)] {
            let error = clips.show(&none, None).unwrap_err().to_string();
            assert!(error.contains("1 0, 2 1"), "{error}");
        }
    }

    #[test]
    fn a_layer_gets_a_clip_of_its_own_when_one_is_asked_for() {
        let mut clips = clips(&[layer("skin", true, None), layer("bone", true, None)]);
        for words in ["clip of skin: as the frame", "clip of bone: as the frame"] {
            clips.edit(&Edit::Next).unwrap();
            clips.act(GripAction::Next, &camera(), 1.0);
            assert_eq!(clips.words().unwrap(), words);
        }
        assert!(clips.flags().is_empty() && clips.in_force().count() == 1);
        clips.act(GripAction::Toggle, &camera(), 1.0);
        assert_eq!(clips.words().unwrap(), "clip of bone: plane at 0.0000");
        assert_eq!(clips.in_force().count(), 2);
        clips.act(GripAction::On(false), &camera(), 1.0);
        assert_eq!(clips.flags(), ["--layer-clip=bone=whole"]);
        let selected = clips.clone().typed(&[("--select", "bone=label in 3")]);
        assert_eq!(
            selected.flags(),
            ["--select='bone=label in 3'", "--layer-clip=bone=whole"]
        );
        assert_eq!(clips.words().unwrap(), "clip of bone: whole");
        clips.edit(&Edit::Next).unwrap();
        assert_eq!(clips.words().unwrap(), "sphere");
    }
}
