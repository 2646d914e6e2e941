use super::*;
use crate::generate::Random;
use glam::Vec3Swizzles;

fn read(text: &str) -> Prism {
    Prism::read(text).unwrap_or_else(|error| panic!("{text}: {error}"))
}

/// Checks a prism along z against the even-odd rule, at points that are not on its edges.
fn check(prism: &Prism, random: &mut Random) {
    let clip = prism.clip();
    let corners = || prism.rings().iter().flatten();
    let low = corners().copied().reduce(DVec2::min).expect("corners");
    let high = corners().copied().reduce(DVec2::max).expect("corners");
    let margin = 0.2 * (high - low);
    for _ in 0..2_000 {
        let [x, y] =
            [0, 1].map(|axis| random.range(low[axis] - margin[axis], high[axis] + margin[axis]));
        let point = DVec2::new(x, y);
        let inside = prism
            .rings()
            .iter()
            .filter(|ring| winds_around(ring, point))
            .count()
            % 2
            == 1;
        assert_eq!(clip.keeps(point.extend(0.5)), inside, "{prism}: {point}");
    }
}

#[test]
fn polygons_keep_their_inside() {
    let mut random = Random::new(3);
    for text in [
        "z;0,0;2,0;2,1;0,1",
        "z;0,0;0,1;2,1;2,0",                         // the other way round
        "z;0,0;4,0;4,3;3,3;3,1;2,1;2,3;1,3;1,1;0,1", // a comb
        "z;0,0;4,0;4,1;1,1;1,2;4,2;4,3;0,3",         // a C
        "z;0,0;4,0;4,1;1,1;1,2;3,2;3,1.5;3.5,1.5;3.5,2.5;0,2.5",
        "z;0,0;5,0;5,5;1,5;1,2;3,2;3,3;2,3;2,4;4,4;4,1;0,1", // a spiral
        "z;0,0;1,2;2,0;3,2;4,0;4,3;0,3",
        "z;0,0;2,0;2,0;2,1;1,1;0,1;0,0", // repeated corners, one in line, and closed
        "z=0..1;0,0;9,0;9,9;0,9|3,3;6,3;6,6;3,6|1,1;2,1;1,2",
        "z;1e6,1e6;1000001,1e6;1000001,1000001;1000000.5,1000000.5",
    ] {
        check(&read(text), &mut random);
    }
    // Stars around a point, with corners at random distances.
    for count in [3, 5, 8, 20, 200, 1_000] {
        for _ in 0..8 {
            let corner = |at: usize| {
                let angle = std::f64::consts::TAU * at as f64 / count as f64;
                DVec2::from_angle(angle) * random.range(0.2, 1.0)
            };
            let ring: Vec<DVec2> = (0..count).map(corner).collect();
            check(
                &Prism::new("z", &[ring], None).expect("a star"),
                &mut random,
            );
        }
    }
}

#[test]
fn each_edge_is_a_plane_once() {
    let comb = read("z;0,0;4,0;4,3;3,3;3,1;2,1;2,3;1,3;1,1;0,1");
    assert_eq!(comb.clip().all_surfaces().len(), 10);
    let convex = read("axial=0..2;0,0;1,0;1,1;0,1").clip();
    assert!(convex.is_flat() && convex.surfaces.len() == 6);
}

#[test]
fn corners_lie_across_the_axis() {
    for (axis, point) in [
        ("x", DVec3::new(5.0, 1.5, 0.5)),
        ("y", DVec3::new(1.5, 5.0, 0.5)),
        ("z", DVec3::new(1.5, 0.5, 5.0)),
    ] {
        let prism = read(&format!("{axis}=4..6;1,0;2,0;2,1;1,1"));
        let along = Axis::parse(axis).expect("an axis").along;
        assert!(prism.clip().keeps(point), "{axis}");
        assert!(!prism.clip().keeps(point + 2.0 * along), "{axis}");
        assert!(!prism.clip().keeps(point.zyx() + 0.1), "{axis}");
        assert_eq!(read(&prism.to_string()), prism);
    }
}

#[test]
fn what_is_no_simple_polygon_is_refused_by_place() {
    for (text, says) in [
        ("w;0,0;1,0;1,1", "across 'w'"),
        ("!z;0,0;1,0;1,1", "across '!z'"),
        ("z", "needs corners"),
        ("z;0,0;1,0", "three corners"),
        ("z;0,0;1,0;2,0", "three corners"),
        (
            "z;0,0;1,1;1,0;0,1",
            "from (0, 0) to (1, 1) and that from (1, 0) to (0, 1)",
        ),
        ("z;0,0;2,0;2,2;1,0;0,2", "cross or touch"),
        ("z;0,0;4,0;4,1;2,1;2,3;2,1;0,1", "cross or touch"),
        ("z;0,0;9,0;9,9;0,9|8,8;12,8;12,9", "cross or touch"),
        (
            "z;0,0;9,0;9,9;0,9|10,8;12,8;12,9",
            "not inside of it: hole 1",
        ),
        ("z=2..1;0,0;1,0;1,1", "from 2 to 1"),
        ("z=2;0,0;1,0;1,1", "two heights"),
        ("z;0,0;1;1,1", "'1' is not a corner"),
        ("z;0,0;1,x;1,1", "'x' is not a finite number"),
        ("z;0,0;1,0;1,1|", "'' is not a corner"),
    ] {
        let error = Prism::read(text).expect_err(text).to_string();
        assert!(error.contains(says), "{text}: {error}");
    }
}
