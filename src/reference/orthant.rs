//! The share of a cut splat that is on the visible side of several planes at once.
//!
//! Given a pixel, the planes' distances are normal variables (see [`exact`](super::exact)). What is left open of the
//! Gaussian correlates them: fully along a ray without low-pass, so that every plane is a threshold in one variable; under
//! a low-pass wider than the splat, as much as their normals agree. The share is the chance that all of them are positive.
//!
//! For two variables, Plackett's identity (1954) integrates the bivariate density over the correlation up to the actual
//! one. It starts from independence, `Phi(h) Phi(k)`, or from dependence, `min(Phi(h), Phi(k))` or
//! `Phi(h) + Phi(k) - 1`. Near dependence the density's edge `exp(-(h - k)^2 / 2 c^2)` at `c = sqrt(1 - rho^2)` is
//! integrated in closed form, and the nodes integrate only what changes smoothly beside it, as Drezner and Wesolowsky do
//! (1990).
//!
//! For three variables the same identity holds along a path. It starts with the first variable independent of the other
//! two, which are those that depend most on each other, and ends at the actual correlations; each of the two that grow adds
//! its bivariate density times the chance that the third is positive (Genz, 2004).
//!
//! Four and more planes meet in one pixel of one splat only at the ends of small boxes. The pairs' dependences are taken
//! to add up (Kirkwood's superposition), between bounds that the pairs give (from below Hunter's tree, 1976), which meet in
//! the share where correlations are full.

use super::real::{Real, Vec3};

/// A plane in a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Threshold<T> {
    /// Mean over deviation of the plane's distance.
    pub z: T,
    /// True when the visible side is the farther one along the ray.
    pub far: bool,
    /// The half-space's direction among what the pixel leaves open of the Gaussian: a unit vector of ten components.
    pub direction: Direction<T>,
}

/// A unit vector: its component along the ray, and three vectors of components that the low-pass leaves open.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Direction<T> {
    /// `a . c`.
    pub along: T,
    /// `sqrt(L) a x b1`, `sqrt(L) a x b2` and `L a`.
    pub across: [Vec3<T>; 3],
}

impl<T: Real> Direction<T> {
    pub fn squared(&self) -> T {
        self.dot(self)
    }

    fn dot(&self, other: &Self) -> T {
        let across = self.across.iter().zip(&other.across);
        across.fold(self.along * other.along, |sum, (a, b)| sum + a.dot(*b))
    }
}

impl<T: Real> std::ops::Mul<T> for Direction<T> {
    type Output = Self;
    fn mul(self, factor: T) -> Self {
        Self {
            along: self.along * factor,
            across: self.across.map(|a| a * factor),
        }
    }
}

impl<T: Real> std::ops::Sub for Direction<T> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        let [a, b, c] = self.across;
        let [d, e, f] = other.across;
        Self {
            along: self.along - other.along,
            across: [a - d, b - e, c - f],
        }
    }
}

impl<T: Real> Threshold<T> {
    pub fn complement(self) -> Self {
        Self {
            z: -self.z,
            far: !self.far,
            direction: self.direction * -T::one(),
        }
    }
}

/// How two variables depend on each other.
#[derive(Debug, Clone, Copy)]
struct Correlation<T> {
    rho: T,
    /// `1 - rho^2`, whose digits a difference from one would lose.
    rest: T,
}

impl<T: Real> Correlation<T> {
    fn from_thresholds(a: &Threshold<T>, b: &Threshold<T>) -> Self {
        let sign = T::one().copysign(a.direction.dot(&b.direction));
        let apart = T::of(0.5) * (a.direction - b.direction * sign).squared();
        Self {
            rho: sign * (T::one() - apart),
            rest: apart * (T::of(2.0) - apart),
        }
    }
}

/// The chance that two variables are positive.
pub fn both<T: Real>(a: &Threshold<T>, b: &Threshold<T>) -> T {
    both_positive(a.z, b.z, Correlation::from_thresholds(a, b))
}

/// The chance that all variables are positive.
pub fn orthant<T: Real>(thresholds: impl Iterator<Item = Threshold<T>>) -> T {
    let (zero, one) = (T::zero(), T::one());
    let mut open = Vec::new();
    for threshold in thresholds {
        let share = threshold.z.phi();
        if share <= zero {
            return zero;
        }
        if share < one && !open.contains(&threshold) {
            open.push(threshold);
        }
    }
    // The strictest comes first, so that the given order does not matter.
    open.sort_by(|a, b| {
        let by_z = a.z.partial_cmp(&b.z).unwrap_or(std::cmp::Ordering::Equal);
        by_z.then(b.far.cmp(&a.far))
    });
    match &open[..] {
        [] => one,
        [one] => one.z.phi(),
        [a, b] => both_positive(a.z, b.z, Correlation::from_thresholds(a, b)),
        [a, b, c] => three_positive([a, b, c]),
        many => many_positive(many),
    }
}

/// The correlation up to which the integral starts at independence.
const NEAR: f64 = 0.85;
/// Gauss's nodes and weights on [0, 1], which leave an error of less than 1e-6.
const NODES: [(f64, f64); 8] = [
    (0.019_855_071_751_231_88, 0.050_614_268_145_188_13),
    (0.101_666_761_293_186_6, 0.111_190_517_226_687_24),
    (0.237_233_795_041_835_5, 0.156_853_322_938_943_64),
    (0.408_282_678_752_175_1, 0.181_341_891_689_181),
    (0.591_717_321_247_825, 0.181_341_891_689_181),
    (0.762_766_204_958_164_5, 0.156_853_322_938_943_64),
    (0.898_333_238_706_813_4, 0.111_190_517_226_687_24),
    (0.980_144_928_248_768_1, 0.050_614_268_145_188_13),
];

/// The chance that two variables are positive.
fn both_positive<T: Real>(h: T, k: T, correlation: Correlation<T>) -> T {
    let Correlation { rho, rest } = correlation;
    let (zero, one, half, tau) = (
        T::zero(),
        T::one(),
        T::of(0.5),
        T::of(std::f64::consts::TAU),
    );
    let integral = |f: &dyn Fn(T) -> T| {
        let nodes = NODES.iter();
        nodes.fold(zero, |sum, &(node, weight)| {
            sum + T::of(weight) * f(T::of(node))
        })
    };
    let (p, q) = (h.phi(), k.phi());
    let bounds = [(p - (one - q)).max(zero), p.min(q)];
    let sign = one.copysign(rho);
    let share = if rho.abs() <= T::of(NEAR) {
        let squares = half * (h * h + k * k);
        let density = |node: T| {
            let r = rho * node;
            let rest = one - r * r;
            ((r * h * k - squares) / rest).exp() / rest.sqrt()
        };
        p * q + rho / tau * integral(&density)
    } else {
        let limit = if sign > zero { bounds[1] } else { bounds[0] };
        let (apart, root) = ((h - sign * k).abs(), rest.sqrt());
        // Beyond nine deviations the edge is nothing.
        if apart >= T::of(9.0) * root {
            return limit;
        }
        let product = sign * h * k;
        let first = (-half * product).exp();
        let edge = |c: T| (-half * (apart / c).powi(2)).exp();
        let beside = |node: T| {
            let c = root * node;
            let r = (one - c * c).sqrt();
            edge(c) * ((-product / (one + r)).exp() / r - first)
        };
        let on_edge = edge(root) - apart / root * tau.sqrt() * (-apart / root).phi();
        limit - sign * root / tau * (first * on_edge + integral(&beside))
    };
    share.max(bounds[0]).min(bounds[1])
}

/// The chance that three variables are positive.
fn three_positive<T: Real>(open: [&Threshold<T>; 3]) -> T {
    let (zero, one) = (T::zero(), T::one());
    let joint = |i: usize, j: usize| Correlation::from_thresholds(open[i], open[j]);
    let both = |i: usize, j: usize| both_positive(open[i].z, open[j].z, joint(i, j));
    let share = |i: usize| open[i].z.phi();
    // The first variable is the one whose two others depend most on each other.
    let orders = [[0, 1, 2], [1, 0, 2], [2, 0, 1]];
    let dependence = |order: &[usize; 3]| joint(order[1], order[2]).rho.abs();
    let mut best = orders[0];
    for order in orders {
        if dependence(&order) > dependence(&best) {
            best = order;
        }
    }
    let [z0, z1, z2] = best.map(|i| open[i].z);
    let rho = [(0, 1), (0, 2), (1, 2)].map(|(i, j)| joint(best[i], best[j]).rho);
    // One of the first variable's correlations, r, adds the density of the two, times the chance that the third, of
    // correlations s and q with them, is positive.
    let density = |h: T, k: T, third: T, [r, s, q]: [T; 3]| {
        let rest = one - r * r;
        let open = (rest - s * s - q * q + T::of(2.0) * r * s * q).max(T::of(1e-12));
        let mean = (s - r * q) * h + (q - r * s) * k;
        let density = ((r * h * k - T::of(0.5) * (h * h + k * k)) / rest).exp() / rest.sqrt();
        density * ((third * rest - mean) / (rest * open).sqrt()).phi()
    };
    let mut sum = zero;
    for (node, weight) in NODES {
        // Take both halves of the path 2 t - t^2, whose slope evens out what grows like 1 / sqrt(1 - rho^2) at its end.
        for t in [0.5 * node, 0.5 + 0.5 * node] {
            let (step, slope) = (T::of(2.0 * t - t * t), T::of(weight * (1.0 - t)));
            let (a, b) = (rho[0] * step, rho[1] * step);
            let first = rho[0] * density(z0, z1, z2, [a, b, rho[2]]);
            let second = rho[1] * density(z0, z2, z1, [b, a, rho[2]]);
            sum = sum + slope * (first + second);
        }
    }
    let [i, j, k] = best;
    let pairs = [both(i, j), both(i, k), both(j, k)];
    let high = pairs[0].min(pairs[1]).min(pairs[2]);
    let low = (pairs[0] + pairs[1] - share(i))
        .max(pairs[0] + pairs[2] - share(j))
        .max(pairs[1] + pairs[2] - share(k));
    let estimate = z0.phi() * pairs[2] + sum / T::of(std::f64::consts::TAU);
    estimate.max(low).max(zero).min(high)
}

/// The chance that four or more variables are positive, of which the strictest comes first.
fn many_positive<T: Real>(open: &[Threshold<T>]) -> T {
    let tiny = T::of(1e-6);
    let both = |i: usize, j: usize| {
        both_positive(
            open[i].z,
            open[j].z,
            Correlation::from_thresholds(&open[i], &open[j]),
        )
    };
    // The strictest of the other kind, if there is one.
    let other = open.iter().position(|t| t.far != open[0].far);
    let mut low = other.map_or(open[0].z.phi(), |other| both(0, other));
    let (mut high, mut share) = (T::one(), T::one());
    for (j, t) in open.iter().enumerate() {
        let p = t.z.phi().max(tiny);
        share = share * p;
        for (i, before) in open[..j].iter().enumerate() {
            let pair = both(i, j);
            high = high.min(pair);
            share = share * pair / (p * before.z.phi().max(tiny));
        }
        // In the tree each one hangs on the strictest of its kind, and the strictest of one kind on that of the other.
        let first = if t.far == open[0].far { Some(0) } else { other };
        if let Some(first) = first.filter(|&first| first != j) {
            low = low + both(first, j) - open[first].z.phi();
        }
    }
    share.max(low).max(T::zero()).min(high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::real::vec3;
    use std::f64::consts::{PI, TAU};

    /// A variable whose direction is that of a vector.
    fn threshold(z: f64, v: [f64; 3]) -> Threshold<f64> {
        let v = vec3(v[0], v[1], v[2]);
        Threshold {
            z,
            far: v.x >= 0.0,
            direction: Direction {
                along: v.x / v.length(),
                across: [
                    vec3(v.y, v.z, 0.0) * (1.0 / v.length()),
                    Vec3::zero(),
                    Vec3::zero(),
                ],
            },
        }
    }

    /// Two of them with a given correlation.
    fn pair(h: f64, k: f64, rho: f64) -> f64 {
        let turned = [rho, (1.0 - rho * rho).sqrt(), 0.0];
        orthant([threshold(h, [1.0, 0.0, 0.0]), threshold(k, turned)].into_iter())
    }

    #[test]
    fn two_variables_have_their_known_chances() {
        for rho in [
            -1.0, -0.99999, -0.95, -0.9, -0.5, 0.0, 0.3, 0.9, 0.91, 0.999, 1.0,
        ] {
            let known = 0.25 + f64::asin(rho) / TAU;
            let found = pair(0.0, 0.0, rho);
            assert!((found - known).abs() < 1e-6, "{rho}: {found}, {known}");
        }
        // The expected chance sums up h's density times the chance that k follows, in a million steps.
        for (h, k) in [
            (0.5, -0.3),
            (1.0, 1.02),
            (-1.0, 0.9),
            (2.0, -2.1),
            (3.0, 1.0),
        ] {
            for rho in [-0.999, -0.93, -0.6, 0.2, 0.85, 0.92, 0.9999] {
                let steps = 1_000_000;
                let width = (h + 8.5) / f64::from(steps);
                let chance = |i: i32| {
                    let x = -h + (f64::from(i) + 0.5) * width;
                    (-0.5 * x * x).exp() * ((k + rho * x) / f64::sqrt(1.0 - rho * rho)).phi()
                };
                let sum: f64 = (0..steps).map(chance).sum::<f64>() * width / TAU.sqrt();
                assert!((pair(h, k, rho) - sum).abs() < 1e-6, "{h} {k} {rho}");
            }
        }
    }

    #[test]
    fn three_variables_are_close_to_their_known_chances() {
        // Without means the chance is 1/8 and the sum of the correlations' arcsines over 4 pi.
        let (mut worst, mut sum) = (0.0_f64, 0.0);
        for i in 0..1000 {
            let turn = |j: i32| f64::from(i * j) * 0.618_034 * TAU;
            let v = [3, 5, 7].map(|j| [turn(j).sin(), turn(j + 1).cos(), turn(j + 20).sin()]);
            let cosine = |a: usize, b: usize| {
                let of = |v: [f64; 3]| vec3(v[0], v[1], v[2]);
                of(v[a]).dot(of(v[b])) / (of(v[a]).length() * of(v[b]).length())
            };
            let angles = cosine(0, 1).asin() + cosine(0, 2).asin() + cosine(1, 2).asin();
            let known = 0.125 + angles / (4.0 * PI);
            let found = orthant(v.map(|v| threshold(0.0, v)).into_iter());
            worst = worst.max((found - known).abs());
            sum += (found - known).abs();
        }
        assert!(
            worst < 0.03 && sum / 1000.0 < 0.01,
            "{worst}, on average {}",
            sum / 1000.0
        );
    }

    #[test]
    fn full_correlation_is_one_threshold() {
        let (far, near) = ([1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]);
        let set = [(0.7, far), (1.5, near), (0.2, far), (1.1, near), (0.2, far)];
        let share = orthant(set.map(|(z, v)| threshold(z, v)).into_iter());
        assert!((share - (0.2.phi() + 1.1.phi() - 1.0)).abs() < 1e-15);
    }
}
