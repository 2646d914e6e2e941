//! Stage `clip`: what the clip does to each Gaussian, whatever the camera sees of it (the paper, section 3.2).
//!
//! What perspective adds to the band of splats that follow each pixel's true ray depends on the camera: stage
//! [`classify`](super::classify) asks the same question again for those.

use super::classify::{Side, UnitPlane};
use super::footprint::half_axes;
use super::real::{Real, Vec3};
use crate::limits::ALPHA_MIN_INVERSE;
use crate::{Clip, ClipOp, Gaussians, Mode, Settings};

/// What one plane does to one Gaussian.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Verdict {
    Keep,
    Cut,
    Drop,
}

/// The class of every Gaussian of the scene; none is [`Side::Culled`].
pub fn clip<T: Real>(scene: &Gaussians, clip: &Clip, settings: &Settings) -> Vec<Side> {
    let side = |index: usize| {
        let axes = half_axes(scene.scales[index], scene.rotations[index]);
        let brightness = T::of(f64::from(scene.opacities[index]) * f64::from(ALPHA_MIN_INVERSE));
        let reach = (T::of(2.0) * brightness.ln()).max(T::zero()).sqrt();
        clip_side(scene, index, &axes, band(reach, settings), clip, settings)
    };
    (0..scene.len()).map(side).collect()
}

/// Half width of the band in which a plane cuts, standard deviations. The paper's chord can be longer than the
/// visible footprint; a splat is then cut as soon as its traced ellipsoid is.
pub(super) fn band<T: Real>(reach: T, settings: &Settings) -> T {
    match settings.mode {
        Mode::Rara => reach.max(T::of(f64::from(settings.sigma))),
        Mode::None | Mode::Hard | Mode::Exact => reach,
    }
}

/// The class of a Gaussian whose band reaches so many standard deviations.
pub(super) fn clip_side<T: Real>(
    scene: &Gaussians,
    index: usize,
    axes: &[Vec3<T>; 3],
    reach: T,
    clip: &Clip,
    settings: &Settings,
) -> Side {
    if clip.planes.is_empty() || settings.mode == Mode::None {
        return Side::Visible;
    }
    let planes = clip
        .planes
        .iter()
        .map(|plane| UnitPlane::new(scene, index, axes, plane));
    if settings.mode == Mode::Hard {
        let mut kept = planes.map(|plane| plane.offset >= T::zero());
        let visible = match clip.op {
            ClipOp::And => kept.all(|k| k),
            ClipOp::Or => kept.any(|k| k),
        };
        return if visible {
            Side::Visible
        } else {
            Side::Invisible
        };
    }
    if settings.trace_all {
        return Side::Cutoff;
    }
    let verdicts: Vec<_> = planes.map(|plane| plane.verdict(reach)).collect();
    let (all, any) = (
        |v| verdicts.iter().all(|&x| x == v),
        |v| verdicts.contains(&v),
    );
    match clip.op {
        ClipOp::And if any(Verdict::Drop) => Side::Invisible,
        ClipOp::And if all(Verdict::Keep) => Side::Visible,
        ClipOp::Or if any(Verdict::Keep) => Side::Visible,
        ClipOp::Or if all(Verdict::Drop) => Side::Invisible,
        _ => Side::Cutoff,
    }
}
