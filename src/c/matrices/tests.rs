//! Hosts hand over their matrices in every order and precision, and what is wrong with them is named.

use std::ptr::{null, null_mut};

use super::*;
use crate::boundary::{RARA_ERROR_INVALID, RARA_OK};
use crate::camera::{RARA_PROJECTION_ORTHOGRAPHIC, RARA_PROJECTION_PERSPECTIVE};
use crate::tests::assert_fails;
use rara::glam::DVec3;
use rara::glam::dcamera::{lh, rh};

fn ndc() -> RaraNdc {
    let mut ndc = VULKAN;
    ndc.order = 77;
    // SAFETY: the struct has the room that the call is given.
    let filled = unsafe { rara_ndc_default(&mut ndc, size_of_val(&ndc)) };
    assert_eq!((filled, ndc), (RARA_OK, VULKAN));
    ndc
}

const NO_MAP: RaraDepthMap = RaraDepthMap {
    offset: 0.0,
    scale: 0.0,
    projection: RARA_PROJECTION_PERSPECTIVE,
};

/// The result for a host in double precision, and what it was given.
fn made(
    view: DMat4,
    projection: DMat4,
    ndc: Option<&RaraNdc>,
) -> (RaraResult, (RaraCamera, RaraDepthMap)) {
    let [view, projection] = [view, projection].map(|matrix| matrix.to_cols_array());
    let (mut camera, ndc) = (NOWHERE, ndc.map_or(null(), std::ptr::from_ref));
    let (mut map, size) = (NO_MAP, size_of_val(&camera));
    // SAFETY: both have 16 numbers, and the struct has the room that the call is given.
    let result = unsafe {
        let (view, projection) = (view.as_ptr(), projection.as_ptr());
        rara_camera_of_projection(view, projection, ndc, 320, 200, &mut camera, size, &mut map)
    };
    (result, (camera, map))
}

fn view() -> DMat4 {
    lh::view::look_at_mat4(DVec3::new(1.0, 2.0, -5.0), DVec3::ZERO, DVec3::Y)
}

fn projection() -> DMat4 {
    lh::proj::directx::perspective_infinite_reverse(0.8, 1.6, 0.1)
}

#[test]
fn a_hosts_matrices_are_the_camera_that_they_are_in_rust() {
    let size = (320, 200);
    let up = RaraNdc {
        y_up: vk::TRUE,
        ..ndc()
    };
    let (camera, depth) =
        Camera::of_projection(view(), projection(), Ndc::DIRECT3D, size).expect("a camera");
    let (result, seen) = made(view(), projection(), Some(&up));
    assert_eq!(result, RARA_OK);
    let map = RaraDepthMap {
        offset: depth.offset(),
        scale: depth.scale(),
        projection: RARA_PROJECTION_PERSPECTIVE,
    };
    assert_eq!(seen, (camera.into(), map));
    assert_eq!(map.map().expect("a map"), depth);
    assert!(depth.is_reversed() && camera.rotation.determinant() < 0.0);
    // A left-handed host's camera is as good as another.
    assert_eq!(seen.0.camera().expect("a camera"), camera);

    let beside = RaraNdc {
        order: RARA_MATRIX_ORDER_TRANSLATION_BESIDE,
        ..up
    };
    let (result, turned) = made(view().transpose(), projection().transpose(), Some(&beside));
    assert_eq!((result, turned), (RARA_OK, seen));

    let [view, projection] = [view(), projection()].map(|m| m.as_mat4().to_cols_array());
    let (mut floats, size) = (NOWHERE, size_of::<RaraCamera>());
    // SAFETY: as above.
    let result = unsafe {
        let (view, projection) = (view.as_ptr(), projection.as_ptr());
        rara_camera_of_projection_floats(
            view,
            projection,
            &up,
            320,
            200,
            &mut floats,
            size,
            null_mut(),
        )
    };
    assert_eq!(result, RARA_OK);
    assert!((floats.fx - seen.0.fx).abs() < 1e-4);
    let pairs = floats.eye.iter().zip(seen.0.eye);
    assert!(pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-5));
}

#[test]
fn the_default_is_vulkans_and_orthographic_projections_say_so() {
    let view = rh::view::look_at_mat4(DVec3::new(0.0, 1.0, 4.0), DVec3::ZERO, DVec3::Y);
    let flat = rh::proj::vulkan::orthographic(-2.0, 2.0, -1.0, 1.0, 1.0, 9.0);
    let (result, seen) = made(view, flat, None);
    assert_eq!(result, RARA_OK);
    let (camera, map) = seen;
    assert_eq!(camera.projection, RARA_PROJECTION_ORTHOGRAPHIC);
    assert_eq!(map.projection, RARA_PROJECTION_ORTHOGRAPHIC);
    assert_eq!((camera.fx, camera.fy), (80.0, 100.0));
    assert!((map.offset + 0.125).abs() < 1e-12 && (map.scale + 0.125).abs() < 1e-12);
    let (result, other) = made(view, flat, Some(&ndc()));
    assert_eq!((result, other), (RARA_OK, seen));
}

#[test]
fn what_is_wrong_is_named() {
    let refused = |view, projection, ndc: &RaraNdc, says| {
        let (result, seen) = made(view, projection, Some(ndc));
        assert_fails(result, RARA_ERROR_INVALID, says);
        assert_eq!(seen, (NOWHERE, NO_MAP));
    };
    let (right, beside) = (
        ndc(),
        RaraNdc {
            order: RARA_MATRIX_ORDER_TRANSLATION_BESIDE,
            ..ndc()
        },
    );
    refused(view(), projection(), &beside, "the view matrix's last row");
    let far = RaraNdc { order: 7, ..right };
    refused(
        view(),
        projection(),
        &far,
        "ndc->order 7 is no RaraMatrixOrder",
    );
    let small = RaraNdc {
        struct_size: 3,
        ..right
    };
    refused(view(), projection(), &small, "ndc->struct_size is 3");
    refused(
        view(),
        DMat4::NAN,
        &right,
        "the projection matrix has NaN in row 0",
    );
    let numbers = view().to_cols_array();
    let (mut seen, size) = (NOWHERE, size_of::<RaraCamera>());
    // SAFETY: null is refused, and the rest is as above.
    unsafe {
        let given = numbers.as_ptr();
        let result =
            rara_camera_of_projection(null(), given, null(), 8, 8, &mut seen, size, null_mut());
        assert_fails(result, RARA_ERROR_INVALID, "view is null");
        let result =
            rara_camera_of_projection(given, null(), null(), 8, 8, &mut seen, size, null_mut());
        assert_fails(result, RARA_ERROR_INVALID, "projection is null");
        let result =
            rara_camera_of_projection(given, given, null(), 8, 8, &mut seen, 5, null_mut());
        assert_fails(result, RARA_ERROR_INVALID, "sizeof(RaraCamera)");
    }
}
