//! `--place`: where layers stand, in place of what their list says.

use glam::{DQuat, DVec3};

use super::failure::Failure;
use super::layer_place::{Place, stretch};
use super::scene_layers::{LoadedLayer, SceneLayers};
use super::values;

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
            loaded.named("--place", name)?;
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
mod tests {
    use super::*;

    #[test]
    fn parts_make_a_placement_in_any_order() {
        let made = place("move:1,2,3 turn:0,0,1,90 scale:2").expect("a place");
        assert_eq!(place("scale:2,2,2 turn:0,0,1,90 move:1,2,3"), Ok(made));
        let to_world = |place: Place| place.placement.to_world(place.stretch * DVec3::X);
        assert!((to_world(made) - DVec3::new(1.0, 4.0, 3.0)).length() < 1e-12);
        let half = place("rotation:0,0,0,2").expect("a place");
        assert!((to_world(half) + DVec3::X).length() < 1e-12);
        assert_eq!(place("turn:0,0,5,180"), Ok(half));
        let mirrored = place("scale:-2,1,1 turn:0,0,1,90").expect("a place");
        assert!((to_world(mirrored) + 2.0 * DVec3::Y).length() < 1e-12);
    }

    #[test]
    fn what_is_no_placement_is_refused_with_its_part() {
        for (text, says) in [
            ("", "expected move:X,Y,Z"),
            ("1,2,3", "'1,2,3' is none of move"),
            ("move:1,2", "move:1,2: "),
            ("turn:0,0,0,90", "axis"),
            ("turn:0,0,1,90 rotation:1,0,0,0", "comes second"),
            ("scale:0", "scale"),
            ("scale:-1", "scale"),
            ("scale:1,2", "one for each of the three axes"),
            ("scale:1,0,1", "none of them 0"),
            ("rotation:0,0,0,0", "rotation"),
        ] {
            let error = place(text).expect_err(text);
            assert!(error.contains(says), "{text}: {error}");
        }
    }
}
