//! Values of rows and columns as colours.

use plotters::prelude::*;

use super::axis::{Axis, Span, axes};
use super::canvas::{self, FAINT, GRID, MIDDLE};

#[derive(Debug, Clone)]
pub struct HeatMap {
    pub title: String,
    pub y: String,
    pub x: String,
    /// The rows, from the top.
    pub rows: Vec<String>,
    /// The columns, from the left.
    pub columns: Vec<String>,
    /// The values, row by row, which are written with one decimal; what is missing is NaN.
    pub values: Vec<Vec<f64>>,
    /// What the values measure, and in which unit.
    pub unit: String,
    /// Colours go from blue at minus this value, by nearly white at 0, to red at this value.
    pub most: f64,
}

impl HeatMap {
    pub fn svg(&self) -> String {
        let height = 220 + 26 * self.rows.len().max(1) as i32;
        canvas::chart(&self.title, None, height, |canvas, top| {
            let x = Span::of_categories(&self.x, self.columns.iter());
            let y = Span::of_categories(&self.y, self.rows.iter().rev());
            let mut cells = axes(canvas, top..height - 86, &x, &y)?;
            let values = self.values.iter().take(self.rows.len());
            for (row, values) in values.enumerate() {
                let top = (y.marks.len() - row) as f64;
                for (left, &value) in values.iter().take(self.columns.len()).enumerate() {
                    let left = left as f64;
                    let colour = canvas::diverging(value / self.most);
                    let (colour, ink, text) = match value.is_finite() {
                        true => (colour, canvas::on(colour), text(value)),
                        false => (GRID, FAINT, "\u{2013}".into()),
                    };
                    let corners = [(left, top), (left + 1.0, top - 1.0)];
                    let mut cell = Rectangle::new(corners, colour.filled());
                    cell.set_margin(0, 1, 0, 1);
                    cells.draw_series([cell])?;
                    let middle = cells.backend_coord(&(left + 0.5, top - 0.5));
                    canvas::write(canvas, &text, middle, MIDDLE, ink)?;
                }
            }
            // The colours and the values that they stand for.
            let x = Axis::linear(&self.unit).between(-self.most, self.most);
            let y = Span::of_categories("", [].iter());
            let mut key = axes(canvas, height - 78..height - 16, &x.span([]), &y)?;
            key.draw_series((-32..32).map(|step| {
                let [left, right] = [step, step + 1].map(|edge| f64::from(edge) / 32.0);
                let colour = canvas::diverging((left + right) / 2.0);
                let corners = [(left * self.most, 1.0), (right * self.most, 0.0)];
                Rectangle::new(corners, colour.filled())
            }))?;
            Ok(())
        })
    }
}

/// A number with one decimal, and without a sign where it is rounded to 0.
fn text(value: f64) -> String {
    let rounded = (value * 10.0).round() / 10.0 + 0.0;
    format!("{rounded:.1}").replace('-', "\u{2212}")
}
