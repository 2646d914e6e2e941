use super::*;

#[test]
fn what_was_applied_before_is_not_applied_again() {
    // A quarter turn about z, and a step; both files say it, so that only the scale is left.
    let rows = [
        [0.0, -1.0, 0.0, 3.0],
        [1.0, 0.0, 0.0, 4.0],
        [0.0, 0.0, 1.0, 5.0],
    ];
    let transforms = Transforms {
        transform: rows,
        scale: 0.5,
    };
    let applied = |applied_transform| DataparserTransform {
        applied_transform,
        applied_scale: None,
    };
    let camera =
        Camera::look_at(DVec3::X, DVec3::ZERO, DVec3::NEG_Y, 50.0, (8, 8)).expect("a camera");
    let same = Move::new(&transforms, &applied(Some(rows)))
        .expect("rigid")
        .camera(&camera);
    assert!(same.eye.abs_diff_eq(0.5 * DVec3::X, 1e-12) && same.rotation == camera.rotation);
    let moved = Move::new(&transforms, &applied(None))
        .expect("rigid")
        .camera(&camera);
    assert!(
        moved
            .eye
            .abs_diff_eq(0.5 * DVec3::new(3.0, 5.0, 5.0), 1e-12)
    );
    // It looked along -x, which has become -y.
    assert!(moved.rotation.row(2).abs_diff_eq(DVec3::NEG_Y, 1e-12));
    assert!(rigid(&[[2.0; 4]; 3]).is_none());
}
