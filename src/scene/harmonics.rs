//! Spherical harmonics, in 3DGS's order and signs.

use std::f64::consts::PI;

use glam::DVec3;

/// Coefficients up to degree 3.
pub(super) const COEFFICIENTS: usize = 16;

/// The real orthonormal spherical harmonics up to degree 3 in a direction of length one.
pub(super) fn basis(d: DVec3) -> [f64; COEFFICIENTS] {
    let DVec3 { x, y, z } = d;
    let (xx, yy, zz) = (x * x, y * y, z * z);
    let c0 = (1.0 / (4.0 * PI)).sqrt();
    let c1 = (3.0 / (4.0 * PI)).sqrt();
    let c2 = (15.0 / (4.0 * PI)).sqrt();
    let c20 = (5.0 / (16.0 * PI)).sqrt();
    let c33 = (35.0 / (32.0 * PI)).sqrt();
    let c32 = (105.0 / (4.0 * PI)).sqrt();
    let c31 = (21.0 / (32.0 * PI)).sqrt();
    let c30 = (7.0 / (16.0 * PI)).sqrt();
    [
        c0,
        -c1 * y,
        c1 * z,
        -c1 * x,
        c2 * x * y,
        -c2 * y * z,
        c20 * (2.0 * zz - xx - yy),
        -c2 * x * z,
        c2 / 2.0 * (xx - yy),
        -c33 * y * (3.0 * xx - yy),
        c32 * x * y * z,
        -c31 * y * (4.0 * zz - xx - yy),
        c30 * z * (2.0 * zz - 3.0 * xx - 3.0 * yy),
        -c31 * x * (4.0 * zz - xx - yy),
        c32 / 2.0 * z * (xx - yy),
        -c33 * x * (xx - 3.0 * yy),
    ]
}
