//! Rotations as files have them: rounded to few digits, or scaled with the world.

use glam::{DMat3, DMat4, DVec3};

use crate::camera::oblique;

/// How oblique axes may be that are taken as they are. [`Camera`](crate::Camera) makes them square.
const AS_IT_IS: f64 = 1e-3;
/// How oblique axes are that have been rounded to two decimals.
const ROUNDED: f64 = 0.03;
/// How oblique single precision makes axes, which is not worth a word.
const UNSAID: f64 = 1e-5;

/// A matrix that turns, and what had to be made of the file's for it.
pub(super) struct Rigid {
    /// The file's where that turns and nothing else, or is no rotation at all.
    pub(super) axes: DMat3,
    /// What the file's matrix scales by.
    pub(super) scale: f64,
    /// How oblique the file's axes are.
    pub(super) oblique: f64,
    /// What was done, if that is worth a word.
    pub(super) repair: Option<String>,
}

impl Rigid {
    pub(super) fn new(matrix: DMat3) -> Self {
        let as_it_is = oblique(matrix);
        let unit = matrix.determinant().cbrt();
        let level = matrix * unit.recip();
        let of_level = oblique(level);
        // Rounding makes axes oblique as well as long or short; a scale makes them long or short alone.
        let is_scaled = as_it_is > AS_IT_IS && unit > 0.0 && (unit - 1.0).abs() > of_level;
        let (axes, scale, oblique) = match is_scaled {
            true => (level, unit, of_level),
            false => (matrix, 1.0, as_it_is),
        };
        if !(oblique <= ROUNDED && axes.determinant() > 0.0) {
            return Self {
                axes: matrix,
                scale: 1.0,
                oblique,
                repair: None,
            };
        }
        let rounded =
            format!("its axes are a rotation to within {oblique:.1e} and are made square");
        let scaled = format!("its matrix scales by {scale:.6}, which is left out");
        let repair = match (is_scaled, oblique > UNSAID) {
            (true, true) => Some(format!("{scaled}, and {rounded}")),
            (true, false) => Some(scaled),
            (false, true) => Some(rounded),
            (false, false) => None,
        };
        let axes = if oblique > AS_IT_IS {
            nearest_rotation(axes)
        } else {
            axes
        };
        Self {
            axes,
            scale,
            oblique,
            repair,
        }
    }
}

/// The matrix whose last row is 0, 0, 0, 1, of one whose row is that but for rounding and a factor of the whole.
pub(super) fn affine(matrix: DMat4) -> Option<DMat4> {
    let last = matrix.row(3);
    let is_affine = last.truncate().abs().max_element() <= 1e-6 * last.w && last.w.is_finite();
    if last.truncate() == DVec3::ZERO && last.w == 1.0 {
        return Some(matrix);
    }
    let [x, y, z, w] = matrix
        .to_cols_array_2d()
        .map(|[x, y, z, _]| DVec3::new(x, y, z) / last.w);
    let affine = DMat4::from_mat3_translation(DMat3::from_cols(x, y, z), w);
    (is_affine && last.w > 0.0).then_some(affine)
}

/// The orthogonal factor of the polar decomposition, by the iteration of Newton and Higham, which doubles its digits each time.
fn nearest_rotation(axes: DMat3) -> DMat3 {
    (0..6).fold(axes, |axes, _| (axes + axes.inverse().transpose()) * 0.5)
}
