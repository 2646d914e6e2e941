//! The numbers of a shape, for people: each with its name.

use std::fmt::Write;

use glam::DQuat;
use rara::clip::Parameter;
use rara::{Plane, Shape};

/// The numbers of a shape, a line each. Lengths are world units, and rotations an axis and degrees about it.
pub(super) fn lines(shape: &Shape) -> Vec<String> {
    let mut lines = Vec::new();
    let mut say = |name: &str, numbers: &[f64]| lines.push(named(name, numbers));
    for (name, parameter) in shape.solid().parameters() {
        match parameter {
            Parameter::Plane(plane) => {
                say("normal", &plane.normal().to_array());
                say("at", &[stands_at(&plane)]);
            }
            Parameter::Point(vector) | Parameter::Sizes(vector) => say(name, &vector.to_array()),
            Parameter::Size(size) => say(name, &[size]),
            Parameter::Rotation(rotation) => turned(rotation, &mut say),
        }
    }
    lines
}

/// The place of a plane along its normal, world units.
pub(super) fn stands_at(plane: &Plane) -> f64 {
    0.0 - plane.offset() // -0 is 0
}

/// Says a rotation that can be seen, by the axis and the degrees of less than half a turn.
fn turned(rotation: DQuat, say: &mut impl FnMut(&str, &[f64])) {
    let sign = if rotation.w < 0.0 { -1.0 } else { 1.0 };
    let (axis, angle) = (rotation * sign).to_axis_angle();
    let degrees = angle.to_degrees();
    if degrees > 5e-3 {
        say("turned", &[axis.x, axis.y, axis.z, degrees]);
    }
}

/// A name and its numbers, in columns.
fn named(name: &str, numbers: &[f64]) -> String {
    let mut line = format!("{name:<9}");
    for number in numbers {
        let _ = write!(line, " {:>10}", shown(*number));
    }
    line
}

/// Four digits behind the point, or four digits of what is too large or too small for that.
fn shown(number: f64) -> String {
    let size = number.abs();
    if size >= 1e5 || size != 0.0 && size < 1e-3 {
        return format!("{number:.3e}");
    }
    format!("{:.4}", number + 0.0) // -0 is 0
}

#[cfg(test)]
mod tests {
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
}
