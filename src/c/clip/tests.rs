//! What a host says of planes, of regions and of planes that move with the camera.

use std::ptr::{null, null_mut};

use super::*;
use crate::boundary::*;
use crate::region::{rara_region_destroy, rara_region_parse};

#[test]
fn planes() {
    let plane = |x| RaraPlane {
        normal: [x, 0.0, 0.0],
        offset: 1.0,
    };
    let planes = [plane(1.0), plane(0.0)];
    let mut given = RaraClip {
        planes: planes.as_ptr(),
        plane_count: 2,
        ..RaraClip::WHOLE
    };
    // SAFETY: the planes are there, or the pointer is null.
    let read = |given: &RaraClip| unsafe { clip(given) }.map_err(|error| error.to_string());
    let error = read(&given).expect_err("a plane without a normal");
    assert!(
        error.starts_with("clip->planes[1]: the clip plane 0,0,0,1"),
        "{error}"
    );
    given.plane_count = 1;
    assert_eq!(read(&given).expect("one plane").surfaces.len(), 1);
    given.op = 2;
    assert_eq!(
        read(&given).expect_err("no op"),
        "clip->op 2 is no RaraClipOp"
    );
    given.plane_count = 33;
    assert!(read(&given).expect_err("too many").contains("at most 32"));
    (given.plane_count, given.planes) = (1, null());
    assert_eq!(read(&given).expect_err("no planes"), "clip->planes is null");
    // SAFETY: null stands for no clip.
    let none = unsafe { clip(null()) };
    assert!(none.expect("everything").surfaces.is_empty());
}

#[test]
fn planes_of_the_camera_are_depths() {
    let camera = Camera::look_at(DVec3::NEG_Z, DVec3::ZERO, DVec3::NEG_Y, 50.0, (9, 9));
    let camera = camera.expect("a view");
    let read = |clip_near, clip_far| {
        let given = RaraClip {
            clip_near,
            clip_far,
            ..RaraClip::WHOLE
        };
        // SAFETY: there are no planes.
        let kept = unsafe { kept(&given) };
        kept.map(|kept| kept.seen_by(camera).0)
            .map_err(|error| error.to_string())
    };
    let (none, all) = (f64::NEG_INFINITY, f64::INFINITY);
    assert_eq!(read(none, all), Ok(camera));
    assert_eq!(read(0.5, all), Ok(camera.clip_near(Some(0.5))));
    let both = camera.clip_near(Some(-1.0)).clip_far(Some(2.0));
    assert_eq!(read(-1.0, 2.0), Ok(both));
    for (near, far, says) in [
        (all, all, "clip->clip_near is inf"),
        (f64::NAN, all, "clip->clip_near is NaN"),
        (none, none, "clip->clip_far is -inf"),
        (0.0, f64::NAN, "clip->clip_far is NaN: give a depth, or"),
    ] {
        let error = read(near, far).expect_err(says);
        assert!(error.starts_with(says), "{error}");
    }
    let nearer = RaraClip {
        near_cut: 0.05,
        ..RaraClip::WHOLE
    };
    // SAFETY: there are no planes.
    let seen = unsafe { kept(&nearer) }.expect("a clip").seen_by(camera).0;
    assert_eq!(seen, camera.near_cut(Some(0.05)));
    let farther = RaraClip {
        clip_far: 2.0,
        ..RaraClip::WHOLE
    };
    for given in [nearer, farther] {
        // SAFETY: there are no planes.
        let error = unsafe { clip(&given) }.expect_err("it is a layer's");
        let text = error.to_string();
        assert!(
            text.contains("a layer's clip stands in the scene"),
            "{text}"
        );
    }
}

#[test]
fn a_region_takes_the_place_of_planes() {
    let mut region = null_mut();
    let plane = RaraPlane {
        normal: [1.0, 0.0, 0.0],
        offset: 1.0,
    };
    // SAFETY: strings that end in NUL, planes that are there, a pointer that may be overwritten.
    unsafe {
        let text = c"!sphere:0,0,0,1".as_ptr();
        assert_eq!(rara_region_parse(text, &mut region), RARA_OK);
        let mut given = RaraClip {
            region,
            ..RaraClip::WHOLE
        };
        let found = clip(&given).expect("a region");
        assert!(found.keeps(DVec3::X * 2.0) && !found.keeps(DVec3::ZERO));
        (given.planes, given.plane_count) = (&plane, 1);
        let error = clip(&given).expect_err("both").to_string();
        assert!(error.contains("are both given"), "{error}");
        rara_region_destroy(region);
        given.plane_count = 0;
        let error = clip(&given).expect_err("it was destroyed").to_string();
        assert!(
            error.starts_with("clip->region is no RaraRegion"),
            "{error}"
        );
    }
}
