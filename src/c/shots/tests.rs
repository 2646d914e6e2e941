//! Cameras are those of the Rust crate, and what has none is refused by name.

use std::ptr::{null, null_mut};

use super::*;
use crate::boundary::*;
use crate::handles::add;
use crate::layer::rara_layer_default;
use crate::tests::assert_fails;
use rara::scene::{Kind, generate};
use rara::{Gaussians, Plane};

const UP: [f64; 3] = [0.0, -1.0, 0.0];
const SIZE: usize = size_of::<RaraCamera>();

fn scene() -> Gaussians {
    generate(Kind::Strands, 500, 3)
}

/// The layer of Gaussians that C has.
fn layer(gaussians: Gaussians) -> RaraLayer {
    let handle = add(RaraGaussians::from(gaussians)).expect("a number");
    // SAFETY: a struct that may hold any bytes, a string that ends in NUL, and a handle that is alive.
    unsafe {
        let mut layer: RaraLayer = std::mem::zeroed();
        let size = size_of_val(&layer);
        assert_eq!(
            rara_layer_default(&mut layer, size, c"one".as_ptr(), handle),
            RARA_OK
        );
        layer
    }
}

/// The cameras that a call has written.
fn written<const N: usize>(call: impl FnOnce(*mut RaraCamera) -> RaraResult) -> [Camera; N] {
    let mut cameras = [NOWHERE; N];
    assert_eq!(
        call(cameras.as_mut_ptr()),
        RARA_OK,
        "{}",
        crate::tests::message()
    );
    cameras.map(|camera| camera.camera().expect("it is possible"))
}

#[test]
fn a_scene_is_framed_and_a_plane_is_faced_as_by_the_library() {
    let scene = scene();
    let layer = layer(scene.clone());
    let visible = Visible::of(&(&scene).into());
    let framing = Framing::new(Lens::Perspective(40.0), (320, 200));
    // SAFETY: handles that are alive, and as many numbers and structs as are asked for.
    let [framed] = written(|camera| unsafe {
        rara_camera_frame_visible(&layer, 1, UP.as_ptr(), 40.0, 320, 200, camera, SIZE)
    });
    assert_eq!(framed, framing.camera(&visible).unwrap());

    let plane = Plane::new(DVec3::new(0.2, 0.1, 1.0), -0.3).unwrap();
    let in_c = RaraPlane {
        normal: plane.normal().into(),
        offset: plane.offset(),
    };
    let sections = Sections::new((320, 200)).up(Some(UP.into()));
    let all = Visible::nearly_all_of(&(&scene).into());
    // SAFETY: as above.
    let [faces] = written(|camera| unsafe {
        rara_camera_section(&layer, 1, &in_c, UP.as_ptr(), 320, 200, camera, SIZE)
    });
    assert_eq!(faces, sections.at(plane, &all).unwrap().camera);

    let mut flat = null_mut();
    // SAFETY: as above.
    let made = unsafe { rara_gaussians_cross_section(layer.gaussians, &in_c, &mut flat) };
    assert_eq!(made, RARA_OK);
    let flat = alive(flat, "flat").unwrap();
    assert!(!flat.gaussians.is_empty());
    assert_eq!(flat.gaussians, cross_section(&scene, &plane));
}

#[test]
fn a_slice_of_a_scene_far_from_zero_is_where_the_world_has_it() {
    let (scene, origin) = (scene(), DVec3::new(4e6, 2e5, -3e6));
    let relative = Plane::new(DVec3::Z, -0.3).unwrap();
    let expected = cross_section(&scene, &relative);
    assert!(!expected.is_empty());
    let mut far = scene;
    far.set_origin(origin).expect("is finite");
    let layer = layer(far);
    let in_c = RaraPlane {
        normal: [0.0, 0.0, 1.0],
        offset: -0.3 - origin.z,
    };
    let mut flat = null_mut();
    // SAFETY: a handle that is alive, a plane, and a pointer that may be overwritten.
    let made = unsafe { rara_gaussians_cross_section(layer.gaussians, &in_c, &mut flat) };
    assert_eq!(made, RARA_OK);
    let flat = alive(flat, "flat").unwrap();
    assert_eq!(flat.gaussians.origin(), origin);
    // The plane's offset is known to 2^-31 there.
    let pairs = flat.gaussians.positions().iter().zip(expected.positions());
    assert_eq!(flat.gaussians.len(), expected.len());
    assert!(
        pairs
            .into_iter()
            .all(|(at, near)| at.distance(*near) < 1e-6)
    );
}

#[test]
fn orbits_and_paths_are_those_of_the_library() {
    let camera = Camera::look_at(
        DVec3::new(0.0, -1.0, -4.0),
        DVec3::ZERO,
        UP.into(),
        50.0,
        (64, 48),
    );
    let camera = camera.unwrap();
    let (given, pivot) = (RaraCamera::from(camera), [0.5, 0.0, 0.0]);
    // SAFETY: as many numbers and structs as are asked for.
    let orbit: [_; 5] = written(|cameras| unsafe {
        rara_cameras_orbit(&given, pivot.as_ptr(), UP.as_ptr(), 1.0, 5, cameras, SIZE)
    });
    let expected = Orbit::new(1.0, 5).cameras(camera, (pivot.into(), UP.into()));
    assert_eq!(orbit[..], expected);

    let through = orbit.map(RaraCamera::from);
    // SAFETY: as above.
    let path: [_; 7] =
        written(|cameras| unsafe { rara_cameras_path(through.as_ptr(), 5, 1, 7, cameras, SIZE) });
    assert_eq!(path[..], Spline::through(&orbit, true).unwrap().cameras(7));

    let mut room = [NOWHERE; 2];
    let room = room.as_mut_ptr();
    let turned = |axis: [f64; 3], turns| {
        // SAFETY: as above.
        unsafe { rara_cameras_orbit(&given, pivot.as_ptr(), axis.as_ptr(), turns, 2, room, SIZE) }
    };
    assert_fails(
        turned([0.0; 3], 1.0),
        RARA_ERROR_INVALID,
        "axis is [0, 0, 0]",
    );
    assert_fails(turned(UP, f64::NAN), RARA_ERROR_INVALID, "turns is NaN");
    // Nothing is written where there is no room, and nothing is made for room that is null.
    let mut none = NOWHERE;
    let turned_to = |count, to: *mut RaraCamera| {
        // SAFETY: as above.
        unsafe { rara_cameras_orbit(&given, pivot.as_ptr(), UP.as_ptr(), 1.0, count, to, SIZE) }
    };
    none.width = 77;
    assert_eq!(turned_to(0, &raw mut none), RARA_OK);
    assert_eq!(none.width, 77);
    let lost = turned_to(u32::MAX, null_mut());
    assert_fails(lost, RARA_ERROR_INVALID, "cameras is null");
    let mut broken = through;
    broken[3].fx = -1.0;
    let gone = |through: &[RaraCamera]| {
        // SAFETY: as above.
        unsafe { rara_cameras_path(through.as_ptr(), through.len(), 0, 2, room, SIZE) }
    };
    assert_fails(gone(&broken), RARA_ERROR_INVALID, "through[3]: ");
    assert_fails(
        gone(&through[..1]),
        RARA_ERROR_INVALID,
        "two cameras or more",
    );
    assert_fails(gone(&[]), RARA_ERROR_INVALID, "no cameras");
}

#[test]
fn a_panorama_is_put_together_of_the_pictures_of_its_faces() {
    let width = 64;
    let panorama = Panorama::new((width, width / 2)).unwrap();
    let camera = Camera::look_at(DVec3::X, DVec3::ZERO, UP.into(), 50.0, (64, 48)).unwrap();
    let given = RaraCamera::from(camera);
    // SAFETY: as many numbers and structs as are asked for.
    let faces = written(|cameras| unsafe { rara_cameras_panorama(&given, width, cameras, SIZE) });
    assert_eq!(faces, panorama.faces(&camera));

    let mut level = 0.0;
    let pictures = faces.map(|face| {
        level += 0.125;
        Picture::filled(face.width, face.height, [level, 0.5 * level, 0.0, 1.0])
    });
    let pointers = pictures
        .each_ref()
        .map(|picture| picture.pixels.as_ptr().cast());
    let mut pixels = vec![0.0_f32; (width * (width / 2) * 4) as usize];
    // SAFETY: as many pixels as the cameras say, and room for the panorama's.
    let made = unsafe { rara_panorama_assemble(width, pointers.as_ptr(), pixels.as_mut_ptr()) };
    assert_eq!(made, RARA_OK);
    assert_eq!(pixels, panorama.assembled(&pictures).pixels.as_flattened());

    let missing = [
        pointers[0],
        pointers[1],
        null(),
        pointers[3],
        pointers[4],
        pointers[5],
    ];
    // SAFETY: as above.
    let assemble = |width, faces: [*const f32; 6]| unsafe {
        rara_panorama_assemble(width, faces.as_ptr(), pixels.as_mut_ptr())
    };
    let mut assemble = assemble;
    assert_fails(
        assemble(width, missing),
        RARA_ERROR_INVALID,
        "faces[2] is null",
    );
    assert_fails(
        assemble(63, pointers),
        RARA_ERROR_INVALID,
        "a panorama cannot have the size 63",
    );
}
