use super::*;

#[test]
fn a_map_is_white_where_nothing_differs_and_darker_where_more_does() {
    let a = Picture::filled(3, 1, [0.5, 0.5, 0.5, 1.0]);
    let mut b = a.clone();
    b.pixels[1][1] += 1.0 / 255.0;
    b.pixels[2][1] -= 0.4;
    let map = error_map(&a, &b).unwrap();
    let bright = |x: usize| map.pixels[x][..3].iter().sum::<f32>();
    assert_eq!(map.pixels[0], [1.0; 4]);
    assert!(
        bright(0) > bright(1) && bright(1) > bright(2) + 0.5,
        "{map:?}"
    );
    assert!(map.pixels.iter().all(|p| p[3] == 1.0));
    let scale = scale(64, 1);
    let brightness = |p: &[f32; 4]| 0.3 * p[0] + 0.6 * p[1] + 0.1 * p[2];
    // A step of 8 bits may be rounded the other way.
    let falls = |p: &[[f32; 4]]| brightness(&p[0]) + 1.0 / 255.0 >= brightness(&p[1]);
    assert!(scale.pixels.windows(2).all(falls));
}

#[test]
fn known_colours_of_oklab_come_out() {
    assert_eq!(oklch(1.0, 0.0, 0.0), [255; 3]);
    assert_eq!(oklch(0.0, 0.0, 0.0), [0; 3]);
    // Red of sRGB, as CSS Color 4 has it.
    let [r, g, b] = oklch(0.627_955, 0.257_683, 29.234);
    assert!(r >= 254 && g <= 1 && b <= 1, "{r} {g} {b}");
}

#[test]
fn the_worst_square_is_around_what_differs() {
    let a = Picture::filled(20, 12, [0.0; 4]);
    let mut b = a.clone();
    for (x, y) in [(13, 7), (14, 8), (15, 9)] {
        b.pixels[y * 20 + x][0] = 1.0;
    }
    let [left, top] = worst_square(&a, &b, 4).unwrap();
    assert!(
        (12..=13).contains(&left) && (6..=7).contains(&top),
        "{left} {top}"
    );
    let part = magnified(&b, [left, top], 4, 2);
    let red = part.pixels.iter().filter(|p| p[0] == 1.0).count();
    assert_eq!((part.width, red), (8, 12));
    assert!(worst_square(&a, &Picture::filled(3, 3, [0.0; 4]), 4).is_err());
}
