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
//! The chance of four and more is that of the polytope that they bound.

use super::polytope::polytope;
use super::real::Real;
use super::threshold::{PHI_ONE, Threshold};

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
    if open.len() > 3 {
        // Planes that leave all but nothing have no say in how a polytope is sliced.
        open.retain(|t| t.z < T::of(PHI_ONE));
    }
    match &open[..] {
        [] => one,
        [one] => one.z.phi(),
        [a, b] => both_positive(a.z, b.z, Correlation::from_thresholds(a, b)),
        [a, b, c] => three_positive([a, b, c]),
        many => polytope(many),
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

#[cfg(test)]
mod tests;
