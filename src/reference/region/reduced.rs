//! A region as one Gaussian sees it: the surfaces that cut it, and how they combine once all others are decided.

use super::surface::unit_surface;
use super::{Ellipsoid, Side, UnitSurface, surface_gaussian_side};
use crate::real::Real;
use rara_base::limits::MAX_CUTTING;
use rara_scene::clip::postfix::{answer, postfix};
use rara_scene::clip::{Clip, ClipOp};
use rara_scene::settings::Settings;

/// What is left of a region.
#[derive(Debug, Clone, PartialEq)]
pub enum RegionRest<T> {
    /// All or nothing is kept.
    Decided(bool),
    /// The surfaces that cut the Gaussian. After each, its operators replace the two answers on top of a stack.
    Cut(Vec<(UnitSurface<T>, Vec<ClipOp>)>),
}

impl<T: Real> RegionRest<T> {
    fn join(self, op: ClipOp, other: Self) -> Self {
        match (self, other) {
            (Self::Decided(kept), rest) | (rest, Self::Decided(kept)) => {
                match kept == (op == ClipOp::And) {
                    true => rest,
                    false => Self::Decided(kept),
                }
            }
            (Self::Cut(mut one), Self::Cut(other)) => {
                one.extend(other);
                one.last_mut().expect("it is not empty").1.push(op);
                Self::Cut(one)
            }
        }
    }

    /// The operation that joins all surfaces, if there is only one such operation and none of the surfaces bends.
    pub(crate) fn as_planes(&self) -> Option<ClipOp> {
        let Self::Cut(surfaces) = self else {
            return None;
        };
        let mut operators = surfaces.iter().flat_map(|(_, operators)| operators);
        let op = operators.next().copied().unwrap_or_default();
        let is_flat = surfaces.iter().all(|(surface, _)| surface.is_flat());
        (is_flat && operators.all(|other| *other == op)).then_some(op)
    }
}

/// What is left of the region of a Gaussian that has a band of `deviations` standard deviations. Beyond [`MAX_CUTTING`] surfaces only those count that are nearest; of the others it is on the side of its
/// centre.
pub(crate) fn reduced<T: Real>(
    ellipsoid: &Ellipsoid<T>,
    deviations: T,
    clip: &Clip,
    settings: &Settings,
) -> RegionRest<T> {
    let steps = postfix(clip);
    let seen: Vec<_> = steps
        .iter()
        .map(|step| {
            let surface = &step.surface;
            let side = surface_gaussian_side(surface, ellipsoid, deviations, settings);
            (side, unit_surface(surface, ellipsoid))
        })
        .collect();
    let distance = |surface: &UnitSurface<T>| {
        let offset = surface.half_space.offset.abs();
        let slope = surface.half_space.normal.length() + (offset * surface.bend.norm()).sqrt();
        (offset / slope.max(T::of(1e-30))).min(T::of(1e29))
    };
    let mut nearest: Vec<usize> = (0..seen.len())
        .filter(|&index| seen[index].0 == Side::Cutoff)
        .collect();
    // Of equal distances the first in the list counts.
    nearest.sort_by(|&a, &b| {
        let (a, b) = (distance(&seen[a].1), distance(&seen[b].1));
        a.partial_cmp(&b).unwrap_or(std::cmp::Ordering::Equal)
    });
    nearest.truncate(MAX_CUTTING as usize);
    let numbered = seen.into_iter().enumerate();
    let answers = numbered.zip(steps).map(|((index, (side, surface)), step)| {
        let part = match side {
            Side::Cutoff if nearest.contains(&index) => {
                RegionRest::Cut(vec![(surface.scaled(), Vec::new())])
            }
            Side::Cutoff => RegionRest::Decided(surface.half_space.offset >= T::zero()),
            side => RegionRest::Decided(side == Side::Visible),
        };
        (part, step.operators)
    });
    answer(answers, RegionRest::Decided(true), |op, a, b| a.join(op, b))
}
