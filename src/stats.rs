//! The statistics of a frame; the `--json` statistics are made of it.

/// How many Gaussians are of which class. `visible + cutoff + invisible + culled` is the scene's count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Counts {
    /// In view and untouched by the clip.
    pub visible: u32,
    /// In view and cut by the clip.
    pub cutoff: u32,
    /// In view but wholly clipped away.
    pub invisible: u32,
    /// Outside the view or too faint, whatever the clip says.
    pub culled: u32,
    /// Splats handed to the rasteriser.
    pub drawn: u32,
}

/// GPU time of one stage.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct PassTime {
    /// The stage: the same name as its shader, module and debug label.
    pub name: &'static str,
    /// Milliseconds between its timestamps.
    pub ms: f64,
}

/// The work of one stage, as the device counts it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct PassStatistics {
    /// The stage.
    pub name: &'static str,
    /// Compute shader invocations.
    pub compute_invocations: u64,
    /// Vertex shader invocations; mesh shaders have none.
    pub vertex_invocations: u64,
    /// Primitives that are left after clipping.
    pub primitives: u64,
    /// Fragment shader invocations.
    pub fragment_invocations: u64,
}

/// Which way of turning splats into pixels a frame took.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct RasterChoice {
    /// `mesh`, `quad` or `tiles`; empty before the first frame.
    pub path: &'static str,
    /// Why.
    pub reason: &'static str,
}

/// The statistics of one frame.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
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
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub statistics: Vec<PassStatistics>,
}
