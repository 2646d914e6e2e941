//! nerfstudio trains in a world of its own, which it turns, moves and scales: `dataparser_transforms.json` says how. Cameras of
//! its `transforms.json` stand in the world before that, and are brought to where the Gaussians are.

use std::path::Path;

use glam::{DMat3, DVec3};
use rara::camera_files::NamedCamera;
use rara::{Camera, Error, Result};
use rara_base::json;
use serde::Deserialize;
use serde::de::DeserializeOwned;

use super::json_kind;

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
struct Move {
    axes: DMat3,
    shift: DVec3,
    scale: f64,
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

    fn camera(&self, camera: &Camera) -> Camera {
        camera
            .eye(self.scale * (self.axes * camera.eye + self.shift))
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
    json_kind::parsed(path, &json::read(path, "transforms")?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_applied_before_is_not_applied_again() {
        // A quarter turn about z, and a step; both files say it, so that only the scale is left.
        let rows = [
            [0.0, -1.0, 0.0, 3.0],
            [1.0, 0.0, 0.0, 4.0],
            [0.0, 0.0, 1.0, 5.0],
        ];
        let transforms = Transforms {
            transform: rows,
            scale: 0.5,
        };
        let applied = |applied_transform| DataparserTransform {
            applied_transform,
            applied_scale: None,
        };
        let camera =
            Camera::look_at(DVec3::X, DVec3::ZERO, DVec3::NEG_Y, 50.0, (8, 8)).expect("a camera");
        let same = Move::new(&transforms, &applied(Some(rows)))
            .expect("rigid")
            .camera(&camera);
        assert!(same.eye.abs_diff_eq(0.5 * DVec3::X, 1e-12) && same.rotation == camera.rotation);
        let moved = Move::new(&transforms, &applied(None))
            .expect("rigid")
            .camera(&camera);
        assert!(
            moved
                .eye
                .abs_diff_eq(0.5 * DVec3::new(3.0, 5.0, 5.0), 1e-12)
        );
        // It looked along -x, which has become -y.
        assert!(moved.rotation.row(2).abs_diff_eq(DVec3::NEG_Y, 1e-12));
        assert!(rigid(&[[2.0; 4]; 3]).is_none());
    }
}
