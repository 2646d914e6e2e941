//! The statistics of a frame; the `--json` statistics are made of it.

use rara_base::stats::{Counts, PassStatistics};

/// GPU time of one stage.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "json", derive(serde::Serialize))]
pub struct PassTime {
    /// The stage: the same name as its shader, module and debug label.
    pub name: &'static str,
    /// Milliseconds between its timestamps.
    pub ms: f64,
}

/// The raster path that a frame took, and the reason.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "json", derive(serde::Serialize))]
#[non_exhaustive]
pub struct RasterChoice {
    /// `mesh`, `quad` or `tiles`; empty before the first frame.
    pub path: &'static str,
    /// Why.
    pub reason: &'static str,
}

/// The statistics of one frame.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "json", derive(serde::Serialize))]
#[non_exhaustive]
pub struct FrameStats {
    /// How many Gaussians are of which class.
    pub counts: Counts,
    /// GPU time of each stage, in order.
    pub passes: Vec<PassTime>,
    /// GPU time of the frame, milliseconds: 0 for one that computed nothing, `None` where no times were taken.
    pub gpu_ms: Option<f64>,
    /// From recording to the picture being ready on the device, milliseconds.
    pub wall_ms: f64,
    /// The stages that this frame did not need.
    pub skipped: Vec<&'static str>,
    /// How splats became pixels, and why in that way.
    pub raster: RasterChoice,
    /// The work of each stage, where that was asked for and the device counts it.
    #[cfg_attr(feature = "json", serde(skip_serializing_if = "Vec::is_empty"))]
    pub statistics: Vec<PassStatistics>,
}
