//! `--layer-opacity` and `--layer-tint`: how single layers look, in place of what their list says.

use super::failure::Failure;
use super::layer_names::named;
use super::values;
use rara::Error;
use rara::scene::layers::{LoadedLayer, SceneLayers, Tint};

/// Does what the flags say, in their order.
pub(super) fn apply(
    opacities: &[String],
    tints: &[String],
    loaded: &mut SceneLayers,
) -> Result<(), Failure> {
    each(loaded, "--layer-opacity", opacities, |text| {
        let opacity = values::share(text)?;
        Ok(move |layer: &mut LoadedLayer| layer.state = layer.state.opacity(opacity))
    })?;
    each(loaded, "--layer-tint", tints, |text| {
        let tint: Tint = text.parse().map_err(|error: Error| error.to_string())?;
        Ok(move |layer: &mut LoadedLayer| tint.apply(&mut layer.gaussians))
    })
}

/// Changes the layers of each `NAME=VALUE` by what `change` makes of the value.
fn each<C: Fn(&mut LoadedLayer)>(
    loaded: &mut SceneLayers,
    flag: &str,
    texts: &[String],
    change: impl Fn(&str) -> Result<C, String>,
) -> Result<(), Failure> {
    for text in texts {
        let wrong = |error: String| Failure::Usage(format!("{flag} {text}: {error}"));
        let end = loaded.end_of_name(text);
        let end = end.ok_or_else(|| wrong("a layer's name and = come first".into()))?;
        let change = change(text[end + 1..].trim()).map_err(wrong)?;
        named(loaded, flag, &text[..end])?
            .into_iter()
            .for_each(change);
    }
    Ok(())
}
