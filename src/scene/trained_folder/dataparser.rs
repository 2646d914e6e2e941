//! nerfstudio trains in a world of its own, which it turns, moves and scales: `dataparser_transforms.json` says how. Cameras of
//! its `transforms.json` stand in the world before that, and are brought to where the Gaussians are.

use std::path::Path;

use glam::{DMat3, DVec3};
use rara_base::error::{Error, Result};
use rara_base::json;
use serde::Deserialize;
use serde::de::DeserializeOwned;

use crate::camera::Camera;
use crate::camera_files::NamedCamera;

/// Three rows of a rigid matrix.
type Rows = [[f64; 4]; 3];

#[derive(Deserialize)]
struct Transforms {
    transform: Rows,
    scale: f64,
}

/// What has been done to the cameras of a `transforms.json` already, and is part of the other file too.
#[derive(Deserialize)]
struct DataparserTransform {
    applied_transform: Option<Rows>,
    applied_scale: Option<f64>,
}

/// The way from the world of the cameras to that of the Gaussians: scale (axes p + shift).
#[derive(Debug, Clone, Copy)]
pub(super) struct Move {
    pub(super) axes: DMat3,
    pub(super) shift: DVec3,
    pub(super) scale: f64,
}

/// The cameras of the file `of`, a `transforms.json`, where the file `by` puts them.
pub(super) fn place(cameras: Vec<NamedCamera>, of: &Path, by: &Path) -> Result<Vec<NamedCamera>> {
    let (transforms, applied) = (read::<Transforms>(by)?, read::<DataparserTransform>(of)?);
    let way = Move::new(&transforms, &applied).ok_or_else(|| {
        Error::format(by, "its transform and scale, or the applied ones of transforms.json, turn, move and scale nothing; \
             train again, or take this file away")
    })?;
    let placed = |named: NamedCamera| named.placed(|camera| way.camera(&camera));
    Ok(cameras.into_iter().map(placed).collect())
}

impl Move {
    /// `None` where the matrices are not rigid or the scale is none.
    fn new(transforms: &Transforms, applied: &DataparserTransform) -> Option<Self> {
        const NOTHING: Rows = [
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
        ];
        let (axes, shift) = rigid(&transforms.transform)?;
        let (before, start) = rigid(applied.applied_transform.as_ref().unwrap_or(&NOTHING))?;
        let axes = axes * before.transpose();
        let scale = transforms.scale / applied.applied_scale.unwrap_or(1.0);
        (scale > 0.0 && scale.is_finite()).then_some(Self {
            axes,
            shift: shift - axes * start,
            scale,
        })
    }

    pub(super) fn point(&self, point: DVec3) -> DVec3 {
        self.scale * (self.axes * point + self.shift)
    }

    pub(super) fn camera(&self, camera: &Camera) -> Camera {
        camera
            .eye(self.point(camera.eye))
            .rotation(camera.rotation * self.axes.transpose())
    }
}

/// The rotation and the translation of a rigid matrix.
fn rigid(rows: &Rows) -> Option<(DMat3, DVec3)> {
    let column = |at: usize| DVec3::new(rows[0][at], rows[1][at], rows[2][at]);
    let axes = DMat3::from_cols(column(0), column(1), column(2));
    // nerfstudio writes single precision.
    let is_rotation =
        (axes * axes.transpose()).abs_diff_eq(DMat3::IDENTITY, 1e-4) && axes.determinant() > 0.0;
    (is_rotation && column(3).is_finite()).then_some((axes, column(3)))
}

fn read<T: DeserializeOwned>(path: &Path) -> Result<T> {
    let text = json::read(path, "transforms")?;
    json::parse(json::bare(&text)).map_err(|message| Error::format(path, message))
}

#[cfg(test)]
mod tests;
