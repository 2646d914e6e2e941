//! Clip planes from JSON: `[{"name": "axial", "normal": [0, 0, 1], "d": -2.5}, ...]`.

use std::path::Path;

use glam::DVec3;
use serde::Deserialize;

use super::Plane;
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

#[derive(Deserialize)]
struct Entry {
    name: Option<String>,
    normal: [f64; 3],
    d: f64,
}

/// Loads the planes of a JSON file: a list of `{"normal": [x, y, z], "d": d}`, each with a `"name"` or without. A plane
/// keeps the points with `normal . x + d >= 0`; normals of any length are made unit vectors, and `d` goes with them.
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
    let format = |message: String| Error::format(name, message);
    let entries: Vec<Entry> =
        serde_json::from_slice(json::bare(json)).map_err(|error| format(json::explain(&error)))?;
    if entries.is_empty() {
        return Err(format(
            "there is no plane in it; export the planes again".into(),
        ));
    }
    let named = |(number, entry): (usize, Entry)| {
        let plane = Plane::new(DVec3::from(entry.normal), entry.d);
        Ok(NamedPlane {
            plane: plane.map_err(|error| format(format!("plane {number}: {error}")))?,
            name: entry.name.unwrap_or_else(|| number.to_string()),
        })
    };
    entries.into_iter().enumerate().map(named).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

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
    }

    #[test]
    fn what_is_no_list_of_planes_is_refused_with_its_place() {
        for (json, words) in [
            ("", "line 1"),
            ("{}", "line 1"),
            ("[]", "no plane"),
            ("[{\"normal\": [1, 0, 0]}]", "`d`"),
            ("[\n{\"normal\": [1, 0], \"d\": 0}]", "line 2"),
            ("[{\"normal\": [1, 0, 0], \"d\": 1e999}]", "line 1"),
            (
                "[{\"normal\": [1, 0, 0], \"d\": 0}, {\"normal\": [0, 0, 0], \"d\": 0}]",
                "plane 1: ",
            ),
            ("[{\"normal\": [1e-300, 0, 0], \"d\": 1e300}]", "overflows"),
        ] {
            let message = parse(json).unwrap_err().to_string();
            assert!(
                message.starts_with("planes.json: ") && message.contains(words),
                "{message}"
            );
        }
    }
}
