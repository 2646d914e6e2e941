//! The bounds of a scene, by percentiles: scanner exports carry far shells, and trained scenes a few strays at
//! infinity.

use glam::DVec3;

use super::placed::FAR;
use super::{Layer, Scene};

/// Share of the centres that may lie beyond each end. A smaller one lets a scanner's far shell decide how the scene
/// is framed, a larger one cuts visible parts off.
const OUTLIERS: f64 = 0.01;

/// An axis-aligned box around nearly all of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// The corner with the smallest coordinates.
    pub min: DVec3,
    /// The corner with the largest coordinates.
    pub max: DVec3,
}

impl Bounds {
    /// Returns the robust bounds of a scene: a box without the outermost percent of the centres at each end of each axis,
    /// widened by the largest standard deviation of the median Gaussian. The box is never empty: an empty scene has the unit
    /// box about the origin.
    ///
    /// Only the visible layers of a scene count, in their placements.
    pub fn of<'a>(scene: impl Into<Scene<'a>>) -> Self {
        let scene = scene.into();
        let axis = |axis: DVec3| extent_along(scene.clone(), axis);
        let (x, y, z) = (axis(DVec3::X), axis(DVec3::Y), axis(DVec3::Z));
        Self {
            min: DVec3::new(x.0, y.0, z.0),
            max: DVec3::new(x.1, y.1, z.1),
        }
    }

    /// Returns the middle of the box.
    pub fn centre(&self) -> DVec3 {
        (self.min + self.max) / 2.0
    }

    /// Returns half the diagonal of the box.
    pub fn radius(&self) -> f64 {
        (self.max - self.min).length() / 2.0
    }

    /// Returns the eight corners of the box.
    pub fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|i| {
            let pick = |bit: usize, min: f64, max: f64| if i & bit == 0 { min } else { max };
            DVec3::new(
                pick(1, self.min.x, self.max.x),
                pick(2, self.min.y, self.max.y),
                pick(4, self.min.z, self.max.z),
            )
        })
    }
}

/// Returns the smallest and largest `normal . x` of the scene: where a plane that sweeps along `normal` enters and leaves it.
/// The outermost percent of the centres is left out at each end, and the largest standard deviation of the median Gaussian is
/// added. The first number is always less than the second. An empty scene counts as the unit box about the origin.
pub fn extent_along<'a>(scene: impl Into<Scene<'a>>, normal: DVec3) -> (f64, f64) {
    let scene = scene.into();
    let mut along: Vec<f64> = Vec::new();
    for layer in visible(&scene) {
        let placement = layer.placement();
        // normal . to_world(p), which is linear in p.
        let start = normal.dot(placement.position());
        let step = placement.scale() * (placement.rotation().inverse() * normal);
        let positions = layer.gaussians().positions().iter();
        along.extend(positions.map(|p| start + step.dot(p.as_dvec3())));
    }
    if along.is_empty() {
        let half = 0.5 * (normal.x.abs() + normal.y.abs() + normal.z.abs());
        return widened(-half, half, 0.0);
    }
    let last = along.len() - 1;
    let outliers = (OUTLIERS * last as f64).round() as usize;
    let (_, &mut low, above) = along.select_nth_unstable_by(outliers, f64::total_cmp);
    // The upper percentile is in what is not below the lower one: outliers < last - outliers unless both are one.
    let high = match (last - outliers).checked_sub(outliers + 1) {
        Some(nth) => *above.select_nth_unstable_by(nth, f64::total_cmp).1,
        None => low,
    };
    drop(along);
    widened(low, high, median_size(&scene) * normal.length())
}

fn visible<'s, 'a>(scene: &'s Scene<'a>) -> impl Iterator<Item = &'s Layer<'a>> {
    scene.layers().iter().filter(|layer| layer.state().visible)
}

fn median_size(scene: &Scene<'_>) -> f64 {
    let mut sizes: Vec<f32> = Vec::new();
    for layer in visible(scene) {
        let unit = layer.state().placement.scale() as f32;
        let scales = layer.gaussians().scales().iter();
        sizes.extend(scales.map(|scale| unit * scale.max_element()));
    }
    let middle = sizes.len() / 2;
    f64::from(*sizes.select_nth_unstable_by(middle, f32::total_cmp).1)
}

/// Adds `by` at both ends, and in any case so much that the interval isn't empty (a flat or a one-point scene).
fn widened(low: f64, high: f64, by: f64) -> (f64, f64) {
    // What is farther away is counted from an origin, in double precision.
    let size = low.abs().max(high.abs());
    let least = (1e-6 * (1.0 + size.min(FAR))).max(1e-12 * size);
    let by = by.max(least);
    (low - by, high + by)
}

#[cfg(test)]
mod tests;
