//! Folders that training leaves: the scene in them, and the cameras and settings beside it. 3DGS, gsplat, nerfstudio,
//! LichtFeld and Brush are known.
//!
//! A scene is named by its file or its folder. Nothing is beside `-`, as programs call standard input.

mod dataparser;
mod gsplat;

use std::fs;
use std::path::{Path, PathBuf};

use glam::DVec3;
use rara_base::error::{Error, Result};

use crate::camera::Camera;
use crate::camera_files::{self, NamedCamera};
use crate::formats::SOG_DOCUMENTS;

/// The scene in a folder that training has left, if it is one: the one of most steps, or what was exported.
///
/// # Errors
/// [`Error::Format`] if the folder has a checkpoint alone, with the command that exports it.
pub fn scene_in(folder: &Path) -> Result<Option<PathBuf>> {
    /// Where programs put scenes, and what they call the one of so many steps: gsplat, 3DGS, LichtFeld and Brush.
    const OF_STEPS: [(&str, &str); 6] = [
        ("point_cloud", "iteration_"),
        ("", "iteration_"),
        ("ply", "point_cloud_"),
        ("", "point_cloud_"),
        ("", "splat_"),
        ("", "export_"),
    ];
    const EXPORTED: [&str; 3] = ["splat.ply", "exports/splat/splat.ply", "point_cloud.ply"];
    const CHECKPOINTS: [(&str, &str); 2] = [
        (
            "nerfstudio_models",
            "only nerfstudio reads; export them into this folder: \
             ns-export gaussian-splat --load-config config.yml --output-dir .",
        ),
        (
            "ckpts",
            "only gsplat reads; train again, or go on from it, with --save_ply, which writes them into the folder ply",
        ),
    ];
    let is_sog = SOG_DOCUMENTS.iter().any(|name| folder.join(name).is_file());
    if is_sog || !folder.is_dir() {
        return Ok(None);
    }
    let of_steps = OF_STEPS.iter().flat_map(|(inner, begin)| {
        let entries = fs::read_dir(folder.join(inner)).into_iter().flatten();
        entries.flatten().filter_map(move |entry| {
            let name = entry.file_name();
            let rest = name.to_str()?.strip_prefix(begin)?;
            let number: u64 = rest.strip_suffix(".ply").unwrap_or(rest).parse().ok()?;
            let whole = entry.path();
            let file = match whole.is_dir() {
                true => whole.join("point_cloud.ply"),
                false => whole,
            };
            let is_scene = file.is_file() && file.extension().is_some_and(|ending| ending == "ply");
            is_scene.then_some((number, file))
        })
    });
    if let Some((_, last)) = of_steps.max_by_key(|(number, _)| *number) {
        return Ok(Some(last));
    }
    let exported = EXPORTED.map(|name| folder.join(name));
    if let Some(exported) = exported.into_iter().find(|file| file.is_file()) {
        return Ok(Some(exported));
    }
    for (inner, reader) in CHECKPOINTS {
        if folder.join(inner).is_dir() {
            let message = format!("the Gaussians are in a checkpoint that {reader}");
            return Err(Error::format(folder, message));
        }
    }
    Ok(None)
}

/// The folders in which files about a scene may be, the nearest first; none of standard input's.
fn around(scene: &Path) -> Vec<PathBuf> {
    if scene == Path::new("-") {
        return Vec::new();
    }
    if scene.is_dir() {
        return vec![scene.to_owned()];
    }
    let absolute = std::path::absolute(scene).unwrap_or_else(|_| scene.to_owned());
    let folder = absolute.parent();
    let above = folder.and_then(Path::parent);
    // In a 3DGS output the scene is two folders deep, point_cloud/iteration_N, and in one of nerfstudio it may be.
    let is_inner = |above: &&Path| above.ends_with("point_cloud") || above.ends_with("exports");
    let output = above.filter(is_inner).and_then(Path::parent);
    // gsplat's are in a folder of their own.
    let of_gsplat = above.filter(|_| folder.is_some_and(|folder| folder.ends_with("ply")));
    let all = [folder, output, of_gsplat].into_iter().flatten();
    all.map(Path::to_owned).collect()
}

/// The file of that name that is nearest to a scene.
pub fn beside(scene: &Path, name: &str) -> Option<PathBuf> {
    let files = around(scene).into_iter().map(|folder| folder.join(name));
    files.into_iter().find(|file| file.is_file())
}

/// The file of this name that is nearest to a scene, and its settings, `key:value` or `key=value` without blanks and quotes.
fn settings(scene: &Path, name: &str) -> Option<(PathBuf, Vec<String>)> {
    /// The longest file that is searched.
    const MOST_BYTES: u64 = 1 << 20;
    let file = beside(scene, name)?;
    let is_short = fs::metadata(&file).is_ok_and(|metadata| metadata.len() <= MOST_BYTES);
    let text = fs::read(&file).ok().filter(|_| is_short)?;
    let text = String::from_utf8_lossy(&text);
    // cfg_args is one line of many settings, the others have a line for each.
    let settings = text.split([',', '(', ')', '\n']).map(|setting| {
        let signs = setting
            .chars()
            .filter(|c| !c.is_whitespace() && *c != '\'' && *c != '"');
        signs.collect()
    });
    let settings = settings.collect();
    Some((file, settings))
}

/// The file beside a scene whose settings say that it was trained antialiased: `cfg_args` of 3DGS, `config.yml` of nerfstudio
/// or `cfg.yml` of gsplat.
pub fn antialiased_by(scene: &Path) -> Option<PathBuf> {
    const SAYINGS: [(&str, &str); 3] = [
        ("cfg_args", "antialiasing=True"),
        ("config.yml", "rasterize_mode:antialiased"),
        (GSPLAT, "antialiased:true"),
    ];
    SAYINGS.iter().find_map(|(name, saying)| {
        let (file, settings) = settings(scene, name)?;
        settings.iter().any(|one| one == saying).then_some(file)
    })
}

/// The settings of gsplat's trainer.
const GSPLAT: &str = "cfg.yml";

/// gsplat's settings beside a scene where it trained in a world of its own, which it does unless they say otherwise.
fn normalised_by(scene: &Path) -> Option<PathBuf> {
    let (file, settings) = settings(scene, GSPLAT)?;
    let has = |begin: &str| settings.iter().any(|one| one.starts_with(begin));
    let is_as_it_was = has("normalize_world_space:false");
    (has("data_factor:") && !is_as_it_was || has("normalize_world_space:true")).then_some(file)
}

/// The file of cameras of one of these scenes: a `cameras.json` or `transforms.json` beside it, or a scene of glTF that has
/// cameras itself.
pub fn cameras_of(scenes: &[PathBuf]) -> Option<PathBuf> {
    let has_cameras = |scene: &&PathBuf| {
        let ending = scene.extension().map(|ending| ending.to_ascii_lowercase());
        let is_gltf = ending.is_some_and(|ending| ending == "glb" || ending == "gltf");
        is_gltf && camera_files::load_cameras(scene).is_ok()
    };
    let beside = scenes.iter().find_map(|scene| cameras_beside(scene));
    beside.or_else(|| scenes.iter().find(has_cameras).cloned())
}

fn cameras_beside(scene: &Path) -> Option<PathBuf> {
    ["cameras.json", "transforms.json"]
        .iter()
        .find_map(|name| beside(scene, name))
}

/// Cameras where the Gaussians are.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct PlacedCameras {
    /// In the order of their file.
    pub cameras: Vec<NamedCamera>,
    /// How they were brought to where training put the Gaussians, a sentence each.
    pub notes: Vec<String>,
}

/// The cameras of a file or a COLMAP folder, where the Gaussians of these scenes are: nerfstudio and gsplat train in worlds of
/// their own.
///
/// # Errors
/// [`Error::Io`] and [`Error::Format`] if the file cannot be read, or if the way to the world of the Gaussians is not known.
pub fn load_cameras(path: &Path, scenes: &[PathBuf]) -> Result<PlacedCameras> {
    let mut cameras = camera_files::load_cameras(path)?;
    let mut notes = Vec::new();
    let is_nerfstudio = path
        .file_name()
        .is_some_and(|name| name == "transforms.json");
    let moved = scenes
        .iter()
        .find_map(|scene| beside(scene, "dataparser_transforms.json"));
    if let Some(by) = moved.filter(|_| is_nerfstudio) {
        cameras = dataparser::place(cameras, path, &by)?;
        notes.push(format!("the cameras are placed by {}", by.display()));
    }
    let normalised = scenes.iter().find_map(|scene| {
        let trained = scene_in(scene).ok().flatten();
        Some((normalised_by(scene)?, trained.unwrap_or(scene.clone())))
    });
    if let Some((by, trained)) = &normalised {
        let (placed, note) = gsplat::place(cameras, path, (by, trained))?;
        cameras = placed;
        notes.extend(note);
    }
    Ok(PlacedCameras { cameras, notes })
}

/// The direction that is up by the file of one of these scenes.
pub fn stated_up(scenes: &[PathBuf]) -> Option<DVec3> {
    let stated = |scene: &PathBuf| {
        let trained = scene_in(scene).ok().flatten();
        crate::ply::stated_up(trained.as_deref().unwrap_or(scene))
    };
    scenes.iter().find_map(stated)
}

/// The direction that is up for cameras that agree well enough to have one.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct CommonUp {
    /// The mean of theirs.
    pub direction: DVec3,
    /// The file of the cameras.
    pub file: PathBuf,
    /// How they were brought to where training put the Gaussians, a sentence each.
    pub notes: Vec<String>,
}

/// The direction that is up for the cameras beside one of these scenes.
pub fn up_of_cameras(scenes: &[PathBuf]) -> Option<CommonUp> {
    scenes.iter().find_map(|scene| {
        let file = cameras_beside(scene)?;
        let PlacedCameras { cameras, notes } = load_cameras(&file, scenes).ok()?;
        let pinholes = cameras.iter().filter_map(|named| named.undistorted().ok());
        Some(CommonUp {
            direction: common_up(pinholes)?,
            file,
            notes,
        })
    })
}

/// The direction that is up for most of these cameras: the mean of theirs, where they agree well enough to have one.
fn common_up(cameras: impl Iterator<Item = Camera>) -> Option<DVec3> {
    let (mut sum, mut count) = (DVec3::ZERO, 0_u32);
    for camera in cameras {
        sum -= camera.rotation.row(1); // down in the picture
        count += 1;
    }
    let mean = sum / f64::from(count.max(1));
    (mean.length() > 0.7).then(|| mean.normalize())
}

#[cfg(test)]
mod tests;
