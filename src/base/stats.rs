//! The statistics that stages count, and the median that many of them are summed up by.

/// The number of Gaussians in each class. `visible + cutoff + invisible + culled` is the number of Gaussians in the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "json", derive(serde::Serialize))]
pub struct Counts {
    /// The Gaussians in view that the clip leaves whole.
    pub visible: u32,
    /// The Gaussians in view that the clip cuts.
    pub cutoff: u32,
    /// The Gaussians in view of which the clip keeps nothing.
    pub invisible: u32,
    /// The Gaussians that are out of view, too faint or in a hidden layer, whatever their side of the clip.
    pub culled: u32,
    /// The splats that are given to the rasteriser.
    pub drawn: u32,
    /// The cut Gaussians whose weight takes fewer surfaces into account than cut them. They are cut by more surfaces than a
    /// record has room for, and there was not enough memory for all longer records.
    pub shortened: u32,
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

/// The middle value, or the mean of the two in the middle; `None` of nothing.
pub fn median(values: &[f64]) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    match sorted.len() {
        0 => None,
        n if n % 2 == 1 => Some(sorted[middle]),
        _ => Some(f64::midpoint(sorted[middle - 1], sorted[middle])),
    }
}
