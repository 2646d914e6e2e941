//! How far a choice's picture is from the exact cut, and from its own picture in double precision.

use std::cell::RefCell;

use crate::measure::{self, Pixels, Popping};
use glam::DVec3;
use rara::scene::extent_along;
use rara::{
    Camera, Clip, Decay, ExactForm, Headless, Mode, Picture, Plane, Precision, Result, Scene,
    Settings, Surface,
};
use serde::Serialize;

use crate::frames::picture;

/// A step of the slow sweep as a share of the scene: ten seconds across it at 30 pictures a second.
const STEP: f64 = 1.0 / 300.0;
/// Pixels around those in which cuts differ, as far as SSIM's window reaches.
const BAND: usize = 5;

/// Errors against the truth, in units of 1/255 but for SSIM, which is 1 at best.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Measures {
    pub(crate) l1: f64,
    pub(crate) ssim: f64,
    /// SSIM where the way of cutting makes a difference; `None` if it makes none anywhere.
    pub(crate) band_ssim: Option<f64>,
    pub(crate) max: f64,
    pub(crate) leak: f64,
    pub(crate) loss: f64,
    pub(crate) popping: Popping,
    /// Peak signal to noise ratio against the same choice in double precision, decibels.
    #[serde(serialize_with = "finite")]
    pub(crate) twin_psnr: f64,
}

/// JSON has no infinity, so pictures that are equal are 999 dB apart.
pub(crate) fn finite<S: serde::Serializer>(
    psnr: &f64,
    serializer: S,
) -> std::result::Result<S::Ok, S::Error> {
    serializer.serialize_f64(psnr.min(999.0))
}

pub(crate) struct Judge<'a> {
    scene: &'a Scene<'a>,
    camera: &'a Camera,
    /// The clip in each step of the sweep; all measures but popping use the first.
    clips: Vec<Clip>,
    truths: Vec<Picture>,
    band: Pixels,
    /// Pictures in double precision that have been drawn, by the settings that they depend on.
    twins: RefCell<Vec<(Settings, Picture)>>,
}

/// The settings of the truth: every splat, called cut or not, is exact in perspective and weighed by optical depth.
pub(crate) fn truth_settings(look: &Settings) -> Settings {
    look.mode(Mode::Exact)
        .decay(Some(Decay::Depth))
        .form(ExactForm::Beam)
        .trace_all(true)
}

/// The region in which the way of cutting makes a difference: the cut by centres and the true one differ there or nearby.
pub(crate) fn band(by_centres: &Picture, truth: &Picture) -> Result<Pixels> {
    Ok(Pixels::where_different(by_centres, truth, 1.0 / 255.0)?.dilated(BAND))
}

impl<'a> Judge<'a> {
    pub(crate) fn new(
        scene: &'a Scene<'a>,
        camera: &'a Camera,
        clip: &Clip,
        look: &Settings,
        steps: u32,
    ) -> Result<Self> {
        let clips = sweep(scene, clip, steps)?;
        let truth = truth_settings(look);
        let draw = |clip: &Clip| rara_reference::render::<f64>(scene, camera, clip, &truth).picture;
        let truths: Vec<_> = clips.iter().map(draw).collect();
        let hard = look.mode(Mode::Hard);
        let hard = rara_reference::render::<f64>(scene, camera, &clips[0], &hard).picture;
        let band = band(&hard, &truths[0])?;
        Ok(Self {
            scene,
            camera,
            clips,
            truths,
            band,
            twins: RefCell::default(),
        })
    }

    /// Share of the picture in which the way of cutting makes a difference.
    pub(crate) fn band_share(&self) -> f64 {
        self.band.share()
    }

    /// Measures one choice; the headless holds the scene in the choice's format.
    pub(crate) fn measure(&self, headless: &mut Headless, settings: &Settings) -> Result<Measures> {
        let draw = |clip| Ok(picture(headless, self.camera, clip, settings)?.0);
        let pictures = self.clips.iter().map(draw).collect::<Result<Vec<_>>>()?;
        let (own, band_ssim) =
            measure::compare_within(&pictures[0], &self.truths[0], Some(&self.band))?;
        Ok(Measures {
            l1: own.l1,
            ssim: own.ssim,
            band_ssim,
            max: own.max,
            leak: own.leak,
            loss: own.loss,
            popping: measure::popping(&pictures, &self.truths)?,
            twin_psnr: self.twin_psnr(&pictures[0], settings)?,
        })
    }

    fn twin_psnr(&self, picture: &Picture, settings: &Settings) -> Result<f64> {
        // The reference depends on a precision only where the forms of the weight change.
        let key =
            settings.precision(Precision::default().beam_switch(settings.precision.beam_switch));
        let mut twins = self.twins.borrow_mut();
        let known = twins.iter().position(|(have, _)| *have == key);
        let index = known.unwrap_or_else(|| {
            let frame =
                rara_reference::render::<f64>(self.scene, self.camera, &self.clips[0], &key);
            twins.push((key, frame.picture));
            twins.len() - 1
        });
        measure::psnr(picture, &twins[index].1)
    }
}

/// The clip, and `steps` more, in each of which every plane has moved a little further towards what it keeps.
fn sweep(scene: &Scene<'_>, clip: &Clip, steps: u32) -> Result<Vec<Clip>> {
    let extent = |normal: DVec3| {
        let (low, high) = extent_along(scene, normal);
        high - low
    };
    let moved = |surface: &Surface, step: u32| {
        let Some(plane) = surface.as_plane() else {
            return Ok(surface.clone());
        };
        let by = STEP * f64::from(step) * extent(plane.normal());
        Plane::new(plane.normal(), plane.offset() - by).map(Surface::from)
    };
    let at = |step: u32| {
        let surfaces = clip.surfaces.iter().map(|surface| moved(surface, step));
        Ok(Clip {
            surfaces: surfaces.collect::<Result<Vec<_>>>()?,
            ..clip.clone()
        })
    };
    (0..=steps).map(at).collect()
}
