//! What participants judge.

use serde::{Deserialize, Serialize};

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Metric {
    /// Whether the cut is even.
    Flatness,
    /// Whether it changes evenly while it moves.
    TemporalStability,
    /// Whether what belongs together stays together.
    TopologicalIntegrity,
    /// Whether it looks as if something real had been cut.
    Naturalness,
    /// Whether it shows what is to be seen.
    RoiExposure,
    /// Whether what is around it stays visible.
    ContextCompleteness,
}

impl Metric {
    /// All of them: three for the first group of participants, then three for the second one.
    pub const ALL: [Self; 6] = [
        Self::Flatness,
        Self::TemporalStability,
        Self::TopologicalIntegrity,
        Self::Naturalness,
        Self::RoiExposure,
        Self::ContextCompleteness,
    ];

    pub fn name(self) -> &'static str {
        match self {
            Self::Flatness => "Flatness",
            Self::TemporalStability => "Temporal stability",
            Self::TopologicalIntegrity => "Topological integrity",
            Self::Naturalness => "Naturalness",
            Self::RoiExposure => "ROI exposure",
            Self::ContextCompleteness => "Context completeness",
        }
    }

    /// What participants read before they choose.
    pub(super) fn definition(self) -> &'static str {
        match self {
            Self::Flatness => {
                "Where is the cut surface smoother and more even, with fewer steps, spikes and ragged edges?"
            }
            Self::TemporalStability => {
                "Watch the animations. Where does the surface change more smoothly while the cut \
                 moves, without parts that flicker, or appear and disappear at once?"
            }
            Self::TopologicalIntegrity => {
                "Where are there fewer holes, breaks and loose fragments, so that what belongs together stays together?"
            }
            Self::Naturalness => {
                "Where does the cut fit better into what surrounds it, as if a real object had been cut with a knife?"
            }
            Self::RoiExposure => {
                "The region of interest is what the cut lays open. Where can it be seen more clearly, without anything \
                 important hidden?"
            }
            Self::ContextCompleteness => {
                "Where does more of the surroundings stay visible, so that you know better what you are looking at?"
            }
        }
    }
}
