//! Colours that depend on the direction of view, as spherical-harmonics coefficients in 3DGS's order and signs.

use std::f64::consts::PI;

use glam::DVec3;

use crate::harmonics::{COEFFICIENTS, basis};

/// A splat's colour by the direction of view.
pub(super) struct Colours(pub(super) [DVec3; COEFFICIENTS]);

impl Colours {
    /// The same `colour` (0 to 1) from everywhere.
    pub(super) fn plain(colour: DVec3) -> Self {
        let mut coefficients = [DVec3::ZERO; COEFFICIENTS];
        coefficients[0] = (colour - 0.5) / basis(DVec3::Z)[0];
        Self(coefficients)
    }

    /// Adds `colour` times a function of the angle between the direction of view (eye to splat) and `axis`: the sum
    /// of `bands[l - 1]` times the Legendre polynomial of degree l of its cosine, by the addition theorem.
    pub(super) fn add_zonal(&mut self, axis: DVec3, bands: [f64; 3], colour: DVec3) {
        let basis = basis(axis);
        for (degree, band) in (1..).zip(bands) {
            let factor = 4.0 * PI / (2 * degree + 1) as f64 * band;
            let of_degree = degree * degree..(degree + 1) * (degree + 1);
            for (coefficient, basis) in self.0[of_degree.clone()].iter_mut().zip(&basis[of_degree])
            {
                *coefficient += factor * basis * colour;
            }
        }
    }
}

#[cfg(test)]
mod tests;
