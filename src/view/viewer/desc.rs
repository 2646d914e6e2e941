//! The description from which a viewer is opened.

use glam::DVec3;
use rara::{Clip, FrameLimits, HeadlessDesc, Settings, Surface};
use rara_base::setters;

use super::action::Action;
use super::failure::Failure;
use super::loading::Load;

/// A source of actions, as of a script that is being written. It calls the function with the actions of one step after the other,
/// until there are no more or the function returns false, on a thread of its own.
pub type Follow = Box<dyn FnOnce(&mut dyn FnMut(Result<Vec<Action>, Failure>) -> bool) + Send>;

/// The description from which a viewer is opened.
#[non_exhaustive]
pub struct ViewerDesc {
    /// The device, and how closely it is watched.
    pub device: HeadlessDesc,
    /// The size of the window, px.
    pub size: (u32, u32),
    /// How frames are drawn.
    pub settings: Settings,
    /// The direction that is up in the pictures of dropped scenes; `None` where they say it.
    pub up: Option<DVec3>,
    /// True to outline the shapes that clip.
    pub outlined: bool,
    /// True to show text over the picture without being asked for it.
    pub text: bool,
    /// How the first scene is read.
    pub load: Load,
    /// The number of the first scene's layers and an example of its clip, as far as they are known before it is read; shaders
    /// are compiled for them meanwhile.
    pub expected: (u32, Clip),
    /// The actions that are done first.
    pub script: Vec<Action>,
    /// Where more actions come from.
    pub follow: Option<Follow>,
}

setters!(ViewerDesc {
    device: HeadlessDesc,
    size: (u32, u32),
    settings: Settings,
    up: Option<DVec3>,
    outlined: bool,
    text: bool,
    expected: (u32, Clip),
    script: Vec<Action>,
    follow: Option<Follow>,
});

impl ViewerDesc {
    /// A window of 1280x720 pixels, with text and outlines, that shows a scene by the default settings on the best device.
    pub fn new(load: Load) -> Self {
        Self {
            device: HeadlessDesc::default(),
            size: (1280, 720),
            settings: Settings::default(),
            up: None,
            outlined: true,
            text: true,
            load,
            expected: (1, Clip::default()),
            script: Vec::new(),
            follow: None,
        }
    }
    /// The limits of the frames that are expected, of a scene of however many Gaussians.
    pub(super) fn limits(&self) -> FrameLimits {
        let (layers, clip) = &self.expected;
        let all = clip.all_surfaces();
        let count = all.len() as u32;
        let faces = all.iter().map(|surface| match surface {
            Surface::Inside(inside) => inside.mesh().faces().len() as u32,
            _ => 0,
        });
        let (planes, surfaces) = match clip.is_general() {
            true => (0, count),
            false => (count, 0),
        };
        FrameLimits::new(self.size, 1)
            .layers((*layers).max(1))
            .sh_format(self.settings.precision.sh)
            .planes(planes)
            .surfaces(surfaces)
            .faces(faces.sum())
            .settings(vec![self.settings])
    }
}
