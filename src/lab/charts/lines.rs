//! Lines through points, with a marker on each.

use plotters::prelude::*;

use super::canvas::{self, HEIGHT, Key, WIDTH};
use super::plot::Plot;
use super::{Axis, Point, Series, colours};

#[derive(Debug, Clone)]
pub struct Lines {
    pub title: String,
    pub x: Axis,
    pub y: Axis,
    /// The lines; a line is broken where a value is missing.
    pub series: Vec<Series>,
}

impl Lines {
    pub fn svg(&self) -> String {
        canvas::chart(&self.title, (WIDTH, HEIGHT), |area| {
            let names: Vec<_> = self.series.iter().map(|s| s.name.as_str()).collect();
            let area = canvas::legend(area, Key::Line, &names)?;
            let points = self.series.iter().flat_map(|series| &series.points);
            let plot = Plot::measured(&area, (&self.x, &self.y), points)?;
            let has_place = |p: &Point| self.x.takes(p.x) && self.y.takes(p.y);
            for (number, series) in self.series.iter().enumerate() {
                let runs = series.points.split(|point| !has_place(point));
                for run in runs.filter(|run| !run.is_empty()) {
                    let path: Vec<_> = run.iter().map(|p| plot.at(p.x, p.y)).collect();
                    let style = colours::series(number).stroke_width(2);
                    plot.area.draw(&PathElement::new(path.clone(), style))?;
                    for at in path {
                        canvas::mark(&plot.area, number, at)?;
                    }
                }
            }
            Ok(())
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::charts::test::Read;

    #[test]
    fn lines_pass_through_their_points_and_break_where_values_are_missing() {
        let lines = Lines {
            title: "Time by size".into(),
            x: Axis::log("Gaussians"),
            y: Axis::linear("Time (ms)").between(0.0, 10.0),
            series: vec![
                Series::new(
                    "exact",
                    [[1e3, 1.0], [1e4, 2.0], [1e5, f64::NAN], [1e6, 9.0]],
                ),
                Series::new("hard & fast", [[1e3, 0.5], [1e6, 4.0]]),
            ],
        };
        let read = Read::parse("lines", &lines.svg());
        read.has(&[
            "Time by size",
            "Gaussians",
            "Time (ms)",
            "exact",
            "hard & fast",
            "0",
            "10",
            "10⁶",
        ]);
        let paths = read.paths("#0072B2");
        // The legend's, then the two pieces.
        assert_eq!(paths.len(), 3, "{paths:?}");
        let (first, last) = (&paths[1], &paths[2]);
        assert_eq!((first.len(), last.len()), (2, 1));
        // 1e3 to 1e6 with a margin of 6 % of three decades at both ends.
        let step = first[1].0 - first[0].0;
        assert!((last[0].0 - first[0].0 - 3 * step).abs() <= 2, "{paths:?}");
        assert!(first[0].1 > first[1].1 && first[1].1 > last[0].1);
    }
}
