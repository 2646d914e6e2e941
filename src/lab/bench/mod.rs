//! What each mode and each choice of precision costs and how far its picture is from the exact cut.

mod clock;
mod judge;
mod report;
pub(crate) mod shapes;
mod tables;
mod variants;
mod ways;

use rara::{Camera, Clip, Headless, Plane, Result, Scene, Settings};

use crate::measure::undominated;
pub(crate) use clock::time;
use judge::Judge;
pub(crate) use judge::{band, truth_settings};
pub use report::BenchReport;
use report::ChoiceRow;
pub use variants::names;
pub(crate) use ways::ways;

#[derive(Debug, Clone)]
pub struct BenchOptions {
    /// Frames of each choice, one of each in turn.
    pub frames: u32,
    /// Steps of the slow sweep that popping is measured over, each a 300th of the scene.
    pub steps: u32,
    /// The names of the choices; all if empty.
    pub only: Vec<String>,
    /// A plane beside which shapes through the same point are measured.
    pub shapes: Option<Plane>,
}

/// Measures the choices on a scene. What is not within its own bound of its own picture in double precision is not timed.
/// `progress` hears how many of how many steps are done.
pub fn bench(
    headless: &mut Headless,
    (scene, camera, clip): (&Scene<'_>, &Camera, &Clip),
    look: &Settings,
    options: &BenchOptions,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<BenchReport> {
    let mut all = variants::variants(*look);
    all.retain(|v| options.only.is_empty() || options.only.iter().any(|name| name == v.name));
    let total = all.len() as u64 + 2;

    // First which pictures are right and how far each is from the truth; then what they cost.
    let judge = Judge::new(scene, camera, clip, look, options.steps)?;
    let (mut right, mut measured, mut refused) = (Vec::new(), Vec::new(), Vec::new());
    for (done, variant) in all.into_iter().enumerate() {
        progress(done as u64, total);
        headless.load_as(scene, variant.settings.precision.sh)?;
        let measures = judge.measure(headless, &variant.settings)?;
        let least = variant.settings.precision.least_psnr();
        if measures.twin_psnr >= least {
            right.push(variant);
            measured.push(measures);
        } else {
            refused.push(format!(
                "{} ({}): {:.1} dB against its own picture in double precision, where {least} is the least",
                variant.name, variant.flags, measures.twin_psnr
            ));
        }
    }
    progress(total - 1, total);
    let named: Vec<_> = right.iter().map(|v| v.name).zip(&measured).collect();
    let ways = ways::lines(headless, scene, (camera, clip), look, options.steps, &named)?;
    let settings: Vec<_> = right.iter().map(|v| (clip, v.settings)).collect();
    let times = clock::time(headless, scene, camera, &settings, options.frames)?;
    let shapes = match options.shapes {
        Some(plane) => shapes::lines(headless, scene, camera, plane, look, options.frames)?,
        None => Vec::new(),
    };

    let rows = right.iter().zip(measured).zip(times);
    let mut rows: Vec<ChoiceRow> = rows
        .map(|((variant, measures), times)| ChoiceRow {
            name: variant.name,
            flags: variant.flags,
            measures,
            times,
            undominated: false,
        })
        .collect();
    // Mode `none` is left out, since it is no way of cutting.
    let point = |row: &ChoiceRow| match row.name {
        "none" => [f64::NAN; 2],
        _ => [row.times.cost, row.measures.l1],
    };
    let points: Vec<_> = rows.iter().map(point).collect();
    for index in undominated(&points) {
        rows[index].undominated = true;
    }
    let names: Vec<_> = scene.layers().iter().map(|layer| layer.name()).collect();
    Ok(BenchReport {
        scene: names.join(" + "),
        gaussians: scene.gaussians(),
        size: [camera.width, camera.height],
        device: headless.device_name().to_owned(),
        driver: headless.driver().to_owned(),
        frames: options.frames,
        steps: options.steps,
        band_share: judge.band_share(),
        rows,
        ways,
        shapes,
        refused,
    })
}
