//! How far a baked scene's pictures are from those of the exact cut.

use rara::{Camera, Clip, HeadlessDesc, Mode, Scene, Settings, ShFormat};
use rara_reference::comparison::{Comparison, compare};
use serde::Serialize;

use super::compare::Measures;
use super::failure::Failure;
use super::output::{self, ProgressLine};
use super::session::Session;

#[derive(Debug, Serialize)]
pub(super) struct ResidualView {
    eye: [f64; 3],
    /// The baked scene, drawn without a clip.
    baked: Measures,
    /// The scene clipped by centres.
    hard: Measures,
}

/// The measures of all views: each by itself, and over all of their pixels.
#[derive(Debug)]
pub(super) struct Residual {
    pub(super) baked: Measures,
    pub(super) hard: Measures,
    pub(super) views: Vec<ResidualView>,
    /// The line about the driver's compilation, where that took a moment.
    pub(super) compiled: Option<String>,
}

/// Draws the scene cut exactly and by centres, and the baked scene, and compares them.
pub(super) fn residual(
    device: &HeadlessDesc,
    scene: &Scene<'_>,
    baked: &Scene<'_>,
    clip: &Clip,
    cameras: &[Camera],
) -> Result<Residual, Failure> {
    let mut progress = ProgressLine::new("comparing");
    let settings = |mode| Settings::default().mode(mode);
    let mut session = Session::open(device, scene, ShFormat::Float)?;
    let mut pictures = Vec::new();
    for (done, camera) in cameras.iter().enumerate() {
        progress.update(done as u64, 2 * cameras.len() as u64);
        let mut picture = |mode| session.picture(camera, clip, &settings(mode));
        pictures.push([picture(Mode::Exact)?, picture(Mode::Hard)?]);
    }
    session.headless.load_as(baked, ShFormat::Float)?;
    let (mut of_baked, mut of_hard, mut views) = (Vec::new(), Vec::new(), Vec::new());
    for (done, (camera, [exact, hard])) in cameras.iter().zip(pictures).enumerate() {
        progress.update((cameras.len() + done) as u64, 2 * cameras.len() as u64);
        let drawn = session.picture(camera, &Clip::default(), &settings(Mode::None))?;
        let (baked, hard) = (compare(&drawn, &exact)?, compare(&hard, &exact)?);
        views.push(ResidualView {
            eye: camera.eye.to_array(),
            baked: baked.into(),
            hard: hard.into(),
        });
        of_baked.push(baked);
        of_hard.push(hard);
    }
    let compiled = output::compiled(session.first_use_ms(0.0), session.has_kept());
    session.headless.close()?;
    Ok(Residual {
        compiled,
        baked: over_all(&of_baked).into(),
        hard: over_all(&of_hard).into(),
        views,
    })
}

/// The measures of pictures of one size as if they were one picture.
fn over_all(views: &[Comparison]) -> Comparison {
    let mean =
        |get: fn(&Comparison) -> f64| views.iter().map(get).sum::<f64>() / views.len() as f64;
    let rmse = mean(|c| c.rmse * c.rmse).sqrt();
    Comparison {
        max: views.iter().map(|c| c.max).fold(0.0, f64::max),
        l1: mean(|c| c.l1),
        rmse,
        psnr: 20.0 * (255.0 / rmse).log10(),
        ssim: mean(|c| c.ssim),
        share_over_2: mean(|c| c.share_over_2),
        leak: mean(|c| c.leak),
        loss: mean(|c| c.loss),
    }
}
