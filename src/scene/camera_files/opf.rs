//! Calibrated cameras of Pix4D's Open Photogrammetry Format: `project.opf`, which names files of sensors, poses and pictures.

use std::collections::HashMap;
use std::path::Path;

use glam::{DMat3, DVec3};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

use super::{Entry, Outcome, Parts, Pose};
use rara_base::error::{Error, Result, shortened};
use rara_base::json;

#[derive(Deserialize)]
struct Project {
    #[serde(default)]
    items: Vec<Item>,
}

#[derive(Deserialize)]
struct Item {
    #[serde(default)]
    resources: Vec<Resource>,
}

#[derive(Deserialize)]
struct Resource {
    uri: String,
    format: String,
}

#[derive(Deserialize)]
struct Calibrated {
    sensors: Vec<Sensor>,
    cameras: Vec<Calibration>,
}

#[derive(Deserialize)]
struct Sensor {
    id: Value,
    internals: Option<Internals>,
    image_size_px: Option<[f64; 2]>,
}

#[derive(Deserialize, Clone)]
struct Internals {
    r#type: String,
    principal_point_px: Option<[f64; 2]>,
    /// Of perspective sensors.
    focal_length_px: Option<f64>,
    #[serde(default)]
    radial_distortion: Vec<f64>,
    #[serde(default)]
    tangential_distortion: Vec<f64>,
    /// Of fisheyes, row by row: pixels of an angle.
    affine: Option<[f64; 4]>,
}

#[derive(Deserialize)]
struct Calibration {
    id: Value,
    sensor_id: Value,
    position: [f64; 3],
    /// Omega, phi and kappa: turns about x, y and z, the last one first, from the camera's right, up and back to the world.
    orientation_deg: [f64; 3],
}

#[derive(Deserialize)]
struct InputCameras {
    sensors: Vec<Sensor>,
}

#[derive(Deserialize)]
struct CameraList {
    cameras: Vec<Listed>,
}

#[derive(Deserialize)]
struct Listed {
    id: Value,
    uri: String,
}

/// The cameras of a project, whose files lie where it says, and what it is called in messages.
pub(super) fn load(json: &[u8], path: &Path) -> Result<Vec<Entry>> {
    let wrong = |message: String| Error::format(path, message);
    let project: Project = json::parse(json).map_err(wrong)?;
    let resources: Vec<_> = project
        .items
        .into_iter()
        .flat_map(|item| item.resources)
        .collect();
    let calibrated =
        part::<Calibrated>(&resources, "calibrated-cameras", path)?.ok_or_else(|| {
            wrong(
                "this is a project of Pix4D without calibrated cameras; export it once they are"
                    .into(),
            )
        })?;
    let input = part::<InputCameras>(&resources, "input-cameras", path)?;
    let list = part::<CameraList>(&resources, "camera-list", path)?;
    let sizes = input.map_or(Vec::new(), |input| input.sensors);
    let names = list.map_or(Vec::new(), |list| list.cameras);
    Ok(calibrated.entries(&sizes, &names))
}

/// The file of a project that has this format; none where it names none.
fn part<T: DeserializeOwned>(
    resources: &[Resource],
    format: &str,
    project: &Path,
) -> Result<Option<T>> {
    let format = format!("application/opf-{format}+json");
    let Some(resource) = resources.iter().find(|one| one.format == format) else {
        return Ok(None);
    };
    let folder = project.parent().unwrap_or(Path::new(""));
    let file = folder.join(&resource.uri);
    if !file.is_file() {
        let message = format!(
            "this project of Pix4D names {}, which is not in its folder; put it there, or export the project again",
            shortened(&resource.uri)
        );
        return Err(Error::format(project, message));
    }
    let parsed = json::parse(json::bare(&json::read(&file, "cameras")?));
    parsed
        .map(Some)
        .map_err(|message| Error::format(&file, message))
}

/// The cameras of a file of calibrated cameras alone.
pub(super) fn parse(json: &[u8]) -> std::result::Result<Vec<Entry>, String> {
    Ok(json::parse::<Calibrated>(json)?.entries(&[], &[]))
}

impl Calibrated {
    fn entries(self, sizes: &[Sensor], names: &[Listed]) -> Vec<Entry> {
        let sizes: HashMap<String, [f64; 2]> = sizes
            .iter()
            .filter_map(|sensor| Some((sensor.id.to_string(), sensor.image_size_px?)))
            .collect();
        let names: HashMap<String, &str> = names
            .iter()
            .map(|one| (one.id.to_string(), one.uri.as_str()))
            .collect();
        let sensors: HashMap<String, Sensor> = self
            .sensors
            .into_iter()
            .map(|sensor| (sensor.id.to_string(), sensor))
            .collect();
        let entry = |camera: Calibration| {
            let id = camera.id.to_string();
            let name = names.get(&id).map_or(id, |name| (*name).to_owned());
            let what = format!("the camera `{}`", shortened(&name));
            let sensor = camera.sensor_id.to_string();
            let internals = sensors
                .get(&sensor)
                .and_then(|sensor| sensor.internals.as_ref());
            let pinhole = |what: &str| match internals {
                Some(internals) => internals.pinhole(sizes.get(&sensor), &camera, what),
                None => Err(format!(
                    "{what} has no sensor that the file lists; export the project again"
                )),
            };
            Entry::new(name, what, pinhole).bent(internals.and_then(Internals::distortion))
        };
        self.cameras.into_iter().map(entry).collect()
    }
}

impl Internals {
    /// What a lens that bends straight lines is called.
    fn distortion(&self) -> Option<String> {
        let mut bends = self
            .radial_distortion
            .iter()
            .chain(&self.tangential_distortion);
        let is_straight = self.r#type == "perspective" && bends.all(|&k| k == 0.0);
        (!is_straight).then(|| self.r#type.clone())
    }

    fn pinhole(&self, size: Option<&[f64; 2]>, camera: &Calibration, what: &str) -> Outcome {
        let focal = match self.affine {
            Some([x, _, _, y]) => Some((x, y)),
            None => self.focal_length_px.map(|focal| (focal, focal)),
        };
        let (Some(focal), Some(centre)) = (focal, self.principal_point_px) else {
            return Err(format!(
                "{what} is of a {} sensor, which has no pinhole; give another one",
                shortened(&self.r#type)
            ));
        };
        let [width, height] = size.copied().unwrap_or(centre.map(|at| (2.0 * at).round()));
        let [omega, phi, kappa] = camera.orientation_deg.map(f64::to_radians);
        let turn = DMat3::from_rotation_x(omega)
            * DMat3::from_rotation_y(phi)
            * DMat3::from_rotation_z(kappa);
        let parts = Parts {
            width,
            height,
            focal,
            centre: (Some(centre[0]), Some(centre[1])),
            pose: Pose::CameraToWorld {
                axes: turn * DMat3::from_diagonal(DVec3::new(1.0, -1.0, -1.0)),
                eye: camera.position.into(),
            },
        };
        let mut camera = parts.camera(what)?;
        if size.is_none() {
            let repair = "its picture, whose size the file does not say, is taken to be twice as large as its principal point is far from its corner";
            camera.repairs.push(repair.into());
        }
        Ok(camera)
    }
}
