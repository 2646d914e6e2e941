use super::*;

#[test]
fn vectors_take_signs_spaces_and_exponents() {
    assert_eq!(vec3("-1, 2.5,-3e2"), Ok(DVec3::new(-1.0, 2.5, -300.0)));
    assert!(vec3("1,2").is_err());
    assert!(vec3("1,2,3,4").is_err());
    assert!(vec3("1,,3").is_err());
    assert!(vec3("nan,0,0").is_err());
    assert!(vec3("1e999,0,0").is_err());
}

#[test]
fn turns_are_about_an_axis_by_degrees() {
    let half = turn("0,0,2,180").expect("an axis");
    assert_eq!(half * DVec3::X, DVec3::NEG_X);
    let back = turn("0,1,0,-90").expect("an axis");
    assert!((back * DVec3::X).distance(DVec3::Z) < 1e-15);
    assert!(turn("0,0,0,90").is_err() && turn("1,2,3").is_err());
}

#[test]
fn sizes_and_names() {
    assert_eq!(size("640x480"), Ok((640, 480)));
    assert!(size("640").is_err() && size("-1x5").is_err() && size("5x99999999999").is_err());
    assert!(positive("0").is_err() && positive("1e60").is_err() && positive("3").is_ok());
    assert!(picture_path("a.PNG".into()).is_ok() && picture_path("a.exr".into()).is_ok());
    assert!(picture_path("a.jpg".into()).is_err() && picture_path("png".into()).is_err());
}
