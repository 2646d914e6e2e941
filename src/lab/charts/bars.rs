//! Bars side by side.

use plotters::prelude::*;

use super::axis::number;
use super::canvas::{self, Anchor, HEIGHT, Key, WIDTH};
use super::plot::Plot;
use super::{Axis, Values, colours};

/// Values of categories as bars.
#[derive(Debug, Clone)]
pub struct Bars {
    /// What stands above it.
    pub title: String,
    /// What the categories are.
    pub x: String,
    /// The categories.
    pub categories: Vec<String>,
    /// Up. A linear axis begins at 0.
    pub y: Axis,
    /// A bar in each category, in their order.
    pub series: Vec<Values>,
}

impl Bars {
    /// The chart as an SVG document.
    pub fn svg(&self) -> String {
        let values = self.series.iter().flat_map(|series| &series.values);
        let base = match self.y.scale {
            super::Scale::Linear => Some(0.0),
            super::Scale::Log => None,
        };
        // What is written above and below the bars needs some room.
        let values = values.map(|value| value * 1.08);
        let y = self.y.span(values.chain(base));
        let count = self.series.len().max(1) as f64;
        canvas::chart(&self.title, (WIDTH, HEIGHT), |area| {
            let names: Vec<_> = self.series.iter().map(|s| s.name.as_str()).collect();
            let area = canvas::legend(area, Key::Patch, &names)?;
            let categories: Vec<_> = self.categories.iter().map(String::as_str).collect();
            let plot = Plot::of_categories(&area, &categories, &self.x, (&self.y, y))?;
            let bottom = base.map_or(plot.area.dim_in_pixel().1 as i32, |base| plot.down(base));
            for (number, series) in self.series.iter().enumerate() {
                for (place, &value) in series.values.iter().take(categories.len()).enumerate() {
                    if !self.y.takes(value) {
                        continue;
                    }
                    let edge = |part: usize| place as f64 + 0.1 + 0.8 * part as f64 / count;
                    let (left, right) = (plot.across(edge(number)), plot.across(edge(number + 1)));
                    self.draw_bar(&plot, number, (left, right), (bottom, value))?;
                }
            }
            plot.line((0, bottom), plot_end(&plot, bottom), colours::FAINT)
        })
    }

    /// A bar, and its value above it where there is room.
    fn draw_bar(
        &self,
        plot: &Plot<'_>,
        series: usize,
        (left, right): (i32, i32),
        (bottom, value): (i32, f64),
    ) -> canvas::Drawn {
        let top = plot.down(value);
        let corners = [(left, top.min(bottom)), (right - 1, top.max(bottom))];
        let filled = colours::series(series).filled();
        plot.area.draw(&Rectangle::new(corners, filled))?;
        let text = number(value);
        if canvas::width_of(&text, 11) <= right - left + 4 {
            let y = if value < 0.0 { top + 9 } else { top - 9 };
            let at = ((left + right) / 2, y);
            canvas::write(&plot.area, &text, at, Anchor::Middle, 11, colours::INK)?;
        }
        Ok(())
    }
}

fn plot_end(plot: &Plot<'_>, y: i32) -> (i32, i32) {
    (plot.area.dim_in_pixel().0 as i32, y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::charts::test::Read;

    #[test]
    fn bars_are_as_high_as_their_values_and_missing_ones_are_not_there() {
        let bars = Bars {
            title: "Frame times".into(),
            x: "Scene".into(),
            categories: vec!["hair".into(), "anatomy, coarse".into()],
            y: Axis::linear("Time (ms)"),
            series: vec![
                Values::new("hard", [1.0, 2.0]),
                Values::new("exact", [4.0, f64::NAN]),
            ],
        };
        let read = Read::of("bars", &bars.svg());
        read.has(&[
            "Frame times",
            "Scene",
            "hair",
            "anatomy, coarse",
            "hard",
            "exact",
            "Time (ms)",
        ]);
        let [hard, exact] = ["#0072B2", "#D55E00"].map(|colour| read.rectangles(colour));
        assert_eq!((hard.len(), exact.len()), (3, 2), "with the legend's");
        assert!((hard[2].3 - 2 * hard[1].3).abs() <= 2, "{hard:?}");
        assert!(
            (exact[1].3 - 4 * hard[1].3).abs() <= 3,
            "{hard:?} {exact:?}"
        );
        assert!(exact[1].0 >= hard[1].0 + hard[1].2, "they do not overlap");
    }
}
