//! Finds the direction that is up in the pictures of scenes.

use std::path::PathBuf;

use glam::DVec3;
use rara::scene::trained_folder;
use rara_shots::UP;

use super::output;

/// The direction that is up in a picture that frames these scenes: the one that is `chosen`, or that a file states, or that of the
/// cameras beside one, or -y, as in COLMAP's worlds, and in those of formats that say what is up, which are turned as they are
/// read. It comes with a note where it may be another.
pub(super) fn up_of(chosen: Option<DVec3>, scenes: &[PathBuf]) -> (DVec3, Option<String>) {
    let usual = |up: DVec3| up.dot(UP) > 0.9;
    if let Some(up) = chosen {
        return (up, None);
    }
    if let Some(up) = trained_folder::stated_up(scenes) {
        let note = format!(
            "note: up is {}, as the scene's file says; --up takes another direction",
            direction_text(up)
        );
        return (up, (!usual(up)).then_some(note));
    }
    if let Some(common) = trained_folder::up_of_cameras(scenes) {
        for note in common.notes {
            output::say(format_args!("note: {note}"));
        }
        let up = common.direction;
        let note = format!(
            "note: up is {}, the mean of the cameras in {}; --up takes another direction",
            direction_text(up),
            common.file.display()
        );
        return (up, (!usual(up)).then_some(note));
    }
    let says_what_is_up = |scene: &PathBuf| {
        let ending = scene.extension().and_then(|ending| ending.to_str());
        let ending = ending.unwrap_or_default().to_ascii_lowercase();
        ["spz", "glb", "gltf"].contains(&&ending[..])
    };
    let note = "note: up is -y; if the picture is upside down, give --up y; if it lies on its side, --up z";
    let is_known = scenes.iter().all(says_what_is_up);
    (UP, (!is_known).then(|| note.into()))
}

/// A direction as --up takes it: the axis that it is near, or its numbers.
pub(super) fn direction_text(direction: DVec3) -> String {
    let axes = [("x", DVec3::X), ("y", DVec3::Y), ("z", DVec3::Z)];
    let near = axes
        .iter()
        .find(|(_, axis)| direction.dot(*axis).abs() > 0.9);
    match near {
        Some((name, axis)) if direction.dot(*axis) > 0.0 => (*name).into(),
        Some((name, _)) => format!("-{name}"),
        None => {
            let DVec3 { x, y, z } = direction;
            format!("{x:.2},{y:.2},{z:.2}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_named_by_their_axis() {
        for (direction, text) in [
            (DVec3::Y, "y"),
            (DVec3::new(0.1, -0.99, 0.0), "-y"),
            (DVec3::Z, "z"),
            (DVec3::new(0.6, -0.8, 0.0), "0.60,-0.80,0.00"),
        ] {
            assert_eq!(direction_text(direction), text);
        }
    }
}
