//! View-dependent colour: real spherical harmonics up to degree 3, with the order and signs of 3DGS.

use super::real::{Real, Vec3};
use rara_base::limits::MAX_SH_COEFFICIENTS;
use rara_scene::sh_coefficients;

/// Colour of a Gaussian seen along `direction` (from the eye to its centre or, in an orthographic view, along the view axis; of any length): the harmonics' sum plus 0.5,
/// clamped below at 0. `coefficients` is `[coefficient][r, g, b]`.
pub fn colour<T: Real>(coefficients: &[f32], degree: u32, direction: Vec3<T>) -> [T; 3] {
    let basis = basis(direction * (T::one() / direction.length()));
    let used = sh_coefficients(degree);
    [0, 1, 2].map(|channel| {
        let terms = (0..used).map(|i| basis[i] * T::of(f64::from(coefficients[3 * i + channel])));
        let sum = terms.fold(T::zero(), |sum, term| sum + term);
        (sum + T::of(0.5)).max(T::zero())
    })
}

/// The 16 basis functions at a unit direction: bands 0 to 3, orders -l to l, orthonormal over the sphere, with the
/// Condon-Shortley signs of 3DGS (odd orders negative).
pub fn basis<T: Real>(direction: Vec3<T>) -> [T; MAX_SH_COEFFICIENTS as usize] {
    let Vec3 { x, y, z } = direction;
    let (xx, yy, zz) = (x * x, y * y, z * z);
    // Each factor is sqrt((2l + 1) (l - m)! / (4 pi (l + m)!)), times sqrt(2) where m is not 0, times the leading
    // number of the Legendre polynomial.
    let root = |n: f64, d: f64| T::of((n / (d * std::f64::consts::PI)).sqrt());
    let (two, three, four) = (T::of(2.0), T::of(3.0), T::of(4.0));
    let one_axis = root(3.0, 4.0);
    let two_axes = root(15.0, 4.0);
    let cubes = root(35.0, 32.0);
    let saddle = root(21.0, 32.0);
    [
        root(1.0, 4.0),
        -one_axis * y,
        one_axis * z,
        -one_axis * x,
        two_axes * x * y,
        -two_axes * y * z,
        root(5.0, 16.0) * (two * zz - xx - yy),
        -two_axes * x * z,
        root(15.0, 16.0) * (xx - yy),
        -cubes * y * (three * xx - yy),
        root(105.0, 4.0) * x * y * z,
        -saddle * y * (four * zz - xx - yy),
        root(7.0, 16.0) * z * (two * zz - three * (xx + yy)),
        -saddle * x * (four * zz - xx - yy),
        root(105.0, 16.0) * z * (xx - yy),
        -cubes * x * (xx - three * yy),
    ]
}
