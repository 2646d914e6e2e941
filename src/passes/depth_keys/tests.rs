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
    for by in [SortBy::Depth, SortBy::Distance] {
        let [halved, once] = [(twice, doubled, 0.5), (camera, far, 1.0)]
            .map(|one| DepthKeys::new([one].into_iter(), 32, by).unwrap());
        assert_eq!(halved, once);
    }
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
        assert!(most < 1.01 * (bounds[1] - bounds[0]).as_dvec3().length_squared() as f32 + 400.0);
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
