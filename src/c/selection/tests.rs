//! Selections of what is loaded and of a host's own, and what is none.

use std::ffi::CStr;
use std::ptr::{null, null_mut};

use super::*;
use crate::arrays::*;
use crate::bake::*;
use crate::boundary::*;
use crate::clip::{rara_clip_destroy, rara_clip_parse};
use crate::gaussians::*;
use crate::handles::alive;
use crate::load::*;
use crate::tests::assert_fails;

/// Five Gaussians with a label each.
const SCENE: &[u8] = b"ply\nformat ascii 1.0\nelement vertex 5
property float x\nproperty float y\nproperty float z
property float f_dc_0\nproperty float f_dc_1\nproperty float f_dc_2\nproperty float opacity
property float scale_0\nproperty float scale_1\nproperty float scale_2
property float rot_0\nproperty float rot_1\nproperty float rot_2\nproperty float rot_3
property uchar label\nend_header
0 0 0 1 1 1 2 -1 -1 -1 1 0 0 0 3
1 0 0 1 1 1 2 -1 -1 -1 1 0 0 0 4
2 0 0 1 1 1 -2 -1 -1 -1 1 0 0 0 3
3 0 0 1 1 1 2 -1 -1 -1 1 0 0 0 4
4 0 0 1 1 1 2 -1 -1 -1 1 0 0 0 5\n";

fn load_for(predicates: &[&CStr]) -> (RaraResult, *mut RaraGaussians) {
    let mut made = null_mut();
    let texts: Vec<_> = predicates.iter().map(|text| text.as_ptr()).collect();
    // SAFETY: bytes that are there, strings that end in NUL, a pointer that may be overwritten.
    let result = unsafe {
        let (data, name) = (SCENE.as_ptr(), c"entry".as_ptr());
        rara_gaussians_load_from(
            data,
            SCENE.len(),
            name,
            texts.as_ptr(),
            texts.len(),
            &mut made,
        )
    };
    (result, made)
}

fn select(from: *mut RaraGaussians, predicate: &CStr) -> (RaraResult, *mut RaraGaussians) {
    let mut taken = null_mut();
    // SAFETY: a string that ends in NUL, and a pointer that may be overwritten.
    let result = unsafe { rara_gaussians_select(from, predicate.as_ptr(), null(), &mut taken) };
    (result, taken)
}

/// Where the Gaussians are along x, which is what they are numbered by in the file, and those numbers as they are kept.
fn places(gaussians: *mut RaraGaussians) -> Vec<u32> {
    let gaussians = alive(gaussians, "gaussians").expect("is alive");
    let places = gaussians.gaussians.positions().iter().map(|at| at.x as u32);
    let places: Vec<u32> = places.collect();
    if let Some(part) = &gaussians.part {
        assert_eq!(part.numbers, places);
        assert_eq!(*part.set, 5);
    }
    for property in &gaussians.properties {
        assert_eq!(property.values.len(), places.len());
    }
    places
}

#[test]
fn what_fulfils_a_predicate_becomes_gaussians_of_its_own() {
    let (result, whole) = load_for(&[c"label=3", c"label in 4"]);
    assert_eq!(result, RARA_OK);
    assert_eq!(places(whole), [0, 1, 2, 3, 4]);
    let (result, threes) = select(whole, c"label in 3,5");
    assert_eq!(result, RARA_OK);
    assert_eq!((places(whole), places(threes)), (vec![1, 3], vec![0, 2, 4]));
    // From what was taken, and from what is left.
    let (_, faint) = select(threes, c"opacity<0.5 and not inside(sphere:0,0,0,1)");
    assert_eq!((places(threes), places(faint)), (vec![0, 4], vec![2]));
    let (_, near) = select(whole, c"inside(sphere:0,0,0,2)");
    assert_eq!((places(whole), places(near)), (vec![3], vec![1]));
    let (result, none) = select(near, c"size>9");
    assert_eq!(result, RARA_OK);
    assert_eq!((places(near), places(none)), (vec![1], vec![]));
    let set = |handle: *mut RaraGaussians| {
        let part = alive(handle, "a part").expect("is alive").part.clone();
        part.expect("it is one").set
    };
    for handle in [threes, faint, near, none] {
        assert!(Arc::ptr_eq(&set(handle), &set(whole)));
    }
    // What others are appended to is no part any more; properties that both have stay.
    // SAFETY: handles that are alive, a string that ends in NUL, and as many values as the count says.
    unsafe {
        assert_eq!(rara_gaussians_append(near, none), RARA_OK);
        assert!(alive(near, "near").expect("is alive").part.is_some());
        let values = [7.0];
        let name = c"mine".as_ptr();
        let set = rara_gaussians_set_property(faint, name, values.as_ptr(), 1);
        assert_eq!(set, RARA_OK);
        assert_eq!(rara_gaussians_append(faint, threes), RARA_OK);
        // Nothing has all properties.
        assert_eq!(rara_gaussians_append(none, faint), RARA_OK);
        let joined = alive(none, "none").expect("is alive");
        assert_eq!(joined.properties.len(), 1);
        drop(joined);
        let joined = alive(faint, "faint").expect("is alive");
        assert!(joined.part.is_none());
        assert_eq!(joined.properties.len(), 1);
        assert_eq!(joined.properties[0].values, [3.0, 3.0, 5.0]);
        drop(joined);
        for handle in [whole, threes, faint, near, none] {
            rara_gaussians_destroy(handle);
        }
    }
}

#[test]
fn what_is_baked_keeps_its_properties() {
    let (_, whole) = load_for(&[c"label=3"]);
    let (mut region, mut baked) = (null_mut(), null_mut());
    // SAFETY: a string that ends in NUL, handles that are alive, pointers that may be overwritten.
    unsafe {
        assert_eq!(
            rara_clip_parse(c"plane:1,0,0,-2.5".as_ptr(), &mut region),
            RARA_OK
        );
        let result = rara_gaussians_bake(whole, region, null(), &mut baked, null_mut(), 0);
        assert_eq!(result, RARA_OK);
    }
    let made = alive(baked, "baked").expect("is alive");
    let region_of = alive(region, "region").expect("is alive");
    let of = alive(whole, "whole").expect("is alive");
    let truth = rara::bake(&of.gaussians, &region_of.0, &rara::BakeSettings::default());
    let sources = truth.expect("bakes").sources;
    let label = |&source: &u32| of.properties[0].values[source as usize];
    let labels: Vec<f64> = sources.iter().map(label).collect();
    assert!((2..5).contains(&labels.len()), "{labels:?}");
    assert_eq!(made.properties[0].values, labels);
    drop((made, of, region_of));
    let (result, threes) = select(baked, c"label=3");
    assert_eq!(result, RARA_OK);
    // SAFETY: they are alive.
    unsafe {
        rara_clip_destroy(region);
        for handle in [whole, baked, threes] {
            rara_gaussians_destroy(handle);
        }
    }
}

#[test]
fn a_host_labels_its_own_gaussians() {
    let positions = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0];
    let (scales, rotations) = ([0.1_f32; 6], [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    let (opacities, sh) = ([0.5_f32; 2], [0.0_f32; 6]);
    let mut made = null_mut();
    // SAFETY: the arrays have two Gaussians; strings end in NUL; pointers may be overwritten.
    unsafe {
        let mut arrays: RaraGaussianArrays = std::mem::zeroed();
        let size = size_of_val(&arrays);
        assert_eq!(rara_gaussian_arrays_default(&mut arrays, size), RARA_OK);
        arrays.count = 2;
        (arrays.positions, arrays.scales) = (positions.as_ptr(), scales.as_ptr());
        (arrays.rotations, arrays.opacities) = (rotations.as_ptr(), opacities.as_ptr());
        arrays.sh = sh.as_ptr();
        assert_eq!(rara_gaussians_from_arrays(&arrays, &mut made), RARA_OK);
        let set = |name: &CStr, values: *const f64, count| {
            rara_gaussians_set_property(made, name.as_ptr(), values, count)
        };
        let (before, values) = ([9.0, 9.0], [f64::NAN, 16_777_217.0]);
        assert_eq!(set(c"my label", before.as_ptr(), 2), RARA_OK);
        assert_eq!(set(c"my label", values.as_ptr(), 2), RARA_OK);
        let short = set(c"my label", values.as_ptr(), 1);
        assert_fails(short, RARA_ERROR_INVALID, "count is 1, and there are 2");
        let nothing = set(c"my label", null(), 2);
        assert_fails(nothing, RARA_ERROR_INVALID, "values is null");
        let unnamed = set(c" ", values.as_ptr(), 2);
        assert_fails(unnamed, RARA_ERROR_INVALID, "name is empty");
        let (result, taken) = select(made, c"property(my label)=16777217");
        assert_eq!(result, RARA_OK);
        let taken_of = alive(taken, "taken").expect("is alive");
        assert_eq!(taken_of.gaussians.positions()[0].x, 1.0);
        drop(taken_of);
        // Clips and sizes are those of the scene that the layer is placed in.
        let placement = RaraPlacement {
            position: [5.0, 0.0, 0.0],
            rotation: [0.0, 0.0, 0.0, 1.0],
            scale: 2.0,
        };
        let mut moved = null_mut();
        let predicate = c"inside(sphere:5,0,0,1) and size>=0.2".as_ptr();
        let result = rara_gaussians_select(made, predicate, &placement, &mut moved);
        assert_eq!(result, RARA_OK);
        let placed = moved;
        assert_eq!(alive(moved, "moved").expect("is alive").gaussians.len(), 1);
        let nowhere = RaraPlacement {
            scale: 0.0,
            ..placement
        };
        let result = rara_gaussians_select(taken, predicate, &nowhere, &mut moved);
        assert_fails(result, RARA_ERROR_INVALID, "a scene cannot be placed so");
        for handle in [made, taken, placed] {
            rara_gaussians_destroy(handle);
        }
    }
}

#[test]
fn what_is_no_selection_says_where_it_is_wrong() {
    for (text, says) in [
        (
            c"label in 3,",
            "predicates[1]: column 12 of the selection: a number is missing",
        ),
        (c"\xff", "predicates[1] is not UTF-8"),
    ] {
        let (result, made) = load_for(&[c"opacity>0.5", text]);
        assert_fails(result, RARA_ERROR_INVALID, says);
        assert!(made.is_null());
    }
    let (result, _) = load_for(&[c"colour=3"]);
    assert_fails(result, RARA_ERROR_FORMAT, "colour");
    let (_, made) = load_for(&[]);
    for (text, says) in [
        (
            c"opacity>half",
            "predicate: column 9 of the selection: 'half' is not",
        ),
        (c"", "predicate: column 1 of the selection"),
        (
            c"red>1 and inside(globe:1)",
            "from column 18 of the selection on: column 1 of the clip expression",
        ),
        (
            c"label=3",
            "the property 'label', which the Gaussians have not: load them by rara_gaussians_load",
        ),
    ] {
        let (result, taken) = select(made, text);
        assert_fails(result, RARA_ERROR_INVALID, says);
        assert!(taken.is_null());
        assert_eq!(places(made), [0, 1, 2, 3, 4], "as it was");
    }
    // SAFETY: it is alive, and then it is not.
    unsafe { rara_gaussians_destroy(made) };
    let (result, _) = select(made, c"opacity>0.5");
    assert_fails(result, RARA_ERROR_INVALID, "gaussians is no RaraGaussians");
}
