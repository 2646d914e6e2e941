//! Regions from text, from JSON and from files, and what is none of them.

use std::ffi::{CStr, CString};
use std::ptr::{null, null_mut};

use super::*;
use crate::boundary::*;
use crate::tests::assert_fails;

const CLIPS: &str = r#"[
    {"name": "core", "clip": {"all": [{"sphere": {"centre": [0, 0, 0], "radius": 1}},
        {"not": {"box": {"centre": [0, 0, 0], "half": [0.5, 0.5, 0.5]}}}]}},
    {"normal": [0, 0, 2], "d": -1}]"#;

/// True when the region keeps a point on the z axis; the region is freed.
///
/// # Safety
/// The region is alive.
unsafe fn keeps(region: *mut RaraRegion, z: f64) -> bool {
    let mut kept = 7;
    // SAFETY: the caller's promise, and three numbers.
    unsafe {
        let result = rara_region_keeps(region, [0.0, 0.0, z].as_ptr(), &mut kept);
        assert_eq!(result, RARA_OK);
        rara_region_destroy(region);
    }
    assert!(kept < 2);
    kept == 1
}

#[test]
fn regions_are_made_of_text_and_json() {
    let mut region = null_mut();
    let mut parse = |text: &CStr| {
        // SAFETY: a string that ends in NUL, and a pointer that may be overwritten.
        let result = unsafe { rara_region_parse(text.as_ptr(), &mut region) };
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
        let result = unsafe { rara_region_from_json(text.as_ptr(), text.len(), name, &mut region) };
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
        let result = rara_region_load(name.as_ptr(), c"core".as_ptr(), &mut region);
        assert_eq!(result, RARA_OK);
        assert!(keeps(region, 0.7));
        let result = rara_region_load(c"no/such.json".as_ptr(), null(), &mut region);
        assert_fails(result, RARA_ERROR_IO, "no/such.json");
        // Without a region all is kept.
        assert!(clip(null()).expect("everything").is_everything());
    }
    std::fs::remove_file(&path).expect("is there");
    assert!(projection(RARA_PROJECTION_ORTHOGRAPHIC).is_ok());
    let error = projection(2).expect_err("no projection").to_string();
    assert_eq!(error, "projection 2 is no RaraProjection");
}
