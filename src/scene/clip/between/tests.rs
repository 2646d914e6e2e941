use super::*;
use glam::DVec3;

fn between(from: &str, to: &str, share: f64) -> Result<Expression> {
    let [from, to] = [from, to].map(|text| text.parse::<Expression>().expect("an expression"));
    from.between(&to, share)
}

#[test]
fn every_kind_of_shape_moves_evenly() {
    for (from, to, middle) in [
        ("plane:0,0,1,2", "plane:0,0,1,4", "plane:0,0,1,3"),
        ("!slab:1,0,0,0,1", "!slab:1,0,0,2,3", "!slab:1,0,0,1,2"),
        ("box:0,0,0,1,1,1", "box:2,0,0,1,3,1", "box:1,0,0,1,2,1"),
        ("sphere:0,0,0,1", "sphere:0,0,4,2", "sphere:0,0,2,1.5"),
        (
            "ellipsoid:0,0,0,1,1,1",
            "ellipsoid:0,0,0,3,1,1",
            "ellipsoid:0,0,0,2,1,1",
        ),
        (
            "cylinder:0,0,0,0,1,0,1",
            "cylinder:0,0,0,0,3,0,2",
            "cylinder:0,0,0,0,2,0,1.5",
        ),
        (
            "capsule:0,0,0,0,1,0,1",
            "capsule:1,0,0,1,1,0,1",
            "capsule:0.5,0,0,0.5,1,0,1",
        ),
        (
            "cone:0,0,0,0,1,0,1",
            "cone:0,0,0,0,1,0,2",
            "cone:0,0,0,0,1,0,1.5",
        ),
        (
            "all(sphere:0,0,0,1, not(any(plane:1,0,0,0, sphere:0,0,0,2)))",
            "all(sphere:0,0,0,3, not(any(plane:1,0,0,1, sphere:0,0,0,2)))",
            "all(sphere:0,0,0,2, not(any(plane:1,0,0,0.5, sphere:0,0,0,2)))",
        ),
    ] {
        let middle = middle.parse::<Expression>().expect("an expression");
        assert_eq!(between(from, to, 0.5).expect("a region"), middle);
        assert_eq!(
            between(from, to, 0.0).expect("a region"),
            from.parse().expect("an expression")
        );
        assert_eq!(
            between(from, to, 1.0).expect("a region"),
            to.parse().expect("an expression")
        );
    }
}

#[test]
fn planes_turn_about_what_they_have_in_common() {
    let share = 0.3;
    // Both hold the line through (2, 3, z).
    let turned = between("plane:1,0,0,-2", "plane:0,1,0,-3", share)
        .expect("a plane")
        .clip();
    let plane = turned.surfaces[0].as_plane().expect("a plane");
    assert!(plane.distance(DVec3::new(2.0, 3.0, 7.0)).abs() < 1e-12);
    let angle = plane.normal().dot(DVec3::X).acos();
    assert!((angle - share * std::f64::consts::FRAC_PI_2).abs() < 1e-12);
}

#[test]
fn other_forms_are_refused() {
    for (from, to) in [
        ("sphere:0,0,0,1", "box:0,0,0,1,1,1"),
        ("sphere:0,0,0,1", "!sphere:0,0,0,1"),
        ("all(sphere:0,0,0,1)", "any(sphere:0,0,0,1)"),
        ("all(sphere:0,0,0,1, plane:1,0,0,0)", "all(sphere:0,0,0,1)"),
    ] {
        for share in [0.0, 0.5, 1.0] {
            let error = between(from, to, share).expect_err(from).to_string();
            assert!(
                error.contains("the same kinds of shapes"),
                "{share}: {error}"
            );
        }
    }
    let error = between("plane:1,0,0,0", "plane:-1,0,0,0", 0.5).expect_err("opposed");
    assert!(error.to_string().contains("180 degrees"), "{error}");
    // The two discs of a cylinder pass through each other.
    assert!(between("cylinder:0,0,0,0,1,0,1", "cylinder:0,0,0,0,-1,0,1", 0.5).is_err());
}
