//! The Gaussians that pixels show most of.

use ash::vk;

use super::super::loaded;
use super::Headless;
use crate::renderer::{Kept, Picker, Picks};
use rara_base::error::{Error, Result};
use rara_scene::camera::Camera;
use rara_scene::settings::Settings;

impl Headless {
    /// Finds the Gaussians that the pixels of a part of the picture show most of, and waits for them. [`Picker`] does the same
    /// without waiting.
    ///
    /// # Errors
    /// As [`Picker::record`], and [`Error::Invalid`] without a scene.
    pub fn pick<'a>(
        &mut self,
        camera: &Camera,
        kept: impl Into<Kept<'a>>,
        settings: &Settings,
        rect: vk::Rect2D,
    ) -> Result<Picks> {
        let picked = self.picked(camera, kept.into(), settings, rect);
        picked.map_err(|error| self.session.explain(error))
    }

    fn picked(
        &mut self,
        camera: &Camera,
        kept: Kept<'_>,
        settings: &Settings,
        rect: vk::Rect2D,
    ) -> Result<Picks> {
        let session = &self.session;
        let (device, scene) = (&session.device, loaded(&session.scene, "pick from")?);
        let mut picker = Picker::new(&session.renderer, 1)?;
        let ticket = device.submit_and_wait(|cmd| {
            // SAFETY: `cmd` is recording outside a rendering scope, all earlier submissions were waited for, and scene
            // and picker outlive the wait for this one.
            unsafe { picker.record(cmd, scene, camera, kept, settings, rect) }
        })?;
        Error::validated(device.validation_messages())?;
        // SAFETY: the submission was waited for.
        unsafe { picker.read(ticket) }
    }
}
