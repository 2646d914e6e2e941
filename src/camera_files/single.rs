//! Our own file of one camera: the matrix as a renderer has it.

use glam::{DMat4, DVec4};
use serde::Deserialize;

use super::{Parts, Pose};
use crate::camera::{Camera, Projection};
use crate::json;

#[derive(Deserialize)]
struct Single {
    width: f64,
    height: f64,
    fx: f64,
    fy: f64,
    cx: Option<f64>,
    cy: Option<f64>,
    /// Row by row.
    world_to_camera: [f64; 16],
    #[serde(default)]
    projection: Name,
}

#[derive(Deserialize, Default)]
#[serde(rename_all = "lowercase")]
enum Name {
    #[default]
    Perspective,
    Orthographic,
}

pub(super) fn parse(json: &[u8]) -> Result<Camera, String> {
    let single: Single = json::parse(json)?;
    let matrix = DMat4::from_cols_array(&single.world_to_camera).transpose();
    if matrix.row(3) != DVec4::W {
        return Err(
            "the last row of world_to_camera is not 0, 0, 0, 1; write the matrix row by row".into(),
        );
    }
    let parts = Parts {
        width: single.width,
        height: single.height,
        focal: (single.fx, single.fy),
        centre: (single.cx, single.cy),
        pose: Pose::WorldToCamera(matrix),
    };
    let projection = match single.projection {
        Name::Perspective => Projection::Perspective,
        Name::Orthographic => Projection::Orthographic,
    };
    Ok(parts.camera("the camera")?.projection(projection))
}
