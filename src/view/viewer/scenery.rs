//! What a viewer shows: a scene and where it is looked at from, and what stays when another scene comes.

use std::collections::BTreeMap;
use std::path::PathBuf;

use glam::DVec3;
use rara::clip::Expression;
use rara::scene::layers::{self, SceneLayers, Tint};
use rara::scene::trained_folder;
use rara::{Camera, ClipOp, Cue, Cues, Gaussians, Scene, Settings};
use rara_shots::{Framing, Lens, OUTLINE_WIDTH, RIM_WIDTH, UP, Visible};

use super::cut::ClipEditor;
use super::failure::Failure;
use super::layers::Clips;
use super::viewpoint::Viewpoint;
use crate::Windowed;

/// A scene that has been read, and how it is looked at.
#[derive(Debug)]
pub struct SceneView {
    pub(super) scenery: Scenery,
}

/// The scene that is shown, and how it is moved.
#[derive(Debug)]
pub(super) struct Scenery {
    /// The scene's name, for the title.
    pub(super) name: String,
    /// The scene's layers as they were uploaded; their Gaussians stay on the host.
    pub(super) scene: SceneLayers,
    /// The Gaussians of tinted layers as they were read, by the layers' numbers.
    untinted: BTreeMap<usize, Gaussians>,
    /// The cameras to choose from, each with its up direction; the first is the start.
    pub(super) views: Vec<(Camera, DVec3)>,
    pub(super) clips: Clips,
    pub(super) centre: DVec3,
    pub(super) radius: f64,
    /// What the program has noted of it.
    pub(super) notes: Vec<String>,
}

/// The parts of cut faces that are shown once the view rests.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct FaceView {
    /// True for the slice on the faces of the held shape, in place of the scene behind them.
    pub slice: bool,
    /// True for a line around cut faces.
    pub edge: bool,
    /// True for a tint along their edges.
    pub rim: bool,
}

const EDGE: [f32; 3] = [1.0, 0.9, 0.2];
const RIM: [f32; 3] = [1.0, 0.5, 0.1];

impl FaceView {
    /// The marks at the edges of cut surfaces.
    pub fn cues(&self) -> Cues {
        let mut cues = Cues::default();
        let cue = |colour, width| Cue { colour, width };
        cues.outline = self.edge.then_some(cue(EDGE, OUTLINE_WIDTH));
        cues.rim = self.rim.then_some(cue(RIM, RIM_WIDTH));
        cues
    }
}

/// What a description says of a viewer, whatever the scene.
#[derive(Debug)]
pub(super) struct Manner {
    pub(super) settings: Settings,
    /// The direction that is up in the pictures of scenes that no camera comes with, if it is said.
    pub(super) up: Option<DVec3>,
    /// The parts of cut faces that are asked for.
    pub(super) faces: FaceView,
    /// True when the shapes that clip are outlined.
    pub(super) outlined: bool,
    /// True when there is text over the picture without asking for it.
    pub(super) text: bool,
}

impl SceneView {
    /// A scene of which this is visible, with one camera at least to choose from, each with what is up for it, and the frame's clip.
    pub fn new(
        loaded: SceneLayers,
        visible: &Visible,
        views: Vec<(Camera, DVec3)>,
        frame: ClipEditor,
    ) -> Self {
        let centre = frame.centre();
        let clips = Clips::new(frame, &loaded.layers, centre);
        let scenery = Scenery {
            name: name(&loaded.scene()),
            scene: loaded,
            untinted: BTreeMap::new(),
            views,
            clips,
            centre: visible.middle(),
            radius: visible.radius(),
            notes: Vec::new(),
        };
        Self { scenery }
    }

    /// Notes what the program wants to know of the scene when it is [shown](super::Shown::notes), as where it is from.
    #[must_use]
    pub fn notes(mut self, notes: Vec<String>) -> Self {
        self.scenery.notes = notes;
        self
    }

    /// The scene of files, whose layers are all its layers, framed for a window of this size.
    ///
    /// # Errors
    /// The errors of reading, and of a camera for them.
    pub fn of_files(
        files: &[PathBuf],
        up: Option<DVec3>,
        size: (u32, u32),
    ) -> Result<Self, Failure> {
        let mut entries = Vec::new();
        for file in files {
            entries.extend(layers::entries(file)?);
        }
        let loaded = layers::load(entries)?;
        let stated = || trained_folder::stated_up(files);
        let common = || Some(trained_folder::up_of_cameras(files)?.direction);
        let up = up.or_else(stated).or_else(common).unwrap_or(UP);
        let visible = Visible::of(&loaded.scene());
        let camera = Framing::new(Lens::Perspective(50.0), size).up(up);
        let camera = camera.camera(&visible)?;
        let frame = ClipEditor::new(Vec::<Expression>::new(), ClipOp::And, visible.middle());
        Ok(Self::new(loaded, &visible, vec![(camera, up)], frame))
    }
}

/// A short name for the title.
fn name(scene: &Scene<'_>) -> String {
    let first = scene.layers().first().map_or("", |layer| layer.name());
    match scene.layers().len() {
        0 | 1 => first.to_owned(),
        more => format!("{first} and {} more", more - 1),
    }
}

impl Scenery {
    /// What there is to look at before the first scene.
    pub(super) fn nothing(up: DVec3) -> rara::Result<Self> {
        let ahead = up.normalize().any_orthonormal_vector();
        let camera = Camera::look_at(-ahead, DVec3::ZERO, up, 50.0, (64, 64))?;
        let cut = ClipEditor::new(Vec::new(), ClipOp::And, DVec3::ZERO);
        Ok(Self {
            name: String::new(),
            scene: SceneLayers::default(),
            untinted: BTreeMap::new(),
            views: vec![(camera, up)],
            clips: Clips::new(cut, &[], DVec3::ZERO),
            centre: DVec3::ZERO,
            radius: 1.0,
            notes: Vec::new(),
        })
    }

    /// Mixes a colour into layers of these numbers, or leaves them as they were read.
    pub(super) fn tint(&mut self, places: &[usize], tint: Option<Tint>) {
        for &place in places {
            let gaussians = &mut self.scene.layers[place].gaussians;
            if let Some(plain) = self.untinted.remove(&place) {
                *gaussians = plain;
            }
            if let Some(tint) = tint {
                self.untinted.insert(place, gaussians.clone());
                tint.apply(gaussians);
            }
        }
    }

    /// Uploads the scene in place of the one that a window shows.
    pub(super) fn upload(&self, windowed: &mut Windowed, settings: &Settings) -> rara::Result<()> {
        windowed.load_as(self.scene.scene(), settings.precision.sh)
    }

    pub(super) fn viewpoint(&self, view: usize) -> Viewpoint {
        let (camera, up) = &self.views[view];
        Viewpoint::new(camera, *up, self.centre, self.radius)
    }
}
