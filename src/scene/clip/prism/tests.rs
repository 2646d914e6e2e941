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
                &Prism::new(PrismBase::Axis("z".into()), &[ring], None).expect("a star"),
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
        ("w;0,0;1,0;1,1", "axis 'w'"),
        ("!z;0,0;1,0;1,1", "axis '!z'"),
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
            "outside of its outline: hole 1",
        ),
        ("z=2..1;0,0;1,0;1,1", "height 2 to height 1"),
        ("z=2;0,0;1,0;1,1", "two heights"),
        ("z;0,0;1;1,1", "'1' is not a corner"),
        ("z;0,0;1,x;1,1", "'x' is not a finite number"),
        ("z;0,0;1,0;1,1|", "'' is not a corner"),
        ("0,0,0;0,0;1,0;1,1", "zero or not finite"),
        ("1,2;0,0;1,0;1,1", "not a direction"),
        ("from 1,2,3/1,0,0;0,0;1,0;1,1", "not an eye"),
        (
            "from 1,2,3/1,0,0/0,2,0;0,0;1,0;1,1",
            "perpendicular and of length 1",
        ),
        ("plot.geojson", "axis 'plot.geojson'"),
    ] {
        let error = Prism::read(text).expect_err(text).to_string();
        assert!(error.contains(says), "{text}: {error}");
    }
}

#[test]
fn directions_are_axes_that_were_turned() {
    for (name, direction) in [("z", "0,0,2"), ("y", "0,1,0"), ("x", "3,0,0")] {
        let named = read(&format!("{name}=-1..4;0,0;2,0;2,1;0,1"));
        let given = read(&format!("{direction}=-1..4;0,0;2,0;2,1;0,1"));
        assert_eq!(named.clip(), given.clip(), "{name}");
    }
    let turned = read("0,0.6,0.8=0..1;-1,-1;1,-1;1,1;-1,1");
    let clip = turned.clip();
    // z was turned about x, so that y was, too.
    let (along, v) = (DVec3::new(0.0, 0.6, 0.8), DVec3::new(0.0, 0.8, -0.6));
    for (u, v_at, height, inside) in [
        (0.9, 0.9, 0.9, true),
        (0.9, -0.9, 0.1, true),
        (1.1, 0.0, 0.5, false),
        (0.0, 1.1, 0.5, false),
        (0.0, 0.0, 1.1, false),
        (0.0, 0.0, -0.1, false),
    ] {
        let point = DVec3::X * u + v * v_at + along * height;
        assert_eq!(clip.keeps(point), inside, "{point}");
    }
    // The way back is the same prism, upside down.
    assert!(
        read("0,-0.6,-0.8=-1..0;-1,-1;1,-1;1,1;-1,1")
            .clip()
            .keeps(along * 0.5)
    );
    assert_eq!(read(&turned.to_string()), turned);
}

#[test]
fn prisms_are_placed_as_their_points_are() {
    let mut random = Random::new(5);
    let placement = Placement::new(
        DVec3::new(1.0, -2.0, 0.5),
        DQuat::from_scaled_axis(DVec3::new(0.3, 1.1, -0.4)),
        1.7,
    )
    .unwrap();
    for text in [
        "z=0..1;0,0;2,0;2,1;0,1|0.5,0.5;1,0.5;1,0.8",
        "y;-1,-1;1,-1;0,1",
        "0.2,-0.5,0.4=0..3;-1,-1;1,-1;0,1",
        "from 1,2,3/1,0,0/0,1,0;-1,-1;1,-1;0,1",
        "from 0,0,-2/0,0,1/0,1,0=1..4;-1,-1;1,-1;0,1",
    ] {
        let prism = read(text);
        let (before, after) = (prism.clip(), prism.placed(&placement).unwrap().clip());
        for _ in 0..500 {
            let point = DVec3::from_array([(); 3].map(|()| random.range(-3.0, 3.0)));
            let moved = placement.to_world(point);
            assert_eq!(before.keeps(point), after.keeps(moved), "{text}: {point}");
        }
        let edges = prism.edges([-1.0, 5.0]);
        let corners: usize = prism.rings().iter().map(Vec::len).sum();
        assert_eq!(edges.len(), 3 * corners, "{text}");
    }
}
