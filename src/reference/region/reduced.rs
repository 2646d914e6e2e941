//! A region as one Gaussian sees it: the surfaces that cut it, and how they combine once all others are decided.

use super::surface::unit_surface;
use super::{Ellipsoid, Side, UnitInside, UnitSurface, surface_gaussian_side};
use crate::real::Real;
use rara_scene::clip::postfix::{answer, postfix};
use rara_scene::clip::{Clip, ClipOp, Surface};
use rara_scene::settings::Settings;

/// What is left of a region.
#[derive(Debug, Clone, PartialEq)]
pub enum RegionRest<T> {
    /// All or nothing is kept.
    Decided(bool),
    /// The surfaces that cut the Gaussian. After each, its operators replace the two answers on top of a stack.
    Cut(Vec<(RestSurface<T>, Vec<ClipOp>)>),
}

/// A surface that cuts a Gaussian.
#[derive(Debug, Clone, PartialEq)]
pub enum RestSurface<T> {
    /// A plane, or one that bends.
    Smooth(UnitSurface<T>),
    /// The inside of a mesh.
    Inside(UnitInside<T>),
}

impl<T: Real> RestSurface<T> {
    /// The surface, or the plane that a mesh is near the Gaussian's centre.
    pub(crate) fn nearest(&self) -> &UnitSurface<T> {
        match self {
            Self::Smooth(surface) => surface,
            Self::Inside(inside) => &inside.nearest,
        }
    }

    /// The surface, if it is no mesh.
    pub(crate) fn as_smooth(&self) -> Option<&UnitSurface<T>> {
        match self {
            Self::Smooth(surface) => Some(surface),
            Self::Inside(_) => None,
        }
    }
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

    /// The same without the surfaces that change nothing, for a band of so many deviations, and with their numbers scaled.
    pub(crate) fn without_implied(mut self, deviations: T) -> Self {
        if let Self::Cut(surfaces) = &mut self {
            leave_out_implied(surfaces, deviations);
            for (surface, _) in surfaces {
                if let RestSurface::Smooth(surface) = surface {
                    *surface = surface.scaled();
                }
            }
        }
        self
    }

    /// The operation that joins all surfaces, if there is only one such operation and none of the surfaces bends.
    pub(crate) fn as_planes(&self) -> Option<ClipOp> {
        match self {
            Self::Cut(surfaces) => list_op(surfaces),
            Self::Decided(_) => None,
        }
    }
}

/// The operation that joins all surfaces, if there is only one such operation and none of the surfaces bends.
pub(super) fn list_op<T: Real>(surfaces: &[(RestSurface<T>, Vec<ClipOp>)]) -> Option<ClipOp> {
    let mut operators = surfaces.iter().flat_map(|(_, operators)| operators);
    let op = operators.next().copied().unwrap_or_default();
    let is_plane = |surface: &RestSurface<T>| surface.as_smooth().is_some_and(UnitSurface::is_flat);
    let is_flat = surfaces.iter().all(|(surface, _)| is_plane(surface));
    (is_flat && operators.all(|other| *other == op)).then_some(op)
}

/// What is left of the region of a Gaussian that has a band of `deviations` standard deviations.
pub(crate) fn reduced<T: Real>(
    ellipsoid: &Ellipsoid<T>,
    deviations: T,
    clip: &Clip,
    settings: &Settings,
) -> RegionRest<T> {
    let answers = postfix(clip).into_iter().map(|step| {
        let side = surface_gaussian_side(&step.surface, ellipsoid, deviations, settings);
        let part = match side {
            Side::Cutoff => {
                let surface = match &step.surface {
                    Surface::Inside(inside) => {
                        RestSurface::Inside(UnitInside::new(inside, ellipsoid))
                    }
                    surface => RestSurface::Smooth(unit_surface(surface, ellipsoid)),
                };
                RegionRest::Cut(vec![(surface, Vec::new())])
            }
            side => RegionRest::Decided(side == Side::Visible),
        };
        (part, step.operators)
    });
    answer(answers, RegionRest::Decided(true), |op, a, b| a.join(op, b))
}

/// A surface is taken to keep no more than another if it reaches beyond that by at most this, deviations.
const IMPLIED: f64 = 3e-4;

/// True when a surface keeps nothing of a Gaussian, as far as `deviations`, that another one does not keep. It follows if the
/// difference D of their functions is at least -e there, e a small part of a deviation. That follows if `D + e / 2 + m |u|^2` is
/// nowhere negative, with `m = e / (2 deviations^2)`: if its matrix is positive definite.
fn implies<T: Real>(one: &UnitSurface<T>, other: &UnitSurface<T>, deviations: T) -> bool {
    let half = T::of(0.5);
    let length = |surface: &UnitSurface<T>| surface.half_space.normal.length();
    let slack = T::of(IMPLIED) * length(one).min(length(other));
    let n = (other.half_space.normal - one.half_space.normal) * half;
    let d = other.bend.diagonal - one.bend.diagonal;
    let a = other.bend.across - one.bend.across;
    let shift = half * slack / (deviations * deviations);
    let offset = other.half_space.offset - one.half_space.offset + half * slack;
    let mut rest = [
        [d.x + shift, a.x, a.y, n.x],
        [a.x, d.y + shift, a.z, n.y],
        [a.y, a.z, d.z + shift, n.z],
        [n.x, n.y, n.z, offset],
    ];
    for i in 0..4 {
        let pivot = rest[i];
        let is_positive = pivot[i] > T::zero();
        if !is_positive {
            return false;
        }
        for row in &mut rest[i + 1..] {
            let factor = row[i] / pivot[i];
            for (value, above) in row.iter_mut().zip(pivot) {
                *value = *value - factor * above;
            }
        }
    }
    true
}

/// Takes a surface off a list that changes nothing beside the one that it is joined with: as a capsule's ball within its tube.
fn leave_out_implied<T: Real>(surfaces: &mut Vec<(RestSurface<T>, Vec<ClipOp>)>, deviations: T) {
    let mut i = 1;
    while i < surfaces.len() {
        let [(Some(below), []), (Some(top), [op, ..])] =
            [i - 1, i].map(|i| (surfaces[i].0.as_smooth(), &surfaces[i].1[..]))
        else {
            i += 1;
            continue;
        };
        let top_implies = implies(top, below, deviations);
        if !top_implies && !implies(below, top, deviations) {
            i += 1;
            continue;
        }
        let keeps_top = top_implies != (*op == ClipOp::Or);
        let (top, operators) = surfaces.remove(i);
        if keeps_top {
            surfaces[i - 1].0 = top;
        }
        surfaces[i - 1].1 = operators[1..].to_vec();
        i = (i - 1).max(1);
    }
}
