use super::*;

#[test]
fn paths_are_read_as_they_are_written() {
    let views = |names: &[&str]| Some(names.iter().map(|name| name.to_string()).collect());
    assert_eq!(route("orbit"), Ok(Route::Orbit(1.0)));
    assert_eq!(route("orbit:-0.5"), Ok(Route::Orbit(-0.5)));
    for (text, names, closed) in [
        ("spline", None, false),
        ("spline:closed", None, true),
        ("spline:3,a.jpg", views(&["3", "a.jpg"]), false),
        ("spline:0,1,2,closed", views(&["0", "1", "2"]), true),
    ] {
        let views = names;
        assert_eq!(route(text), Ok(Route::Spline { views, closed }), "{text}");
    }
    assert_eq!(route("cameras:7"), Ok(Route::Cameras(views(&["7"]))));
    for wrong in [
        "",
        "circle",
        "orbit:",
        "orbit:x",
        "orbit:0",
        "orbit:inf",
        "spline:",
        "cameras:1,,2",
    ] {
        assert!(route(wrong).is_err(), "{wrong}");
    }
}
