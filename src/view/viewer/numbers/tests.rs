use super::*;

fn shown_lines(text: &str) -> Vec<String> {
    let lines = lines(&text.parse().expect("a shape"));
    let words = |line: String| line.split_whitespace().collect::<Vec<_>>().join(" ");
    lines.into_iter().map(words).collect()
}

#[test]
fn every_shape_says_its_numbers_by_their_names() {
    assert_eq!(
        shown_lines("plane:0,0,-2,1"),
        ["normal 0.0000 0.0000 -1.0000", "at -0.5000"]
    );
    assert_eq!(shown_lines("slab:1,0,0,0,0.25")[2], "thickness 0.2500");
    assert_eq!(
        shown_lines("!sphere:1,2,3,4e-5"),
        ["centre 1.0000 2.0000 3.0000", "radius 4.000e-5"]
    );
    assert_eq!(
        shown_lines("box:1,2,3,4,5,123456,1,0,0,1"),
        [
            "centre 1.0000 2.0000 3.0000",
            "half size 4.0000 5.0000 1.235e5",
            "turned 0.0000 0.0000 1.0000 90.0000"
        ]
    );
    assert_eq!(
        shown_lines("ellipsoid:0,0,0,1,2,3")[1],
        "radii 1.0000 2.0000 3.0000"
    );
    assert_eq!(
        shown_lines("ellipsoid:0,0,0,1,2,3").len(),
        2,
        "it is not turned"
    );
    for text in ["cylinder:0,0,0,1,0,0,2", "capsule:0,0,0,1,0,0,2"] {
        assert_eq!(
            shown_lines(text),
            [
                "from 0.0000 0.0000 0.0000",
                "to 1.0000 0.0000 0.0000",
                "radius 2.0000"
            ]
        );
    }
    assert_eq!(
        shown_lines("cone:0,0,0,1,0,0,2")[0],
        "tip 0.0000 0.0000 0.0000"
    );
}

#[test]
fn columns_stay_where_they_are_while_a_shape_is_moved() {
    let line = |text: &str| lines(&text.parse().expect("a shape"))[0].len();
    for text in [
        "sphere:-1,2,3,1",
        "sphere:99999,-0.00001,1e300,1",
        "sphere:0,0,0,1",
    ] {
        assert_eq!(line(text), 9 + 3 * 11, "{text}");
    }
}
