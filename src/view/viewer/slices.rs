//! Cut faces, once the view rests: the slice on those of the held shape, and marks at the edges of cut surfaces.

use std::time::{Duration, Instant};

use rara::scene::layers::SceneLayers;
use rara::{Camera, Clip, Picture, Settings};
use rara_shots::{Slice, cut_by_frame};

use super::layers::CutFaces;
use super::scenery::{FaceView, Manner, Scenery};
use crate::Windowed;

const NO_SLICE: &str = "a slice needs a plane, slab or box that is held, is on and cuts together with the other shapes";
const NO_MARKS: &str = "lines and tints mark what planes, slabs and boxes cut together: the frame's clip is off, or has other shapes";

/// A picture with cut faces: all that it is made of, but for the Gaussians.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FacePlan {
    view: FaceView,
    camera: Camera,
    settings: Settings,
    /// The frame's clip.
    clip: Clip,
    cut: CutFaces,
}

/// The cut faces over the window's picture.
#[derive(Debug, Default)]
pub(super) struct ShownFaces {
    /// The plan of those that the window shows, if it shows any.
    made: Option<FacePlan>,
    /// Why there can be none, where that was told.
    pub(super) told: Option<&'static str>,
    /// True while the window says that they are drawn.
    pub(super) announced: bool,
    /// How long the last ones took.
    took: Option<Duration>,
}

impl FacePlan {
    /// Plans the cut faces that a camera sees; `None` where nobody has asked for them.
    ///
    /// # Errors
    /// A sentence that says why they cannot be shown.
    pub(super) fn new(
        scenery: &Scenery,
        manner: &Manner,
        camera: &Camera,
    ) -> Result<Option<Self>, &'static str> {
        let view = manner.faces;
        if view == FaceView::default() {
            return Ok(None);
        }
        let (clips, read) = (&scenery.clips, &scenery.scene.layers);
        let cut = match view.slice {
            true => clips.held_faces(read, camera).ok_or(NO_SLICE)?,
            false => clips.faces(read, camera).ok_or(NO_MARKS)?,
        };
        Ok(Some(Self {
            view,
            camera: *camera,
            settings: manner.settings,
            clip: clips.frame.clip(),
            cut,
        }))
    }

    /// Draws the picture beside a window that shows these layers.
    pub(super) fn picture(
        &self,
        windowed: &mut Windowed,
        read: &SceneLayers,
    ) -> rara::Result<Picture> {
        let Self {
            view,
            camera,
            settings,
            clip,
            cut,
        } = self;
        let mut picture = match view.slice {
            true => Picture::filled(camera.width, camera.height, [0.0; 4]),
            false => windowed.picture(camera, clip, settings)?,
        };
        let mut scene = cut.scene(read);
        if !view.slice {
            scene = cut_by_frame(&scene);
        }
        let cues = view.cues();
        let mut headless = windowed.beside()?;
        let mut slices = Vec::new();
        for face in &cut.faces {
            let slice = Slice::new(&scene, &face.plane);
            slice.load(&mut headless, settings)?;
            let seen = (camera, &face.rest, settings);
            let slice = slice.picture(&mut headless, seen, None)?;
            if view.slice {
                let mut solid = slice.clone();
                solid.make_opaque(cues.level);
                put_before(&mut picture, &solid);
            }
            slices.push(slice);
        }
        if let Some(background) = settings.background.filter(|_| view.slice) {
            picture.put_before(background);
        }
        for slice in &slices {
            picture.draw_cues(slice, &cues)?;
        }
        Ok(picture)
    }
}

/// The window says that it draws cut faces where the last ones took longer than this.
const SOON: Duration = Duration::from_millis(300);

impl ShownFaces {
    /// Takes cut faces away that are not those of this plan. Returns true where the window shows what the plan says.
    pub(super) fn uncover(&mut self, windowed: &mut Windowed, plan: Option<&FacePlan>) -> bool {
        if self.made.as_ref() != plan && self.made.take().is_some() {
            windowed.set_cover(None);
        }
        self.made.as_ref() == plan
    }

    /// Has the window show the cut faces of a plan with its next frame. Where they take long, the next frame says so and the one
    /// behind it shows them.
    pub(super) fn cover(
        &mut self,
        windowed: &mut Windowed,
        (plan, read): (FacePlan, &SceneLayers),
    ) -> rara::Result<()> {
        let is_slow = self.took.is_none_or(|took| took > SOON);
        self.announced = is_slow && !self.announced;
        if self.announced {
            return Ok(());
        }
        let begun = Instant::now();
        let picture = plan.picture(windowed, read)?;
        self.took = Some(begun.elapsed());
        windowed.set_cover(Some(&picture));
        self.made = Some(plan);
        Ok(())
    }

    /// Forgets the cut faces of a scene that the window does not show any more.
    pub(super) fn forget(&mut self, windowed: &mut Windowed) {
        self.uncover(windowed, None);
        *self = Self::default();
    }
}

/// Puts a picture before another of its size; both are premultiplied.
fn put_before(behind: &mut Picture, before: &Picture) {
    for (pixel, over) in behind.pixels.iter_mut().zip(&before.pixels) {
        let rest = 1.0 - over[3];
        for (value, over) in pixel.iter_mut().zip(over) {
            *value = over + rest * *value;
        }
    }
}

#[cfg(test)]
mod tests;
