//! What was measured.

use serde::Serialize;

use super::clock::Times;
use super::judge::Measures;
use super::{shapes, ways};
use crate::charts::{Axis, Plot, Series};

#[derive(Debug, Serialize)]
pub struct BenchReport {
    /// The names of the layers.
    pub(crate) scene: String,
    pub(crate) gaussians: usize,
    /// Pixels across and down.
    pub(crate) size: [u32; 2],
    pub(crate) device: String,
    pub(crate) driver: String,
    pub(crate) frames: u32,
    pub(crate) steps: u32,
    /// Share of the picture in which the way of cutting makes a difference: where the hard and the exact truth differ,
    /// and 5 px around.
    pub(crate) band_share: f64,
    pub(crate) rows: Vec<ChoiceRow>,
    /// The ways of cutting at two sizes.
    #[serde(rename = "paper")] // the name that scripts know
    pub(crate) ways: Vec<ways::WayRow>,
    pub(crate) shapes: Vec<shapes::ShapeRow>,
    /// Choices whose pictures are wrong, and why.
    pub refused: Vec<String>,
}

#[derive(Debug, Serialize)]
pub(crate) struct ChoiceRow {
    pub(crate) name: &'static str,
    pub(crate) flags: &'static str,
    #[serde(flatten)]
    pub(crate) measures: Measures,
    #[serde(flatten)]
    pub(crate) times: Times,
    /// True when no other choice is both faster and nearer to the truth.
    pub(crate) undominated: bool,
}

impl BenchReport {
    /// Cost against error, with the front of what nothing beats.
    pub fn chart(&self) -> Plot {
        let of = |kind: ChoiceKind| {
            let rows = self.rows.iter();
            let rows = rows
                .filter(move |row| row.name != "none" && ChoiceKind::from_name(row.name) == kind);
            let points = rows.map(|row| (row.times.cost, row.measures.l1, row.name.into()));
            Series {
                name: kind.name().into(),
                points: points.collect(),
            }
        };
        let front = self.rows.iter().filter(|row| row.undominated);
        Plot {
            title: format!("{}: run time against error", self.scene),
            x: Axis::log("Cost (ms per frame)"),
            y: Axis::log("L1 against the truth (of 255)"),
            series: [ChoiceKind::Way, ChoiceKind::Law, ChoiceKind::Precision]
                .map(of)
                .into(),
            joined: false,
            front: front.map(|row| [row.times.cost, row.measures.l1]).collect(),
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum ChoiceKind {
    Way,
    /// How a weight changes opacity, and in which form it is computed.
    Law,
    Precision,
}

impl ChoiceKind {
    fn from_name(name: &str) -> Self {
        match name {
            "hard" | "rara, paper" | "rara, released" | "rara" | "exact" => Self::Way,
            _ if name.contains("law") || name.contains("affine") => Self::Law,
            _ => Self::Precision,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Way => "ways of cutting",
            Self::Law => "laws and forms",
            Self::Precision => "precision",
        }
    }
}
