//! A device and the scene on it, and the frames that are measured there.
//!
//! What a driver compiles when a shader is used first would be in the time of the first frame, so a frame is measured
//! after one that is not; what that one took longer is reported by itself.

use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use glam::DVec3;
use rara::scene::{Bounds, Kind, generate};
use rara::{
    Camera, Clip, FrameStats, Headless, HeadlessDesc, Layer, Picture, Result, Scene, Settings,
    ShFormat,
};

use super::combine::FrameSummary;
use super::output::Compiling;
use super::process;

pub(super) struct Session {
    pub(super) headless: Headless,
    /// Times from recording to the picture of the frames that are not measured, milliseconds.
    first_ms: Vec<f64>,
}

/// The first frame of a command, as far as it is known before its scene is read.
pub(super) struct FirstFrame {
    pub(super) device: HeadlessDesc,
    pub(super) layers: usize,
    pub(super) clip: Clip,
    pub(super) settings: Settings,
}

/// A session that a thread opens while the scene is read. It draws an example of a scene meanwhile, so that the driver compiles
/// the first frame's shaders.
pub(super) struct SessionAhead(Option<JoinHandle<Result<Session>>>);

impl SessionAhead {
    pub(super) fn begin(first: FirstFrame) -> Self {
        process::make_drivers_folder();
        let named = thread::Builder::new().name("compiling".into());
        Self(named.spawn(move || Session::of_example(&first)).ok())
    }

    /// The session. What has kept it from being there is found again by whoever opens it then.
    pub(super) fn end(mut self) -> Option<Session> {
        self.0.take()?.join().ok()?.ok()
    }
}

/// The thread ends before the process does, which would take away what its driver uses.
impl Drop for SessionAhead {
    fn drop(&mut self) {
        drop(self.0.take().map(JoinHandle::join));
    }
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
    pub(super) fn open<'a>(
        desc: &HeadlessDesc,
        scene: impl Into<Scene<'a>>,
        sh: ShFormat,
    ) -> Result<Self> {
        process::make_drivers_folder();
        let mut headless = Headless::new(desc)?;
        headless.load_as(scene, sh)?;
        Ok(Self {
            headless,
            first_ms: Vec::new(),
        })
    }

    /// Opens a session that has drawn an example of a scene.
    fn of_example(first: &FirstFrame) -> Result<Self> {
        let gaussians = generate(Kind::General, 500, 1);
        let up = -DVec3::Y;
        let camera = Camera::frame(&Bounds::of(&gaussians), up, 50.0, (64, 64))?;
        let layer = |number: usize| Layer::new(number.to_string(), &gaussians);
        let scene: Scene<'_> = (0..first.layers.max(1)).map(layer).collect();
        let mut session = Self::open(&first.device, scene, first.settings.precision.sh)?;
        session.fresh(&camera, &first.clip, &first.settings)?;
        Ok(session)
    }

    /// Draws frames that are not measured, so that the driver compiles their shaders before the measured frames. Each frame may
    /// reuse results of the one before.
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
                let frame = self.headless.render(camera, clip, settings)?;
                return Ok(FrameSummary::from_frames(&[frame]));
            }
            Repeat::Exactly(most) | Repeat::UpTo(most) => most,
        };
        if self.first_ms.is_empty() {
            self.warm_up([(camera, clip, settings)])?;
        }
        let begin = Instant::now();
        let mut frames = Vec::new();
        for _ in 0..most {
            frames.push(self.fresh(camera, clip, settings)?);
            if matches!(repeat, Repeat::UpTo(_)) && begin.elapsed() > PATIENCE {
                break;
            }
        }
        Ok(FrameSummary::from_frames(&frames))
    }

    /// Draws a frame that reuses nothing of the one before.
    pub(super) fn fresh(
        &mut self,
        camera: &Camera,
        clip: &Clip,
        settings: &Settings,
    ) -> Result<FrameStats> {
        self.headless.forget();
        self.headless.render(camera, clip, settings)
    }

    /// The picture of such a frame.
    pub(super) fn picture(
        &mut self,
        camera: &Camera,
        clip: &Clip,
        settings: &Settings,
    ) -> Result<Picture> {
        self.fresh(camera, clip, settings)?;
        self.headless.picture()
    }

    /// Gives the layers the clips that they have in a scene of the same layers.
    pub(super) fn set_layer_clips(&mut self, scene: &Scene<'_>) -> Result<()> {
        let layers = scene.layers().iter().enumerate();
        layers
            .map(|(index, layer)| (index, layer.clip().cloned()))
            .try_for_each(|(index, clip)| self.headless.set_layer_clip(index, clip))
    }

    /// Renders the frame `repeat` times from nothing.
    pub(super) fn frame(
        &mut self,
        camera: &Camera,
        clip: &Clip,
        settings: &Settings,
        repeat: u32,
    ) -> Result<FrameSummary> {
        let frames = (0..repeat).map(|_| self.fresh(camera, clip, settings));
        Ok(FrameSummary::from_frames(
            &frames.collect::<Result<Vec<_>>>()?,
        ))
    }
}
