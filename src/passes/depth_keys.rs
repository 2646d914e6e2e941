//! What the sort compares: the bits of a view depth, counted from the nearest one that the scene's bounds allow.

use glam::Vec3;

use crate::camera::Camera;
use crate::error::{Error, Result};
use crate::limits;

/// How depths become keys: `min(bits(z) - near, span) >> shift`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct DepthKeys {
    pub(super) near: u32,
    pub(super) span: u32,
    pub(super) shift: u32,
}

impl DepthKeys {
    /// Keys of at most `bits` bits for centres within a box.
    pub(super) fn new(bounds: [Vec3; 2], camera: &Camera, bits: u32) -> Result<Self> {
        if !(limits::SORT_BITS..=u32::BITS).contains(&bits) {
            return Err(Error::Invalid(format!(
                "sort keys of {bits} bits are not possible; give {} to 32",
                limits::SORT_BITS
            )));
        }
        let [near, far] = depths(bounds, camera).map(f32::to_bits);
        let span = far - near;
        Ok(Self {
            near,
            span,
            shift: width(span).saturating_sub(bits),
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

/// Least and greatest depth of what is not culled, a little wider than the box for single precision's sake.
fn depths(bounds: [Vec3; 2], camera: &Camera) -> [f32; 2] {
    let nearest = limits::NEAR_Z;
    if !bounds[0].cmple(bounds[1]).all() {
        return [nearest, f32::MAX]; // no centres: any range will do
    }
    let [low, high] = bounds.map(|corner| corner.as_dvec3() - camera.eye);
    let forward = camera.rotation.row(2);
    let (a, b) = (forward * low, forward * high);
    let slack = 1e-5 * low.abs().max(high.abs()).element_sum();
    let near = (a.min(b).element_sum() - slack).max(f64::from(nearest));
    let far = (a.max(b).element_sum() + slack).max(near);
    // A 32-bit float beyond the range is infinite; the clamp to the largest keeps the difference of the bits right.
    [near as f32, far as f32].map(|depth| depth.min(f32::MAX))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn camera() -> Camera {
        Camera::look_at(
            DVec3::new(0.0, 0.0, -4.0),
            DVec3::ZERO,
            DVec3::NEG_Y,
            50.0,
            (64, 64),
        )
        .unwrap()
    }

    fn key(keys: DepthKeys, depth: f32) -> u32 {
        let bits = depth.to_bits().max(keys.near) - keys.near;
        bits.min(keys.span) >> keys.shift
    }

    #[test]
    fn a_scene_seen_from_outside_needs_three_passes_and_loses_nothing() {
        let keys = DepthKeys::new([Vec3::NEG_ONE, Vec3::ONE], &camera(), 32).unwrap();
        assert_eq!((keys.shift, keys.passes()), (0, 3));
        let two = DepthKeys::new([Vec3::NEG_ONE, Vec3::ONE], &camera(), 16).unwrap();
        assert_eq!(two.passes(), 2);
        // Three to five units deep: 2^24 values or fewer in 16 bits, one part in 2^15 told apart.
        assert!(key(two, 4.0) < key(two, 4.0 * (1.0 + 1.0 / 16384.0)));
    }

    #[test]
    fn keys_never_turn_an_order_round_and_fit_their_bits() {
        for size in [1e-3_f32, 1.0, 3.9, 4.1, 1e3, 1e30, f32::MAX] {
            for bits in [8, 16, 24, 32] {
                let bounds = [Vec3::splat(-size), Vec3::splat(size)];
                let keys = DepthKeys::new(bounds, &camera(), bits).unwrap();
                let mut last = 0;
                for step in 0..4000 {
                    let key = key(keys, 0.2 * 1.05_f32.powi(step).min(f32::MAX));
                    assert!(key >= last && u64::from(key) < 1 << bits);
                    assert!(width(key) <= limits::SORT_BITS * keys.passes());
                    last = key;
                }
            }
        }
    }

    #[test]
    fn no_centres_and_impossible_widths() {
        let empty = [Vec3::INFINITY, Vec3::NEG_INFINITY];
        assert!(DepthKeys::new(empty, &camera(), 32).unwrap().passes() <= 4);
        for bits in [0, 7, 33] {
            assert!(DepthKeys::new(empty, &camera(), bits).is_err());
        }
    }
}
