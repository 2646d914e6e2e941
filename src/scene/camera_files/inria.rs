//! `cameras.json`, as 3DGS training writes it beside its output.

use glam::{DMat3, DVec3};
use serde::Deserialize;

use super::{Entry, Parts, Pose};
use rara_base::error::shortened;
use rara_base::json;

#[derive(Deserialize)]
struct CameraRecord {
    #[serde(default)]
    id: serde_json::Value,
    img_name: Option<String>,
    width: f64,
    height: f64,
    /// The camera's position.
    position: DVec3Json,
    /// Camera to world, row by row: the columns are the camera's right, down and forward axes.
    rotation: [DVec3Json; 3],
    fx: f64,
    fy: f64,
    cx: Option<f64>,
    cy: Option<f64>,
}

type DVec3Json = [f64; 3];

pub(super) fn parse(json: &[u8]) -> Result<Vec<Entry>, String> {
    let entries: Vec<CameraRecord> = json::parse(json)?;
    let named = |(number, entry): (usize, CameraRecord)| {
        let name = entry.img_name.unwrap_or_else(|| match &entry.id {
            serde_json::Value::Null => number.to_string(),
            id => id.to_string(),
        });
        let [x, y, z] = entry.rotation.map(DVec3::from);
        let parts = Parts {
            width: entry.width,
            height: entry.height,
            focal: (entry.fx, entry.fy),
            centre: (entry.cx, entry.cy),
            pose: Pose::CameraToWorld {
                axes: DMat3::from_cols(x, y, z).transpose(),
                eye: entry.position.into(),
            },
        };
        let what = format!("camera {number} (`{}`)", shortened(&name));
        Entry::new(name, what, |what| parts.camera(what))
    };
    Ok(entries.into_iter().enumerate().map(named).collect())
}
