//! gsplat trains in a world of its own: its trainer turns, moves and scales the world of a COLMAP model by what the model's
//! cameras and points are (`normalize_world_space`, its default). What it did is written nowhere, and is computed again here.

use std::path::Path;

use glam::{DMat3, DVec3};
use rara_base::error::{Error, Result};
use rara_base::stats;

use super::dataparser::Move;
use crate::camera::Camera;
use crate::camera_files::{NamedCamera, load_colmap_points};
use crate::gaussians::Gaussians;

/// The cameras of the COLMAP model `of` where the trainer put them, whose settings are `by`, and the Gaussians are those of
/// `trained`; with a note of it.
pub(super) fn place(
    cameras: Vec<NamedCamera>,
    of: &Path,
    (by, trained): (&Path, &Path),
) -> Result<(Vec<NamedCamera>, Option<String>)> {
    let Some(points) = load_colmap_points(of)? else {
        return Ok((cameras, None));
    };
    let unknown = |what: &str| {
        let message = format!(
            "{what}; {} says that gsplat trained in a world that it made of this model (normalize_world_space), so that its \
             cameras do not match the scene: give the model that it trained with, or write false there to draw by these \
             cameras as they are",
            by.display()
        );
        Error::format(of, message)
    };
    let poses = cameras.iter().map(NamedCamera::undistorted);
    let poses = poses.collect::<Result<Vec<_>>>()?;
    let upright = similarity(&poses).map_err(unknown)?;
    let seen: Vec<DVec3> = points.iter().map(|point| upright.point(*point)).collect();
    let aligned = principal(&seen).map_err(unknown)?;
    let seen: Vec<DVec3> = seen.iter().map(|point| aligned.point(*point)).collect();
    let (turn, is_sure) = turn(&seen, &crate::load(trained, &mut |_, _| {})?.gaussians);
    let unsure = match is_sure {
        true => "",
        false => {
            "; which way round the axes of its points are is a guess, as few Gaussians are where the points are"
        }
    };
    let note = format!(
        "the cameras are placed in the world that gsplat made of {}, as {} says{unsure}",
        of.display(),
        by.display()
    );
    let placed = |camera: Camera| turn.camera(&aligned.camera(&upright.camera(&camera)));
    let cameras = cameras.into_iter().map(|named| named.placed(placed));
    Ok((cameras.collect(), Some(note)))
}

/// The way to a world in which the cameras' mean up is -y, the median of what they look at is the origin, and the median of
/// their distances from it is 1.
fn similarity(cameras: &[Camera]) -> std::result::Result<Move, &'static str> {
    let up: DVec3 = cameras.iter().map(|camera| -camera.rotation.row(1)).sum();
    let up = up
        .try_normalize()
        .ok_or("its cameras have no direction that is up in the mean")?;
    // The rotation that takes `up` the shortest way to -y, by the formula of Rodrigues.
    let (cross, cosine) = (up.cross(DVec3::NEG_Y), up.dot(DVec3::NEG_Y));
    if cosine < -1.0 + 1e-9 {
        return Err("up is y in it, where gsplat mirrors the world");
    }
    let skew = DMat3::from_cols(
        DVec3::new(0.0, cross.z, -cross.y),
        DVec3::new(-cross.z, 0.0, cross.x),
        DVec3::new(cross.y, -cross.x, 0.0),
    );
    let axes = DMat3::IDENTITY + skew + skew * skew * (1.0 + cosine).recip();
    // Where each line of sight is nearest to the origin.
    let nearest = cameras.iter().map(|camera| {
        let (eye, forward) = (axes * camera.eye, axes * camera.rotation.row(2));
        eye - forward * forward.dot(eye)
    });
    let shift = -median_point(&nearest.collect::<Vec<_>>());
    let away = cameras
        .iter()
        .map(|camera| (axes * camera.eye + shift).length());
    let scale = median(away.collect()).recip();
    match scale.is_finite() {
        true => Ok(Move { axes, shift, scale }),
        false => Err("its cameras all stand where they look"),
    }
}

/// The way to a world in which the points' median is the origin and their principal axes are x, y and z, the longest first. Which
/// way round two of these are is left open.
fn principal(points: &[DVec3]) -> std::result::Result<Move, &'static str> {
    /// Axes of a spread that differs by less are in directions of chance.
    const ALIKE: f64 = 1e-9;
    if points.len() < 3 {
        return Err("it has no points, and gsplat turns its world by their principal axes");
    }
    let centre = median_point(points);
    let mean = points.iter().sum::<DVec3>() / points.len() as f64;
    let spread = points.iter().fold(DMat3::ZERO, |sum, point| {
        let d = *point - mean;
        sum + DMat3::from_cols(d * d.x, d * d.y, d * d.z)
    });
    let (axes, [least, middle, most]) = eigen(spread);
    let is_told_apart = |a: f64, b: f64| b - a > ALIKE * most;
    if !(is_told_apart(least, middle) && is_told_apart(middle, most)) {
        return Err(
            "its points have no three principal axes that can be told apart, by which gsplat turns its world",
        );
    }
    let (x, y) = (axes.col(2), axes.col(1));
    let axes = DMat3::from_cols(x, y, x.cross(y)).transpose();
    Ok(Move {
        axes,
        shift: -(axes * centre),
        scale: 1.0,
    })
}

/// The eigenvectors of a symmetric matrix, as columns, and their values, the least first: Jacobi's rotations.
fn eigen(mut matrix: DMat3) -> (DMat3, [f64; 3]) {
    let mut vectors = DMat3::IDENTITY;
    for (i, j) in [(0, 1), (0, 2), (1, 2)].into_iter().cycle().take(3 * 16) {
        let (off, apart) = (matrix.col(j)[i], matrix.col(j)[j] - matrix.col(i)[i]);
        let angle = 0.5 * (2.0 * off / apart).atan();
        if off == 0.0 || !angle.is_finite() {
            continue;
        }
        let (sin, cos) = angle.sin_cos();
        let mut turn = DMat3::IDENTITY;
        (turn.col_mut(i)[i], turn.col_mut(j)[j]) = (cos, cos);
        (turn.col_mut(j)[i], turn.col_mut(i)[j]) = (sin, -sin);
        matrix = turn.transpose() * matrix * turn;
        vectors *= turn;
    }
    let mut order = [0, 1, 2].map(|i| (matrix.col(i)[i], vectors.col(i)));
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    let [a, b, c] = order;
    (DMat3::from_cols(a.1, b.1, c.1), [a.0, b.0, c.0])
}

/// Of the four ways round that axes can have, the one in which the Gaussians are where the points are, and whether that is told
/// well apart from the others: linear algebra leaves it open, and programs differ. Where it is not, gsplat has most points low.
fn turn(points: &[DVec3], gaussians: &Gaussians) -> (Move, bool) {
    const POINTS: usize = 500;
    const GAUSSIANS: usize = 20_000;
    /// How many times as far from each other they are in the next best way round.
    const SURELY: f64 = 1.2;
    let some = |count: usize, most: usize| (0..count).step_by(count.div_ceil(most).max(1));
    let points: Vec<DVec3> = some(points.len(), POINTS).map(|i| points[i]).collect();
    let centres = some(gaussians.len(), GAUSSIANS).map(|i| gaussians.centre(i));
    let centres: Vec<DVec3> = centres.collect();
    let few: Vec<DVec3> = some(centres.len(), POINTS).map(|i| centres[i]).collect();
    let turns = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
    let turns = turns.map(|(x, y)| DVec3::new(x, y, x * y));
    let apart = |from: &[DVec3], to: &[DVec3]| {
        let nearest = |a: &DVec3| {
            to.iter()
                .fold(f64::INFINITY, |d, b| d.min(a.distance_squared(*b)))
        };
        median(from.iter().map(nearest).collect()).sqrt()
    };
    // What the Gaussians are far from tells nothing where few are left, and what the points are far from where few were trained.
    let ways = [false, true].map(|of_gaussians| {
        let mut ways = turns.map(|turn| {
            let turned: Vec<DVec3> = points.iter().map(|point| turn * *point).collect();
            let apart = match of_gaussians {
                false => apart(&turned, &centres),
                true => apart(&few, &turned),
            };
            (apart, turn)
        });
        ways.sort_by(|a, b| a.0.total_cmp(&b.0));
        ways
    });
    let lead = |ways: &[(f64, DVec3); 4]| (ways[1].0 + f64::EPSILON) / (ways[0].0 + f64::EPSILON);
    let [of_points, of_gaussians] = &ways;
    let best = match lead(of_points) >= lead(of_gaussians) {
        true => of_points,
        false => of_gaussians,
    };
    let is_sure = lead(best) >= SURELY;
    let heights = |turn: DVec3| points.iter().map(move |point| (turn * *point).z);
    let has_most_low = |turn: DVec3| {
        median(heights(turn).collect()) <= heights(turn).sum::<f64>() / points.len() as f64
    };
    let chosen = best.iter().find(|(_, turn)| is_sure || has_most_low(*turn));
    let turned = chosen.map_or(DVec3::ONE, |(_, turn)| *turn);
    let way = Move {
        axes: DMat3::from_diagonal(turned),
        shift: DVec3::ZERO,
        scale: 1.0,
    };
    (way, is_sure)
}

/// The median of each coordinate.
fn median_point(points: &[DVec3]) -> DVec3 {
    let along = |axis: usize| median(points.iter().map(|point| point[axis]).collect());
    DVec3::new(along(0), along(1), along(2))
}

/// Not a number where there are none.
fn median(values: Vec<f64>) -> f64 {
    stats::median(&values).unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eigenvectors_rebuild_their_matrix() {
        let axes = DMat3::from_quat(glam::DQuat::from_xyzw(0.1, -0.3, 0.2, 0.9).normalize());
        for values in [[1.0, 2.0, 5.0], [0.0, 1e-3, 7.0], [1.0, 1.0, 2.0]] {
            let matrix = axes * DMat3::from_diagonal(values.into()) * axes.transpose();
            let (vectors, found) = eigen(matrix);
            let again = vectors * DMat3::from_diagonal(found.into()) * vectors.transpose();
            assert!(again.abs_diff_eq(matrix, 1e-12), "{again}");
            assert!(DVec3::from(found).abs_diff_eq(values.into(), 1e-12));
        }
    }

    #[test]
    fn medians_are_of_the_middle_two() {
        assert_eq!(median(vec![3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(vec![4.0, 1.0, 2.0, 3.0]), 2.5);
        assert!(median(Vec::new()).is_nan());
    }
}
