//! `transforms.json` of nerfstudio and instant-ngp, and `camera_path.json` of nerfstudio's viewer: OpenGL cameras, intrinsics
//! shared or frame by frame.

use glam::{DMat3, DMat4, DQuat, DVec3, DVec4};
use serde::Deserialize;

use super::rigid::affine;
use super::{Entry, Outcome, Parts, PathSettings, Pose};
use crate::clip::Shape;
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

/// Defines intrinsics, of which a file may leave out any, by their names and types.
macro_rules! intrinsics {
    ($($field:ident: $of:ty,)+) => {
        #[derive(Deserialize, Clone)]
        struct Intrinsics {
            $($field: Option<$of>,)+
        }

        impl Intrinsics {
            /// These, and the shared ones where these say nothing.
            fn or(self, shared: &Self) -> Self {
                let shared = shared.clone();
                Self {
                    $($field: self.$field.or(shared.$field),)+
                }
            }
        }
    };
}

intrinsics! {
    w: f64, h: f64, fl_x: f64, fl_y: f64, cx: f64, cy: f64, camera_angle_x: f64, camera_angle_y: f64,
    camera_model: String, is_fisheye: bool,
    k1: f64, k2: f64, k3: f64, k4: f64, k5: f64, k6: f64, p1: f64, p2: f64, distortion_params: Vec<f64>,
}

impl Intrinsics {
    /// The model of a lens that bends straight lines.
    fn distortion(&self) -> Option<String> {
        let is_fisheye = self.is_fisheye == Some(true);
        let model = self.camera_model.as_deref().unwrap_or(match is_fisheye {
            true => "OPENCV_FISHEYE",
            false => "OPENCV",
        });
        let is_straight = matches!(
            model,
            "PINHOLE" | "SIMPLE_PINHOLE" | "SIMPLE_RADIAL" | "RADIAL" | "OPENCV" | "FULL_OPENCV"
        );
        let radial = [self.k1, self.k2, self.k3, self.k4, self.k5, self.k6];
        let coefficients = radial.iter().chain([&self.p1, &self.p2]).flatten();
        let mut coefficients = coefficients.chain(self.distortion_params.iter().flatten());
        if is_straight && !is_fisheye && coefficients.all(|&k| k == 0.0) {
            return None;
        }
        let model = match model {
            "PINHOLE" | "SIMPLE_PINHOLE" => "OPENCV",
            bent => bent,
        };
        Some(model.into())
    }

    /// The camera with this pose, whatever its lens does to straight lines.
    fn pinhole(&self, rows: &[[f64; 4]], what: &str) -> Outcome {
        const NO_PINHOLES: [&str; 6] = [
            "EQUIRECTANGULAR",
            "OMNIDIRECTIONALSTEREO_L",
            "OMNIDIRECTIONALSTEREO_R",
            "VR180_L",
            "VR180_R",
            "ORTHOPHOTO",
        ];
        let model = self.camera_model.as_deref().unwrap_or_default();
        if NO_PINHOLES.contains(&model) {
            return Err(format!(
                "{what} is a camera of the model {model}, which has no pinhole; give another one"
            ));
        }
        let (size, focal) = self.size_and_focal(what)?;
        let parts = Parts {
            width: size.0,
            height: size.1,
            focal,
            centre: (self.cx, self.cy),
            pose: pose(rows, "transform_matrix", what)?,
        };
        parts.camera(what)
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
    let row = |at: usize| rows.get(at).copied().map(DVec4::from);
    let whole = match (row(0), row(1), row(2), row(3), rows.len()) {
        (Some(x), Some(y), Some(z), last, 3 | 4) => {
            let transposed = DMat4::from_cols(x, y, z, last.unwrap_or(DVec4::W));
            affine(transposed.transpose())
        }
        _ => None,
    };
    let matrix = whole.ok_or_else(|| {
        format!("the {name} of {what} is not a 4x4 matrix that ends in 0, 0, 0, 1; export the cameras again")
    })?;
    let [x, y, z] = DMat3::from_mat4(matrix).to_cols_array_2d().map(DVec3::from);
    // OpenGL's up and backward are our down and forward, turned round.
    Ok(Pose::CameraToWorld {
        axes: DMat3::from_cols(x, -y, -z),
        eye: matrix.w_axis.truncate(),
    })
}

/// A path of the viewer: a camera for each picture of a film.
#[derive(Deserialize)]
struct CameraPath {
    camera_path: Vec<PathCamera>,
    render_width: f64,
    render_height: f64,
    camera_type: Option<String>,
    fps: Option<f64>,
    seconds: Option<f64>,
    crop: Option<Crop>,
}

/// A box in the scene, outside of which nothing is drawn, and what is drawn there.
#[derive(Deserialize)]
struct Crop {
    crop_center: Option<[f64; 3]>,
    /// Its sides.
    crop_scale: Option<[f64; 3]>,
    /// Turns about x, y and z, the first one first, radians.
    crop_rot: Option<[f64; 3]>,
    /// Older files have two corners instead.
    crop_min: Option<[f64; 3]>,
    crop_max: Option<[f64; 3]>,
    crop_bg_color: Option<Rgb>,
}

/// From 0 to 255.
#[derive(Deserialize)]
struct Rgb {
    r: f64,
    g: f64,
    b: f64,
}

#[derive(Deserialize)]
struct PathCamera {
    /// Row by row.
    camera_to_world: Vec<f64>,
    /// Vertical, degrees.
    fov: f64,
}

pub(super) fn parse_path(json: &[u8]) -> Result<Vec<Entry>, String> {
    let file: CameraPath = json::parse(json)?;
    let kind = file.camera_type.as_deref().unwrap_or("perspective");
    if kind != "perspective" {
        return Err(format!(
            "its pictures are {}, and only perspective ones are drawn along a path; choose that in the viewer",
            shortened(kind)
        ));
    }
    let size = (file.render_width, file.render_height);
    let entry = |(number, camera): (usize, PathCamera)| {
        let what = format!("camera {number} of the path");
        Entry::new(number.to_string(), what, |what| camera.pinhole(size, what))
    };
    Ok(file
        .camera_path
        .into_iter()
        .enumerate()
        .map(entry)
        .collect())
}

/// What a path says of its film beside the cameras.
pub(super) fn path_settings(json: &[u8]) -> Result<PathSettings, String> {
    let file: CameraPath = json::parse(json)?;
    let frames = file.camera_path.len() as f64;
    let fps = file.fps.or(file.seconds.map(|seconds| frames / seconds));
    let colour = file
        .crop
        .as_ref()
        .and_then(|crop| crop.crop_bg_color.as_ref());
    let colour =
        colour.map(|Rgb { r, g, b }| [r, g, b].map(|ink| (ink / 255.0).clamp(0.0, 1.0) as f32));
    Ok(PathSettings {
        crop: file.crop.map(|crop| crop.shape()).transpose()?,
        background: colour,
        fps: fps.filter(|fps| *fps > 0.0 && fps.is_finite()),
    })
}

impl Crop {
    fn shape(&self) -> Result<Shape, String> {
        let (centre, sides) = match (
            self.crop_min.map(DVec3::from),
            self.crop_max.map(DVec3::from),
        ) {
            (Some(min), Some(max)) => (Some((min + max) / 2.0), Some(max - min)),
            _ => (
                self.crop_center.map(DVec3::from),
                self.crop_scale.map(DVec3::from),
            ),
        };
        let (Some(centre), Some(sides)) = (centre, sides) else {
            return Err("its crop has no crop_center and crop_scale; export the path again".into());
        };
        let [x, y, z] = self.crop_rot.unwrap_or_default();
        let turn =
            DQuat::from_rotation_z(z) * DQuat::from_rotation_y(y) * DQuat::from_rotation_x(x);
        let shape = Shape::cuboid(centre, sides / 2.0, turn);
        shape.map_err(|error| format!("its crop is not a box: {error}; export the path again"))
    }
}

impl PathCamera {
    /// The camera of a picture of this size.
    fn pinhole(&self, (width, height): Pair, what: &str) -> Outcome {
        let (rows, rest) = self.camera_to_world.as_chunks::<4>();
        if !(rest.is_empty() && self.fov > 0.0 && self.fov < 180.0) {
            return Err(format!(
                "{what} has no matrix of 16 numbers, or an angle that is not between 0 and 180 degrees; export the path again"
            ));
        }
        let focal = height / 2.0 / (self.fov.to_radians() / 2.0).tan();
        let parts = Parts {
            width,
            height,
            focal: (focal, focal),
            centre: (None, None),
            pose: pose(rows, "camera_to_world", what)?,
        };
        parts.camera(what)
    }
}

pub(super) fn parse(json: &[u8]) -> Result<Vec<Entry>, String> {
    let file: Transforms = json::parse(json)?;
    let entry = |(number, frame): (usize, TransformsFrame)| {
        let name = frame.file_path.unwrap_or_else(|| number.to_string());
        let what = format!("frame {number} (`{}`)", shortened(&name));
        let intrinsics = frame.own.or(&file.shared);
        let pinhole = |what: &str| intrinsics.pinhole(&frame.transform_matrix, what);
        Entry::new(name, what, pinhole).bent(intrinsics.distortion())
    };
    Ok(file.frames.into_iter().enumerate().map(entry).collect())
}
