//! The Gaussian that stands for a part of another one.

use glam::{DMat3, DQuat, DVec3, Quat, Vec3};

use rara_base::limits::ALPHA_MIN_INVERSE;
use rara_scene::Gaussians;

/// The least variance that a part may have, of the whole one's: thinner ones come from rounding.
const THINNEST: f64 = 1e-8;

/// A part of a standard normal distribution.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Part {
    /// Its share of the whole, 0 to 1.
    pub(super) mass: f64,
    pub(super) mean: DVec3,
    pub(super) covariance: DMat3,
}

/// A Gaussian in the units of the scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Child {
    pub(super) position: Vec3,
    pub(super) scale: Vec3,
    pub(super) rotation: Quat,
    pub(super) opacity: f32,
}

impl Child {
    /// The Gaussian itself.
    pub(super) fn whole(gaussians: &Gaussians, index: usize) -> Self {
        Self {
            position: gaussians.positions()[index],
            scale: gaussians.scales()[index],
            rotation: gaussians.rotations()[index],
            opacity: gaussians.opacities()[index],
        }
    }
}

/// The Gaussians that stand for parts of a Gaussian. Those are left out that are too faint to show in a layer which fades
/// them: 3DGS skips what is below an alpha of 1/255. `None` if one cannot be written in single precision.
pub(super) fn children(
    gaussians: &Gaussians,
    index: usize,
    parts: &[Part],
    fade: f32,
) -> Option<Vec<Child>> {
    let mut children = Vec::with_capacity(parts.len());
    for part in parts {
        let opacity = gaussians.opacities()[index] * opacity_factor(part) as f32;
        if opacity * fade * ALPHA_MIN_INVERSE >= 1.0 {
            children.push(child(gaussians, index, part, opacity)?);
        }
    }
    Some(children)
}

/// The factor of the opacity. Seen across a cut the amplitude is the mass over the deviation that is left along its normal,
/// seen along the normal it is the mass; this lies between the two. A part is nowhere denser than the whole.
fn opacity_factor(part: &Part) -> f64 {
    let volume = part.covariance.determinant().max(THINNEST * THINNEST);
    (part.mass / volume.powf(0.25)).min(1.0)
}

fn child(gaussians: &Gaussians, index: usize, part: &Part, opacity: f32) -> Option<Child> {
    let scale = gaussians.scales()[index].as_dvec3();
    let turn = gaussians.rotations()[index].as_dquat().normalize();
    let position = gaussians.positions()[index].as_dvec3() + turn * (scale * part.mean);
    // In the whole one's own axes the covariance is S L (S L)^T. The rows of S L are the columns of a matrix whose
    // singular values are the deviations, which needles keep to the last digit, as they would not in the covariance.
    let root = cholesky(part.covariance);
    let rows = root.transpose() * DMat3::from_diagonal(scale);
    let (deviations, axes) = singular(rows);
    let child = Child {
        position: position.as_vec3(),
        scale: deviations.as_vec3(),
        rotation: (turn * axes).normalize().as_quat(),
        opacity,
    };
    let usable = child.position.is_finite()
        && child.scale.is_finite()
        && child.rotation.is_finite()
        && child.opacity.is_finite();
    usable.then_some(child)
}

/// The lower triangle L with `L L^T` the covariance; rounding may have left that without a last positive digit.
fn cholesky(c: DMat3) -> DMat3 {
    let at = |row: usize, column: usize| c.col(column)[row];
    let pivot = |square: f64| square.max(THINNEST).sqrt();
    let a = pivot(at(0, 0));
    let (b, c) = (at(1, 0) / a, at(2, 0) / a);
    let d = pivot(at(1, 1) - b * b);
    let e = (at(2, 1) - b * c) / d;
    let f = pivot(at(2, 2) - c * c - e * e);
    DMat3::from_cols(
        DVec3::new(a, b, c),
        DVec3::new(0.0, d, e),
        DVec3::new(0.0, 0.0, f),
    )
}

/// The singular values of a matrix, and its right singular vectors as a rotation, by one-sided Jacobi rotations: the
/// columns are turned against each other until they are orthogonal (Hestenes, 1958). Columns of very different lengths
/// keep their digits (Demmel and Veselic, 1992).
fn singular(mut m: DMat3) -> (DVec3, DQuat) {
    const SWEEPS: usize = 30;
    let mut turn = DMat3::IDENTITY;
    for _ in 0..SWEEPS {
        let mut turned = false;
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            let (x, y) = (m.col(i), m.col(j));
            let (a, b, c) = (x.length_squared(), y.length_squared(), x.dot(y));
            if c.abs() <= 1e-15 * (a * b).sqrt() || c == 0.0 {
                continue;
            }
            turned = true;
            let half = (b - a) / (2.0 * c);
            let tangent = 1.0_f64.copysign(half) / (half.abs() + half.hypot(1.0));
            let cosine = 1.0 / tangent.hypot(1.0);
            let sine = cosine * tangent;
            for matrix in [&mut m, &mut turn] {
                let (x, y) = (matrix.col(i), matrix.col(j));
                *matrix.col_mut(i) = x * cosine - y * sine;
                *matrix.col_mut(j) = x * sine + y * cosine;
            }
        }
        if !turned {
            break;
        }
    }
    let lengths = DVec3::new(m.x_axis.length(), m.y_axis.length(), m.z_axis.length());
    (lengths, DQuat::from_mat3(&turn))
}
