//! The six qualities that the paper asks people about, measured in every case.

use rara::{Clip, Headless, Mode, Picture, Result, Settings, reference};
use serde::{Deserialize, Serialize};

use crate::bench::{band, truth_settings, ways};
use crate::cases::Case;
use crate::frames::picture;
use crate::measure::{self, Popping, Qualities, Truth};

/// How far from the middle of the cut's way the cut lies that removes a little more.
const DEEPER: f64 = 0.1;
/// One way of cutting in one case.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct PerceptionMeasures {
    pub way: String,
    pub qualities: Qualities,
    /// Mean absolute difference from the truth, on a scale of 0 to 255.
    pub l1: f64,
    pub max: f64,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Outcome {
    pub case: String,
    pub ways: Vec<PerceptionMeasures>,
}

pub(super) struct Pictures {
    pub(super) truth: Picture,
    pub(super) ways: Vec<Picture>,
}

/// Measures all ways of cutting in one case, with a sweep of so many steps, and returns the pictures of the
/// cut too. The device holds the scene.
pub(super) fn measure(
    headless: &mut Headless,
    name: String,
    (scene, case): (&rara::Scene<'_>, &Case),
    steps: u32,
) -> Result<(Outcome, Pictures)> {
    let settings = truth_settings(&Settings::default());
    let draw = |clip: &Clip, settings: &Settings| {
        reference::render::<f64>(scene, &case.camera, clip, settings).picture
    };
    let middle = case.at(0.5)?;
    let cut = draw(&middle, &settings);
    let by_centres = draw(&middle, &Settings::default().mode(Mode::Hard));
    let truth = Truth {
        whole: draw(&Clip::default(), &settings),
        deeper: draw(&case.at(0.5 + DEEPER)?, &settings),
        band: band(&by_centres, &cut)?,
        cut,
    };
    let at = |step: u32| case.at(f64::from(step) / f64::from(steps.max(1)));
    let clips = (0..=steps).map(at).collect::<Result<Vec<_>>>()?;
    let truths: Vec<Picture> = clips.iter().map(|clip| draw(clip, &settings)).collect();
    let (mut measured, mut pictures) = (Vec::new(), Vec::new());
    for (way, settings) in ways(Settings::default()) {
        let popping = popping(headless, case, &clips, &truths, &settings)?;
        let (drawn, _) = picture(headless, &case.camera, &middle, &settings)?;
        let apart = measure::differences(&drawn, &truth.cut)?;
        measured.push(PerceptionMeasures {
            way: way.into(),
            qualities: truth.measure(&drawn, &popping)?,
            l1: apart.l1,
            max: apart.max,
        });
        pictures.push(drawn);
    }
    let outcome = Outcome {
        case: name,
        ways: measured,
    };
    let pictures = Pictures {
        truth: truth.cut,
        ways: pictures,
    };
    Ok((outcome, pictures))
}

/// What the frames of a sweep change beyond the truth's.
fn popping(
    headless: &mut Headless,
    case: &Case,
    clips: &[Clip],
    truths: &[Picture],
    settings: &Settings,
) -> Result<Popping> {
    let frame = |clip: &Clip| {
        headless.render(&case.camera, clip, settings)?;
        headless.picture()
    };
    let pictures = clips.iter().map(frame).collect::<Result<Vec<_>>>()?;
    measure::popping(&pictures, truths)
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Quality {
    /// The cut edge is where the true one is.
    Flatness,
    /// Nothing changes from step to step that the truth does not change.
    Stability,
    /// There are the pieces and the holes of the truth.
    Topology,
    /// What is around the cut looks like the truth.
    Naturalness,
    /// Nothing of what was removed is left.
    Exposure,
    /// Nothing of what stays is lost.
    Completeness,
}

impl Quality {
    /// All of them, in the paper's order.
    pub(super) const ALL: [Self; 6] = [
        Self::Flatness,
        Self::Stability,
        Self::Topology,
        Self::Naturalness,
        Self::Exposure,
        Self::Completeness,
    ];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Flatness => "flatness",
            Self::Stability => "temporal stability",
            Self::Topology => "topological integrity",
            Self::Naturalness => "naturalness",
            Self::Exposure => "ROI exposure",
            Self::Completeness => "context completeness",
        }
    }

    /// What its defect is, and in which unit.
    pub(super) fn defect(self) -> &'static str {
        match self {
            Self::Flatness => "distance of the edge (px)",
            Self::Stability => "change beyond the truth's (of 255)",
            Self::Topology => "pieces and holes too many or too few",
            Self::Naturalness => "1 - SSIM around the cut",
            Self::Exposure => "energy that leaks (%)",
            Self::Completeness => "energy that is lost (%)",
        }
    }

    /// How large the defect is: 0 is the truth. `None` where it cannot be measured.
    pub(super) fn of(self, q: &Qualities) -> Option<f64> {
        match self {
            Self::Flatness => q.flatness,
            Self::Stability => Some(q.stability),
            Self::Topology => Some(q.topology),
            Self::Naturalness => q.naturalness.map(|ssim| 1.0 - ssim),
            Self::Exposure => Some(100.0 * q.exposure),
            Self::Completeness => Some(100.0 * q.completeness),
        }
    }
}
