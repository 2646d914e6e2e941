//! A limb-like body of filled shells, marrow to skin: what a cut through a scanned body shows.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::random::Random;
use super::spherical::Colours;
use super::{Builder, Draft, Gaussians, axes_about, pattern, split};

/// Half axes of the body's ellipsoid.
const BODY: DVec3 = DVec3::new(0.74, 0.92, 0.66);
/// Deviation in units of the mean spacing: the body is solid, but boundaries stay sharp.
const FILLING: f64 = 0.5;

/// One filled shell, between two shares of the body's radius.
struct Layer {
    inner: f64,
    outer: f64,
    /// Density of splats relative to the fat: thin and detailed layers get more and smaller ones.
    density: f64,
    opacity: f64,
    colour: fn(DVec3, f64) -> DVec3,
}

/// From the inside to the outside.
const LAYERS: [Layer; 5] = [
    layer([0.0, 0.2], 4.0, 0.75, marrow),
    layer([0.2, 0.38], 4.0, 0.97, bone),
    layer([0.38, 0.77], 1.6, 0.85, muscle),
    layer([0.77, 0.93], 1.0, 0.6, fat),
    layer([0.93, 1.0], 3.0, 0.9, skin),
];

const fn layer(
    [inner, outer]: [f64; 2],
    density: f64,
    opacity: f64,
    colour: fn(DVec3, f64) -> DVec3,
) -> Layer {
    Layer {
        inner,
        outer,
        density,
        opacity,
        colour,
    }
}

pub(super) fn generate(count: usize, mut random: Random) -> Gaussians {
    let mut builder = Builder::new(count, 0);
    let volume = |layer: &Layer| layer.outer.powi(3) - layer.inner.powi(3);
    let counts = split(
        count,
        LAYERS.each_ref().map(|layer| volume(layer) * layer.density),
    );
    let body = 4.0 / 3.0 * PI * BODY.element_product();
    for (layer, count) in LAYERS.iter().zip(counts) {
        let spacing = (volume(layer) * body / count.max(1) as f64).cbrt();
        let sigma = (FILLING * spacing).min(0.25);
        for _ in 0..count {
            push(&mut builder, layer, sigma, &mut random);
        }
    }
    builder.0
}

fn push(builder: &mut Builder, layer: &Layer, sigma: f64, random: &mut Random) {
    let direction = random.direction();
    // A gently dented body; every layer follows the dents.
    let radius = 1.0 + 0.05 * pattern(direction, 0.6) + 0.015 * pattern(direction, 1.9);
    let full = direction * BODY * radius;
    let thickness = (layer.outer - layer.inner) * full.length();
    // A splat on a boundary must not reach into the next layer, or the rings would blur.
    let across = sigma.min(0.25 * thickness) * random.factor(0.15).clamp(0.6, 1.5);
    let inset = (1.2 * across / full.length()).min(0.45 * (layer.outer - layer.inner));
    let inner = if layer.inner > 0.0 {
        layer.inner + inset
    } else {
        0.0
    };
    let outer = layer.outer - inset;
    let share = random.range(inner.powi(3), outer.powi(3)).cbrt();
    let position = full * share;
    let normal = (direction / BODY).normalize();
    let splat = Draft {
        position,
        axes: axes_about(normal, random.range(0.0, TAU)),
        scales: DVec3::new(
            sigma * random.factor(0.2).clamp(0.5, 2.0),
            sigma * random.factor(0.2).clamp(0.5, 2.0),
            across,
        ),
        opacity: (layer.opacity + random.normal(0.0, 0.04)).clamp(0.1, 0.99),
    };
    let depth = (share - layer.inner) / (layer.outer - layer.inner);
    let colour = (layer.colour)(position, depth) + 0.02 * random.in_ball();
    builder.push(
        &splat,
        &Colours::plain(colour.clamp(DVec3::ZERO, DVec3::ONE)).0[..1],
    );
}

fn marrow(p: DVec3, _depth: f64) -> DVec3 {
    let yellow = 0.5 + 0.5 * pattern(p, 9.0);
    DVec3::new(0.52, 0.08, 0.10).lerp(DVec3::new(0.86, 0.52, 0.26), yellow * yellow)
}

/// Spongy inside, compact outside.
fn bone(p: DVec3, depth: f64) -> DVec3 {
    let pores = (pattern(p, 14.0) * (1.0 - depth)).max(0.0);
    DVec3::new(0.94, 0.90, 0.80).lerp(DVec3::new(0.66, 0.42, 0.34), 1.6 * pores.min(0.5))
}

/// Bundles along the limb with pale sheaths between them, in two rings.
fn muscle(p: DVec3, depth: f64) -> DVec3 {
    let angle = p.z.atan2(p.x);
    let outer_ring = depth > 0.5;
    let bundles = if outer_ring { 9.0 } else { 6.0 };
    let wobble = 0.12 * pattern(p, 1.5);
    let at = (angle / TAU * bundles + wobble + if outer_ring { 0.35 } else { 0.0 }).rem_euclid(1.0);
    // Distance to the nearest sheath: between bundles, between the rings, and round the whole.
    let side = at.min(1.0 - at) / bundles * TAU * DVec3::new(p.x, 0.0, p.z).length();
    let ring = (depth - 0.5 - 0.08 * pattern(p, 1.1))
        .abs()
        .min(1.0 - depth)
        * 0.3;
    let sheath = 1.0 - (side.min(ring) / 0.016).min(1.0);
    let fibre = 0.5 + 0.5 * pattern(p * DVec3::new(1.0, 0.15, 1.0), 16.0);
    let meat = DVec3::new(0.48, 0.07, 0.08).lerp(DVec3::new(0.74, 0.20, 0.17), fibre);
    meat.lerp(DVec3::new(0.93, 0.80, 0.74), 0.9 * sheath)
}

/// Lobules with whitish walls.
fn fat(p: DVec3, _depth: f64) -> DVec3 {
    let wall = (1.0 - 6.0 * pattern(p, 5.0).abs()).max(0.0);
    DVec3::new(0.96, 0.80, 0.36).lerp(DVec3::new(0.98, 0.93, 0.78), wall)
}

fn skin(p: DVec3, depth: f64) -> DVec3 {
    let blush = 0.5 + 0.5 * pattern(p, 1.3);
    let outer = DVec3::new(0.80, 0.56, 0.44).lerp(DVec3::new(0.90, 0.68, 0.56), blush);
    // The deeper half is the redder one.
    outer.lerp(DVec3::new(0.80, 0.36, 0.32), (0.6 - depth).clamp(0.0, 0.6))
}
