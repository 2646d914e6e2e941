//! The sort compares keys: the bits of a view depth, or of a distance's square, counted from the least that the scene's bounds
//! allow.

use glam::{DVec3, Vec3};

use rara_base::error::{Error, Result};
use rara_base::limits;
use rara_scene::SortBy;
use rara_scene::camera::Camera;

/// How depths become keys: `min(bits(z) - near, span) >> shift`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct DepthKeys {
    pub(super) near: u32,
    pub(super) span: u32,
    pub(super) shift: u32,
    /// No centre is deeper than this, the scene's units.
    pub(super) deepest: f64,
}

impl DepthKeys {
    /// Keys of at most `bits` bits for centres within boxes. Each box comes with the camera in its space, its corners,
    /// and the scene's units in one of its own.
    pub(super) fn new(
        boxes: impl Iterator<Item = (Camera, [Vec3; 2], f64)>,
        bits: u32,
        order: SortBy,
    ) -> Result<Self> {
        if !(limits::SORT_BITS..=u32::BITS).contains(&bits) {
            return Err(Error::Invalid(format!(
                "sort keys of {bits} bits are not possible; give {} to 32",
                limits::SORT_BITS
            )));
        }
        let all = boxes.filter_map(|(camera, bounds, unit)| {
            let depths = depths(bounds, &camera, unit)?;
            Some(match order {
                SortBy::Depth => (depths, depths),
                SortBy::Distance => (depths, squares(bounds, &camera, unit, depths[0])),
            })
        });
        let widest = |[near, far]: [f32; 2], [nearer, farther]: [f32; 2]| {
            [near.min(nearer), far.max(farther)]
        };
        let all = all.reduce(|a, b| (widest(a.0, b.0), widest(a.1, b.1)));
        // Without centres any range will do.
        let any = [limits::NEAR_Z, f32::MAX];
        let (depths, keys) = all.unwrap_or((any, any));
        let [near, far] = keys.map(f32::to_bits);
        let span = far - near;
        Ok(Self {
            near,
            span,
            shift: width(span).saturating_sub(bits),
            deepest: depths[1].into(),
        })
    }

    /// Passes of the sort that see every bit of a key.
    pub(super) fn passes(self) -> u32 {
        width(self.span >> self.shift)
            .div_ceil(limits::SORT_BITS)
            .max(1)
    }
}

fn width(value: u32) -> u32 {
    u32::BITS - value.leading_zeros()
}

/// The least and the greatest depth that is not culled, the scene's units, a little wider than the box to allow for single
/// precision. `None` without centres.
fn depths(bounds: [Vec3; 2], camera: &Camera, unit: f64) -> Option<[f32; 2]> {
    if !bounds[0].cmple(bounds[1]).all() {
        return None;
    }
    let [low, high] = bounds.map(|corner| corner.as_dvec3() - camera.eye);
    let forward = unit * camera.rotation.row(2);
    let (a, b) = (forward * low, forward * high);
    let slack = unit * 1e-5 * low.abs().max(high.abs()).element_sum();
    let near = (a.min(b).element_sum() - slack).max(camera.nearest(unit));
    let far = (a.max(b).element_sum() + slack).max(near);
    // A depth beyond a 32-bit float's range becomes infinite; the clamp keeps the difference of the bits right.
    Some([near as f32, far as f32].map(|depth| depth.min(f32::MAX)))
}

/// The least and the greatest square of a centre's distance from the eye, likewise. None is less than that of the least depth.
fn squares(bounds: [Vec3; 2], camera: &Camera, unit: f64, nearest: f32) -> [f32; 2] {
    let [low, high] = bounds.map(|corner| corner.as_dvec3() - camera.eye);
    let most = low.abs().max(high.abs());
    let slack = 1e-5 * most.element_sum();
    let least = low.max(-high).max(DVec3::ZERO).length() - slack;
    let near = (unit * least).max(nearest.into());
    let far = (unit * (most.length() + slack)).max(near);
    [near, far].map(|distance| ((distance * distance) as f32).min(f32::MAX))
}

#[cfg(test)]
mod tests;
