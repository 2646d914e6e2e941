use super::*;

#[test]
fn letters_are_where_they_were_put() {
    let mut picture = Picture::filled(20, 10, [1.0; 4]);
    // Text that is partly outside does no harm.
    text(&mut picture, [18.0, 9.0], "edge", (Font::Small, 3), [0; 3]);
    picture = Picture::filled(20, 10, [1.0; 4]);
    text(&mut picture, [1.0, 1.0], "L1", (Font::Small, 1), [0; 3]);
    let black = |x, y| picture.at(x, y) == [0.0, 0.0, 0.0, 1.0];
    let left = (1..8).all(|y| black(1, y));
    assert!(left && (1..6).all(|x| black(x, 7)), "an L from (1, 1)");
    assert!((1..8).all(|y| black(9, y)), "a 1 beside it");
    assert!((0..20).all(|x| !black(x, 0) && !black(x, 8)));
}

#[test]
fn every_letter_has_a_shape_of_its_own_at_any_scale() {
    let drawn = |letter: char, scale: i64| {
        let mut picture = Picture::filled(24, 36, [1.0; 4]);
        text(
            &mut picture,
            [3.0, 6.0],
            &letter.to_string(),
            (Font::Small, scale),
            [0; 3],
        );
        picture
    };
    let letters: Vec<char> = ('!'..='~').collect();
    for (place, &letter) in letters.iter().enumerate() {
        let small = drawn(letter, 1);
        assert_ne!(small, Picture::filled(24, 36, [1.0; 4]), "{letter}");
        for &other in &letters[..place] {
            assert_ne!(small, drawn(other, 1), "{letter} and {other}");
        }
        let ink = |picture: &Picture| picture.pixels.iter().filter(|p| p[0] == 0.0).count();
        assert_eq!(ink(&drawn(letter, 3)), 9 * ink(&small), "{letter}");
    }
    assert_eq!(drawn('é', 1), drawn('?', 1));
}
