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
mod tests {
    use super::*;
    use crate::generate::Random;

    fn evaluate(colours: &Colours, d: DVec3) -> DVec3 {
        colours
            .0
            .iter()
            .zip(basis(d))
            .map(|(c, b)| *c * b)
            .sum::<DVec3>()
            + 0.5
    }

    #[test]
    fn plain_colours_come_back() {
        let colour = DVec3::new(0.1, 0.5, 0.9);
        let seen = evaluate(&Colours::plain(colour), DVec3::new(0.6, 0.0, -0.8));
        assert!(seen.abs_diff_eq(colour, 1e-12));
    }

    #[test]
    fn lobes_are_sums_of_legendre_polynomials() {
        let mut random = Random::new(1);
        for _ in 0..50 {
            let (axis, d) = (random.direction(), random.direction());
            let bands = [0.3, -0.2, 0.7];
            let mut colours = Colours::plain(DVec3::splat(0.5));
            colours.add_zonal(axis, bands, DVec3::new(1.0, 2.0, 0.0));
            let t = axis.dot(d);
            let legendre = [t, 1.5 * t * t - 0.5, 2.5 * t * t * t - 1.5 * t];
            let expected: f64 = bands.iter().zip(legendre).map(|(b, p)| b * p).sum();
            let seen = evaluate(&colours, d) - 0.5;
            assert!(
                seen.abs_diff_eq(DVec3::new(expected, 2.0 * expected, 0.0), 1e-12),
                "{seen} {expected}"
            );
        }
    }
}
