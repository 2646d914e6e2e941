//! A head of hair: strands grow from a cap, fall and curl; one needle a segment, as strand reconstructions have them.

use std::f64::consts::TAU;

use glam::{DMat3, DVec3};

use super::random::Random;
use super::spherical::Colours;
use super::{Builder, Draft, Gaussians, pattern};

/// Segments of a strand. Fewer make visible corners in the curls.
const SEGMENTS: usize = 24;
/// A segment's deviation along the strand in units of its length: needles join without beads or gaps.
const OVERLAP: f64 = 0.5;
/// Length by thickness of a needle.
const SLENDERNESS: f64 = 20.0;

const HEAD: DVec3 = DVec3::new(0.0, -0.26, 0.0);
const HEAD_RADIUS: f64 = 0.36;
/// The middle of the scalp: above (y is down) and slightly behind.
const CROWN: DVec3 = DVec3::new(0.0, -0.95, 0.31);
/// Cosine of the scalp's extent from the crown.
const HAIRLINE: f64 = -0.12;
const LIGHT: DVec3 = DVec3::new(-0.4, -0.8, -0.45);

pub(super) fn generate(count: usize, mut random: Random) -> Gaussians {
    let mut builder = Builder::new(count, 3);
    while builder.0.len() < count {
        let segments = SEGMENTS.min(count - builder.0.len());
        push_strand(&mut builder, segments, &mut random);
    }
    builder.0
}

fn push_strand(builder: &mut Builder, segments: usize, random: &mut Random) {
    let root = scalp(random);
    // Neighbours share waves and tone, so that the hair falls in locks; each strand strays a little from its lock.
    let lock = pattern(root, 1.7);
    let phase = TAU * (1.5 * pattern(root, 1.1)) + random.normal(0.0, 0.25);
    let length = random.range(0.72, 0.9) * (0.85 + 0.15 * lock);
    let step = length / SEGMENTS as f64;
    let curl = 0.05 + 0.025 * lock;
    let stray = 0.12 * random.in_ball();

    let mut core = HEAD + HEAD_RADIUS * root;
    let mut previous = core;
    let mut direction = root;
    let tone = 0.5 + 0.5 * lock + random.normal(0.0, 0.18);
    for segment in 0..segments {
        let along = (segment + 1) as f64 / SEGMENTS as f64;
        // Stiff at the root, then the weight takes over.
        direction = (direction + DVec3::Y * (0.16 + 0.30 * along) + 0.25 * stray).normalize();
        core += step * direction;
        let from_head = core - HEAD;
        let floor = HEAD_RADIUS * 1.04;
        if from_head.length() < floor {
            core = HEAD + from_head.normalize() * floor;
        }
        // The strand winds round its core line.
        let (u, v) = root.any_orthonormal_pair();
        let turn = phase + along * 2.2 * TAU;
        let end = core + curl * along.sqrt() * (turn.cos() * u + turn.sin() * v);
        push_needle(builder, previous, end, along, tone, random);
        previous = end;
    }
}

/// Uniform on the cap round the crown, as a direction from the head's middle.
fn scalp(random: &mut Random) -> DVec3 {
    loop {
        let direction = random.direction();
        if direction.dot(CROWN.normalize()) > HAIRLINE {
            return direction;
        }
    }
}

fn push_needle(
    builder: &mut Builder,
    from: DVec3,
    to: DVec3,
    along: f64,
    tone: f64,
    random: &mut Random,
) {
    let tangent = (to - from).try_normalize().unwrap_or(DVec3::Y);
    let (u, v) = tangent.any_orthonormal_pair();
    let long = OVERLAP * (to - from).length().max(1e-3);
    let thin = long / SLENDERNESS;
    let splat = Draft {
        position: (from + to) / 2.0,
        axes: DMat3::from_cols(tangent, u, v),
        scales: DVec3::new(long, thin, thin),
        opacity: (0.92 - 0.35 * along * along) * random.range(0.85, 1.0),
    };
    let dark = DVec3::new(0.20, 0.10, 0.05);
    let light = DVec3::new(0.74, 0.46, 0.22);
    let colour = dark.lerp(light, (0.18 + 0.42 * tone + 0.25 * along).clamp(0.0, 1.0));
    // Lit where it runs across the light, as Kajiya and Kay have it; from the side that faces it.
    let towards = LIGHT.normalize();
    let across = (1.0 - tangent.dot(towards).powi(2)).sqrt();
    let outside = ((from - HEAD).normalize_or_zero().dot(towards) * 0.5 + 0.5).clamp(0.0, 1.0);
    let lit = 0.35 + 0.75 * across * outside;
    let mut colours = Colours::plain(colour * lit);
    // The sheen: brighter seen across the strand than along it, and against the light's mirror direction.
    let sheen = DVec3::new(0.55, 0.45, 0.35) * across * outside;
    colours.add_zonal(tangent, [0.0, -0.16, 0.0], sheen);
    let mirrored = towards - 2.0 * tangent.dot(towards) * tangent;
    colours.add_zonal(-mirrored, [0.10, 0.08, 0.05], sheen);
    builder.push(&splat, &colours.0);
}
