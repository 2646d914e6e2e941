//! Device, renderer, target and readback in one: scenes in, pictures out, no window.

use crate::{Camera, Clip, FrameStats, Gaussians, Picture, Result, Settings};

/// What a headless renderer is created with.
#[derive(Debug, Clone, Default)]
pub struct HeadlessDesc {
    /// Device number or part of its name; `None` is the best device.
    pub device: Option<String>,
    /// Load the Khronos validation layer with synchronisation checks; any message becomes [`Error::Validation`](crate::Error::Validation).
    pub validation: bool,
}

/// A renderer that owns its device and draws into an offscreen 32-bit float picture.
#[derive(Debug)]
pub struct Headless {}

impl Headless {
    /// Opens the device.
    pub fn new(_desc: &HeadlessDesc) -> Result<Self> {
        Ok(Self {})
    }

    /// The device's name, for people.
    pub fn device_name(&self) -> &str {
        ""
    }

    /// The driver's name and version, for people.
    pub fn driver(&self) -> &str {
        ""
    }

    /// Device memory in use, bytes.
    pub fn device_bytes(&self) -> u64 {
        0
    }

    /// Uploads a scene in place of the one before.
    pub fn load(&mut self, _scene: &Gaussians) -> Result<()> {
        Ok(())
    }

    /// Renders one frame of the scene; the picture stays on the device.
    pub fn render(
        &mut self,
        _camera: &Camera,
        _clip: &Clip,
        _settings: &Settings,
    ) -> Result<FrameStats> {
        Ok(FrameStats::default())
    }

    /// Reads the picture of the last frame back.
    pub fn picture(&mut self) -> Result<Picture> {
        Ok(Picture::default())
    }
}
