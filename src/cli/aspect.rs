//! `--size` beside a camera of a file: pictures of another size, and of another aspect.

use rara::Camera;

use super::failure::Failure;
use super::output;

/// The camera with pictures of another size. Where that has another aspect, all that the camera sees is in the picture and in
/// its middle, as large as fits, and what is beside it fills the rest; a note says so.
pub(super) fn sized(camera: Camera, size: (u32, u32)) -> Result<Camera, Failure> {
    let resized = camera.resized(size).map_err(Failure::usage)?;
    let [wide, high] = [resized.fx / camera.fx, resized.fy / camera.fy];
    // A pixel more or less is rounding.
    if (wide / high - 1.0).abs() <= 1.5 / f64::from(size.0.min(size.1)) {
        return Ok(resized);
    }
    let more = if wide > high {
        "at its sides"
    } else {
        "above and below"
    };
    output::warn_once(format!(
        "note: --size {}x{} has another aspect than the camera's {}x{}: all that the camera sees is in the picture, and \
         more {more}",
        size.0, size.1, camera.width, camera.height
    ));
    let scale = wide.min(high);
    let margin = |size: u32, own: u32| (f64::from(size) - scale * f64::from(own)) / 2.0;
    Ok(resized
        .fx(scale * camera.fx)
        .fy(scale * camera.fy)
        .cx(scale * camera.cx + margin(size.0, camera.width))
        .cy(scale * camera.cy + margin(size.1, camera.height)))
}
