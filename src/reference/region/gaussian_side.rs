//! On which side of the region a Gaussian is (the paper, section 3.2).

use super::{Side, UnitPlane};
use crate::reference::real::{Real, Vec3};
use crate::{Clip, ClipOp, Gaussians, Mode, Settings};

/// The side of Gaussian `index`, whose half axes these are and whose band reaches so many standard deviations. None is
/// [`Side::Culled`].
pub fn gaussian_side<T: Real>(
    scene: &Gaussians,
    index: usize,
    axes: &[Vec3<T>; 3],
    deviations: T,
    clip: &Clip,
    settings: &Settings,
) -> Side {
    if clip.planes.is_empty() || settings.mode == Mode::None {
        return Side::Visible;
    }
    // What one plane says of it that is the region's answer, whatever the others say, and the answer if none does.
    let (decides, undecided) = match clip.op {
        ClipOp::And => (Side::Invisible, Side::Visible),
        ClipOp::Or => (Side::Visible, Side::Invisible),
    };
    let mut side = undecided;
    for plane in &clip.planes {
        let one = UnitPlane::new(scene, index, axes, plane).gaussian_side(deviations, settings);
        if one == decides {
            return one;
        }
        if one == Side::Cutoff {
            side = one;
        }
    }
    side
}
