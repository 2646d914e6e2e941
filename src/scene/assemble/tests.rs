use super::*;

fn row() -> [f64; SLOTS] {
    let mut row = [0.0; SLOTS];
    row[6] = 1.0;
    row
}

fn load(rows: &[[f64; SLOTS]]) -> (Gaussians, LoadReport) {
    load_as(rows, ColumnForm::Logarithms)
}

fn load_as(rows: &[[f64; SLOTS]], stored: ColumnForm) -> (Gaussians, LoadReport) {
    let made = room(rows.len() as u64, 0, stored).and_then(|room| {
        room.make(|number, row| {
            row.copy_from_slice(&rows[number]);
            Ok(())
        })
    });
    let Ok(made) = made else { panic!("no memory") };
    let (loaded, _) = made.finish();
    (loaded.gaussians, loaded.report)
}

#[test]
fn quaternions_of_any_length_are_normalised() {
    for length in [1e-300, 1e-40, 1e-25, 0.03, 1.0, 1.93, 1e25, 3e37] {
        let mut r = row();
        (r[6], r[7], r[8], r[9]) = (length, -length, length, -length);
        let (gaussians, report) = load(&[r]);
        assert!(report.is_clean());
        assert_eq!(
            gaussians.rotations()[0],
            Quat::from_xyzw(-0.5, 0.5, -0.5, 0.5)
        );
    }
}

#[test]
fn a_zero_quaternion_is_repaired_and_counted() {
    let mut r = row();
    r[6] = -0.0;
    let (gaussians, report) = load(&[row(), r]);
    assert_eq!(gaussians.rotations()[1], Quat::IDENTITY);
    assert_eq!((report.repaired, report.dropped), (1, 0));
    assert_eq!(report.first_repaired[0].element, 1);
}

#[test]
fn extreme_opacities_and_scales_stay_finite() {
    let mut rows = [row(), row()];
    rows[0][10] = 1000.0;
    rows[1][10] = -1000.0;
    rows[1][3] = -1e30;
    rows[1][4] = 88.7;
    let (gaussians, report) = load(&rows);
    assert!(report.is_clean());
    assert_eq!(gaussians.opacities(), [1.0, 0.0]);
    assert_eq!(gaussians.scales()[1].x, 0.0);
    assert!(gaussians.scales()[1].y > 1e38);
}

#[test]
fn infinite_logits_and_logarithms_of_zero_are_taken_at_their_word() {
    let mut rows = [row(), row(), row()];
    rows[0][OPACITY] = f64::INFINITY;
    rows[1][OPACITY] = f64::NEG_INFINITY;
    rows[2][SCALES + 2] = f64::NEG_INFINITY;
    let (gaussians, report) = load(&rows);
    assert_eq!((gaussians.len(), report.repaired), (3, 3));
    assert_eq!(gaussians.opacities(), [1.0, 0.0, 0.5]);
    assert_eq!(gaussians.scales()[2], Vec3::new(1.0, 1.0, 0.0));
    assert_eq!(
        report.first_repaired[0].reason,
        "opacity is inf, taken as the opacity 1"
    );
}

#[test]
fn plain_scales_and_opacities_are_taken_as_they_are() {
    let mut rows = [row(), row(), row()];
    (rows[0][SCALES], rows[0][OPACITY]) = (0.5, 0.25);
    (rows[1][SCALES], rows[1][OPACITY]) = (-0.5, 1.0);
    rows[2][OPACITY] = 1.5;
    let (gaussians, report) = load_as(&rows, ColumnForm::Plain);
    assert_eq!(gaussians.scales()[0], Vec3::new(0.5, 0.0, 0.0));
    assert_eq!(gaussians.scales()[1], gaussians.scales()[0]);
    assert_eq!(gaussians.opacities(), [0.25, 1.0, 1.0]);
    assert_eq!((report.repaired, report.dropped), (2, 0));
}

#[test]
fn what_is_not_finite_is_dropped_with_its_property_named() {
    for (slot, value, named) in [
        (0, f64::NAN, "x is NaN"),
        (4, 100.0, "scale_1"),
        (5, f64::INFINITY, "scale_2 is inf"),
        (9, 1e39, "rot_3 is 1e39, beyond"),
        (10, f64::NAN, "opacity is NaN"),
        (13, f64::NAN, "f_dc_2"),
    ] {
        let mut r = row();
        r[slot] = value;
        let (gaussians, report) = load(&[row(), r, row()]);
        assert_eq!((gaussians.len(), report.dropped), (2, 1));
        assert_eq!(report.first_dropped[0].element, 1);
        let reason = &report.first_dropped[0].reason;
        assert!(reason.contains(named), "{reason}");
    }
}
