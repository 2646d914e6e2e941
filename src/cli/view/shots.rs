//! Screenshots: their names, the cameras beside them, and what draws them again.

use std::path::{Path, PathBuf};

use rara::{Camera, ClipOp, Error, Picture, Result};
use serde_json::json;

use super::cut::Cut;
use crate::cli::output;

/// Where screenshots go: `{}` becomes their number.
#[derive(Debug)]
pub(super) struct Shots {
    pattern: String,
    /// The last number that was taken.
    last: u32,
}

impl Shots {
    pub(super) fn new(pattern: String) -> Self {
        Self { pattern, last: 0 }
    }

    /// The next name that is free.
    pub(super) fn next(&mut self) -> PathBuf {
        loop {
            self.last += 1;
            let path = PathBuf::from(self.pattern.replace("{}", &format!("{:03}", self.last)));
            if !taken(&path) {
                return path;
            }
        }
    }
}

/// The file of a picture's camera.
fn beside(picture: &Path) -> PathBuf {
    picture.with_extension("json")
}

fn taken(picture: &Path) -> bool {
    picture.exists() || beside(picture).exists()
}

/// Writes a picture and its camera. Neither replaces a file.
pub(super) fn save(picture: &Picture, camera: &Camera, path: &Path) -> Result<()> {
    if taken(path) {
        return Err(Error::format(
            path,
            "this file, or the .json of its camera beside it, is there already; a screenshot replaces nothing, choose \
             another name",
        ));
    }
    output::check_file(path)?;
    picture.save(path)?;
    let matrix = camera.world_to_camera().transpose().to_cols_array();
    let file = json!({
        "width": camera.width, "height": camera.height,
        "fx": camera.fx, "fy": camera.fy, "cx": camera.cx, "cy": camera.cy,
        "world_to_camera": matrix,
    });
    output::text(&beside(path), &format!("{file:#}\n"))
}

/// What was written, and the flags with which `rara render` draws it.
pub(super) fn told(path: &Path, cut: &Cut, mode: &str) -> String {
    let mut text = format!(
        "wrote {}; as in rara render --camera {}",
        path.display(),
        beside(path).display()
    );
    let planes = cut.clip().planes;
    for plane in &planes {
        let (n, d) = (plane.normal(), plane.offset());
        text += &format!(" --clip plane:{},{},{},{d}", n.x, n.y, n.z);
    }
    if planes.len() > 1 && cut.op() == ClipOp::Or {
        text += " --clip-op or";
    }
    text + " --mode " + mode
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use rara::{Clip, Plane, camera_files};

    #[test]
    fn names_are_numbered_and_no_file_is_replaced() {
        let folder = std::env::temp_dir().join(format!("rara-shots-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let mut shots = Shots::new(folder.join("shot_{}.png").display().to_string());
        std::fs::write(folder.join("shot_001.json"), "").unwrap();
        let path = shots.next();
        assert_eq!(path, folder.join("shot_002.png"));

        let eye = DVec3::new(1.0, -2.0, -3.5);
        let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::NEG_Y, 40.0, (8, 6)).unwrap();
        let picture = Picture::filled(8, 6, [0.5; 4]);
        save(&picture, &camera, &path).unwrap();
        let again = save(&picture, &camera, &path).unwrap_err().to_string();
        assert!(again.contains("replaces nothing"), "{again}");
        assert_eq!(shots.next(), folder.join("shot_003.png"));

        let read = camera_files::load_camera(&folder.join("shot_002.json")).unwrap();
        assert!((read.eye - eye).length() < 1e-12 && read.fx == camera.fx);
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn the_flags_that_draw_it_again() {
        let clip = Clip {
            planes: vec![Plane::new(DVec3::NEG_Z, 0.25).unwrap()],
            op: ClipOp::And,
        };
        let cut = Cut::new(clip, DVec3::ZERO);
        let text = told(Path::new("a.png"), &cut, "hard");
        assert!(
            text.contains("--camera a.json --clip plane:0,0,-1,0.25 --mode hard"),
            "{text}"
        );
    }
}
