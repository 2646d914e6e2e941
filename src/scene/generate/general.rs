//! A planet with a core and a ring above a tiled floor: splats on surfaces, distributed as training leaves them.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::random::Random;
use super::spherical::Colours;
use super::{Builder, Draft, Gaussians, axes_about, pattern, split};
use crate::harmonics::COEFFICIENTS;

/// Tangential deviation in units of the mean spacing. Below about 0.7 holes show, above 1 the pattern blurs.
const COVERAGE: f64 = 0.8;
/// Share of faint large splats off the surfaces, which every training leaves.
const FLOATERS: f64 = 0.02;
/// Towards the light: up (y is down), front and left.
const LIGHT: DVec3 = DVec3::new(-0.48, -0.72, -0.5);

const PLANET: DVec3 = DVec3::new(0.0, 0.04, 0.0);
const PLANET_RADIUS: f64 = 0.36;
const CORE_RADIUS: f64 = 0.19;
const RING_RADIUS: f64 = 0.62;
const RING_THICKNESS: f64 = 0.075;
/// The ring's axis: the world's vertical, tilted.
const RING_AXIS: DVec3 = DVec3::new(0.34, -0.92, -0.19);
const FLOOR_Y: f64 = 0.54;
const FLOOR_RADIUS: f64 = 0.82;

/// A point of a surface.
struct Sample {
    position: DVec3,
    normal: DVec3,
    colour: DVec3,
    /// Strength of the highlight, 0 to 1.
    gloss: f64,
}

type Surface = fn(&mut Random) -> Sample;

pub(super) fn generate(count: usize, mut random: Random) -> Gaussians {
    // The planet's bumps add about a tenth to a sphere's area.
    let surfaces: [(f64, Surface); 4] = [
        (4.4 * PI * PLANET_RADIUS * PLANET_RADIUS, planet),
        (4.0 * PI * CORE_RADIUS * CORE_RADIUS, core),
        (TAU * RING_RADIUS * TAU * RING_THICKNESS, ring),
        (PI * FLOOR_RADIUS * FLOOR_RADIUS, floor),
    ];
    let area: f64 = surfaces.iter().map(|(area, _)| area).sum();
    let [on, off] = split(count, [1.0 - FLOATERS, FLOATERS]);
    let sigma = COVERAGE * (area / on.max(1) as f64).sqrt();
    // With few splats there is little to see, but none of them should be larger than the scene.
    let sigma = sigma.min(0.2);
    let mut builder = Builder::new(count, 3);
    let counts = split(on, surfaces.map(|(area, _)| area));
    for ((_, surface), count) in surfaces.into_iter().zip(counts) {
        for _ in 0..count {
            let sample = surface(&mut random);
            push_sample(&mut builder, &sample, sigma, &mut random);
        }
    }
    for _ in 0..off {
        push_floater(&mut builder, sigma, &mut random);
    }
    builder.0
}

fn push_sample(builder: &mut Builder, sample: &Sample, sigma: f64, random: &mut Random) {
    let Sample {
        position,
        normal,
        colour,
        gloss,
    } = *sample;
    let size = sigma * random.factor(0.3);
    let aspect = random.factor(0.4).clamp(0.3, 3.0);
    // Training flattens splats on surfaces; a tenth of them end up as sheets without measurable thickness.
    let flatness = if random.unit() < 0.1 {
        1e-4
    } else {
        0.1 * random.factor(0.8).min(5.0)
    };
    let tilted = (normal + 0.08 * random.in_ball()).normalize();
    let splat = Draft {
        position: position
            + normal
                * random
                    .normal(0.0, 0.1 * sigma)
                    .clamp(-0.3 * sigma, 0.3 * sigma),
        axes: axes_about(tilted, random.range(0.0, TAU)),
        scales: DVec3::new(size * aspect.sqrt(), size / aspect.sqrt(), size * flatness),
        opacity: opacity(random),
    };
    let light = LIGHT.normalize();
    let lit = 0.55 + 0.45 * normal.dot(light);
    let colour = (colour * lit + 0.015 * random.in_ball()).clamp(DVec3::ZERO, DVec3::ONE);
    let mut colours = Colours::plain(colour);
    // A highlight is seen along the reflected ray, that is, in a direction of view against the reflection.
    let reflected = 2.0 * normal.dot(light) * normal - light;
    let facing = normal.dot(light).max(0.0);
    colours.add_zonal(-reflected, [0.10, 0.09, 0.06], DVec3::splat(gloss * facing));
    for at in 1..COEFFICIENTS {
        colours.0[at] += 0.012 * random.in_ball();
    }
    builder.push(&splat, &colours.0);
}

/// Most splats of a trained scene are either nearly opaque or nearly gone.
fn opacity(random: &mut Random) -> f64 {
    let which = random.unit();
    let logit = if which < 0.72 {
        random.normal(4.0, 1.2)
    } else if which < 0.88 {
        random.normal(0.5, 1.2)
    } else {
        random.normal(-3.0, 0.8)
    };
    1.0 / (1.0 + (-logit).exp())
}

fn push_floater(builder: &mut Builder, sigma: f64, random: &mut Random) {
    let size = 2.5 * sigma * random.factor(0.4).min(3.0);
    let splat = Draft {
        position: 0.85 * random.in_ball() * DVec3::new(1.0, 0.6, 1.0),
        axes: axes_about(random.direction(), 0.0),
        scales: size * DVec3::new(random.factor(0.3), random.factor(0.3), random.factor(0.3)),
        opacity: random.range(0.005, 0.03),
    };
    let grey = DVec3::splat(random.range(0.3, 0.6));
    builder.push(&splat, &Colours::plain(grey).0);
}

fn planet(random: &mut Random) -> Sample {
    let direction = random.direction();
    let height = |d: DVec3| PLANET_RADIUS * (1.0 + 0.07 * pattern(d, 0.8) + 0.02 * pattern(d, 2.3));
    // The normal from the surface's own tangents, by differences.
    let (u, v) = direction.any_orthonormal_pair();
    let at = |d: DVec3| d * height(d.normalize()) / d.length();
    let position = at(direction);
    let step = 1e-4;
    let normal = (at(direction + step * u) - position).cross(at(direction + step * v) - position);
    let normal = normal.normalize() * normal.dot(direction).signum();
    let altitude = pattern(direction, 0.8) + 0.3 * pattern(direction, 2.3);
    let detail = 0.5 + 0.5 * pattern(direction, 5.0);
    let (colour, gloss) = if altitude < -0.05 {
        (
            DVec3::new(0.05, 0.28, 0.55).lerp(DVec3::new(0.08, 0.42, 0.62), detail),
            1.0,
        )
    } else if altitude < 0.02 {
        (DVec3::new(0.90, 0.80, 0.55), 0.3)
    } else if altitude < 0.35 {
        (
            DVec3::new(0.16, 0.50, 0.20).lerp(DVec3::new(0.42, 0.62, 0.22), detail),
            0.2,
        )
    } else {
        (
            DVec3::new(0.62, 0.52, 0.44).lerp(DVec3::splat(0.95), detail),
            0.4,
        )
    };
    Sample {
        position: PLANET + position,
        normal,
        colour,
        gloss,
    }
}

fn core(random: &mut Random) -> Sample {
    let normal = random.direction();
    let heat = 0.5 + 0.5 * pattern(normal, 1.6);
    let colour = DVec3::new(0.85, 0.16, 0.05).lerp(DVec3::new(1.0, 0.85, 0.30), heat * heat);
    Sample {
        position: PLANET + CORE_RADIUS * normal,
        normal,
        colour,
        gloss: 0.6,
    }
}

fn ring(random: &mut Random) -> Sample {
    let axis = RING_AXIS.normalize();
    let (u, v) = axis.any_orthonormal_pair();
    let around = random.range(0.0, TAU);
    // The outside of a torus has more area than the inside.
    let across = loop {
        let angle = random.range(0.0, TAU);
        let share = (RING_RADIUS + RING_THICKNESS * angle.cos()) / (RING_RADIUS + RING_THICKNESS);
        if random.unit() < share {
            break angle;
        }
    };
    let outwards = around.cos() * u + around.sin() * v;
    let normal = across.cos() * outwards + across.sin() * axis;
    // Three coloured bands wind round the ring.
    let turn = (around * 9.0 + across * 2.0).rem_euclid(TAU) / TAU;
    let colour = match (3.0 * turn) as u32 {
        0 => DVec3::new(0.93, 0.35, 0.18),
        1 => DVec3::new(0.96, 0.90, 0.80),
        _ => DVec3::new(0.18, 0.45, 0.68),
    };
    Sample {
        position: PLANET + RING_RADIUS * outwards + RING_THICKNESS * normal,
        normal,
        colour,
        gloss: 0.9,
    }
}

fn floor(random: &mut Random) -> Sample {
    let radius = FLOOR_RADIUS * random.unit().sqrt();
    let angle = random.range(0.0, TAU);
    let position = DVec3::new(radius * angle.cos(), FLOOR_Y, radius * angle.sin());
    let tile = ((position.x / 0.12).floor() + (position.z / 0.12).floor()).rem_euclid(2.0);
    let grain = 0.06 * pattern(position, 6.0);
    let tone = if tile < 1.0 {
        DVec3::new(0.85, 0.82, 0.76)
    } else {
        DVec3::new(0.36, 0.33, 0.34)
    };
    // The planet's shadow, without an edge.
    let shadow =
        1.0 - 0.55 * (-(position - DVec3::new(0.18, FLOOR_Y, 0.18)).length_squared() / 0.09).exp();
    Sample {
        position,
        normal: -DVec3::Y,
        colour: (tone + grain) * shadow,
        gloss: 0.3,
    }
}
