//! `--layer-opacity` and `--layer-tint`: how single layers look, in place of what their list says.

use super::failure::Failure;
use super::layer_names::named;
use super::values;
use rara::scene::layers::{LoadedLayer, SceneLayers};

/// The share of a tint's colour where the flag says none.
const TINT: f32 = 0.5;

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
        let (colour, share) = match text.rsplit_once(':') {
            Some((colour, share)) => (colour, values::share(share)?),
            None => (text, TINT),
        };
        let colour = values::colour(colour)?;
        Ok(move |layer: &mut LoadedLayer| layer.gaussians.tint(colour, share))
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
