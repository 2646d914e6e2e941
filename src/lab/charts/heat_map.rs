//! Values of rows and columns as colours.

use plotters::prelude::*;

use super::axis::number;
use super::canvas::{self, Anchor, Area, MEDIUM, SMALL, WIDTH, width_of};
use super::colours;

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Colours {
    /// Colours from blue at minus this value, by nearly white at 0, to red at this value.
    Diverging(f64),
    /// Colours from light to dark between two values.
    Sequential(f64, f64),
}

impl Colours {
    fn colour(self, value: f64) -> RGBColor {
        match self {
            Self::Diverging(most) => colours::diverging(value / most),
            Self::Sequential(low, high) => colours::sequential((value - low) / (high - low)),
        }
    }

    fn ends(self) -> [f64; 2] {
        match self {
            Self::Diverging(most) => [-most, most],
            Self::Sequential(low, high) => [low, high],
        }
    }
}

#[derive(Debug, Clone)]
pub struct HeatMap {
    pub title: String,
    pub y: String,
    pub x: String,
    /// The rows, from the top.
    pub rows: Vec<String>,
    /// The columns, from the left.
    pub columns: Vec<String>,
    /// The values, row by row; what is missing is NaN.
    pub values: Vec<Vec<f64>>,
    /// What the values measure, and in which unit.
    pub unit: String,
    pub colours: Colours,
    pub decimals: usize,
}

const ROW: i32 = 26;
/// The space above the cells: what the columns are, and their names.
const ABOVE: i32 = 62;
/// The space below the cells: the colours and what they mean.
const BELOW: i32 = 62;

impl HeatMap {
    pub fn svg(&self) -> String {
        let rows = self.rows.len().max(1) as i32;
        let height = 56 + ABOVE + ROW * rows + BELOW;
        canvas::chart(&self.title, (WIDTH, height as u32), |area| {
            let names = self.rows.iter().map(|name| width_of(name, SMALL));
            let left = names.max().unwrap_or(0).clamp(60, 260) + 30;
            let right = area.dim_in_pixel().0 as i32;
            let count = self.columns.len().max(1) as i32;
            let edge = |column: usize| left + (right - left) * column as i32 / count;
            let middle = (left + right) / 2;
            canvas::write(
                area,
                &self.x,
                (middle, 8),
                Anchor::Middle,
                MEDIUM,
                colours::INK,
            )?;
            canvas::write(area, &self.y, (0, 40), Anchor::Start, MEDIUM, colours::INK)?;
            for (column, name) in self.columns.iter().enumerate() {
                let at = ((edge(column) + edge(column + 1)) / 2, 40);
                canvas::write_wrapped(area, name, at, Anchor::Middle, edge(1) - left - 6)?;
            }
            for (row, name) in self.rows.iter().enumerate() {
                let top = ABOVE + ROW * row as i32;
                let at = (left - 8, top + ROW / 2);
                canvas::write(area, name, at, Anchor::End, SMALL, colours::INK)?;
                let values = self.values.get(row).into_iter().flatten();
                for (column, &value) in values.take(self.columns.len()).enumerate() {
                    let corners = [(edge(column), top), (edge(column + 1) - 1, top + ROW - 1)];
                    self.draw_cell(area, corners, value)?;
                }
            }
            self.draw_key(area, (left, right), ABOVE + ROW * rows + 14)
        })
    }

    fn draw_cell(
        &self,
        area: &Area<'_>,
        corners: [(i32, i32); 2],
        value: f64,
    ) -> canvas::DrawResult {
        let [(left, top), (right, bottom)] = corners;
        let at = ((left + right) / 2, (top + bottom) / 2);
        if !value.is_finite() {
            area.draw(&Rectangle::new(corners, colours::GRID))?;
            return canvas::write(area, "\u{2013}", at, Anchor::Middle, 12, colours::FAINT);
        }
        let colour = self.colours.colour(value);
        area.draw(&Rectangle::new(corners, colour.filled()))?;
        let text = format!("{value:.*}", self.decimals);
        // What is rounded to 0 has no sign.
        let text = match text.trim_start_matches('-') {
            plain if plain.chars().all(|c| matches!(c, '0' | '.')) => plain.into(),
            _ => text.replace('-', "\u{2212}"),
        };
        canvas::write(area, &text, at, Anchor::Middle, 12, colours::on(colour))
    }

    /// The colours and the values that they stand for.
    fn draw_key(&self, area: &Area<'_>, (left, right): (i32, i32), top: i32) -> canvas::DrawResult {
        const STEPS: i32 = 64;
        let [low, high] = self.colours.ends();
        let unit = width_of(&self.unit, SMALL) + 16;
        let width = (right - left - unit).clamp(100, 320);
        for step in 0..STEPS {
            let value = low + (high - low) * f64::from(step) / f64::from(STEPS - 1);
            let edge = |step: i32| left + width * step / STEPS;
            let corners = [(edge(step), top), (edge(step + 1), top + 12)];
            area.draw(&Rectangle::new(
                corners,
                self.colours.colour(value).filled(),
            ))?;
        }
        for part in 0..=2 {
            let value = low + (high - low) * f64::from(part) / 2.0;
            let at = (left + width * part / 2, top + 22);
            canvas::write(area, &number(value), at, Anchor::Middle, 12, colours::INK)?;
        }
        let at = (left + width + 16, top + 6);
        canvas::write_wrapped(area, &self.unit, at, Anchor::Start, right - at.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::charts::test::Read;

    #[test]
    fn cells_have_the_colours_and_numbers_of_their_values() {
        let map = HeatMap {
            title: "Preference by case".into(),
            x: "Metric".into(),
            y: "Case".into(),
            rows: vec!["surfaces 1, face".into(), "hair 1, edge".into()],
            columns: vec!["Flatness".into(), "Temporal stability".into()],
            values: vec![vec![7.0, -3.456], vec![-0.001, f64::NAN]],
            unit: "Mean signed preference".into(),
            colours: Colours::Diverging(7.0),
            decimals: 2,
        };
        let read = Read::parse("heat_map", &map.svg());
        read.has(&[
            "Preference by case",
            "Metric",
            "Case",
            "surfaces 1, face",
            "hair 1, edge",
        ]);
        read.has(&[
            "Flatness",
            "Temporal stability",
            "7.00",
            "−3.46",
            "0.00",
            "–",
            "Mean signed preference",
        ]);
        let hex = |RGBColor(r, g, b): RGBColor| format!("#{r:02X}{g:02X}{b:02X}");
        let full = read.rectangles(&hex(colours::diverging(1.0)));
        let middle = read.rectangles(&hex(colours::diverging(-0.001 / 7.0)));
        // Row by row, from the left; the key has the strongest colour too.
        let (first, below) = (full[0], middle[0]);
        assert_eq!(first.0, below.0);
        assert_eq!(below.1 - first.1, ROW);
        let minus = read.rectangles(&hex(colours::diverging(-3.456 / 7.0)));
        assert_eq!(minus[0].1, first.1);
        assert!(minus[0].0 > first.0);
    }
}
