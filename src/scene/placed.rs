//! Gaussians that are moved, turned and scaled for good.

use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::{Gaussians, sh_coefficients};
use crate::harmonics::basis;
use crate::placement::Placement;
use rara_base::parallel::in_parallel;

/// Gaussians that a thread turns at a time.
const CHUNK: usize = 1 << 10;

/// Units from zero from which on Gaussians have an origin.
pub(super) const FAR: f64 = 1e4;

/// The origin for Gaussians about a point: nothing where single precision holds them, to a thousandth of a unit and better, and
/// whole units beyond that.
pub(super) fn far_origin(point: DVec3) -> DVec3 {
    // Beyond this even double precision has no whole units.
    const FARTHEST: f64 = 1e15;
    match (FAR..FARTHEST).contains(&point.abs().max_element()) {
        true => point.round(),
        false => DVec3::ZERO,
    }
}

impl Gaussians {
    /// Scales, turns and moves the Gaussians themselves, their spherical harmonics too, in double precision. A layer's
    /// [placement](super::LayerState::placement) changes no number; this is for scenes that are written to files.
    ///
    /// Gaussians that single precision cannot hold where they are placed are dropped. Returns their numbers before that,
    /// which ascend.
    #[must_use = "what was dropped is to be told"]
    pub fn place(&mut self, placement: &Placement) -> Vec<u32> {
        if *placement == Placement::IDENTITY {
            return Vec::new(); // to the bit
        }
        self.move_by(|position| placement.to_world(position));
        for scale in self.scales_mut() {
            *scale = (scale.as_dvec3() * placement.scale()).as_vec3();
        }
        let turn = placement.rotation();
        for rotation in self.rotations_mut() {
            // Its length stays what it is, so that turning back gives the same bits.
            *rotation = (turn * rotation.as_dquat()).as_quat();
        }
        self.turn_harmonics(DMat3::from_quat(turn));
        self.drop_infinite()
    }

    /// Applies a transform to the Gaussians themselves, in double precision. It may mirror, shear and scale non-uniformly: a
    /// covariance `C` becomes `M C Mᵀ`. The spherical harmonics are turned by the rotation that is nearest to `M`, and
    /// mirrored if `M` mirrors.
    ///
    /// Gaussians whose new place or size is too large for single precision are dropped. Returns their former numbers in
    /// ascending order.
    #[must_use = "what was dropped is to be told"]
    pub fn transform(&mut self, transform: &DAffine3) -> Vec<u32> {
        self.move_by(|position| transform.transform_point3(position));
        let matrix = transform.matrix3;
        let arrays = self.arrays_mut();
        let shapes = arrays.scales.chunks_mut(CHUNK);
        in_parallel(
            shapes.zip(arrays.rotations.chunks_mut(CHUNK)),
            |(scales, rotations)| {
                for (scale, rotation) in scales.iter_mut().zip(rotations) {
                    let turn = DMat3::from_quat(rotation.as_dquat());
                    let axes = matrix * turn * DMat3::from_diagonal(scale.as_dvec3());
                    let Axes { lengths, turn, .. } = Axes::of(axes);
                    *scale = lengths.as_vec3();
                    // An ellipsoid is its own mirror image.
                    let turn = turn * turn.determinant().signum();
                    *rotation = DQuat::from_mat3(&turn).normalize().as_quat();
                }
            },
        );
        let Axes { turn, from, .. } = Axes::of(matrix);
        self.turn_harmonics(turn * from.transpose());
        self.drop_infinite()
    }

    /// Moves the centres, and their origin with them where that is far away.
    fn move_by(&mut self, to: impl Fn(DVec3) -> DVec3) {
        let (from, origin) = (self.origin(), far_origin(to(self.origin())));
        self.arrays_mut().origin = origin;
        for position in self.positions_mut() {
            *position = (to(from + position.as_dvec3()) - origin).as_vec3();
        }
    }

    /// Turns the spherical harmonics by an orthogonal matrix, which may mirror.
    fn turn_harmonics(&mut self, turn: DMat3) {
        let bands = bands(turn, self.sh_degree());
        let coefficients = self.sh_coefficients();
        in_parallel(
            self.sh_mut().chunks_mut(CHUNK * 3 * coefficients),
            |chunk| {
                for own in chunk.chunks_exact_mut(3 * coefficients) {
                    for (band, matrix) in (1..).zip(&bands) {
                        turn_band(own, sh_coefficients(band - 1), matrix);
                    }
                }
            },
        );
    }

    fn drop_infinite(&mut self) -> Vec<u32> {
        let is_finite = |&index: &u32| {
            let at = index as usize;
            self.positions()[at].is_finite()
                && self.scales()[at].is_finite()
                && self.sh_of(at).iter().all(|value| value.is_finite())
        };
        let (kept, dropped): (Vec<u32>, _) = (0..self.len() as u32).partition(is_finite);
        if !dropped.is_empty() {
            self.keep(&kept);
        }
        dropped
    }
}

/// The singular value decomposition of a matrix: `turn · diagonal(lengths) · fromᵀ`, with orthogonal matrices, of which
/// `from` does not mirror.
struct Axes {
    turn: DMat3,
    lengths: DVec3,
    from: DMat3,
}

impl Axes {
    /// By Jacobi's rotations of the columns, which keep the digits of short axes beside long ones. Columns that are
    /// orthogonal stay as they are.
    fn of(matrix: DMat3) -> Self {
        // With the largest number 1, no square is out of range.
        let size = matrix
            .to_cols_array()
            .into_iter()
            .fold(0.0, |a: f64, b| a.max(b.abs()));
        let scale = if size > 0.0 && size.is_finite() {
            size
        } else {
            1.0
        };
        let mut columns = [0, 1, 2].map(|at| matrix.col(at) / scale);
        let mut from = [DVec3::X, DVec3::Y, DVec3::Z];
        for _ in 0..30 {
            let mut is_done = true;
            for (i, j) in [(0, 1), (0, 2), (1, 2)] {
                let [a, b] = [columns[i], columns[j]];
                let (dot, squares) = (a.dot(b), [a.length_squared(), b.length_squared()]);
                if dot.abs() <= 1e-15 * (squares[0] * squares[1]).sqrt() {
                    continue;
                }
                is_done = false;
                let ratio = (squares[1] - squares[0]) / (2.0 * dot);
                let tangent = 1.0_f64.copysign(ratio) / (ratio.abs() + ratio.hypot(1.0));
                let cosine = tangent.hypot(1.0).recip();
                let sine = cosine * tangent;
                for all in [&mut columns, &mut from] {
                    let [a, b] = [all[i], all[j]];
                    (all[i], all[j]) = (cosine * a - sine * b, sine * a + cosine * b);
                }
            }
            if is_done {
                break;
            }
        }
        let lengths = DVec3::from(columns.map(DVec3::length));
        let least = 1e-14 * lengths.max_element();
        // The direction of what is shorter is rounding, and may be anything at right angles to the others.
        let mut turn = columns.map(|axis| (axis.length() > least).then(|| axis.normalize()));
        for at in 0..3 {
            let others = [turn[(at + 1) % 3], turn[(at + 2) % 3]];
            if turn[at].is_none() {
                turn[at] = Some(match others {
                    [Some(a), Some(b)] => a.cross(b),
                    [Some(a), None] | [None, Some(a)] => a.any_orthonormal_vector(),
                    [None, None] => from[at],
                });
            }
        }
        Self {
            turn: DMat3::from_cols_array_2d(&turn.map(|axis| axis.unwrap_or_default().to_array())),
            lengths: lengths * scale,
            from: DMat3::from_cols(from[0], from[1], from[2]),
        }
    }
}

/// The matrix of one band, `[to][from]`.
type Band = Vec<Vec<f64>>;

/// Multiplies the coefficients of a band, which begin at `first`, by its matrix.
fn turn_band(own: &mut [f32], first: usize, matrix: &Band) {
    let mut turned = [0.0; 21];
    for (to, row) in turned.chunks_exact_mut(3).zip(matrix) {
        for (from, factor) in row.iter().enumerate() {
            for (channel, to) in to.iter_mut().enumerate() {
                *to += factor * f64::from(own[3 * (first + from) + channel]);
            }
        }
    }
    for (to, value) in own[3 * first..].iter_mut().zip(&turned[..3 * matrix.len()]) {
        *to = *value as f32;
    }
}

/// How a turn, which may mirror, changes the coefficients of each band from 1 to `degree`: the integral over the sphere of each function
/// times each turned one. Their products are polynomials of degree 6 at most, for which the sum over four circles of
/// eight points (Gauss and Legendre) is the integral.
fn bands(turn: DMat3, degree: u32) -> Vec<Band> {
    const CIRCLES: [(f64, f64); 4] = [
        (-0.861_136_311_594_052_6, 0.347_854_845_137_453_8),
        (-0.339_981_043_584_856_26, 0.652_145_154_862_546_2),
        (0.339_981_043_584_856_26, 0.652_145_154_862_546_2),
        (0.861_136_311_594_052_6, 0.347_854_845_137_453_8),
    ];
    let mut matrices: Vec<Band> = (1..=degree)
        .map(|band| vec![vec![0.0; 2 * band as usize + 1]; 2 * band as usize + 1])
        .collect();
    for (z, weight) in CIRCLES {
        for step in 0..8 {
            let angle = std::f64::consts::TAU * f64::from(step) / 8.0;
            let radius = (1.0 - z * z).sqrt();
            let to = DVec3::new(radius * angle.cos(), radius * angle.sin(), z);
            let (here, there) = (basis(to), basis(turn.transpose() * to));
            for (band, matrix) in (1..).zip(&mut matrices) {
                let first = sh_coefficients(band - 1);
                for (i, row) in matrix.iter_mut().enumerate() {
                    for (j, sum) in row.iter_mut().enumerate() {
                        let area = weight * std::f64::consts::TAU / 8.0;
                        *sum += area * here[first + i] * there[first + j];
                    }
                }
            }
        }
    }
    // Quarter turns are exact: what rounding has left of zero and one goes.
    for factor in matrices.iter_mut().flatten().flatten() {
        if (*factor - factor.round()).abs() < 1e-14 {
            *factor = factor.round();
        }
    }
    matrices
}

#[cfg(test)]
mod tests;
