//! How far a scene is from what it was made of, attribute by attribute.

use std::fmt;

use rara::Gaussians;
use rara::glam::Vec3;

/// The spherical harmonic of degree 0.
const SH_0: f32 = 0.282_094_8;

/// The largest differences of all Gaussians.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Distance {
    /// World units.
    pub(super) position: f32,
    /// Relative to the larger of the scales and `floor`: 0.01 is one per cent.
    pub(super) scale: f32,
    /// Of the axes' directions, radians.
    pub(super) rotation: f32,
    pub(super) opacity: f32,
    /// Of the colours of degree 0, which are 0 to 1 but may be beyond.
    pub(super) colour: f32,
    /// The same of what is within 0 to 1.
    pub(super) shown: f32,
    /// Of the coefficients above degree 0 that both have.
    pub(super) harmonics: f32,
}

impl Distance {
    /// The distance between scenes of as many Gaussians, each matched with that which is nearest to it; all are within
    /// `near` of their own. Scales below `floor` are all the same.
    pub(super) fn between(truth: &Gaussians, other: &Gaussians, near: f32, floor: f32) -> Self {
        assert_eq!(truth.len(), other.len());
        let mut distance = Self::default();
        let mut taken = vec![false; other.len()];
        let mut by_x: Vec<usize> = (0..other.len()).collect();
        let x = |at: usize| other.positions()[at].x;
        by_x.sort_by(|a, b| x(*a).total_cmp(&x(*b)));
        for (index, position) in truth.positions().iter().enumerate() {
            let first = by_x.partition_point(|at| x(*at) < position.x - near);
            let candidates = by_x[first..]
                .iter()
                .take_while(|at| x(**at) <= position.x + near);
            // Several centres may be in one place: then the one whose other numbers fit.
            let unlike = |at: usize| {
                let axes = truth.scales()[index].distance(other.scales()[at]);
                let turned = turned(truth, index, other, at).min(0.3);
                position.distance(other.positions()[at]) / near + axes + turned
            };
            let free = candidates.filter(|at| !taken[**at]);
            let nearest = free
                .copied()
                .min_by(|a, b| unlike(*a).total_cmp(&unlike(*b)));
            let at =
                nearest.unwrap_or_else(|| panic!("none is near to Gaussian {index} at {position}"));
            taken[at] = true;
            distance.add(truth, index, other, at, floor);
        }
        distance
    }

    fn add(&mut self, truth: &Gaussians, index: usize, other: &Gaussians, at: usize, floor: f32) {
        let more = |to: &mut f32, value: f32| *to = to.max(value);
        let apart = truth.positions()[index] - other.positions()[at];
        more(&mut self.position, apart.abs().max_element());
        let scales = [truth.scales()[index], other.scales()[at]].map(|s| s.max(Vec3::splat(floor)));
        more(
            &mut self.scale,
            ((scales[0] - scales[1]).abs() / scales[0].max(scales[1])).max_element(),
        );
        more(&mut self.rotation, turned(truth, index, other, at));
        more(
            &mut self.opacity,
            (truth.opacities()[index] - other.opacities()[at]).abs(),
        );
        let [own, others] = [truth.sh_of(index), other.sh_of(at)];
        for (number, (a, b)) in own.iter().zip(others).enumerate() {
            if number < 3 {
                let [a, b] = [a, b].map(|value| 0.5 + SH_0 * value);
                more(&mut self.colour, (a - b).abs());
                more(
                    &mut self.shown,
                    (a.clamp(0.0, 1.0) - b.clamp(0.0, 1.0)).abs(),
                );
            } else {
                more(&mut self.harmonics, (a - b).abs());
            }
        }
    }
}

/// The angle between two rotations.
fn turned(truth: &Gaussians, index: usize, other: &Gaussians, at: usize) -> f32 {
    let [a, b] = [truth.rotations()[index], other.rotations()[at]].map(|q| q.as_dquat());
    let between = a.conjugate() * b;
    (2.0 * between.xyz().length().atan2(between.w.abs())) as f32
}

impl fmt::Display for Distance {
    /// A row of the guide's table.
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        let columns = [
            self.position,
            self.scale,
            self.rotation,
            self.opacity,
            self.shown,
            self.harmonics,
        ];
        for (number, value) in columns.into_iter().enumerate() {
            let between = if number > 0 { " | " } else { "" };
            match value {
                value if value < 1e-6 => write!(to, "{between}0")?,
                value => write!(to, "{between}{value:.1e}")?,
            }
        }
        Ok(())
    }
}
