//! The three ways of cutting that the paper compares, against the truth, at a small size and at the size asked for.

use rara::{Camera, Clip, Headless, Miss, Mode, Result, Scene, Settings};
use serde::Serialize;

use super::judge::{Judge, Measures};

/// Pixels a side of the small picture.
const SMALL: u32 = 256;

#[derive(Debug, Serialize)]
pub(crate) struct WayRow {
    pub(crate) size: [u32; 2],
    pub(crate) name: &'static str,
    #[serde(flatten)]
    pub(crate) measures: Measures,
    /// How many times exact is nearer to the truth, by L1.
    pub(crate) l1_over_exact: f64,
}

/// Measures all ways at the small size, in the precision of `look`. `measured` has them by name at the size asked for.
pub(crate) fn lines(
    headless: &mut Headless,
    scene: &Scene<'_>,
    (camera, clip): (&Camera, &Clip),
    look: &Settings,
    steps: u32,
    measured: &[(&str, &Measures)],
) -> Result<Vec<WayRow>> {
    headless.load_as(scene, look.precision.sh)?;
    let small_camera = camera.resized((SMALL, SMALL * camera.height / camera.width.max(1)))?;
    let small = Judge::new(scene, &small_camera, clip, look, steps)?;
    let mut of_small = Vec::new();
    for (name, settings) in ways(*look) {
        of_small.push((name, small.measure(headless, &settings)?));
    }
    let known = |name| measured.iter().find(|(have, _)| *have == name);
    let of_size = ways(*look).map(|(name, _)| Some((name, known(name)?.1.clone())));
    let mut lines = with_ratios(&small_camera, of_small);
    if [small_camera.width, small_camera.height] != [camera.width, camera.height] {
        lines.extend(with_ratios(camera, of_size.into_iter().flatten().collect()));
    }
    Ok(lines)
}

fn with_ratios(camera: &Camera, measured: Vec<(&'static str, Measures)>) -> Vec<WayRow> {
    let exact = measured.iter().find(|(name, _)| *name == "exact");
    let exact = exact.map_or(f64::NAN, |(_, measures)| measures.l1);
    let line = |(name, measures): (&'static str, Measures)| WayRow {
        size: [camera.width, camera.height],
        name,
        l1_over_exact: measures.l1 / exact.max(1e-12),
        measures,
    };
    measured.into_iter().map(line).collect()
}

/// Cuts by centre, by the paper's text, by our default reading of it, and exactly; the others are compared with the last.
pub(crate) fn ways(look: Settings) -> [(&'static str, Settings); 4] {
    let mode = |mode| look.mode(mode);
    let paper = mode(Mode::Rara).sigma(1.0).miss(Miss::Keep);
    [
        ("hard", mode(Mode::Hard)),
        ("rara, paper", paper),
        ("rara", mode(Mode::Rara)),
        ("exact", mode(Mode::Exact)),
    ]
}
