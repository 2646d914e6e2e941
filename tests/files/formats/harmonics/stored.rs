//! The coefficients of a file and what they show, by the definition of spherical harmonics.

use std::f64::consts::{PI, SQRT_2};

use rara::Gaussians;
use rara::glam::{DMat3, DVec3};

/// The real spherical harmonic of a degree and an order in a direction of length one. It is orthonormal over the sphere, and
/// odd orders are negative, as in 3DGS.
fn harmonic(degree: u32, order: i32, direction: DVec3) -> f64 {
    let m = order.unsigned_abs();
    let (cosine, azimuth) = (direction.z, direction.y.atan2(direction.x));
    let sine = (1.0 - cosine * cosine).sqrt();
    // The associated Legendre polynomial by its recurrence, from the one of degree m.
    let mut before = 0.0;
    let mut legendre: f64 = (1..=m).map(|k| f64::from(2 * k - 1) * sine).product();
    for l in m + 1..=degree {
        let next = f64::from(2 * l - 1) * cosine * legendre - f64::from(l + m - 1) * before;
        (before, legendre) = (legendre, next / f64::from(l - m));
    }
    let factorials: f64 = (degree - m + 1..=degree + m).map(f64::from).product();
    let length = (f64::from(2 * degree + 1) / (4.0 * PI * factorials)).sqrt();
    let around = match order {
        0 => 1.0,
        1.. => SQRT_2 * (f64::from(m) * azimuth).cos(),
        _ => SQRT_2 * (f64::from(m) * azimuth).sin(),
    };
    let sign = if m % 2 == 1 { -1.0 } else { 1.0 };
    sign * length * legendre * around
}

/// Degree and order of the coefficients above degree 0, in their order.
pub(super) fn coefficients(degree: u32) -> Vec<(u32, i32)> {
    let band = |l: u32| (-(l as i32)..=l as i32).map(move |m| (l, m));
    (1..=degree).flat_map(band).collect()
}

/// What a file of one Gaussian for each coefficient and channel has: Gaussian `3 k + c` has `high` in channel `c` of
/// coefficient `k`, and `low` in all others.
pub(super) struct Stored<T> {
    pub(super) degree: u32,
    pub(super) low: T,
    pub(super) high: T,
}

impl<T: Copy> Stored<T> {
    pub(super) fn coefficients(&self) -> usize {
        coefficients(self.degree).len()
    }

    pub(super) fn count(&self) -> usize {
        3 * self.coefficients()
    }

    pub(super) fn at(&self, gaussian: usize, coefficient: usize, channel: usize) -> T {
        match gaussian == 3 * coefficient + channel {
            true => self.high,
            false => self.low,
        }
    }

    /// All numbers of a Gaussian, the three channels of a coefficient side by side.
    pub(super) fn by_coefficient(&self, gaussian: usize) -> impl Iterator<Item = T> + '_ {
        (0..self.count()).map(move |number| self.at(gaussian, number / 3, number % 3))
    }

    /// The same, the coefficients of a channel side by side.
    pub(super) fn by_channel(&self, gaussian: usize) -> impl Iterator<Item = T> + '_ {
        let each = self.coefficients();
        (0..self.count()).map(move |number| self.at(gaussian, number % each, number / each))
    }
}

/// Directions all around, none of them in a plane of the axes.
fn directions() -> impl Iterator<Item = DVec3> {
    (0..20).map(|number| {
        let z = 0.93 - 0.096 * f64::from(number);
        let angle = 0.4 + 2.399_963 * f64::from(number);
        DVec3::new(angle.cos(), angle.sin(), 0.0) * (1.0 - z * z).sqrt() + DVec3::Z * z
    })
}

/// Asserts that each Gaussian shows in a direction, taken from the file's axes to ours, what the file's numbers show in the
/// direction itself, but for what is beyond degree 3, which is not read.
pub(super) fn assert_shown(name: &str, found: &Gaussians, stored: &Stored<f64>, to_ours: DMat3) {
    let degree = stored.degree.min(3);
    assert_eq!(found.sh_degree(), degree, "{name}");
    assert_eq!(found.len(), stored.count(), "{name}");
    let all = coefficients(stored.degree);
    let read = coefficients(degree).len();
    for gaussian in 0..found.len() {
        let mut own = found.sh_of(gaussian).to_vec();
        own[..3].fill(0.0); // of degree 0, which no axes change
        for direction in directions() {
            let d = to_ours * direction;
            let d = rara_reference::vec3(d.x, d.y, d.z);
            let shown: [f64; 3] = rara_reference::harmonics::colour(&own, degree, d);
            for (channel, shown) in shown.into_iter().enumerate() {
                let terms = all[..read]
                    .iter()
                    .enumerate()
                    .map(|(coefficient, &(l, m))| {
                        stored.at(gaussian, coefficient, channel) * harmonic(l, m, direction)
                    });
                let expected = 0.5 + terms.sum::<f64>();
                assert!(
                    (shown - expected).abs() < 1e-6,
                    "{name}, degree and order {:?}, channel {channel}: {shown}, not {expected}",
                    all[gaussian / 3]
                );
            }
        }
    }
}

/// Plain numbers, for the formats that hold them.
pub(super) fn plain(degree: u32) -> Stored<f64> {
    Stored {
        degree,
        low: 0.0,
        high: 0.25,
    }
}
