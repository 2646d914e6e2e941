use super::*;

#[test]
fn a_dilated_pixel_is_a_square_cut_off_at_the_edges() {
    let a = Picture::filled(9, 7, [0.0; 4]);
    let mut b = a.clone();
    b.pixels[3 * 9 + 4][2] = 0.5;
    let spot = Pixels::where_different(&a, &b, 0.4).unwrap();
    assert_eq!(spot.share(), 1.0 / 63.0);
    assert_eq!(spot.dilated(2).share(), 25.0 / 63.0);
    assert_eq!(spot.dilated(0), spot);
    assert_eq!(Pixels::where_different(&a, &b, 0.6).unwrap().share(), 0.0);
    b.pixels[0][0] = 1.0;
    let both = Pixels::where_different(&a, &b, 0.4).unwrap();
    assert_eq!(both.dilated(1).share(), (9.0 + 4.0) / 63.0);
    assert_eq!(both.dilated(9).share(), 1.0);
}

#[test]
fn means_are_over_what_is_inside() {
    let a = Picture::filled(2, 2, [0.0; 4]);
    let mut b = a.clone();
    let nothing = Pixels::where_different(&a, &b, 0.0).unwrap();
    assert_eq!(nothing.mean(&[1.0; 4]), None);
    b.pixels[1][3] = 1.0;
    b.pixels[2][3] = 1.0;
    let two = Pixels::where_different(&a, &b, 0.0).unwrap();
    assert_eq!(two.mean(&[9.0, 1.0, 2.0, 9.0]), Some(1.5));
    assert!(Pixels::where_different(&a, &Picture::default(), 0.0).is_err());
}
