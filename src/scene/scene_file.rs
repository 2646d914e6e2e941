//! What readers of scene files make of one.

use glam::DVec3;

use super::{Annotations, Format, Gaussians, LoadReport, Training};

/// A scene as loaded, and what the loader did to it.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneFile {
    /// The scene.
    pub gaussians: Gaussians,
    /// Elements that were dropped or repaired.
    pub report: LoadReport,
    /// The file's format.
    pub format: Format,
    /// Whether the file says that its Gaussians were trained [antialiased](Gaussians::is_antialiased), or were not; `None` if
    /// it says neither.
    pub antialiased: Option<bool>,
    /// The direction that is up, where a comment of a `.ply` says it (`Vertical Axis: z`); -y is usual.
    pub up: Option<DVec3>,
    /// The names of what the file has beside this scene, and that was not read: properties that were not asked for, lists, and
    /// other elements of a `.ply`, and members of the `meta.json` of SOG.
    pub others: Vec<String>,
    /// The names and `extras` around the Gaussians of a glTF file; other formats have none.
    pub annotations: Option<Annotations>,
}

impl SceneFile {
    /// Notes what the file says of how its Gaussians were trained; they are drawn so.
    pub(super) fn says(&mut self, antialiased: Option<bool>, training: Training) {
        self.antialiased = antialiased;
        let antialiased = antialiased == Some(true);
        self.gaussians.train(training.antialiased(antialiased));
    }

    /// Notes the origin from which centres are counted, where there is one.
    pub(super) fn says_origin(&mut self) {
        let origin = self.gaussians.origin();
        if origin != DVec3::ZERO {
            self.report.note(format!(
                "stored the centres relative to ({}, {}, {}), which keeps their digits",
                origin.x, origin.y, origin.z
            ));
        }
    }
}
