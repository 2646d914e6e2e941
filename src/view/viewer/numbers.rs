//! The numbers of a shape, for people: each with its name.

use std::fmt::Write;

use glam::DQuat;
use rara::Plane;
use rara::clip::{Expression, Parameter};

/// The numbers of a shape, a line each. Lengths are world units, and rotations an axis and degrees about it.
pub(super) fn lines(shape: &Expression) -> Vec<String> {
    let mut lines = Vec::new();
    let mut say = |name: &str, numbers: &[f64]| lines.push(named(name, numbers));
    if let Expression::Prism(prism) = shape {
        say("along", &prism.along().to_array());
        if let Some(heights) = prism.heights() {
            say("heights", &heights);
        }
        let corners: usize = prism.rings().iter().map(Vec::len).sum();
        lines.push(format!("{:<9} {corners:>10}", "corners"));
        return lines;
    }
    if let Expression::Mesh(mesh) = shape {
        let inside = mesh.inside();
        say("at", &mesh.middle().to_array());
        say("scale", &[inside.placement().scale()]);
        turned(inside.placement().rotation(), &mut say);
        lines.push(format!(
            "{:<9} {:>10}",
            "faces",
            inside.mesh().faces().len()
        ));
        return lines;
    }
    let Expression::Shape(shape) = shape else {
        return lines;
    };
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
mod tests;
