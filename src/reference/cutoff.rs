//! Stage `cutoff`: how a cut splat's weight varies over its pixels.

use super::chord::Chord;
use super::classify::{cutting, side};
use super::exact::{AffinePlane, Beam};
use super::footprint::Footprint;
use super::real::Real;
use super::region::{self, HalfSpace, Side};
use super::view::View;
use crate::{Clip, ClipOp, ExactForm, Gaussians, Mode, Projection, Settings};

/// The record of a cut splat: everything that its weight in a pixel depends on.
#[derive(Debug, Clone)]
pub enum Cut<T> {
    /// The exact share, affine in the pixel within each half-space's normal distribution function.
    Affine {
        /// The half-spaces that are kept of the splat.
        planes: Vec<AffinePlane<T>>,
        /// How they combine.
        op: ClipOp,
    },
    /// The exact share along each pixel's true ray.
    Beam(Beam<T>),
    /// The paper's length ratio.
    Chord(Chord<T>),
}

impl<T: Real> Cut<T> {
    /// The visible share of the splat at an offset from its centre in pixels: 0 to 1.
    pub fn weight(&self, dx: T, dy: T) -> T {
        match self {
            Cut::Affine { planes, op } => {
                region::share(*op, planes.iter().map(|plane| plane.threshold(dx, dy)))
            }
            Cut::Beam(beam) => beam.weight(dx, dy),
            Cut::Chord(chord) => chord.weight(dx, dy),
        }
    }
}

/// The record of one Gaussian, or nothing if the clip leaves it whole (or none of it).
pub fn cutoff<T: Real>(
    scene: &Gaussians,
    index: usize,
    footprint: &Footprint<T>,
    view: &View<T>,
    clip: &Clip,
    settings: &Settings,
) -> Option<Cut<T>> {
    if side(scene, index, footprint, clip, settings) != Side::Cutoff {
        return None;
    }
    let half_spaces = cutting(scene, index, footprint, clip, settings);
    Some(match settings.mode {
        Mode::Rara => Cut::Chord(Chord {
            gradients: footprint.true_gradients(view),
            lean: footprint.lean(),
            front: (footprint.projection == Projection::Perspective).then_some(HalfSpace {
                normal: footprint.rows[2],
                offset: footprint.view_centre.z,
            }),
            half_spaces,
            op: clip.op,
            sigma: T::of(f64::from(settings.sigma)),
            miss: settings.miss,
        }),
        _ if is_beam(scene, index, footprint, settings) => {
            Cut::Beam(Beam::new(footprint, view, half_spaces, clip.op))
        }
        _ => Cut::Affine {
            planes: half_spaces
                .iter()
                .map(|half_space| AffinePlane::new(footprint.gradients, half_space))
                .collect(),
            op: clip.op,
        },
    })
}

/// True when a splat is too large or too far off the axis for the affine form. An eye within the splat makes it too
/// large: its depth is then less than K < 3.4 deviations. In an orthographic view the affine form is exact for all splats.
pub(super) fn is_beam<T: Real>(
    scene: &Gaussians,
    index: usize,
    footprint: &Footprint<T>,
    settings: &Settings,
) -> bool {
    if footprint.projection == Projection::Orthographic {
        return false;
    }
    match settings.form {
        ExactForm::Beam => true,
        ExactForm::Affine => false,
        ExactForm::Auto => {
            let sigma_max = footprint.unit * T::of(f64::from(scene.scales()[index].max_element()));
            let large = sigma_max / footprint.view_centre.z
                > T::of(f64::from(settings.precision.beam_switch));
            large || footprint.clamped
        }
    }
}
