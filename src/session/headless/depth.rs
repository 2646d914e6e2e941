//! How deep a frame's pixels are, drawn by themselves.

use super::super::loaded;
use super::super::target::{blendable_on, vulkan_format};
use super::Headless;
use crate::renderer::Kept;
use rara_base::error::{Error, Result};
use rara_gpu::{BufferDesc, Drawer, ImageDesc, Location};
use rara_scene::camera::Camera;
use rara_scene::precision::TargetFormat;
use rara_scene::settings::{Settings, Show};

impl Headless {
    /// Draws the expected depth of each pixel, row by row from the top left: the mean depth along the view axis, world
    /// units, of what the clip leaves of its splats, each by what it adds to the pixel's alpha. It is 0 where there is none.
    /// [`Renderer::draw_depth`](crate::Renderer::draw_depth) says what it is of a cut splat.
    ///
    /// This is a frame of its own, whose memory is freed again; nothing of the picture changes.
    ///
    /// # Errors
    /// The errors of [`render`](Self::render).
    pub fn expected_depth<'a>(
        &mut self,
        camera: &Camera,
        kept: impl Into<Kept<'a>>,
        settings: &Settings,
    ) -> Result<Vec<f32>> {
        let drawn = self.draw_depth(camera, kept.into(), settings);
        drawn.map_err(|error| self.session.explain(error))
    }

    fn draw_depth(
        &mut self,
        camera: &Camera,
        kept: Kept<'_>,
        settings: &Settings,
    ) -> Result<Vec<f32>> {
        let session = &self.session;
        let (device, scene) = (&session.device, loaded(&session.scene, "draw depths of")?);
        let format = blendable_on(device, TargetFormat::Float)?;
        let mut renderer = session
            .renderer
            .with_expected_depth(vulkan_format(format))?;
        // Depths are the same whatever a picture shows, of which some is made by tiles alone.
        let drawn = settings.show(Show::Colour);
        let frame = renderer.configure(scene, camera, kept, &drawn)?;
        let image = device.create_image(&ImageDesc {
            name: "expected depth",
            width: camera.width,
            height: camera.height,
            format: vulkan_format(format),
        })?;
        let size = u64::from(camera.width) * u64::from(camera.height) * format.pixel_bytes();
        let readback = device.create_buffer(&BufferDesc {
            name: "readback",
            size,
            location: Location::Readback,
        })?;
        device.submit_and_wait(|cmd| {
            // SAFETY: `cmd` is recording, all earlier frames were waited for, and scene, image, buffer and renderer
            // outlive the wait for this one; the rendering scope is opened and closed here around the draw, on an
            // attachment of the format of the renderer's depths, and leaves the image ready to be copied from.
            unsafe {
                let frame = renderer.prepare(cmd, scene, None, frame)?;
                image.begin_rendering(cmd, [0.0; 4]);
                Drawer::new(device, cmd, None).viewport(image.extent().into());
                renderer.draw_depth(cmd, [0.0, 0.0], &frame)?;
                image.end_rendering(cmd);
                image.copy_to(cmd, &readback);
            }
            Ok(())
        })?;
        Error::validated(device.validation_messages())?;
        let sums = format.decode(&readback.mapped()[..size as usize]);
        let depth = |[sum, alpha, ..]: [f32; 4]| if alpha > 0.0 { sum / alpha } else { 0.0 };
        Ok(sums.map(depth).collect())
    }
}
