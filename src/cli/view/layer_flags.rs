//! The flags of `rara render` that make the layers of files what is shown of them.

use rara::clip::Expression;

use rara::scene::layers::{LayerClip, Tint};
use rara_view::viewer::NamedLayer;

use super::shots::quoted;

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
    opacity: Change<f32>,
    /// The colour that the window has mixed into them.
    tint: Change<Option<Tint>>,
    /// `None` is the frame's clip.
    clip: Change<Option<LayerClip>>,
}

fn changes<'a>(layers: &'a [NamedLayer], section: &[Expression]) -> Vec<Changes<'a>> {
    let mut all: Vec<Changes<'_>> = Vec::new();
    for NamedLayer { name, .. } in layers {
        if all.iter().any(|known| known.name == name) {
            continue;
        }
        let (mut visible, mut opacity) = (Vec::new(), Vec::new());
        let (mut tint, mut clip) = (Vec::new(), Vec::new());
        for layer in layers.iter().filter(|layer| layer.name == *name) {
            for listed in &layer.listed {
                visible.push((listed.visible, layer.visible));
                opacity.push((listed.opacity, layer.opacity));
                tint.push((None, layer.tint));
                clip.push((listed.clip.clone(), layer.clip(section)));
            }
        }
        all.push(Changes {
            name,
            visible: Change::from_layers(visible),
            opacity: Change::from_layers(opacity),
            tint: Change::from_layers(tint),
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
        opacity,
        tint,
        clip,
    } in changes(layers, section)
    {
        match visible {
            Change::To(false) => flags.push(format!("--hide={}", quoted(name))),
            Change::To(true) => flags.push(format!("--unhide={}", quoted(name))),
            Change::None | Change::Unsaid => {}
        }
        let mut set = |flag: &str, value: String| {
            flags.push(format!("{flag}={}", quoted(&format!("{name}={value}"))));
        };
        if let Change::To(opacity) = opacity {
            set("--layer-opacity", opacity.to_string());
        }
        if let Change::To(Some(tint)) = tint {
            set("--layer-tint", tint.to_string());
        }
        if let Change::To(clip) = clip {
            set(
                "--layer-clip",
                clip.map_or("frame".into(), |clip| clip.to_string()),
            );
        }
    }
    flags
}

/// A note on the layers of which the flags cannot say what is shown.
pub(super) fn note(layers: &[NamedLayer], section: &[Expression]) -> Option<String> {
    let all = changes(layers, section);
    let is_unsaid = |of: &&Changes<'_>| {
        of.visible == Change::Unsaid
            || of.opacity == Change::Unsaid
            || of.tint == Change::Unsaid
            || of.clip == Change::Unsaid
    };
    let names: Vec<_> = all.iter().filter(is_unsaid).map(|of| of.name).collect();
    let names = (!names.is_empty()).then(|| names.join(" and "))?;
    Some(format!(
        "note: the flags leave out what differs between the layers called {names}, since a flag takes all layers of a name \
         alike; give each of them a name of its own"
    ))
}

#[cfg(test)]
mod tests;
