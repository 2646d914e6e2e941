//! Cameras for pictures of a scene: a camera that frames its visible part, cameras on an orbit or on a path through other
//! cameras, sections across its axes, and panoramas.
//!
//! Everything here is computed on the CPU, from scenes and cameras of [`rara`], but for the pictures of slices, which a
//! [`Headless`](rara::Headless) draws. Draw the resulting cameras by [`rara`].
//!
//! ```
//! use rara_shots::{Framing, Lens, Orbit, Visible};
//! # use rara::scene::{Kind, generate};
//!
//! let gaussians = generate(Kind::Strands, 2000, 1);
//! let visible = Visible::of(&(&gaussians).into());
//! let framing = Framing::new(Lens::Perspective(50.0), (1280, 720));
//! let camera = framing.camera(&visible)?;
//! let film = framing.orbit(Orbit::new(1.0, 120), &visible)?;
//! assert_eq!((camera.width, film.len()), (1280, 120));
//! # Ok::<(), rara::Error>(())
//! ```

#![forbid(unsafe_code)]

mod ease;
mod framing;
mod lens;
mod orbit;
mod panorama;
mod section;
mod slice;
mod spline;

pub use ease::Ease;
pub use framing::{Framing, Outside, Visible};
pub use lens::{Depths, Lens, UP, upright};
pub use orbit::Orbit;
pub use panorama::{Panorama, Seams, levelled};
pub use section::{Section, Sections};
pub use slice::{Face, OUTLINE_WIDTH, RIM_WIDTH, Slice, cut_by_frame, faces};
pub use spline::Spline;

/// Where a picture stands on its path, from 0 to 1. A closed path comes back to its beginning with the picture that would be
/// next, so that a film of it repeats without a halt.
fn share(index: u32, frames: u32, closed: bool) -> f64 {
    let steps = if closed {
        frames
    } else {
        frames.saturating_sub(1)
    };
    f64::from(index) / f64::from(steps.max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_paths_leave_their_beginning_to_the_next_round() {
        let shares = |closed| [0, 1, 3].map(|index| share(index, 4, closed));
        assert_eq!(shares(true), [0.0, 0.25, 0.75]);
        assert_eq!(shares(false), [0.0, 1.0 / 3.0, 1.0]);
        assert_eq!((share(0, 1, true), share(0, 1, false)), (0.0, 0.0));
    }
}
