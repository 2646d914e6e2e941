//! Clips from planes, from text, from JSON and from files, what is none of them, and what is baked by them.

use std::ffi::{CStr, CString};
use std::ptr::{null, null_mut};

use super::*;
use crate::bake::*;
use crate::boundary::*;
use crate::gaussians::*;
use crate::tests::assert_fails;

const CLIPS: &str = r#"[
    {"name": "core", "clip": {"all": [{"sphere": {"centre": [0, 0, 0], "radius": 1}},
        {"not": {"box": {"centre": [0, 0, 0], "half": [0.5, 0.5, 0.5]}}}]}},
    {"normal": [0, 0, 2], "d": -1}]"#;

/// True when the region keeps a point on the z axis; the region is freed.
///
/// # Safety
/// The region is alive.
unsafe fn keeps(region: *mut RaraClip, z: f64) -> bool {
    let mut kept = 7;
    // SAFETY: the caller's promise, and three numbers.
    unsafe {
        let result = rara_clip_keeps(region, [0.0, 0.0, z].as_ptr(), &mut kept);
        assert_eq!(result, RARA_OK);
        rara_clip_destroy(region);
    }
    assert!(kept < 2);
    kept == 1
}

#[test]
fn clips_are_made_of_text_and_json() {
    let mut region = null_mut();
    let mut parse = |text: &CStr| {
        // SAFETY: a string that ends in NUL, and a pointer that may be overwritten.
        let result = unsafe { rara_clip_parse(text.as_ptr(), &mut region) };
        (result, region)
    };
    for (z, kept) in [(0.0, false), (0.7, true), (1.2, false)] {
        let (result, region) = parse(c"all(sphere:0,0,0,1, not(box:0,0,0,.5,.5,.5))");
        assert_eq!(result, RARA_OK);
        // SAFETY: it was just made.
        assert_eq!(unsafe { keeps(region, z) }, kept, "{z}");
    }
    for (text, says) in [
        (c"all(sphere:0,0,0", "column 5 of the clip expression"),
        (c"globe:1", "'globe' is neither a shape"),
        (c"\xff", "expression is not UTF-8"),
    ] {
        let (result, region) = parse(text);
        assert_fails(result, RARA_ERROR_INVALID, says);
        assert!(region.is_null());
    }
    let json = |name: *const c_char, text: &str| {
        let mut region = null_mut();
        // SAFETY: bytes that are there, a string that ends in NUL or null, a pointer that may be overwritten.
        let result = unsafe { rara_clip_from_json(text.as_ptr(), text.len(), name, &mut region) };
        (result, region)
    };
    for (name, z, kept) in [
        (c"core", 0.7, true),
        (c"core", 0.2, false),
        (c"1", 0.7, true),
        (c"1", 0.2, false),
    ] {
        let (result, region) = json(name.as_ptr(), CLIPS);
        assert_eq!(result, RARA_OK);
        // SAFETY: it was just made.
        assert_eq!(unsafe { keeps(region, z) }, kept, "{name:?}, {z}");
    }
    let (result, _) = json(null(), CLIPS);
    assert_fails(
        result,
        RARA_ERROR_FORMAT,
        "json: name one of its clips: core, 1",
    );
    let (result, _) = json(c"cores".as_ptr(), CLIPS);
    assert_fails(result, RARA_ERROR_FORMAT, "core, 1");
    let (result, _) = json(null(), "[{}]");
    assert_fails(result, RARA_ERROR_FORMAT, "element 0 needs either");

    let path = std::env::temp_dir().join(format!("rara-c-clips-{}.json", std::process::id()));
    std::fs::write(&path, CLIPS).expect("a temporary file");
    let name = CString::new(path.to_str().expect("UTF-8")).expect("no NUL");
    // SAFETY: strings that end in NUL, and a pointer that may be overwritten.
    unsafe {
        let result = rara_clip_load(name.as_ptr(), c"core".as_ptr(), &mut region);
        assert_eq!(result, RARA_OK);
        assert!(keeps(region, 0.7));
        let result = rara_clip_load(c"no/such.json".as_ptr(), null(), &mut region);
        assert_fails(result, RARA_ERROR_IO, "no/such.json");
        // Without a region all is kept.
        assert!(clip(null(), "clip").expect("everything").is_none());
    }
    std::fs::remove_file(&path).expect("is there");
}

#[test]
fn baking_is_that_of_rust() {
    let scene = rara::scene::generate(rara::scene::Kind::General, 900, 4);
    let text = "all(not(sphere:0,0,0,0.6), plane:0,0,1,0.1)";
    let expression: Expression = text.parse().expect("a region");
    let settings = rara::BakeSettings::default().children(2).leave(1.2);
    let truth = rara::bake(&scene, &expression.clip(), &settings).expect("bakes");
    let gaussians = crate::handles::add(RaraGaussians::from(scene)).expect("a number");
    let (mut region, mut baked) = (null_mut(), null_mut());
    let text = CString::new(text).expect("no NUL");
    // SAFETY: handles that are alive, structs that may hold any bytes, pointers that may be overwritten.
    unsafe {
        assert_eq!(rara_clip_parse(text.as_ptr(), &mut region), RARA_OK);
        let mut given: RaraBakeSettings = std::mem::zeroed();
        let size = size_of_val(&given);
        assert_eq!(rara_bake_settings_default(&mut given, size), RARA_OK);
        assert_eq!(given, rara::BakeSettings::default().into());
        (given.children, given.leave) = (2, 1.2);
        let mut counts: RaraBakeCounts = std::mem::zeroed();
        let room = size_of_val(&counts);
        let mut bake = |given: *const RaraBakeSettings, counts: *mut RaraBakeCounts, room| {
            let result = rara_gaussians_bake(gaussians, region, given, &mut baked, counts, room);
            (result, baked)
        };
        let (result, made) = bake(&given, &mut counts, room);
        assert_eq!(result, RARA_OK);
        let of_made = alive(made, "made").expect("just made");
        assert_eq!(of_made.gaussians, truth.gaussians);
        drop(of_made);
        assert_eq!(counts, truth.counts.into());
        assert!(counts.children > 0 && counts.struct_size == room);
        rara_gaussians_destroy(made);
        // The defaults, and nobody who counts.
        let (result, made) = bake(null(), null_mut(), 0);
        assert_eq!(result, RARA_OK);
        rara_gaussians_destroy(made);

        let (result, made) = bake(&given, &mut counts, 3);
        assert_fails(result, RARA_ERROR_INVALID, "sizeof(RaraBakeCounts)");
        assert!(made.is_null());
        given.children = 4;
        assert_fails(
            bake(&given, null_mut(), 0).0,
            RARA_ERROR_INVALID,
            "4 children",
        );
        given.mode = 9;
        assert_fails(bake(&given, null_mut(), 0).0, RARA_ERROR_INVALID, "mode 9");
        let nothing = rara_gaussians_bake(gaussians, null(), null(), &mut baked, null_mut(), 0);
        assert_fails(nothing, RARA_ERROR_INVALID, "clip is null");
        rara_clip_destroy(region);
        let nothing = rara_gaussians_bake(gaussians, region, null(), &mut baked, null_mut(), 0);
        assert_fails(
            nothing,
            RARA_ERROR_INVALID,
            "clip is no RaraClip that is alive",
        );
        rara_gaussians_destroy(gaussians);
    }
}

#[test]
fn clips_are_made_of_meshes() {
    let vertices = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let mut clip = null_mut();
    let mut make = |face_count, rule| {
        let (at, faces) = (vertices.as_ptr(), faces.as_ptr());
        // SAFETY: the lists are as long as said, and the pointer may be overwritten.
        let result = unsafe { rara_clip_of_mesh(at, 4, faces, face_count, rule, &mut clip) };
        (result, clip)
    };
    for (count, rule, says) in [
        (4, 2, "rule 2 is no RaraMeshRule"),
        (
            3,
            RARA_MESH_RULE_CLOSED,
            "the mesh is not closed: the edge from",
        ),
        (0, RARA_MESH_RULE_WINDING, "the mesh has no faces"),
    ] {
        let (result, clip) = make(count, rule);
        assert_fails(result, RARA_ERROR_INVALID, says);
        assert!(clip.is_null());
    }
    let (result, clip) = make(4, RARA_MESH_RULE_CLOSED);
    assert_eq!(result, RARA_OK);
    for (x, kept) in [(0.1, 1), (0.9, 0)] {
        let mut keeps = 2;
        // SAFETY: the clip is alive.
        let result = unsafe { rara_clip_keeps(clip, [x; 3].as_ptr(), &mut keeps) };
        assert_eq!((result, keeps), (RARA_OK, kept));
    }
    // SAFETY: it is not used any more.
    unsafe { rara_clip_destroy(clip) };
}

#[test]
fn clips_are_made_of_planes() {
    let plane = |x| RaraPlane {
        normal: [x, 0.0, 0.0],
        offset: 1.0,
    };
    let planes = [plane(1.0), plane(0.0)];
    let mut clip = null_mut();
    let mut make = |planes: *const RaraPlane, count, op| {
        // SAFETY: the planes are there or null, and the pointer may be overwritten.
        let result = unsafe { rara_clip_of_planes(planes, count, op, &mut clip) };
        (result, clip)
    };
    let (and, there) = (RARA_CLIP_OP_AND, planes.as_ptr());
    for (planes, count, op, says) in [
        (there, 2, and, "planes[1]: the clip plane 0,0,0,1"),
        (there, 1, 2, "op 2 is no RaraClipOp"),
        (null(), 1, and, "planes is null"),
    ] {
        let (result, clip) = make(planes, count, op);
        assert_fails(result, RARA_ERROR_INVALID, says);
        assert!(clip.is_null());
    }
    let prism = [plane(1.0); 200];
    let (result, many) = make(prism.as_ptr(), prism.len(), and);
    assert_eq!(result, RARA_OK);
    let (result, one) = make(there, 1, and);
    assert_eq!(result, RARA_OK);
    let (result, all) = make(null(), 0, RARA_CLIP_OP_OR);
    assert_eq!(result, RARA_OK);
    for (clip, surfaces) in [(many, 200), (one, 1), (all, 0)] {
        let made = super::clip(clip, "clip").expect("is alive");
        assert_eq!(made.expect("is no null").surfaces.len(), surfaces);
        // SAFETY: it is not used any more.
        unsafe { rara_clip_destroy(clip) };
    }
    assert!(super::clip(null(), "clip").is_ok_and(|none| none.is_none()));
    let error = super::clip(one, "clip").expect_err("it was destroyed");
    assert!(error.to_string().starts_with("clip is no RaraClip"));
}
