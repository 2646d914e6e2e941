//! `transforms.json` of nerfstudio and instant-ngp, and `camera_path.json` of nerfstudio's viewer: OpenGL cameras, intrinsics
//! shared or frame by frame.

use glam::{DMat3, DVec3};
use serde::Deserialize;

use super::{NamedCamera, Parts, Pose};
use rara_base::error::shortened;
use rara_base::json;

/// Picture side where a file gives the angle of view alone, as the synthetic NeRF scenes do: their pictures are square.
const DEFAULT_SIDE: f64 = 1024.0;

/// Along x and along y.
type Pair = (f64, f64);

#[derive(Deserialize)]
struct Transforms {
    #[serde(flatten)]
    shared: Intrinsics,
    frames: Vec<TransformsFrame>,
}

#[derive(Deserialize)]
struct TransformsFrame {
    #[serde(flatten)]
    own: Intrinsics,
    file_path: Option<String>,
    /// Camera to world, row by row, three rows or four; the camera looks along its -z with +y up.
    transform_matrix: Vec<[f64; 4]>,
}

#[derive(Deserialize, Clone, Default)]
struct Intrinsics {
    w: Option<f64>,
    h: Option<f64>,
    fl_x: Option<f64>,
    fl_y: Option<f64>,
    cx: Option<f64>,
    cy: Option<f64>,
    camera_angle_x: Option<f64>,
    camera_angle_y: Option<f64>,
    camera_model: Option<String>,
    k1: Option<f64>,
    k2: Option<f64>,
    k3: Option<f64>,
    k4: Option<f64>,
    p1: Option<f64>,
    p2: Option<f64>,
}

impl Intrinsics {
    fn or(self, shared: &Self) -> Self {
        let shared = shared.clone();
        Self {
            w: self.w.or(shared.w),
            h: self.h.or(shared.h),
            fl_x: self.fl_x.or(shared.fl_x),
            fl_y: self.fl_y.or(shared.fl_y),
            cx: self.cx.or(shared.cx),
            cy: self.cy.or(shared.cy),
            camera_angle_x: self.camera_angle_x.or(shared.camera_angle_x),
            camera_angle_y: self.camera_angle_y.or(shared.camera_angle_y),
            camera_model: self.camera_model.or(shared.camera_model),
            k1: self.k1.or(shared.k1),
            k2: self.k2.or(shared.k2),
            k3: self.k3.or(shared.k3),
            k4: self.k4.or(shared.k4),
            p1: self.p1.or(shared.p1),
            p2: self.p2.or(shared.p2),
        }
    }

    fn check_undistorted(&self, what: &str) -> Result<(), String> {
        let model = self.camera_model.as_deref().unwrap_or("PINHOLE");
        let pinhole = matches!(
            model,
            "PINHOLE" | "SIMPLE_PINHOLE" | "SIMPLE_RADIAL" | "RADIAL" | "OPENCV" | "FULL_OPENCV"
        );
        let coefficients = [self.k1, self.k2, self.k3, self.k4, self.p1, self.p2];
        if pinhole && coefficients.iter().flatten().all(|&k| k == 0.0) {
            return Ok(());
        }
        Err(format!(
            "{what} is a {} camera with lens distortion, which a splat renderer has not; undistort the pictures \
             and export their cameras",
            shortened(model)
        ))
    }

    /// Picture size and focal lengths, from lengths or from angles.
    fn size_and_focal(&self, what: &str) -> Result<(Pair, Pair), String> {
        let angles_only = self.fl_x.is_none() && self.fl_y.is_none();
        let side = |side: Option<f64>, centre: Option<f64>, name: &str| match (side, centre) {
            (Some(side), _) => Ok(side),
            (None, Some(centre)) => Ok((2.0 * centre).round()),
            (None, None) if angles_only => Ok(DEFAULT_SIDE),
            (None, None) => Err(format!(
                "{what} has no `{name}`; add the picture's size to the file"
            )),
        };
        let (width, height) = (side(self.w, self.cx, "w")?, side(self.h, self.cy, "h")?);
        let focal = |length: Option<f64>, side: f64, angle: Option<f64>| {
            length.or_else(|| Some(side / 2.0 / (angle? / 2.0).tan()))
        };
        let x = focal(self.fl_x, width, self.camera_angle_x);
        let y = focal(self.fl_y, height, self.camera_angle_y);
        // With one of the two, pixels are square.
        match (x.or(y), y.or(x)) {
            (Some(x), Some(y)) => Ok(((width, height), (x, y))),
            _ => Err(format!(
                "{what} has neither `fl_x` nor `camera_angle_x`; add one to the file"
            )),
        }
    }
}

/// The pose of an OpenGL camera, from the rows of a matrix that the file calls `name`.
fn pose(rows: &[[f64; 4]], name: &str, what: &str) -> Result<Pose, String> {
    let whole =
        matches!(rows.len(), 3 | 4) && rows.get(3).is_none_or(|row| *row == [0.0, 0.0, 0.0, 1.0]);
    if !whole {
        return Err(format!(
            "the {name} of {what} is no rigid 4x4 matrix; export the cameras again"
        ));
    }
    let column = |i: usize| DVec3::new(rows[0][i], rows[1][i], rows[2][i]);
    // OpenGL's up and backward are our down and forward, turned round.
    Ok(Pose::CameraToWorld {
        axes: DMat3::from_cols(column(0), -column(1), -column(2)),
        eye: column(3),
    })
}

/// A path of the viewer: a camera for each picture of a film.
#[derive(Deserialize)]
struct CameraPath {
    camera_path: Vec<PathCamera>,
    render_width: f64,
    render_height: f64,
    camera_type: Option<String>,
}

#[derive(Deserialize)]
struct PathCamera {
    /// Row by row.
    camera_to_world: Vec<f64>,
    /// Vertical, degrees.
    fov: f64,
}

/// True for JSON with the viewer's list of cameras.
pub(super) fn is_path(json: &[u8]) -> bool {
    /// What stands there is looked at later.
    #[derive(Deserialize)]
    struct Any {
        #[serde(rename = "camera_path")]
        _camera_path: serde::de::IgnoredAny,
    }
    json::parse::<Any>(json).is_ok()
}

pub(super) fn parse_path(json: &[u8]) -> Result<Vec<NamedCamera>, String> {
    let file: CameraPath = json::parse(json)?;
    let kind = file.camera_type.as_deref().unwrap_or("perspective");
    if kind != "perspective" {
        return Err(format!(
            "its pictures are {}, and only perspective ones are drawn along a path; choose that in the viewer",
            shortened(kind)
        ));
    }
    let named = |(number, camera): (usize, PathCamera)| {
        let what = format!("camera {number} of the path");
        let (rows, rest) = camera.camera_to_world.as_chunks::<4>();
        if !(rest.is_empty() && camera.fov > 0.0 && camera.fov < 180.0) {
            return Err(format!(
                "{what} has no matrix of 16 numbers, or an angle that is not between 0 and 180 degrees; export the path again"
            ));
        }
        let focal = file.render_height / 2.0 / (camera.fov.to_radians() / 2.0).tan();
        let parts = Parts {
            width: file.render_width,
            height: file.render_height,
            focal: (focal, focal),
            centre: (None, None),
            pose: pose(rows, "camera_to_world", &what)?,
        };
        Ok(NamedCamera {
            name: number.to_string(),
            camera: parts.camera(&what)?,
        })
    };
    file.camera_path
        .into_iter()
        .enumerate()
        .map(named)
        .collect()
}

pub(super) fn parse(json: &[u8]) -> Result<Vec<NamedCamera>, String> {
    let file: Transforms = json::parse(json)?;
    let shared = file.shared;
    let named = |(number, frame): (usize, TransformsFrame)| {
        let name = frame.file_path.unwrap_or_else(|| number.to_string());
        let what = format!("frame {number} (`{}`)", shortened(&name));
        let intrinsics = frame.own.or(&shared);
        intrinsics.check_undistorted(&what)?;
        let (size, focal) = intrinsics.size_and_focal(&what)?;
        let parts = Parts {
            width: size.0,
            height: size.1,
            focal,
            centre: (intrinsics.cx, intrinsics.cy),
            pose: pose(&frame.transform_matrix, "transform_matrix", &what)?,
        };
        let camera = parts.camera(&what)?;
        Ok(NamedCamera { name, camera })
    };
    file.frames.into_iter().enumerate().map(named).collect()
}
