use super::*;

#[test]
fn what_reaches_out_of_the_picture_is_said() {
    let said = |outside, visible| super::outside(&Outside { visible, outside });
    assert_eq!(said(0, 9), None);
    for (outside, says) in [
        (3, "0.10 % of the visible Gaussians, 3 of 3 003, reach"),
        (1, "0.03 %"),
    ] {
        let note = said(outside, 3003).expect("a note");
        assert!(note.contains(says), "{note}");
    }
    assert!(said(1, 1_000_000).is_some_and(|note| note.contains("less than 0.01 %")));
}

#[test]
fn views_are_picked_by_number_name_stem_or_range() {
    let names = ["a.jpg", "b/7.png", "2", "0..1", "x,y"];
    let numbers = |wanted| picked(&names, wanted, Path::new("f"), "--view");
    for (wanted, meant) in [
        ("1", &[1][..]),
        ("a.jpg", &[0]),
        ("a", &[0]),
        ("7", &[1]),
        ("2", &[2]),
        ("1..3", &[1, 2, 3]),
        ("3..1", &[3, 2, 1]),
        ("2 .. 2", &[2]),
        ("2,1..2, a", &[2, 1, 2, 0]),
        // These are names.
        ("0..1", &[3]),
        ("x,y", &[4]),
    ] {
        assert_eq!(numbers(wanted).ok().as_deref(), Some(meant), "{wanted}");
    }
    for none in ["9", "3..5", "..2", "1..", "1,", "0,b", "a..7"] {
        let failure = numbers(none).expect_err(none).to_string();
        assert!(failure.contains("f has 5 cameras"), "{none}: {failure}");
    }
}
