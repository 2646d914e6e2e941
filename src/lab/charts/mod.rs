//! Charts as SVG documents, for reports. Each is described by a struct and drawn by its `svg`.
//!
//! Values that are not finite are missing: they are left out. Colours can be told apart by people who are colour-blind,
//! and markers differ in shape as well.

mod axis;
mod canvas;
mod colours;
mod heat_map;
mod lines;
mod plot;
mod radar;
mod scatter;
#[cfg(test)]
mod test;
mod violins;

pub use axis::{Axis, Scale};
pub use heat_map::{Colours, HeatMap};
pub use lines::Lines;
pub use radar::Radar;
pub use scatter::Scatter;
pub use violins::Violins;

#[derive(Debug, Clone, PartialEq)]
pub struct Values {
    pub name: String,
    pub values: Vec<f64>,
}

impl Values {
    pub fn new(name: impl Into<String>, values: impl Into<Vec<f64>>) -> Self {
        Self {
            name: name.into(),
            values: values.into(),
        }
    }
}

#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    pub x: f64,
    pub y: f64,
    /// What stands beside it; nothing where it is empty.
    pub label: String,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    pub name: String,
    pub points: Vec<Point>,
}

impl Series {
    pub fn new(name: impl Into<String>, points: impl IntoIterator<Item = [f64; 2]>) -> Self {
        let points = points.into_iter().map(|[x, y]| (x, y, String::new()));
        Self::labelled(name, points)
    }

    pub fn labelled<L: Into<String>>(
        name: impl Into<String>,
        points: impl IntoIterator<Item = (f64, f64, L)>,
    ) -> Self {
        let points = points.into_iter().map(|(x, y, label)| Point {
            x,
            y,
            label: label.into(),
        });
        Self {
            name: name.into(),
            points: points.collect(),
        }
    }
}

/// The colour of a value from 0, light, to 1, dark: equal steps look equal.
pub fn sequential(value: f64) -> [u8; 3] {
    let plotters::style::RGBColor(r, g, b) = colours::sequential(value);
    [r, g, b]
}
