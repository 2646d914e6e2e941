//! What a viewer shows: a scene and where it is looked at from, and what stays when another scene comes.

use glam::DVec3;
use rara::{Camera, ClipOp, Settings, ShFormat};

use super::cut::ClipEditor;
use super::layers::Clips;
use super::shots::Shots;
use super::viewpoint::Viewpoint;

/// The scene that is shown, and how it is moved.
#[derive(Debug)]
pub(super) struct Scenery {
    /// The scene's name, for the title.
    pub(super) name: String,
    /// The cameras to choose from, each with its up direction; the first is the start.
    pub(super) views: Vec<(Camera, DVec3)>,
    pub(super) clips: Clips,
    pub(super) centre: DVec3,
    pub(super) radius: f64,
}

/// What flags say of a viewer, whatever the scene.
#[derive(Debug)]
pub(super) struct Manner {
    pub(super) settings: Settings,
    /// How spherical harmonics are stored.
    pub(super) sh: ShFormat,
    /// The direction that is up in the pictures of scenes that no camera comes with, if a flag says it.
    pub(super) up: Option<DVec3>,
    /// True when the shapes that clip are outlined.
    pub(super) outlined: bool,
    /// True when there is text over the picture without asking for it.
    pub(super) text: bool,
    pub(super) shots: Shots,
}

impl Scenery {
    /// What there is to look at before the first scene.
    pub(super) fn nothing(up: DVec3) -> rara::Result<Self> {
        let ahead = up.normalize().any_orthonormal_vector();
        let camera = Camera::look_at(-ahead, DVec3::ZERO, up, 50.0, (64, 64))?;
        let cut = ClipEditor::new(Vec::new(), ClipOp::And, DVec3::ZERO);
        Ok(Self {
            name: String::new(),
            views: vec![(camera, up)],
            clips: Clips::new(cut, &[], DVec3::ZERO),
            centre: DVec3::ZERO,
            radius: 1.0,
        })
    }

    pub(super) fn viewpoint(&self, view: usize) -> Viewpoint {
        let (camera, up) = &self.views[view];
        Viewpoint::new(camera, *up, self.centre, self.radius)
    }
}
