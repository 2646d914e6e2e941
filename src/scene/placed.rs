//! Gaussians that are moved, turned and scaled for good.

use glam::{DMat3, DVec3};

use super::{Gaussians, sh_coefficients};
use crate::harmonics::basis;
use crate::placement::Placement;
use rara_base::parallel::in_parallel;

/// Gaussians whose spherical harmonics a thread turns at a time.
const CHUNK: usize = 1 << 10;

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
        for position in self.positions_mut() {
            *position = placement.to_world(position.as_dvec3()).as_vec3();
        }
        for scale in self.scales_mut() {
            *scale = (scale.as_dvec3() * placement.scale()).as_vec3();
        }
        let turn = placement.rotation();
        for rotation in self.rotations_mut() {
            // Its length stays what it is, so that turning back gives the same bits.
            *rotation = (turn * rotation.as_dquat()).as_quat();
        }
        let degree = self.sh_degree();
        let bands = bands(DMat3::from_quat(turn), degree);
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
        self.drop_infinite()
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

/// How a turn changes the coefficients of each band from 1 to `degree`: the integral over the sphere of each function
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
mod tests {
    use glam::DQuat;

    use super::*;
    use crate::{Kind, generate};

    /// The colour of a Gaussian in a direction.
    fn seen(gaussians: &Gaussians, index: usize, direction: DVec3) -> DVec3 {
        let parts = basis(direction);
        let own = gaussians.sh_of(index).chunks_exact(3);
        own.zip(parts)
            .map(|(c, part)| DVec3::new(c[0].into(), c[1].into(), c[2].into()) * part)
            .sum()
    }

    #[test]
    fn what_is_placed_looks_the_same_from_where_it_is() {
        let mut whole = generate(Kind::General, 40, 3);
        whole.set_sh_degree(3);
        let mut number = 0_u32;
        whole.sh_mut().fill_with(|| {
            number = number.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            number as f32 / u32::MAX as f32 - 0.5
        });
        let turn = DQuat::from_xyzw(0.3, -0.5, 0.2, 0.9).normalize();
        let placement = Placement::new(DVec3::new(4.0, -1.0, 2.5), turn, 0.35).expect("numbers");
        let mut placed = whole.clone();
        assert!(placed.place(&placement).is_empty());
        for index in 0..whole.len() {
            let to = placement.to_world(whole.positions()[index].as_dvec3());
            assert!(to.distance(placed.positions()[index].as_dvec3()) < 1e-6);
            for direction in [DVec3::X, DVec3::new(0.6, 0.0, -0.8), DVec3::ONE.normalize()] {
                let [before, after] = [
                    seen(&whole, index, direction),
                    seen(&placed, index, turn * direction),
                ];
                assert!(before.distance(after) < 1e-6, "{before} {after}");
            }
            let axis = whole.rotations()[index].as_dquat() * DVec3::X;
            let turned = placed.rotations()[index].as_dquat() * DVec3::X;
            assert!((turn * axis).distance(turned) < 1e-6);
        }
    }

    #[test]
    fn half_turns_there_and_back_change_nothing() {
        let mut whole = generate(Kind::General, 40, 3);
        whole.set_sh_degree(3);
        let half = DQuat::from_xyzw(0.0, 0.0, 1.0, 0.0);
        let mut placed = whole.clone();
        for turn in [half, half.inverse()] {
            let placement = Placement::new(DVec3::ZERO, turn, 1.0).expect("numbers");
            assert!(placed.place(&placement).is_empty());
        }
        assert_eq!(placed, whole);
    }

    #[test]
    fn what_cannot_be_held_where_it_is_placed_is_dropped() {
        let mut whole = generate(Kind::General, 5, 3);
        whole.positions_mut().fill(DVec3::X.as_vec3());
        whole.positions_mut()[1] *= 10.0;
        whole.positions_mut()[2] = DVec3::ZERO.as_vec3();
        whole.scales_mut()[2].x = 10.0;
        let kept = [0, 3, 4].map(|at| whole.sh_of(at).to_vec()).concat();
        let placement = Placement::new(DVec3::ZERO, DQuat::IDENTITY, 1e38).expect("numbers");
        assert_eq!(whole.place(&placement), [1, 2]);
        assert_eq!((whole.len(), whole.sh()), (3, &kept[..]));
        assert!(whole.positions().iter().all(|at| at.is_finite()));
    }
}
