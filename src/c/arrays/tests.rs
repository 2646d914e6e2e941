//! Gaussians of a host's arrays are those of a file, whatever lies between them, and what is wrong with them is named.

use std::ptr::{null, null_mut};

use super::*;
use crate::boundary::{RARA_ERROR_INVALID, RARA_OK};
use crate::gaussians::rara_gaussians_destroy;
use crate::handles::alive;
use crate::tests::assert_fails;
use rara::Training;
use rara::scene::{Kind, generate};

/// The result, and the Gaussians that it has given.
fn made(arrays: &RaraGaussianArrays) -> (RaraResult, Option<Gaussians>) {
    let mut handle = null_mut();
    // SAFETY: every test's arrays are as they say, or refused before they are read.
    unsafe {
        let result = rara_gaussians_from_arrays(arrays, &mut handle);
        let found = (result == RARA_OK).then(|| {
            let object = alive(handle.cast_const(), "gaussians").expect("made just now");
            object.gaussians.clone()
        });
        rara_gaussians_destroy(handle);
        (result, found)
    }
}

fn default() -> RaraGaussianArrays {
    let mut arrays = RaraGaussianArrays::BLANK;
    arrays.count = 7;
    // SAFETY: the struct has the room that the call is given.
    let filled = unsafe { rara_gaussian_arrays_default(&mut arrays, size_of_val(&arrays)) };
    assert_eq!((filled, arrays.count), (RARA_OK, 0));
    arrays
}

/// Arrays of Gaussians without gaps.
fn packed(gaussians: &Gaussians) -> RaraGaussianArrays {
    RaraGaussianArrays {
        count: gaussians.len(),
        positions: gaussians.positions().as_ptr().cast(),
        scales: gaussians.scales().as_ptr().cast(),
        // glam aligns a quaternion as it likes, and its numbers are x, y, z, w.
        rotations: gaussians.rotations().as_ptr().cast(),
        opacities: gaussians.opacities().as_ptr(),
        sh_degree: gaussians.sh_degree(),
        sh: gaussians.sh().as_ptr(),
        ..default()
    }
}

#[test]
fn arrays_are_the_gaussians_that_they_hold() {
    for degree in 0..4 {
        let mut gaussians = generate(Kind::Strands, 100, 3);
        gaussians.set_sh_degree(degree);
        let (result, found) = made(&packed(&gaussians));
        assert_eq!((result, found), (RARA_OK, Some(gaussians)));
    }
    let (result, found) = made(&default());
    assert_eq!((result, found.map(|none| none.len())), (RARA_OK, Some(0)));
}

/// A host's own struct, whose floats begin at an odd byte.
#[test]
fn fields_of_a_hosts_structs_are_found_by_their_strides() {
    let mut gaussians = generate(Kind::General, 50, 3);
    gaussians.set_sh_degree(1);
    const STRIDE: usize = 1 + 4 * (3 + 3 + 4 + 1 + 12) + 6;
    let mut bytes = Vec::new();
    for i in 0..gaussians.len() {
        let (position, scale) = (gaussians.positions()[i], gaussians.scales()[i]);
        let own = [position.to_array(), scale.to_array()].concat();
        let rotation = gaussians.rotations()[i].to_array();
        let (opacity, sh) = ([gaussians.opacities()[i]], &gaussians.sh()[12 * i..][..12]);
        bytes.push(0xff);
        let all = own.iter().chain(&rotation).chain(&opacity).chain(sh);
        bytes.extend(all.flat_map(|v| v.to_ne_bytes()));
        bytes.extend([0xee; 6]);
    }
    let at = |float: usize| bytes[1 + 4 * float..].as_ptr().cast();
    let arrays = RaraGaussianArrays {
        count: gaussians.len(),
        positions: at(0),
        position_stride: STRIDE,
        scales: at(3),
        scale_stride: STRIDE,
        rotations: at(6),
        rotation_stride: STRIDE,
        opacities: at(10),
        opacity_stride: STRIDE,
        sh_degree: 1,
        sh: at(11),
        sh_stride: STRIDE,
        ..default()
    };
    assert_eq!(made(&arrays), (RARA_OK, Some(gaussians)));
}

#[test]
fn what_is_wrong_with_arrays_is_named() {
    let gaussians = generate(Kind::General, 5, 3);
    let refused = |change: &dyn Fn(&mut RaraGaussianArrays), says| {
        let mut arrays = packed(&gaussians);
        change(&mut arrays);
        assert_fails(made(&arrays).0, RARA_ERROR_INVALID, says);
    };
    let mut antialiased = packed(&gaussians);
    antialiased.antialiased = 1;
    antialiased.low_pass = 0.1;
    antialiased.origin = [5e5, -1.0, 0.0];
    let (code, made_of_it) = made(&antialiased);
    let made_of_it = made_of_it.expect("they can be drawn");
    assert_eq!(code, RARA_OK);
    let training = Training::default().antialiased(true).low_pass(0.1);
    assert_eq!(made_of_it.training(), training);
    assert_eq!(made_of_it.origin().to_array(), [5e5, -1.0, 0.0]);
    refused(&|a| a.struct_size = 12, "arrays->struct_size is 12");
    refused(&|a| a.origin[1] = f64::NAN, "arrays->the origin is");
    refused(&|a| a.low_pass = -1.0, "arrays->the low-pass is -1");
    refused(&|a| a.sh_degree = 4, "arrays->sh_degree is 4");
    refused(&|a| a.positions = null(), "arrays->positions is null");
    refused(&|a| a.scales = null(), "arrays->scales is null");
    refused(&|a| a.rotations = null(), "arrays->rotations is null");
    refused(&|a| a.opacities = null(), "arrays->opacities is null");
    refused(&|a| a.sh = null(), "arrays->sh is null");
    refused(
        &|a| a.rotation_stride = 12,
        "arrays->rotation_stride is 12, and each has 16 bytes",
    );
    refused(&|a| a.count = usize::MAX / 3, "is more than memory holds");
    let bad = [f32::NAN; 15];
    refused(&|a| a.positions = bad.as_ptr(), "arrays->positions[0] is");
    let negative = [-1.0_f32; 15];
    refused(&|a| a.scales = negative.as_ptr(), "arrays->scales[0] is");
    let twice = [2.0_f32; 20];
    refused(&|a| a.rotations = twice.as_ptr(), "no unit quaternion");
    refused(
        &|a| a.opacities = twice.as_ptr(),
        "arrays->opacities[0] is 2.0",
    );
}
