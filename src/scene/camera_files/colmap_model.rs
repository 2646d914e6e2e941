//! What a COLMAP sparse model says: intrinsics by camera, poses by picture, and the cameras that they make.

use glam::{DMat4, DQuat, DVec3};

use super::{Outcome, Parts, Pose};
use rara_base::error::shortened;

/// The lines or records of `cameras`.
pub(super) struct Lenses {
    pub(super) lenses: Vec<Lens>,
    /// Why those behind them could not be read, if there are any.
    pub(super) rest: Option<String>,
}

/// A line or record of `cameras`.
pub(super) struct Lens {
    pub(super) id: u32,
    /// Or the name of one that we do not know.
    pub(super) model: std::result::Result<&'static Model, String>,
    pub(super) width: f64,
    pub(super) height: f64,
    /// Those of a model that we know.
    pub(super) parameters: Vec<f64>,
}

/// A line or record of `images`.
pub(super) struct ColmapImage {
    pub(super) name: String,
    pub(super) lens: u32,
    /// World to camera.
    pub(super) rotation: DQuat,
    pub(super) translation: DVec3,
}

/// One of COLMAP's camera models.
pub(super) struct Model {
    pub(super) name: &'static str,
    pub(super) parameters: usize,
    /// One focal length for both axes.
    shared_focal: bool,
    /// Straight lines stay straight when the parameters after the principal point are zero.
    straight: bool,
}

const fn model(name: &'static str, parameters: usize, shared_focal: bool, straight: bool) -> Model {
    Model {
        name,
        parameters,
        shared_focal,
        straight,
    }
}

/// By COLMAP's number of the model.
pub(super) const MODELS: [Model; 17] = [
    model("SIMPLE_PINHOLE", 3, true, true),
    model("PINHOLE", 4, false, true),
    model("SIMPLE_RADIAL", 4, true, true),
    model("RADIAL", 5, true, true),
    model("OPENCV", 8, false, true),
    model("OPENCV_FISHEYE", 8, false, false),
    model("FULL_OPENCV", 12, false, true),
    model("FOV", 5, false, true),
    model("SIMPLE_RADIAL_FISHEYE", 4, true, false),
    model("RADIAL_FISHEYE", 5, true, false),
    model("THIN_PRISM_FISHEYE", 12, false, false),
    model("RAD_TAN_THIN_PRISM_FISHEYE", 16, false, false),
    model("SIMPLE_DIVISION", 4, true, true),
    model("DIVISION", 5, false, true),
    model("SIMPLE_FISHEYE", 3, true, false),
    model("FISHEYE", 4, false, false),
    model("EUCM", 6, false, false),
];

impl Lens {
    /// The name of the model, if it bends straight lines.
    pub(super) fn distortion(&self) -> Option<&'static str> {
        let model = self.model.as_ref().ok()?;
        let focal_and_centre = if model.shared_focal { 3 } else { 4 };
        let mut distortion = self.parameters[focal_and_centre..].iter();
        let is_straight = model.straight && distortion.all(|&k| k == 0.0);
        (!is_straight).then_some(model.name)
    }

    /// The camera of a picture, whatever its lens does to straight lines.
    pub(super) fn camera(&self, image: &ColmapImage, picture: &str) -> Outcome {
        let model = self.model.as_ref().map_err(|name| {
            format!(
                "{picture} was taken with camera {} of the model {}, which is not known; undistort the pictures where the model is \
                 from, and give their cameras",
                self.id,
                shortened(name)
            )
        })?;
        let p = &self.parameters;
        let (focal, centre) = match model.shared_focal {
            true => ((p[0], p[0]), &p[1..]),
            false => ((p[0], p[1]), &p[2..]),
        };
        let length = image.rotation.length();
        if !(length.is_finite() && length > 1e-6) {
            return Err(format!(
                "{picture} has no valid rotation; export the model again"
            ));
        }
        let parts = Parts {
            width: self.width,
            height: self.height,
            focal,
            centre: (Some(centre[0]), Some(centre[1])),
            pose: Pose::WorldToCamera(DMat4::from_rotation_translation(
                image.rotation / length,
                image.translation,
            )),
        };
        let mut camera = parts.camera(picture)?;
        if (length - 1.0).abs() > 1e-3 {
            let repair = format!("its quaternion is {length:.6} long and is made a rotation");
            camera.repairs.push(repair);
        }
        Ok(camera)
    }
}
