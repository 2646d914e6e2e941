//! The flags of `rara render` that make the layers of files what is shown of them.

use rara::clip::Expression;

use super::layers::NamedLayer;
use super::shots::quoted;
use crate::scene_file::LayerClip;

/// How a flag, which takes all layers of a name alike, makes what is listed of them into what is shown.
#[derive(Debug, PartialEq)]
enum Change<T> {
    /// They are as they are listed.
    None,
    /// All of them become this.
    To(T),
    /// They become different things, which no flag can say.
    Unsaid,
}

impl<T: PartialEq> Change<T> {
    /// The change of layers of which this is listed and that is shown.
    fn from_layers(layers: Vec<(T, T)>) -> Self {
        if layers.iter().all(|(listed, shown)| listed == shown) {
            return Self::None;
        }
        let mut shown = layers.into_iter().map(|(_, shown)| shown);
        match shown.next() {
            Some(first) if shown.all(|other| other == first) => Self::To(first),
            _ => Self::Unsaid,
        }
    }
}

/// The changes of the layers of a name.
struct Changes<'a> {
    name: &'a str,
    visible: Change<bool>,
    /// `None` is the frame's clip.
    clip: Change<Option<LayerClip>>,
}

fn changes<'a>(layers: &'a [NamedLayer], section: &[Expression]) -> Vec<Changes<'a>> {
    let mut all: Vec<Changes<'_>> = Vec::new();
    for NamedLayer { name, .. } in layers {
        if all.iter().any(|known| known.name == name) {
            continue;
        }
        let mut visible = Vec::new();
        let mut clip = Vec::new();
        for layer in layers.iter().filter(|layer| layer.name == *name) {
            for listed in &layer.listed {
                visible.push((listed.visible, layer.visible));
                clip.push((listed.clip.clone(), layer.clip(section)));
            }
        }
        all.push(Changes {
            name,
            visible: Change::from_layers(visible),
            clip: Change::from_layers(clip),
        });
    }
    all
}

/// The flags that make layers, as they are listed, what is shown of them where a section cuts them.
pub(super) fn flags(layers: &[NamedLayer], section: &[Expression]) -> Vec<String> {
    let mut flags = Vec::new();
    for Changes {
        name,
        visible,
        clip,
    } in changes(layers, section)
    {
        match visible {
            Change::To(false) => flags.push(format!("--hide={}", quoted(name))),
            Change::To(true) => flags.push(format!("--unhide={}", quoted(name))),
            Change::None | Change::Unsaid => {}
        }
        if let Change::To(clip) = clip {
            let clip = clip.map_or("frame".into(), |clip| clip.to_string());
            flags.push(format!(
                "--layer-clip={}",
                quoted(&format!("{name}={clip}"))
            ));
        }
    }
    flags
}

/// A note on the layers of which the flags cannot say what is shown.
pub(super) fn note(layers: &[NamedLayer], section: &[Expression]) -> Option<String> {
    let all = changes(layers, section);
    let is_unsaid = |of: &&Changes<'_>| of.visible == Change::Unsaid || of.clip == Change::Unsaid;
    let names: Vec<_> = all.iter().filter(is_unsaid).map(|of| of.name).collect();
    let names = (!names.is_empty()).then(|| names.join(" and "))?;
    Some(format!(
        "note: the flags leave out what differs between the layers called {names}, since a flag takes all layers of a name \
         alike; give each of them a name of its own"
    ))
}

#[cfg(test)]
mod tests {
    use crate::scene_layers::LoadedLayer;
    use crate::view::action::{Edit, GripAction, Which};
    use crate::view::cut::ClipEditor;
    use crate::view::layers::Clips;
    use crate::view::layers::tests::{camera, layer};
    use glam::DVec3;
    use rara::ClipOp;

    fn clips(layers: &[LoadedLayer]) -> Clips {
        let frame = ClipEditor::new(Vec::new(), ClipOp::And, DVec3::ZERO);
        Clips::new(frame, layers, DVec3::ZERO)
    }

    /// The same layer as flags have left it: hidden, or with another clip.
    fn flagged(mut layer: LoadedLayer, visible: bool, clip: Option<&str>) -> LoadedLayer {
        layer.state = layer.state.visible(visible);
        layer.clip = clip.map(|text| crate::scene_file::LayerClip::parse(text).unwrap());
        layer
    }

    #[test]
    fn a_clip_is_said_where_it_is_another_than_the_listed_one() {
        for listed in [
            "!plane:1,0,0,0",
            "whole",
            "all(sphere:0,0,0,1, plane:1,0,0,0)",
        ] {
            let mut clips = clips(&[layer("skin", true, Some(listed))]);
            assert!(clips.flags().is_empty(), "{listed}");
            clips.edit(&Edit::Next).unwrap();
            clips.act(
                GripAction::Set("sphere:0,0,0,2".parse().unwrap()),
                &camera(),
                1.0,
            );
            let said = clips.flags();
            assert!(
                said[0].contains("sphere:0,0,0,2") && said.len() == 1,
                "{said:?}"
            );
            clips.edit(&Edit::Release).unwrap();
            assert_eq!(clips.flags(), ["--layer-clip=skin=frame"]);
        }
        // What flags have made of a layer is said again.
        let typed = flagged(
            layer("skin", true, Some("whole")),
            false,
            Some("plane:1,0,0,0"),
        );
        assert_eq!(
            clips(&[typed]).flags(),
            ["--hide=skin", "--layer-clip=skin=plane:1,0,0,0"]
        );
    }

    #[test]
    fn layers_of_one_name_that_differ_are_left_as_they_are_listed() {
        let mut clips = clips(&[
            layer("part", true, Some("plane:1,0,0,0")),
            layer("part", false, Some("sphere:0,0,0,1")),
        ]);
        assert!(clips.flags().is_empty() && clips.note().is_none());
        clips.show(&Which::Number(2), Some(true)).unwrap();
        assert_eq!(clips.flags(), ["--unhide=part"]);
        clips.show(&Which::Number(1), Some(false)).unwrap();
        assert!(clips.flags().is_empty());
        let note = clips.note().unwrap();
        assert!(note.contains("the layers called part,"), "{note}");
        clips.show(&Which::Number(2), Some(false)).unwrap();
        assert_eq!(clips.flags(), ["--hide=part"]);
        assert!(clips.note().is_none());
        // One of the clips is changed, and then both are the same.
        clips.edit(&Edit::Next).unwrap();
        clips.act(GripAction::On(false), &camera(), 1.0);
        assert_eq!(clips.flags(), ["--hide=part"]);
        assert!(clips.note().is_some());
        clips.edit(&Edit::Next).unwrap();
        clips.act(GripAction::On(false), &camera(), 1.0);
        assert_eq!(clips.flags(), ["--hide=part", "--layer-clip=part=whole"]);
        assert!(clips.note().is_none());
    }

    #[test]
    fn layers_that_flags_have_made_alike_are_said_as_they_are_listed() {
        // The list shows one and hides the other, and --unhide has brought that back.
        let shown = layer("part", true, None);
        let hidden = flagged(layer("part", false, None), true, None);
        let mut alike = clips(&[shown, hidden]);
        assert_eq!(alike.flags(), ["--unhide=part"]);
        alike
            .show(&Which::Typed("part".into()), Some(false))
            .unwrap();
        assert_eq!(alike.flags(), ["--hide=part"]);
        // The same of a clip that only the second is listed with.
        let plain = layer("part", true, None);
        let freed = flagged(layer("part", true, Some("whole")), true, None);
        assert_eq!(clips(&[plain, freed]).flags(), ["--layer-clip=part=frame"]);
    }
}
