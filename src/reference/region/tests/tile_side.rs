//! The side of a tile in a cut splat, from bounds of its pixels' z: the twin of `glsl/region/tile_side.glsl`.
//!
//! No picture depends on how close the bounds are: a tile that is on no side is weighed pixel by pixel. The tests hold them to
//! the pixels' own values.

use glam::{DVec2, DVec3, Vec2, Vec3, Vec4};

use rara_base::limits::{TILE_HEIGHT, TILE_WIDTH};
use rara_scene::Random;

/// From a tile's middle to its outermost pixel centres, px.
pub(super) const TILE_REACH: Vec2 = Vec2::new(
    0.5 * (TILE_WIDTH - 1) as f32,
    0.5 * (TILE_HEIGHT - 1) as f32,
);

/// The least and the greatest value.
pub(super) type Range = [f32; 2];

/// Of a splat that carries its curve.
fn carried_range(linear: Vec3, curvature: Vec3, delta: Vec2) -> Range {
    let squares = Vec3::new(delta.x * delta.x, delta.x * delta.y, delta.y * delta.y);
    let z = linear.x + linear.y * delta.x + linear.z * delta.y + curvature.dot(squares);
    let slope = Vec2::new(
        linear.y + 2.0 * curvature.x * delta.x + curvature.y * delta.y,
        linear.z + curvature.y * delta.x + 2.0 * curvature.z * delta.y,
    );
    let r = TILE_REACH;
    let bent = Vec3::new(r.x * r.x, r.x * r.y, r.y * r.y);
    let reach = slope.abs().dot(r) + curvature.abs().dot(bent);
    [z - reach, z + reach]
}

/// A record that is a curve: linear, bend, twist and wave, as `glsl/cut.glsl` says.
type Curve = [Vec4; 4];

fn curve_z([linear, bend, twist, wave]: &Curve, uv: Vec2) -> f64 {
    let at = |v: &Vec4| v.to_array().map(f64::from);
    let ([l, b], [t, w]) = ([at(linear), at(bend)], [at(twist), at(wave)]);
    let [u, v] = uv.to_array().map(f64::from);
    l[0] + u * (l[1] + u * (b[0] + u * (t[0] + u * w[0])))
        + v * (l[2]
            + u * (b[1] + u * (t[1] + u * w[1]))
            + v * (b[2] + u * (t[2] + u * w[2]) + v * (t[3] + u * w[3] + v * b[3])))
}

fn curve_range(curve: &Curve, uv: Vec2, uv_reach: Vec2) -> Range {
    let [linear, bend, twist, wave] = curve.map(Vec4::abs);
    let z = curve_z(curve, uv) as f32;
    // The mean value theorem, with the largest slopes that the coordinates' magnitudes allow.
    let Vec2 { x: u, y: v } = uv.abs() + uv_reach;
    let along_u = linear.y
        + 2.0 * bend.x * u
        + bend.y * v
        + 3.0 * twist.x * u * u
        + 2.0 * twist.y * u * v
        + twist.z * v * v
        + 4.0 * wave.x * u * u * u
        + 3.0 * wave.y * u * u * v
        + 2.0 * wave.z * u * v * v
        + wave.w * v * v * v;
    let along_v = linear.z
        + bend.y * u
        + 2.0 * bend.z * v
        + twist.y * u * u
        + 2.0 * twist.z * u * v
        + 3.0 * twist.w * v * v
        + wave.y * u * u * u
        + 2.0 * wave.z * u * u * v
        + 3.0 * wave.w * u * v * v
        + 4.0 * bend.w * v * v * v;
    let reach = along_u * uv_reach.x + along_v * uv_reach.y;
    [z - reach, z + reach]
}

/// The lines of sight through a splat: the gradients at the tile's middle, how they lean, and the middle relative to the
/// splat's centre.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sights {
    pub(super) b1: Vec3,
    pub(super) b2: Vec3,
    pub(super) lean: Vec3,
    pub(super) delta: Vec2,
    pub(super) scale: f32,
    pub(super) low_pass: f32,
}

/// How far the terms of the lines of sight of a tile's pixels are from those of the middle one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reach {
    pub(super) b: Vec2,
    pub(super) c_x: Vec3,
    pub(super) c_y: Vec3,
    pub(super) c: f32,
    /// The determinant in the middle, the least and the greatest.
    pub(super) det: [f32; 3],
}

/// Bounds of what a plane's z is made of: `mean / sqrt(variance det)`.
pub(super) struct PlaneRange {
    pub(super) mean: Range,
    pub(super) variance: Range,
}

impl Sights {
    pub(super) fn reach(&self) -> Reach {
        let determinant =
            |c: f32, b: Vec2| c * c + self.low_pass * (b.length_squared() + self.low_pass);
        let c_x = TILE_REACH.x * self.b2.cross(self.lean);
        let c_y = TILE_REACH.y * self.lean.cross(self.b1);
        let (c_length, c) = (self.b1.cross(self.b2).length(), c_x.length() + c_y.length());
        let length = Vec2::new(self.b1.length(), self.b2.length());
        let b = TILE_REACH * self.lean.length();
        let det = [
            determinant(c_length, length),
            determinant((c_length - c).max(0.0), (length - b).max(Vec2::ZERO)),
            determinant(c_length + c, length + b),
        ];
        Reach {
            b,
            c_x,
            c_y,
            c,
            det,
        }
    }

    /// A half-space's z in the pixel this far from the tile's middle (`beam_z` of `glsl/sight.glsl`), in double precision.
    fn z(&self, half_space: Vec4, pixel: DVec2) -> f64 {
        let lean = self.lean.as_dvec3();
        let b1 = self.b1.as_dvec3() - pixel.x * lean;
        let b2 = self.b2.as_dvec3() - pixel.y * lean;
        let (c, low_pass) = (b1.cross(b2), f64::from(self.low_pass));
        let det = c.length_squared()
            + low_pass * (b1.length_squared() + b2.length_squared())
            + low_pass * low_pass;
        let a: DVec3 = half_space.truncate().as_dvec3();
        let (a1, a2) = (a.cross(b1), a.cross(b2));
        let variance = a.dot(c).powi(2)
            + low_pass * (a1.length_squared() + a2.length_squared())
            + low_pass * low_pass * a.length_squared();
        let k = DVec2::new(
            c.dot(a2) + low_pass * a.dot(b1),
            low_pass * a.dot(b2) - c.dot(a1),
        );
        let delta = (self.delta.as_dvec2() + pixel) * f64::from(self.scale);
        (f64::from(half_space.w) + k.dot(delta) / det) / (variance / det).sqrt()
    }

    /// Bounds over the tile of what it is made of.
    pub(super) fn plane_range(&self, half_space: Vec4) -> PlaneRange {
        let reach = self.reach();
        let [det, det_least, det_most] = reach.det;
        let c = self.b1.cross(self.b2);
        let a = half_space.truncate();
        let (a1, a2) = (a.cross(self.b1), a.cross(self.b2));
        let across = Vec2::new(a1.length(), a2.length());
        let across_reach = TILE_REACH * a.cross(self.lean).length();
        let along = a.dot(c).abs();
        let along_reach = a.dot(reach.c_x).abs() + a.dot(reach.c_y).abs();
        let variance = |along: f32, across: Vec2| {
            along * along
                + self.low_pass * across.length_squared()
                + self.low_pass * self.low_pass * a.length_squared()
        };
        let across_least = (across - across_reach).max(Vec2::ZERO);
        let variance_least = variance((along - along_reach).max(0.0), across_least);
        let variance_most = variance(along + along_reach, across + across_reach);
        let k = Vec2::new(
            c.dot(a2) + self.low_pass * a.dot(self.b1),
            self.low_pass * a.dot(self.b2) - c.dot(a1),
        );
        let k_reach = Vec2::new(across.y, across.x) * reach.c
            + (c.length() + reach.c) * Vec2::new(across_reach.y, across_reach.x)
            + self.low_pass * a.length() * reach.b;
        let delta = self.delta * self.scale;
        let mean = half_space.w * det + k.dot(delta);
        let mean_reach = half_space.w.abs() * (det_most - det).max(det - det_least)
            + delta.abs().dot(k_reach)
            + (TILE_REACH * self.scale).dot(k.abs() + k_reach);
        PlaneRange {
            mean: [mean - mean_reach, mean + mean_reach],
            variance: [variance_least, variance_most],
        }
    }

    /// Bounds of it over the tile.
    fn z_range(&self, half_space: Vec4) -> Range {
        let [_, det_least, det_most] = self.reach().det;
        let PlaneRange {
            mean: [low, high],
            variance: [variance_least, variance_most],
        } = self.plane_range(half_space);
        let scale_least = (variance_most * det_most).max(1e-30).sqrt().recip();
        let scale_most = (variance_least * det_least).max(1e-30).sqrt().recip();
        let scaled =
            |mean: f32, outwards: bool| mean * if outwards { scale_most } else { scale_least };
        [scaled(low, low <= 0.0), scaled(high, high >= 0.0)]
    }
}

/// Offsets of a tile's pixel centres from its middle.
pub(super) fn pixels() -> impl Iterator<Item = Vec2> {
    let places = (0..TILE_HEIGHT).flat_map(|y| (0..TILE_WIDTH).map(move |x| (x, y)));
    places.map(|(x, y)| Vec2::new(x as f32, y as f32) - TILE_REACH)
}

/// Checks that a range holds all values, and returns by how much of their own range it is too wide at either end.
fn slack(range: Range, values: impl Iterator<Item = f64>) -> f64 {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for value in values {
        (low, high) = (low.min(value), high.max(value));
    }
    let [least, most] = range.map(f64::from);
    let rounding = 1e-4 * (1.0 + low.abs().max(high.abs()));
    assert!(
        least <= low + rounding && most >= high - rounding,
        "{least} to {most} does not hold {low} to {high}"
    );
    (low - least).max(most - high)
}

pub(super) fn within(random: &mut Random, most: f32) -> f32 {
    most * (2.0 * random.unit() as f32 - 1.0)
}

pub(super) fn vector(random: &mut Random, most: f32) -> Vec3 {
    Vec3::from_array([(); 3].map(|()| within(random, most)))
}

#[test]
fn bounds_of_carried_curves_hold_every_pixels_z() {
    let mut random = Random::new(1);
    for _ in 0..4_000 {
        let linear = vector(&mut random, 0.5) + Vec3::X * within(&mut random, 6.0);
        let curvature = vector(&mut random, 5e-3);
        let delta = vector(&mut random, 40.0).truncate();
        let z = |pixel: Vec2| {
            let d = (delta + pixel).as_dvec2();
            let [c0, c1, c2] = curvature.as_dvec3().to_array();
            let bent = c0 * d.x * d.x + c1 * d.x * d.y + c2 * d.y * d.y;
            f64::from(linear.x) + f64::from(linear.y) * d.x + f64::from(linear.z) * d.y + bent
        };
        let slack = slack(carried_range(linear, curvature, delta), pixels().map(z));
        assert!(slack < 1.0, "{slack}: no tile would ever be on a side");
    }
}

#[test]
fn bounds_of_curves_hold_every_pixels_z() {
    let mut random = Random::new(2);
    for _ in 0..4_000 {
        let curve = [1.0, 0.3, 0.1, 0.05]
            .map(|most| vector(&mut random, most).extend(within(&mut random, most)));
        let uv = vector(&mut random, 3.0).truncate();
        let conic = Vec3::new(0.1, 0.05, 0.1) * random.unit() as f32;
        let turned =
            |pixel: Vec2| Vec2::new(conic.x * pixel.x, conic.y * pixel.x + conic.z * pixel.y);
        let z = pixels().map(|pixel| curve_z(&curve, uv + turned(pixel)));
        slack(curve_range(&curve, uv, turned(TILE_REACH)), z);
    }
}

#[test]
fn bounds_of_planes_hold_every_pixels_z() {
    let mut random = Random::new(3);
    let mut slacks = [(); 8].map(|()| Vec::new());
    for round in 0..8_000 {
        // Deviations of 1 to 128 pixels, and leans from none to that of a splat around the eye.
        let size = 2_f32.powi(round % 8);
        let sights = Sights {
            b1: vector(&mut random, size),
            b2: vector(&mut random, size),
            lean: vector(&mut random, size) * [0.0, 1e-3, 1e-2][(round % 3) as usize],
            delta: vector(&mut random, 3.0 * size).truncate(),
            scale: 1.0,
            low_pass: if round % 5 == 0 { 0.0 } else { 0.3 },
        };
        let normal = vector(&mut random, 1.0);
        let half_space = normal.extend(within(&mut random, 4.0));
        let z = pixels().map(|pixel| sights.z(half_space, pixel.as_dvec2()));
        slacks[(round % 8) as usize].push(slack(sights.z_range(half_space), z));
    }
    let medians = slacks.map(|mut slacks| {
        slacks.sort_by(f64::total_cmp);
        slacks[slacks.len() / 2]
    });
    // Large splats cover many tiles, so theirs have to be close.
    assert!(
        medians[6] < 0.5,
        "{medians:?}: bounds so wide are of no use"
    );
}
