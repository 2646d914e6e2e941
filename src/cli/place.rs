//! `--place`: where layers stand, in place of what their list says.

use glam::{DQuat, DVec3};

use super::failure::Failure;
use super::layer_names::named;
use super::values;
use rara::scene::layers::{LoadedLayer, Place, SceneLayers, stretch};

/// Does what the flags say, each in place of what was said of its layers before.
pub(super) fn apply(texts: &[String], loaded: &mut SceneLayers) -> Result<(), Failure> {
    let mut places = vec![None; loaded.layers.len()];
    for text in texts {
        let end = loaded.end_of_name(text);
        let (name, parts) = match end {
            Some(at) => (Some(&text[..at]), &text[at + 1..]),
            None => (None, &text[..]),
        };
        let place =
            place(parts).map_err(|error| Failure::Usage(format!("--place {text}: {error}")))?;
        if let Some(name) = name {
            named(loaded, "--place", name)?;
        }
        let is_meant = |layer: &LoadedLayer| name.is_none_or(|name| name == layer.name);
        for (layer, own) in loaded.layers.iter().zip(&mut places) {
            if is_meant(layer) {
                *own = Some(place);
            }
        }
    }
    for (layer, place) in loaded.layers.iter_mut().zip(places) {
        let Some(Place {
            placement,
            stretch: by,
        }) = place
        else {
            continue;
        };
        // In place of how the list has stretched it already.
        stretch(&mut layer.gaussians, by / layer.stretch)
            .map_err(|error| Failure::Usage(format!("--place: layer '{}': {error}", layer.name)))?;
        layer.stretch = by;
        layer.state = layer.state.placement(placement);
    }
    Ok(())
}

/// A place of its parts, in any order and each once at most: the layer is scaled, then turned, then moved.
fn place(text: &str) -> Result<Place, String> {
    const FORMS: &str = "move:X,Y,Z, turn:X,Y,Z,DEGREES or rotation:W,X,Y,Z, and scale:S or scale:X,Y,Z, with blanks between \
                         them";
    let (mut position, mut turn, mut scales) = (None, None, None);
    for part in text.split_whitespace() {
        let of_part = |error: String| format!("{part}: {error}");
        let (word, numbers) = part.split_once(':').unwrap_or((part, ""));
        let is_second = match word {
            "move" => {
                let to = values::vec3(numbers).map_err(of_part)?;
                position.replace(to).is_some()
            }
            "turn" => {
                let by = values::turn(numbers).map_err(of_part)?;
                turn.replace(by).is_some()
            }
            "rotation" => {
                let [w, x, y, z] = values::numbers::<4>(numbers).map_err(of_part)?;
                turn.replace(DQuat::from_xyzw(x, y, z, w)).is_some()
            }
            "scale" => {
                let by =
                    rara::clip::numbers(numbers).map_err(|error| of_part(error.to_string()))?;
                scales.replace(by).is_some()
            }
            _ => return Err(format!("'{part}' is none of {FORMS}")),
        };
        if is_second {
            return Err(format!(
                "{part} comes second; a layer has one move, one turn and one scale"
            ));
        }
    }
    if position.is_none() && turn.is_none() && scales.is_none() {
        return Err(format!("expected {FORMS}"));
    }
    Place::new(
        position.unwrap_or(DVec3::ZERO),
        turn.unwrap_or(DQuat::IDENTITY),
        scales.as_deref().unwrap_or(&[1.0]),
    )
    .map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests;
