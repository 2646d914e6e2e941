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

    fn keys_of(bounds: [Vec3; 2], bits: u32) -> Result<DepthKeys> {
        DepthKeys::new([(camera(), bounds, 1.0)].into_iter(), bits, SortBy::Depth)
    }

    fn key(keys: DepthKeys, depth: f32) -> u32 {
        let bits = depth.to_bits().max(keys.near) - keys.near;
        bits.min(keys.span) >> keys.shift
    }

    #[test]
    fn a_scene_seen_from_outside_needs_three_passes_and_loses_nothing() {
        let keys = keys_of([Vec3::NEG_ONE, Vec3::ONE], 32).unwrap();
        assert_eq!((keys.shift, keys.passes()), (0, 3));
        let two = keys_of([Vec3::NEG_ONE, Vec3::ONE], 16).unwrap();
        assert_eq!(two.passes(), 2);
        // Three to five units deep: 2^24 values or fewer in 16 bits, which distinguish one part in 2^15.
        assert!(key(two, 4.0) < key(two, 4.0 * (1.0 + 1.0 / 16384.0)));
    }

    #[test]
    fn keys_never_turn_an_order_round_and_fit_their_bits() {
        for size in [1e-3_f32, 1.0, 3.9, 4.1, 1e3, 1e30, f32::MAX] {
            for bits in [8, 16, 24, 32] {
                let bounds = [Vec3::splat(-size), Vec3::splat(size)];
                let keys = keys_of(bounds, bits).unwrap();
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
    fn keys_of_several_boxes_are_of_the_nearest_and_the_farthest() {
        let (near, far) = ([Vec3::NEG_ONE, Vec3::ONE], [Vec3::ONE, Vec3::splat(5.0)]);
        let empty = [Vec3::INFINITY, Vec3::NEG_INFINITY];
        let camera = camera();
        let boxes = [near, empty, far].map(|bounds| (camera, bounds, 1.0));
        let all = DepthKeys::new(boxes.into_iter(), 32, SortBy::Depth).unwrap();
        let ends = |keys: DepthKeys| (keys.near, keys.near + keys.span);
        let (first, last) = (keys_of(near, 32).unwrap(), keys_of(far, 32).unwrap());
        assert_eq!(ends(all), (ends(first).0, ends(last).1));
        // A box of twice the size in units of half the length is the same box.
        let doubled = far.map(|corner| 2.0 * corner);
        let eye = DVec3::new(0.0, 0.0, -8.0);
        let twice = camera.eye(eye);
        let halved = [(twice, doubled, 0.5)].into_iter();
        let halved = DepthKeys::new(halved, 32, SortBy::Depth).unwrap();
        assert_eq!(ends(halved), ends(last));
    }

    #[test]
    fn keys_of_distances_hold_those_of_all_centres() {
        let camera = camera();
        for bounds in [
            [Vec3::NEG_ONE, Vec3::ONE],
            [Vec3::new(2.0, -1.0, -3.0), Vec3::new(5.0, 4.0, 6.0)],
            [Vec3::splat(-9.0), Vec3::splat(9.0)], // the eye is inside
        ] {
            let boxes = [(camera, bounds, 1.0)].into_iter();
            let keys = DepthKeys::new(boxes, 32, SortBy::Distance).unwrap();
            let [least, most] = [keys.near, keys.near + keys.span].map(f32::from_bits);
            let share = |at: i32| at as f32 / 4.0;
            for at in 0..125 {
                let place = Vec3::new(share(at % 5), share(at / 5 % 5), share(at / 25));
                let centre = (bounds[0] + place * (bounds[1] - bounds[0])).as_dvec3() - camera.eye;
                let depth = (camera.rotation * centre).z;
                let square = centre.length_squared() as f32;
                assert!(depth < camera.nearest(1.0) || (least <= square && square <= most));
                assert!(depth <= keys.deepest);
            }
            assert!(
                most < 1.01 * (bounds[1] - bounds[0]).as_dvec3().length_squared() as f32 + 400.0
            );
        }
    }

    #[test]
    fn no_centres_and_impossible_widths() {
        let empty = [Vec3::INFINITY, Vec3::NEG_INFINITY];
        assert!(keys_of(empty, 32).unwrap().passes() <= 4);
        for bits in [0, 7, 33] {
            assert!(keys_of(empty, bits).is_err());
        }
    }
}
