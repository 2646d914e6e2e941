//! The flags of `rara render` that draw what is shown.

use rara::ClipOp;
use rara::clip::Expression;
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
    let notes = note(shown).map(|note| format!("\n{note}"));
    lines + &notes.unwrap_or_default()
}

/// A note on what no flags can say.
pub(super) fn note(shown: &Shown<'_>) -> Option<String> {
    layer_flags::note(shown.clips.layers(), shown.clips.frame.section())
}

/// The flags that made the layers of a scene, of which these texts were typed.
pub(super) fn typed(flags: &[(&str, &str)]) -> Vec<String> {
    let typed = |(flag, text): &(&str, &str)| format!("{flag}={}", quoted(text));
    flags.iter().map(typed).collect()
}

#[cfg(test)]
mod tests;
