//! The scene in memory: one array per attribute, as the file had them but in the units the renderer works in.

use glam::{Quat, Vec3};

/// A set of 3D Gaussians, one array per attribute, all of the same length (except [`sh`](Self::sh)).
///
/// Everything in here is finite, rotations are unit quaternions and scales are not negative: the loaders repair or
/// drop what is not and report it, so that no later stage has to ask.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Gaussians {
    /// Centres, world units.
    pub positions: Vec<Vec3>,
    /// Standard deviations along the Gaussian's own axes, world units (linear, not logarithms). Zero is allowed.
    pub scales: Vec<Vec3>,
    /// Rotation from the Gaussian's own axes to the world, unit quaternions.
    pub rotations: Vec<Quat>,
    /// Opacity at the centre, 0 to 1 (not logits).
    pub opacities: Vec<f32>,
    /// Degree of the spherical harmonics, 0 to 3.
    pub sh_degree: u32,
    /// Spherical harmonics, `[Gaussian][coefficient][r, g, b]`, `(sh_degree + 1)^2` coefficients a Gaussian.
    pub sh: Vec<f32>,
}

impl Gaussians {
    /// Number of Gaussians.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Coefficients a colour channel: `(sh_degree + 1)^2`.
    pub fn sh_coefficients(&self) -> usize {
        sh_coefficients(self.sh_degree)
    }

    /// The spherical harmonics of one Gaussian, `[coefficient][r, g, b]`.
    pub fn sh_of(&self, index: usize) -> &[f32] {
        let stride = 3 * self.sh_coefficients();
        &self.sh[index * stride..][..stride]
    }

    /// Appends `other`, raising both to the higher spherical-harmonics degree (the missing coefficients are zero).
    pub fn append(&mut self, other: &Gaussians) {
        let degree = if self.is_empty() {
            other.sh_degree
        } else {
            self.sh_degree.max(other.sh_degree)
        };
        self.set_sh_degree(degree);
        self.positions.extend_from_slice(&other.positions);
        self.scales.extend_from_slice(&other.scales);
        self.rotations.extend_from_slice(&other.rotations);
        self.opacities.extend_from_slice(&other.opacities);
        if other.sh_degree == degree {
            self.sh.extend_from_slice(&other.sh);
        } else {
            let mut raised = other.clone();
            raised.set_sh_degree(degree);
            self.sh.extend_from_slice(&raised.sh);
        }
    }

    /// Changes the degree: higher coefficients are dropped, missing ones are zero.
    pub fn set_sh_degree(&mut self, degree: u32) {
        let (old, new) = (3 * self.sh_coefficients(), 3 * sh_coefficients(degree));
        if old != new {
            let mut sh = vec![0.0; self.len() * new];
            let kept = old.min(new);
            for (to, from) in sh.chunks_exact_mut(new).zip(self.sh.chunks_exact(old)) {
                to[..kept].copy_from_slice(&from[..kept]);
            }
            self.sh = sh;
        }
        self.sh_degree = degree;
    }
}

/// Coefficients a colour channel for spherical harmonics up to `degree`.
pub const fn sh_coefficients(degree: u32) -> usize {
    ((degree + 1) * (degree + 1)) as usize
}
