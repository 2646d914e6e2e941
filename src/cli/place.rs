//! `--place`: where layers stand, in place of what their list says.

use glam::{DQuat, DVec3};
use rara::Placement;

use super::failure::Failure;
use super::scene_layers::SceneLayers;
use super::values;

/// Does what the flags say, each in place of what was said of its layers before.
pub(super) fn apply(texts: &[String], loaded: &mut SceneLayers) -> Result<(), Failure> {
    for text in texts {
        let Some(at) = loaded.end_of_name(text) else {
            let placement = of_flag(text, text)?;
            for layer in &mut loaded.layers {
                layer.state = layer.state.placement(placement);
            }
            continue;
        };
        let (name, parts) = (&text[..at], &text[at + 1..]);
        let placement = of_flag(text, parts)?;
        for layer in loaded.named("--place", name)? {
            layer.state = layer.state.placement(placement);
        }
    }
    Ok(())
}

fn of_flag(flag: &str, parts: &str) -> Result<Placement, Failure> {
    placement(parts).map_err(|error| Failure::Usage(format!("--place {flag}: {error}")))
}

/// A placement of its parts, in any order and each once at most: the layer is scaled, then turned, then moved.
fn placement(text: &str) -> Result<Placement, String> {
    const FORMS: &str =
        "move:X,Y,Z, turn:X,Y,Z,DEGREES or rotation:W,X,Y,Z, and scale:S, with blanks between them";
    let (mut position, mut turn, mut scale) = (None, None, None);
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
                let [by] = values::numbers::<1>(numbers).map_err(of_part)?;
                scale.replace(by).is_some()
            }
            _ => return Err(format!("'{part}' is none of {FORMS}")),
        };
        if is_second {
            return Err(format!(
                "{part} comes second; a layer has one move, one turn and one scale"
            ));
        }
    }
    if position.is_none() && turn.is_none() && scale.is_none() {
        return Err(format!("expected {FORMS}"));
    }
    Placement::new(
        position.unwrap_or(DVec3::ZERO),
        turn.unwrap_or(DQuat::IDENTITY),
        scale.unwrap_or(1.0),
    )
    .map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_make_a_placement_in_any_order() {
        let made = placement("move:1,2,3 turn:0,0,1,90 scale:2").expect("a placement");
        assert_eq!(placement("scale:2 turn:0,0,1,90 move:1,2,3"), Ok(made));
        assert!((made.to_world(DVec3::X) - DVec3::new(1.0, 4.0, 3.0)).length() < 1e-12);
        let half = placement("rotation:0,0,0,2").expect("a placement");
        assert!((half.to_world(DVec3::X) + DVec3::X).length() < 1e-12);
        assert_eq!(placement("turn:0,0,5,180"), Ok(half));
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
            ("rotation:0,0,0,0", "rotation"),
        ] {
            let error = placement(text).expect_err(text);
            assert!(error.contains(says), "{text}: {error}");
        }
    }
}
