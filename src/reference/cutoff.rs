//! Stage `cutoff`: how a cut splat's weight varies over its pixels.

use super::chord::Chord;
use super::classify::GaussianInView;
use super::combined::CombinedCut;
use super::exact::{AffinePlane, Beam};
use super::footprint::Footprint;
use super::real::{Real, Vec3};
use super::region::{
    self, Combination, HalfSpace, RegionRest, RestSurface, Side, Symmetric, UnitSurface,
};
use super::view::ViewTransform;
use rara_base::limits::RECORD_SURFACES;
use rara_scene::Gaussians;
use rara_scene::camera::Projection;
use rara_scene::clip::{Clip, ClipOp};
use rara_scene::settings::{Mode, Settings};

/// The record of a cut splat: everything that its weight in a pixel depends on.
#[derive(Debug, Clone)]
pub enum SplatCut<T> {
    /// The exact share, affine in the pixel within each half-space's normal distribution function.
    Affine {
        /// The half-spaces that are kept of the splat.
        planes: Vec<AffinePlane<T>>,
        op: ClipOp,
    },
    /// The exact share along each pixel's true ray.
    Beam(Beam<T>),
    /// The paper's length ratio.
    Chord(Chord<T>),
    /// Either of surfaces that bend or combine in some other way than a list of planes does.
    Combined(CombinedCut<T>),
    /// Less than the region's own test sees: all or nothing is kept.
    Decided(bool),
}

impl<T: Real> SplatCut<T> {
    /// The visible share of the splat at an offset from its centre in pixels: 0 to 1.
    pub fn weight(&self, dx: T, dy: T) -> T {
        match self {
            SplatCut::Affine { planes, op } => {
                region::share(*op, planes.iter().map(|plane| plane.threshold(dx, dy)))
            }
            SplatCut::Beam(beam) => beam.weight(dx, dy),
            SplatCut::Chord(chord) => chord.weight(dx, dy),
            SplatCut::Combined(combined) => combined.weight(dx, dy),
            SplatCut::Decided(true) => T::one(),
            SplatCut::Decided(false) => T::zero(),
        }
    }
}

/// How many surfaces pass through a Gaussian, as far as it reaches, of those on which what is kept of it depends.
pub fn cutting_count<T: Real>(
    scene: &Gaussians,
    index: usize,
    footprint: &Footprint<T>,
    clip: &Clip,
    settings: &Settings,
) -> usize {
    GaussianInView::new(scene, index, footprint, clip, settings).cutting_count()
}

/// The record of one Gaussian, or nothing if the clip leaves it whole (or none of it).
pub fn cutoff<T: Real>(
    scene: &Gaussians,
    index: usize,
    footprint: &Footprint<T>,
    view: &ViewTransform<T>,
    clip: &Clip,
    settings: &Settings,
) -> Option<SplatCut<T>> {
    let gaussian = GaussianInView::new(scene, index, footprint, clip, settings);
    if gaussian.side() != Side::Cutoff {
        return None;
    }
    if !clip.is_general() {
        return Some(of_planes(&gaussian, view, gaussian.cutting(), clip.op));
    }
    let reduced = gaussian.left();
    let op = reduced.as_planes();
    Some(match (reduced, op) {
        (RegionRest::Decided(kept), _) => SplatCut::Decided(kept),
        (RegionRest::Cut(surfaces), Some(op)) => {
            let half_spaces = surfaces
                .iter()
                .map(|(surface, _)| surface.nearest().half_space);
            let half_spaces = half_spaces.collect();
            of_planes(&gaussian, view, half_spaces, op)
        }
        (RegionRest::Cut(surfaces), None) => of_combination(&gaussian, view, surfaces),
    })
}

/// The record of a splat whose surfaces bend, combine, or are many.
fn of_combination<T: Real>(
    gaussian: &GaussianInView<'_, T>,
    view: &ViewTransform<T>,
    surfaces: Vec<(RestSurface<T>, Vec<ClipOp>)>,
) -> SplatCut<T> {
    let &GaussianInView {
        footprint,
        settings,
        ..
    } = gaussian;
    let is_chord = settings.mode == Mode::Rara;
    let follows_rays = is_chord || gaussian.is_beam();
    let front = HalfSpace {
        normal: footprint.rows[2],
        offset: footprint.view_centre.z,
    };
    let has_front = match is_chord {
        true => footprint.projection == Projection::Perspective,
        false => follows_rays && footprint.holds_the_eye(),
    };
    SplatCut::Combined(CombinedCut {
        gradients: match follows_rays {
            true => footprint.true_gradients(view),
            false => footprint.gradients,
        },
        lean: match follows_rays {
            true => footprint.lean(),
            false => Vec3::zero(),
        },
        surfaces: Combination(surfaces),
        front: has_front.then_some(front),
        chord: is_chord.then(|| (T::of(f64::from(settings.sigma)), settings.miss)),
    })
}

/// The record of a splat that only planes cut.
fn of_planes<T: Real>(
    gaussian: &GaussianInView<'_, T>,
    view: &ViewTransform<T>,
    half_spaces: Vec<HalfSpace<T>>,
    op: ClipOp,
) -> SplatCut<T> {
    let &GaussianInView {
        footprint,
        settings,
        ..
    } = gaussian;
    match settings.mode {
        Mode::Rara => SplatCut::Chord(Chord {
            gradients: footprint.true_gradients(view).b,
            lean: footprint.lean(),
            front: (footprint.projection == Projection::Perspective).then_some(HalfSpace {
                normal: footprint.rows[2],
                offset: footprint.view_centre.z,
            }),
            half_spaces,
            op,
            sigma: T::of(f64::from(settings.sigma)),
            miss: settings.miss,
        }),
        _ if half_spaces.len() > RECORD_SURFACES as usize => {
            let surfaces = half_spaces.into_iter().enumerate();
            let surfaces = surfaces.map(|(number, half_space)| {
                let bend = Symmetric::zero();
                let operators = if number == 0 { vec![] } else { vec![op] };
                let surface = UnitSurface { half_space, bend }.scaled();
                (RestSurface::Smooth(surface), operators)
            });
            of_combination(gaussian, view, surfaces.collect())
        }
        _ if gaussian.is_beam() => SplatCut::Beam(Beam::new(footprint, view, half_spaces, op)),
        _ => SplatCut::Affine {
            planes: half_spaces
                .iter()
                .map(|half_space| AffinePlane::new(footprint.gradients, half_space))
                .collect(),
            op,
        },
    }
}
