//! A device and the scene on it, and the frames that are measured there.
//!
//! What a driver compiles when a shader is used first would be in the time of the first frame, so a frame is measured
//! after one that is not; what that one took longer is reported by itself.

use std::time::{Duration, Instant};

use rara::gpu::DeviceShape;
use rara::{
    Aov, Camera, Channel, Clip, FrameStats, Headless, HeadlessDesc, Picture, Result, Scene,
    Settings, ShFormat, StoredPicture,
};

use rara_lab::frames::fresh;

use super::combine::FrameSummary;
use super::output::Compiling;
use super::process;

pub(super) struct Session {
    headless: Headless,
    /// Times from recording to the picture of the frames that are not measured, milliseconds.
    first_ms: Vec<f64>,
}

#[derive(Debug, Clone, Copy)]
pub(super) enum Repeat {
    /// Once, as no time is shown.
    Unmeasured,
    /// Once, with what the frame before has left.
    Following,
    /// This often, after one that is not measured.
    Exactly(u32),
    /// Likewise, but no more once they have taken [`PATIENCE`] together.
    UpTo(u32),
}

impl Repeat {
    /// How often each of so many pictures is drawn, so that a median of at least five frames can be shown.
    pub(super) fn of_pictures(count: usize) -> Self {
        Self::UpTo(5_usize.div_ceil(count.max(1)) as u32)
    }
}

/// How long somebody who wants a picture waits for a median.
const PATIENCE: Duration = Duration::from_secs(2);

impl Session {
    pub(super) fn open(desc: &HeadlessDesc, scene: &Scene<'_>, sh: ShFormat) -> Result<Self> {
        process::make_drivers_folder();
        let mut headless = Headless::new(desc)?;
        headless.load_as(scene, sh)?;
        Ok(Self {
            headless,
            first_ms: Vec::new(),
        })
    }

    /// Draws frames that are not measured, the ones after the first each from the one before, so that what the driver
    /// compiles for them is in no frame that is.
    pub(super) fn warm_up<'a>(
        &mut self,
        frames: impl IntoIterator<Item = (&'a Camera, &'a Clip, &'a Settings)>,
    ) -> Result<()> {
        let _compiling = Compiling::begin();
        self.headless.forget();
        for (camera, clip, settings) in frames {
            let first = self.headless.render(camera, clip, settings)?;
            self.first_ms.push(first.wall_ms);
        }
        self.headless.forget();
        Ok(())
    }

    /// How much longer the driver took because it used its shaders for the first time, where a frame usually takes
    /// `wall_ms`; milliseconds.
    pub(super) fn first_use_ms(&self, wall_ms: f64) -> f64 {
        let longer = self.first_ms.iter().map(|ms| (ms - wall_ms).max(0.0));
        self.headless.device().pipeline_ms() + longer.sum::<f64>()
    }

    /// True when an earlier run has kept what this driver compiled.
    pub(super) fn has_kept(&self) -> bool {
        self.headless.kept_pipeline_bytes() > 0
    }

    /// Renders a frame that is measured, each time from nothing; the statistics are the medians.
    pub(super) fn measured_frame(
        &mut self,
        camera: &Camera,
        clip: &Clip,
        settings: &Settings,
        repeat: Repeat,
    ) -> Result<FrameSummary> {
        let most = match repeat {
            Repeat::Unmeasured => return self.frame(camera, clip, settings, 1),
            Repeat::Following => {
                return Ok(FrameSummary::from_frames(&[
                    self.next_frame(camera, clip, settings)?
                ]));
            }
            Repeat::Exactly(most) | Repeat::UpTo(most) => most,
        };
        if self.first_ms.is_empty() {
            self.warm_up([(camera, clip, settings)])?;
        }
        let begin = Instant::now();
        let mut frames = Vec::new();
        for _ in 0..most {
            frames.push(self.one(camera, clip, settings)?);
            if matches!(repeat, Repeat::UpTo(_)) && begin.elapsed() > PATIENCE {
                break;
            }
        }
        Ok(FrameSummary::from_frames(&frames))
    }

    /// Uploads the scene once more, its spherical harmonics stored in another way.
    pub(super) fn reload(&mut self, scene: &Scene<'_>, sh: ShFormat) -> Result<()> {
        self.headless.load_as(scene, sh)
    }

    /// Gives the layers the clips that they have in a scene of the same layers.
    pub(super) fn set_layer_clips(&mut self, scene: &Scene<'_>) -> Result<()> {
        let layers = scene.layers().iter().enumerate();
        layers
            .map(|(index, layer)| (index, layer.clip().cloned()))
            .try_for_each(|(index, clip)| self.headless.set_layer_clip(index, clip))
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

    /// Renders the frame `repeat` times from nothing.
    pub(super) fn frame(
        &mut self,
        camera: &Camera,
        clip: &Clip,
        settings: &Settings,
        repeat: u32,
    ) -> Result<FrameSummary> {
        let frames = (0..repeat).map(|_| self.one(camera, clip, settings));
        Ok(FrameSummary::from_frames(
            &frames.collect::<Result<Vec<_>>>()?,
        ))
    }

    /// Renders a frame that takes over nothing.
    pub(super) fn one(
        &mut self,
        camera: &Camera,
        clip: &Clip,
        settings: &Settings,
    ) -> Result<FrameStats> {
        fresh(&mut self.headless, camera, clip, settings)
    }

    pub(super) fn picture(
        &mut self,
        camera: &Camera,
        clip: &Clip,
        settings: &Settings,
    ) -> Result<(Picture, FrameStats)> {
        let stats = self.one(camera, clip, settings)?;
        Ok((self.last_picture()?, stats))
    }

    /// Channels beside the colours of a frame of the scene that is loaded.
    pub(super) fn channels(
        &mut self,
        aovs: &[Aov],
        frame: (&Camera, &Clip, &Settings),
    ) -> Result<Vec<Channel>> {
        self.headless.channels(aovs, frame)
    }

    pub(super) fn last_picture(&mut self) -> Result<Picture> {
        self.headless.picture()
    }

    /// The same, for a thread to decode.
    pub(super) fn last_stored(&mut self) -> Result<StoredPicture> {
        self.headless.read_back()
    }

    /// Frees everything; an error is what the validation layer has reported about it.
    pub(super) fn close(self) -> Result<()> {
        self.headless.close()
    }

    /// True when the device counts what the stages do.
    pub(super) fn has_statistics(&self) -> bool {
        self.headless.device().support().pipeline_statistics
    }

    /// Device memory by what it is for, the largest first.
    pub(super) fn memory_by_name(&self) -> Vec<rara::gpu::NamedBytes> {
        self.headless.device().memory_by_name()
    }

    pub(super) fn scene_bytes(&self) -> u64 {
        self.headless.scene_bytes()
    }

    /// The kind of machine that pipelines were chosen for, and the reason.
    pub(super) fn shape(&self) -> (DeviceShape, &'static str) {
        let device = self.headless.device();
        (device.shape(), device.shape_reason())
    }

    pub(super) fn driver(&self) -> &str {
        self.headless.driver()
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
