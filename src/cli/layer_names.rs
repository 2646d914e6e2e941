//! The layers that flags name.

use rara::scene::layers::{LoadedLayer, SceneLayers};

use super::failure::Failure;
use super::output;
use super::values;

/// Says which layers the frame's clip does not cut, as they have clips of their own.
pub(super) fn tell_own_clips(loaded: &SceneLayers) {
    let shown = loaded.layers.iter().filter(|layer| layer.state.visible);
    let own = shown.filter(|layer| layer.clip.is_some());
    let mut names: Vec<_> = own.map(|layer| layer.name.as_str()).collect();
    names.dedup();
    if !names.is_empty() {
        output::warn_once(format!(
            "note: {} {} of its own, which takes the place of the frame's; --layer-clip NAME=frame takes it away",
            names.join(", "),
            if names.len() == 1 {
                "has a clip"
            } else {
                "each have a clip"
            }
        ));
    }
}

/// The layers of a name, which `flag` asks for.
pub(super) fn named<'a>(
    loaded: &'a mut SceneLayers,
    flag: &str,
    name: &str,
) -> Result<Vec<&'a mut LoadedLayer>, Failure> {
    let names = loaded.layers.iter().map(|layer| layer.name.as_str());
    if !names.clone().any(|one| one == name) {
        return Err(no_layer(flag, name, names));
    }
    let layers = loaded.layers.iter_mut();
    Ok(layers.filter(|layer| layer.name == name).collect())
}

/// The refusal of a name that no layer has, which `flag` asks for.
pub(super) fn no_layer<'a>(
    flag: &str,
    name: &str,
    names: impl Iterator<Item = &'a str>,
) -> Failure {
    let names: Vec<_> = names.collect();
    Failure::Usage(format!(
        "{flag}: no layer is called '{name}'; the layers are {}{}",
        names.join(", "),
        values::meant(name, names.iter().copied())
    ))
}
