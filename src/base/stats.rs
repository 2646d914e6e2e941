//! The statistics that stages count.

/// How many Gaussians are of which class. `visible + cutoff + invisible + culled` is the scene's count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "json", derive(serde::Serialize))]
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

/// The work of one stage, as the device counts it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "json", derive(serde::Serialize))]
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

impl PassStatistics {
    /// Those of a stage that has done nothing yet.
    #[doc(hidden)]
    pub fn new(name: &'static str) -> Self {
        Self {
            name,
            ..Self::default()
        }
    }
}
