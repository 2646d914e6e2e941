use super::checks::cube;
use super::*;

#[test]
fn degenerate_and_duplicate_faces_are_dropped() {
    let mut shape = cube();
    let own = shape.1.len();
    shape
        .0
        .extend([DVec3::ZERO, DVec3::new(-0.0, 0.0, -0.0), DVec3::splat(9.0)]);
    shape.1.extend([
        [0, 8, 9],
        [3, 3, 1],
        shape.1[4],
        [shape.1[5][0], shape.1[5][2], shape.1[5][1]],
    ]);
    // Two vertices at a corner's place, and one that no face has.
    shape.1[0] = shape.1[0].map(|at| if at == 0 { 8 } else { at });
    let made = mesh(shape);
    assert_eq!((made.faces().len(), made.vertices().len()), (own, 8));
    let report = made.report();
    assert_eq!(
        (report.degenerate, report.duplicate, report.welded),
        (2, 2, 2)
    );
    assert_eq!(
        report.to_string(),
        "dropped 2 faces without an area; dropped 2 faces that another has the corners of"
    );
    assert!(!report.is_clean() && mesh(cube()).report().is_clean());
    assert_eq!(
        mesh(cube()).report().to_string(),
        "nothing dropped or repaired"
    );
}

#[test]
fn shells_that_share_a_wall_are_one() {
    // A wall of three by three squares between two sheets, which has faces that touch none of its rim.
    let lower = shapes::sheet(3, 0.5);
    let mut upper = lower.clone();
    upper.0.iter_mut().for_each(|at| at.z += 0.5);
    // The same bits on both sides of the wall.
    for at in 0..16 {
        upper.0[16 + at] = lower.0[at];
    }
    let faces = lower.1.len();
    let mut both = lower;
    shapes::join(&mut both, upper);
    let made = mesh(both);
    assert_eq!(made.faces().len(), 2 * faces - 36);
    assert_eq!((made.report().duplicate, made.report().shells), (36, 1));
    for z in [-0.2, 0.2, 0.3, 0.7] {
        assert_eq!(made.winding(DVec3::new(0.01, 0.02, z)), 1, "{z}");
    }
    // Where every face is there once for either side, one of them stays.
    let mut twofold = cube();
    let backs: Vec<_> = twofold.1.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    twofold.1.extend(backs);
    let made = mesh(twofold);
    assert_eq!((made.faces().len(), made.report().duplicate), (12, 12));
    assert!(made.keeps(DVec3::splat(0.5)));
}

#[test]
fn faces_without_an_area_stay_where_they_close_the_surface() {
    // An edge that one neighbour has as two: the face between them has its corners in line.
    let mut shape = cube();
    let middle = shape.0.len() as u32;
    let [a, b, c] = shape.1[0];
    shape
        .0
        .push(0.5 * (shape.0[a as usize] + shape.0[b as usize]));
    shape.1[0] = [a, middle, c];
    shape.1.extend([[middle, b, c], [a, b, middle]]);
    let made = mesh(shape);
    assert_eq!((made.report().slivers, made.report().degenerate), (1, 0));
    assert!(
        made.report()
            .to_string()
            .starts_with("kept 1 face without an area")
    );
    assert!(made.keeps(DVec3::splat(0.5)));
    // One that is not needed goes.
    let mut shape = cube();
    shape
        .0
        .extend([DVec3::X * 3.0, DVec3::X * 4.0, DVec3::X * 5.0]);
    shape.1.extend([[8, 9, 10], [8, 10, 9]]);
    let made = mesh(shape);
    assert_eq!((made.report().slivers, made.report().duplicate), (0, 2));
    assert_eq!(made.report().degenerate, 0);
}
