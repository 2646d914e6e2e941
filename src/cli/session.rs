//! A device and the scene on it.

use rara::gpu::DeviceShape;
use rara::{
    Aov, Camera, Channel, Clip, FrameStats, Headless, HeadlessDesc, Picture, Result, Scene,
    Settings, ShFormat,
};

use super::combine::{Combine, combine};

/// A device with a scene on it.
pub(super) struct Session {
    headless: Headless,
}

impl Session {
    pub(super) fn open(desc: &HeadlessDesc, scene: &Scene<'_>, sh: ShFormat) -> Result<Self> {
        let mut headless = Headless::new(desc)?;
        headless.load_as(scene, sh)?;
        Ok(Self { headless })
    }

    /// Uploads the scene once more, its spherical harmonics stored in another way.
    pub(super) fn reload(&mut self, scene: &Scene<'_>, sh: ShFormat) -> Result<()> {
        self.headless.load_as(scene, sh)
    }

    /// Renders a frame that follows the one before and takes over what stays the same.
    pub(super) fn next_frame(
        &mut self,
        camera: &Camera,
        clip: &Clip,
        settings: &Settings,
    ) -> Result<FrameStats> {
        self.headless.render(camera, clip, settings)
    }

    /// Renders the frame `repeat` times from nothing; the statistics are the medians.
    pub(super) fn frame(
        &mut self,
        camera: &Camera,
        clip: &Clip,
        settings: &Settings,
        repeat: u32,
    ) -> Result<FrameStats> {
        let frames = (0..repeat).map(|_| {
            self.headless.forget(); // nothing is carried over between them
            self.headless.render(camera, clip, settings)
        });
        Ok(combine(
            &frames.collect::<Result<Vec<_>>>()?,
            Combine::Median,
        ))
    }

    /// One frame and its picture.
    pub(super) fn picture(
        &mut self,
        camera: &Camera,
        clip: &Clip,
        settings: &Settings,
    ) -> Result<(Picture, FrameStats)> {
        let stats = self.frame(camera, clip, settings, 1)?;
        Ok((self.last_picture()?, stats))
    }

    /// Channels beside the colours of a frame of the scene that is loaded.
    pub(super) fn channels(
        &mut self,
        aovs: &[Aov],
        scene: &Scene<'_>,
        frame: (&Camera, &Clip, &Settings),
    ) -> Result<Vec<Channel>> {
        self.headless.channels(aovs, scene, frame)
    }

    /// The picture of the last frame.
    pub(super) fn last_picture(&mut self) -> Result<Picture> {
        self.headless.picture()
    }

    /// Frees everything; an error is what the validation layer has reported about it.
    pub(super) fn close(self) -> Result<()> {
        self.headless.close()
    }

    /// True when the device is this machine's processor.
    pub(super) fn is_cpu(&self) -> bool {
        self.headless.device().info().kind_name() == "cpu"
    }

    /// True when the device counts what the stages do.
    pub(super) fn has_statistics(&self) -> bool {
        self.headless.device().support().pipeline_statistics
    }

    /// Device memory by what it is for, the largest first.
    pub(super) fn memory_by_name(&self) -> Vec<rara::gpu::NamedBytes> {
        self.headless.device().memory_by_name()
    }

    /// Device memory that the scene takes.
    pub(super) fn scene_bytes(&self) -> u64 {
        self.headless.scene_bytes()
    }

    /// The kind of machine that kernels were chosen for, and the reason.
    pub(super) fn shape(&self) -> (DeviceShape, &'static str) {
        let device = self.headless.device();
        (device.shape(), device.shape_reason())
    }

    /// Device name, driver, and device memory in use.
    pub(super) fn about(&self) -> (String, String, u64) {
        let headless = &self.headless;
        (
            headless.device_name().to_owned(),
            headless.driver().to_owned(),
            headless.device_bytes(),
        )
    }
}
