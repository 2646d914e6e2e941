//! Frames that reuse nothing, which is what is measured and compared.

use rara::{Camera, Clip, FrameStats, Headless, Picture, Result, Settings};

/// Draws a frame that reuses nothing of the one before.
///
/// # Errors
/// As [`Headless::render`] has them.
pub fn fresh(
    headless: &mut Headless,
    camera: &Camera,
    clip: &Clip,
    settings: &Settings,
) -> Result<FrameStats> {
    headless.forget();
    headless.render(camera, clip, settings)
}

/// Draws such a frame and reads its picture back.
///
/// # Errors
/// As [`Headless::render`] has them.
pub fn picture(
    headless: &mut Headless,
    camera: &Camera,
    clip: &Clip,
    settings: &Settings,
) -> Result<(Picture, FrameStats)> {
    let stats = fresh(headless, camera, clip, settings)?;
    Ok((headless.picture()?, stats))
}
