//! The visible share of a cut splat in a pixel by brute numerical integration: a second opinion on the weights that
//! uses none of the renderer's formulas.
//!
//! It integrates the density of the Gaussian at points of the world, from its inverse transform (the paper, section 3.3:
//! `|M^-1 (x - mu)|^2`), along rays that start at the eye and only in front of it. 3DGS's low-pass means
//! that a pixel sees a bundle of rays, weighted by a Gaussian of the [low-pass](Gaussians::low_pass). There are two readings of that
//! bundle, see [`Bundle`]; they differ by what the low-pass does at depths other than the splat's own.
//!
//! Orthographic rays run along the view axis. They start nowhere, and both readings are the same.

use glam::{DMat3, DQuat, DVec2, DVec3};

use super::region::surface_crossings;
use rara_scene::Gaussians;
use rara_scene::camera::{Camera, Projection};
use rara_scene::clip::Clip;
use rara_scene::placement::Placement;

/// Which rays a pixel's low-pass gathers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bundle {
    /// Rays parallel to the pixel's own, displaced by the low-pass as wide as it is at the depth of the splat's centre.
    /// This is the measure that the perspective form of mode `exact` integrates in closed form: a standard normal u,
    /// given that the two planes through the eye that meet in the pixel's ray are observed with noise.
    Parallel,
    /// Rays through the eye and a point of the screen near the pixel: the picture of the truncated Gaussian, blurred
    /// on the screen. It is wider than the other bundle behind the splat's centre and narrower before it.
    Diverging,
}

/// Standard deviations beyond which densities are taken for nothing.
const EXTENT: f64 = 6.5;
/// Gauss-Legendre nodes on each stretch of a ray.
const NODES: usize = 32;

/// A pixel's rays, and the clip that they are cut by.
#[derive(Debug, Clone, Copy)]
pub struct PixelRays<'a> {
    pub camera: &'a Camera,
    pub clip: &'a Clip,
    /// The pixel's position from the picture's corner, pixels.
    pub position: DVec2,
    pub bundle: Bundle,
    /// The number of rays along each side of their grid.
    pub steps: u32,
}

impl<'a> PixelRays<'a> {
    /// The rays of the parallel bundle.
    pub fn parallel(camera: &'a Camera, clip: &'a Clip, position: DVec2, steps: u32) -> Self {
        Self {
            camera,
            clip,
            position,
            bundle: Bundle::Parallel,
            steps,
        }
    }

    /// The share of Gaussian `index` that the clip leaves visible in the pixel. It is not a number if the Gaussian is flat
    /// or wholly behind the eye.
    pub fn share(&self, scene: &Gaussians, index: usize) -> f64 {
        let [visible, whole, _] = self.sums(scene, index);
        visible / whole
    }

    /// The mean depth along the view axis of what the clip leaves visible of Gaussian `index` in the pixel, world units. It
    /// is not a number if that is nothing.
    pub fn mean_depth(&self, scene: &Gaussians, index: usize) -> f64 {
        let camera = self.camera;
        let centre = camera.rotation * (scene.centre(index) - camera.eye);
        let [visible, _, depth] = self.sums(scene, index);
        centre.z + depth / visible
    }

    /// The visible part, the whole, and the depth of the visible part counted from the centre times that part.
    fn sums(&self, scene: &Gaussians, index: usize) -> [f64; 3] {
        let pixel = Pixel::new(scene, index, self.camera, self.position, self.bundle);
        let (middle, spread) = pixel.densest();
        // The clip is relative to the Gaussian's centre, as the rays are: there nothing cancels, however far the origin is.
        let centred = Placement::new(pixel.centre, DQuat::IDENTITY, 1.0);
        let clip = self.clip.in_scene(&centred.expect("centres are finite"));
        let nodes = legendre();
        let peak = pixel.exponent(middle);

        // The grid covers the offsets that matter, turned so that no straight edge lies along its lines.
        let step = 2.0 * EXTENT / f64::from(self.steps);
        let turn = DVec2::from_angle(0.5);
        let mut total = [0.0; 3];
        for i in 0..self.steps {
            for j in 0..self.steps {
                let white = DVec2::new(f64::from(i) + 0.5, f64::from(j) + 0.5) * step - EXTENT;
                if white.length_squared() > EXTENT * EXTENT {
                    continue;
                }
                let white = turn.rotate(white);
                let offset = middle + spread[0] * white.x + spread[1] * white.y;
                let parts = pixel.integrate(offset, peak, &clip, &nodes);
                for (total, part) in total.iter_mut().zip(parts) {
                    *total += part;
                }
            }
        }
        total
    }
}

struct Pixel {
    /// Centre of the Gaussian, world units.
    centre: DVec3,
    /// The centre's depth.
    depth: f64,
    /// World to the Gaussian's unit space, `M^-1`.
    inverse: DMat3,
    /// Camera to world.
    turn: DMat3,
    /// The centre in camera axes.
    view: DVec3,
    focal: DVec2,
    projection: Projection,
    /// x/z and y/z of the pixel's own ray; of an orthographic one its x and y.
    slope: DVec2,
    bundle: Bundle,
    /// Square pixels.
    low_pass: f64,
}

/// A ray in the Gaussian's unit space and in the world, by the depth counted from the Gaussian's centre.
struct Ray {
    unit_start: DVec3,
    unit_step: DVec3,
    /// World positions relative to the Gaussian's centre.
    start: DVec3,
    step: DVec3,
}

impl Ray {
    /// Depth of the densest point.
    fn densest(&self) -> f64 {
        -self.unit_start.dot(self.unit_step) / self.unit_step.length_squared()
    }
}

impl Pixel {
    fn new(
        scene: &Gaussians,
        index: usize,
        camera: &Camera,
        position: DVec2,
        bundle: Bundle,
    ) -> Self {
        let centre = scene.centre(index);
        let view = camera.rotation * (centre - camera.eye);
        let axes = DMat3::from_quat(scene.rotations()[index].as_dquat().normalize());
        let focal = DVec2::new(camera.fx, camera.fy);
        Self {
            centre,
            depth: view.z,
            inverse: DMat3::from_diagonal(1.0 / scene.scales()[index].as_dvec3())
                * axes.transpose(),
            turn: camera.rotation.transpose(),
            view,
            focal,
            projection: camera.projection,
            slope: (position - DVec2::new(camera.cx, camera.cy)) / focal,
            bundle,
            low_pass: f64::from(scene.low_pass()),
        }
    }

    /// The ray of the bundle at an offset in pixels.
    fn ray(&self, offset: DVec2) -> Ray {
        let aside = offset / self.focal;
        let (slope, from) = match (self.projection, self.bundle) {
            (Projection::Perspective, Bundle::Parallel) => (self.slope, aside * self.depth),
            (Projection::Perspective, Bundle::Diverging) => (self.slope + aside, DVec2::ZERO),
            (Projection::Orthographic, _) => (DVec2::ZERO, self.slope + aside),
        };
        let start = self.turn * ((from + slope * self.depth).extend(self.depth) - self.view);
        let step = self.turn * slope.extend(1.0);
        Ray {
            unit_start: self.inverse * start,
            unit_step: self.inverse * step,
            start,
            step,
        }
    }

    /// How far a ray is from the densest one of all: its offset in deviations of the low-pass and its densest point.
    fn residual(&self, offset: DVec2) -> [f64; 5] {
        let ray = self.ray(offset);
        let nearest = ray.unit_start + ray.unit_step * ray.densest();
        let filter = offset / self.low_pass.sqrt();
        [filter.x, filter.y, nearest.x, nearest.y, nearest.z]
    }

    /// Logarithm of the density at a ray's densest point, negated.
    fn exponent(&self, offset: DVec2) -> f64 {
        0.5 * self.residual(offset).iter().map(|r| r * r).sum::<f64>()
    }

    /// The place of the grid of rays: the offset about which the bundle's rays carry most weight, and two offsets from
    /// there that make the weight a standard normal one (nearly so if the bundle diverges).
    fn densest(&self) -> (DVec2, [DVec2; 2]) {
        let mut middle = DVec2::ZERO;
        let mut spread = [DVec2::X, DVec2::Y];
        for _ in 0..4 {
            // This is one step of Gauss and Newton, with derivatives by central differences.
            let step = 1e-3;
            let slopes = [DVec2::X, DVec2::Y].map(|axis| {
                let (up, down) = (
                    self.residual(middle + axis * step),
                    self.residual(middle - axis * step),
                );
                [0, 1, 2, 3, 4].map(|i| (up[i] - down[i]) / (2.0 * step))
            });
            let dot = |a: &[f64; 5], b: &[f64; 5]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let here = self.residual(middle);
            let (xx, xy, yy) = (
                dot(&slopes[0], &slopes[0]),
                dot(&slopes[0], &slopes[1]),
                dot(&slopes[1], &slopes[1]),
            );
            // Factorise the matrix of products: [[xx, xy], [xy, yy]] = L L^T; the spread is L^-T.
            let l0 = xx.sqrt();
            let l1 = xy / l0;
            let l2 = (yy - l1 * l1).sqrt();
            spread = [
                DVec2::new(1.0 / l0, 0.0),
                DVec2::new(-l1 / (l0 * l2), 1.0 / l2),
            ];
            let gradient = DVec2::new(dot(&slopes[0], &here), dot(&slopes[1], &here));
            middle -= spread[0] * spread[0].dot(gradient) + spread[1] * spread[1].dot(gradient);
        }
        (middle, spread)
    }

    /// Integrals of the density along one ray of the bundle: the visible part, the whole, and the visible part's depth times
    /// it.
    fn integrate(
        &self,
        offset: DVec2,
        peak: f64,
        clip: &Clip,
        nodes: &[(f64, f64); NODES],
    ) -> [f64; 3] {
        let ray = self.ray(offset);
        let (middle, half) = (ray.densest(), EXTENT / ray.unit_step.length());
        // Only the part in front of the eye counts, where there is one.
        let first = match self.projection {
            Projection::Perspective => -self.depth,
            Projection::Orthographic => f64::NEG_INFINITY,
        };
        let (start, end) = ((middle - half).max(first), middle + half);
        if start >= end {
            return [0.0; 3];
        }
        let surfaces = clip.all_surfaces();
        let crossings = surfaces
            .iter()
            .flat_map(|s| surface_crossings(s, ray.start, ray.step));
        let mut ends: Vec<_> = crossings
            .filter(|t| *t > start && *t < end)
            .chain([start, end])
            .collect();
        ends.sort_by(f64::total_cmp);

        let weight = 0.5 * offset.length_squared() / self.low_pass - peak;
        let mut sums = [0.0; 3];
        for stretch in ends.windows(2) {
            let (centre, half) = (
                0.5 * (stretch[0] + stretch[1]),
                0.5 * (stretch[1] - stretch[0]),
            );
            let density = |t: f64| {
                (-0.5 * (ray.unit_start + ray.unit_step * t).length_squared() - weight).exp()
            };
            let (mut sum, mut depths) = (0.0, 0.0);
            for (node, weight) in nodes {
                let t = centre + half * node;
                let mass = half * weight * density(t);
                sum += mass;
                depths += mass * t;
            }
            let point = ray.start + ray.step * centre;
            let seen = if clip.keeps(point) { 1.0 } else { 0.0 };
            for (total, part) in sums.iter_mut().zip([seen * sum, sum, seen * depths]) {
                *total += part;
            }
        }
        sums
    }
}

/// Nodes and weights of Gauss-Legendre quadrature on [-1, 1]: the roots of the Legendre polynomial, by Newton's method.
fn legendre() -> [(f64, f64); NODES] {
    let n = NODES as f64;
    std::array::from_fn(|i| {
        let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n + 0.5)).cos();
        let mut slope = 0.0;
        for _ in 0..20 {
            let (mut value, mut before) = (x, 1.0);
            for k in 2..=NODES {
                let k = k as f64;
                (value, before) = (
                    ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k,
                    value,
                );
            }
            slope = n * (before - x * value) / (1.0 - x * x);
            x -= value / slope;
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rule_integrates_a_gaussian() {
        let nodes = legendre();
        assert!((nodes.iter().map(|(_, weight)| weight).sum::<f64>() - 2.0).abs() < 1e-13);
        let integral: f64 = nodes
            .iter()
            .map(|(x, w)| w * EXTENT * (-0.5 * (EXTENT * x).powi(2)).exp())
            .sum();
        assert!(
            (integral - std::f64::consts::TAU.sqrt()).abs() < 1e-8,
            "{integral}"
        );
    }
}
