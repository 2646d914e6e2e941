//! The flags of `rara render` that draw what is shown.

use rara::ClipOp;
use rara::clip::Expression;
use rara_base::value::Value;
use rara_view::viewer::Shown;

use super::shots::quoted;
use super::{camera_flags, layer_flags};
use crate::settings;

/// The flags of `rara render` for clips, the planes of the camera among them, layers and settings, as a user would type them.
/// They leave out defaults.
pub(super) fn flags(shown: &Shown<'_>) -> String {
    let (clips, settings) = (shown.clips, shown.settings);
    let mut flags = camera_flags::planes(&shown.camera);
    let cut = &clips.frame;
    let expressions = cut.expressions();
    // Shells take some of an expression's characters for their own.
    flags.extend(expressions.iter().map(|expression| match expression {
        Expression::Shape(shape) if shape.is_outside() => format!("--clip '{shape}'"),
        Expression::Shape(shape) => format!("--clip {shape}"),
        other => format!("--clip-expr '{other}'"),
    }));
    if expressions.len() > 1 && cut.op() == ClipOp::Or {
        flags.push("--clip-op or".into());
    }
    flags.extend_from_slice(shown.notes);
    flags.extend(layer_flags::flags(clips.layers(), cut.section()));
    let cues = shown.faces.cues();
    let marks = [("--outline", cues.outline), ("--rim", cues.rim)];
    let marks = marks.into_iter().filter(|_| !shown.faces.slice);
    flags.extend(marks.filter_map(|(flag, cue)| Some(format!("{flag}={}", cue?.colour.text()?))));
    flags.extend(settings::flags(settings));
    flags.join(" ")
}

/// The line with all flags of `rara render` that draw what is shown.
pub(super) fn lines(shown: &Shown<'_>) -> String {
    let rest = flags(shown);
    let lines = match camera_flags::flags(&shown.camera) {
        Some(camera) => format!("flags    {camera} {rest}"),
        None => format!(
            "flags    {rest}\nnote: only a file can say what this camera is; a screenshot (C) writes one next to it, for \
             --camera"
        ),
    };
    notes(shown).fold(lines, |lines, note| format!("{lines}\n{note}"))
}

/// Notes on what no flags can say.
pub(super) fn notes(shown: &Shown<'_>) -> impl Iterator<Item = String> {
    let layers = layer_flags::note(shown.clips.layers(), shown.clips.frame.section());
    let slice = shown.faces.slice.then(|| {
        "note: the flags draw the scene and leave out the slice: --slice is for a --section, which places the camera itself"
            .to_owned()
    });
    layers.into_iter().chain(slice)
}

/// The flags that made the layers of a scene, of which these texts were typed.
pub(super) fn typed(flags: &[(&str, &str)]) -> Vec<String> {
    let typed = |(flag, text): &(&str, &str)| format!("{flag}={}", quoted(text));
    flags.iter().map(typed).collect()
}

#[cfg(test)]
mod tests;
