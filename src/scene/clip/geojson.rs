//! Polygons from GeoJSON files, whose coordinates are those of the scene.

use std::path::Path;

use ::geojson::{GeoJson, GeometryValue, PolygonType};
use glam::DVec2;

use super::prism::{Prism, head};
use rara_base::error::{Error, Result};
use rara_base::json;

/// Reads the text that follows `polygon:` if it names a file: `FILE`, across z, or `AXIS;FILE`, where the head is as before corners.
/// There is one prism at least.
pub(super) fn of_file(text: &str) -> Option<Result<Vec<Prism>>> {
    let (before, file) = text.rsplit_once(';').unwrap_or(("z", text));
    let path = Path::new(file.trim());
    let ending = path.extension()?.to_ascii_lowercase();
    (ending == "geojson" || ending == "json").then(|| prisms(before, path))
}

fn prisms(before: &str, path: &Path) -> Result<Vec<Prism>> {
    let (base, heights, _) = head(before)?;
    let format = |message: String| Error::format(path, message);
    let text = json::read(path, "polygons")?;
    let document: GeoJson = serde_json::from_slice(json::bare(&text))
        .map_err(|error| format(format!("this is not GeoJSON ({error})")))?;
    let mut prisms = Vec::new();
    let mut add = |polygon: PolygonType| {
        let number = prisms.len() + 1;
        let of_polygon = |error: Error| format(format!("polygon {number}: {error}"));
        let corner = |position: &::geojson::Position| match position.as_slice() {
            [x, y, ..] => Ok(DVec2::new(*x, *y)),
            _ => Err(of_polygon(Error::Invalid(
                "a corner has fewer than two numbers".into(),
            ))),
        };
        let ring = |ring: &Vec<_>| ring.iter().map(corner).collect::<Result<Vec<_>>>();
        let rings = polygon.iter().map(ring).collect::<Result<Vec<_>>>()?;
        prisms.push(Prism::new(base.clone(), &rings, heights).map_err(of_polygon)?);
        Ok(())
    };
    for geometry in geometries(document) {
        match geometry {
            GeometryValue::Polygon { coordinates } => add(coordinates)?,
            GeometryValue::MultiPolygon { coordinates } => {
                coordinates.into_iter().try_for_each(&mut add)?;
            }
            other => {
                return Err(format(format!(
                    "it holds a {}, which has no inside; leave polygons alone in it",
                    other.type_name()
                )));
            }
        }
    }
    match prisms.is_empty() {
        true => Err(format("there is no polygon in it".into())),
        false => Ok(prisms),
    }
}

/// The geometries of a document, those of collections one by one.
fn geometries(document: GeoJson) -> Vec<GeometryValue> {
    let mut left = match document {
        GeoJson::Geometry(geometry) => vec![geometry.value],
        GeoJson::Feature(feature) => feature.geometry.map(|one| one.value).into_iter().collect(),
        GeoJson::FeatureCollection(all) => {
            let geometry = |feature: ::geojson::Feature| Some(feature.geometry?.value);
            all.features.into_iter().filter_map(geometry).collect()
        }
    };
    left.reverse();
    let mut all = Vec::new();
    while let Some(one) = left.pop() {
        match one {
            GeometryValue::GeometryCollection { geometries } => {
                left.extend(geometries.into_iter().rev().map(|one| one.value));
            }
            one => all.push(one),
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clip::Expression;

    fn read(name: &str, text: &str, before: &str) -> Result<Expression> {
        let path = std::env::temp_dir().join(format!("rara-{}-{name}.geojson", std::process::id()));
        std::fs::write(&path, text).unwrap();
        let read = format!("{before}{}", path.display()).parse();
        std::fs::remove_file(&path).unwrap();
        read
    }

    #[test]
    fn polygons_are_those_of_their_corners() {
        let square = r#"{"type": "Polygon", "coordinates": [[[0, 0, 7], [2, 0], [2, 2], [0, 2], [0, 0]],
            [[0.5, 0.5], [1, 0.5], [1, 1], [0.5, 0.5]]]}"#;
        let same = "polygon:z=0..4;0,0;2,0;2,2;0,2;0,0|0.5,0.5;1,0.5;1,1;0.5,0.5";
        let one = read("square", square, "polygon:z=0..4;").unwrap();
        assert_eq!(one, same.parse().unwrap());
        let feature = format!(
            r#"{{"type": "FeatureCollection", "features": [
            {{"type": "Feature", "properties": {{"name": "plot"}}, "geometry": {square}}},
            {{"type": "Feature", "properties": null, "geometry": {{"type": "MultiPolygon", "coordinates":
            [[[[5, 5], [6, 5], [6, 6], [5, 5]]], [[[8, 8], [9, 8], [9, 9], [8, 8]]]]}}}},
            {{"type": "Feature", "properties": null, "geometry": null}}]}}"#
        );
        let several = read("features", &feature, "polygon:").unwrap().to_string();
        let parts = [
            "polygon:z;0,0;2,0;2,2;0,2;0,0|0.5,0.5;1,0.5;1,1;0.5,0.5",
            "polygon:z;5,5;6,5;6,6;5,5",
            "polygon:z;8,8;9,8;9,9;8,8",
        ];
        assert_eq!(several, format!("any({})", parts.join(", ")));
    }

    #[test]
    fn what_is_no_polygon_is_said_with_its_file() {
        for (name, text, says) in [
            ("words", "no", "this is not GeoJSON (expected"),
            (
                "point",
                r#"{"type": "Point", "coordinates": [1, 2]}"#,
                "it holds a Point",
            ),
            (
                "empty",
                r#"{"type": "FeatureCollection", "features": []}"#,
                "no polygon in it",
            ),
            (
                "crossed",
                r#"{"type": "Polygon", "coordinates": [[[0, 0], [1, 1], [1, 0], [0, 1]]]}"#,
                "polygon 1: a polygon has edges that cross",
            ),
        ] {
            let error = read(name, text, "polygon:x;").unwrap_err().to_string();
            assert!(error.contains(says) && error.contains(name), "{error}");
        }
        let missing = "polygon:/nowhere/plot.geojson".parse::<Expression>();
        let missing = missing.unwrap_err().to_string();
        assert!(missing.contains("/nowhere/plot.geojson"), "{missing}");
    }
}
