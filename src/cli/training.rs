//! Folders that training leaves: the scene in them, and the cameras beside it.

use std::fs;
use std::path::{Path, PathBuf};

use glam::DVec3;
use rara::Camera;
use rara::camera_files::{self, NamedCamera};

use super::failure::Failure;
use super::lens::UP;
use super::values::STANDARD;
use super::{dataparser, output};

/// The scene in a folder that training has left, if it is one: of 3DGS the last iteration's, of nerfstudio what was exported.
pub(super) fn scene_in(folder: &Path) -> Result<Option<PathBuf>, Failure> {
    let is_sog = ["meta.json", "lod-meta.json"]
        .iter()
        .any(|name| folder.join(name).is_file());
    if is_sog || !folder.is_dir() {
        return Ok(None);
    }
    let iterations = fs::read_dir(folder.join("point_cloud"))
        .into_iter()
        .flatten();
    let iterations = iterations.flatten().filter_map(|entry| {
        let name = entry.file_name();
        let number: u64 = name.to_str()?.strip_prefix("iteration_")?.parse().ok()?;
        let file = entry.path().join("point_cloud.ply");
        file.is_file().then_some((number, file))
    });
    if let Some((_, last)) = iterations.max_by_key(|(number, _)| *number) {
        return Ok(Some(last));
    }
    let exported = ["splat.ply", "exports/splat/splat.ply"].map(|name| folder.join(name));
    if let Some(exported) = exported.into_iter().find(|file| file.is_file()) {
        return Ok(Some(exported));
    }
    if folder.join("nerfstudio_models").is_dir() {
        return Err(rara::Error::format(
            folder,
            "the Gaussians are in a checkpoint that only nerfstudio reads; export them into this folder: \
             ns-export gaussian-splat --load-config config.yml --output-dir .",
        )
        .into());
    }
    Ok(None)
}

/// The folders in which files about a scene may be, the nearest first; none of standard input's.
fn around(scene: &Path) -> Vec<PathBuf> {
    if scene == Path::new(STANDARD) {
        return Vec::new();
    }
    if scene.is_dir() {
        return vec![scene.to_owned()];
    }
    let absolute = std::path::absolute(scene).unwrap_or_else(|_| scene.to_owned());
    let mut folders: Vec<PathBuf> = absolute.parent().map(Path::to_owned).into_iter().collect();
    // In a 3DGS output the scene is two folders deep, point_cloud/iteration_N, and in one of nerfstudio it may be.
    // gsplat's are in a folder of their own.
    let of_gsplat = folders.first().filter(|folder| folder.ends_with("ply"));
    let of_gsplat = of_gsplat.and_then(|folder| Some(folder.parent()?.to_owned()));
    let is_inner = |folder: &Path| {
        let inner = folder.parent().and_then(Path::file_name);
        inner.is_some_and(|name| name == "point_cloud" || name == "exports")
    };
    if let Some(output) = folders
        .first()
        .filter(|f| is_inner(f))
        .and_then(|f| f.parent()?.parent())
    {
        folders.push(output.to_owned());
    }
    folders.extend(of_gsplat);
    folders
}

/// The file of that name that is nearest to a scene.
pub(super) fn beside(scene: &Path, name: &str) -> Option<PathBuf> {
    let files = around(scene).into_iter().map(|folder| folder.join(name));
    files.into_iter().find(|file| file.is_file())
}

/// The file beside a scene whose settings say that it was trained antialiased: `cfg_args` of 3DGS, `config.yml` of nerfstudio
/// or `cfg.yml` of gsplat.
pub(super) fn antialiased_by(scene: &Path) -> Option<PathBuf> {
    /// The longest file that is searched.
    const MOST_BYTES: u64 = 1 << 20;
    const SAYINGS: [(&str, &str); 3] = [
        ("cfg_args", "antialiasing=True"),
        ("config.yml", "rasterize_mode:antialiased"),
        ("cfg.yml", "antialiased:true"),
    ];
    SAYINGS.iter().find_map(|(name, saying)| {
        let file = beside(scene, name)?;
        let is_short = fs::metadata(&file).is_ok_and(|metadata| metadata.len() <= MOST_BYTES);
        let text = fs::read(&file).ok().filter(|_| is_short)?;
        let text = String::from_utf8_lossy(&text);
        // cfg_args is one line of many settings, the others have a line for each.
        let mut settings = text.split([',', '(', ')', '\n']).map(|setting| {
            let signs = setting
                .chars()
                .filter(|c| !c.is_whitespace() && *c != '\'' && *c != '"');
            signs.collect::<String>()
        });
        settings.any(|setting| setting == *saying).then_some(file)
    })
}

pub(super) fn cameras(scene: &Path) -> Option<PathBuf> {
    ["cameras.json", "transforms.json"]
        .iter()
        .find_map(|name| beside(scene, name))
}

/// The cameras of a file or a COLMAP folder, where the Gaussians of these scenes are.
pub(super) fn load_cameras(path: &Path, scenes: &[PathBuf]) -> rara::Result<Vec<NamedCamera>> {
    let mut cameras = camera_files::load_cameras(path)?;
    let is_nerfstudio = path
        .file_name()
        .is_some_and(|name| name == "transforms.json");
    let moved = scenes
        .iter()
        .find_map(|scene| beside(scene, "dataparser_transforms.json"));
    if let Some(by) = moved.filter(|_| is_nerfstudio) {
        cameras = dataparser::place(cameras, path, &by)?;
        output::say(format_args!(
            "note: the cameras are placed by {}",
            by.display()
        ));
    }
    Ok(cameras)
}

/// The direction that is up in a picture that frames these scenes: the one that is `chosen`, or that of the cameras beside one, or
/// -y, as in COLMAP's worlds, and in those of formats that say what is up, which are turned as they are read. With a note where
/// it may be another.
pub(super) fn up_of(chosen: Option<DVec3>, scenes: &[PathBuf]) -> (DVec3, Option<String>) {
    if let Some(up) = chosen {
        return (up, None);
    }
    let of_cameras = scenes.iter().find_map(|scene| {
        let file = cameras(scene)?;
        let loaded = load_cameras(&file, scenes).ok()?;
        let up = common_up(loaded.iter().filter_map(|named| named.undistorted().ok()))?;
        let note = format!(
            "note: up is {}, the mean of the cameras in {}; --up takes another direction",
            direction_text(up),
            file.display()
        );
        let is_usual = up.dot(UP) > 0.9;
        Some((up, (!is_usual).then_some(note)))
    });
    let says_what_is_up = |scene: &PathBuf| {
        let ending = scene.extension().and_then(|ending| ending.to_str());
        let ending = ending.unwrap_or_default().to_ascii_lowercase();
        ["spz", "glb", "gltf"].contains(&&ending[..])
    };
    of_cameras.unwrap_or_else(|| {
        let note = "note: up is -y; --up y turns a picture that is upside down, --up z one that lies on its side";
        let is_known = scenes.iter().all(says_what_is_up);
        (UP, (!is_known).then(|| note.into()))
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

/// A direction as --up takes it: the axis that it is near, or its numbers.
fn direction_text(direction: DVec3) -> String {
    let axes = [("x", DVec3::X), ("y", DVec3::Y), ("z", DVec3::Z)];
    let near = axes
        .iter()
        .find(|(_, axis)| direction.dot(*axis).abs() > 0.9);
    match near {
        Some((name, axis)) if direction.dot(*axis) > 0.0 => (*name).into(),
        Some((name, _)) => format!("-{name}"),
        None => {
            let DVec3 { x, y, z } = direction;
            format!("{x:.2},{y:.2},{z:.2}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cameras_that_agree_have_a_common_up() {
        let ring = |up: DVec3| {
            let camera = |turn: u32| {
                let eye =
                    glam::DQuat::from_axis_angle(up, f64::from(turn)) * up.any_orthonormal_vector();
                Camera::look_at(5.0 * eye + up, DVec3::ZERO, up, 50.0, (8, 8)).expect("a view")
            };
            (0..6).map(camera).collect::<Vec<_>>()
        };
        for (up, text) in [(DVec3::Y, "y"), (DVec3::NEG_Y, "-y"), (DVec3::Z, "z")] {
            let found = common_up(ring(up).into_iter()).expect("they agree");
            assert!(found.dot(up) > 0.99, "{found}");
            assert_eq!(direction_text(found), text);
        }
        let mut all = ring(DVec3::Y);
        all.extend(ring(DVec3::NEG_Y));
        assert_eq!(common_up(all.into_iter()), None);
        assert_eq!(
            direction_text(DVec3::new(0.6, -0.8, 0.0)),
            "0.60,-0.80,0.00"
        );
    }

    #[test]
    fn the_last_iteration_counts_and_its_cameras_are_found() {
        let folder = std::env::temp_dir().join(format!("rara-training-{}", std::process::id()));
        let write = |name: &str| {
            let file = folder.join(name);
            fs::create_dir_all(file.parent().expect("a folder")).expect("a folder");
            fs::write(&file, "").expect("a file");
            file
        };
        fs::create_dir_all(&folder).expect("a folder");
        assert!(matches!(scene_in(&folder), Ok(None)));
        write("point_cloud/iteration_7000/point_cloud.ply");
        let last = write("point_cloud/iteration_30000/point_cloud.ply");
        write("point_cloud/iteration_40000/other.ply");
        write("point_cloud/iteration_x/point_cloud.ply");
        let cameras_file = write("cameras.json");
        assert_eq!(scene_in(&folder).ok().flatten(), Some(last.clone()));
        assert_eq!(cameras(&folder), Some(cameras_file.clone()));
        assert_eq!(cameras(&last), Some(cameras_file));
        assert_eq!(beside(&last, "dataparser_transforms.json"), None);
        // Standard input is beside nothing, whatever folder the program runs in.
        assert!(around(Path::new(STANDARD)).is_empty());
        for (name, text, says) in [
            (
                "cfg_args",
                "Namespace(sh_degree=3, antialiasing=False, white_background=False)",
                false,
            ),
            (
                "cfg_args",
                "Namespace(sh_degree=3, antialiasing=True, white_background=False)",
                true,
            ),
            (
                "config.yml",
                "  model: !!python/object\n    not_rasterize_mode: antialiased\n",
                false,
            ),
            (
                "config.yml",
                "  model: !!python/object\n    rasterize_mode: antialiased\n",
                true,
            ),
            ("cfg.yml", "antialiased: false\n", false),
            ("cfg.yml", "antialiased: true\n", true),
        ] {
            let file = folder.join(name);
            fs::write(&file, text).expect("a file");
            let by = antialiased_by(&last);
            assert_eq!(by, says.then_some(file.clone()), "{text}");
            assert_eq!(antialiased_by(&folder.join("ply/a.ply")), by);
            fs::remove_file(&file).expect("ours");
        }
        write("meta.json");
        assert!(matches!(scene_in(&folder), Ok(None)), "it is SOG");
        fs::remove_dir_all(&folder).expect("ours");
    }
}
