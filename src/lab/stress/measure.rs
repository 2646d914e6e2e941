//! The measures of a regime: pictures of the GPU against pictures of the reference in double precision.

use std::panic;
use std::thread::{self, ScopedJoinHandle};

use serde::Serialize;

use super::{COARSE, Case, Limit, Regime, TARGET};
use crate::measure::{Differences, differences};
use rara::{Clip, Counts, Decay, ExactForm, Headless, Mode, Picture, Raster, Result, Settings};
use rara_base::limits::ALPHA_MIN_INVERSE;
use rara_gpu::DeviceShape;

/// The forms of the cut that are measured. Mode `rara` only has to be finite and right in the picture: its length
/// ratio jumps where a ray leaves the ellipsoid.
const FORMS: [(&str, Mode, ExactForm); 4] = [
    ("affine", Mode::Exact, ExactForm::Affine),
    ("beam", Mode::Exact, ExactForm::Beam),
    ("auto", Mode::Exact, ExactForm::Auto),
    ("rara", Mode::Rara, ExactForm::Auto),
];
/// Pixels whose uncut alpha is this near to 1/255, relatively, may count on one side and not on the other.
const THRESHOLD_BAND: f64 = 2e-3;
/// The limits of pictures: decibels, and the share of pixels that are more than 2/255 off.
const PICTURE_PSNR: f64 = 60.0;
const PICTURE_SHARE: f64 = 1e-3;

/// One form of the cut in one regime: the worst of all cases.
#[derive(Debug, Clone, Copy, Default, Serialize)]
pub struct FormRow {
    /// `affine`, `beam`, `auto` or `rara`.
    pub form: &'static str,
    /// Largest difference of alpha times weight in a pixel, GPU against the same form in f64, single splats only.
    pub weight: f64,
    /// Worst picture of crowds and single splats: mean difference, units of 1/255.
    pub l1: f64,
    /// Peak signal to noise ratio of the worst picture, decibels; infinite (null in JSON) where equal.
    pub psnr: f64,
    /// Largest difference of a channel in any picture, units of 1/255, relative to the picture's largest value.
    pub max: f64,
    /// Largest share of a picture's pixels that are more than 2/255 off.
    pub share_over_2: f64,
    /// For information: how far the form itself is from the perspective-exact one, both in f64: the sum of the
    /// differences of alpha times weight over the sum of alpha.
    pub model: f64,
}

#[derive(Debug, Clone, Default, Serialize)]
pub struct RegimeRow {
    pub regime: &'static str,
    /// Splats drawn, in all cases together.
    pub splats: usize,
    /// Largest error of the uncut alpha in a pixel, single splats only: what no form of the cut can be better than.
    pub alpha: f64,
    /// Pixels whose alpha is at least 1/255 but that the drawn tiles or quads miss.
    pub missed: usize,
    /// Values of pictures that are not finite.
    pub not_finite: usize,
    /// Most splats of a case that are visible, cut, invisible or culled here and not in the reference.
    pub miscounted: u32,
    pub forms: Vec<FormRow>,
    pub target: f64,
    /// The limit of pictures, decibels.
    pub least_psnr: f64,
    /// Why these are not the suite's targets.
    pub reason: Option<&'static str>,
    /// True when everything is as it must be.
    pub ok: bool,
}

impl RegimeRow {
    fn judge(&self, exact: Option<f64>) -> bool {
        let good = |form: &FormRow| {
            let weight = form.form == "rara" || form.weight <= self.target;
            let order = exact.is_none_or(|most| form.max <= 255.0 * most);
            let share = form.share_over_2 <= PICTURE_SHARE || self.least_psnr < PICTURE_PSNR;
            weight && order && form.psnr >= self.least_psnr && share
        };
        // A splat whose contour touches a pixel's centre or a plane to seven digits may be counted on either side.
        let counted = self.miscounted <= 1;
        self.missed == 0 && self.not_finite == 0 && counted && self.forms.iter().all(good)
    }
}

/// Draws every `every`-th case of a regime in every form, and measures. Single splats are drawn by tiles in one case and by
/// quads in the next, in each form, and by both where cases are left out; crowds by both. Any message of the validation layer is an error.
pub fn run(headless: &mut Headless, regime: &Regime, every: usize) -> Result<RegimeRow> {
    let limit = regime.limit;
    let is_cpus = headless.device().shape() == DeviceShape::Cpu;
    let coarse = if is_cpus { 1.0 } else { COARSE };
    let mut row = RegimeRow {
        regime: regime.name,
        forms: FORMS.map(|(form, ..)| FormRow::from_form(form)).to_vec(),
        target: coarse * limit.map_or(TARGET, |limit: Limit| limit.weight),
        least_psnr: limit.map_or(PICTURE_PSNR, |limit| limit.psnr),
        reason: limit.map(|limit| limit.reason),
        ..RegimeRow::default()
    };
    let cases = (regime.cases)();
    let alone = cases.len() == 1;
    for (number, case) in cases.into_iter().enumerate().step_by(every.max(1)) {
        headless.load(&case.scene)?;
        row.splats += case.scene.len();
        let both = alone || every > 1 || !case.apart;
        measure(headless, &case, (!both).then_some(number), &mut row)?;
    }
    row.ok = row.judge(regime.exact);
    Ok(row)
}

/// Measures a case. Without a turn both ways of drawing have each form, else every other form. The reference's pictures
/// are computed while ours are drawn.
fn measure(
    headless: &mut Headless,
    case: &Case,
    turn: Option<usize>,
    row: &mut RegimeRow,
) -> Result<()> {
    let rasters = |form: usize| match turn.map(|turn| (turn + form) % 2) {
        None => &[Raster::Tiles, Raster::Quad][..],
        Some(0) => &[Raster::Tiles],
        Some(_) => &[Raster::Quad],
    };
    let uncut = Settings::default().mode(Mode::None);
    let no_clip = Clip::default();
    // Linear, so that a pixel's alpha is alpha times weight.
    let decay = case.apart.then_some(Decay::Linear);
    let settings = FORMS.map(|(_, mode, form)| {
        let settings = Settings::default().mode(mode).form(form);
        settings.decay(decay)
    });
    let (drawn, cut, whole, truths) = thread::scope(|scope| {
        let beside = |clip, settings| scope.spawn(move || truth(case, clip, settings));
        let whole = beside(&no_clip, &uncut);
        let truths = settings.each_ref().map(|form| beside(&case.clip, form));
        let mut draw =
            |clip, settings, rasters: &[_]| pictures(headless, case, clip, settings, rasters);
        // A splat that either way of drawing leaves out shows here, before anything is cut.
        let drawn = draw(&no_clip, &uncut, &[Raster::Tiles, Raster::Quad])?;
        let cut = (settings.iter().enumerate())
            .map(|(at, form)| draw(&case.clip, form, rasters(at)))
            .collect::<Result<Vec<_>>>()?;
        Ok((drawn, cut, joined(whole).picture, truths.map(joined)))
    })?;
    let decided: Vec<_> = (0..whole.pixels.len())
        .map(|at| {
            let alphas = drawn.iter().map(|(ours, _)| ours.pixels[at][3]);
            alphas.chain([whole.pixels[at][3]]).all(|a| !undecided(a))
        })
        .collect();
    for (ours, _) in &drawn {
        row.not_finite += not_finite(ours);
        row.missed += missed(ours, &whole, &decided);
        if case.apart {
            row.alpha = row.alpha.max(worst(ours, &whole, &decided));
        }
    }

    let beam = FORMS.iter().position(|(form, ..)| *form == "beam");
    let beam = &truths[beam.expect("one of them")].picture;
    for (at, (settings, truth)) in settings.iter().zip(&truths).enumerate() {
        let (truth, counts) = (&truth.picture, truth.counts);
        let to = &mut row.forms[at];
        for (ours, counted) in &cut[at] {
            let bad = not_finite(ours);
            row.not_finite += bad;
            if bad == 0 {
                to.add(differences(&scaled(ours, truth), &scaled(truth, truth))?);
            }
            if case.apart {
                to.weight = to.weight.max(worst(ours, truth, &decided));
            }
            if settings.mode == Mode::Exact && settings.form == ExactForm::Auto {
                row.miscounted = row.miscounted.max(miscounted(*counted, counts));
            }
        }
        if case.apart {
            to.model = to.model.max(apart(truth, beam, &whole));
        }
    }
    Ok(())
}

/// The GPU's pictures and counts, by each way of drawing.
fn pictures(
    headless: &mut Headless,
    case: &Case,
    clip: &Clip,
    settings: &Settings,
    rasters: &[Raster],
) -> Result<Vec<(Picture, Counts)>> {
    let draw = |&raster| {
        let settings = settings.raster(raster);
        let counts = headless.render(&case.camera, clip, &settings)?.counts;
        Ok((headless.picture()?, counts))
    };
    rasters.iter().map(draw).collect()
}

fn truth(case: &Case, clip: &Clip, settings: &Settings) -> rara_reference::ReferenceFrame {
    rara_reference::render::<f64>(&case.scene, &case.camera, clip, settings)
}

fn joined<T>(thread: ScopedJoinHandle<'_, T>) -> T {
    thread
        .join()
        .unwrap_or_else(|cause| panic::resume_unwind(cause))
}

fn miscounted(ours: Counts, truth: Counts) -> u32 {
    [
        (ours.visible, truth.visible),
        (ours.cutoff, truth.cutoff),
        (ours.invisible, truth.invisible),
        (ours.culled, truth.culled),
    ]
    .into_iter()
    .fold(0, |most, (ours, truth)| most.max(ours.abs_diff(truth)))
}

fn not_finite(picture: &Picture) -> usize {
    let values = picture.pixels.iter().flatten();
    values.filter(|value| !value.is_finite()).count()
}

/// A picture in units of the truth's largest value, where that is beyond 1.
fn scaled(picture: &Picture, truth: &Picture) -> Picture {
    let largest = truth
        .pixels
        .iter()
        .flatten()
        .fold(1.0_f32, |a, b| a.max(*b));
    let pixels = picture.pixels.iter();
    Picture {
        pixels: pixels.map(|pixel| pixel.map(|v| v / largest)).collect(),
        ..*picture
    }
}

/// True when a splat's alpha is so near to 1/255 that single precision may count it on either side.
fn undecided(whole: f32) -> bool {
    (f64::from(whole) * f64::from(ALPHA_MIN_INVERSE) - 1.0).abs() < THRESHOLD_BAND
}

/// Largest difference of alpha, where there is no doubt whether the pixel counts at all.
fn worst(ours: &Picture, truth: &Picture, decided: &[bool]) -> f64 {
    let pixels = ours.pixels.iter().zip(&truth.pixels).zip(decided);
    pixels
        .filter(|(_, decided)| **decided)
        .map(|((ours, truth), _)| f64::from((ours[3] - truth[3]).abs()))
        .fold(0.0, f64::max)
}

/// Pixels that the truth covers beyond doubt and our picture does not.
fn missed(ours: &Picture, whole: &Picture, decided: &[bool]) -> usize {
    let pixels = ours.pixels.iter().zip(&whole.pixels).zip(decided);
    pixels
        .filter(|((ours, whole), decided)| **decided && whole[3] > 0.0 && ours[3] == 0.0)
        .count()
}

/// Sum of differences of alpha over the sum of the uncut alpha.
fn apart(a: &Picture, b: &Picture, whole: &Picture) -> f64 {
    let pixels = a.pixels.iter().zip(&b.pixels);
    let sum: f64 = pixels.map(|(a, b)| f64::from((a[3] - b[3]).abs())).sum();
    let all: f64 = whole.pixels.iter().map(|pixel| f64::from(pixel[3])).sum();
    sum / all.max(1e-30)
}

impl FormRow {
    fn from_form(form: &'static str) -> Self {
        Self {
            form,
            psnr: f64::INFINITY,
            ..Self::default()
        }
    }

    fn add(&mut self, other: Differences) {
        self.l1 = self.l1.max(other.l1);
        self.psnr = self.psnr.min(other.psnr);
        self.max = self.max.max(other.max);
        self.share_over_2 = self.share_over_2.max(other.share_over_2);
    }
}
