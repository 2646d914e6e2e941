//! What the surfaces of a splat keep of lines through it.

use super::combination::{Combination, among};
use super::crossing::{FAR_AWAY, Sight};
use super::{RestSurface, UnitSurface};
use crate::real::{Real, Vec3, vec3};

/// How far the points of the lattice are apart, in deviations, how far it reaches, and the cosine and the sine by which it is
/// turned, so that the edges in which surfaces meet do not run along its rows.
const LATTICE: f64 = 0.74;
const LATTICE_RADIUS: f64 = 4.2;
const LATTICE_TURN: (f64, f64) = (0.850_650_8, 0.525_731_1);
/// Surfaces that turn away from their mean direction by less are seen by every second row and column, or by a single line.
const TURNS_LITTLE: f64 = 0.1;
const TURNS_NOT: f64 = 0.001;

/// A stretch of a line, and whether a surface keeps it or the rest.
#[derive(Debug, Clone, Copy)]
struct Stretch<T> {
    start: T,
    end: T,
    between: bool,
}

impl<T: Real> Stretch<T> {
    /// Of the points `at + t direction`.
    fn of_line(surface: &UnitSurface<T>, at: Vec3<T>, direction: Vec3<T>) -> Self {
        let (two, four) = (T::of(2.0), T::of(4.0));
        let (value, bend) = (surface.at(at), surface.bend.form(direction));
        let slope = surface.gradient(at).dot(direction);
        let square = slope * slope - four * bend * value;
        let sum = (slope.abs() + square.max(T::zero()).sqrt()).copysign(slope);
        let (before, after) = (T::neg_infinity(), T::infinity());
        let is_crossed = square >= T::zero() && sum != T::zero();
        let (first, second) = (-two * value / sum, -sum / (two * bend));
        let (start, end, between) = if !is_crossed {
            (before, after, value >= T::zero())
        } else if second.abs() < T::of(FAR_AWAY) {
            (first.min(second), first.max(second), bend < T::zero())
        } else if slope < T::zero() {
            (before, first, true)
        } else {
            (first, after, true)
        };
        Self {
            start,
            end,
            between,
        }
    }

    fn keeps(&self, t: T) -> bool {
        (t >= self.start && t <= self.end) == self.between
    }
}

/// The mean of a Gaussian given a pixel, and its deviations along the line of sight and across it.
type Spread<'a, T> = (Vec3<T>, &'a [Vec3<T>; 3]);

/// The vector that has these parts among deviations.
fn moved<T: Real>(&[first, second, third]: &[Vec3<T>; 3], v: Vec3<T>) -> Vec3<T> {
    first * v.x + second * v.y + third * v.z
}

/// The unit vector of this direction, or that along the line.
fn unit<T: Real>(v: Vec3<T>) -> Vec3<T> {
    if v.squared() > T::zero() {
        v * (T::one() / v.length())
    } else {
        vec3(T::one(), T::zero(), T::zero())
    }
}

/// A surface keeps a stretch of a line; a mesh keeps what lies between places where that changes.
enum Kept<T> {
    Stretch(Stretch<T>),
    Changes(bool, Vec<T>),
}

impl<T: Real> Kept<T> {
    fn of_line(surface: &RestSurface<T>, at: Vec3<T>, direction: Vec3<T>) -> Self {
        match surface {
            RestSurface::Smooth(surface) => Self::Stretch(Stretch::of_line(surface, at, direction)),
            RestSurface::Inside(inside) => {
                let (kept, changes) = inside.changes(at, direction);
                Self::Changes(kept, changes)
            }
        }
    }

    fn ends(&self) -> Vec<T> {
        match self {
            Self::Stretch(stretch) => vec![stretch.start, stretch.end],
            Self::Changes(_, changes) => changes.clone(),
        }
    }

    fn keeps(&self, t: T) -> bool {
        match self {
            Self::Stretch(stretch) => stretch.keeps(t),
            Self::Changes(kept, changes) => {
                let before = changes.iter().filter(|&&change| change < t).count();
                *kept != (before % 2 == 1)
            }
        }
    }
}

impl<T: Real> Combination<T> {
    /// The measure of what is kept of the points `at + t direction` from `start` to `end`, by the measure of a stretch.
    pub(crate) fn measure_line(
        &self,
        (at, direction): (Vec3<T>, Vec3<T>),
        ends: (T, T),
        measure: &dyn Fn(T, T) -> T,
    ) -> T {
        let surfaces = self.0.iter();
        let kept = surfaces.map(|(surface, _)| Kept::of_line(surface, at, direction));
        self.walked(&kept.collect::<Vec<_>>(), ends, measure)
    }

    /// The measure of what is kept of a pixel, by that of a stretch of a line along which a function of this gradient varies
    /// and across which it does not; `start` and `end` are counted from the mean, in deviations.
    pub(crate) fn measure_across(
        &self,
        sight: &Sight<T>,
        gradient: Vec3<T>,
        ends: (T, T),
        measure: &dyn Fn(T, T) -> T,
    ) -> T {
        let deviations = sight.deviations();
        let direction = unit(among(&deviations, gradient));
        self.measure_lattice((sight.mean(), &deviations), direction, ends, measure)
    }

    /// The same of lines of the direction that all surfaces cross, as well as one can.
    pub(super) fn measure_through(
        &self,
        sight: &Sight<T>,
        ends: (T, T),
        measure: &dyn Fn(T, T) -> T,
    ) -> T {
        let spread = (sight.mean(), &sight.deviations());
        self.measure_lattice(spread, self.direction_through(spread), ends, measure)
    }

    /// The direction that all surfaces cross, as well as one can, among a line's deviations: a unit vector. It does not depend on the
    /// surfaces' order, and a region's complement has the same one, so that what both keep adds up to the whole.
    fn direction_through(&self, (mean, deviations): Spread<'_, T>) -> Vec3<T> {
        let zero = Vec3::zero();
        let weighed = self.0.iter().map(|(surface, _)| {
            let surface = surface.nearest();
            let a = among(deviations, surface.gradient(mean));
            let square = a.squared().max(T::of(1e-30));
            let value = surface.at(mean);
            let near = (-T::of(0.5) * (value * value / square).min(T::of(20.0))).exp();
            a * (near / square.sqrt())
        });
        let nearest = weighed.clone().fold(zero, |most: Vec3<T>, a| {
            if a.squared() > most.squared() {
                a
            } else {
                most
            }
        });
        let sum = weighed.fold(zero, |sum, a| {
            if a.dot(nearest) < T::zero() {
                sum - a
            } else {
                sum + a
            }
        });
        let parts = [sum.x, sum.y, sum.z];
        let first = parts.iter().find(|&&part| part != T::zero());
        match first.is_some_and(|&part| part < T::zero()) {
            true => unit(-sum),
            false => unit(sum),
        }
    }

    /// Crossings on lines of this direction move by no more than this for each deviation across it.
    fn turn(&self, (mean, deviations): Spread<'_, T>, direction: Vec3<T>) -> T {
        self.0.iter().fold(T::zero(), |most, (surface, _)| {
            let RestSurface::Smooth(surface) = surface else {
                return T::one(); // its faces may turn in any way
            };
            let a = among(deviations, surface.gradient(mean));
            let along = a.dot(direction);
            let parts = [direction.x, direction.y, direction.z];
            let bends = deviations.iter().zip(parts);
            let bend = bends.fold(T::zero(), |sum, (deviation, part)| {
                sum + (T::one() - part * part) * surface.bend.form(*deviation).abs()
            });
            let across = (a - direction * along).length() + bend;
            most.max(across / along.abs().max(T::of(1e-30)))
        })
    }

    fn measure_lattice(
        &self,
        (mean, deviations): Spread<'_, T>,
        h: Vec3<T>,
        ends: (T, T),
        measure: &dyn Fn(T, T) -> T,
    ) -> T {
        let direction = moved(deviations, h);
        let turn = self.turn((mean, deviations), h);
        if turn < T::of(TURNS_NOT) {
            return self.measure_line((mean, direction), ends, measure);
        }
        let g = h.perpendicular();
        let (first, second) = (moved(deviations, g), moved(deviations, h.cross(g)));
        let step = if turn < T::of(TURNS_LITTLE) {
            2.0 * LATTICE
        } else {
            LATTICE
        };
        let rows = (LATTICE_RADIUS / step) as i32 + 1;
        let (cosine, sine) = LATTICE_TURN;
        let points = (-rows..=rows).flat_map(|row| (-rows..=rows).map(move |column| (row, column)));
        let points = points.map(|(row, column)| {
            let (row, column) = (step * f64::from(row), step * f64::from(column));
            (row * cosine - column * sine, row * sine + column * cosine)
        });
        let points = points.filter(|(x, y)| x * x + y * y <= LATTICE_RADIUS * LATTICE_RADIUS);
        let (mut share, mut weights) = (T::zero(), T::zero());
        for (x, y) in points {
            let weight = T::of((-0.5 * (x * x + y * y)).exp());
            let at = mean + first * T::of(x) + second * T::of(y);
            weights = weights + weight;
            share = share + weight * self.measure_line((at, direction), ends, measure);
        }
        share / weights
    }

    fn walked(&self, surfaces: &[Kept<T>], (start, end): (T, T), measure: &dyn Fn(T, T) -> T) -> T {
        let ends = surfaces.iter().flat_map(Kept::ends);
        let mut ends: Vec<T> = ends.filter(|&t| t > start && t < end).collect();
        ends.extend([start, end]);
        ends.sort_by(|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
        let one = T::one();
        let mut total = T::zero();
        for pair in ends.windows(2) {
            let (low, high) = (pair[0], pair[1]);
            let middle = match (low.is_finite(), high.is_finite()) {
                (true, true) => T::of(0.5) * (low + high),
                (true, false) => low + one,
                (false, true) => high - one,
                (false, false) => T::zero(),
            };
            if self.answer(&|i| surfaces[i].keeps(middle)) {
                total = total + measure(low, high);
            }
        }
        total
    }
}
