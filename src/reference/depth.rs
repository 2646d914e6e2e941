//! Stage `depth` finds how deep a splat is in a pixel, on average of what the clip leaves of it, and a pixel's expected
//! depth.
//!
//! As in [`exact`](super::exact), u ~ N(0, I) is the Gaussian's unit space, a pixel an observation of two linear functions
//! of u, and `C = I - B^T S^-1 B` (with `S = B B^T + L`) the covariance that it leaves. The depth is one more linear
//! function, `Z + m3 . u`: given the pixel it is normal with a mean that is affine in delta, `Z + (S^-1 B m3) . delta`. The
//! function `g + a . u` of a half-space that a surface keeps is normal too, with mean over deviation z and deviation s, and
//! their covariance is `m3^T C a`. Of a normal pair (d, p) the mean of d where p is positive follows from regressing d on p,
//! `d = mean + cov / s (p - mean p) / s + rest`, with a rest that does not depend on p, and from the mean of a truncated
//! normal variable: `E[d | p > 0] = mean + cov / s phi(z) / Phi(z)`, the shift `cov / s` times the inverse of Mills's ratio.
//!
//! Several half-spaces are thresholds on the line of sight: the strictest that keeps the far side bounds it from below, the
//! strictest that keeps the near side from above, each with its own shift:
//! `E = mean + (shift_far phi(low) + shift_near phi(high)) / (Phi(high) - Phi(low))`. That is exact for one, and for
//! two where both are thresholds in one variable, as on a ray without low-pass. A union leaves out what its complements
//! keep in common, such an interval; it keeps the rest of the whole's mean.

use super::classify::GaussianInView;
use super::footprint::{Footprint, determinant, scaled};
use super::real::{Real, Vec3};
use super::{LayerView, layer, splat};
use rara_scene::camera::Camera;
use rara_scene::clip::{Clip, ClipOp};
use rara_scene::settings::{Mode, Settings};
use rara_scene::{Gaussians, Scene};

/// A linear function of u given a pixel: `at + slope . delta`, over its deviation.
#[derive(Debug, Clone, Copy)]
struct DepthLimit<T> {
    z: [T; 3],
    /// Covariance with the depth over the deviation.
    shift: T,
}

/// How deep a splat is.
#[derive(Debug, Clone, Copy)]
pub struct SplatDepth<T> {
    /// The whole splat's mean depth at its centre, and how that changes a pixel across and down.
    mean: [T; 3],
    far: DepthLimit<T>,
    near: DepthLimit<T>,
    op: ClipOp,
}

/// The distribution of u given a pixel.
struct PixelConditional<T> {
    gradients: [Vec3<T>; 2],
    across: Vec3<T>,
    factor: T,
    low_pass: T,
    det: T,
}

impl<T: Real> PixelConditional<T> {
    fn new(footprint: &Footprint<T>) -> Self {
        let ([b1, b2], factor, low_pass) = scaled(footprint.gradients);
        let across = b1.cross(b2);
        Self {
            gradients: [b1, b2],
            across,
            factor,
            low_pass,
            det: determinant([b1, b2], across, low_pass),
        }
    }

    /// By how much the mean of `a . u` changes a pixel: `S^-1 B a`.
    fn slope(&self, a: Vec3<T>) -> [T; 2] {
        let ([b1, b2], c, l) = (self.gradients, self.across, self.low_pass);
        let x = c.dot(a.cross(b2)) + l * a.dot(b1);
        let y = l * a.dot(b2) - c.dot(a.cross(b1));
        [x, y].map(|v| v * self.factor / self.det)
    }

    /// Covariance of `a . u` and `b . u`, as a sum of terms that do not cancel where a is b.
    fn covariance(&self, a: Vec3<T>, b: Vec3<T>) -> T {
        let ([b1, b2], c, l) = (self.gradients, self.across, self.low_pass);
        let across = a.cross(b1).dot(b.cross(b1)) + a.cross(b2).dot(b.cross(b2));
        (a.dot(c) * b.dot(c) + l * (across + l * a.dot(b))) / self.det
    }
}

/// Beyond this many deviations a surface is as good as not there.
const FARTHEST: f64 = 8.0;
/// Shares below which a pixel shows nothing of a splat.
const LEAST_SHARE: f64 = 1e-9;

impl<T: Real> SplatDepth<T> {
    /// The depth of a splat under a clip.
    pub fn new(
        scene: &Gaussians,
        index: usize,
        footprint: &Footprint<T>,
        clip: &Clip,
        settings: &Settings,
    ) -> Self {
        let given = PixelConditional::new(footprint);
        let m3 = footprint.rows[2];
        let [x, y] = given.slope(m3);
        let open = DepthLimit {
            z: [T::of(FARTHEST), T::zero(), T::zero()],
            shift: T::zero(),
        };
        let mut depth = Self {
            mean: [footprint.view_centre.z, x, y],
            far: open,
            near: open,
            op: clip.op,
        };
        let gaussian = GaussianInView::new(scene, index, footprint, clip, settings);
        let surfaces = match clip.is_flat() {
            true => clip.surfaces.clone(),
            false => gaussian.cutting_surfaces(),
        };
        if surfaces.is_empty() || !matches!(settings.mode, Mode::Rara | Mode::Exact) {
            depth.op = ClipOp::And;
            return depth;
        }
        if !clip.is_flat() {
            // What cuts a splat of a region with parts is taken for an intersection.
            depth.op = ClipOp::And;
        }
        for surface in &surfaces {
            let half_space = gaussian.half_space(surface);
            let half_space = match depth.op {
                ClipOp::And => half_space,
                ClipOp::Or => half_space.complement(),
            };
            let size = half_space.normal.largest().max(T::of(1e-30));
            let a = half_space.normal * (T::one() / size);
            let deviation = given.covariance(a, a).max(T::of(1e-30)).sqrt();
            let z = half_space.offset / size / deviation;
            let [x, y] = given.slope(a).map(|v| v / deviation);
            let threshold = DepthLimit {
                z: [z, x, y],
                shift: given.covariance(a, m3) / deviation,
            };
            let along = [a.dot(given.across), a.x, a.y, a.z];
            let first = along.into_iter().find(|&v| v != T::zero());
            let kind = if first.is_none_or(|v| v > T::zero()) {
                &mut depth.far
            } else {
                &mut depth.near
            };
            if z < kind.z[0] {
                *kind = threshold;
            }
        }
        depth
    }

    /// The mean depth of what is visible at an offset from the splat's centre, pixels.
    pub fn mean(&self, dx: T, dy: T) -> T {
        let at = |[a, b, c]: [T; 3]| a + b * dx + c * dy;
        let farthest = T::of(FARTHEST);
        let kept = |z: T| z.max(-farthest).min(farthest);
        let density = |z: T| (T::of(-0.5) * z * z).exp() / T::of(std::f64::consts::TAU.sqrt());
        let whole = at(self.mean);
        let (low, high) = (-kept(at(self.far.z)), kept(at(self.near.z)));
        if low >= high {
            return whole;
        }
        let moment = self.far.shift * density(low) + self.near.shift * density(high);
        let least = T::of(LEAST_SHARE);
        match self.op {
            ClipOp::And if low + high > T::zero() => {
                whole + moment / ((-low).phi() - (-high).phi()).max(least)
            }
            ClipOp::And => whole + moment / (high.phi() - low.phi()).max(least),
            ClipOp::Or => whole - moment / (low.phi() + (-high).phi()).max(least),
        }
    }
}

/// A picture of expected depths: for each pixel the sum of the splats' depths, each times what its splat adds to the pixel's
/// alpha, and that alpha.
pub fn expected<'a, T: Real>(
    scene: impl Into<Scene<'a>>,
    camera: &Camera,
    clip: &Clip,
    settings: &Settings,
) -> Vec<[f64; 2]> {
    blended::<T, [f64; 2]>(&scene.into(), (camera, clip, settings), |pixel, part| {
        let [sum, coverage] = pixel;
        *sum += part.added * part.depth;
        *coverage = part.coverage;
    })
}

/// A picture of the depths of the splats with which the pixels reach an alpha, front to back; `None` where they stay below.
pub fn reaching<'a, T: Real>(
    scene: impl Into<Scene<'a>>,
    camera: &Camera,
    clip: &Clip,
    settings: &Settings,
    least: f64,
) -> Vec<Option<f64>> {
    let look = (camera, clip, settings);
    blended::<T, Option<f64>>(&scene.into(), look, |reached, part| {
        if part.coverage >= least {
            reached.get_or_insert(part.depth);
        }
    })
}

/// A picture of the splats that add most to their pixels' alpha. The coverage is that of the whole pixel.
pub fn strongest<'a, T: Real>(
    scene: impl Into<Scene<'a>>,
    camera: &Camera,
    clip: &Clip,
    settings: &Settings,
) -> Vec<SplatPart> {
    blended::<T, SplatPart>(&scene.into(), (camera, clip, settings), |most, part| {
        if part.added > most.added {
            *most = part;
        }
        most.coverage = part.coverage;
    })
}

/// The part that a splat has in a pixel.
#[derive(Debug, Clone, Copy, Default)]
pub struct SplatPart {
    /// What it adds to the pixel's alpha.
    pub added: f64,
    /// The pixel's alpha with it.
    pub coverage: f64,
    /// Its depth there.
    pub depth: f64,
    /// The number of its layer.
    pub layer: usize,
    /// The number of its Gaussian in the layer.
    pub gaussian: usize,
}

/// A picture whose pixels a function has made of the splats' parts in them, front to back.
fn blended<T: Real, P: Clone + Default>(
    scene: &Scene<'_>,
    (camera, clip, settings): (&Camera, &Clip, &Settings),
    mut blend: impl FnMut(&mut P, SplatPart),
) -> Vec<P> {
    let mut pixels = vec![(0.0, P::default()); (camera.width * camera.height) as usize];
    let layers = layer::layers(scene, camera, clip);
    let sides: Vec<_> = layers
        .iter()
        .map(|layer| super::sides(layer, settings))
        .collect();
    let splats = super::in_order::<T>(&layers, &sides, camera, settings);
    // By their numbers, the layer and the place in it of the scene's Gaussians.
    let mut places = vec![(0, 0); sides.iter().map(Vec::len).sum()];
    for (at, layer) in layers.iter().enumerate() {
        for index in 0..layer.gaussians.len() {
            places[layer.numbers.of(index as u32) as usize] = (at, index);
        }
    }
    let [width, height] = [camera.width, camera.height];
    for splat in &splats {
        let footprint = &splat.footprint;
        let (layer, index) = places[splat.index as usize];
        let LayerView {
            gaussians, clip, ..
        } = &layers[layer];
        let depth = SplatDepth::new(gaussians, index, footprint, clip, settings);
        let span = |axis, size| footprint.span(axis, size, T::one());
        let (Some((left, right)), Some((top, bottom))) = (span(0, width), span(1, height)) else {
            continue;
        };
        for y in top..=bottom {
            for x in left..=right {
                let offset = |at: u32, axis: usize| {
                    T::of(f64::from(at) + 0.5) - footprint.screen_centre[axis]
                };
                let (dx, dy) = (offset(x, 0), offset(y, 1));
                if let Some(alpha) = splat::alpha(splat, dx, dy, settings.decay_law()) {
                    let (coverage, pixel) = &mut pixels[(y * width + x) as usize];
                    let added = (1.0 - *coverage) * alpha.wide();
                    *coverage += added;
                    let part = SplatPart {
                        added,
                        coverage: *coverage,
                        depth: depth.mean(dx, dy).wide(),
                        layer,
                        gaussian: index,
                    };
                    blend(pixel, part);
                }
            }
        }
    }
    pixels.into_iter().map(|(_, pixel)| pixel).collect()
}
