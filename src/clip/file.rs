//! Clip planes from JSON: `[{"name": "axial", "normal": [0, 0, 1], "d": -2.5}, ...]`.

use std::path::Path;

use super::{NamedClip, Plane, clips_from_json};
use crate::error::{Error, Result};
use crate::json;

/// A plane and what its file calls it.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedPlane {
    /// Its name in the file, or its number there, from 0. Several planes may share one.
    pub name: String,
    /// The plane.
    pub plane: Plane,
}

/// Loads the planes of a JSON file: a list of `{"normal": [x, y, z], "d": d}`, each with a `"name"` or without. A plane
/// keeps the points with `normal . x + d >= 0`; normals of any length are made unit vectors, and `d` goes with them. It is a
/// file of clips, as [`load_clips`](super::load_clips) reads, that are all planes.
///
/// # Errors
/// [`Error::Io`] if the file can't be read, [`Error::Format`] if it is no such list, has no plane in it, or one whose
/// normal is zero.
pub fn load_planes(path: &Path) -> Result<Vec<NamedPlane>> {
    planes_from_json(&json::read(path, "clip planes")?, path)
}

/// Like [`load_planes`] for text in memory; `name` stands for the file in messages.
///
/// # Errors
/// [`Error::Format`] as there.
pub fn planes_from_json(json: &[u8], name: &Path) -> Result<Vec<NamedPlane>> {
    let clips = clips_from_json(json, name)?.into_iter().enumerate();
    let plane = |(
        number,
        NamedClip {
            name: own, clip, ..
        },
    ): (usize, NamedClip)| match clip.as_plane() {
        Some(plane) => Ok(NamedPlane { name: own, plane }),
        None => Err(Error::format(
            name,
            format!("element {number} is no plane; leave it out, or read the file as clips"),
        )),
    };
    clips.map(plane).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn parse(json: &str) -> Result<Vec<NamedPlane>> {
        planes_from_json(json.as_bytes(), Path::new("planes.json"))
    }

    #[test]
    fn planes_are_normalised_and_named_or_numbered() {
        let planes = parse(
            "\u{feff} [{\"name\": \"axial\", \"normal\": [0, 0, 2], \"d\": -5, \"note\": null},
             {\"d\": 1e-3, \"normal\": [-1.0, 0, 0]}]",
        );
        let planes = planes.unwrap();
        let names: Vec<_> = planes.iter().map(|p| p.name.as_str()).collect();
        assert_eq!(names, ["axial", "1"]);
        assert_eq!(planes[0].plane, Plane::new(DVec3::Z, -2.5).unwrap());
        assert_eq!(planes[1].plane, Plane::new(-DVec3::X, 1e-3).unwrap());
        let tree = "[{\"clip\": {\"not\": {\"plane\": {\"normal\": [0, 0, 1], \"d\": 2}}}}]";
        let other = parse(tree).unwrap()[0].plane;
        assert_eq!(other, Plane::new(-DVec3::Z, -2.0).unwrap());
    }

    #[test]
    fn what_is_no_list_of_planes_is_refused_with_its_place() {
        for (json, words) in [
            ("", "line 1"),
            ("{}", "line 1"),
            ("[]", "there is no clip in it"),
            ("[{\"normal\": [1, 0, 0]}]", "\"d\""),
            ("[\n{\"normal\": [1, 0], \"d\": 0}]", "line 2"),
            ("[{\"normal\": [1, 0, 0], \"d\": 1e999}]", "line 1"),
            (
                "[{\"normal\": [1, 0, 0], \"d\": 0}, {\"normal\": [0, 0, 0], \"d\": 0}]",
                "element 1: ",
            ),
            ("[{\"normal\": [1e-300, 0, 0], \"d\": 1e300}]", "overflows"),
            (
                "[{\"clip\": {\"sphere\": {\"centre\": [0, 0, 0], \"radius\": 1}}}]",
                "element 0 is no plane",
            ),
        ] {
            let message = parse(json).unwrap_err().to_string();
            assert!(
                message.starts_with("planes.json: ") && message.contains(words),
                "{message}"
            );
        }
    }
}
