//! How much is measured, and everything that was.

use serde::{Deserialize, Serialize};

use super::ablation;
use super::efficiency::Efficiency;
use super::perception::Outcome;
use super::series::Series;
use crate::table::Table;

#[derive(Debug, Clone, Hash, Serialize)]
pub struct PaperOptions {
    /// Width and height of the pictures that are timed, pixels.
    pub size: u32,
    /// Width and height of the pictures of the cases, pixels.
    pub case_size: u32,
    pub frames: u32,
    /// Sweeps of each mode, and frames of each choice.
    pub repeats: u32,
    /// Steps of the slow sweep of each case.
    pub steps: u32,
    /// The scenes that are timed, by their numbers.
    pub timed: Vec<usize>,
    /// Gaussians of the scenes in which one property varies.
    pub count: usize,
    /// True for all choices of precision; only the ways of cutting and the presets otherwise.
    pub all_choices: bool,
}

impl PaperOptions {
    /// A few minutes on two cores, on generated scenes of 6 000 Gaussians.
    pub fn quick() -> Self {
        Self {
            size: 256,
            case_size: 160,
            frames: 30,
            repeats: 3,
            steps: 120,
            timed: vec![0, 3, 6],
            count: 10_000,
            all_choices: false,
        }
    }

    /// The better part of an hour on two cores, on scans of 100 000 Gaussians.
    pub fn thorough() -> Self {
        Self {
            size: 512,
            case_size: 256,
            repeats: 5,
            count: 100_000,
            all_choices: true,
            ..Self::quick()
        }
    }
}

/// The choices of a scene: cost against error.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Choices {
    pub(super) tables: Vec<Table>,
    pub(super) chart: String,
    pub(super) refused: Vec<String>,
}

/// The pictures of one case, as files below the report's folder.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Maps {
    pub(super) case: String,
    /// The truth, then each way: its name, picture, map of errors, and the worst piece of both, magnified. The truth has no
    /// map.
    pub(super) pictures: Vec<(String, [Option<String>; 4])>,
}

#[derive(Debug, Serialize)]
pub(super) struct Results {
    pub(super) version: &'static str,
    pub(super) device: String,
    pub(super) driver: String,
    pub(super) options: PaperOptions,
    pub(super) scenes: Vec<(String, usize)>,
    pub(super) seconds: f64,
    pub(super) efficiency: Vec<Efficiency>,
    pub(super) ablation: Vec<(String, Vec<ablation::AblationRow>)>,
    pub(super) outcomes: Vec<Outcome>,
    pub(super) maps: Vec<Maps>,
    pub(super) choices: Vec<(String, Choices)>,
    pub(super) series: Vec<Series>,
}
