//! The six qualities that the paper asks people about, measured in every case.

use rara::{Clip, Headless, Mode, Picture, Result, Settings};
use serde::{Deserialize, Serialize};

use crate::bench::{band, truth_settings, ways};
use crate::cases::Case;
use crate::frames::picture;
use crate::measure::{self, Popping, Qualities, Truth};
use crate::study::Metric;

/// How far from the middle of the cut's way the cut lies that removes a little more.
const DEEPER: f64 = 0.1;
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
        rara_reference::render::<f64>(scene, &case.camera, clip, settings).picture
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

/// What the defect of a quality is, and in which unit.
pub(super) fn defect(quality: Metric) -> &'static str {
    match quality {
        Metric::Flatness => "distance of the edge (px)",
        Metric::TemporalStability => "change beyond the truth's (of 255)",
        Metric::TopologicalIntegrity => "pieces and holes too many or too few",
        Metric::Naturalness => "1 - SSIM around the cut",
        Metric::RoiExposure => "energy that leaks (%)",
        Metric::ContextCompleteness => "energy that is lost (%)",
    }
}

/// How large the defect is: 0 is the truth. `None` where it cannot be measured.
pub(super) fn measured(quality: Metric, q: &Qualities) -> Option<f64> {
    match quality {
        Metric::Flatness => q.flatness,
        Metric::TemporalStability => Some(q.stability),
        Metric::TopologicalIntegrity => Some(q.topology),
        Metric::Naturalness => q.naturalness.map(|ssim| 1.0 - ssim),
        Metric::RoiExposure => Some(100.0 * q.exposure),
        Metric::ContextCompleteness => Some(100.0 * q.completeness),
    }
}
