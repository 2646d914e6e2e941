use super::*;

#[test]
fn parts_make_a_placement_in_any_order() {
    let made = place("move:1,2,3 turn:0,0,1,90 scale:2").expect("a place");
    assert_eq!(place("scale:2,2,2 turn:0,0,1,90 move:1,2,3"), Ok(made));
    let to_world = |place: Place| place.placement.to_world(place.stretch * DVec3::X);
    assert!((to_world(made) - DVec3::new(1.0, 4.0, 3.0)).length() < 1e-12);
    let half = place("rotation:0,0,0,2").expect("a place");
    assert!((to_world(half) + DVec3::X).length() < 1e-12);
    assert_eq!(place("turn:0,0,5,180"), Ok(half));
    assert_eq!(place("scale:-2"), place("scale:-2,-2,-2"));
    let mirrored = place("scale:-2,1,1 turn:0,0,1,90").expect("a place");
    assert!((to_world(mirrored) + 2.0 * DVec3::Y).length() < 1e-12);
}

#[test]
fn what_is_no_placement_is_refused_with_its_part() {
    for (text, says) in [
        ("", "expected move:X,Y,Z"),
        ("1,2,3", "'1,2,3' is none of move"),
        ("move:1,2", "move:1,2: "),
        ("turn:0,0,0,90", "axis"),
        ("turn:0,0,1,90 rotation:1,0,0,0", "comes second"),
        ("scale:0", "none of them 0"),
        ("scale:1,2", "one for each of the three axes"),
        ("scale:1,0,1", "none of them 0"),
        ("rotation:0,0,0,0", "rotation"),
    ] {
        let error = place(text).expect_err(text);
        assert!(error.contains(says), "{text}: {error}");
    }
}
